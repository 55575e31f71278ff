"""What a hunt looks for: goals give every input a score, the higher the worse, and say which score is a finding."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..comparing.ulp import PRECISIONS, ulp_difference
from ..errors import DomainError
from .domain import ROW, Domain
from .inputs import Batch, results
from .spaces import Interval

if TYPE_CHECKING:
    from ..calling.function import Function

GOALS = {
    "nonfinite": "a result that is NaN or infinite",
    "negative": "a result below 0",
    "ulp": "a result more than --max-ulp ulps off the same source in double",
    "monotone:X": "a result that goes back, by more than --max-ulp ulps, while X goes from one end to the other",
    "symmetric:A,B": "a result that changes, by more than --max-ulp ulps, when A and B change places",
}
_UPPER = "'"  # x' is the other value of x


@dataclass(frozen=True)
class Goal:
    """One thing to look for: a kind of ``GOALS``, and the names of inputs that go with it."""

    kind: str
    names: tuple[str, ...]
    max_ulp: float

    @classmethod
    def read(cls, text: str, max_ulp: float) -> Goal:
        """From the command line's words. DomainError where there is no such goal."""
        kind, _, rest = text.partition(":")
        names = tuple(name.strip() for name in rest.split(",")) if rest else ()
        wanted = {"nonfinite": 0, "negative": 0, "ulp": 0, "monotone": 1, "symmetric": 2}
        if kind not in wanted or len(names) != wanted[kind] or not all(names):
            raise DomainError(f"nothing is known of finding {text!r}; there are {', '.join(GOALS)}")
        if not (np.isfinite(max_ulp) and max_ulp >= 0):
            raise DomainError(f"max_ulp has to be finite and not negative, and is {max_ulp}")
        return cls(kind, names, max_ulp)

    def __str__(self):
        return f"{self.kind}:{','.join(self.names)}" if self.names else self.kind

    @property
    def limit(self) -> float:
        """Scores above it are findings."""
        return {"nonfinite": np.finfo(np.float64).max, "negative": 0.0}.get(self.kind, self.max_ulp)

    def domain(self, domain: Domain) -> Domain:
        """What is searched: for monotony, inputs with another value of the one that moves."""
        if self.kind != "monotone":
            return domain
        space = domain.spaces.get(self.names[0])
        if not isinstance(space, Interval) or space.width > 1:
            raise DomainError(f"{self}: {self.names[0]} is no number that moves in an interval")
        return replace(domain, spaces={**domain.spaces, self.names[0] + _UPPER: space})

    def score(self, trial: Trial) -> np.ndarray:
        """How bad each input is: (n,) float64, inf for what is no number and should be."""
        return getattr(self, f"_{self.kind}")(trial)

    def _nonfinite(self, trial: Trial) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            return _worst(np.where(np.isfinite(trial.got), np.abs(trial.got), np.inf))

    def _negative(self, trial: Trial) -> np.ndarray:
        return _worst(np.where(np.isnan(trial.got), -np.inf, 0.0 - trial.got))

    def _ulp(self, trial: Trial) -> np.ndarray:
        flushed = (trial.got == 0) & (np.abs(trial.double) < PRECISIONS["float32"].flushed_below)
        return _worst(np.where(flushed, 0.0, ulp_difference(trial.got, trial.double)))

    def _monotone(self, trial: Trial) -> np.ndarray:
        lower, upper, start, end = trial.path(self.names[0])
        direction = np.sign(end - start)
        with np.errstate(invalid="ignore"):
            back = np.where(direction == 0, upper != lower, (upper - lower) * direction < 0)
        return _worst(np.where(back, ulp_difference(upper, lower), 0.0))

    def _symmetric(self, trial: Trial) -> np.ndarray:
        return _worst(ulp_difference(trial.got, trial.swapped(*self.names)))


def _worst(scores: np.ndarray) -> np.ndarray:
    return scores.max(axis=1)


class Trial:
    """A function at a batch of inputs: what it returns there, and elsewhere where a goal asks; float64 (n, numbers)."""

    def __init__(self, f: Function, domain: Domain, flat: Mapping[str, np.ndarray]):
        self.f, self.domain, self.flat = f, domain, flat

    @cached_property
    def batch(self) -> Batch:
        """The inputs."""
        return self.domain.batch(self.flat)

    @cached_property
    def got(self) -> np.ndarray:
        """What the function returns."""
        return _returned(self.f, self.batch)

    @cached_property
    def double(self) -> np.ndarray:
        """What the same source in double returns."""
        return _returned(self.f.with_mode("double"), self.batch)

    def swapped(self, a: str, b: str) -> np.ndarray:
        """What it returns when two inputs have changed places."""
        flat = dict(self.batch.flat)
        pairs = [(n, b + n[len(a) :]) for n in flat if n == a or n.startswith((f"{a}.", f"{a}["))]
        if not pairs or a == b or any(o not in flat or flat[o].shape != flat[n].shape for n, o in pairs):
            raise DomainError(f"symmetric:{a},{b}: {a} and {b} are not two inputs of the same type")
        for name, other in pairs:
            flat[name], flat[other] = flat[other], flat[name]
        return _returned(self.f, replace(self.batch, flat=flat))

    def steps(self, name: str) -> list[np.ndarray]:
        """The smaller and the larger of the two values of an input."""
        return [choose(self.flat[name], self.flat[name + _UPPER]) for choose in (np.minimum, np.maximum)]

    def path(self, name: str) -> list[np.ndarray]:
        """What it returns at the smaller and the larger value of an input, and at both ends of its interval."""
        space, count = self.domain.spaces[name], len(self.flat[ROW])
        ends = [np.full((count, 1), end) for end in (space.low, space.high)]
        flat = {n: np.concatenate([v] * 4) for n, v in self.flat.items()}
        flat[name] = np.concatenate([*self.steps(name), *ends])
        return np.split(_returned(self.f, self.domain.batch(flat)), 4)


def _returned(f: Function, batch: Batch) -> np.ndarray:
    arrays = results(f(**batch.arguments())).values()
    return np.concatenate([a.reshape(batch.size, -1).astype(np.float64) for a in arrays], axis=1)


def goals(texts: Sequence[str], max_ulp: float) -> list[Goal]:
    """The goals of the command line's words, each once."""
    return list(dict.fromkeys(Goal.read(text, max_ulp) for text in texts))
