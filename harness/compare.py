"""Comparing float32 results with expectations, in units in the last place."""

from __future__ import annotations

import numpy as np


def ulp_difference(got: np.ndarray, want: np.ndarray) -> np.ndarray:
    """How far ``got`` lies from ``want``, in ulps of float32 at ``want``; both broadcast.

    ``want`` may be more precise than float32. Two NaN, or the same infinity, are 0 apart; NaN and a number, or an
    infinity and anything else, are inf apart. Zeros of either sign are equal.
    """
    got = np.asarray(got, np.float64)
    want = np.asarray(want, np.float64)
    # |want| is in [2^(exponent - 1), 2^exponent), where floats are 2^(exponent - 24) apart, but never less than 2^-149
    _, exponent = np.frexp(np.where(np.isfinite(want), np.maximum(np.abs(want), 2.0**-149), 1.0))
    spacing = np.ldexp(1.0, np.maximum(exponent - 24, -149))
    with np.errstate(invalid="ignore", over="ignore"):
        ulps = np.abs(got - want) / spacing
    same = (got == want) | (np.isnan(got) & np.isnan(want))
    return np.where(same, 0.0, np.where(np.isfinite(ulps), ulps, np.inf))


def assert_ulp(got, want, max_ulp: float, atol_near_zero: float = 0.0) -> None:
    """Fails unless every float32 ``got`` is within ``max_ulp`` ulps, or ``atol_near_zero``, of ``want``.

    The message counts the failures and shows the worst, in decimal and hexadecimal.
    """
    got, want = np.broadcast_arrays(np.asarray(got, np.float64), np.asarray(want, np.float64))
    ulps = ulp_difference(got, want)
    with np.errstate(invalid="ignore"):
        near_zero = np.abs(got - want) <= atol_near_zero
    bad = (ulps > max_ulp) & ~near_zero
    if not bad.any():
        return
    worst = np.unravel_index(np.argmax(np.where(bad, ulps, -1.0)), ulps.shape)
    g, w = float(got[worst]), float(want[worst])
    raise AssertionError(
        f"{bad.sum()} of {bad.size} values are more than {max_ulp:g} ulp off; the worst, at {tuple(map(int, worst))}: "
        f"got {g!r} ({g.hex()}), want {w!r} ({w.hex()}), {ulps[worst]:.3g} ulp"
    )
