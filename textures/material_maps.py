"""A material as arrays, and its encoding into the bytes of texture maps.

The conventions are those of ambientCG (https://ambientcg.com): base colour is stored in sRGB, all else
linearly; row 0 is the picture's top; the GL normal map has green pointing up the picture, the DX one down.
"""

from dataclasses import dataclass

import numpy as np

SIZE = 1024  # rows and columns of every map; lengths in the materials are in texels of this size

# A normal's component n is the byte 127 n + 128, so that n = (byte - 128) / 127. Unlike the usual 127.5 n +
# 127.5, zero is a byte of its own, 128: flat is exactly (128, 128, 255), and mirroring a component about it
# (256 - byte) is exact.
NORMAL_SCALE = 127
NORMAL_ZERO = 128


def srgb_to_linear(encoded):
    """Decode one sRGB component, a float in [0, 1] (IEC 61966-2-1, with its limit 0.04045)."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


def linear_rgb(red, green, blue):
    """The linear colour, shape (3,), of sRGB bytes as a colour picker shows them."""
    return np.array([srgb_to_linear(byte / 255) for byte in (red, green, blue)])


# Linear values at which the nearest sRGB byte changes. Looking bytes up between these limits rounds exactly,
# and takes 255 powers from Python's own math instead of millions from numpy's, whose last bit differs between
# builds.
_BYTE_LIMITS = np.array([srgb_to_linear((byte + 0.5) / 255) for byte in range(255)])


@dataclass(frozen=True)
class MaterialMaps:
    """A material before quantisation; all pictures have the same rows and columns and tile.

    base_color: (rows, columns, 3) linear, in [0, 1]; albedo of a dielectric, reflectance at normal incidence
    of a metal.
    roughness: (rows, columns), perceptual roughness in [0, 1].
    metalness: (rows, columns) in [0, 1], or None for a material without metal.
    height: (rows, columns) in texels, away from the surface: a slope of 1 is 45 degrees.
    """

    base_color: np.ndarray
    roughness: np.ndarray
    metalness: np.ndarray | None
    height: np.ndarray


def unit_bytes(values):
    """Round values of [0, 1] to bytes; values outside are clamped."""
    return np.floor(np.clip(values, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def srgb_bytes(linear):
    """Encode linear values of [0, 1] as sRGB bytes, rounded to the nearest; values outside are clamped."""
    return np.searchsorted(_BYTE_LIMITS, linear, side="right").astype(np.uint8)


def normals(height):
    """Unit normals, shape (rows, columns, 3), of a tiling height field in texels.

    x points to the right, y up the picture and z out of it. Central differences over two texels, round the
    border.
    """
    slope_right = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) * 0.5
    slope_up = (np.roll(height, 1, axis=0) - np.roll(height, -1, axis=0)) * 0.5
    length = np.sqrt(slope_right * slope_right + slope_up * slope_up + 1.0)
    return np.stack([-slope_right / length, -slope_up / length, 1.0 / length], axis=-1)


def normal_bytes(unit_normals):
    """Encode normals with y up as the bytes of a GL normal map, 1 to 255."""
    return (np.floor(unit_normals * NORMAL_SCALE + 0.5) + NORMAL_ZERO).astype(np.uint8)


def green_mirrored(gl_bytes):
    """The DX normal map of a GL one, or the other way round: y has the opposite sign, exactly."""
    dx_bytes = gl_bytes.copy()
    dx_bytes[..., 1] = 2 * NORMAL_ZERO - gl_bytes[..., 1].astype(np.int64)
    return dx_bytes


def encode(maps):
    """The maps by the ends of ambientCG's file names: uint8, (rows, columns) gray or (rows, columns, 3)."""
    normal_gl = normal_bytes(normals(maps.height))
    pictures = {"Color": srgb_bytes(maps.base_color), "Roughness": unit_bytes(maps.roughness)}
    if maps.metalness is not None:
        pictures["Metalness"] = unit_bytes(maps.metalness)
    return pictures | {"NormalGL": normal_gl, "NormalDX": green_mirrored(normal_gl)}
