"""Distances in units in the last place. Expected values from the layout of IEEE 754 binary32 (24 bits, 2^-149 up)."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from harness import assert_ulp, ulp_difference

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
