"""The pictures of a trade's page: errors over the hemisphere, and differences of two pictures, in false colour."""

from __future__ import annotations

import numpy as np

#: the ends of the scale of relative errors; what is smaller or larger has the colour of the end
SMALLEST, LARGEST = 1e-7, 1.0

# From dark to light, so that it reads without colours too.
_COLORS = np.array(
    [[13, 17, 48], [44, 51, 122], [36, 110, 140], [66, 166, 116], [177, 204, 80], [255, 238, 150]], float
)


def heat(errors: np.ndarray) -> np.ndarray:
    """Relative errors, (h, w), as (h, w, 4) uint8: dark to light over decades. NaN is transparent, infinity white."""
    outside, endless = np.isnan(errors), np.isinf(errors)
    bounded = np.clip(np.where(outside | endless, LARGEST, np.abs(errors)), SMALLEST, LARGEST)
    span = np.log10(LARGEST / SMALLEST)
    made = _colored(np.log10(bounded / SMALLEST) / span)
    made[endless] = 255
    made[outside] = 0
    return made


def amplification(picture: np.ndarray, reference: np.ndarray) -> int:
    """The power of two that brings the difference of two uint8 pictures near 255, in all but one in a hundred of the
    pixels that differ; 1 where none does."""
    off = _off(picture, reference)
    if not off.any():
        return 1
    most = int(np.percentile(off[off > 0], 99, method="higher"))
    return 1 << ((255 // most).bit_length() - 1)


def difference(picture: np.ndarray, reference: np.ndarray, factor: int) -> np.ndarray:
    """The largest difference of a channel of each pixel, times ``factor``, as (h, w, 4) uint8: dark is none."""
    return _colored(np.clip(_off(picture, reference) * factor, 0, 255) / 255)


def scale(width: int) -> np.ndarray:
    """All colours from left to right, (1, width, 4) uint8."""
    return _colored(np.linspace(0, 1, width)[None, :])


def _off(picture: np.ndarray, reference: np.ndarray) -> np.ndarray:
    return np.abs(picture[..., :3].astype(int) - reference[..., :3]).max(axis=-1)


def _colored(shares: np.ndarray) -> np.ndarray:
    """0...1 as colours, opaque."""
    ends = np.linspace(0, 1, len(_COLORS))
    channels = [np.interp(shares, ends, _COLORS[:, channel]) for channel in range(3)]
    return np.stack([*channels, np.full(shares.shape, 255.0)], axis=-1).round().astype(np.uint8)
