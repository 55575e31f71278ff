"""Checks #include: the two compilers of SHADERed find and take includes by different rules, and both must succeed.

The driver's text is pasted line by line before any preprocessing, from the include paths and then the project's folder;
glslang's preprocessor looks in the project's folder, the include paths from the last on, and beside the shader.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import NativeError
from ..language.glsl import shown_path
from ..native import Stage
from . import renderer
from .state import State

_PASTED = re.compile(r'#include\s+(?:"([^"]+)"|<([^>]+)>)')
_ANY = re.compile(r'[ \t]*#[ \t]*include\b[ \t]*(?:"([^"]*)"|<([^>]*)>|)')
_EXTENSION = re.compile(r"\s*#\s*extension\s+(\w+)\s*:\s*(\w+)")
_GUARD = re.compile(r"\s*#\s*if(def)?\b.*\bGL_GOOGLE_include_directive\b")
_MARK = "HN_INCLUDE_"
EXTENSION = "GL_GOOGLE_include_directive"
DEEPEST = 32  # of includes within includes; deeper only in a circle


@dataclass(frozen=True)
class _Include:
    """An #include of a file, whatever its form. ``driver`` and ``glslang``: the files that they find."""

    at: tuple[str, int]
    name: str
    is_pasted: bool
    is_cut_off: bool  # the last line of its file, without an end
    driver: Path | None
    glslang: Path | None
    earlier: int | None  # index of the first include of the same file in the same file


class _Expansion:
    """A shader's text with a mark before what each include brings in."""

    def __init__(self, state: State, path: Path):
        self.driver_dirs = state.include_dirs
        self.glslang_dirs = [state.folder, *reversed(state.include_paths), path.parent]
        self.includes: list[_Include] = []
        self.with_bom: list[str] = []
        self.lines = list(self._expand(path, 0))

    def _expand(self, path: Path, depth: int) -> Iterator[str]:
        try:
            data = path.read_bytes()
        except OSError:
            return
        if depth and data.startswith(b"\xef\xbb\xbf"):
            self.with_bom.append(shown_path(path))
        lines = data.decode("utf-8-sig", errors="replace").replace("\r\n", "\n").split("\n")
        first: dict[Path, int] = {}
        for number, text in enumerate(lines, 1):
            match = _ANY.match(text)
            if not match:
                yield text
                continue
            name = match[1] or match[2] or ""
            driver, glslang = _find(name, self.driver_dirs), _find(name, self.glslang_dirs)
            index = len(self.includes)
            self.includes.append(
                _Include(
                    (shown_path(path), number),
                    name,
                    bool(_PASTED.match(text)),
                    number == len(lines),
                    driver,
                    glslang,
                    first.get(driver) if driver else None,
                )
            )
            yield f"{_MARK}{index}"
            target = driver or glslang
            if target and depth < DEEPEST and first.setdefault(target, index) == index:
                yield from self._expand(target, depth + 1)


def _find(name: str, folders: list[Path]) -> Path | None:
    return next((f / name for f in folders if os.path.isfile(f / name)), None)


def check(state: State, stage: Stage, path: Path, defines: Mapping[str, str]) -> bool:
    """Checks the includes that a shader reaches; whether both compilers see the text that was meant."""
    expansion = _Expansion(state, path)
    if not expansion.includes:
        return True
    reached = _reached(stage, expansion.lines, defines)
    fine = True
    for index, include in enumerate(expansion.includes):
        # glslang crashes on an empty name, so that one may stand nowhere.
        is_seen = index in reached or not include.name
        wrong = _wrong(state, include, reached.get(index, ""), reached) if is_seen else None
        if wrong:
            state.add(wrong[0], include.at, *wrong[1:])
            fine = False
    for file in expansion.with_bom:
        fine = False
        state.add(
            "HS109",
            (file, 1),
            "the included file begins with a byte order mark, on which the driver fails",
            "save it as UTF-8 without BOM",
        )
    _check_guard(state, path)
    return fine


