"""Comparing results with expectations: in units in the last place, or within tolerances of one's own.

What holds for every comparison here:

- NaN equals NaN and nothing else, an infinity equals itself and nothing else, however wide the tolerance.
- Zeros of either sign are equal, unless ``signed_zeros=True``.
- A driver may flush denormals: 0 passes for an expectation below the smallest normal number, unless
  ``flush_denormals=False``. (It may flush denormal *inputs* too; then give it none.)
- What could pass without comparing anything is an error (CompareError): nothing to compare, shapes that numpy would
  broadcast into something else than was meant, tolerances that are NaN, infinite or negative.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import CompareError
from ..searching.inputs import Batch, elementwise, results
from .budget import error_budget
from .failure import Comparison, fail
from .finite import assert_finite
from .ulp import Precision, distance, precision_named, ulp_difference

if TYPE_CHECKING:
    from ..calling.function import Function

__all__ = ["assert_close", "assert_finite", "assert_ulp", "elementwise", "error_budget", "ulp_difference"]


def assert_ulp(
    got: Any,
    want: Any,
    max_ulp: Any,
    atol_near_zero: Any = 0.0,
    *,
    inputs: Mapping[str, Any] | None = None,
    precision: str = "float32",
    flush_denormals: bool = True,
    signed_zeros: bool = False,
) -> None:
    """Fails unless every ``got`` is within ``max_ulp`` ulps, or within ``atol_near_zero``, of ``want``.

        assert_ulp(brdf.D_GGX(1, 0.25), 1 / (np.pi * 0.25**2), max_ulp=4)
        assert_ulp(brdf.D_GGX, ggx_in_float64, max_ulp=4, inputs={"NoH": cosines, "alpha": alphas})

    ``got`` is an array, or a GLSL function, evaluated at ``inputs``, its arguments by name (``samples`` makes some).
    ``want`` is an array, or a callable that gets the same inputs as rounded for GLSL, by position, as float64 arrays
    (one by one: ``elementwise``); another function of GLSL will do. With a function the failure also shows its place,
    the worst input and a command that repeats it alone. ``want`` and the tolerances are numbers, or have the
    dimensions of ``got``, each as long or 1. Of NaN, zeros and denormals see the module. AssertionError, CompareError.
    """
    __tracebackhide__ = True  # pytest shows the test's own line
    kind = precision_named(precision)

    def judge(g: np.ndarray, w: np.ndarray, sides: _Sides) -> Comparison:
        ulps = ulp_difference(g, w, precision)
        limit = _tolerance(max_ulp, "max_ulp", g.shape)
        near = _tolerance(atol_near_zero, "atol_near_zero", g.shape)
        with np.errstate(invalid="ignore"):
            good = (ulps <= limit) | (np.abs(g.astype(np.float64) - w) <= near)
        good = _with_policy(good, g, w, kind, flush_denormals, signed_zeros)
        said = f"more than {_span(limit)} ulp off"
        return Comparison(sides.name, g, w, ~good, ulps, said, lambda i: f"{ulps[i]:.3g} ulp")

    _compare(got, want, inputs, judge)


def assert_close(
    got: Any,
    want: Any,
    rtol: Any = 0.0,
    atol: Any = 0.0,
    *,
    inputs: Mapping[str, Any] | None = None,
    precision: str = "float32",
    flush_denormals: bool = True,
    signed_zeros: bool = False,
) -> None:
    """Fails unless |got − want| ≤ atol + rtol |want| everywhere. The tolerances may differ from element to element.

    Both are 0 unless given. All else is as with ``assert_ulp``; ``precision`` says which numbers are denormal.
    """
    __tracebackhide__ = True  # pytest shows the test's own line
    kind = precision_named(precision)

    def judge(g: np.ndarray, w: np.ndarray, sides: _Sides) -> Comparison:
        relative, absolute = _tolerance(rtol, "rtol", g.shape), _tolerance(atol, "atol", g.shape)
        off = distance(g, w)
        with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
            allowed = np.where(np.isfinite(w), absolute + relative * np.abs(w), 0.0)
            good = off <= np.minimum(allowed, np.finfo(np.float64).max)
            excess = np.where(allowed > 0, off / np.where(allowed > 0, allowed, 1), np.where(off > 0, np.inf, 0))
        good = _with_policy(good, g, w, kind, flush_denormals, signed_zeros)
        said = f"further off than rtol {_span(relative)}, atol {_span(absolute)} allow"
        severity = np.where(np.isfinite(off), np.minimum(excess, np.finfo(np.float64).max), np.inf)
        return Comparison(
            sides.name, g, w, ~good, severity, said, lambda i: f"{off[i]:.3g} off where {allowed[i]:.3g} is allowed"
        )

    _compare(got, want, inputs, judge)


# ---- What both have in common ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Sides:
    """One result with its name (empty where there is only one) and what it should be."""

    name: str
    got: np.ndarray
    want: np.ndarray


def _compare(got: Any, want: Any, inputs: Mapping[str, Any] | None, judge: Callable) -> None:
    __tracebackhide__ = True  # pytest shows the test's own line
    function, batch = None, None
    if callable(got):
        function, batch = got, _batch(got, inputs)
        got = function(**batch.arguments())
        want = batch.expected(want) if callable(want) else want
    elif inputs is not None or callable(want):
        raise CompareError("inputs, and an expectation that is a function, go with a GLSL function, not its result")
    fail([judge(sides.got, sides.want, sides) for sides in _paired(got, want)], function, batch)


def _batch(f: Function, inputs: Mapping[str, Any] | None) -> Batch:
    if inputs is None:
        raise CompareError(f"{f!r} is to be evaluated at no inputs: give inputs={{name: values, ...}}")
    batch = Batch.of(f, inputs)
    if not batch.size:
        raise CompareError(f"{f!r} is to be evaluated at none: the inputs are empty")
    return batch


def _paired(got: Any, want: Any) -> Iterator[_Sides]:
    """Each result beside its expectation. CompareError where they do not fit, or there is nothing to compare."""
    left, right = results(got), results(want)
    if len(left) != len(right):
        raise CompareError(f"{', '.join(left)} were returned, and {', '.join(right)} expected")
    by_name = set(left) == set(right)
    for (name, g), other in zip(left.items(), right, strict=True):
        g = g if g.dtype.kind in "fiub" else _numbers(g, "got")
        w = _numbers(right[name if by_name else other], "want")
        if not g.size:
            raise CompareError(f"there is nothing to compare: an array of shape {g.shape}")
        yield _Sides(name if len(left) > 1 else "", g, _fitted(w, "want", g.shape))


def _numbers(values: Any, what: str) -> np.ndarray:
    try:
        array = np.asarray(values)
        if array.dtype.kind == "c":
            raise TypeError("complex numbers")
        return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise CompareError(f"{what} is no array of real numbers: {error}") from None


def _fitted(values: np.ndarray, what: str, shape: tuple[int, ...]) -> np.ndarray:
    """Broadcast only where no mistake can hide: a number, or all the dimensions, each of the same length or 1."""
    fits = values.ndim == len(shape) and all(own in (1, n) for own, n in zip(values.shape, shape, strict=True))
    if values.ndim and not fits:
        raise CompareError(
            f"{what} has the shape {values.shape} where got has {shape}: a number, or as many dimensions, each as long "
            "or 1, are compared"
        )
    return np.broadcast_to(values, shape)


def _tolerance(values: Any, what: str, shape: tuple[int, ...]) -> np.ndarray:
    array = _numbers(values, what)
    if not (np.isfinite(array) & (array >= 0)).all():
        wrong = array[~(np.isfinite(array) & (array >= 0))]
        raise CompareError(f"{what} has to be finite and not negative, and has {wrong}")
    return _fitted(array, what, shape)


def _with_policy(
    good: np.ndarray, got: np.ndarray, want: np.ndarray, kind: Precision, flush_denormals: bool, signed_zeros: bool
) -> np.ndarray:
    if flush_denormals:
        good = good | ((got == 0) & (np.abs(want) < kind.smallest_normal))
    if signed_zeros:
        good = good & ~((got == 0) & (want == 0) & (np.signbit(got) != np.signbit(want)))
    return good


def _span(limits: np.ndarray) -> str:
    """One number, or the range of those that differ from element to element."""
    low, high = limits.min(), limits.max()
    return f"{low:g}" if low == high else f"{low:g} ... {high:g}"
