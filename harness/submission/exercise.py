"""The exercise's parts, their points and the evidence for each, from docs/exercise.toml beside the project."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import HarnessError

FILE = "docs/exercise.toml"


class ExerciseError(HarnessError):
    """docs/exercise.toml is missing or malformed, or names evidence that there is not."""


@dataclass(frozen=True)
class Region:
    """Where a pass shows in the picture. ``within`` is a part of that: left, top, right, bottom, in 0...1."""

    pass_name: str
    caption: str
    within: tuple[float, float, float, float]


@dataclass(frozen=True)
class Quotation:
    """A function of a shader file, as a pass compiles it; "" is no pass, and no macros."""

    file: str
    function: str
    pass_name: str


@dataclass(frozen=True)
class Part:
    """A part of the exercise: what is ``asked`` for ``points`` and what was ``done``. ``tests`` are as pytest names
    them, without parameters: FILE::FUNCTION."""

    name: str
    title: str
    points: int
    asked: str
    done: str
    regions: tuple[Region, ...]
    quotations: tuple[Quotation, ...]
    tests: tuple[str, ...]


@dataclass(frozen=True)
class CostRow:
    """A function to say the cost of, with the macros that make it a rung."""

    label: str
    file: str
    function: str
    defines: Mapping[str, str]


@dataclass(frozen=True)
class Exercise:
    """All of the file. ``tests`` are the files and folders whose tests must pass."""

    title: str
    course: str
    summary: str
    alt: str
    tests: tuple[str, ...]
    parts: tuple[Part, ...]
    costs: tuple[CostRow, ...]
    path: Path

    @property
    def points(self) -> int:
        """Of all parts."""
        return sum(part.points for part in self.parts)

    def error(self, message: str) -> ExerciseError:
        """An error in what the file says."""
        return ExerciseError(message, self.path)


def read(project: Path) -> Exercise:
    """The exercise of a project. ExerciseError when the file is missing or malformed."""
    path = project.parent / FILE
    try:
        table = _Table(tomllib.loads(path.read_text()), path, "it")
    except OSError as error:
        raise ExerciseError(
            f"cannot read the exercise's parts and the evidence for each ({error.strerror})", path
        ) from error
    except ValueError as error:
        raise ExerciseError(f"malformed TOML: {error}", path) from None
    return Exercise(
        table.get("title", str),
        table.get("course", str),
        table.get("summary", str),
        table.get("alt", str),
        tuple(table.get("tests", list, [])),
        tuple(_part(entry) for entry in table.tables("part")),
        tuple(_cost(entry) for entry in table.tables("cost")),
        path,
    )


def _part(table: _Table) -> Part:
    part = Part(
        table.get("name", str),
        table.get("title", str),
        table.get("points", int),
        table.get("asked", str),
        table.get("done", str),
        tuple(
            Region(t.get("pass", str), t.get("caption", str), t.box("within", (0.0, 0.0, 1.0, 1.0)))
            for t in table.tables("region")
        ),
        tuple(
            Quotation(t.get("file", str), t.get("function", str), t.get("pass", str, ""))
            for t in table.tables("shader")
        ),
        tuple(table.get("tests", list, [])),
    )
    for test in part.tests:
        if not isinstance(test, str) or not re.fullmatch(r"[^:]+\.py::\w+", test):
            raise ExerciseError(f'"{test}" is not a test of the form FILE.py::FUNCTION', table.path)
    return part


def _cost(table: _Table) -> CostRow:
    return CostRow(
        table.get("label", str), table.get("file", str), table.get("function", str), table.get("defines", dict, {})
    )


_NAMES = {str: "a text", int: "a whole number", list: "a list", dict: "a table"}
_REQUIRED = object()


@dataclass(frozen=True)
class _Table:
    """A table of the file, whose values are looked at when they are taken."""

    values: dict[str, Any]
    path: Path
    what: str

    def get(self, key: str, kind: type, default: Any = _REQUIRED) -> Any:
        value = self.values.get(key, default)
        if value is default and default is not _REQUIRED:
            return default
        if type(value) is not kind:
            lacks = "lacks" if value is _REQUIRED else "must have"
            raise ExerciseError(f"{self.what} {lacks} {key} = {_NAMES[kind]}", self.path)
        return value

    def tables(self, key: str) -> list[_Table]:
        entries = self.get(key, list, [])
        if not all(isinstance(entry, dict) for entry in entries):
            raise ExerciseError(f"{self.what} must have {key} = a list of tables", self.path)
        return [_Table(entry, self.path, f"[[{key}]] number {n}") for n, entry in enumerate(entries, 1)]

    def box(self, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        box = self.get(key, list, list(default))
        numbers = len(box) == 4 and all(isinstance(n, int | float) for n in box)
        if not numbers or not (0 <= box[0] < box[2] <= 1 and 0 <= box[1] < box[3] <= 1):
            raise ExerciseError(f"{self.what}: {key} = {box} is not left, top, right, bottom in 0...1", self.path)
        return tuple(float(n) for n in box)
