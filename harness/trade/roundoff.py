"""Round-off: how far a formula in single and in half precision is from the same formula in double."""

from __future__ import annotations

from typing import Any

from ..calling.function import Function
from . import relative
from .values import Flat, rounded, values

MODES = ("as-written", "precise", "mediump")


def roundoff(function: Function, flat: Flat, mode: str) -> dict[str, Any]:
    """``relative.summary`` of one mode against "double", both at the same float32 inputs.

    So the rounding of the inputs themselves does not count. Relative to the result, or to the smallest normal number
    of the mode's format (2^-126, in half precision 2^-14) where that is larger. HarnessError when the function cannot
    be evaluated in the mode.
    """
    given = rounded(flat)
    want = values(function.with_mode("double"), given)
    got = values(function.with_mode(mode), given)
    return relative.summary(relative.errors(got, want, "float16" if mode == "mediump" else "float32"), given)
