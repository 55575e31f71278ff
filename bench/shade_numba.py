"""``shade`` in numba: the arithmetic of shaders/brdf.glsl as a loop, compiled for all cores."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

from .inputs import Inputs

# A Python number would make the arithmetic double.
PI, DIELECTRIC_F0 = np.float32(np.pi), np.float32(0.04)
ZERO, HALF, ONE, TWO, FOUR = (np.float32(x) for x in (0, 0.5, 1, 2, 4))
#: the least alpha^2, and the least divisor
LEAST_ALPHA2, LEAST = np.float32(1e-26), np.float32(1e-37)


@numba.njit(inline="always")
def _clamp(x):
    return min(max(x, ZERO), ONE)


@numba.njit(parallel=True, fastmath=False, error_model="numpy", cache=True)
def _shade(l, v, n, albedo, metalness, roughness, radiance):  # noqa: E741
    for i in numba.prange(len(radiance)):
        nx, ny, nz = n[i, 0], n[i, 1], n[i, 2]
        lx, ly, lz = l[i, 0], l[i, 1], l[i, 2]
        vx, vy, vz = v[i, 0], v[i, 1], v[i, 2]
        alpha = roughness[i] * roughness[i]
        alpha2 = alpha * alpha + LEAST_ALPHA2
        NoL = _clamp(nx * lx + ny * ly + nz * lz)
        NoV = _clamp(nx * vx + ny * vy + nz * vz)
        lit = NoL / (TWO * PI) if NoV > ZERO else ZERO
        hx, hy, hz = HALF * (lx + vx), HALF * (ly + vy), HALF * (lz + vz)
        NoHH = HALF * (NoL + NoV)
        px, py, pz = hx - nx * NoHH, hy - ny * NoHH, hz - nz * NoHH
        sin2, cos2 = px * px + (py * py + (pz * pz + LEAST)), NoHH * NoHH
        HH = sin2 + cos2
        c = np.sqrt(HH)

        k = alpha * HH / (sin2 + alpha2 * cos2)
        masking = np.sqrt((NoV - alpha2 * NoV) * NoV + alpha2)
        shadowing = np.sqrt((NoL - alpha2 * NoL) * NoL + alpha2)
        V = HALF / (NoL * masking + (NoV * shadowing + LEAST))
        S = TWO * (k * k * (V * lit))

        x = max(ONE - c, ZERO)
        q = c - HALF * HH
        y = FOUR * (q - q * q)
        W, w = x * y + c, x - x * y
        dielectric = ONE - metalness[i]
        A, G, E = metalness[i] * W, dielectric * W, TWO * (dielectric * lit)
        linear, square, constant = S * A + E * (W - DIELECTRIC_F0 * G), E * A, S * (DIELECTRIC_F0 * G + w)
        for j in range(3):
            a = albedo[i, j]
            radiance[i, j] = a * (linear - square * a) + constant


def contender() -> Callable[[Inputs], np.ndarray]:
    """The function, compiled at its first call."""

    def shade(x: Inputs) -> np.ndarray:
        radiance = np.empty_like(x.l)
        _shade(*x, radiance)
        return radiance

    return shade
