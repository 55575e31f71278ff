"""Is a test suite any good? Makes mutants of a GLSL file and runs the tests that use it against each.

``mutate`` runs the tests once on the file as it is, and learns by it which tests use what of the file and under which
macros it is compiled; then it makes the mutants, drops those that do not compile or come to the same code, and runs the
rest in parallel, each against the tests that can notice it, until one fails.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..errors import GlslError, HarnessError
from ..language import glsl
from ..processes import jobs
from . import mutate_project
from .mutants import Mutant, mutants
from .mutate_equivalents import Equivalents
from .mutate_recorder import ANY
from .mutate_variants import Loaded, Variant, active_text, different

#: a test may take so many times as long as on the unchanged file, and so many seconds more
PATIENCE, SECONDS_MORE = 5, 20

_TOGETHER = 8  # mutants that go to a worker at once: of one function, for what killed one is likely to kill the next


@dataclass(frozen=True)
class Result:
    """What became of a mutant.

    ``status``: killed, timeout or survived; invalid (does not compile), same (the same code), equivalent (listed as
    such, not run). ``by`` is the test that noticed. ``tests`` counts those that can reach it.
    """

    mutant: Mutant
    status: str
    by: str | None = None
    tests: int = 0


@dataclass(frozen=True)
class _Test:
    name: str
    seconds: float
    uses: tuple[tuple[Any, str], ...]


@dataclass(frozen=True)
class _Task:
    """A mutant for a worker: the whole text, and (name, seconds) of the tests, the likeliest first."""

    text: str
    tests: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class _Chunk:
    """Mutants for a worker. ``original`` is the file's text here, which the worker's must be equal to."""

    project: mutate_project.Project
    original: str
    warm: bool
    tasks: tuple[_Task, ...]


class Mutation:
    """The mutants of a file, as its tests compile it. Making one runs the tests on the unchanged file.

    ``results`` has one entry a mutant, in the order of the text; ``run`` fills in those that are to be run.
    HarnessError when the tests fail on the unchanged file, or none uses it.
    """

    def __init__(
        self,
        file: str | Path,
        tests: Sequence[str | Path] = (),
        only: str | None = None,
        equivalents: Equivalents | None = None,
    ):
        self.project = mutate_project.find(file, tests)
        self.path = glsl.shown_path(file)
        self._file = Path(self.project.root, self.project.file)
        self.text = _read(self._file)
        self._tests, loaded, self._warm = _clean_run(self.project, self.path)
        self._variants = self._loaded_variants(loaded)
        self._standing = different(self._variants)
        found = self._all_mutants()
        listed = equivalents.of(self._file.name, self.text, [m for m, _ in found]) if equivalents else set()
        if only is not None:
            found = [(m, places) for m, places in found if m.function == only]
            if not found:
                raise HarnessError(f"no mutants in a function {only}", self.path)
        self._relevant: dict[str, list[_Test]] = {}
        self.results = [self._first_result(mutant, places, listed) for mutant, places in found]

    def _loaded_variants(self, loaded: list[Loaded]) -> list[Variant]:
        if not loaded:  # by other means than ours: the file by itself is all that is known
            source = glsl.load(self._file, {}, [self._file.parent], version=glsl.VERSION)
            name = glsl.shown_path(self._file)
            places = [(n, m) for n, (file, m) in enumerate(source.origins, 1) if file == name]
            loaded = [Loaded(source.text, tuple(places))]
        return [Variant(one, self.text) for one in loaded]

    def _all_mutants(self) -> list[tuple[Mutant, set[int]]]:
        """Each mutant, with the variants that its line takes part in."""
        found: dict[tuple, tuple[Mutant, set[int]]] = {}
        for n in dict.fromkeys(self._standing):
            for mutant in mutants(self.text, active_text(self.text, self._variants[n])):
                found.setdefault(mutant.edits, (mutant, set()))[1].add(n)
        return sorted(found.values(), key=lambda pair: (pair[0].line, pair[0].column))

    def _first_result(self, mutant: Mutant, places: set[int], listed: set[str]) -> Result:
        text = mutant.apply(self.text)
        outcomes = {n: self._variants[n].outcome(text) for n in sorted(places)}
        if "invalid" in outcomes.values():
            return Result(mutant, "invalid")
        differing = {n for n, outcome in outcomes.items() if outcome == "differs"}
        if not differing:
            return Result(mutant, "same")
        tests = [test for test in self._tests if self._can_notice(test, mutant, differing)]
        self._relevant[mutant.id] = tests
        status = "equivalent" if mutant.id in listed else "survived" if not tests else "to run"
        return Result(mutant, status, None, len(tests))

    def _can_notice(self, test: _Test, mutant: Mutant, places: set[int]) -> bool:
        for shader, function in test.uses:
            if shader == ANY:
                return True
            if self._standing[shader] in places:
                calls = self._variants[shader].calls
                if ANY in (function, mutant.function or ANY) or mutant.function in calls.get(function, ()):
                    return True
        return False

    def run(
        self, workers: int | None = None, scheduler: str | None = None, done: Callable[[int], None] = lambda count: None
    ) -> list[Result]:
        """Runs what is to be run, and returns all results. ``done`` is told how many more mutants are through."""
        waiting = [n for n, result in enumerate(self.results) if result.status == "to run"]
        groups = list(_groups(waiting, [self.results[n].mutant.function for n in waiting]))
        chunks = (self._chunk(group) for group in groups)
        for place, outcomes in jobs.run(_attempt, chunks, scheduler=scheduler, workers=workers):
            for n, (status, by) in zip(groups[place], outcomes, strict=True):
                self.results[n] = replace(self.results[n], status=status, by=by)
            done(len(outcomes))
        return self.results

    @property
    def to_run(self) -> int:
        """How many mutants ``run`` has before it."""
        return sum(result.status == "to run" for result in self.results)

    def _chunk(self, group: Sequence[int]) -> _Chunk:
        tasks = []
        for n in group:
            mutant = self.results[n].mutant
            tests = sorted(self._relevant[mutant.id], key=lambda test: (test.seconds, test.name))
            tasks.append(_Task(mutant.apply(self.text), tuple((test.name, test.seconds) for test in tests)))
        return _Chunk(self.project, self.text, self._warm, tuple(tasks))


def _groups(places: Sequence[int], functions: Sequence[str | None]) -> Iterator[list[int]]:
    """Places next to each other of one function, so many together that the way to a worker pays."""
    group: list[int] = []
    at = None
    for place, function in zip(places, functions, strict=True):
        if group and (len(group) == _TOGETHER or function != at):
            yield group
            group = []
        group.append(place)
        at = function
    if group:
        yield group


def _read(file: Path) -> str:
    """The file's text as ``glsl`` reads it."""
    return file.read_bytes().decode("utf-8-sig", errors="replace").replace("\r\n", "\n")


