"""Whether two contenders computed the same thing: before that, no time means anything."""

from __future__ import annotations

import numpy as np

from .inputs import LEAST_ROUGHNESS

#: Largest relative difference of one value. Both round as if n had been turned by up to 6 half units in the last place
#: (test_shade.py), by which ln D changes 2/alpha times as much at most; 1e-5 for all else. The worst found is 2e-5.
TOLERANCE = 1e-5 + 2 * 2 / LEAST_ROUGHNESS**2 * 6 * 2.0**-24


def disagreement(result: np.ndarray, reference: np.ndarray) -> float:
    """Largest relative difference of a value to the reference's; infinite where shape, type or NaN and Inf differ."""
    if result.shape != reference.shape or result.dtype != reference.dtype:
        return np.inf
    with np.errstate(invalid="ignore", divide="ignore"):
        difference = np.abs(result - reference) / np.abs(reference)
    difference[result == reference] = 0  # 0/0, Inf - Inf
    return float(np.nan_to_num(difference, nan=np.inf).max(initial=0))


def agrees(result: np.ndarray, reference: np.ndarray) -> bool:
    """Whether a contender's result is within TOLERANCE of the reference."""
    return disagreement(result, reference) <= TOLERANCE
