"""A process that runs the tests of a copy of a project again and again, each time on another text of one file.

Run by ``python -m``, it reads requests and writes replies, one JSON object a line. It copies the project,
collects its tests once, and forks for each request: what Python has loaded is there at once, and GL, which must not be
started before a fork, is started in each child anew. When its input ends, however the asker ended, it kills what runs
and removes the copy.

Requests, in this order:
  {"root", "files", "file", "within", "tests"}
                                         the project's folder, what to copy of it, the file, the folder where the tests
                                         run, all relative to it, and pytest's arguments
  {"clean": true}                        runs all tests on the file as it is -> what ``Recorder`` found
  {"text", "tests", "warm"}              runs [node id, seconds that it may take]..., in this order, on another text,
                                         until one fails -> {"status": "killed", "survived" or "timeout", "by": node id}
An {"error": message} may come instead.
"""

from __future__ import annotations

import json
import os
import select
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

IDLE_SECONDS = 300  # with no request: a cluster's worker keeps its process after the work is done
LINKED_BYTES = 1 << 20  # from here on a file is linked, not copied: a picture or a model


def copy_project(root: Path, files: Sequence[str], folder: Path) -> None:
    """Copies files, named relative to ``root``; large ones are linked, and those that have gone are left out."""
    for name in files:
        source, target = root / name, folder / name
        if not source.is_file():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.stat().st_size >= LINKED_BYTES:
            target.symlink_to(source.resolve())
        else:
            shutil.copy2(source, target)


class _Gone(Exception):  # noqa: N818
    """Whoever asks has ended."""


