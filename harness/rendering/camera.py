"""Where a picture is seen from: SHADERed's two cameras and its one lens."""

from __future__ import annotations

import numpy as np

from ..projects.project import ArcballCamera, FirstPersonCamera
from . import transforms
from .transforms import f32

Camera = ArcballCamera | FirstPersonCamera

#: what the arcball camera's distance is clamped to
NEAREST, FARTHEST = 2.0, 50.0
#: the lens: vertical field of view in degrees, and the depths of the clipping planes
FIELD_OF_VIEW, NEAR_PLANE, FAR_PLANE = 45.0, 0.1, 1000.0
UP = np.array([0, 1, 0], f32)


def _rotation(camera: Camera) -> np.ndarray:
    roll = camera.roll if isinstance(camera, ArcballCamera) else 0.0
    return transforms.rotation(*map(transforms.radians, (camera.pitch, camera.yaw, roll)))


def position(camera: Camera) -> np.ndarray:
    """Where the camera is (3). The arcball camera at zero angles is on the -z axis."""
    if isinstance(camera, FirstPersonCamera):
        return np.array(camera.position, f32)
    distance = f32(min(max(camera.distance, NEAREST), FARTHEST))
    return _rotation(camera)[:3, 2] * -distance


def target(camera: Camera) -> np.ndarray:
    """A point that the camera looks at (3): the origin, or one unit ahead of the first-person camera."""
    if isinstance(camera, ArcballCamera):
        return np.zeros(3, f32)
    return position(camera) - transforms.normalized(_rotation(camera)[:3, 2])


def direction(camera: Camera) -> np.ndarray:
    """What SHADERed calls CameraDirection3 (3): minus the position, or the first-person camera's target."""
    return -position(camera) if isinstance(camera, ArcballCamera) else target(camera)


def view(camera: Camera) -> np.ndarray:
    """World to view space (4, 4). The first-person camera does not lean: its up is that of the world."""
    up = _rotation(camera)[:3, 1] if isinstance(camera, ArcballCamera) else UP
    return transforms.look_at(position(camera), target(camera), up)


def projection(width: int, height: int) -> np.ndarray:
    """View to clip space (4, 4) for a target of that size in pixels."""
    aspect = f32(width) / f32(height)
    return transforms.perspective(transforms.radians(FIELD_OF_VIEW), aspect, NEAR_PLANE, FAR_PLANE)


def orthographic(width: int, height: int) -> np.ndarray:
    """Pixels to clip space (4, 4): x to the right from 0 to the width, y down from 0 to the height."""
    return transforms.orthographic(0, width, height, 0, NEAR_PLANE, FAR_PLANE)
