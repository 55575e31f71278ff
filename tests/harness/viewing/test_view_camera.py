"""Mouse to camera. Expected: SHADERed's rates and limits by hand, and positions by the closed form of its cameras."""

from __future__ import annotations

import numpy as np
import pytest

from harness.projects.project import ArcballCamera, FirstPersonCamera
from harness.rendering import camera as cameras
from harness.viewing import view_camera

ARCBALL = ArcballCamera(distance=15.0, pitch=16.0, yaw=180.0, roll=3.0, line=7)
WALKER = FirstPersonCamera(position=(1.0, 2.0, 3.0), pitch=0.0, yaw=0.0, line=7)


def eye(distance: float, pitch: float, yaw: float) -> np.ndarray:
    p, y = np.radians(pitch), np.radians(yaw)
    return distance * np.array([-np.sin(y) * np.cos(p), np.sin(p), -np.cos(y) * np.cos(p)])


def test_a_pixel_turns_the_arcball_by_a_degree():
    turned = view_camera.drag(ARCBALL, 30, 10)
    assert turned == ArcballCamera(distance=15.0, pitch=26.0, yaw=150.0, roll=3.0, line=7)
    # float32: sums of a few products of about 15
    np.testing.assert_allclose(cameras.position(turned), eye(15, 26, 150), atol=1e-5)


def test_dragging_right_brings_what_is_left_of_the_middle_to_the_middle():
    """As if a hand turned the scene: a point in front of the origin moves to the right of the picture."""
    before, after = (cameras.view(c).astype(float) @ [0, 0, 1, 1] for c in (ARCBALL, view_camera.drag(ARCBALL, 20, 0)))
    assert after[0] > before[0] + 0.3


@pytest.mark.parametrize(("yaw", "dx", "expected"), [(10, 20, 350), (350, -20, 10), (180, 720, 180)])
def test_yaw_stays_within_a_turn(yaw, dx, expected):
    assert view_camera.drag(ArcballCamera(5, 0, yaw, 0), dx, 0).yaw == expected


@pytest.mark.parametrize(("dy", "expected"), [(500, 89.0), (-500, -89.0), (73, 89.0), (72, 88.0)])
def test_pitch_stops_before_the_poles(dy, expected):
    assert view_camera.drag(ARCBALL, 0, dy).pitch == expected


@pytest.mark.parametrize(("notches", "expected"), [(1, 14.0), (-2, 17.0), (100, 2.0), (-100, 50.0), (0.5, 14.5)])
def test_a_notch_of_the_wheel_is_a_unit_of_distance(notches, expected):
    assert view_camera.zoom(ARCBALL, notches).distance == expected


def test_the_wheel_does_not_move_the_first_person():
    assert view_camera.zoom(WALKER, 3) == WALKER


def test_the_first_person_turns_to_where_the_pointer_goes():
    turned = view_camera.drag(WALKER, 200, -100)  # right and up
    forward = cameras.target(turned).astype(float) - WALKER.position
    y, p = np.radians([10.0, 5.0])  # 0.05 degrees a pixel
    np.testing.assert_allclose(forward, [np.sin(y) * np.cos(p), np.sin(p), -np.cos(y) * np.cos(p)], atol=1e-6)


@pytest.mark.parametrize(("ahead", "right", "step"), [(1, 0, (0, 0, -1)), (-1, 0, (0, 0, 1)), (0, 1, (1, 0, 0))])
def test_the_first_person_walks_60_frames_of_a_70th_a_second(ahead, right, step):
    walked = view_camera.walk(WALKER, ahead, right, 1.0)
    np.testing.assert_allclose(np.subtract(walked.position, WALKER.position), np.array(step) * 60 / 70, atol=1e-6)


def test_the_first_person_walks_where_it_looks():
    camera = FirstPersonCamera((0.0, 0.0, 0.0), pitch=20.0, yaw=50.0, line=1)
    forward = cameras.target(camera).astype(float)
    np.testing.assert_allclose(view_camera.walk(camera, 1, 0, 0.5).position, forward * 30 / 70, atol=1e-6)


def test_the_arcball_does_not_walk():
    assert view_camera.walk(ARCBALL, 1, 1, 1.0) == ARCBALL
