"""A process for each contender: two providers of GL in one process crash, and threads of one would disturb another.

The child (``python -m bench.worker CONTENDER``) reads requests from stdin, one line of JSON each, and answers likewise:

- ``{"count": N, "save": FILE}`` calls once with N inputs and saves the result;
- ``{"seconds": S}`` finds out how many calls take S seconds: ``{"calls": n}``;
- ``{"calls": n}`` times n calls: ``{"seconds": of one call}``.

Before that it says ``{"renderer": ...}``: it is ready. Instead of an answer: ``{"error": ...}``, ``{"absent": ...}``.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import tempfile
import time

import numpy as np

from . import ROOT, AbsentError
from .inputs import Inputs, inputs

#: name -> module of this package, function that gives the callable, package that it needs
CONTENDERS = {
    "harness": ("shade_harness", "contender", "harness"),
    "numpy": ("shade_numpy", "contender", "numpy"),
    "numba": ("shade_numba", "contender", "numba"),
    "moderngl, textures": ("shade_moderngl", "textures", "moderngl"),
    "moderngl, feedback": ("shade_moderngl", "feedback", "moderngl"),
}


class WorkerError(Exception):
    """A contender cannot be measured; the text says why."""


class Worker:
    """The parent's end. Several start at the same time: ``hello`` waits for one."""

    def __init__(self, contender: str):
        self._log = tempfile.TemporaryFile("w+")
        self._process = subprocess.Popen(
            [sys.executable, "-m", "bench.worker", contender],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            text=True,
            cwd=ROOT,
        )

    def hello(self) -> dict:
        """What the contender says of itself once it has started. WorkerError or AbsentError when it does not start."""
        return self._answer()

    def ask(self, **request) -> dict:
        """Sends a request and waits for its answer. WorkerError when the contender fails."""
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # the answer is that it died
        return self._answer()

    def _answer(self) -> dict:
        line = self._process.stdout.readline()
        if not line:
            self._log.seek(0)
            last = (self._log.read().strip().splitlines() or ["no message"])[-1]
            raise WorkerError(f"its process ended with exit code {self._process.wait()}: {last}")
        answer = json.loads(line)
        if "absent" in answer:
            raise AbsentError(answer["absent"])
        if "error" in answer:
            raise WorkerError(answer["error"])
        return answer

    def close(self) -> None:
        """Ends the process."""
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()
        self._log.close()


def timed(call, x: Inputs, calls: int) -> float:
    """Seconds of one of ``calls`` calls. Each makes a new array, and drops it before the next."""
    start = time.perf_counter()
    for _ in range(calls):
        call(x)
    return (time.perf_counter() - start) / calls


def _serve(contender: str) -> None:
    module_name, function, package = CONTENDERS[contender]
    try:
        module = importlib.import_module(f"bench.{module_name}")
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise AbsentError(f'{package} is not installed: pip install -e ".[bench]"') from None
    call = getattr(module, function)()
    _say(renderer=module.renderer() if hasattr(module, "renderer") else "")
    x = inputs(1)
    for line in sys.stdin:
        request = json.loads(line)
        if "save" in request:
            x = inputs(request["count"])
            np.save(request["save"], call(x))
            _say(saved=True)
        elif "seconds" in request:
            _say(calls=max(1, round(request["seconds"] / timed(call, x, 3))))
        else:
            _say(seconds=timed(call, x, request["calls"]))


def _say(**answer) -> None:
    print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    try:
        _serve(sys.argv[1])
    except AbsentError as error:
        _say(absent=str(error))
    except Exception as error:  # noqa: BLE001 -- whatever it is, the table says it
        _say(error=f"{type(error).__name__}: {error}")
