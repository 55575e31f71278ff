"""Points, normals and tangents of a bicubic Bezier patch on a regular grid of its parameters.

A net is (4, 4, 3): rows along t, columns along s. Everything is float64 and done by one elementwise + - * /
or square root at a time, each of which IEEE 754 rounds in one way only: the same bits on every machine. Sums
by np.sum, np.dot, np.einsum or np.linalg may add in another order, or fuse operations, in another build.
"""

from typing import NamedTuple

import numpy as np


class PatchGrid(NamedTuple):
    """A patch at (n + 1) x (n + 1) parameter values: element [i, j] is at t = i/n, s = j/n."""

    position: np.ndarray
    """(n + 1, n + 1, 3)"""
    normal: np.ndarray
    """(n + 1, n + 1, 3), unit, along dP/ds x dP/dt"""
    tangent: np.ndarray
    """(n + 1, n + 1, 3), unit, along dP/ds, so orthogonal to the normal"""


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Scalar product over the last axis, (..., 3) and (..., 3) to (..., 1)."""
    return a[..., 0:1] * b[..., 0:1] + a[..., 1:2] * b[..., 1:2] + a[..., 2:3] * b[..., 2:3]


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Vector product over the last axis, (..., 3) and (..., 3) to (..., 3)."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def length(a: np.ndarray) -> np.ndarray:
    """Euclidean length over the last axis, (..., 3) to (..., 1)."""
    return np.sqrt(dot(a, a))


def quadratic(x: np.ndarray) -> list[np.ndarray]:
    """The three Bernstein polynomials of degree 2 at x in [0, 1]; exactly 0 or 1 at the ends."""
    y = 1 - x
    return [y * y, 2 * x * y, x * x]


def cubic(x: np.ndarray) -> list[np.ndarray]:
    """The four Bernstein polynomials of degree 3 at x in [0, 1]; exactly 0 or 1 at the ends."""
    y = 1 - x
    return [y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x]


def tensor_product(along_t: list[np.ndarray], along_s: list[np.ndarray], net: np.ndarray) -> np.ndarray:
    """Sum over i, k of along_t[i] along_s[k] net[i, k]: weights (m,) and (n,) and a net give (m, n, 3)."""
    total = np.zeros((along_t[0].size, along_s[0].size, 3))
    for i, weight_t in enumerate(along_t):
        for k, weight_s in enumerate(along_s):
            total = total + weight_t[:, None, None] * weight_s[None, :, None] * net[i, k]
    return total


def evaluate(net: np.ndarray, segments: int) -> PatchGrid:
    """Evaluate a patch; its rows at t = 0 and t = 1 may collapse to a point (a pole of the surface).

    The derivatives are Bezier surfaces of lower degree on differences of control points (G. Farin, "Curves
    and Surfaces for CAGD", 2002), so that dP/ds is exactly 0 where a row collapses.
    """
    x = np.arange(segments + 1) / segments
    net_s, net_t = 3 * np.diff(net, axis=1), 3 * np.diff(net, axis=0)
    net_st = 3 * np.diff(net_s, axis=0)
    position = tensor_product(cubic(x), cubic(x), net)
    dP_ds = tensor_product(cubic(x), quadratic(x), net_s)
    dP_dt = tensor_product(quadratic(x), cubic(x), net_t)
    # At a distance h from a pole, dP/ds = h d2P/dsdt + O(h^2) by Taylor, with h > 0 into the patch from t = 0
    # and h < 0 from t = 1: its direction tends to that of d2P/dsdt or of its opposite.
    d2P_dsdt = tensor_product(quadratic(x), quadratic(x), net_st)
    sign_of_h = (1 - 2 * x)[:, None, None]
    is_pole = np.all(dP_ds == 0, axis=(1, 2))[:, None, None]
    dP_ds = np.where(is_pole, sign_of_h * d2P_dsdt, dP_ds)
    position = np.where(is_pole, position[:, :1], position)  # one point, where rounding may have made several
    normal = cross(dP_ds, dP_dt)
    return PatchGrid(position, normal / length(normal), dP_ds / length(dP_ds))
