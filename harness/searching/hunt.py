"""``hunt``: searches a domain for the inputs at which a function is at its worst.

Not by chance alone: first the edges meet each other, then inputs are drawn that are weighted to them, and around the
worst found so far others are tried, at distances from one ulp to the whole domain, or with a part of another's. The
search is cut into islands that know nothing of each other, each from the seed and its own number: any number of workers
finds the same.
"""

from __future__ import annotations

import itertools
import pickle
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import DomainError
from ..processes import jobs
from .domain import ROW, Domain
from .goals import Goal, Trial
from .goals import goals as read_goals
from .inputs import Batch
from .spaces import SIMPLE, Unit, from_ordered, ordered

if TYPE_CHECKING:
    from ..calling.function import Function

ISLAND = 1 << 17  # evaluations of one island, for each goal
_DRAWN = 1 << 14  # inputs evaluated at once where they are drawn
_BORN = 1 << 11  # and where they descend from the worst
_KEPT = 64  # of the worst, to descend from

Columns = dict[str, np.ndarray]


@dataclass(frozen=True)
class Finding:
    """The worst input that was found for a goal, as one of ``trial``; ``bad`` when its score is beyond the limit."""

    goal: Goal
    score: float
    trial: Trial
    samples: int

    @property
    def bad(self) -> bool:
        """Whether it is what was looked for."""
        return self.score > self.goal.limit

    @property
    def inputs(self) -> Batch:
        """The input."""
        return self.trial.batch.element((0,))


