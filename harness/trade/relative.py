"""Relative errors and what is told of many: the median, what 99 of 100 stay below, the largest, and where it is."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..comparing.budget import Spread
from ..comparing.ulp import PRECISIONS, distance
from .values import Flat, shown


def errors(got: np.ndarray, want: np.ndarray, precision: str = "float32") -> np.ndarray:
    """Of each evaluation the largest relative error of its numbers: (n, numbers) arrays to (n,).

    Relative to what is right, or to the smallest normal number of ``precision`` where that is larger: below it no
    format holds digits. inf where one of the two alone is a number, 0 where neither is.
    """
    scale = np.maximum(np.abs(want), PRECISIONS[precision].smallest_normal)
    return (distance(got, want) / np.where(np.isfinite(want), scale, 1)).max(axis=1)


def summary(errors: np.ndarray, flat: Flat) -> dict[str, Any]:
    """``median``, ``p99``, ``max``, and the input of the largest, ``at`` and ``hex``."""
    spread = Spread.of(errors)
    worst = int(np.argmax(errors))
    return {"median": spread.median, "p99": spread.p99, "max": spread.max, **shown(flat, worst)}
