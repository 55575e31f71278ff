"""GLSL text: pastes includes, inserts macros, and keeps for every line of the result where it came from.

What is done to the text is what SHADERed does before it hands a shader to the driver, so both see the same program.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .. import native
from ..errors import GlslError, NativeError
from ..native import Stage

VERSION = "#version 330"  # given to files that state none: libraries, which are meant to be included

# As SHADERed: in column 0, "x" and <x> alike, whatever follows the closing mark.
_INCLUDE = re.compile(r'#include\s+(?:"([^"]+)"|<([^>]+)>)')
_LIBRARY_INCLUDE = re.compile(r'[ \t]*#[ \t]*include\s*(?:"([^"]+)"|<([^>]+)>)')
_NAMELESS_INCLUDE = re.compile(r'[ \t]*#[ \t]*include\s*(?:""|<>)')
_GLSLANG_LINE = re.compile(r"^(?:ERROR|WARNING): (?:\d+|[^:]*):(\d+): (.*)$")
_DRIVER_LINE = re.compile(r"^\d+[:(](\d+)(?:\(\d+\)\s*:|\)\s*:|:)\s*(.*)$")

ERRORS_SHOWN = 5  # of one compilation: what follows is mostly their consequence


@dataclass(frozen=True)
class Source:
    """A shader as the compiler gets it. Line n of ``text`` (from 1) came from ``origins[n - 1]``, a (file, line)."""

    path: str
    text: str
    origins: tuple[tuple[str, int], ...]
    #: line of ``text`` -> what to say of the include that was not found there, should the compiler reach it
    missing_includes: Mapping[int, str] = field(default_factory=dict)
    #: the same lines as the user wrote them, where ``text`` was rewritten
    written: str | None = None

    def origin(self, line: int) -> tuple[str, int]:
        """File and line that line ``line`` of ``text`` came from."""
        return self.origins[min(max(line, 1), len(self.origins)) - 1]

    def error(self, log: str) -> GlslError:
        """The error that a compiler's log about ``text`` amounts to, in the user's files and lines."""
        found = list(_messages(log))
        for line, _ in found:
            if line in self.missing_includes:
                return GlslError(self.missing_includes[line], *self.origin(line))
        found = [(line, message) for line, message in found if line > 0]  # 0: a linker's, of no line
        if not found:
            return GlslError(log.strip(), self.path)
        lines = (self.written or self.text).split("\n")
        shown = []
        for line, message in found[:ERRORS_SHOWN]:
            file, number = self.origin(line)
            quoted = lines[min(line, len(lines)) - 1].strip()
            shown.append(f"{file}:{number}: {message}\n    {quoted}")
        if len(found) > ERRORS_SHOWN:
            shown.append(f"... and {len(found) - ERRORS_SHOWN} more")
        file, number = self.origin(found[0][0])
        return GlslError("\n".join(shown).removeprefix(f"{file}:{number}: "), file, number)

    def errors(self, log: str) -> list[tuple[int, str]]:
        """Each error of that log by itself: (line of ``text``, what the compiler says), 0 for a linker's of no line."""
        return list(_messages(log)) or [(0, log.strip())]


def _messages(log: str) -> Iterator[tuple[int, str]]:
    """(line of the text, message) of each error in a log of glslang or of a driver, each once."""
    seen = set()
    for text in log.splitlines():
        match = _GLSLANG_LINE.match(text) or _DRIVER_LINE.match(text)
        if not match or text.startswith("WARNING") or match[2].startswith("warning"):
            continue
        entry = int(match[1]), match[2].removeprefix("error: ").removeprefix("'' : ").strip()
        if entry not in seen and "compilation terminated" not in entry[1]:
            seen.add(entry)
            yield entry


def shown_path(path: str | Path) -> str:
    """A path as a user likes to read it: relative where it lies below the current folder."""
    relative = os.path.relpath(path)
    return str(path) if relative.startswith("..") else relative


def _read(path: Path) -> list[str]:
    text = path.read_bytes().decode("utf-8-sig", errors="replace")
    lines = text.replace("\r\n", "\n").split("\n")
    return lines[:-1] if lines and not lines[-1] else lines


def _joined(lines: list[str]) -> list[str]:
    """The lines with those that end in a backslash joined to the next, which leaves its place empty.

    GLSL knows such lines from 4.20 on only, but drivers take them in all versions, and glslang refuses them below.
    """
    joined = list(lines)
    for k in range(len(lines) - 1, 0, -1):
        if lines[k - 1].endswith("\\"):
            joined[k - 1] = lines[k - 1][:-1] + joined[k]
            joined[k] = ""
    return joined


def _paste(
    path: Path, include_dirs: Sequence[Path], library: bool, within: tuple[Path, ...]
) -> Iterator[tuple[str, tuple[str, int], str | None]]:
    """Lines of a file with its includes pasted: (text, origin, what to say if the compiler reaches this include)."""
    included = set()
    folders = [*include_dirs, path.parent] if library else include_dirs
    pattern = _LIBRARY_INCLUDE if library else _INCLUDE
    lines, shown = _read(path), shown_path(path)
    for number, text in enumerate(_joined(lines) if library else lines, 1):
        origin = shown, number
        match = pattern.match(text)
        if _NAMELESS_INCLUDE.match(text):
            yield "#error no name", origin, "an include without a name"  # glslang 12 aborts on it
            continue
        if not match:
            yield text, origin, None
            continue
        name = match[1] or match[2]
        # os.path: pathlib raises for a name that no file system takes
        target = next((d / name for d in folders if os.path.isfile(d / name)), None)
        if target is None:
            looked = ", ".join(shown_path(d) + os.sep for d in dict.fromkeys(folders))
            # Left as it is, glslang would look for it by itself, in the current folder.
            yield "#error no such file", origin, f'cannot find the included file "{name}" (looked in {looked})'
        elif target in included or target.resolve() in within:
            # SHADERed drops the second include of a file from the text of one; a circle would never end.
            yield "", origin, None
        else:
            included.add(target)
            yield from _paste(target, include_dirs, library, (*within, target.resolve()))


