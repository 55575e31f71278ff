"""What one sees of a choice: a project's pictures under other macros, and how far two pictures are apart."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..errors import CompareError, HarnessError
from ..rendering.render import Renderer
from ..viewing import view_macros

#: width and height of the pictures that are compared
SIZE = (640, 360)


@dataclass(frozen=True)
class Difference:
    """How far a picture is from a reference, in what a screen shows of it: red, green and blue."""

    max: float  # largest difference of a channel, in 1/255
    mean: float  # of all channels of all pixels, in 1/255
    flip: float | None  # mean of the ꟻLIP error map, 0 ... 1; None where it was not asked for or is not installed
    changed: float  # share of the pixels that change the code of a channel, 0 ... 1


def renderer(project_path: str | os.PathLike, macros: Mapping[str, str], size: tuple[int, int] = SIZE) -> Renderer:
    """The project under other macros, to draw any views of it: each macro in the passes whose shaders know it.

    HarnessError for what is wrong in the project, or does not compile under these macros.
    """
    changes = view_macros.Changes(rungs=dict(macros))
    return Renderer(project_path, size, change=lambda project: view_macros.changed(project, changes))


def picture(project_path: str | os.PathLike, macros: Mapping[str, str], size: tuple[int, int] = SIZE) -> np.ndarray:
    """The project's first frame under other macros: (h, w, 4) uint8, top row first."""
    made = renderer(project_path, macros, size)
    made.draw()
    return made.picture()


def difference(picture: np.ndarray, reference: np.ndarray, *, flip: bool = True) -> Difference:
    """How far a picture is from a reference, both (h, w, 3 or more) uint8; of alpha nothing is compared.

    ``flip``: with the mean ꟻLIP error too, which takes a hundred times as long as the rest. CompareError when the
    pictures are not of one size.
    """
    shown, wanted = _colors(picture), _colors(reference)
    if shown.shape != wanted.shape:
        raise CompareError(f"pictures of {shown.shape[:2]} and {wanted.shape[:2]} rows and columns cannot be compared")
    off = np.abs(shown.astype(np.int16) - wanted)
    perceived = flip_mean(picture, reference) if flip and flip_unavailable() is None else None
    return Difference(float(off.max()), float(off.mean()), perceived, float(off.any(axis=-1).mean()))


@cache
def flip_unavailable() -> str | None:
    """Why ꟻLIP cannot be computed here, or None when it can."""
    try:
        import flip_evaluator  # noqa: F401
    except ImportError:
        return "the package flip-evaluator is not installed: pip install 'shader-harness[trade]'"
    return None


def flip_mean(picture: np.ndarray, reference: np.ndarray) -> float:
    """The mean ꟻLIP error [Andersson et al. 2020], 0 ... 1: what an eye sees of the difference when it flips from one
    picture to the other, 0.7 m from a screen of 3840 pixels in 0.7 m (67 pixels a degree).

    HarnessError when the package is not installed.
    """
    reason = flip_unavailable()
    if reason is not None:
        raise HarnessError(reason)
    import flip_evaluator

    shown, wanted = (np.ascontiguousarray(_colors(p), np.float32) / 255 for p in (picture, reference))
    _, mean, _ = flip_evaluator.evaluate(wanted, shown, "LDR", applyMagma=False)
    return float(mean)


def _colors(picture: np.ndarray) -> np.ndarray:
    if picture.ndim != 3 or picture.shape[-1] < 3 or picture.dtype != np.uint8 or picture.size == 0:
        raise CompareError(f"a picture is (h, w, 3 or 4) uint8, not {picture.shape} {picture.dtype}")
    return picture[..., :3]
