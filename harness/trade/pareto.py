"""Who gives more for less: of choices with a cost and an error each, those that no other beats in both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

#: modes that compute in single precision, and in half
SINGLE, HALF = ("as-written", "precise"), ("mediump",)


@dataclass(frozen=True)
class Point:
    """A choice: its ``cost`` and its ``error``, numbers of which less is better; infinity is allowed, NaN is not."""

    name: str
    cost: float
    error: float


def dominates(one: Point, other: Point) -> bool:
    """Whether ``one`` is no worse in both and better in one. Equal choices do not dominate each other."""
    no_worse = one.cost <= other.cost and one.error <= other.error
    return no_worse and (one.cost < other.cost or one.error < other.error)


def front(points: Sequence[Point]) -> list[Point]:
    """The choices that none dominates, cheapest first; of equal ones all."""
    kept = [point for point in points if not any(dominates(other, point) for other in points)]
    return sorted(kept, key=lambda point: (point.cost, point.error))


def dominated(points: Sequence[Point]) -> dict[str, str]:
    """The name of each choice that is dominated -> the name of one that does it and is dominated by none.

    Where several do, it is the most accurate of them, and the first in the sequence of equal ones.
    """
    best = [point for point in points if not any(dominates(other, point) for other in points)]
    found = {}
    for point in points:
        above = [other for other in best if dominates(other, point)]
        if above:
            found[point.name] = min(above, key=lambda other: (other.error, other.cost)).name
    return found


def error(entry: Mapping[str, Any], modes: Sequence[str] = SINGLE) -> float | None:
    """How far from the exact one an entry of the trade may be, relative: the 99th percentile of what the formula leaves
    out, plus that of rounding in the worst of the modes: as written or ``precise``, a compiler may do either.

    None where one of them was not measured.
    """
    model, roundoff = entry["model"], entry["roundoff"]
    if model is None or roundoff is None:
        return None
    parts = [model, *(roundoff[mode] for mode in modes)]
    if any(part is None or part["p99"] is None for part in parts):
        return None
    return model["p99"] + max(part["p99"] for part in parts[1:])


def cycles(entry: Mapping[str, Any], target: str) -> float | None:
    """What an entry costs on a target, in cycles a wave of 64; None where that was not measured."""
    return ((entry["cost"] or {}).get(target) or {}).get("cycles")


def points(entries: Iterable[Mapping[str, Any]], target: str, modes: Sequence[str] = SINGLE) -> list[Point]:
    """The entries whose cost on the target and whose error in the modes are known."""
    measured = [(entry["name"], cycles(entry, target), error(entry, modes)) for entry in entries]
    return [Point(name, cost, wrong) for name, cost, wrong in measured if cost is not None and wrong is not None]
