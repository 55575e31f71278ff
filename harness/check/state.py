"""What the checks share: the project as its XML has it, what was found so far, and the compiled passes.

The .sprj is read element by element and not through ``harness.projects.sprj``: that reader stops at the first fault,
and a check goes on to the next.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ..language.glsl import Source, shown_path
from ..native import Program, Stage
from ..projects.xml_lines import Element
from .findings import Finding

TRUE = tuple("1tTyY")  # what a truth value begins with
DEFAULT_LAYOUT = ("Position", "Normal", "Texcoord")
#: types of items that draw something
DRAWN = ("geometry", "model", "vertexbuffer")


def flag(element: Element, name: str, default: bool = False) -> bool:
    """The truth value of an attribute."""
    return element.attributes[name].startswith(TRUE) if name in element.attributes else default


def child_text(element: Element, name: str, default: str = "") -> str:
    """The text of the last child of that name: the one that holds."""
    return next((c.text for c in reversed(element.children) if c.name == name), default)


def path_of(text: str) -> str:
    """A path as SHADERed takes it."""
    return text.replace("\\", "/")


@dataclass
class Bound:
    """An object given to a pass: its ``<object>`` and ``<bind>``. ``path`` is None for what is no file."""

    element: Element
    bind: Element
    slot: int
    name: str
    path: str | None


@dataclass
class PassState:
    """A pass that draws. ``layout`` has "" for a value that there is not. ``sources`` and ``program`` are there as far
    as its shaders compile."""

    element: Element
    name: str
    items: list[Element]
    layout: tuple[str, ...]
    bound: list[Bound] = field(default_factory=list)
    sources: dict[Stage, Source] = field(default_factory=dict)
    preprocessed: dict[Stage, str] = field(default_factory=dict)
    program: Program | None = None
    is_complete: bool = True  # whether all of its shaders have a source

    @property
    def variables(self) -> list[Element]:
        """The ``<variable>``s."""
        return self.element.nested("variables", "variable")

    @property
    def macros(self) -> list[Element]:
        """The active ``<define>``s."""
        return [d for d in self.element.nested("macros", "define") if flag(d, "active", True)]

    def kinds(self) -> set[str]:
        """What it draws: types of items."""
        return {item.attributes.get("type", "") for item in self.items if item.attributes.get("type") in DRAWN}


@dataclass
class State:
    """The project and what was found in it."""

    path: Path
    root: Element
    findings: list[Finding] = field(default_factory=list)
    passes: list[PassState] = field(default_factory=list)

    @property
    def folder(self) -> Path:
        """Where the project's paths start."""
        return self.path.parent

    @property
    def include_paths(self) -> list[Path]:
        """The project's include paths, in order; of several entries the last holds."""
        entries = [e for e in self.root.nested("settings", "entry") if e.attributes.get("type") == "ipaths"]
        return [self.folder / p.text for p in entries[-1].all("path")] if entries else []

    @property
    def include_dirs(self) -> list[Path]:
        """Where the text for the driver is pasted from, in order."""
        return [*self.include_paths, self.folder]

    @property
    def objects(self) -> list[Element]:
        """The ``<object>``s."""
        return self.root.nested("objects", "object")

    def file(self, relative: str) -> Path:
        """A file of the project. As in SHADERed, a leading slash does not lead out of its folder."""
        return Path(f"{self.folder}/{relative}")

    def add(
        self, code: str, at: Element | tuple[str, int | None], message: str, fix: str, severity: str | None = None
    ) -> None:
        """Adds a finding at an element of the .sprj or at (file, line), once."""
        file, line = (shown_path(self.path), at.line) if isinstance(at, Element) else at
        found = Finding(code, message, fix, file, line, severity)
        if found not in self.findings:
            self.findings.append(found)

    def has(self, at: tuple[str, int | None]) -> bool:
        """Whether something was found at (file, line)."""
        return any((f.file, f.line) == at for f in self.findings)
