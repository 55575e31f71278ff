"""Distances in units in the last place. Expected values from the layout of IEEE 754 binary32 (24 bits, 2^-149 up)."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from harness import CompareError, assert_close, assert_ulp, elementwise, ulp_difference

ONE_UP = np.nextafter(np.float32(1), np.float32(2))  # 1 + 2^-23
ONE_DOWN = np.nextafter(np.float32(1), np.float32(0))  # 1 - 2^-24
LARGEST = np.finfo(np.float32).max
SMALLEST = np.float32(2.0**-149)
SMALLEST_NORMAL = np.float32(2.0**-126)


@pytest.mark.parametrize(
    ("got", "want", "ulps"),
    [
        (1.0, 1.0, 0),
        (ONE_UP, 1.0, 1),
        (ONE_DOWN, 1.0, 0.5),  # below a power of two floats are twice as dense
        (1.0, ONE_DOWN, 1),
        (2.0, np.nextafter(np.float32(2), np.float32(1)), 1),
        (-ONE_UP, -1.0, 1),
        (ONE_UP, -1.0, 2 / 2.0**-23 + 1),
        (0.0, -0.0, 0),
        (SMALLEST, 0.0, 1),
        (-SMALLEST, SMALLEST, 2),
        (SMALLEST_NORMAL - SMALLEST, SMALLEST_NORMAL, 1),
        (0.0, SMALLEST_NORMAL, 2.0**23),
        (np.nextafter(LARGEST, np.float32(0)), LARGEST, 1),
        (0.0, LARGEST, 2.0**24 - 1),
    ],
)
def test_the_distance_in_ulps_of_what_is_wanted(got, want, ulps):
    assert ulp_difference(np.float32(got), np.float32(want)) == ulps


def test_a_more_precise_expectation_is_not_rounded_first():
    """1 + 2^-25 lies a quarter of an ulp from 1, and three quarters from 1 + 2^-23."""
    assert ulp_difference(np.float32(1), 1 + 2.0**-25) == 0.25
    assert ulp_difference(ONE_UP, 1 + 2.0**-25) == 0.75


def test_just_below_a_power_of_two_the_ulp_is_the_smaller_one():
    """2 - 2^-26 rounds to 2, but lies among floats that are 2^-23 apart."""
    assert ulp_difference(np.float32(2), 2 - 2.0**-26) == 2.0**-26 / 2.0**-23


@pytest.mark.parametrize(
    ("got", "want", "ulps"),
    [
        (np.nan, np.nan, 0),
        (np.nan, 1, np.inf),
        (1, np.nan, np.inf),
        (np.inf, np.inf, 0),
        (-np.inf, -np.inf, 0),
        (-np.inf, np.inf, np.inf),
        (np.inf, LARGEST, np.inf),
        (LARGEST, np.inf, np.inf),
        (np.nan, np.inf, np.inf),
        (np.inf, np.nan, np.inf),
        (np.inf, 1e39, np.inf),  # no float32, but a number
    ],
)
def test_nan_and_infinity_equal_themselves_alone(got, want, ulps):
    assert ulp_difference(got, want) == ulps


@pytest.mark.filterwarnings("error")
def test_no_value_causes_a_warning():
    values = np.array([0, -0.0, 1, 1e-45, 1e39, LARGEST, np.inf, -np.inf, np.nan])
    ulp_difference(values[:, None], values)


def test_both_broadcast():
    assert ulp_difference(np.ones((2, 1), np.float32), np.ones(3)).shape == (2, 3)


def test_multiprecision_expectations_are_taken():
    assert_ulp(np.float32([1, 0.5]), [mp.mpf(1), mp.mpf("0.5")], max_ulp=0)


@pytest.mark.parametrize(("allowed", "passes"), [(0, False), (0.99, False), (1, True), (2, True)])
def test_the_bound_itself_is_allowed(allowed, passes):
    if passes:
        assert_ulp(ONE_UP, 1.0, max_ulp=allowed)
    else:
        with pytest.raises(AssertionError):
            assert_ulp(ONE_UP, 1.0, max_ulp=allowed)


def test_near_zero_an_absolute_distance_will_do():
    assert_ulp(np.float32(2.0**-100), 0.0, max_ulp=1, atol_near_zero=2.0**-100)
    with pytest.raises(AssertionError):
        assert_ulp(np.float32(1.5 * 2.0**-100), 0.0, max_ulp=1, atol_near_zero=2.0**-100)


@pytest.mark.parametrize(("got", "want"), [(np.nan, 1.0), (np.inf, 1.0), (1.0, np.nan), (0.0, LARGEST)])
def test_no_bound_is_wide_enough_for_what_is_no_number(got, want):
    with pytest.raises(AssertionError):
        assert_ulp(got, want, max_ulp=1e6)


def test_the_message_counts_and_shows_the_worst():
    """Expected: 2 of 6 wrong; (1, 2) is 8 ulp off: 1 + 2^-20 is 0x1.00001p+0."""
    got = np.ones((2, 3), np.float32)
    got[0, 1] += np.float32(2.0**-21)
    got[1, 2] += np.float32(2.0**-20)
    with pytest.raises(AssertionError) as caught:
        assert_ulp(got, 1.0, max_ulp=1)
    message = str(caught.value)
    assert message.startswith("2 of 6 values are more than 1 ulp off")
    assert "at (1, 2)" in message
    assert "got 1.00000095367431" in message
    assert "(0x1.00001p+0)" in message
    assert "want 1.0 (0x1p+0)" in message
    assert message.endswith("8 ulp")


def test_the_message_shows_a_nan_before_any_number():
    with pytest.raises(AssertionError, match=r"at \(1,\): got nan"):
        assert_ulp([2.0, np.nan, 9.0], 1.0, max_ulp=1)


# ---- What could pass without comparing -----------------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [np.nan, np.inf, -1.0, [1.0, np.nan]])
@pytest.mark.parametrize("name", ["max_ulp", "atol_near_zero", "rtol", "atol"])
def test_a_tolerance_that_is_no_bound_is_refused(name, tolerance):
    tolerance = np.broadcast_to(tolerance, 2)
    with pytest.raises(CompareError, match=f"{name} has to be finite and not negative"):
        if name in ("rtol", "atol"):
            assert_close([1.0, 2.0], [1.0, 2.0], **{name: tolerance})
        else:
            assert_ulp([1.0, 2.0], [1.0, 2.0], **{"max_ulp": 1, name: tolerance})


@pytest.mark.parametrize(("got", "want"), [([], []), ([], 1.0), (np.empty((0, 3)), np.empty((0, 3)))])
def test_nothing_to_compare_is_refused(got, want):
    with pytest.raises(CompareError, match="nothing to compare"):
        assert_ulp(got, want, max_ulp=1)
    with pytest.raises(CompareError, match="nothing to compare"):
        assert_close(got, want)


@pytest.mark.parametrize(
    ("got", "want"), [((3,), (3, 1)), ((3, 3), (3,)), ((3,), (2,)), ((3, 1), (3, 3)), ((2, 3), (2, 2)), ((), (1,))]
)
def test_shapes_that_numpy_would_broadcast_into_something_else_are_refused(got, want):
    with pytest.raises(CompareError, match="want has the shape"):
        assert_ulp(np.ones(got), np.ones(want), max_ulp=1)


@pytest.mark.parametrize("want", [(), (4, 3), (4, 1), (1, 3), (1, 1)])
def test_a_number_and_lengths_of_1_are_compared_with_all(want):
    assert_ulp(np.ones((4, 3)), np.ones(want), max_ulp=0)


def test_a_name_of_no_precision_is_refused():
    with pytest.raises(CompareError, match="no precision 'float8'; there are: float16, float32, float64"):
        assert_ulp(1.0, 1.0, max_ulp=1, precision="float8")


def test_what_is_no_number_is_refused():
    with pytest.raises(CompareError, match="want is no array of real numbers"):
        assert_ulp(1.0, 1 + 2j, max_ulp=1)


# ---- The policy ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("compare", [lambda *a, **k: assert_ulp(*a, max_ulp=1, **k), assert_close])
def test_a_flushed_denormal_passes_unless_forbidden(compare):
    denormal = SMALLEST_NORMAL - SMALLEST
    compare(0.0, denormal)
    compare(-0.0, denormal)
    with pytest.raises(AssertionError):
        compare(0.0, denormal, flush_denormals=False)
    with pytest.raises(AssertionError):
        compare(0.0, SMALLEST_NORMAL)


@pytest.mark.parametrize("compare", [lambda *a, **k: assert_ulp(*a, max_ulp=1, **k), assert_close])
def test_zeros_of_either_sign_are_equal_unless_told_apart(compare):
    compare([0.0, -0.0], [-0.0, 0.0])
    compare([0.0, -0.0], [0.0, -0.0], signed_zeros=True)
    with pytest.raises(AssertionError, match="1 of 2"):
        compare([0.0, -0.0], [0.0, 0.0], signed_zeros=True)


@pytest.mark.parametrize(
    ("got", "want"), [(np.nan, 1.0), (np.inf, 1.0), (1.0, np.nan), (1.0, np.inf), (np.inf, -np.inf)]
)
def test_no_tolerance_is_wide_enough_for_what_is_no_number(got, want):
    with pytest.raises(AssertionError):
        assert_close(got, want, rtol=1e300, atol=1e300)


def test_nan_and_infinity_are_expected_where_they_are():
    assert_close([np.nan, np.inf, -np.inf], [np.nan, np.inf, -np.inf])


# ---- assert_close, and the other precisions ------------------------------------------------------------------------


def test_close_adds_both_tolerances_and_allows_the_bound_itself():
    assert_close(10.75, 10.0, rtol=0.05, atol=0.25)
    with pytest.raises(AssertionError, match="0.75 off where 0.7 is allowed"):
        assert_close(10.75, 10.0, rtol=0.05, atol=0.2)


def test_tolerances_differ_from_element_to_element():
    got, want = np.array([[1.5, 2.5], [3.5, 4.5]]), np.array([[1.0, 2.0], [3.0, 4.0]])
    assert_close(got, want, atol=[[0.5], [0.5]])
    with pytest.raises(AssertionError, match=r"1 of 4 values are further off .*; the worst, at \(1, 0\)"):
        assert_close(got, want, atol=[[0.5, 0.5], [0.4, 0.5]])
    with pytest.raises(AssertionError, match=r"1 of 4 values are more than 1 ... 4.1943e\+06 ulp off"):
        assert_ulp(got, want, max_ulp=[[4194304, 2097152.0], [2097152, 1]])


@pytest.mark.parametrize(("precision", "step"), [("float16", 2.0**-10), ("float32", 2.0**-23), ("float64", 2.0**-52)])
def test_an_ulp_is_that_of_the_precision(precision, step):
    assert ulp_difference(1 + 3 * step, 1.0, precision) == 3
    smallest = {"float16": 2.0**-24, "float32": 2.0**-149, "float64": 2.0**-1074}[precision]
    assert ulp_difference(smallest, 0.0, precision) == 1


def test_integers_have_ulps_of_one():
    """2^24 and 2^24 + 1 are the same float32, but not the same integer."""
    assert ulp_difference(np.int32(2**24 + 1), np.int32(2**24)) == 1
    with pytest.raises(AssertionError):
        assert_ulp(np.array([2**30 + 1], np.int32), [2**30], max_ulp=0)


# ---- Of a function -------------------------------------------------------------------------------------------------

TEXT = """
struct S { vec3 c; float k; };
uniform float scale;

