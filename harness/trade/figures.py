"""What entries of a trade are compared by: error, soundness and cost, None where one was not measured."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .pareto import Point

Entry = Mapping[str, Any]
#: modes that compute in single precision, and in half
SINGLE, HALF = ("as-written", "precise"), ("mediump",)


def rounding(entry: Entry, modes: Sequence[str] = SINGLE) -> float | None:
    """The 99th percentile of the error of rounding in the worst of the modes: as written or ``precise``, a compiler may
    do either."""
    measured = entry["roundoff"] or {}
    found = [p99(measured.get(mode)) for mode in modes]
    return None if None in found else max(found)


def error(entry: Entry, modes: Sequence[str] = SINGLE) -> float | None:
    """How far from the exact one an entry may be, relative: the 99th percentiles of what the formula leaves out and of
    rounding, together."""
    formula, rounded = p99(entry["model"]), rounding(entry, modes)
    return None if formula is None or rounded is None else formula + rounded


def broken(entry: Entry, modes: Sequence[str]) -> int | None:
    """How many values at the extreme inputs are not finite or are negative, in the worst of the modes."""
    measured = entry["extremes"] or {}
    counts = [measured.get(mode) for mode in modes]
    return None if None in counts else max(found["non_finite"] + found["negative"] for found in counts)


def cycles(entry: Entry, target: str) -> float | None:
    """What an entry costs on a target, in cycles a wave of 64."""
    return ((entry["cost"] or {}).get(target) or {}).get("cycles")


def operations(entry: Entry) -> float | None:
    """What an entry costs in weighted SPIR-V operations."""
    return (entry["cost"] or {}).get("spirv")


def points(entries: Iterable[Entry], target: str, modes: Sequence[str] = SINGLE) -> list[Point]:
    """The entries whose cost on the target and whose error in the modes are known."""
    measured = [(entry["name"], cycles(entry, target), error(entry, modes)) for entry in entries]
    return [Point(name, cost, wrong) for name, cost, wrong in measured if cost is not None and wrong is not None]


def p99(spread: Entry | None) -> float | None:
    """The 99th percentile of a distribution of errors."""
    return None if spread is None else spread["p99"]