class Server:
    """Answers requests in one copy of a project."""

    def __init__(self, requests: int, replies: int):
        self._requests, self._replies = requests, replies
        self._left = b""
        self._warm = False
        self.folder: Path | None = None

    def run(self) -> None:
        """Until the input ends."""
        try:
            first = self._next()
            self.folder = Path(tempfile.mkdtemp(prefix="harness-mutate-")).resolve()
            self._tree = self.folder / "project"
            copy_project(Path(first["root"]), first["files"], self._tree)
            self._file = self._tree / first["file"]
            self._arguments = first["tests"]
            os.environ["MESA_SHADER_CACHE_DIR"] = str(self.folder / "cache")
            os.environ["HARNESS_NATIVE_LIB"] = _native_library()
            os.environ["TMPDIR"] = tempfile.tempdir = str(self.folder)
            os.chdir(self._tree / first["within"])
            sys.path.insert(0, os.getcwd())  # as python -m pytest does
            self.serve()
        except _Gone:
            pass
        except Exception as error:
            self._reply({"error": f"{type(error).__name__}: {error}"})
        finally:
            if self.folder:
                os.chdir("/")
                shutil.rmtree(self.folder, ignore_errors=True)

    def serve(self, warm: WarmTests | None = None) -> None:
        """Answers requests. ``warm`` are the collected tests, once there are."""
        while True:
            request = self._next()
            if "clean" in request:
                self._reply(self._clean())
                continue
            if request["warm"] and not self._warm:
                # From here on inside pytest, with the tests collected, until the end.
                self._warm = True
                self._requeue(request)
                _pytest([*self._arguments], WarmTests(self))
                raise _Gone
            self._reply(self._attempt(request, warm if request["warm"] else None))

    # ---- Requests and replies

    def _next(self) -> dict[str, Any]:
        while b"\n" not in self._left:
            if not select.select([self._requests], [], [], IDLE_SECONDS)[0]:
                raise _Gone
            part = os.read(self._requests, 1 << 20)
            if not part:
                raise _Gone
            self._left += part
        line, _, self._left = self._left.partition(b"\n")
        return json.loads(line)

    def _requeue(self, request: dict[str, Any]) -> None:
        self._left = json.dumps(request).encode() + b"\n" + self._left

    def _reply(self, reply: dict[str, Any]) -> None:
        try:
            _write(self._replies, reply)
        except BrokenPipeError:
            raise _Gone from None

    # ---- Running tests in children

    def _clean(self) -> dict[str, Any]:
        found: dict[str, Any] = {"error": "the tests end without a result: they crash"}

        def take(message: dict[str, Any]) -> None:
            found.clear()
            found.update(message)

        def run(write: Callable[[dict[str, Any]], None]) -> None:
            from .mutate_recorder import Recorder

            recorder = Recorder(self._file)
            recorder.install()
            code = _pytest(self._arguments, recorder)
            write(recorder.result(int(code)))

        self._child(run, take, lambda child: None)
        return found

    def _attempt(self, request: dict[str, Any], warm: WarmTests | None) -> dict[str, Any]:
        tests = dict(request["tests"])
        names = list(tests)
        state: dict[str, Any] = {"by": None, "status": None}
        limit = _Limit(sum(tests.values()))  # of what comes before the first test

        def take(message: dict[str, Any]) -> None:
            nonlocal limit
            if "start" in message:
                state["by"] = message["start"]
                limit = _Limit(tests[message["start"]])
            else:
                state.update(message)

        def run(write: Callable[[dict[str, Any]], None]) -> None:
            if warm:
                warm.run(names, write)
            else:
                chosen = _ChosenTests(names, write)
                files = list(dict.fromkeys(name.partition("::")[0] for name in names))
                there = all(map(os.path.exists, files))  # names are relative to pytest's own root
                chosen.finish(int(_pytest([*(files if there else self._arguments), "--maxfail=1"], chosen)))

        self._file.write_text(request["text"])
        ended = self._child(run, take, lambda child: limit.rest(child))
        # a child that dies of its mutant crashed in a test
        status = "timeout" if not ended else state["status"] or "killed"
        return {"status": status, "by": None if status == "survived" else state["by"]}

    def _child(
        self,
        run: Callable[[Callable[[dict[str, Any]], None]], None],
        take: Callable[[dict[str, Any]], None],
        rest: Callable[[int], float | None],
    ) -> bool:
        """Runs in a forked child, hands on what it writes, and kills it. False when ``rest``, its seconds, are 0."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                os.setsid()  # so that what the tests start is killed with them
                os.close(reading)
                os.close(self._requests)
                run(lambda message: _write(writing, message))
            finally:
                os._exit(0)
        os.close(writing)
        left = b""
        try:
            while True:
                left_seconds = rest(child)
                ready = select.select([reading, self._requests], [], [], left_seconds)[0]
                if reading in ready:
                    part = os.read(reading, 1 << 20)
                    if not part:
                        return True
                    *lines, left = (left + part).split(b"\n")
                    for line in lines:
                        take(json.loads(line))
                elif ready:
                    raise _Gone  # nothing is asked while an answer is due
                elif not left_seconds:
                    return False
        finally:
            os.close(reading)
            try:
                os.killpg(child, signal.SIGKILL)
            except ProcessLookupError:
                os.kill(child, signal.SIGKILL)  # it has not made its own group yet
            os.waitpid(child, 0)


class _Limit:
    """Seconds that a test may take: of the processor, or ``WAITING`` times as many of the clock.

    A machine that has much else to do makes the clock run on; a test that hangs takes the one or the other.
    """

    WAITING = 10

    def __init__(self, seconds: float):
        self._seconds, self._start, self._used = seconds, time.monotonic(), None

    def rest(self, child: int) -> float:
        """Seconds after which to ask again; 0 where there are none left."""
        used = _processor_seconds(child)
        if self._used is None:
            self._used = used
        rest = self._seconds - (used - self._used)
        if time.monotonic() - self._start > self.WAITING * self._seconds or rest <= 0:
            return 0.0
        return max(rest, 0.05)


def _processor_seconds(process: int) -> float:
    """What a process and its threads have used."""
    with open(f"/proc/{process}/stat") as stat:
        fields = stat.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class WarmTests:
    """A pytest plugin: once the tests are collected, the server goes on in the place where they would be run."""

    def __init__(self, server: Server):
        self._server = server
        self._write: Callable[[dict[str, Any]], None] = lambda message: None
        self._failed = False

    def pytest_runtestloop(self, session: Any) -> bool:
        self._items = {item.nodeid: item for item in session.items}
        self._server.serve(self)
        return True

    def run(self, names: Sequence[str], write: Callable[[dict[str, Any]], None]) -> None:
        """Runs tests, in a child, until one fails."""
        self._write = write
        items = [self._items[name] for name in names]
        for item, following in zip(items, [*items[1:], None], strict=True):
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self._failed:
                return
        write({"status": "survived"})

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._write({"start": nodeid})

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed and not self._failed:
            self._failed = True
            self._write({"status": "killed", "by": report.nodeid})


class _ChosenTests:
    """A pytest plugin for a run of its own: some tests, in a given order."""

    def __init__(self, names: Sequence[str], write: Callable[[dict[str, Any]], None]):
        self._names, self._write, self._failed = names, write, False

    def pytest_collection_modifyitems(self, items: list[Any]) -> None:
        found = {item.nodeid: item for item in items}
        items[:] = [found[name] for name in self._names if name in found]

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._write({"start": nodeid})

    def pytest_collectreport(self, report: Any) -> None:
        self.pytest_runtest_logreport(report)

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed and not self._failed:
            self._failed = True
            self._write({"status": "killed", "by": report.nodeid})

    def finish(self, code: int) -> None:
        """After pytest's exit with ``code``: 0 is passed, 5 no tests. Where a test failed it is told already."""
        if not self._failed:
            self._write({"status": "survived" if code in (0, 5) else "killed"})


def _pytest(arguments: Sequence[str], plugin: object) -> int:
    import importlib.util

    import pytest

    # Quiet, and without a header: what a project's header says of GL would start it.
    options = ["-q", "--no-header", "-p", "no:cacheprovider"]
    if importlib.util.find_spec("xdist"):
        options += ["-n", "0"]
    return pytest.main([*options, *arguments], plugins=[plugin])


def _native_library() -> str:
    """The library in use, for a copy of this package among the tests has none built."""
    from ..native import _library

    return _library._name


def _write(file: int, message: dict[str, Any]) -> None:
    data = json.dumps(message).encode() + b"\n"
    while data:
        data = data[os.write(file, data) :]


def main() -> None:
    """The process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for whoever asks
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    requests, replies = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(nothing, standard)
    for name in ("numpy", "mpmath", "PIL.Image", "pytest", "harness"):
        try:
            __import__(name)
        except ImportError:
            pass  # a project need not have them all
    Server(requests, replies).run()


if __name__ == "__main__":
    main()
