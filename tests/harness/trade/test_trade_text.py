"""Figures as words."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.trade import text


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "–"),
        (0, "0"),
        (0.273, "0.27"),
        (1.0, "1"),
        (35.4, "35"),
        (99.4, "99"),
        (99.6, "1e2"),
        (1234, "1.2e3"),
        (0.0099, "9.9e-3"),
        (1.6e-4, "1.6e-4"),
        (2e-7, "2e-7"),
        (math.inf, "∞"),
        (math.nan, "NaN"),
    ],
)
def test_a_number_has_two_digits(value, words):
    assert text.number(value) == words


@given(st.floats(1e-30, 1e30))
def test_a_number_reads_back_to_two_digits(value):
    # half a unit of the second digit is at most 1/20 of the number
    assert float(text.number(value)) == pytest.approx(value, rel=0.05)


def test_a_count_has_its_thousands_apart():
    assert [text.count(n) for n in (0, 999, 1000, 1048576, None)] == ["0", "999", "1\xa0000", "1\xa0048\xa0576", "–"]


@pytest.mark.parametrize(
    ("share", "words"), [(None, "–"), (0.003, "0.3 %"), (0.46, "46 %"), (1, "100 %"), (1.23, "123 %")]
)
def test_a_share_is_in_percent(share, words):
    assert text.percent(share) == words


def test_a_time_has_its_spread():
    assert text.time({"ns": 0.85, "low": 0.77, "high": 1.0234}) == "0.85 (0.77–1.02)"


def test_a_filled_line_breaks_neither_code_nor_a_number():
    words = "a" * (text.WIDTH - 4)
    assert text.wrapped(f"{words}\n`b c` d") == f"{words}\n`b c` d"
    assert text.wrapped(f"{words} {text.count(10000)}") == f"{words}\n10\xa0000"
