"""4 x 4 matrices for column vectors, in single precision and with the operations of glm, SHADERed's library.

Rounding as glm rounds makes pictures equal to the bit. All take and give numpy float32; angles are radians.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

f32 = np.float32


def radians(degrees: float) -> np.float32:
    """An angle in radians."""
    return f32(degrees) * f32(0.017453292519943295)


def _sin(angle: np.float32) -> np.float32:
    return f32(math.sin(angle)) if math.isfinite(angle) else f32(math.nan)


def _cos(angle: np.float32) -> np.float32:
    return f32(math.cos(angle)) if math.isfinite(angle) else f32(math.nan)


def _tan(angle: np.float32) -> np.float32:
    return f32(math.tan(angle)) if math.isfinite(angle) else f32(math.nan)


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The matrix a b, summed from left to right without fused operations, which BLAS would not promise."""
    total = a[:, 0:1] * b[0:1, :]
    for k in range(1, 4):
        total = total + a[:, k : k + 1] * b[k : k + 1, :]
    return total


def translation(offset: Sequence[float]) -> np.ndarray:
    """The matrix that moves by ``offset`` (3)."""
    m = np.eye(4, dtype=f32)
    m[:3, 3] = offset
    return m


def scaling(factors: Sequence[float]) -> np.ndarray:
    """The matrix that scales by ``factors`` (3) along the axes."""
    return np.diag(np.array([*factors, 1], f32))


def rotation(pitch: float, yaw: float, roll: float) -> np.ndarray:
    """Ry(yaw) Rx(pitch) Rz(roll): about z first, then x, then y. As glm::yawPitchRoll."""
    pitch, yaw, roll = f32(pitch), f32(yaw), f32(roll)
    sp, cp, sy, cy, sr, cr = _sin(pitch), _cos(pitch), _sin(yaw), _cos(yaw), _sin(roll), _cos(roll)
    return np.array(
        [
            [cy * cr + sy * sp * sr, -cy * sr + sy * sp * cr, sy * cp, 0],
            [sr * cp, cr * cp, -sp, 0],
            [-sy * cr + cy * sp * sr, sr * sy + cy * sp * cr, cy * cp, 0],
            [0, 0, 0, 1],
        ],
        f32,
    )


def item_matrix(position: Sequence[float], pitch_yaw_roll: Sequence[float], scale: Sequence[float]) -> np.ndarray:
    """An item's place in the world: T Ry(yaw) Rx(pitch) Rz(roll) S."""
    return product(product(translation(position), rotation(*pitch_yaw_roll)), scaling(scale))


def _dot(a: np.ndarray, b: np.ndarray) -> np.float32:
    x, y, z = a * b
    return x + y + z


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array([a[i] * b[j] - b[i] * a[j] for i, j in ((1, 2), (2, 0), (0, 1))], f32)


def normalized(v: np.ndarray) -> np.ndarray:
    """The unit vector along v (3)."""
    return v * (f32(1) / np.sqrt(_dot(v, v)))


def look_at(eye: np.ndarray, center: np.ndarray, up: np.ndarray) -> np.ndarray:
    """World to view space: the eye at the origin, ``center`` on the -z axis, ``up`` in the upper half."""
    forward = normalized(center - eye)
    side = normalized(_cross(forward, up))
    top = _cross(side, forward)
    m = np.eye(4, dtype=f32)
    for row, axis in enumerate((side, top, -forward)):
        m[row, :3] = axis
    m[:3, 3] = -_dot(side, eye), -_dot(top, eye), _dot(forward, eye)
    return m


def perspective(field_of_view: float, aspect: float, near: float, far: float) -> np.ndarray:
    """View to clip space, depth -1...1. ``field_of_view`` is the vertical one, ``aspect`` width by height."""
    near, far = f32(near), f32(far)
    half = _tan(f32(field_of_view) / f32(2))
    m = np.zeros((4, 4), f32)
    m[0, 0] = f32(1) / (f32(aspect) * half)
    m[1, 1] = f32(1) / half
    m[2, 2] = -(far + near) / (far - near)
    m[2, 3] = -(f32(2) * far * near) / (far - near)
    m[3, 2] = -1
    return m


