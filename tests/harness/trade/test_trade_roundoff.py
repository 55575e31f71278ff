"""Round-off of known functions. Expected: numpy's float32 and float16, which are IEEE's as the modes are."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError
from harness.trade.roundoff import roundoff

X = np.random.default_rng(0).uniform(0.001, 1, 5000)


def expected(kind):
    """Of (1 + x) - 1, which is x: what is lost when 1 + x is rounded."""
    x = X.astype(np.float32)
    got = ((kind(1) + x.astype(kind)) - kind(1)).astype(float)
    return np.abs(got - x) / x


def test_cancellation_in_single_precision(functions):
    found = roundoff(functions("float f(float x) { return (1.0 + x) - 1.0; }").f, {"x": X}, "precise")
    errors = expected(np.float32)
    assert found["max"] == errors.max() and found["at"]["x"] == np.float32(X[errors.argmax()])
    assert found["p99"] == np.quantile(errors, 0.99, method="higher")
    assert found["median"] == np.quantile(errors, 0.5, method="higher")


def test_cancellation_in_half_precision(functions):
    """The argument is rounded to half precision, too; it counts, for what half precision gets is not the same x."""
    found = roundoff(functions("float f(float x) { return (1.0 + x) - 1.0; }").f, {"x": X}, "mediump")
    assert found["max"] == pytest.approx(expected(np.float16).max(), rel=1e-12)


def test_the_rounding_of_the_inputs_does_not_count(functions):
    assert roundoff(functions("float f(float x) { return x; }").f, {"x": X + 1e-12}, "precise")["max"] == 0


def test_overflow_in_half_precision_is_infinitely_wrong(functions):
    f = functions("float f(float x) { return x * 65504.0 * 4.0; }").f
    found = roundoff(f, {"x": np.array([0.5, 0.1])}, "mediump")
    assert found["max"] == np.inf and found["at"]["x"] == 0.5


def test_a_function_that_a_mode_cannot_have_is_refused(functions):
    f = functions("uniform sampler2D map; float f(float x) { return texture(map, vec2(x)).r; }").f
    with pytest.raises(CallError):
        roundoff(f, {"x": X}, "precise")
