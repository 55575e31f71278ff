"""Calls GLSL functions by name on numpy arrays: ``shader("brdf.glsl").F_Schlick(F0, LoH)``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..errors import CallError, among
from ..language.glsl import shown_path
from . import library, overloads
from .function import Function, known_mode


def shader(
    path: str | Path,
    defines: Mapping[str, Any] | None = None,
    include_dirs: Sequence[str | Path] = (),
    mode: str = "as-written",
    *,
    isolated: bool = False,
    time_limit: float | None = None,
    memory_limit: int | None = None,
) -> Shader:
    """The functions of a GLSL file, callable by name.

    ``defines`` are macros, ``include_dirs`` the folders where includes are looked for, before those of the including
    file and of the first one. ``mode`` is one of ``dialect.MODES``. GlslError when it does not compile.

    ``isolated``: all of it is done in a process of its own, for code that may hang or crash the driver. To compile a
    function, and to evaluate a block of a batch, may each take ``time_limit`` seconds (60), and the process
    ``memory_limit`` bytes of memory (4 GiB); a HarnessError tells when they do not suffice, and the next call
    works again.
    """
    known_mode(mode)
    if not isolated:
        if time_limit is not None or memory_limit is not None:
            raise CallError("time_limit and memory_limit are kept in a process of its own only: isolated=True")
        return Shader(library.load(path, defines or {}, include_dirs), mode)
    from ..processes.worker import MEMORY_BYTES
    from .isolation import SECONDS, Worker  # few callers need it

    worker = Worker(time_limit or SECONDS, memory_limit or MEMORY_BYTES)
    loaded = worker.call("to read it", (shown_path(path),), library.load, path, defines or {}, include_dirs)
    return Shader(replace(loaded, engine=worker.evaluation), mode)


class Shader:
    """The functions of one GLSL file, as attributes and by ``[name]``, where ``["name(vec3, float)"]`` is one overload.

    Made by ``shader``.
    """

    def __init__(self, loaded: library.Library, mode: str):
        self._library, self._mode = loaded, known_mode(mode)
        self._functions = {
            name: Function(loaded, [s for s in loaded.signatures if s.name == name], mode)
            for name in dict.fromkeys(s.name for s in loaded.signatures)
        }

    @property
    def mode(self) -> str:
        """The arithmetic that its functions are evaluated in."""
        return self._mode

    def with_mode(self, mode: str) -> Shader:
        """The same functions, compiled in another mode."""
        return Shader(self._library, mode)

    def __getattr__(self, name: str) -> Function:
        if name.startswith("__"):  # what Python's own tools ask for
            raise AttributeError(name)
        return self[name]

    def __getitem__(self, name: str) -> Function:
        plain = overloads.named(name)
        if plain in self._functions:
            return self._functions[plain][name] if "(" in name else self._functions[plain]
        message = f"no function {plain}{among(plain, self._functions)}"
        raise _NoFunctionError(message, self._library.path)

    def __iter__(self):
        return iter(self._functions.values())

    def __dir__(self):
        return [*super().__dir__(), *self._functions]

    def _ipython_key_completions_(self) -> list[str]:
        return [*self._functions, *(overloads.key(s) for s in self._library.signatures)]

    def __repr__(self):
        return f"<shader {self._library.path}: {', '.join(self._functions)}>"


class _NoFunctionError(CallError, AttributeError):
    """An AttributeError too, so that hasattr() works."""
