"""assert_finite: results, and what a function computes on the way; the message leads to the line and the input."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from harness import DomainError, assert_finite

TEXT = """
float inverse(float x) { return 1.0 / x; }
float square(float x) { return x * x; }
float signed_one(float x) { return x - 0.5; }
int whole(int i) { return i; }
float hidden(float x)
{
    float r = sqrt(x - 0.5);
    return max(r, 0.0);
}
"""


@dataclass
class Local:
    """A local of a trace, as the interpreter has it."""

    name: str
    file: str
    line: int
    values: np.ndarray
    executed: np.ndarray


def traced(f, locals_at):
    """The function with a trace that is worked out by numpy: what is tested is what becomes of a trace."""

    class Traced(type(f)):
        def trace(self, **inputs):
            with np.errstate(invalid="ignore"):
                return locals_at(np.asarray(inputs["x"]))

    f.__class__ = Traced
    return f


def root(x):
    r = np.sqrt(x - np.float32(0.5))
    return [Local("x", "a.glsl", 6, x, np.ones(x.shape, bool)), Local("r", "a.glsl", 8, r, np.ones(x.shape, bool))]


def test_finite_results_pass(functions):
    assert_finite(functions(TEXT).square, {"x": "[-1e18,1e18]"}, intermediates=False)


def test_the_one_input_that_is_not_finite_is_found(functions):
    """1/0 at 0, of a thousand million floats; smaller denormals are flushed, or their inverse overflows."""
    with pytest.raises(AssertionError) as caught:
        assert_finite(functions(TEXT).inverse, {"x": "[0,1]"}, intermediates=False)
    message = str(caught.value)
    assert ":2: float inverse(float x): result is not finite at" in message
    assert "the first: inf (inf)\n    x = 0.0 (0x0.0p+0)\n    harness call " in message


def test_a_negative_result_is_found_when_asked_for(functions):
    f = functions(TEXT).signed_one
    assert_finite(f, {"x": "[0,1]"}, intermediates=False)
    with pytest.raises(AssertionError, match="result is not finite, or negative at"):
        assert_finite(f, {"x": "[0,1]"}, nonnegative=True, intermediates=False)
    assert_finite(f, {"x": "[0.5,1]"}, nonnegative=True, intermediates=False)


def test_a_nan_that_the_result_hides_is_found_with_its_line(functions):
    f = traced(functions(TEXT).hidden, root)
    assert_finite(f, {"x": "[0,1]"}, intermediates=False)
    with pytest.raises(AssertionError) as caught:
        assert_finite(f, {"x": "[0,1]"}, n=1000)
    message = str(caught.value)
    assert "r is not finite at" in message
    assert "though the result is; the first: nan (nan), at a.glsl:8" in message
    assert "x = 0.0 (0x0.0p+0)" in message
    assert_finite(f, {"x": "[0.5,1]"}, n=1000)


def test_what_may_overflow_may_not_be_nan(functions):
    def steps(x):
        y = np.where(x == 1, np.float32(np.inf), 1)
        z = np.where(x == 0, np.float32(np.nan), y)
        return [Local("y", "a.glsl", 8, y, np.ones(x.shape, bool)), Local("z", "a.glsl", 9, z, np.ones(x.shape, bool))]

    f = traced(functions(TEXT).square, steps)
    assert_finite(f, {"x": "(0,1)"}, n=1000)
    assert_finite(f, {"x": "(0,1]"}, n=1000, may_overflow=("y", "z"))
    with pytest.raises(AssertionError, match="y is not finite"):
        assert_finite(f, {"x": "(0,1]"}, n=1000, may_overflow=("z",))
    with pytest.raises(AssertionError, match="z is not finite .* nan"):
        assert_finite(f, {"x": "[0,1]"}, n=1000, may_overflow=("y", "z"))


def test_what_was_not_executed_is_not_asked_for(functions):
    def branch(x):
        return [Local("r", "a.glsl", 8, np.full(x.shape, np.nan, np.float32), x < 0)]

    f = traced(functions(TEXT).square, branch)
    assert_finite(f, {"x": "[0,1]"}, n=1000)
    with pytest.raises(AssertionError, match="r is not finite"):
        assert_finite(f, {"x": "[-1,1]"}, n=1000)


def test_a_result_that_is_not_finite_is_traced_to_where_it_began(functions):
    def steps(x):
        y = np.where(x == 0, np.float32(np.inf), 1)
        return [Local("y", "a.glsl", 3, y, np.ones(x.shape, bool)), Local("z", "a.glsl", 4, y, np.ones(x.shape, bool))]

    with pytest.raises(AssertionError, match="the first: inf .inf., from y at a.glsl:3"):
        assert_finite(traced(functions(TEXT).inverse, steps), {"x": "[0,1]"}, n=1000)


def test_given_values_are_tried_each_once(functions):
    f = functions(TEXT).inverse
    assert_finite(f, {"x": [1.0, 2.0, -3.0]}, intermediates=False)
    with pytest.raises(AssertionError, match="at 1 of 3 inputs"):
        assert_finite(f, {"x": [1.0, 0.0, -3.0]}, intermediates=False)


def test_integers_are_finite(functions):
    assert_finite(functions(TEXT).whole, {"i": "int"}, intermediates=False)


def test_a_domain_is_needed(functions):
    with pytest.raises(DomainError, match="needs a domain for x"):
        assert_finite(functions(TEXT).square, {})
