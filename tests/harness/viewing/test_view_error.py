"""The error view. Expected: differences by hand, and the ends of the scale."""

from __future__ import annotations

import numpy as np
import pytest

from harness.viewing import view_error


def pixel(*rgba: float) -> np.ndarray:
    return np.array([[rgba]], np.float32)


@pytest.mark.parametrize(
    ("shown", "reference", "expected"),
    [
        ((0.5, 0.5, 0.5, 1), (0.5, 0.25, 0.625, 1), 0.25),  # the largest, of either sign
        ((0.5, 0.5, 0.5, 1), (0.5, 0.5, 0.5, 0), 0),  # alpha does not show
        ((7, -3, 0, 1), (2, 0, 0, 1), 0),  # both show as white and as black
        ((np.inf, 0, 0, 1), (0.75, 0, 0, 1), 0.25),
        ((np.nan, 0, 0, 1), (0.5, 0, 0, 1), 1),
        ((np.nan, 0, 0, 1), (np.nan, 0, 0, 1), 0),
    ],
)
def test_the_difference_is_of_what_is_shown(shown, reference, expected):
    assert view_error.differences(pixel(*shown), pixel(*reference)) == [[expected]]


@pytest.mark.parametrize(
    ("difference", "color"),
    [
        (0, (0, 0, 0)),
        (1 / 64 / 5, (0, 0, 255)),
        (1 / 64 * 2 / 5, (0, 255, 0)),
        (1 / 64 * 4 / 5, (255, 0, 0)),
        (1 / 64, (255, 255, 255)),
        (1, (255, 255, 255)),
    ],
)
def test_the_scale_goes_from_black_to_white_at_a_64th(difference, color):
    assert view_error.false_color(np.array([[difference]])).tolist() == [[[*color, 255]]]


def test_one_step_of_8_bits_shows():
    assert view_error.false_color(np.array([[1 / 255]]))[0, 0, :3].max() > 128
