"""How far numbers lie apart: in units in the last place of a binary format of IEEE 754, and as they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..errors import CompareError


@dataclass(frozen=True)
class Precision:
    """A binary format of IEEE 754: digits of the significand, and the exponent of its smallest number, a power of 2."""

    digits: int
    smallest: int

    @property
    def smallest_normal(self) -> float:
        """Below it numbers are denormal."""
        return 2.0 ** (self.smallest + self.digits - 1)

    @property
    def flushed_below(self) -> float:
        """Below it a result that is a little off, as pow() is, may be denormal and so 0: smallest normal + 1/8192."""
        return self.smallest_normal * (1 + 2.0**-13)


PRECISIONS = {"float16": Precision(11, -24), "float32": Precision(24, -149), "float64": Precision(53, -1074)}


def ulp_difference(got: np.ndarray, want: np.ndarray, precision: str = "float32") -> np.ndarray:
    """How far ``got`` lies from ``want``, in ulps of ``precision`` at ``want``; both broadcast.

    ``want`` may be more precise. Two NaN, or the same infinity, are 0 apart; NaN and a number, or an infinity and
    anything else, are inf apart. Zeros of either sign are equal. An integer array has ulps of 1.
    """
    kind = precision_named(precision)
    whole = isinstance(got, np.ndarray | np.generic) and got.dtype.kind in "iub"
    got = np.asarray(got, np.float64)
    want = np.asarray(want, np.float64)
    # |want| is in [2^(exponent - 1), 2^exponent), where floats are 2^(exponent - digits) apart, or as the smallest are
    _, exponent = np.frexp(np.where(np.isfinite(want), np.maximum(np.abs(want), 2.0**kind.smallest), 1.0))
    spacing = 1.0 if whole else np.ldexp(1.0, np.maximum(exponent - kind.digits, kind.smallest))
    with np.errstate(invalid="ignore", over="ignore"):
        ulps = np.minimum(np.abs(got - want) / spacing, np.finfo(np.float64).max)
    same = (got == want) | (np.isnan(got) & np.isnan(want))
    return np.where(same, 0.0, np.where(np.isfinite(got) & np.isfinite(want), ulps, np.inf))


def distance(got: np.ndarray, want: np.ndarray) -> np.ndarray:
    """|got − want|: 0 between two NaN or equal infinities, inf where only one of both is a number."""
    got = got.astype(np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.minimum(np.abs(got - want), np.finfo(np.float64).max)
    same = (got == want) | (np.isnan(got) & np.isnan(want))
    return np.where(same, 0.0, np.where(np.isfinite(got) & np.isfinite(want), off, np.inf))


def precision_named(name: str) -> Precision:
    """The format of this name. CompareError when there is none."""
    if name not in PRECISIONS:
        raise CompareError(f"no precision {name!r}; there are: {', '.join(PRECISIONS)}")
    return PRECISIONS[name]
