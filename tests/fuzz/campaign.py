"""Tries many cases, in processes with limits on time and memory that are replaced when they die."""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from itertools import count
from multiprocessing.connection import Connection
from pathlib import Path

from cases import WrongError, describe, run

from harness.processes.process import Process

CASE_SECONDS = 20.0  # llvmpipe compiles a shader in milliseconds, an endless loop ends after 65535 rounds
MEMORY_BYTES = 2 << 30
_START_SECONDS = 60.0
_RESTART = 400  # cases: shaders that were compiled stay in a driver's memory


def serve(connection: Connection, projects: list[Path], seed: str) -> None:
    """In the worker: the number of a case in, what came of it out."""
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    connection.send("ready")
    while True:
        number = connection.recv()
        try:
            connection.send((True, run(projects[number % len(projects)], seed, number)))
        except WrongError as error:
            connection.send((False, str(error)))
        except MemoryError:
            connection.send((True, "out of memory"))  # which the command line says in one message
        except Exception:
            connection.send((False, traceback.format_exc()))


class Worker:
    """Tries cases one after the other, in a process that is replaced when it dies."""

    def __init__(self, projects: list[Path], seed: str):
        self._arguments = projects, seed
        self._process: Process | None = None
        self._tried = 0

    def __call__(self, number: int) -> tuple[bool, str]:
        """(whether it is right, what came of it) of a case."""
        projects, seed = self._arguments
        if self._process is None:
            self._process = Process(serve, *self._arguments, memory_bytes=MEMORY_BYTES)
            self._tried = 0
            if not self._process.connection.poll(_START_SECONDS) or self._process.connection.recv() != "ready":
                raise RuntimeError("a worker does not start")
        try:
            self._process.connection.send(number)
            answer = self._process.connection.recv() if self._process.connection.poll(CASE_SECONDS) else None
        except (EOFError, OSError):
            return False, f"crashed: {self.end(1.0)}"
        self._tried += 1
        if answer is None:
            self.end()
            target, *_ = describe(projects[number % len(projects)], seed, number)
            # A shader may loop for ever, which the command line bounds; nothing else may.
            return target == "render", f"{target}: took more than {CASE_SECONDS:g} s"
        if self._tried == _RESTART:
            self.end()
        return answer

    def end(self, patience: float = 0.0) -> str:
        """Ends its process; how that ended."""
        process, self._process = self._process, None
        return process.end(patience) if process else ""


def fuzz(
    projects: list[Path], seed: str, seconds: float | None, cases: int | None, workers: int
) -> Iterator[tuple[int, bool, str]]:
    """(number, right, what came of it) of case 0, 1, ..., for so many seconds or cases."""
    end = None if seconds is None else time.monotonic() + seconds
    numbers = iter(count() if cases is None else range(cases))

    def share() -> list[tuple[int, bool, str]]:
        worker, found = Worker(projects, seed), []
        try:
            for number in numbers:
                if end is not None and time.monotonic() > end:
                    break
                found.append((number, *worker(number)))
        finally:
            worker.end()
        return found

    with ThreadPoolExecutor(workers) as threads:
        for done in as_completed([threads.submit(share) for _ in range(workers)]):
            yield from done.result()
