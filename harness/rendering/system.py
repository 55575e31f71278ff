"""The values that SHADERed itself gives to variables: time, camera, target, item; of this frame and of the last.

Mouse, keys and picking are at rest unless they are given: without a window nobody moves them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..projects.project import Geometry, Item, Project
from . import camera as cameras
from . import transforms

#: seconds between two frames, as SHADERed has it when it renders to a file
TIME_DELTA = 1 / 60
#: where SHADERed puts a ScreenQuad, on the far plane of its orthographic view
SCREEN_QUAD_Z = -1000.0

_AT_REST = {
    "MousePosition": np.zeros(2),
    "Mouse": np.zeros(4),
    "MouseButton": np.zeros(4),
    "IsPicked": np.array(False),
    "IsSavingToFile": np.array(True),
    "KeysWASD": np.zeros(4),
    "PickPosition": np.zeros(3),
}


@dataclass(frozen=True)
class Moment:
    """When a frame is: its index, its time in seconds, and the seconds since the frame before."""

    frame: int = 0
    time: float = 0.0
    delta: float = TIME_DELTA


def item_matrix(item: Item, width: int, height: int) -> np.ndarray:
    """An item's GeometryTransform (4, 4). A ScreenQuad is placed in shares of the target, from its middle."""
    if isinstance(item, Geometry) and item.shape == "ScreenQuad":
        size = np.array([width, height], np.float32)
        x, y = (np.array(item.position[:2], np.float32) + np.float32(0.5)) * size
        scale = np.array(item.scale[:2], np.float32) * size
        return transforms.item_matrix((x, y, SCREEN_QUAD_Z), item.rotation, (*scale, 1))
    return transforms.item_matrix(item.position, item.rotation, item.scale)


class System:
    """The system values while frames are drawn one after the other.

    The size of the target is that of the pass that is drawn; between passes, for a compute pass, that of the last one.
    """

    def __init__(self, project: Project, size: tuple[int, int]):
        self._given = dict(_AT_REST)
        self.look(project.settings.camera)
        self._size = self._last_size = size
        self._moment, self._last_frame, self._last_delta = Moment(), 0, 0.0
        self._matrices: dict[str, np.ndarray] = {}
        self._last_matrices: dict[str, np.ndarray] = {}

    def look(self, camera: cameras.Camera) -> None:
        """Looks through this camera from here on."""
        position = cameras.position(camera)
        self._view = cameras.view(camera)
        self._of_camera = {
            "View": self._view,
            "CameraPosition": np.array([*position, 1]),
            "CameraPosition3": position,
            "CameraDirection3": cameras.direction(camera),
        }
        self._of_size: dict[tuple[int, int], dict[str, np.ndarray]] = {}

    def give(self, values: Mapping[str, np.ndarray]) -> None:
        """What mouse and keys are from here on: values that are at rest otherwise, by name."""
        self._given.update(values)

    def begin(self, moment: Moment) -> None:
        """Begins a frame: what was this frame's so far is the last one's now."""
        self._last_frame, self._last_delta = self._moment.frame, self._moment.delta
        self._last_size, self._last_matrices = self._size, dict(self._matrices)
        self._moment = moment

    def set_size(self, size: tuple[int, int]) -> None:
        """The size of the target in pixels, from here on."""
        self._size = size

    def set_item(self, item: Item) -> None:
        """The item that is drawn next."""
        self._matrices[item.name] = item_matrix(item, *self._size)

    def value(self, name: str, item: Item | None, *, last: bool = False) -> np.ndarray:
        """A value of project.SYSTEM_TYPES, matrices as (row, column). ``last``: that of the frame before.

        In the first frame SHADERed takes zeros for the matrices of the items before; the rest is as in that frame.
        """
        if name in self._given:
            return self._given[name]
        if name in self._of_camera:
            return self._of_camera[name]
        match name:
            case "Time":
                return np.array(self._moment.time)
            case "TimeDelta":
                return np.array(self._last_delta if last else self._moment.delta)
            case "FrameIndex":
                return np.array(self._last_frame if last else self._moment.frame)
            case "GeometryTransform":
                matrices = self._last_matrices if last else self._matrices
                matrix = matrices.get(item.name) if item is not None else None
                return np.zeros((4, 4), np.float32) if matrix is None else matrix
        return self._sized(self._last_size if last else self._size)[name]

    def _sized(self, size: tuple[int, int]) -> dict[str, np.ndarray]:
        if size not in self._of_size:
            projection, orthographic = cameras.projection(*size), cameras.orthographic(*size)
            self._of_size[size] = {
                "ViewportSize": np.array(size),
                "Projection": projection,
                "ViewProjection": transforms.product(projection, self._view),
                "Orthographic": orthographic,
                "ViewOrthographic": transforms.product(orthographic, self._view),
            }
        return self._of_size[size]
