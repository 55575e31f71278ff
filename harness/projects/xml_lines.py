"""XML as plain elements that know their line, read as SHADERed's parser (pugixml) would, but strictly.

Document types with declarations are refused outright, and entities with them: a few lines could grow to gigabytes.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from ..errors import ProjectError
from .traps import Traps

#: far beyond any project; a file of nothing but tags takes some hundred times its size in memory
MOST_BYTES, DEEPEST = 16 << 20, 64


@dataclass(eq=False)
class Element:
    """An element. ``text`` is its first run of characters that is not only white space, untrimmed, or ""."""

    name: str
    attributes: dict[str, str]
    file: str
    line: int
    text: str = ""
    children: list[Element] = field(default_factory=list)
    traps: Traps = field(default_factory=Traps, repr=False)

    def child(self, name: str) -> Element | None:
        """The first child of that name."""
        return next((child for child in self.children if child.name == name), None)

    def all(self, name: str) -> list[Element]:
        """The children of that name, in order."""
        return [child for child in self.children if child.name == name]

    def nested(self, outer: str, name: str) -> list[Element]:
        """The children ``name`` of the first child ``outer``; none when there is no such child."""
        found = self.child(outer)
        return found.all(name) if found else []

    def get(self, name: str, default: str = "") -> str:
        """The value of an attribute."""
        return self.attributes.get(name, default)

    def error(self, message: str) -> ProjectError:
        """The error ``message`` at this element's line."""
        return ProjectError(message, self.file, self.line)

    def warn(self, message: str) -> None:
        """Adds the warning ``message`` at this element's line."""
        self.traps.warn(message, self.file, self.line)


class _Builder:
    """Receives expat's events and builds the tree."""

    def __init__(self, file: str, traps: Traps):
        self.file = file
        self.traps = traps
        self.root: Element | None = None
        self.open: list[Element] = []
        self._run: list[str] = []
        self.parser = parser = expat.ParserCreate()
        parser.StartDoctypeDeclHandler = self._doctype
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._run.append
        # A comment ends a run of text, as it does for pugixml.
        parser.CommentHandler = lambda _: self._end_run()
        parser.ProcessingInstructionHandler = lambda *_: self._end_run()
        parser.StartCdataSectionHandler = parser.EndCdataSectionHandler = self._end_run

    def _error(self, message: str) -> ProjectError:
        return ProjectError(message, self.file, self.parser.CurrentLineNumber)

    def _doctype(self, name: str, system: str | None, public: str | None, has_declarations: int) -> None:
        if has_declarations:
            raise self._error("a document type with declarations (<!DOCTYPE ... [...]>) is not supported")

    def _end_run(self) -> None:
        text = "".join(self._run)
        self._run.clear()
        if self.open and not self.open[-1].text and text.strip():
            self.open[-1].text = text

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._end_run()
        if len(self.open) == DEEPEST:
            raise self._error(f"elements within elements, more than {DEEPEST} deep")
        element = Element(name, attributes, self.file, self.parser.CurrentLineNumber, traps=self.traps)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, _: str) -> None:
        self._end_run()
        self.open.pop()


def read_bytes(path: str | os.PathLike) -> bytes:
    """What is in an XML file. ProjectError when it is missing."""
    try:
        with open(Path(path), "rb") as opened:
            return opened.read(MOST_BYTES + 1)
    except OSError as error:
        raise ProjectError(f"cannot read the project: {error.strerror}", str(path)) from error


def parse(path: str | os.PathLike, traps: Traps | None = None, data: bytes | None = None) -> Element:
    """The root element of an XML file, or of ``data`` as if that were in it.

    ProjectError with file and line when it is missing, malformed or too large.
    """
    file = str(path)
    data = read_bytes(path) if data is None else data
    if len(data) > MOST_BYTES:
        raise ProjectError(f"a project of more than {MOST_BYTES >> 20} MiB", file)
    builder = _Builder(file, Traps() if traps is None else traps)
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as error:
        what = f"malformed XML: {expat.ErrorString(error.code)}"
        if builder.open:
            inner = builder.open[-1]
            what += f"; <{inner.name}> of line {inner.line} is not closed before this"
        raise ProjectError(what, file, error.lineno) from None
    except (ValueError, LookupError) as error:  # an encoding that Python does not know, or not as text
        raise ProjectError(f"malformed XML: {error}", file) from None
    assert builder.root is not None  # expat refuses a document without a root element
    return builder.root
