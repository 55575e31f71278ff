"""The error budget: what is the model's, and what its arithmetic's. Expected from errors that were put there."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CompareError, error_budget
from harness.comparing.budget import Spread

#: x with 1/8 added to the model, and in the other mode 1/4 of round-off
TEXT = """
float f(float x) { return x + 0.125; }
float off(float x) { return x + 0.375; }
vec2 pair(float x) { return vec2(x, x + 1.0); }
"""


class Modes:
    """A function whose modes are other functions: what is tested is what becomes of their results."""

    def __init__(self, double, **modes):
        self._modes = {"double": double, **{name.replace("_", "-"): f for name, f in modes.items()}}
        self._f = modes["as_written"]
        self.__name__ = "f"

    def __getattr__(self, name):
        return getattr(self._f, name)

    def with_mode(self, mode):
        return self._modes[mode]


def in_double(x):
    return np.asarray(x, np.float64) + 0.125


@pytest.fixture
def f(functions):
    made = functions(TEXT)
    return Modes(in_double, as_written=made.f, precise=made.off)


def test_model_and_round_off_are_told_apart(f):
    """x in 1 ... 1.5: model 1/8 against x; as written none, but for rounding; the other mode 1/4."""
    x = 1 + np.arange(256) / 512
    budget = error_budget(f, lambda x: x, {"x": x})
    assert budget.count == 256
    assert budget.model.absolute == Spread(0.125, 0.125, 0.125)
    assert budget.model.relative.max == 0.125
    assert budget.model.ulp.max == 2**20  # 2^-3 of 2^-23
    assert budget.round_off["as-written"].absolute.max == 0
    assert budget.round_off["precise"].absolute == Spread(0.25, 0.25, 0.25)


def test_half_precision_has_ulps_of_its_own(functions):
    made = functions(TEXT)
    f = Modes(in_double, as_written=made.f, mediump=made.off)
    budget = error_budget(f, lambda x: x, {"x": [1.0]}, modes=["mediump"])
    assert budget.round_off["mediump"].ulp.max == 2**8  # 2^-2 of 2^-10


def test_the_worst_input_is_kept_and_shown(f):
    def reference(x):
        return np.where(x == 1.25, 100.0, x + 0.125)

    budget = error_budget(f, reference, {"x": [1.0, 1.25, 1.5]})
    assert budget.model.worst.flat["x"] == 1.25
    assert (budget.model.got, budget.model.want) == (1.375, 100.0)
    text = repr(budget)
    assert text.startswith("f, 3 inputs\n")
    assert "model, worst: x = 1.25 (0x1.4p+0): got 1.375 (0x1.6p+0), want 100.0 (0x1.9p+6)" in text
    assert "round-off, precise" in text


def test_a_spread_is_of_values_that_occur():
    errors = np.arange(1.0, 101.0)
    assert Spread.of(errors) == Spread(100.0, 100.0, 51.0)
    errors[-1] = np.inf
    assert Spread.of(errors) == Spread(np.inf, np.inf, 51.0)
    assert Spread.of(np.append(np.zeros(1000), np.inf)) == Spread(np.inf, 0.0, 0.0)


def test_what_is_no_number_counts_as_infinite(f):
    budget = error_budget(f, lambda x: np.where(x > 1, np.nan, x), {"x": [1.0, 2.0]})
    assert budget.model.absolute.max == np.inf
    assert budget.model.worst.flat["x"] == 2


def test_inputs_may_be_a_domain(f):
    budget = error_budget(f, lambda x: x + 0.125, {"x": "[0,1]"}, n=500, seed=3)
    assert budget.count == 500
    assert budget.model.ulp.max == 0
    assert 0 < budget.round_off["as-written"].ulp.max <= 0.5  # one rounding


def test_a_reference_of_another_shape_is_refused(f):
    with pytest.raises(CompareError, match="result has the shape"):
        error_budget(f, lambda x: x[:1], {"x": [1.0, 2.0]})