def _reached(stage: Stage, lines: list[str], defines: Mapping[str, str]) -> dict[int, str]:
    """Index of each include that the preprocessor reaches -> how the extension stands there, "" without a word."""
    macros = [f"#define {name} {value}" for name, value in defines.items()]
    # Nothing but the preprocessor sees this, so the marks may stand where no declaration may.
    text = "\n".join([lines[0], *macros, *lines[1:]]) + "\n"
    try:
        text = renderer.preprocess(stage, text)
    except NativeError:
        pass  # the compilers say why; until then every include counts
    reached, behaviour = {}, ""
    for line in text.split("\n"):
        extension = _EXTENSION.match(line)
        if extension and extension[1] == EXTENSION:
            behaviour = extension[2]
        for mark in re.findall(rf"\b{_MARK}(\d+)\b", line):
            reached[int(mark)] = behaviour
    return reached


def _wrong(state: State, include: _Include, behaviour: str, reached: Mapping[int, str]) -> tuple[str, str, str] | None:
    """(code, message, fix) of what is wrong with an include that is reached, the extension standing as it does."""
    name = include.name
    if not name:
        return "HS107", "this #include names no file", 'write #include "FILE"'
    if include.driver is None and include.glslang is None:
        looked = ", ".join(dict.fromkeys(shown_path(d) + os.sep for d in state.include_dirs))
        return (
            "HS107",
            f'cannot find the included file "{name}" (looked in {looked})',
            "correct the path: it is relative to the .sprj, or to one of its include paths",
        )
    if include.driver is None:
        folder = os.path.relpath(include.glslang.parent, state.folder)
        relative = os.path.relpath(include.glslang, state.folder)
        return (
            "HS108",
            f'"{name}" lies beside the shader, where glslang finds it; the text for the driver loses the line',
            f'write #include "{relative}", or add the include path {folder} to the settings',
        )
    if not os.path.samefile(include.driver, include.glslang):
        return (
            "HS108",
            f'"{name}" is {shown_path(include.driver)} for the driver and {shown_path(include.glslang)} for glslang',
            "give the two files different names, or write the path from the project's folder",
        )
    if not include.is_pasted:
        return (
            "HS109",
            f'the #include of "{name}" is not pasted for the driver: it must be exactly #include, in column 0',
            f'write #include "{name}" at the beginning of the line',
        )
    if include.is_cut_off:
        return (
            "HS109",
            f'the #include of "{name}" is the last line and has no end, which glslang refuses',
            "end the file with a new line",
        )
    if behaviour not in ("enable", "warn"):
        how = f"behind #extension {EXTENSION} : {behaviour}" if behaviour else f"without #extension {EXTENSION}"
        refuses = "the driver refuses that" if behaviour == "require" else "glslang refuses that"
        return (
            "HS109",
            f'the #include of "{name}" stands {how}: {refuses}',
            f"put below #version: #ifdef {EXTENSION}, #extension {EXTENSION} : enable, #endif, a line each",
        )
    if include.earlier is not None and include.earlier not in reached:
        return (
            "HS109",
            f'this second #include of "{name}" in the file is removed from the driver\'s text, and the first is '
            "under a false #if",
            "include it once, outside of #if",
        )
    return None


def _check_guard(state: State, path: Path) -> None:
    lines = path.read_bytes().decode("utf-8-sig", errors="replace").split("\n")
    for number, text in enumerate(lines, 1):
        match = _EXTENSION.match(text)
        if not match or match[1] != EXTENSION:
            continue
        above = next((t for t in reversed(lines[: number - 1]) if t.strip()), "")
        if not _GUARD.match(above):
            state.add(
                "HS110",
                (shown_path(path), number),
                f"#extension {EXTENSION} is not guarded",
                f"put #ifdef {EXTENSION} above it and #endif below it",
            )
