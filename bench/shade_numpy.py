"""``shade`` in numpy: the arithmetic of shaders/brdf.glsl, vectorised."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .inputs import Inputs

#: rows at a time: the temporaries of a block stay in the cache, which is 1.5 times as fast at 4 million
BLOCK = 16384

PI, DIELECTRIC_F0, TINY = np.float32(np.pi), np.float32(0.04), np.float32(1.2e-38)


def _dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def _shade(l, v, n, albedo, metalness, roughness):  # noqa: E741
    alpha = roughness * roughness
    alpha2 = alpha * alpha
    NoL, NoV = np.clip(_dot(n, l), 0, 1), np.clip(_dot(n, v), 0, 1)
    H = l + v
    NoHH = NoL + NoV
    (nx, ny, nz), (hx, hy, hz) = n.T, H.T
    x, y, z = ny * hz - nz * hy, nz * hx - nx * hz, nx * hy - ny * hx
    sin2, cos2 = x * x + y * y + z * z, NoHH * NoHH
    HH = sin2 + cos2

    k = alpha * HH / (sin2 + (alpha2 * cos2 + np.float32(1e-37)))
    D = k * k / PI
    masking = NoL * np.sqrt(alpha2 + NoV * (NoV - alpha2 * NoV))
    shadowing = NoV * np.sqrt(alpha2 + NoL * (NoL - alpha2 * NoL))
    V = np.float32(0.5) / np.maximum(masking + shadowing, TINY)
    highlight = np.minimum(D * (V * NoL), np.float32(1e37))

    LoH = np.minimum(np.float32(0.5) * np.sqrt(HH), 1)
    x = 1 - LoH
    x2 = x * x
    w = x2 * x2 * x
    left = LoH * ((1 + x) * (1 + x2) + x2 * x2)
    diffuse = (1 - metalness) * (NoL / PI)
    F0 = (DIELECTRIC_F0 * (1 - metalness))[:, None] + albedo * metalness[:, None]
    F = F0 + (1 - F0) * w[:, None]
    radiance = F * highlight[:, None] + (1 - F0) * left[:, None] * albedo * diffuse[:, None]
    return np.where(((NoL > 0) & (NoV > 0))[:, None], radiance, np.float32(0))


def contender() -> Callable[[Inputs], np.ndarray]:
    """The function."""

    def shade(x: Inputs) -> np.ndarray:
        radiance = np.empty_like(x.l)
        for first in range(0, len(radiance), BLOCK):
            rows = slice(first, first + BLOCK)
            radiance[rows] = _shade(*(array[rows] for array in x))
        return radiance

    return shade
