"""Function variables: what SHADERed computes from their arguments.

All matrices are right-handed and GL's, whatever their names say; angles are in degrees where not said otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import transforms
from .transforms import f32, radians

#: MatrixPerspectiveLH's field of view: meant as degrees, taken as radians
_FIXED_FIELD_OF_VIEW = 45.0


def compute(function: str, arguments: Sequence[float], size: int) -> np.ndarray:
    """The value of a function of project.FUNCTIONS, flat float32: a matrix column by column. ``size`` numbers."""
    a = np.array(arguments, f32)
    if function.startswith("Matrix"):
        return _matrix(function, a).T.reshape(-1)
    if function == "VectorNormalize":
        return _normalized(a[:size])
    angle = radians(a[0])
    return np.array([np.sin(np.float64(angle)) if function == "ScalarSin" else np.cos(np.float64(angle))], f32)


def _matrix(function: str, a: np.ndarray) -> np.ndarray:
    match function:
        case "MatrixIdentity":
            return np.eye(4, dtype=f32)
        case "MatrixLookAtLH":
            return transforms.look_at(a[0:3], a[3:6], a[6:9])
        case "MatrixLookToLH":
            return transforms.look_at(a[0:3], a[0:3] + a[3:6], a[6:9])
        case "MatrixOrthographicLH":
            return transforms.orthographic(0, a[0], 0, a[1], a[2], a[3])
        case "MatrixPerspectiveFovLH":
            return transforms.perspective(a[0], a[1], a[2], a[3])
        case "MatrixPerspectiveLH":
            return transforms.perspective_of_size(_FIXED_FIELD_OF_VIEW, *a)
        case "MatrixRotationAxis" | "MatrixRotationNormal":
            return transforms.axis_rotation(a[0:3], radians(a[3]))
        case "MatrixRotationX" | "MatrixRotationY" | "MatrixRotationZ":
            return transforms.axis_rotation(np.eye(3, dtype=f32)["XYZ".index(function[-1])], radians(a[0]))
        case "MatrixScaling":
            return transforms.scaling(a)
        case "MatrixTranslation":
            return transforms.translation(a)
    return np.zeros((4, 4), f32)  # MatrixRotationRollPitchYaw: whatever is in memory, in SHADERed


def _normalized(v: np.ndarray) -> np.ndarray:
    """The unit vector along v (2, 3 or 4); glm adds the products of four numbers in pairs."""
    p = v * v
    total = (p[0] + p[1]) + (p[2] + p[3]) if len(p) == 4 else p[0] + p[1] if len(p) == 2 else p[0] + p[1] + p[2]
    return v * (f32(1) / np.sqrt(total))