def _clean_run(project: mutate_project.Project, path: str) -> tuple[list[_Test], list[Loaded], bool]:
    """The tests that use the file, the shaders that they load it into, and whether it is left alone until tests run."""
    server = _Server(project)
    try:
        found = server.ask({"clean": True})
    finally:
        server.end()
    where = " ".join(project.tests) or "all that pytest finds"
    for name, message in found["not_collected"].items():
        raise HarnessError(f"the tests are not collected on the unchanged file: {name}:\n{message}", path)
    used = [(name, seconds, uses, failed) for name, seconds, uses, failed in found["tests"] if uses]
    if not used:
        raise HarnessError(f"no test uses it ({where}: {len(found['tests'])} tests)", path)
    for name, _, _, failed in used:
        if failed:
            raise HarnessError(f"a test fails on the unchanged file: {name}:\n{failed}", path)
    tests = [_Test(name, seconds, tuple(map(tuple, uses))) for name, seconds, uses, _ in used]
    loaded = [Loaded(text, tuple(map(tuple, places))) for text, places in found["loaded"]]
    return tests, loaded, not found["cold"]


# ---- In the workers --------------------------------------------------------------------------------------------------


class _Server:
    """A process of ``mutate_server``."""

    def __init__(self, project: mutate_project.Project):
        self.project = project
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "harness.mutating.mutate_server"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,  # Ctrl-C is not for it: it ends with its input, and clears up
        )
        first = {name: getattr(project, name) for name in ("root", "files", "file", "within", "tests")}
        self._send(first)

    def _send(self, request: dict[str, Any]) -> None:
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()

    def ask(self, request: dict[str, Any]) -> dict[str, Any]:
        """The reply to a request. HarnessError where it is an error, ConnectionError where there is no process."""
        self._send(request)
        line = self._process.stdout.readline()
        if not line:
            raise ConnectionError
        reply = json.loads(line)
        if "error" in reply:
            raise HarnessError(reply["error"], self.project.file)
        return reply

    def end(self) -> None:
        """Ends it, and waits until it has cleared up."""
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()


_server: _Server | None = None  # of this worker process, kept from one chunk to the next


def _attempt(chunk: _Chunk) -> list[tuple[str, str | None]]:
    """(status, test that noticed) of each mutant of a chunk. Run by the workers."""
    file = Path(chunk.project.root, chunk.project.file)
    try:
        same = _read(file) == chunk.original
    except OSError:
        same = False
    if not same:
        raise GlslError("the worker does not have this file, or has another version of it", file)
    kills: Counter[str] = Counter()
    outcomes = []
    for task in chunk.tasks:
        tests = sorted(task.tests, key=lambda test: -kills[test[0]])  # else as they are: the quick ones first
        limits = [(name, PATIENCE * seconds + SECONDS_MORE) for name, seconds in tests]
        reply = _ask(chunk.project, {"text": task.text, "tests": limits, "warm": chunk.warm})
        kills[reply["by"]] += 1
        outcomes.append((reply["status"], reply["by"]))
    return outcomes


def _ask(project: mutate_project.Project, request: dict[str, Any]) -> dict[str, Any]:
    global _server
    for last in (False, True):
        if _server is None or _server.project != project:
            if _server is not None:
                _server.end()
            _server = _Server(project)
        try:
            return _server.ask(request)
        except (ConnectionError, BrokenPipeError):  # it has ended, having waited long for a request
            _server = None
            if last:
                raise HarnessError("the process that runs the tests dies", project.file) from None
    raise AssertionError
