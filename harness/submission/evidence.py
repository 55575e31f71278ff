"""The evidence for a part of the exercise: lines of shaders, regions of the picture, tests that passed, costs."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from .. import ladder
from ..calling.call import shader
from ..costing import isa, spirv_cost
from ..costing.chips import TARGETS
from ..errors import HarnessError, among
from ..language.glsl_syntax import without_comments
from ..language.tokens import Text
from ..projects.project import Project
from ..rendering.render import Renderer
from ..trade import choices, file, markdown, stale, tables
from .exercise import Exercise, Quotation, Region

# ---- Lines of shaders ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Quoted:
    """Lines of a shader: a function with the comment above it, from line ``first`` of ``file`` on."""

    file: str
    first: int
    function_line: int
    lines: tuple[str, ...]
    signature: str

    @property
    def last(self) -> int:
        """Its last line."""
        return self.first + len(self.lines) - 1


def quote(exercise: Exercise, project: Project, quotation: Quotation) -> Quoted:
    """The lines of a function, where the compiler says that it is defined. HarnessError when there is none."""
    folder = project.file.parent
    defines = {}
    if quotation.pass_name:
        passes = {p.name: p for p in project.passes}
        if quotation.pass_name not in passes:
            raise exercise.error(f"no pass {quotation.pass_name}{among(quotation.pass_name, passes)}")
        defines = {macro.name: macro.value for macro in passes[quotation.pass_name].macros}
    function = shader(folder / quotation.file, defines, project.include_dirs)[quotation.function]
    file, line = function.origin
    text = Path(file).read_bytes().decode("utf-8-sig", errors="replace").replace("\r\n", "\n")
    first, last = _extent(text, quotation.function, line)
    lines = text.split("\n")
    comment = first
    while comment > 1 and lines[comment - 2].lstrip().startswith("//"):
        comment -= 1
    return Quoted(
        os.path.relpath(file, folder).replace(os.sep, "/"),
        comment,
        first,
        tuple(lines[comment - 1 : last]),
        str(function.signatures[0]),
    )


def _extent(text: str, name: str, line: int) -> tuple[int, int]:
    """First and last line of the definition of a function that the compiler sees in ``line``."""
    code = Text(without_comments(text))
    starts = [1]
    for token in code.tokens:
        starts.append(starts[-1] + token.text.count("\n"))
    for statement in code.statements():
        if statement.body is None or code[code.function_name(statement)] != name:
            continue
        if starts[statement.first] <= line <= starts[statement.last]:
            return starts[statement.first], starts[statement.last]
    return line, line  # made by a macro


# ---- Regions of the picture ------------------------------------------------------------------------------------------

#: at this size it is found out which pixels a pass changes
_LOOK = (640, 360)
_MARGIN = 0.015  # of the picture's width, around them


class Regions:
    """Where passes show: the pixels of the picture that each changes."""

    def __init__(self, exercise: Exercise, project: Project):
        self._exercise, self._project = exercise, project
        clear = np.round(np.clip(project.settings.clear_color[:3], 0, 1) * np.float64(255)).astype(np.uint8)
        self._until: dict[str | None, np.ndarray] = {None: np.broadcast_to(clear, (*_LOOK[::-1], 3))}

    def crop(self, picture: np.ndarray, region: Region) -> np.ndarray:
        """The part of the picture, (h, w, 4) uint8. ExerciseError when the pass changes nothing."""
        left, top, right, bottom = self.box(region.pass_name)
        width, height = right - left, bottom - top
        l, t, r, b = region.within  # noqa: E741
        h, w = picture.shape[:2]
        rows = slice(int((top + t * height) * h), max(int((top + b * height) * h), int((top + t * height) * h) + 1))
        columns = slice(int((left + l * width) * w), max(int((left + r * width) * w), int((left + l * width) * w) + 1))
        return picture[rows, columns]

    def box(self, name: str) -> tuple[float, float, float, float]:
        """Left, top, right and bottom in 0...1."""
        names = [p.name for p in self._project.passes]
        if name not in names:
            raise self._exercise.error(f"no pass {name}{among(name, names)}")
        place = names.index(name)
        before = self._picture(names[place - 1] if place else None)
        changed = (self._picture(name) != before).any(axis=2)
        if not changed.any():
            raise self._exercise.error(f'pass "{name}" changes nothing in the picture, so no region shows it')
        rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
        width, height = _LOOK
        margin = _MARGIN, _MARGIN * width / height
        return (
            max(columns[0] / width - margin[0], 0.0),
            max(rows[0] / height - margin[1], 0.0),
            min((columns[-1] + 1) / width + margin[0], 1.0),
            min((rows[-1] + 1) / height + margin[1], 1.0),
        )

    def _picture(self, until: str | None) -> np.ndarray:
        if until not in self._until:
            renderer = Renderer(self._project.file, _LOOK, until_pass=until)
            renderer.draw()
            self._until[until] = renderer.picture()[..., :3]
        return self._until[until]


# ---- Tests -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class TestResult:
    """What became of a test, or of many: how many cases passed and how many were skipped."""

    passed: int
    skipped: int


class TestResults:
    """What pytest said of each test."""

    def __init__(self, counts: Mapping[str, Counter]):
        self._counts = counts

    @property
    def all(self) -> TestResult:
        """All tests together."""
        total = sum(self._counts.values(), Counter())
        return TestResult(total["passed"], total["skipped"])

    def of(self, exercise: Exercise, test: str) -> TestResult:
        """Of FILE::FUNCTION, all its cases. ExerciseError when none of them passed: what did not run shows nothing."""
        counts = self._counts.get(test, Counter())
        if not counts["passed"]:
            why = "skipped here" if counts["skipped"] else f"not among those of {', '.join(exercise.tests)}"
            raise exercise.error(f"the test {test} is {why}, so it is no evidence")
        return TestResult(counts["passed"], counts["skipped"])


def run_tests(exercise: Exercise, folder: Path) -> TestResults:
    """Runs the tests of the exercise by pytest. HarnessError with the end of what it says when one fails."""
    if not exercise.tests:
        raise exercise.error("it names no tests to run; --no-tests packs without")
    with tempfile.TemporaryDirectory() as temporary:
        report = Path(temporary) / "junit.xml"
        options = [
            "-q",
            "-p",
            "no:cacheprovider",
            "--rootdir",
            ".",
            "-o",
            "junit_family=xunit1",
            f"--junitxml={report}",
        ]
        command = [sys.executable, "-m", "pytest", *exercise.tests, *options]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if done.returncode:
            said = "\n".join((done.stdout + done.stderr).strip().splitlines()[-20:])
            raise HarnessError(f"the tests fail, so nothing is packed:\n{said}")
        counts: dict[str, Counter] = {}
        for case in ElementTree.parse(report).iter("testcase"):
            name = f"{case.get('file')}::{case.get('name', '').partition('[')[0]}"
            counts.setdefault(name, Counter())["passed" if case.find("skipped") is None else "skipped"] += 1
    return TestResults(counts)


def check_tests_exist(exercise: Exercise, folder: Path) -> None:
    """ExerciseError for a test of a part that is not in its file, whether tests are run or not."""
    for test in (test for part in exercise.parts for test in part.tests):
        file, _, name = test.partition("::")
        path = folder / file
        if not path.is_file() or f"def {name}(" not in path.read_text():
            raise exercise.error(f"there is no test {test}")


# ---- Costs -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Costs:
    """``rows`` are (label, a number for each of ``columns``); ``driver`` is None without one."""

    columns: Sequence[str]
    rows: Sequence[tuple[str, Sequence[str]]]
    driver: str | None


def costs(exercise: Exercise, folder: Path) -> Costs | None:
    """Cycles a wave of 64 on each chip, and weighted SPIR-V operations; None when no costs are asked for."""
    if not exercise.costs:
        return None
    functions = [shader(folder / row.file, row.defines)[row.function] for row in exercise.costs]
    columns, numbers, driver = (
        ["SPIR-V operations, weighted"],
        [[f"{spirv_cost.weighted_count(f):g}"] for f in functions],
        None,
    )
    if isa.unavailable() is None:
        for target in TARGETS:
            columns.append(f"{target}, cycles")
            for row, cost in zip(numbers, isa.costs(functions, target), strict=True):
                row.append(str(cost.inverse_throughput))
                driver = cost.driver
    return Costs(columns, [(row.label, cells) for row, cells in zip(exercise.costs, numbers, strict=True)], driver)


# ---- The trade -------------------------------------------------------------------------------------------------------

#: beside the project: what `harness trade` measured
TRADE = "build/trade/trade.json"


@dataclass(frozen=True)
class Trade:
    """The presets of the shading model, what each costs and how wrong it is; ``legend`` says what the columns are."""

    table: tables.Table
    legend: str
    machine: str


def trade(project: Project, progress: Callable[[str], None] = lambda said: None) -> Trade | None:
    """What was measured of a project last; None when that was nothing, or of other shaders, which ``progress`` is told.

    HarnessError when the file is no trade.
    """
    path = project.file.parent / TRADE
    if not path.is_file():
        return None
    data = file.read(path)
    others = stale.differences(data, choices.choices(project, ladder.of_project(project)))
    if others:
        progress(f"leaving out {TRADE}, which is not of these shaders ({others[0]}): `make trade` measures them")
        return None
    return Trade(tables.summary(data, data["presets"]), markdown.legend(data), markdown.machine(data))
