"""From where a scene is looked at while it is tuned: round its centre at the camera's distance, the camera's own first.

An arcball camera's centre is the origin, as in SHADERed. A first-person camera has none: there it is the mean of the
drawn items' places, and the other views look at it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..projects.project import ArcballCamera, FirstPersonCamera, Geometry, Pass, Project
from ..rendering import camera as cameras
from ..rendering.camera import Camera

COUNT = 8
#: degrees that views are above and below the camera, in turn
PITCH_STEPS = (0.0, 20.0, 0.0, -20.0)
#: where up and down end
_STEEPEST = 85.0


def orbit(project: Project, count: int = COUNT) -> list[Camera]:
    """``count`` cameras: yaw in equal steps all the way round, pitch as the camera's, above it, as it, below it."""
    camera = project.settings.camera
    steps = [(360.0 * k / count, PITCH_STEPS[k % len(PITCH_STEPS)]) for k in range(count)]
    if isinstance(camera, ArcballCamera):
        return [camera] + [
            replace(camera, yaw=(camera.yaw + yaw) % 360, pitch=_pitch(camera.pitch, step)) for yaw, step in steps[1:]
        ]
    centre = _centre(project)
    away = np.array(camera.position, float) - centre
    distance = float(np.linalg.norm(away))
    if distance == 0:
        return [camera] + [replace(camera, yaw=(camera.yaw + yaw) % 360) for yaw, _ in steps[1:]]
    # Looking back along (yaw, pitch) is being at Ry(yaw) Rx(pitch) (0, 0, 1) from what is looked at.
    yaw, pitch = math.degrees(math.atan2(away[0], away[2])), math.degrees(math.asin(-away[1] / distance))
    return [camera] + [_looking_at(camera, centre, distance, yaw + y, _pitch(pitch, -p)) for y, p in steps[1:]]


def _pitch(pitch: float, step: float) -> float:
    return pitch if step == 0 else min(max(pitch + step, -_STEEPEST), _STEEPEST)


def _looking_at(
    camera: FirstPersonCamera, centre: np.ndarray, distance: float, yaw: float, pitch: float
) -> FirstPersonCamera:
    y, p = math.radians(yaw), math.radians(pitch)
    direction = np.array([math.sin(y) * math.cos(p), -math.sin(p), math.cos(y) * math.cos(p)])
    x, y, z = (float(v) for v in centre + distance * direction)
    return replace(camera, position=(x, y, z), yaw=yaw % 360, pitch=pitch)


def _centre(project: Project) -> np.ndarray:
    places = [
        item.position
        for p in project.passes
        if isinstance(p, Pass)
        for item in p.items
        if not (isinstance(item, Geometry) and item.shape.startswith("ScreenQuad"))
    ]
    return np.mean(places, axis=0) if places else np.zeros(3)


def described(views: Sequence[Camera]) -> str:
    """The views in one line, degrees."""
    camera = views[0]
    if isinstance(camera, ArcballCamera):
        head = f"distance {camera.distance:g}"
    else:
        head = "position " + ", ".join(f"{x:g}" for x in cameras.position(camera))
    return f"{head}, yaw/pitch " + " ".join(f"{v.yaw:g}/{v.pitch:g}" for v in views)
