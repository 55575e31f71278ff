"""The matrices of items and cameras, by what they must do to known points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.rendering import transforms

QUARTER = math.pi / 2


def moved(matrix: np.ndarray, *point: float) -> list[float]:
    """The point behind a matrix, after the division by w."""
    x, y, z, w = matrix @ np.array([*point, 1], np.float32)
    return [x / w, y / w, z / w]


def close(*values: float):
    return pytest.approx(list(values), abs=1e-6)


def test_rotations_about_each_axis():
    assert moved(transforms.rotation(QUARTER, 0, 0), 0, 1, 0) == close(0, 0, 1)
    assert moved(transforms.rotation(0, QUARTER, 0), 0, 0, 1) == close(1, 0, 0)
    assert moved(transforms.rotation(0, 0, QUARTER), 1, 0, 0) == close(0, 1, 0)


def test_roll_comes_before_pitch_and_pitch_before_yaw():
    assert moved(transforms.rotation(QUARTER, QUARTER, QUARTER), 1, 0, 0) == close(1, 0, 0)  # x -> y -> z -> x


def test_an_item_is_scaled_then_turned_then_moved():
    assert moved(transforms.item_matrix((10, 0, 0), (0, 0, QUARTER), (2, 1, 1)), 1, 0, 0) == close(10, 2, 0)


def test_look_at():
    up = np.array([0, 1, 0], np.float32)
    view = transforms.look_at(np.array([0, 0, 5], np.float32), np.zeros(3, np.float32), up)
    assert moved(view, 1, 2, 3) == close(1, 2, -2)


def test_perspective_maps_near_and_far_to_the_ends_of_depth():
    matrix = transforms.perspective(QUARTER, 2, 1, 3)
    assert moved(matrix, 2, 1, -1) == close(1, 1, -1)
    assert moved(matrix, 0, 0, -3) == close(0, 0, 1)


def test_orthographic():
    matrix = transforms.orthographic(0, 4, 0, 2, 1, 3)
    assert moved(matrix, 0, 0, -1) == close(-1, -1, -1)
    assert moved(matrix, 4, 2, -3) == close(1, 1, 1)


@pytest.mark.parametrize("size", [2, 3, 4])
def test_inverse(size):
    matrix = np.random.default_rng(size).uniform(-1, 1, (size, size)).astype(np.float32) + 2 * np.eye(
        size, dtype=np.float32
    )
    np.testing.assert_allclose(transforms.inverse(matrix) @ matrix, np.eye(size), atol=1e-5)


@pytest.mark.parametrize("angle", [math.inf, -math.inf, math.nan])
def test_an_angle_that_is_none_makes_no_number(angle):
    assert np.isnan(transforms.rotation(0, angle, 0)[0, 0])
    assert np.isnan(transforms.perspective(angle, 1, 1, 2)[0, 0])
