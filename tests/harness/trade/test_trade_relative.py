"""Relative errors and their summary. Expected: by hand."""

from __future__ import annotations

import numpy as np
import pytest

from harness.trade.relative import errors, summary


def test_the_largest_of_a_vectors_numbers_counts():
    assert errors(np.array([[1.1, 2.0]]), np.array([[1.0, 1.0]])).tolist() == [1.0]


@pytest.mark.parametrize(("precision", "smallest"), [("float32", 2.0**-126), ("float16", 2.0**-14)])
def test_below_the_smallest_normal_number_errors_count_as_there(precision, smallest):
    assert errors(np.array([[0.0]]), np.array([[smallest / 8]]), precision) == [0.125]


def test_only_one_of_both_a_number_is_infinitely_wrong():
    got = np.array([[np.nan], [1.0], [np.inf], [1.0], [np.nan], [np.inf]])
    want = np.array([[1.0], [np.nan], [1.0], [np.inf], [np.nan], [np.inf]])
    assert errors(got, want).tolist() == [np.inf] * 4 + [0, 0]


def test_the_summary_has_values_that_occur_and_the_place_of_the_largest():
    """Of 0, 1, ... 999 the value that half reach is 499 or 500, that 99 of 100 stay below 990 at most."""
    told = summary(np.roll(np.arange(1000.0), 17), {"x": np.arange(1000.0)})
    assert told["median"] in (499, 500) and told["p99"] in (989, 990) and told["max"] == 999
    assert told["at"] == {"x": 16.0}
