"""SHADERed's built-in shapes, vertex for vertex: their order shows in gl_VertexID and in interpolation.

Each is a triangle list without indices, in single precision, as float32 (n, 18): position, normal, texture
coordinate, tangent, bitangent, colour, in the order of native.Field.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..projects.project import Vector3
from .transforms import radians

f32 = np.float32
PI, TWO_PI = f32(math.pi), f32(2 * math.pi)

CIRCLE_SEGMENTS = 32
SPHERE_STACKS = SPHERE_SLICES = 20

_POSITION, _NORMAL, _TEXCOORD = slice(0, 3), slice(3, 6), slice(6, 8)
_TANGENT, _BITANGENT, _COLOR = slice(8, 11), slice(11, 14), slice(14, 18)

# The two ways in which a face's corners a b c d (0 1 2 3) become triangles.
_ABC_ACD, _ABC_DAC = (0, 1, 2, 0, 2, 3), (0, 1, 2, 3, 0, 2)

#: faces of the cube: normal, corners a b c d as signs of the half extents, texture coordinates, triangles
_CUBE = (
    ((0, 0, 1), "--+ +-+ +++ -++", "00 10 11 01", _ABC_ACD),
    ((0, 0, -1), "++- +-- --- -+-", "11 10 00 01", _ABC_DAC),
    ((1, 0, 0), "+-+ +-- ++- +++", "00 10 11 01", _ABC_ACD),
    ((-1, 0, 0), "-+- --- --+ -++", "11 10 00 01", _ABC_DAC),
    ((0, 1, 0), "-++ +++ ++- -+-", "00 10 11 01", _ABC_ACD),
    ((0, -1, 0), "+-- +-+ --+ ---", "11 10 00 01", _ABC_DAC),
)


# Triangles without area and shapes without size get NaN, huge ones infinities, as in SHADERed.
@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def vertices(shape: str, size: Vector3 = (1.0, 1.0, 1.0)) -> np.ndarray:
    """The vertices of a shape of project.SHAPES, ``size`` being its width, height and depth."""
    width, height, depth = (f32(s) for s in size)
    match shape:
        case "Cube":
            return cube(width, height, depth)
        case "Sphere":
            return sphere(width)
        case "Plane":
            return plane(width, height)
        case "ScreenQuad":
            return plane(f32(1), f32(1))
        case "Circle":
            return circle(width, height)
        case "Triangle":
            return triangle(width)
        case "ScreenQuadNDC":
            return screen_quad_ndc()
    raise ValueError(f"there is no shape {shape!r}")


def cube(width: float, height: float, depth: float) -> np.ndarray:
    """A box of these full sizes."""
    half = np.array([width, height, depth], f32) / f32(2)
    faces = [
        _face(normal, _signs(corners) * half, [[float(c) for c in uv] for uv in texcoords.split()], order)
        for normal, corners, texcoords, order in _CUBE
    ]
    return _with_tangents(np.concatenate(faces))


def plane(width: float, height: float) -> np.ndarray:
    """A rectangle of these full sizes in the xy plane, facing -z."""
    corners = _signs("++0 +-0 --0 -+0") * (np.array([width, height, 0], f32) / f32(2))
    return _with_tangents(_face((0, 0, -1), corners, [[1, 1], [1, 0], [0, 0], [0, 1]], _ABC_DAC))


def circle(radius_x: float, radius_y: float) -> np.ndarray:
    """An ellipse in the xy plane, facing -z: a fan of triangles that begins at +y and goes toward +x."""
    step = TWO_PI / f32(CIRCLE_SEGMENTS)
    angles = step * np.arange(CIRCLE_SEGMENTS + 1, dtype=f32)
    sine, cosine = _rounded(np.sin, angles), _rounded(np.cos, angles)
    rim = np.stack([sine * f32(radius_x), cosine * f32(radius_y), np.zeros_like(sine)], axis=-1)
    rim_uv = np.stack([sine, cosine], axis=-1) * f32(0.5) + f32(0.5)
    fan = _blank(CIRCLE_SEGMENTS * 3).reshape(CIRCLE_SEGMENTS, 3, -1)
    fan[..., _NORMAL] = 0, 0, -1
    fan[:, 0, _TEXCOORD] = 0.5
    for corner, points in ((1, slice(None, -1)), (2, slice(1, None))):
        fan[:, corner, _POSITION], fan[:, corner, _TEXCOORD] = rim[points], rim_uv[points]
    return _with_tangents(fan.reshape(CIRCLE_SEGMENTS * 3, -1))


def triangle(size: float) -> np.ndarray:
    """A triangle in the xy plane, facing +z: ``size`` up and down, size / tan 30 degrees to the sides."""
    right = f32(size) / f32(math.tan(radians(30)))
    corners = [[-right, -size, 0], [right, -size, 0], [0, size, 0]]
    return _with_tangents(_face((0, 0, 1), corners, [[1, 0], [0, 0], [0.5, 1]], (0, 1, 2)))


def sphere(radius: float) -> np.ndarray:
    """A sphere of 20 x 20 faces with its poles on the z axis and smooth normals."""
    phi = (PI / f32(SPHERE_STACKS)) * np.arange(SPHERE_STACKS + 1, dtype=f32)[:, None]
    theta = (TWO_PI / f32(SPHERE_SLICES)) * np.arange(SPHERE_SLICES + 1, dtype=f32)[None, :]
    sin_phi, cos_phi = _rounded(np.sin, phi), _rounded(np.cos, phi)
    sin_theta, cos_theta = _rounded(np.sin, theta), _rounded(np.cos, theta)
    flat = f32(radius) * sin_phi
    grid = _blank((SPHERE_STACKS + 1) * (SPHERE_SLICES + 1)).reshape(SPHERE_STACKS + 1, SPHERE_SLICES + 1, -1)
    grid[..., 0], grid[..., 1], grid[..., 2] = flat * cos_theta, flat * sin_theta, f32(radius) * cos_phi
    grid[..., _NORMAL] = _normalized(grid[..., _POSITION])
    grid[..., 6], grid[..., 7] = theta / TWO_PI, phi / PI
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]
    faces = np.stack([c, b, a, b, c, d], axis=2)
    return _with_tangents(faces.reshape(-1, grid.shape[-1]))


def screen_quad_ndc() -> np.ndarray:
    """The whole target, in clip space. Only position and texture coordinate mean anything."""
    quad = _blank(6)
    quad[:, _POSITION] = _signs("--0 +-0 ++0 --0 ++0 -+0")
    quad[:, _TEXCOORD] = (quad[:, :2] + 1) / 2
    return quad


# ---- Parts of shapes -------------------------------------------------------------------------------------


def _signs(corners: str) -> np.ndarray:
    """Corners such as "+-0" as (n, 3) of 1, -1 and 0."""
    sign = {"+": 1, "-": -1, "0": 0}
    return np.array([[sign[c] for c in corner] for corner in corners.split()], f32)


def _rounded(function: np.ufunc, angles: np.ndarray) -> np.ndarray:
    """sin or cos of float32 angles, rounded once; numpy's own in float32 are a little less accurate."""
    return function(angles.astype(np.float64)).astype(f32)


