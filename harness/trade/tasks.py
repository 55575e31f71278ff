"""What of the trade is measured by all cores at once: pieces of work that can be sent to other processes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cache
from typing import Any

import numpy as np

from ..calling.function import Function
from ..errors import HarnessError
from ..processes import jobs
from ..searching import domain
from . import energy, extremes, model, roundoff, sampling, scene, timing
from .choices import WHOLE, Choice

#: modes that the extremes are tried in
MODES = ("as-written", "precise", "mediump", "double")


@dataclass
class Found:
    """Parts of an entry, None where there is a reason in ``missing``; and the seconds that each took."""

    parts: dict[str, Any] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)

    def measure(self, part: str, work: Callable[[], Any]) -> Any:
        """What ``work`` returns, also as the part of that name; None, and the reason kept, where it cannot be."""
        start = time.perf_counter()
        try:
            self.parts[part] = work()
        except HarnessError as error:
            self.lack(part, str(error).partition("\n")[0])
        self.seconds[part] = self.seconds.get(part, 0.0) + time.perf_counter() - start
        return self.parts[part]

    def lack(self, part: str, reason: str) -> None:
        """The part cannot be measured."""
        self.parts[part], self.missing[part] = None, reason

    def measure_each(self, part: str, names: Sequence[str], work: Callable[[str], Any]) -> None:
        """A part of named members; a member that cannot be measured is missing as ``part.member``."""
        inner = {name: self.measure(f"{part}.{name}", lambda name=name: work(name)) for name in names}
        for name in names:
            del self.parts[f"{part}.{name}"]
        self.seconds[part] = sum(self.seconds.pop(f"{part}.{name}") for name in names)
        self.parts[part] = inner


@dataclass(frozen=True)
class Errors:
    """Round-off and model error of a choice."""

    choice: Choice

    @property
    def label(self) -> str:
        """What is said while it is measured."""
        return f"{self.choice.name}: errors"

    def run(self) -> Found:
        """Measures it."""
        found, choice = Found(), self.choice
        function = choice.function(choice.own)
        flat = sampling.inputs(function, choice.domain, sampling.COUNT)
        found.measure_each("roundoff", roundoff.MODES, lambda mode: roundoff.roundoff(function, flat, mode))
        found.measure("model", lambda: model.model(function, choice.function(choice.own, choice.exact), flat))
        return found


@dataclass(frozen=True)
class Soundness:
    """Extremes and energy of the whole model, or of a function that is no part of it."""

    choice: Choice

    @property
    def label(self) -> str:
        """What is said while it is measured."""
        return f"{self.choice.name}: extremes, energy"

    def run(self) -> Found:
        """Measures it."""
        found, choice = Found(), self.choice
        function = choice.function(choice.whole)
        flat = _extremes() if choice.whole == WHOLE else _extremes_of(function, choice.whole_domain)
        found.measure_each("extremes", MODES, lambda m: extremes.count_broken(function.with_mode(m), flat))
        found.parts["extremes"]["inputs"] = len(next(iter(flat.values())))
        if choice.whole == WHOLE:
            found.measure("energy", lambda: energy.energy(function))
        else:
            found.lack("energy", f"{choice.whole} scatters no light")
        return found


@dataclass(frozen=True)
class Picture:
    """The scene under the macros of a choice, beside that of the reference."""

    choice: Choice
    project_path: str

    @property
    def label(self) -> str:
        """What is said while it is measured."""
        return f"{self.choice.name}: scene"

    def run(self) -> Found:
        """Measures it."""
        found, choice = Found(), self.choice

        def seen() -> dict[str, Any]:
            reference = _picture(self.project_path, tuple(choice.reference.items()))
            return asdict(scene.difference(scene.picture(self.project_path, choice.scene, scene.SIZE), reference))

        found.measure("scene", seen)
        if found.parts["scene"] and (reason := scene.flip_unavailable()):
            found.missing["scene.flip"] = reason
        return found


Task = Errors | Soundness | Picture


def tasks(project_path: str, chosen: Sequence[Choice]) -> list[tuple[Task, list[int]]]:
    """The work for choices, and to which of them each piece belongs: what compiles to the same text is done once."""
    found: dict[tuple, tuple[Task, list[int]]] = {}
    for k, choice in enumerate(chosen):
        text = timing.without_blank_lines(choice.function(choice.whole)._library.source.text)
        for key, task in (
            (("sound", text, choice.whole), Soundness(choice)),
            (("errors", k), Errors(choice)),
            (("scene", tuple(sorted(choice.scene.items()))), Picture(choice, project_path)),
        ):
            found.setdefault(key, (task, []))[1].append(k)
    return list(found.values())


def done(work: Sequence[Task], *, spread: bool) -> Iterator[tuple[int, Found]]:
    """(place of the task, what it found), as they are done: by all cores if ``spread``, which takes a second to start,
    else here."""
    if spread:
        yield from jobs.run(_run, work)
    else:
        for k, task in enumerate(work):
            yield k, task.run()


def _run(task: Task) -> Found:
    return task.run()


@cache
def _extremes() -> Mapping[str, np.ndarray]:
    return extremes.inputs(extremes.COUNT)


def _extremes_of(function: Function, words: Mapping[str, Any]) -> Mapping[str, np.ndarray]:
    """Of a function that is not ``shade``: the edges of its domain, and what is near them."""
    return domain.inputs_of(function, words, extremes.COUNT, extremes.SEED).flat


@cache
def _picture(project_path: str, macros: tuple[tuple[str, str], ...]) -> np.ndarray:
    return scene.picture(project_path, dict(macros), scene.SIZE)
