"""What the page shows beside the numbers: the scene by each preset, and maps of the errors over the hemisphere."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

import numpy as np

from ..errors import HarnessError
from ..ladder import Ladder
from . import model, relative, scene
from .choices import WHOLE, Choice
from .values import rounded, values

#: of the surface and the viewer in all maps: half a metal, so that every term has a share, and degrees from the normal
ROUGHNESS, METALNESS, VIEW = 0.2, 0.5, 60.0
SIZE = 112  # of a map, in pixels

#: of a map, what it is of: the formula against the exact one, and float32 against double of the same formula
FORMULA, ROUNDING = "formula", "rounding"


def pictures(
    project_path: str | os.PathLike, ladder: Ladder, progress: Callable[[str], None] = lambda said: None
) -> dict[str, np.ndarray]:
    """The scene by each preset, (h, w, 4) uint8, without those that cannot be drawn: the trade has the reason."""
    drawn = {}
    for preset in ladder.presets:
        progress(f"picture, {preset.name}")
        try:
            drawn[preset.name] = scene.picture(project_path, preset.macros)
        except HarnessError:
            continue
    return drawn


def maps(
    chosen: Sequence[Choice], progress: Callable[[str], None] = lambda said: None
) -> dict[str, dict[str, np.ndarray]]:
    """Of each choice of the whole model FORMULA and ROUNDING, relative errors (SIZE, SIZE), NaN outside of the disk.

    Without what cannot be evaluated: the trade has the reason.
    """
    made = {}
    for choice in chosen:
        if choice.whole != WHOLE:
            continue
        progress(f"map, {choice.name}")
        try:
            shade = choice.function(WHOLE)
            exact = choice.function(WHOLE, choice.exact)
            made[choice.name] = {
                FORMULA: model.hemisphere(shade, exact, VIEW, ROUGHNESS, metalness=METALNESS, size=SIZE),
                ROUNDING: rounding(shade),
            }
        except HarnessError:
            continue
    return made


def rounding(shade) -> np.ndarray:
    """The relative error of float32, every operation as written, against double at the same float32 directions."""
    light = model.disk(SIZE)
    inside = ~np.isnan(light[..., 0])
    angle = np.radians(VIEW)
    view = [np.sin(angle), 0, np.cos(angle)]
    flat = rounded(model.surface(light[inside], view, model.ALBEDO, METALNESS, ROUGHNESS))
    found = np.full(inside.shape, np.nan)
    got, want = (values(shade.with_mode(mode), flat) for mode in ("precise", "double"))
    found[inside] = relative.errors(got, want)
    return found
