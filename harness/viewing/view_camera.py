"""Mouse and keys to camera, as in SHADERed's preview: pure functions of cameras."""

from __future__ import annotations

import math
from dataclasses import replace

from ..projects.project import ArcballCamera, FirstPersonCamera
from ..rendering import transforms
from ..rendering.camera import FARTHEST, NEAREST, Camera

#: how far the arcball camera looks down or up, in degrees
STEEPEST = 89.0
#: degrees a pixel of dragging
ARCBALL_RATE, FIRST_PERSON_RATE = 1.0, 0.05
#: of walking: SHADERed goes 1/70 a frame, and a frame takes 1/60 s
UNITS_PER_SECOND = 60 / 70


def drag(camera: Camera, dx: float, dy: float) -> Camera:
    """The camera after the pointer was dragged by so many pixels, right and down.

    The arcball camera turns about the origin: yaw against x, kept in 0...360, pitch with y, at most STEEPEST. The
    first-person camera turns to where the pointer goes.
    """
    if isinstance(camera, ArcballCamera):
        pitch = min(max(camera.pitch + dy * ARCBALL_RATE, -STEEPEST), STEEPEST)
        return replace(camera, yaw=(camera.yaw - dx * ARCBALL_RATE) % 360.0, pitch=pitch)
    return replace(camera, yaw=camera.yaw - dx * FIRST_PERSON_RATE, pitch=camera.pitch - dy * FIRST_PERSON_RATE)


def zoom(camera: Camera, notches: float) -> Camera:
    """The camera after the wheel was turned away from the user: the arcball camera nears by 1 a notch, the other
    stays."""
    if isinstance(camera, FirstPersonCamera):
        return camera
    return replace(camera, distance=min(max(camera.distance - notches, NEAREST), FARTHEST))


def walk(camera: Camera, ahead: float, right: float, seconds: float) -> Camera:
    """The first-person camera after so long of walking ``ahead`` and to the ``right``, each -1, 0 or 1: along its own
    axes. The arcball camera stays."""
    if isinstance(camera, ArcballCamera) or not (ahead or right):
        return camera
    rotation = transforms.rotation(math.radians(camera.pitch), math.radians(camera.yaw), 0.0)
    step = (rotation[:3, 0] * right - rotation[:3, 2] * ahead) * (UNITS_PER_SECOND * seconds)
    return replace(camera, position=tuple(float(p + s) for p, s in zip(camera.position, step, strict=True)))
