"""What the checks take from the reader and the renderer, in one place."""

from __future__ import annotations

from pathlib import Path

from .. import native
from ..errors import HarnessError, ProjectError
from ..native import Program, Stage

try:
    from ..programs import SYSTEM_MACROS, declared_samplers
except ImportError:
    from ..prepare import SYSTEM_MACROS, declared_samplers

__all__ = ["STAGES", "SYSTEM_MACROS", "Refusal", "declared_samplers", "link", "refusals"]

#: type of a <shader> in the .sprj -> stage, as far as the native library has it, in the order of drawing
STAGES: dict[str, Stage] = {
    written: Stage[name]
    for written, name in (
        ("vs", "VERTEX"),
        ("tcs", "TESS_CONTROL"),
        ("tes", "TESS_EVALUATION"),
        ("gs", "GEOMETRY"),
        ("ps", "FRAGMENT"),
        ("cs", "COMPUTE"),
    )
    if name in Stage.__members__
}


def link(texts: dict[Stage, str]) -> Program:
    """The program of these stages. NativeError ``STAGE: LOG`` or ``link: LOG``."""
    native.open_context()
    if hasattr(Program, "of_stages"):
        return Program.of_stages(texts)
    return Program(texts[Stage.VERTEX], texts[Stage.FRAGMENT])


class Refusal(tuple):
    """(whether it is only a warning, file, line, message) of what the reader says about a project."""


def refusals(path: Path) -> list[Refusal]:
    """What ``harness render``'s reader refuses or warns of."""
    from .. import sprj

    try:
        from ..traps import Traps
    except ImportError:
        return _refused(lambda: sprj.read(path))
    traps = Traps(keep_going=True)
    found = _refused(lambda: sprj.read(path, traps))
    found = [Refusal((False, e.file, e.line, e.message)) for e in traps.errors] + found
    return found + [Refusal((True, w.file, w.line, w.message)) for w in traps.warnings]


def _refused(read) -> list[Refusal]:
    try:
        read()
    except (ProjectError, HarnessError) as error:
        return [Refusal((False, error.file, error.line, error.message))]
    return []