def _blank(count: int) -> np.ndarray:
    """Vertices with nothing but the colour white."""
    blank = np.zeros((count, _COLOR.stop), f32)
    blank[:, _COLOR] = 1
    return blank


def _face(normal: Sequence, corners: Sequence, texcoords: Sequence, order: Sequence[int]) -> np.ndarray:
    face = _blank(len(order))
    face[:, _POSITION] = np.array(corners, f32)[list(order)]
    face[:, _NORMAL] = normal
    face[:, _TEXCOORD] = np.array(texcoords, f32)[list(order)]
    return face


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    p = a * b
    return (p[..., 0] + p[..., 1] + p[..., 2])[..., None]


def _normalized(v: np.ndarray) -> np.ndarray:
    return v * (f32(1) / np.sqrt(_dot(v, v)))


def _with_tangents(flat: np.ndarray) -> np.ndarray:
    """Fills in tangents and bitangents, triangle by triangle.

    The bitangent is dP/dv as it comes. The tangent is dP/du, made perpendicular to each vertex's normal and
    unit, and turned round where cross(N, T) points away from the bitangent, which is where the texture is
    mirrored: it is -dP/du there.
    Triangles without area, such as those at a sphere's pole, get NaN.
    """
    corners = flat.reshape(-1, 3, flat.shape[-1])
    edges = corners[:, 1:] - corners[:, :1]
    p1, p2 = edges[:, 0, None, _POSITION], edges[:, 1, None, _POSITION]
    (u1, v1), (u2, v2) = (np.split(edges[:, k, None, _TEXCOORD], 2, axis=-1) for k in (0, 1))
    normal = corners[..., _NORMAL]
    r = f32(1) / (u1 * v2 - v1 * u2)
    along_u, along_v = (p1 * v2 - p2 * v1) * r, (p2 * u1 - p1 * u2) * r
    tangent = _normalized(along_u - normal * _dot(normal, along_u))
    turned = _dot(np.cross(normal, tangent), along_v) < 0
    corners[..., _TANGENT] = np.where(turned, -tangent, tangent)
    corners[..., _BITANGENT] = along_v
    return flat
