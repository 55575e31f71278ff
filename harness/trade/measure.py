"""``measure``: all numbers of the trade of a project, as one dict. docs/trade.md says what each is."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from ..costing import isa
from ..errors import HarnessError
from ..info import info
from ..ladder import Ladder
from ..projects import sprj
from . import cost, scene, tasks, timing
from .choices import REFERENCE, Choice, choices, defaults
from .tasks import Found

SCHEMA = 1
#: the parts of an entry, in its order
PARTS = ("roundoff", "model", "scene", "extremes", "energy", "cost", "time")

Progress = Callable[[int, int, str], None]


def measure(
    project_path: str | os.PathLike, ladder: Ladder, only: str | None = None, progress: Progress | None = None
) -> dict[str, Any]:
    """Measures every rung and preset of a ladder, or the one named ``only``, and the project's picture under each.

    All cores are used for errors, extremes and pictures, then one process for the times. ``progress(done, total,
    text)`` is called before each step. What cannot be measured is None, with the reason in the entry's ``missing``.
    HarnessError when the project or the ladder is at fault, or a rung does not compile.
    """
    start = time.perf_counter()
    project = sprj.read(project_path)
    chosen = choices(project, ladder, only)
    work = tasks.tasks(os.fspath(project_path), chosen)
    steps = _Steps(progress, len(work) + len(cost.targets()) + timing.ROUNDS)
    found = [Found() for _ in chosen]
    for k, part in tasks.done([task for task, _ in work], spread=only is None):
        steps.next(work[k][0].label)
        for first, place in enumerate(work[k][1]):
            found[place].parts |= part.parts
            found[place].missing |= part.missing
            found[place].seconds |= part.seconds if first == 0 else {}
    lap = time.perf_counter()
    _costs(chosen, found, steps)
    costs_took, lap = time.perf_counter() - lap, time.perf_counter()
    _times(chosen, found, steps)
    seconds = {part: sum(f.seconds.get(part, 0.0) for f in found) for part in PARTS}
    seconds |= {"cost": costs_took, "time": time.perf_counter() - lap, "total": time.perf_counter() - start}
    entries = [_entry(*each) for each in zip(chosen, found, strict=True)]
    own = defaults(project, ladder)
    terms = []
    for term in ladder.terms:
        rungs = [entry for choice, entry in zip(chosen, entries, strict=True) if choice.term is term]
        described = {name: getattr(term, name) for name in ("name", "title", "macro", "exact")}
        if rungs:
            terms.append({**described, "default": own[term.macro], "rungs": rungs})
    return {
        "schema": SCHEMA,
        "machine": _machine(chosen[0]),
        "targets": list(cost.targets()),
        "reference": REFERENCE,
        "scene": {"project": project.file.name, "size": list(scene.SIZE)},
        "terms": terms,
        "presets": [entry for choice, entry in zip(chosen, entries, strict=True) if choice.term is None],
        "seconds": {part: round(value, 2) for part, value in seconds.items()},
    }


class _Steps:
    """Tells how far the work is."""

    def __init__(self, progress: Progress | None, total: int):
        self._progress, self._total, self._done = progress, total, 0

    def next(self, text: str) -> None:
        """One more step is done, or begins."""
        self._done += 1
        if self._progress:
            self._progress(self._done, self._total, text)


def _entry(choice: Choice, found: Found) -> dict[str, Any]:
    return {**choice.described(), **{part: found.parts.get(part) for part in PARTS}, "missing": found.missing}


def _machine(choice: Choice) -> dict[str, Any]:
    described = info()
    mesa = f", Mesa {described['Mesa']}" if "Mesa" in described else ""
    return {
        "cpu": described["CPU"],
        "driver": described["driver"] + mesa,
        "glslang": described["glslang"],
        "harness": described["shader-harness"],
        "costs": cost.driver(choice.function(choice.whole)),
    }


def _costs(chosen: Sequence[Choice], found: Sequence[Found], steps: _Steps) -> None:
    """Of all that can be counted together, of the others why not."""
    counted, functions = [], []
    for choice, own in zip(chosen, found, strict=True):
        function = choice.function(choice.whole)
        if own.measure("cost", lambda function=function: cost.counted(function)):
            counted.append(own)
            functions.append(function)
    for own, costs in zip(counted, cost.costs(functions, steps.next), strict=True):
        own.parts["cost"] = costs
        if reason := isa.unavailable():
            own.missing["cost.targets"] = reason


def _times(chosen: Sequence[Choice], found: Sequence[Found], steps: _Steps) -> None:
    """Here, and on a GPU where EGL has one."""
    jobs: list[timing.Job] = []
    timed: list[tuple[Found, int]] = []
    for choice, own in zip(chosen, found, strict=True):
        try:
            reference = timing.job(choice.function(choice.whole, choice.reference), choice.whole_domain, len(jobs))
            jobs += [reference, timing.job(choice.function(choice.whole), choice.whole_domain, len(jobs))]
            timed.append((own, len(jobs) - 1))
            own.parts["time"] = []
        except HarnessError as error:
            own.lack("time", str(error).partition("\n")[0])
    if not jobs:
        return
    try:
        measured = [(timing.device(), timing.times(jobs, lambda k, _: steps.next(f"time: round {k + 1}")))]
    except HarnessError as error:
        for own, _ in timed:
            own.lack("time", str(error).partition("\n")[0])
        return
    try:
        on_gpu = timing.times_on_gpu(jobs)
        measured += [on_gpu] if on_gpu else []
    except HarnessError as error:
        for own, _ in timed:
            own.missing["time.egl"] = str(error).partition("\n")[0]
    for (backend, device), times in measured:
        for own, k in timed:
            told = {name: value for name, value in asdict(times[k]).items() if name != "reason"}
            if times[k].reason:
                own.missing[f"time.{backend}"] = times[k].reason
            else:
                own.parts["time"].append({"backend": backend, "device": device, **told})
    for own, _ in timed:
        if not own.parts["time"]:
            own.lack("time", own.missing.pop(f"time.{measured[0][0][0]}"))
