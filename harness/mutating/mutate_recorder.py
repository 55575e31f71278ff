"""A pytest plugin that finds out which tests use a file, what they compile of it, and how long each takes."""

from __future__ import annotations

import functools
import os
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from ..calling import call
from ..language import glsl

#: what is used, where it is not known: any shader, any function
ANY = "*"

_MESSAGE_LINES = 5


class Recorder:
    """Watches a run of the tests. ``file`` is the file by its real path.

    A use is (shader, function): a shader is the text that was loaded, ``ANY`` where the file was read by other means;
    a function ``ANY`` where the shader was used as a whole. What a fixture of wider scope than a function uses, all
    tests with that fixture use.
    """

    def __init__(self, file: Path):
        self._file, self._bytes = file, file.read_bytes()
        self._at: str | None = None  # the test, or the fixture, that runs; None while tests are collected
        self._uses: dict[str | None, set[tuple[int | str, str]]] = defaultdict(set)
        self._numbers: dict[str, int | None] = {}
        self._loaded: list[tuple[str, list[tuple[int, int]]]] = []
        self._is_file: dict[str, bool] = {}
        self._fixtures: dict[str, list[str]] = {}
        self._seconds: dict[str, float] = defaultdict(float)
        self._failed: dict[str, str] = {}
        self._cold = False  # the file is read, GL or a process started, when tests are collected
        self._order: list[str] = []

    def install(self) -> None:
        """Watches what reads files, loads shaders and calls functions. For a process that ends with the run."""
        load = glsl.load

        @functools.wraps(load)
        def watched_load(*args: Any, **kwargs: Any) -> glsl.Source:
            source = load(*args, **kwargs)
            shader = self._shader(source.text, source.origins)
            if shader is not None:
                self._cold = self._cold or self._at is None
                if not _called_from(call.shader):  # else what it is used for is seen when its functions are called
                    self._uses[self._at].add((shader, ANY))
            return source

        glsl.load = watched_load
        for name in ("__call__", "trace", "compare"):
            if method := getattr(call.Function, name, None):
                setattr(call.Function, name, self._watched(method))
        sys.addaudithook(self._audit)

    def _watched(self, method: Any) -> Any:
        @functools.wraps(method)
        def watched(function: call.Function, *args: Any, **kwargs: Any) -> Any:
            source = function._library.source
            shader = self._shader(source.written or source.text, source.origins)
            if shader is not None:
                self._uses[self._at].add((shader, function.__name__))
            return method(function, *args, **kwargs)

        return watched

    def _shader(self, text: str, origins: Sequence[tuple[str, int]]) -> int | None:
        """The number of a shader that the file takes part in, None for others."""
        if text not in self._numbers:
            places = [(n, m) for n, (file, m) in enumerate(origins, 1) if self._is_ours(file)]
            self._numbers[text] = len(self._loaded) if places else None
            if places:
                self._loaded.append((text, places))
        return self._numbers[text]

    def _is_ours(self, file: str) -> bool:
        """Whether it is the file, or a copy."""
        path = os.path.realpath(file)
        if path not in self._is_file:
            same = path == str(self._file)
            if not same and os.path.basename(path) == self._file.name and os.path.isfile(path):
                same = Path(path).read_bytes() == self._bytes
            self._is_file[path] = same
        return self._is_file[path]

    def _audit(self, event: str, args: tuple) -> None:
        if event == "open":
            path = args[0]
            if isinstance(path, str) and path.endswith(self._file.name) and os.path.realpath(path) == str(self._file):
                self._cold = self._cold or self._at is None
                if not _called_from(glsl.load) and not _called_from(self._is_ours):
                    self._uses[self._at].add((ANY, ANY))
        elif event == "subprocess.Popen":
            self._cold = self._cold or self._at is None  # a worker process that every child would share
            if any(self._file.name in str(word) for word in args[1]):
                self._uses[self._at].add((ANY, ANY))

    # ---- pytest's hooks

    def pytest_collection_finish(self, session: Any) -> None:
        self._cold = self._cold or _gl_is_open()
        for item in session.items:
            self._order.append(item.nodeid)
            definitions = getattr(item, "_fixtureinfo", None)
            known = definitions.name2fixturedefs if definitions else {}
            self._fixtures[item.nodeid] = [_fixture_name(d) for several in known.values() for d in several]

    def pytest_collectreport(self, report: Any) -> None:
        if report.failed:
            self._failed[report.nodeid] = _message(report)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        before = self._at
        if fixturedef.scope != "function":
            self._at = _fixture_name(fixturedef)
        try:
            return (yield)
        finally:
            self._at = before

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._at = nodeid

    def pytest_runtest_logreport(self, report: Any) -> None:
        self._seconds[report.nodeid] += report.duration
        if report.failed:
            self._failed.setdefault(report.nodeid, _message(report))

    def result(self, code: int) -> dict[str, Any]:
        """What was found, for JSON. ``tests``: node id, seconds, uses, and the message of those that failed."""
        always = self._uses[None]
        tests = []
        for name in self._order:
            uses = always.union(self._uses[name], *(self._uses[f] for f in self._fixtures[name]))
            tests.append([name, self._seconds[name], sorted(uses, key=str), self._failed.pop(name, None)])
        return {"loaded": self._loaded, "tests": tests, "cold": self._cold, "not_collected": self._failed, "code": code}


def _fixture_name(definition: Any) -> str:
    return f"fixture {definition.baseid}::{definition.argname}"


def _called_from(function: Any) -> bool:
    code = getattr(function, "__wrapped__", function).__code__
    frame = sys._getframe(1)
    while frame is not None:
        if frame.f_code is code:
            return True
        frame = frame.f_back
    return False


def _message(report: Any) -> str:
    """What pytest marks as the error, else the end of what it says."""
    lines = str(report.longrepr).splitlines()
    marked = [line[1:].strip() for line in lines if line.startswith("E ")]
    return "\n".join(marked[:_MESSAGE_LINES] or lines[-1:])


def _gl_is_open() -> bool:
    from .. import native

    try:
        native.context_info()
    except native.NativeError:
        return False
    return True
