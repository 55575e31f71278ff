"""Functions of one float in float64, each from its published formula: what the exhaustive tests hold the shaders to."""

from __future__ import annotations

import numpy as np


def srgb_decode(c: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1: stored sRGB to linear."""
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def srgb_encode(c: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1: linear to stored sRGB."""
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)


def power_decode(c: np.ndarray) -> np.ndarray:
    """The exercise's approximation of the decoding."""
    return c**2.2


def cubic_decode(c: np.ndarray) -> np.ndarray:
    """The polynomial, by the coefficients in the comment of srgb_to_linear."""
    return 0.305306011 * c**3 + 0.682171111 * c**2 + 0.012522878 * c


def schlick_weight(LoH: np.ndarray) -> np.ndarray:
    """(1 - cos)^5, Schlick 1994, eq. 15."""
    return (1 - LoH) ** 5