def load(
    path: str | Path,
    defines: Mapping[str, str] | None = None,
    include_dirs: Sequence[str | Path] = (),
    *,
    version: str | None = None,
    library: bool = False,
) -> Source:
    """The shader in a file, ready for a compiler.

    ``defines`` maps macro names (or ``F(x)``) to their text; they go in after the #version line. Includes are looked
    for in ``include_dirs``, in order, as SHADERed does. A ``library`` may expect more: its includes are looked for
    beside the including file too and may be indented, and its lines may go on after a backslash. A file without
    #version gets ``version``; where that is None, it is an error. GlslError when the file cannot be read or does not
    begin with #version.
    """
    path = Path(path)
    try:
        lines = list(_paste(path, [Path(d) for d in include_dirs], library, (path.resolve(),)))
    except OSError as error:
        raise GlslError(f"cannot read the shader: {error.strerror}", error.filename or path) from error
    macros = [
        (f"#define {name} {text}".rstrip(), ("macros", n), None)
        for n, (name, text) in enumerate((defines or {}).items(), 1)
    ]
    first = next((n for n, (text, _, _) in enumerate(lines) if text.strip()), 0)  # blank lines may stand above it
    if lines and lines[first][0].lstrip().startswith("#version"):
        lines[first + 1 : first + 1] = macros
    elif version is None:
        raise GlslError("a shader must begin with its #version, and nothing may stand above it", shown_path(path), 1)
    else:
        lines[:0] = [(version, (shown_path(path), 1), None), *macros]
    return Source(
        path=shown_path(path),
        text="\n".join(text for text, _, _ in lines) + "\n",
        origins=tuple(origin for _, origin, _ in lines),
        missing_includes={n: what for n, (_, _, what) in enumerate(lines, 1) if what},
    )


def check(stage: Stage, source: Source, *, spirv: bool = False) -> None:
    """Raises GlslError when glslang refuses the shader; ``spirv`` asks for the stricter rules of SHADERed's check."""
    try:
        native.glsl_check(stage, source.text, spirv=spirv)
    except NativeError as error:
        raise source.error(str(error)) from None


def link(vertex: Source, fragment: Source) -> native.Program:
    """The program of two stages, refused by glslang first and by the driver second. GlslError names file and line."""
    return link_stages({Stage.VERTEX: vertex, Stage.FRAGMENT: fragment})


def link_stages(stages: Mapping[Stage, Source]) -> native.Program:
    """The program of these stages, to draw with or to dispatch, refused as by ``link``."""
    for stage, source in stages.items():
        check(stage, source, spirv=True)
    drawn = [stage for stage in _UPSTREAM if stage in stages]
    if Stage.FRAGMENT in stages:
        _check_varyings(drawn[-1], stages[drawn[-1]], stages[Stage.FRAGMENT])
    try:
        return native.Program.of_stages({stage: source.text for stage, source in stages.items()})
    except NativeError as error:
        name, _, log = str(error).partition(": ")
        for stage, source in stages.items():
            if name == stage.name.lower():
                raise source.error(log) from None
        last = stages.get(Stage.FRAGMENT) or next(iter(stages.values()))
        others = " and ".join(source.path for source in stages.values() if source is not last)
        with_others = f" with {others}" if others else ""
        raise GlslError(f"does not link{with_others}: {log.strip()}", last.path) from None


#: stages before the fragment stage, in order
_UPSTREAM = (Stage.VERTEX, Stage.TESS_CONTROL, Stage.TESS_EVALUATION, Stage.GEOMETRY)


# In glslang's syntax tree: what a stage reads or declares, with the line where.
_VARYING = re.compile(r"^0:(\S+) +'(\w+)' \( (?:\w+ )*?(in|out) ", re.MULTILINE)
_WRITTEN = re.compile(r"^0:\S+ +'(\w+)' \((?:layout\([^)]*\))? (?:\w+ )*?out ", re.MULTILINE)
_INTERPOLATED = re.compile(r"'\w+' \( (?:smooth|flat|noperspective|centroid|sample) ")


def _check_varyings(stage: Stage, before: Source, fragment: Source) -> None:
    """Refuses a fragment input that the stage before lacks: Mesa links it where it is read, and draws any colour."""
    written = {m[1] for m in _WRITTEN.finditer(native.glsl_tree(stage, before.text))}
    body, _, _ = native.glsl_tree(Stage.FRAGMENT, fragment.text).partition("Linker Objects")
    for line in body.splitlines():
        match = _VARYING.match(line)
        if match and match[3] == "in" and _INTERPOLATED.search(line) and match[2] not in written:
            where = fragment.origin(int(match[1])) if match[1].isdigit() else (fragment.path, None)
            raise GlslError(f'reads "{match[2]}", which {before.path} does not write', *where)
