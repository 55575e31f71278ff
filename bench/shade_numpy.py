"""``shade`` in numpy: the arithmetic of shaders/brdf.glsl, vectorised."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .inputs import Inputs

#: rows at a time: the temporaries of a block stay in the cache, which is 1.5 times as fast at 4 million
BLOCK = 16384

PI, DIELECTRIC_F0 = np.float32(np.pi), np.float32(0.04)
#: the least alpha^2, and the least divisor
LEAST_ALPHA2, LEAST = np.float32(1e-26), np.float32(1e-37)


def _dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def _shade(l, v, n, albedo, metalness, roughness):  # noqa: E741
    alpha = roughness * roughness
    alpha2 = alpha * alpha + LEAST_ALPHA2
    NoL, NoV = np.clip(_dot(n, l), 0, 1), np.clip(_dot(n, v), 0, 1)
    lit = np.where(NoV > 0, NoL, np.float32(0)) / (2 * PI)
    H, NoHH = np.float32(0.5) * (l + v), np.float32(0.5) * (NoL + NoV)
    p = H - n * NoHH[:, None]
    sin2, cos2 = _dot(p, p) + LEAST, NoHH * NoHH
    HH = sin2 + cos2
    c = np.sqrt(HH)

    k = alpha * HH / (sin2 + alpha2 * cos2)
    masking = np.sqrt((NoV - alpha2 * NoV) * NoV + alpha2)
    shadowing = np.sqrt((NoL - alpha2 * NoL) * NoL + alpha2)
    V = np.float32(0.5) / (NoL * masking + (NoV * shadowing + LEAST))
    S = 2 * (k * k * (V * lit))

    x = np.maximum(1 - c, 0)
    q = c - np.float32(0.5) * HH
    y = 4 * (q - q * q)
    W, w = x * y + c, x - x * y
    dielectric = 1 - metalness
    A, G, E = metalness * W, dielectric * W, 2 * (dielectric * lit)
    linear, square, constant = S * A + E * (W - DIELECTRIC_F0 * G), E * A, S * (DIELECTRIC_F0 * G + w)
    return albedo * (linear[:, None] - square[:, None] * albedo) + constant[:, None]


def contender() -> Callable[[Inputs], np.ndarray]:
    """The function."""

    def shade(x: Inputs) -> np.ndarray:
        radiance = np.empty_like(x.l)
        for first in range(0, len(radiance), BLOCK):
            rows = slice(first, first + BLOCK)
            radiance[rows] = _shade(*(array[rows] for array in x))
        return radiance

    return shade