float square(float x) { return x * x; }
vec3 scaled(vec3 v, S s) { return v * s.c * s.k * scale; }
S both(float x, out float twice) { twice = x + x; return S(vec3(x), -x); }
"""


def test_a_function_is_held_to_a_reference_at_inputs_as_rounded(functions):
    """0.1 is not a float32: the reference gets what the function gets, and so agrees to half an ulp."""
    f = functions(TEXT)
    assert_ulp(f.square, np.square, max_ulp=0.5, inputs={"x": np.linspace(0.1, 9.9, 50)})
    assert_close(f.square, lambda x: x * x, rtol=2.0**-24, inputs={"x": [0.1, 0.2]})


def test_a_reference_for_one_input_at_a_time(functions):
    def exact(v, s, scale):
        assert isinstance(s["k"], float)
        return [mp.mpf(float(a)) * mp.mpf(float(b)) * s["k"] * scale for a, b in zip(v, s["c"], strict=True)]

    v = np.random.default_rng(1).random((4, 5, 3))
    inputs = {"v": v, "s": {"c": [1, 2, 3], "k": 0.3}, "scale": 2.0}
    assert_ulp(functions(TEXT).scaled, elementwise(exact), max_ulp=2, inputs=inputs)


def test_the_failure_of_a_function_says_where_and_how_to_repeat_it(functions):
    f = functions(TEXT)
    with pytest.raises(AssertionError) as caught:
        assert_ulp(f.square, lambda x: np.where(x == 3, 9.5, x * x), max_ulp=4, inputs={"x": [[1, 2], [3, 4]]})
    first, x, command = str(caught.value).split("\n")
    file, line = f.square.origin
    assert first.startswith(
        f"{file}:5: float square(float x): 1 of 4 values are more than 4 ulp off; the worst, at (1, 0)"
    )
    assert line == 5
    assert first.endswith("got 9.0 (0x1.2p+3), want 9.5 (0x1.3p+3), 5.24e+05 ulp")
    assert x.strip() == "x = 3.0 (0x1.8p+1)"
    assert command.strip() == f.square.command({"x": 3.0})


def test_all_results_of_a_function_are_compared_by_name(functions):
    both = functions(TEXT).both
    x = np.float32([1, 2])
    right = {"result": {"c": np.stack([x] * 3, -1), "k": -x}, "twice": 2 * x}
    assert_ulp(both(x), right, max_ulp=0)
    right["result"]["k"] = x
    with pytest.raises(AssertionError, match=r"2 of 10 values .* the worst, k at \(0,\): got -1.0"):
        assert_ulp(both(x), right, max_ulp=0)


def test_a_function_wants_inputs_and_a_result_wants_none(functions):
    f = functions(TEXT)
    with pytest.raises(CompareError, match="at no inputs"):
        assert_ulp(f.square, np.square, max_ulp=1)
    with pytest.raises(CompareError, match="inputs are empty"):
        assert_ulp(f.square, np.square, max_ulp=1, inputs={"x": []})
    with pytest.raises(CompareError, match="go with a GLSL function"):
        assert_ulp(f.square(2.0), np.square, max_ulp=1, inputs={"x": 2.0})
