"""Renders a SHADERed project to the picture that SHADERed's own ``--render`` shows.

Pass after pass into one framebuffer of floats, as SHADERed's window; at the end clamped to 0...1 and rounded
to 8 bits, without gamma or tone mapping: those are the shaders' business.
"""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from . import native, sprj, uniforms
from .prepare import PreparedPass, prepare
from .project import Project

SIZE = (1280, 720)


def render(project_path: str | os.PathLike, size: tuple[int, int] = SIZE, supersample: int = 1) -> np.ndarray:
    """The project's picture at ``size`` (width, height): (h, w, 4) uint8, top row first.

    Alpha is 255 unless the project asks for an alpha channel. ``supersample`` n renders n times as wide and
    high, and every pixel is the rounded mean of its n x n final 8-bit values. HarnessError for what is wrong
    in the project.
    """
    width, height = _check_size(size, supersample)
    target = _draw(sprj.read(project_path), width * supersample, height * supersample)
    pixels = target.read_bytes()[::-1]
    if supersample == 1:
        return pixels
    blocks = pixels.reshape(height, supersample, width, supersample, 4).astype(np.uint32)
    samples = supersample * supersample
    return ((blocks.sum(axis=(1, 3)) + samples // 2) // samples).astype(np.uint8)


def render_floats(project_path: str | os.PathLike, size: tuple[int, int] = SIZE) -> np.ndarray:
    """The framebuffer before it becomes 8 bits: (h, w, 4) float32, top row first, NaN and all."""
    width, height = _check_size(size, 1)
    return _draw(sprj.read(project_path), width, height).read_floats()[::-1]


def _check_size(size: Sequence[int], supersample: int) -> tuple[int, int]:
    width, height = size
    if width < 1 or height < 1 or supersample < 1:
        raise ValueError(f"a picture of {width} x {height} pixels, supersampled {supersample} times")
    return width, height


def _draw(project: Project, width: int, height: int) -> native.Target:
    return draw(project, prepare(project), width, height)


# Matrices of absurd numbers overflow silently, as in SHADERed.
@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def draw(project: Project, passes: Sequence[PreparedPass], width: int, height: int) -> native.Target:
    """Draws prepared passes into a new target of that size."""
    target = native.Target(width, height, project.settings.use_alpha)
    # A window that nothing draws to is never cleared: it stays black, whatever the clear colour.
    target.clear(project.settings.clear_color if passes else (0, 0, 0, 0))
    frame = uniforms.frame(project, width, height)
    for prepared in passes:
        for bound in prepared.textures:
            bound.texture.bind(bound.unit)
        prepared.uniforms.set_frame(frame)
        for item in prepared.items:
            prepared.uniforms.set_item(item.item, frame)
            target.draw(prepared.program, item.mesh, item.fields, item.state)
            prepared.uniforms.restore(item.item)
    return target
