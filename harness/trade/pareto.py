"""Who gives more for less: of choices with a cost and an error each, those that no other beats in both."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


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
