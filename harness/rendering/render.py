"""Renders a SHADERed project to the picture that SHADERed's own ``--render`` shows.

Pass after pass, to the window or to render textures; at the end the window is clamped to 0...1 and rounded to 8 bits,
without gamma or tone mapping: those are the shaders' business.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np

from ..errors import ProjectError
from ..native import Target
from ..projects import sprj
from ..projects.project import Project
from ..projects.traps import Traps, Warning
from .camera import Camera
from .frames import Stage
from .prepare import PreparedPass, prepare
from .system import TIME_DELTA, Moment

SIZE = (1280, 720)
#: as many pixels as the window and the render textures may have in all
LARGEST_SIDE = 16384


class Renderer:
    """A project with everything loaded once, to draw any number of frames of it, one after the other.

    What a frame leaves (render textures that are not cleared, buffers, images) is there for the next, as in SHADERed.
    """

    def __init__(
        self,
        project_path: str | os.PathLike,
        size: tuple[int, int] = SIZE,
        supersample: int = 1,
        *,
        until_pass: str | None = None,
        keep_going: bool = False,
        change: Callable[[Project], Project] | None = None,
    ):
        """``size``: width and height of the picture. ``supersample`` n renders n times as wide and high, and every
        pixel is the rounded mean of its n x n final 8-bit values. ``until_pass`` is the last pass that is drawn.
        ``change`` makes the project that is drawn of the one that was read.

        HarnessError for what is wrong in the project; with ``keep_going`` it costs the part that it is about, and is
        in ``errors``.
        """
        self.size, self._supersample = _check_size(size, supersample), supersample
        self._traps = Traps(keep_going)
        project = sprj.read(project_path, self._traps)
        if until_pass is not None:
            project = _until(project, until_pass)
        if change is not None:
            project = change(project)
        self.project = project
        self._passes = prepare(project, self._traps)
        self._stage = self._make_stage()

    def _make_stage(self) -> Stage:
        width, height = self.size
        window = width * self._supersample, height * self._supersample
        return Stage(self.project, self._passes, window, self._traps)

    def resize(self, size: tuple[int, int]) -> None:
        """Another size of the picture, from the next frame on. What frames have left so far is gone."""
        self.size = _check_size(size, self._supersample)
        self._stage = self._make_stage()

    def look(self, camera: Camera) -> None:
        """Another camera than the project's, from the next frame on."""
        self._stage.system.look(camera)

    def give(self, values: Mapping[str, np.ndarray]) -> None:
        """What mouse and keys are from the next frame on: values of project.SYSTEM_TYPES by name."""
        self._stage.system.give(values)

    @property
    def window(self) -> Target:
        """What the last frame was drawn to, supersampled."""
        return self._stage.window

    @property
    def warnings(self) -> list[Warning]:
        """What SHADERed would pass over in silence, so far: some of it shows only when it is drawn."""
        return self._traps.warnings

    @property
    def errors(self) -> list[Exception]:
        """With ``keep_going``: the errors that parts of the picture were left out for."""
        return self._traps.errors

    def draw(self, frame: int = 0, time: float = 0.0, delta: float = TIME_DELTA) -> None:
        """Draws a frame: its FrameIndex, its Time in seconds and its TimeDelta."""
        self._stage.draw(Moment(frame, time, delta))

    def picture(self) -> np.ndarray:
        """The window: (h, w, 4) uint8, top row first. Alpha is 255 unless the project asks for an alpha channel."""
        pixels = self._stage.window.read_bytes()[::-1]
        n = self._supersample
        if n == 1:
            return pixels
        width, height = self.size
        blocks = pixels.reshape(height, n, width, n, 4).astype(np.uint32)
        return ((blocks.sum(axis=(1, 3)) + n * n // 2) // (n * n)).astype(np.uint8)

    def floats(self) -> np.ndarray:
        """The window before it becomes 8 bits: (h, w, 4) float32, top row first, NaN and all, supersampled."""
        return self._stage.window.read_floats()[::-1]

    def targets(self) -> dict[str, np.ndarray]:
        """The render textures and 2D images by name, as they are now: (h, w, 4) float32, row 0 at v = 0."""
        return self._stage.read_targets()


def render(
    project_path: str | os.PathLike,
    size: tuple[int, int] = SIZE,
    supersample: int = 1,
    *,
    frame: int = 0,
    time: float = 0.0,
    until_pass: str | None = None,
    keep_going: bool = False,
    warnings: list[Warning] | None = None,
) -> np.ndarray:
    """The project's picture: one frame, as ``Renderer`` draws it. ``warnings`` receives its warnings."""
    renderer = Renderer(project_path, size, supersample, until_pass=until_pass, keep_going=keep_going)
    renderer.draw(frame, time)
    if warnings is not None:
        warnings += renderer.warnings
    return renderer.picture()


def render_floats(project_path: str | os.PathLike, size: tuple[int, int] = SIZE) -> np.ndarray:
    """The framebuffer before it becomes 8 bits: (h, w, 4) float32, top row first, NaN and all."""
    renderer = Renderer(project_path, size)
    renderer.draw()
    return renderer.floats()


def render_sequence(renderer: Renderer, frames: Iterable[int], fps: float, start: float = 0.0) -> Iterator[np.ndarray]:
    """The pictures of consecutive frames: frame k at ``start`` + k / ``fps`` seconds."""
    for frame in frames:
        renderer.draw(frame, start + frame / fps, 1 / fps)
        yield renderer.picture()


def draw(project: Project, passes: Sequence[PreparedPass], width: int, height: int) -> Target:
    """The window of that size, with the first frame of prepared passes drawn."""
    stage = Stage(project, passes, (width, height))
    stage.draw(Moment())
    return stage.window


def _check_size(size: Sequence[int], supersample: int) -> tuple[int, int]:
    width, height = size
    if width < 1 or height < 1 or supersample < 1:
        raise ValueError(f"a picture of {width} x {height} pixels, supersampled {supersample} times")
    return width, height


def _until(project: Project, name: str) -> Project:
    from dataclasses import replace

    names = [p.name for p in project.passes]
    if name not in names:
        raise ProjectError(f'there is no pass "{name}" that is drawn; there are: {", ".join(names)}', project.file)
    return replace(project, passes=project.passes[: names.index(name) + 1])
