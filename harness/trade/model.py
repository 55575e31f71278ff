"""The model's error: how far a rung's formula is from the exact one, both in double; and where on the hemisphere."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..calling.function import Function
from ..errors import CallError
from ..searching.inputs import named_leaves
from . import relative
from .values import Flat, only, values

#: of ``hemisphere``: what the surface is where nothing else is said
ALBEDO = 0.5


def model(function: Function, exact: Function, flat: Flat) -> dict[str, Any]:
    """``relative.summary`` of a function against another of the same inputs, both in double at inputs in double."""
    got, want = (values(f.with_mode("double"), flat) for f in (function, exact))
    return relative.summary(relative.errors(got, want), flat)


def disk(size: int) -> np.ndarray:
    """The upper hemisphere seen from above: unit vectors (size, size, 3), NaN outside of the disk; +y in row 0."""
    x = (np.arange(size) + 0.5) * 2 / size - 1
    x, y = np.meshgrid(x, -x)
    with np.errstate(invalid="ignore"):
        z = np.sqrt(1 - x * x - y * y)
    return np.where(np.isnan(z)[..., None], np.nan, np.stack([x, y, z], axis=-1))


def hemisphere(
    shade: Function, exact: Function, view: float, roughness: float, *, metalness: float = 0.0, size: int = 128
) -> np.ndarray:
    """The relative error of one shading function against another over all directions of the light, in double.

    (size, size), NaN outside of the disk that the upper hemisphere is seen as from above. The normal is +z, the viewer
    stands ``view`` degrees from it toward +x, to the right; so the highlight is left of the middle. The material is
    grey of albedo 0.5. CallError when the functions are not called as ``shade`` is.
    """
    light = disk(size)
    inside = ~np.isnan(light[..., 0])
    angle = np.radians(view)
    flat = surface(light[inside], [np.sin(angle), 0, np.cos(angle)], ALBEDO, metalness, roughness)
    found = np.full((size, size), np.nan)
    got, want = (values(checked(f).with_mode("double"), flat) for f in (shade, exact))
    found[inside] = relative.errors(got, want)
    return found


def checked(shade: Function) -> Function:
    """The function itself. CallError unless it is one of l, v, n and a material of albedo, metalness and roughness."""
    signature = only(shade)
    parts = {name: leaf.size for name, leaf in named_leaves(signature).items()}
    wanted = {"l": 3, "v": 3, "n": 3, "m.albedo": 3, "m.metalness": 1, "m.roughness": 1}
    if parts != wanted:
        raise CallError(f"{signature} is not called as shade(vec3 l, vec3 v, vec3 n, Material m) is", *signature.origin)
    return shade


def surface(l, v, albedo, metalness, roughness) -> dict[str, np.ndarray]:  # noqa: E741
    """The inputs of ``shade`` for directions that broadcast, with the normal +z, as ``values`` takes them."""
    l, v, albedo = np.broadcast_arrays(l, v, np.asarray(albedo, np.float64)[..., None])  # noqa: E741
    count = l.size // 3
    return {
        "l": l.reshape(count, 3),
        "v": v.reshape(count, 3),
        "n": np.broadcast_to([0.0, 0.0, 1.0], (count, 3)),
        "m.albedo": albedo.reshape(count, 3),
        "m.metalness": np.full(count, float(metalness)),
        "m.roughness": np.full(count, float(roughness)),
    }
