"""Row group 1: ``shade`` of shaders/brdf.glsl over N evaluations, by the harness and by its rivals.

End to end: arrays in, a new array out, everything compiled and warm. All must give what the harness gives, or their row
says so. The contenders take turns, so that a busy moment of the machine hits all of them.
"""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from . import AbsentError
from .agreement import TOLERANCE, disagreement
from .table import Row
from .worker import CONTENDERS, Worker, WorkerError

COUNTS = 1_000, 100_000, 4_000_000
HARNESS = "harness"  # the contender that the others are compared with
#: N -> nanoseconds per evaluation that the harness should stay within
AIMS = {1_000: 300.0, 4_000_000: 12.0}
#: N at which the harness should be faster than moderngl
FASTER_THAN_MODERNGL = 4_000_000
UNIT = "ns/evaluation"
NANOSECONDS = 1e9


def rows(
    counts: tuple[int, ...], rounds: int, seconds: float, progress: Callable[[str], None]
) -> tuple[list[Row], str]:
    """The rows, and what the harness draws with. A sample is the mean over calls that fill ``seconds``."""
    errors: dict[str, Exception] = {}
    with contextlib.ExitStack() as stack, tempfile.TemporaryDirectory() as folder:
        started = {name: stack.enter_context(contextlib.closing(Worker(name))) for name in CONTENDERS}
        workers, renderer = {}, ""
        for name, worker in started.items():
            progress(f"shade: starting {name}")
            try:
                renderer = worker.hello()["renderer"] or renderer
                workers[name] = worker
            except (WorkerError, AbsentError) as error:
                errors[name] = error
        found = []
        for count in counts:
            progress(f"shade: N = {count}: do all compute the same?")
            notes = dict(_checked(workers, count, Path(folder), errors))
            samples = _samples(workers, rounds, seconds, errors, lambda k, n=count: progress(f"shade: N = {n}: {k}"))
            found += list(_rows(count, samples, notes, errors))
    return found, renderer


def _checked(workers: dict[str, Worker], count: int, folder: Path, errors: dict) -> Iterator[tuple[str, str]]:
    """How far each contender's result is from the harness's; who fails, or differs, is out."""
    reference = None
    for name in list(workers):
        file = folder / "result.npy"
        try:
            workers[name].ask(count=count, save=str(file))
        except WorkerError as error:
            errors[name] = error
            del workers[name]
            continue
        result = np.load(file)
        if name == HARNESS:
            reference = result
        elif reference is None:
            yield name, "the harness gave nothing to compare with"
        else:
            apart = disagreement(result, reference)
            if apart > TOLERANCE:
                errors[name] = WorkerError(f"DISAGREES with the harness by {apart:.2g}, not within {TOLERANCE:.2g}")
                del workers[name]
            else:
                yield name, f"agrees within {apart:.1e}" if apart else "agrees exactly"


def _samples(
    workers: dict[str, Worker], rounds: int, seconds: float, errors: dict, progress: Callable[[str], None]
) -> dict[str, list[float]]:
    """Nanoseconds per call, ``rounds`` times in turn."""
    samples: dict[str, list[float]] = {name: [] for name in workers}
    calls: dict[str, int] = {}
    for k in range(rounds + 1):  # the first finds out how many calls fill the time
        progress(f"round {k} of {rounds}")
        for name in list(workers):
            try:
                if k == 0:
                    calls[name] = workers[name].ask(seconds=seconds)["calls"]
                else:
                    samples[name].append(workers[name].ask(calls=calls[name])["seconds"] * NANOSECONDS)
            except WorkerError as error:
                errors[name] = error
                del workers[name], samples[name]
    return samples


def _rows(count: int, samples: dict[str, list[float]], notes: dict[str, str], errors: dict) -> Iterator[Row]:
    measured = f"shade, N = {count:_}".replace("_", " ")
    own = float(np.median(samples[HARNESS])) / count if HARNESS in samples else None
    for name in CONTENDERS:
        if name not in samples:
            yield Row(measured, name, note=str(errors[name]), absent=isinstance(errors[name], AbsentError))
            continue
        values = tuple(sample / count for sample in samples[name])
        aim, aim_is = (AIMS.get(count), "at most") if name == HARNESS else (None, "at most")
        if name.startswith("moderngl") and count == FASTER_THAN_MODERNGL and own is not None:
            aim, aim_is = own, "above"
        ratio = None if own is None else float(np.median(values)) / own
        yield Row(measured, name, UNIT, values, ratio, aim, aim_is, notes.get(name, ""))
