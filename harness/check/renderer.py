"""What the checks take from the reader and the renderer, in one place."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from .. import native
from ..errors import ProjectError
from ..native import Program, Stage
from ..rendering.programs import SYSTEM_MACROS, declared_samplers

__all__ = [
    "STAGES",
    "SYSTEM_MACROS",
    "Refusal",
    "check_for_spirv",
    "declared_samplers",
    "link",
    "preprocess",
    "refusals",
    "tree",
]

#: type of a <shader> in the .sprj -> stage, in the order of drawing
STAGES = {
    "vs": Stage.VERTEX,
    "tcs": Stage.TESS_CONTROL,
    "tes": Stage.TESS_EVALUATION,
    "gs": Stage.GEOMETRY,
    "ps": Stage.FRAGMENT,
    "cs": Stage.COMPUTE,
}


def link(texts: dict[Stage, str]) -> Program:
    """The program of these stages. NativeError ``STAGE: LOG`` or ``link: LOG``."""
    return _link(tuple(texts.items()))


# Passes share texts, and whoever checks again after a change shares most.
@lru_cache(maxsize=32)
def _link(texts: tuple[tuple[Stage, str], ...]) -> Program:
    native.open_context()
    return Program.of_stages(dict(texts))


@lru_cache(maxsize=128)
def check_for_spirv(stage: Stage, text: str) -> None:
    """SHADERed's own check. NativeError with glslang's log."""
    native.glsl_check(stage, text, spirv=True)


@lru_cache(maxsize=128)
def preprocess(stage: Stage, text: str) -> str:
    """The text after the preprocessor, line by line, without the spaces that it puts around the point of a member."""
    return re.sub(r" ?\. ?(?=[A-Za-z_])", ".", native.glsl_preprocess(stage, text))


@lru_cache(maxsize=128)
def tree(stage: Stage, text: str) -> str:
    """glslang's dump of the syntax tree."""
    return native.glsl_tree(stage, text)


class Refusal(NamedTuple):
    """What the reader says about a project."""

    is_warning: bool
    file: str | None
    line: int | None
    message: str


def refusals(path: Path) -> list[Refusal]:
    """What ``harness render``'s reader refuses or warns of."""
    from ..projects import sprj
    from ..projects.traps import Traps

    traps = Traps(keep_going=True)
    found = _refused(lambda: sprj.read(path, traps))
    found = [Refusal(False, e.file, e.line, e.message) for e in traps.errors] + found
    return found + [Refusal(True, w.file, w.line, w.message) for w in traps.warnings]


def _refused(read) -> list[Refusal]:
    try:
        read()
    except ProjectError as error:
        return [Refusal(False, error.file, error.line, error.message)]
    return []
