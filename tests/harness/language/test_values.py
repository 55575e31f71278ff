"""GLSL values as text: what is written is read back to the bit, and what a user may write is read."""

from __future__ import annotations

import math

import numpy as np
import pytest
from glsl_values import EXTREMES

from harness import CallError
from harness.language.values import read, written


def test_every_float32_is_read_back_to_the_bit():
    """Random bits, all powers of two and their neighbours, powers of ten, and what numpy's shortest decimals miss.

    NaN apart, of which there is one only.
    """
    random = np.random.default_rng(1).integers(0, 2**32, 20_000, np.uint32).view(np.float32)
    powers = np.float32(2.0) ** np.arange(-149, 128, dtype=np.float32)
    tens = np.float32([f"1e{n}" for n in range(-45, 39)])
    missed = np.float32([float.fromhex("0x1.5c87fap-84")])
    x = np.concatenate([random, powers, missed, np.nextafter(powers, np.float32(0)), tens, -tens, EXTREMES["float"]])
    x = x[~np.isnan(x)]
    back = np.array([read(written(value)) for value in x], np.float64).astype(np.float32)
    assert back.tobytes() == x.tobytes()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.float32(0.1), "0.1"),
        (np.float32(3), "3"),
        (np.float32(-0.0), "-0.0"),
        (np.float32(1e-45), "1e-45"),
        (0.1 + 1e-12, "0.1"),  # float64, that goes to GLSL as float32
        (1e300, "inf"),
        (np.float32("nan"), "nan"),
        (np.float32(float.fromhex("0x1.5c87fap-84")), "0x1.5c87fa0000000p-84"),  # rounded twice, 7.038531e-26 is next
        (np.uint32(2**32 - 1), "4294967295"),
        (True, "true"),
        ([1, 2], "1,2"),
        (np.float32([0.5]), "[0.5]"),
        ([[1, 2], [3, 4]], "[[1,2],[3,4]]"),
        ([True, False], "true,false"),
        ([], "[]"),
    ],
)
def test_values_are_written_as_short_as_can_be(value, text):
    assert written(value) == text


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-2.5", -2.5),
        (".5", 0.5),
        ("0x1.8p-3", 0.1875),
        ("-0X1p+4", -16.0),
        ("0x10", 16),
        ("inf", math.inf),
        ("-inf", -math.inf),
        ("true", True),
        ("False", False),
        ("1,2,3", [1, 2, 3]),
        ("1, 0x1p-1,inf", [1, 0.5, math.inf]),
        ("[1,2,3]", [1, 2, 3]),
        ("(1,2,3)", [1, 2, 3]),
        ("[1]", [1]),
        ("1,", [1]),
        ("[]", []),
        ("[[1,2],[3,4]]", [[1, 2], [3, 4]]),
        ("[1,2],[3,4]", [[1, 2], [3, 4]]),
        ("[[1,2],(3,4)]", [[1, 2], [3, 4]]),
    ],
)
def test_values_are_read_as_they_are_written_by_hand(text, value):
    got = read(text)
    assert got == value
    assert type(got) is type(value)


def test_minus_zero_and_nan_are_read():
    assert math.copysign(1, read("-0.0")) == -1
    assert math.isnan(read("nan"))


@pytest.mark.parametrize("text", ["", "one", "[1,", "1]", "[1)", "1 2", "0x", "0x1.p", ",", "1,,2", "0x1p99999", "--1"])
def test_what_is_no_value_is_refused(text):
    with pytest.raises(CallError, match="is no number, vector such as 1,2,3, true or false"):
        read(text)
