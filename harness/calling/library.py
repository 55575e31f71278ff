"""A GLSL file as it was loaded: what it was loaded with, the text for the compiler, and the functions in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from .. import native
from ..language import comments, dialect, glsl, rewrite
from ..language.signature import Signature, signatures
from ..native import Stage
from .engine import engine


@dataclass(frozen=True, eq=False)
class Library:
    """The functions of a file.

    ``engine`` makes what evaluates a function in a mode, here or elsewhere; ``compiled`` keeps that, by both.
    """

    defines: Mapping[str, str]
    include_dirs: Sequence[str]
    source: glsl.Source
    signatures: Sequence[Signature]
    engine: Callable[[glsl.Source, Signature, str], Any] = engine
    compiled: dict[tuple, Any] = field(default_factory=dict)

    def __getstate__(self):
        """Without what was compiled, and with the engine of this process: a worker process compiles for itself."""
        return self.__dict__ | {"compiled": {}, "engine": engine}

    @property
    def path(self) -> str:
        """The file, as a user likes to read it."""
        return self.source.path

    @cached_property
    def comments(self) -> dict[Signature, str]:
        """The comment directly above each function, "" where there is none."""
        return comments.above(self.signatures)


def load(path: str | Path, defines: Mapping[str, Any], include_dirs: Sequence[str | Path]) -> Library:
    """Reads a file, its includes and its signatures. GlslError when it does not compile."""
    path = Path(path)
    macros = {name: str(text) for name, text in defines.items()}
    source = glsl.load(path, macros, [*include_dirs, path.parent], version=glsl.VERSION, library=True)
    try:
        text = rewrite.isolate(native.glsl_preprocess(Stage.FRAGMENT, source.text))
    except native.NativeError as error:
        raise source.error(str(error)) from None
    plain = replace(source, text=text, written=source.text)
    functions = signatures(dialect.checked(plain), rewrite.struct_names(text), rewrite.result_names(text))
    return Library(macros, [str(folder) for folder in include_dirs], plain, functions)
