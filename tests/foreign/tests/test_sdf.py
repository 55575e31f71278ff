"""Distances: against the nearest of many points of the surface, and what must hold of any distance."""

import numpy as np
import pytest
from mpmath import mp, mpf

from harness import assert_ulp

HALF = np.array([1.0, 0.5, 0.25])


@pytest.fixture
def sdf(shader):
    return shader("sdf.glsl")


@pytest.fixture
def points():
    return np.random.default_rng(7).uniform(-2, 2, (400, 3)).astype(np.float32)


def test_the_distance_to_a_box_is_that_to_the_nearest_point_of_its_surface(sdf, points):
    """Outside the nearest point of a box is the clamped one; inside the nearest face counts."""
    p = points.astype(np.float64)
    outside = np.linalg.norm(p - np.clip(p, -HALF, HALF), axis=1)
    inside = (HALF - np.abs(p)).min(axis=1)
    want = np.where(outside > 0, outside, -inside)
    assert np.abs(sdf.box(points, HALF) - want).max() < 8 * 2.0**-24


def test_the_distance_to_a_capsule(sdf, points):
    """By brute force over the points of its axis, of which the nearest is at most half a step away."""
    a, b, radius = np.array([-0.5, 0, 0.25]), np.array([0.75, 1, -0.5]), 0.375
    steps = 4001
    axis = a + (b - a) * np.linspace(0, 1, steps)[:, None]
    nearest = np.linalg.norm(points[:, None].astype(np.float64) - axis, axis=2).min(axis=1)
    got = sdf.capsule(points, {"a": a, "b": b, "radius": radius})
    error = np.linalg.norm(b - a) / (steps - 1) / 2
    assert np.all(got <= nearest - radius + 1e-6) and np.all(got >= nearest - radius - error - 1e-6)


def test_the_smooth_minimum_in_exact_arithmetic(sdf):
    rng = np.random.default_rng(8)
    a, b = rng.uniform(0.5, 2, (2, 300)).astype(np.float32)
    k = rng.uniform(0.1, 1, 300).astype(np.float32)
    with mp.workdps(30):
        want = [
            min(x, y) - max(w - abs(x - y), mpf(0)) ** 2 / (4 * w)
            for x, y, w in zip(*[map(mpf, map(float, v)) for v in (a, b, k)], strict=True)
        ]
    assert_ulp(sdf.smooth_min(a, b, k), np.array(want, np.float64), max_ulp=8)


def test_the_smooth_minimum_is_never_above_and_never_far_below(sdf):
    a, b = np.meshgrid(np.linspace(-2, 2, 101, dtype=np.float32), np.linspace(-2, 2, 101, dtype=np.float32))
    got = sdf.smooth_min(a, b, 0.5)
    assert np.all(got <= np.minimum(a, b)) and np.all(got >= np.minimum(a, b) - 0.125 - 1e-6)
    assert np.array_equal(got, sdf.smooth_min(b, a, 0.5))


def test_the_normal_of_a_box_is_that_of_its_face(sdf):
    for axis in range(3):
        p = np.zeros(3)
        p[axis] = HALF[axis] + 0.125
        assert np.abs(sdf.box_normal(p, HALF) - np.eye(3)[axis]).max() < 1e-5
        assert np.abs(sdf.box_normal(-p, HALF) + np.eye(3)[axis]).max() < 1e-5