def hunt(
    f: Function,
    domain: Mapping[str, Any],
    find: Sequence[str] = ("nonfinite",),
    *,
    samples: int = 1_000_000,
    seconds: float | None = None,
    seed: int = 0,
    max_ulp: float = 4.0,
    scheduler: str | None = None,
    workers: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> list[Finding]:
    """The worst inputs of ``f`` in a domain (domain.py), one for each goal of ``find`` (goals.py).

    ``samples`` evaluations are spent on each goal, in whole islands of ISLAND; or as many islands as are done within
    ``seconds``: ``Finding.samples`` says how many they were, and the same number finds the same again, with any number
    of ``workers`` or on the Dask cluster at ``scheduler``. ``progress`` is told the share that is done. DomainError.
    """
    wanted = read_goals(find, max_ulp)
    where = Domain.of(f, domain)
    searched = {goal: goal.domain(where) for goal in wanted}
    for goal, own in searched.items():  # what is wrong with a goal or a mode shows at the first input
        goal.score(Trial(f, own, own.draw(1, np.random.default_rng(seed))))
    if samples < 1 or (seconds is not None and not seconds > 0):
        raise DomainError("there has to be at least one sample, and some time")
    count = None if seconds else -(-samples // ISLAND)
    function = pickle.dumps(f)
    numbers = itertools.count() if seconds else range(count)
    items = (_Island(function, dict(domain), tuple(wanted), seed, number) for number in numbers)
    done: dict[int, list[tuple[float, Columns]]] = {}
    started = time.monotonic()
    running = jobs.run(_search, items, scheduler=scheduler, workers=workers)
    for number, found in running:
        done[number] = found
        passed = time.monotonic() - started
        progress(min(1.0, passed / seconds) if seconds else len(done) / count)
        if seconds and passed >= seconds and 0 in done:
            break
    running.close()
    whole = next(k for k in itertools.count() if k not in done)  # those before the first that is not done
    findings = []
    for k, (goal, own) in enumerate(searched.items()):
        score, flat = max((done[number][k] for number in range(whole)), key=lambda pair: pair[0])
        score, flat = _simplified(f, own, goal, score, flat)
        findings.append(Finding(goal, score, Trial(f, own, flat), whole * ISLAND))
    return findings


# ---- One island ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Island:
    function: bytes
    domain: Mapping[str, Any]
    goals: tuple[Goal, ...]
    seed: int
    number: int


@lru_cache(maxsize=2)
def _function(pickled: bytes) -> Function:
    """The same function for all islands of a process: compiled once."""
    return pickle.loads(pickled)


def _search(island: _Island) -> list[tuple[float, Columns]]:
    """For each goal the worst score, and its input."""
    f = _function(island.function)
    where = Domain.of(f, island.domain)
    found = []
    for k, goal in enumerate(island.goals):
        random = np.random.default_rng([island.seed, island.number, k])
        pool = _Pool(f, goal, goal.domain(where))
        left = ISLAND // 2
        if island.number == 0:
            pool.add(pool.domain.edge_columns(left // 2, random))
        while left > 0:
            pool.add(pool.domain.draw(_DRAWN, random))
            left -= _DRAWN
        for _ in range(ISLAND // 2 // _BORN):
            pool.add(_descendants(pool.domain, pool.kept, _BORN, random))
        found.append((float(pool.scores[0]), {name: column[:1] for name, column in pool.kept.items()}))
    return found


class _Pool:
    """The worst inputs so far, the worst first."""

    def __init__(self, f: Function, goal: Goal, domain: Domain):
        self.f, self.goal, self.domain = f, goal, domain
        self.kept: Columns = {}
        self.scores = np.empty(0)

    def add(self, flat: Columns) -> None:
        """Evaluates more, and keeps the worst of all."""
        scores = self.goal.score(Trial(self.f, self.domain, flat))
        joined = {name: np.concatenate([self.kept[name], v]) if self.kept else v for name, v in flat.items()}
        scores = np.concatenate([self.scores, scores])
        order = np.argsort(-scores, kind="stable")  # of equals those that were there first
        again = np.diff(scores[order], prepend=np.nan) == 0  # behind the others: what descends from them is more varied
        best = order[np.argsort(again, kind="stable")][:_KEPT]
        self.kept, self.scores = {name: column[best] for name, column in joined.items()}, scores[best]


def _descendants(domain: Domain, kept: Columns, count: int, random: np.random.Generator) -> Columns:
    """Inputs near those kept: steps of any size in some numbers, parts of others and new parts, relations."""
    parents = random.integers(0, len(kept[ROW]), count)
    others = random.integers(0, len(kept[ROW]), count)
    fresh = domain.draw(count, random)
    flat = {}
    for name, column in kept.items():
        own = column[parents]
        kind = random.random((count, 1))
        if name in domain.spaces:
            own = np.where(kind < 0.5, _stepped(domain, name, own, random), own)
        own = np.where(kind > 0.9, fresh[name], np.where(kind > 0.8, column[others], own))
        flat[name] = own.astype(column.dtype)
    related = random.integers(1, 7, count) * (random.random(count) < 0.1)
    domain.relate(flat, related, random.random(count))
    return flat


def _stepped(domain: Domain, name: str, values: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """The values moved, in their space: floats along their order by 1 ... 2^28 places, or by a share of their size."""
    space = domain.spaces[name]
    size = np.exp2(random.uniform(0, 28, (len(values), 1)))
    sign = random.integers(-1, 2, values.shape)  # one in three numbers stays
    if values.dtype.kind != "f":
        return space.clip(values.astype(np.float64) + sign * np.rint(np.sqrt(size)))
    if isinstance(space, Unit):
        return space.clip(values + sign * size * random.random(values.shape) * 2.0**-27)
    largest = ordered(np.float32(np.finfo(np.float32).max))
    return space.clip(from_ordered(np.clip(ordered(values) + sign * np.rint(size), -largest, largest)))


def _simplified(f: Function, domain: Domain, goal: Goal, score: float, flat: Columns) -> tuple[float, Columns]:
    """The same finding with parts replaced by simpler ones, where it is a matter of yes or no and stays one."""
    if goal.kind not in ("nonfinite", "negative") or not score > goal.limit:
        return score, flat
    for name, space in domain.spaces.items():
        tried = {n: np.repeat(column, SIMPLE, axis=0) for n, column in flat.items()}
        tried[name] = space.simple.astype(flat[name].dtype)
        scores = goal.score(Trial(f, domain, tried))
        if (scores > goal.limit).any():
            first = int(np.argmax(scores > goal.limit))
            score, flat = float(scores[first]), {n: column[first : first + 1] for n, column in tried.items()}
    return score, flat
