"""The difference of two pictures, amplified, in false colour."""

from __future__ import annotations

import numpy as np

#: what a difference is multiplied by: 1/64 of full white is the end of the scale
GAIN = 64.0
#: the scale: black none, then blue, green, yellow, red, and white for the end and beyond
_STOPS = np.array([[0, 0, 0], [0, 0, 255], [0, 255, 0], [255, 255, 0], [255, 0, 0], [255, 255, 255]], float)


def differences(shown: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """The largest absolute difference of red, green and blue of (h, w, 4) pictures as they are shown, clamped to
    0...1: (h, w). Where one alone is not a number it is 1."""
    both = [np.clip(p[..., :3].astype(np.float64), 0, 1) for p in (shown, reference)]
    lost = np.isnan(both[0]) != np.isnan(both[1])
    return np.where(lost, 1.0, np.nan_to_num(np.abs(both[0] - both[1]), nan=0.0)).max(axis=-1)


def false_color(difference: np.ndarray, gain: float = GAIN) -> np.ndarray:
    """(h, w) differences of 0...1 on the scale, after multiplication by ``gain``: (h, w, 4) uint8."""
    place = np.clip(difference * gain, 0, 1)
    ends = np.linspace(0, 1, len(_STOPS))
    channels = [np.interp(place, ends, _STOPS[:, k]) for k in range(3)]
    return np.stack([*channels, np.full_like(place, 255)], axis=-1).round().astype(np.uint8)
