"""Function variables against their formulas in float64, and matrices against what they do to points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.projects.project import FUNCTIONS
from harness.rendering import functions


def matrix(function: str, *arguments: float) -> np.ndarray:
    """The matrix (row, column) of a function, from its columns."""
    return functions.compute(function, arguments, 16).reshape(4, 4).T


def moved(function: str, arguments: tuple, point: tuple) -> np.ndarray:
    """A point through the matrix, divided by w."""
    result = matrix(function, *arguments).astype(np.float64) @ (*point, 1)
    return result[:3] / result[3]


@pytest.mark.parametrize(
    "function, arguments, point, expected",
    [
        ("MatrixIdentity", (), (1, 2, 3), (1, 2, 3)),
        ("MatrixTranslation", (4, 5, 6), (1, 2, 3), (5, 7, 9)),
        ("MatrixScaling", (4, 5, 6), (1, 2, 3), (4, 10, 18)),
        # Right-handed, in degrees: a quarter turn takes y to z, z to x, x to y.
        ("MatrixRotationX", (90,), (0, 1, 0), (0, 0, 1)),
        ("MatrixRotationY", (90,), (0, 0, 1), (1, 0, 0)),
        ("MatrixRotationZ", (90,), (1, 0, 0), (0, 1, 0)),
        # A third of a turn about the diagonal takes x to y; the axis need not be of unit length.
        ("MatrixRotationAxis", (5, 5, 5, 120), (1, 0, 0), (0, 1, 0)),
        ("MatrixRotationNormal", (1, 1, 1, 120), (0, 0, 1), (1, 0, 0)),
        # From (0, 0, 5) toward the origin: the origin is 5 ahead, on -z.
        ("MatrixLookAtLH", (0, 0, 5, 0, 0, 0, 0, 1, 0), (1, 2, 0), (1, 2, -5)),
        ("MatrixLookToLH", (0, 0, 5, 0, 0, -1, 0, 1, 0), (1, 2, 0), (1, 2, -5)),
        # The origin is in the lower left corner.
        ("MatrixOrthographicLH", (8, 6, 1, 3), (0, 0, -1), (-1, -1, -1)),
        ("MatrixOrthographicLH", (8, 6, 1, 3), (8, 6, -3), (1, 1, 1)),
        # 90 degrees, in radians: what is as high as it is far lies on the edge.
        ("MatrixPerspectiveFovLH", (math.pi / 2, 2, 1, 3), (2, 1, -1), (1, 1, -1)),
        ("MatrixPerspectiveFovLH", (math.pi / 2, 2, 1, 3), (6, 3, -3), (1, 1, 1)),
    ],
)
def test_what_a_matrix_does_to_a_point(function, arguments, point, expected):
    # Float32 keeps seven digits of coordinates below 10; a few operations lose a bit each.
    np.testing.assert_allclose(moved(function, arguments, point), expected, atol=2e-6)


def test_a_perspective_by_its_size_has_a_view_of_45_radians():
    m = matrix("MatrixPerspectiveLH", 4, 3, 1, 3)
    up = 1 / math.tan(22.5)
    expected = [[up * 3 / 4, 0, 0, 0], [0, up, 0, 0], [0, 0, -2, -3], [0, 0, -1, 0]]
    np.testing.assert_allclose(m, expected, rtol=1e-6)


def test_roll_pitch_yaw_is_nothing():
    assert (matrix("MatrixRotationRollPitchYaw", 1, 2, 3) == 0).all()


@pytest.mark.parametrize("angle", [0, 30, 90, 200, -45])
def test_sine_and_cosine_are_of_degrees(angle):
    radians = angle * math.pi / 180
    assert functions.compute("ScalarSin", (angle,), 1) == pytest.approx([math.sin(radians)], abs=1e-6)
    assert functions.compute("ScalarCos", (angle,), 1) == pytest.approx([math.cos(radians)], abs=1e-6)


@pytest.mark.parametrize("size", [2, 3, 4])
def test_only_as_many_numbers_as_the_vector_has_are_normalized(size):
    numbers = (1.0, -2.0, 3.0, 4.0)
    expected = np.array(numbers[:size]) / np.linalg.norm(numbers[:size])
    found = functions.compute("VectorNormalize", numbers, size)
    assert found.shape == (size,)
    np.testing.assert_allclose(found, expected, rtol=3e-7)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_all_functions_take_zeros(function):
    count, types = FUNCTIONS[function]
    size = {"float4x4": 16, "float": 1, "float2": 2}[types[0]]
    with np.errstate(all="ignore"):
        assert functions.compute(function, (0.0,) * count, size).shape == (size,)
