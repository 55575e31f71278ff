"""``shade`` in numba: the arithmetic of shaders/brdf.glsl as a loop, compiled for all cores."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

from .inputs import Inputs

# A Python number would make the arithmetic double.
PI, DIELECTRIC_F0 = np.float32(np.pi), np.float32(0.04)
ZERO, HALF, ONE = np.float32(0), np.float32(0.5), np.float32(1)
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
        lit = NoL / PI if NoV > ZERO else ZERO
        hx, hy, hz = lx + vx, ly + vy, lz + vz
        NoHH = NoL + NoV
        x, y, z = ny * hz - nz * hy, nz * hx - nx * hz, nx * hy - ny * hx
        sin2, cos2 = x * x + (y * y + (z * z + LEAST)), NoHH * NoHH
        HH = sin2 + cos2

        k = alpha * HH / (sin2 + alpha2 * cos2)
        masking = np.sqrt((NoV - alpha2 * NoV) * NoV + alpha2)
        shadowing = np.sqrt((NoL - alpha2 * NoL) * NoL + alpha2)
        V = HALF / (NoL * masking + (NoV * shadowing + LEAST))
        S = k * k * (V * lit)

        c = HALF * np.sqrt(HH)
        x = max(ONE - c, ZERO)
        x2 = x * x
        x4 = x2 * x2
        left2 = c * x + c
        left4 = left2 * x2 + left2
        W = x4 * c + left4
        dielectric = ONE - metalness[i]
        f = DIELECTRIC_F0 * (dielectric * W)
        A, B = metalness[i] * W, x4 * x + f
        E = dielectric * lit
        linear, square, constant = S * A + E * (W - f), E * A, S * B
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
