"""XML as plain elements that know their line, read as SHADERed's parser (pugixml) would, but strictly.

Document type declarations are refused outright, and entities with them: a few lines could grow to gigabytes.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from .errors import ProjectError


@dataclass(eq=False)
class Element:
    """An element. ``text`` is its first run of characters that is not only white space, untrimmed, or ""."""

    name: str
    attributes: dict[str, str]
    file: str
    line: int
    text: str = ""
    children: list[Element] = field(default_factory=list)

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

    def error(self, message: str) -> ProjectError:
        """The error ``message`` at this element's line."""
        return ProjectError(message, self.file, self.line)


class _Builder:
    """Receives expat's events and builds the tree."""

    def __init__(self, file: str):
        self.file = file
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

    def _doctype(self, *_) -> None:
        raise ProjectError(
            "a document type declaration (<!DOCTYPE>) is not supported",
            self.file,
            self.parser.CurrentLineNumber,
        )

    def _end_run(self) -> None:
        text = "".join(self._run)
        self._run.clear()
        if self.open and not self.open[-1].text and text.strip():
            self.open[-1].text = text

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._end_run()
        element = Element(name, attributes, self.file, self.parser.CurrentLineNumber)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, _: str) -> None:
        self._end_run()
        self.open.pop()


def parse(path: str | os.PathLike) -> Element:
    """The root element of an XML file. ProjectError with file and line when it is missing or malformed."""
    file = str(path)
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise ProjectError(f"cannot read the project: {error.strerror}", file) from error
    builder = _Builder(file)
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as error:
        what = f"malformed XML: {expat.ErrorString(error.code)}"
        if builder.open:
            inner = builder.open[-1]
            what += f"; <{inner.name}> of line {inner.line} is not closed before this"
        raise ProjectError(what, file, error.lineno) from None
    except ValueError as error:  # e.g. an encoding that Python does not know
        raise ProjectError(f"malformed XML: {error}", file) from None
    assert builder.root is not None  # expat refuses a document without a root element
    return builder.root
