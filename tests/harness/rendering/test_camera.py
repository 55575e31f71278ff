"""Cameras and transforms, against the formulas written out in double precision."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.projects.project import ArcballCamera, FirstPersonCamera
from harness.rendering import camera, transforms

TOLERANCE = 4e-7  # a few roundings of float32 numbers around 1

ANGLES = [(0, 0, 0), (0.7, 0.5, 0.3), (-1.1, 2.4, 1.3), (0.4, -2.2, -0.9), (1.5, 3.1, -3.0)]
ARCBALLS = [
    ArcballCamera(6, 0, 0, 0),
    ArcballCamera(5.5, 33, 128, 10),
    ArcballCamera(4, 28, 317, 0),
    ArcballCamera(12, -75, 200, -40),
]
FIRST_PERSONS = [FirstPersonCamera((1, 2, 3), 0, 0, 1), FirstPersonCamera((-4, 0.5, 2), 20, 130, 1)]


def about_x(t):
    return np.array([[1, 0, 0], [0, math.cos(t), -math.sin(t)], [0, math.sin(t), math.cos(t)]])


def about_y(t):
    return np.array([[math.cos(t), 0, math.sin(t)], [0, 1, 0], [-math.sin(t), 0, math.cos(t)]])


def about_z(t):
    return np.array([[math.cos(t), -math.sin(t), 0], [math.sin(t), math.cos(t), 0], [0, 0, 1]])


def project(matrix, point):
    x, y, z, w = matrix.astype(float) @ [*point, 1]
    return np.array([x, y, z]) / w


@pytest.mark.parametrize("pitch, yaw, roll", ANGLES)
def test_rotation_is_about_z_then_x_then_y(pitch, yaw, roll):
    expected = about_y(yaw) @ about_x(pitch) @ about_z(roll)
    np.testing.assert_allclose(transforms.rotation(pitch, yaw, roll)[:3, :3], expected, atol=TOLERANCE)


def test_an_item_is_scaled_then_turned_then_moved():
    matrix = transforms.item_matrix((1, 2, 3), (0.7, 0.5, 0.3), (2, 3, 4))
    point = np.array([0.1, -0.2, 0.3])
    expected = about_y(0.5) @ about_x(0.7) @ about_z(0.3) @ (point * [2, 3, 4]) + [1, 2, 3]
    np.testing.assert_allclose(project(matrix, point), expected, atol=4 * TOLERANCE)


@pytest.mark.parametrize("arcball", ARCBALLS)
def test_arcball_position(arcball):
    # d (-sin yaw cos pitch, sin pitch, -cos yaw cos pitch), whatever the roll
    pitch, yaw = math.radians(arcball.pitch), math.radians(arcball.yaw)
    expected = [-math.sin(yaw) * math.cos(pitch), math.sin(pitch), -math.cos(yaw) * math.cos(pitch)]
    expected = arcball.distance * np.array(expected)
    np.testing.assert_allclose(camera.position(arcball), expected, atol=12 * TOLERANCE)


@pytest.mark.parametrize("distance, clamped", [(0, 2), (1.99, 2), (2, 2), (50, 50), (51, 50), (1e9, 50)])
def test_arcball_distance_is_clamped(distance, clamped):
    assert np.linalg.norm(camera.position(ArcballCamera(distance, 0, 0, 0))) == clamped


def test_at_rest_the_arcball_looks_along_z_with_x_on_the_left():
    view = camera.view(ArcballCamera(6, 0, 0, 0))
    np.testing.assert_allclose(project(view, (0, 0, 0)), (0, 0, -6), atol=TOLERANCE)
    np.testing.assert_allclose(project(view, (1, 0, 0)), (-1, 0, -6), atol=TOLERANCE)
    np.testing.assert_allclose(project(view, (0, 1, 0)), (0, 1, -6), atol=TOLERANCE)


def test_at_rest_the_first_person_looks_along_minus_z_with_x_on_the_right():
    view = camera.view(FirstPersonCamera((0, 0, 7), 0, 0, 1))
    np.testing.assert_allclose(project(view, (1, 0, 0)), (1, 0, -7), atol=TOLERANCE)


@pytest.mark.parametrize("seen_from", ARCBALLS + FIRST_PERSONS)
def test_a_view_is_a_rigid_motion_with_the_eye_at_the_origin(seen_from):
    view = camera.view(seen_from).astype(float)
    np.testing.assert_allclose(view[:3, :3] @ view[:3, :3].T, np.eye(3), atol=2 * TOLERANCE)
    assert np.linalg.det(view[:3, :3]) == pytest.approx(1, abs=2 * TOLERANCE)
    np.testing.assert_allclose(project(view, camera.position(seen_from)), np.zeros(3), atol=12 * TOLERANCE)


@pytest.mark.parametrize("seen_from", ARCBALLS + FIRST_PERSONS)
def test_the_target_is_straight_ahead(seen_from):
    x, y, z = project(camera.view(seen_from), camera.target(seen_from))
    assert abs(x) < 12 * TOLERANCE and abs(y) < 12 * TOLERANCE and z < 0


def test_roll_leans_the_camera():
    # Up is the rotated y axis: with roll alone, (-sin roll, cos roll, 0).
    view = camera.view(ArcballCamera(6, 0, 0, 30)).astype(float)
    up = np.array([-math.sin(math.radians(30)), math.cos(math.radians(30)), 0])
    np.testing.assert_allclose(view[:3, :3] @ up, (0, 1, 0), atol=TOLERANCE)


def test_first_person_direction():
    # forward = -(Ry(yaw) Rx(pitch) (0, 0, 1))
    seen_from = FirstPersonCamera((1, 2, 3), 20, 130, 1)
    forward = -(about_y(math.radians(130)) @ about_x(math.radians(20)) @ [0, 0, 1])
    np.testing.assert_allclose(camera.target(seen_from) - [1, 2, 3], forward, atol=8 * TOLERANCE)


def test_what_shadered_calls_camera_direction():
    arcball, first_person = ARCBALLS[1], FIRST_PERSONS[1]
    np.testing.assert_array_equal(camera.direction(arcball), -camera.position(arcball))
    np.testing.assert_array_equal(camera.direction(first_person), camera.target(first_person))


@pytest.mark.parametrize("width, height", [(1280, 720), (160, 120), (100, 300)])
def test_the_lens_is_45_degrees_high(width, height):
    lens = camera.projection(width, height)
    edge = math.tan(math.radians(22.5))
    top_right = project(lens, (edge * width / height * 5, edge * 5, -5))
    np.testing.assert_allclose(top_right[:2], (1, 1), atol=TOLERANCE)


@pytest.mark.parametrize("depth, clip", [(0.1, -1), (1000, 1)])
def test_clipping_planes(depth, clip):
    assert project(camera.projection(4, 3), (0, 0, -depth))[2] == pytest.approx(clip, abs=1e-6)


def test_orthographic_pixels_go_down():
    lens = camera.orthographic(160, 120)
    np.testing.assert_allclose(project(lens, (0, 0, -0.1)), (-1, 1, -1), atol=1e-6)
    np.testing.assert_allclose(project(lens, (160, 120, -1000)), (1, -1, 1), atol=1e-6)


def test_a_product_is_in_single_precision_from_left_to_right():
    a, b = np.random.default_rng(1).normal(size=(2, 4, 4)).astype(np.float32)
    for i in range(4):
        for j in range(4):
            total = a[i, 0] * b[0, j]
            for k in (1, 2, 3):
                total = total + a[i, k] * b[k, j]
            assert transforms.product(a, b)[i, j] == total


@pytest.mark.parametrize("seed", range(5))
def test_inverse(seed):
    rng = np.random.default_rng(seed)
    matrix = transforms.item_matrix(rng.normal(size=3), rng.normal(size=3), rng.uniform(0.5, 2, 3))
    expected = np.linalg.inv(matrix.astype(float))
    np.testing.assert_allclose(transforms.inverse(matrix), expected, atol=20 * TOLERANCE)


def test_a_singular_matrix_has_no_finite_inverse():
    assert not np.isfinite(transforms.inverse(np.zeros((4, 4), np.float32))).any()
