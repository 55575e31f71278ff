"""``shade`` in numba: the arithmetic of shaders/brdf.glsl as a loop, compiled for all cores."""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np

from .inputs import Inputs

# A Python number would make the arithmetic double.
PI, DIELECTRIC_F0, TINY = np.float32(np.pi), np.float32(0.04), np.float32(1.2e-38)
ZERO, HALF, ONE = np.float32(0), np.float32(0.5), np.float32(1)
LEAST_DIVISOR, MOST = np.float32(1e-37), np.float32(1e37)


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
        alpha2 = alpha * alpha
        NoL = _clamp(nx * lx + ny * ly + nz * lz)
        NoV = _clamp(nx * vx + ny * vy + nz * vz)
        hx, hy, hz = lx + vx, ly + vy, lz + vz
        NoHH = NoL + NoV
        x, y, z = ny * hz - nz * hy, nz * hx - nx * hz, nx * hy - ny * hx
        sin2, cos2 = x * x + y * y + z * z, NoHH * NoHH
        HH = sin2 + cos2

        k = alpha * HH / (sin2 + (alpha2 * cos2 + LEAST_DIVISOR))
        D = k * k / PI
        masking = NoL * np.sqrt(alpha2 + NoV * (NoV - alpha2 * NoV))
        shadowing = NoV * np.sqrt(alpha2 + NoL * (NoL - alpha2 * NoL))
        V = HALF / max(masking + shadowing, TINY)
        highlight = min(D * (V * NoL), MOST)

        LoH = min(HALF * np.sqrt(HH), ONE)
        x = ONE - LoH
        x2 = x * x
        w = x2 * x2 * x
        left = LoH * ((ONE + x) * (ONE + x2) + x2 * x2)
        diffuse = (ONE - metalness[i]) * (NoL / PI)
        lit = NoL > ZERO and NoV > ZERO
        for c in range(3):
            F0 = DIELECTRIC_F0 * (ONE - metalness[i]) + albedo[i, c] * metalness[i]
            F = F0 + (ONE - F0) * w
            value = F * highlight + (ONE - F0) * left * albedo[i, c] * diffuse
            radiance[i, c] = value if lit else ZERO


def contender() -> Callable[[Inputs], np.ndarray]:
    """The function, compiled at its first call."""

    def shade(x: Inputs) -> np.ndarray:
        radiance = np.empty_like(x.l)
        _shade(*x, radiance)
        return radiance

    return shade