def orthographic(left: float, right: float, bottom: float, top: float, near: float, far: float) -> np.ndarray:
    """View to clip space without perspective."""
    low, high = np.array([left, bottom, near], f32), np.array([right, top, far], f32)
    m = np.eye(4, dtype=f32)
    m[[0, 1, 2], [0, 1, 2]] = np.array([2, 2, -2], f32) / (high - low)
    m[:3, 3] = -(high + low) / (high - low)
    return m


def inverse(m: np.ndarray) -> np.ndarray:
    """The inverse (2, 2), (3, 3) or (4, 4) by cofactors, as glm::inverse rounds it; infinities and NaN where there is
    none."""
    if len(m) == 2:
        return _inverse2(m)
    if len(m) == 3:
        return _inverse3(m)
    columns = m.T
    first, second = [2, 2, 1, 1], [3, 3, 3, 2]

    def minors(i: int, j: int) -> np.ndarray:
        return columns[first, i] * columns[second, j] - columns[second, i] * columns[first, j]

    x, y, z, w = (columns[[1, 0, 0, 0], k] for k in range(4))
    zw, yw, yz, xw, xz, xy = (minors(i, j) for i, j in ((2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1)))
    cofactors = np.stack(
        [
            y * zw - z * yw + w * yz,
            x * zw - z * xw + w * xz,
            x * yw - y * xw + w * xy,
            x * yz - y * xz + z * xy,
        ],
        axis=1,
    )
    cofactors *= np.array([[1, -1, 1, -1], [-1, 1, -1, 1], [1, -1, 1, -1], [-1, 1, -1, 1]], f32)
    terms = columns[0] * cofactors[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return cofactors * (f32(1) / ((terms[0] + terms[1]) + (terms[2] + terms[3])))


@np.errstate(divide="ignore", invalid="ignore")
def _inverse2(m: np.ndarray) -> np.ndarray:
    (a, b), (c, d) = m
    return np.array([[d, -b], [-c, a]], f32) * (f32(1) / (a * d - b * c))


@np.errstate(divide="ignore", invalid="ignore")
def _inverse3(m: np.ndarray) -> np.ndarray:
    (a, b, c), (d, e, f), (g, h, i) = m.T  # columns
    determinant = a * (e * i - h * f) - d * (b * i - h * c) + g * (b * f - e * c)
    adjugate = [
        [e * i - h * f, -(d * i - g * f), d * h - g * e],
        [-(b * i - h * c), a * i - g * c, -(a * h - g * b)],
        [b * f - e * c, -(a * f - d * c), a * e - d * b],
    ]
    return np.array(adjugate, f32) * (f32(1) / determinant)


def axis_rotation(axis: Sequence[float], angle: float) -> np.ndarray:
    """The rotation about an axis through the origin by an angle in radians, as glm::rotate rounds it."""
    c, s = _cos(f32(angle)), _sin(f32(angle))
    axis = normalized(np.array(axis, f32))
    x, y, z = axis
    part = (f32(1) - c) * axis
    m = np.eye(4, dtype=f32)
    m[:3, 0] = c + part[0] * x, part[0] * y + s * z, part[0] * z - s * y
    m[:3, 1] = part[1] * x - s * z, c + part[1] * y, part[1] * z + s * x
    m[:3, 2] = part[2] * x + s * y, part[2] * y - s * x, c + part[2] * z
    return m


def perspective_of_size(field_of_view: float, width: float, height: float, near: float, far: float) -> np.ndarray:
    """View to clip space by the vertical field of view and a size, as glm::perspectiveFov rounds it."""
    half = f32(0.5) * f32(field_of_view)
    up = _cos(half) / _sin(half)
    near, far = f32(near), f32(far)
    m = np.zeros((4, 4), f32)
    m[0, 0], m[1, 1] = up * f32(height) / f32(width), up
    m[2, 2], m[2, 3] = -(far + near) / (far - near), -(f32(2) * far * near) / (far - near)
    m[3, 2] = -1
    return m
