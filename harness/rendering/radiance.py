"""Radiance pictures (.hdr) as SHADERed loads them: brought to 8 bits by clamping at 1 and a gamma of 1/2.2.

Format: G. Ward, "Real Pixels", Graphics Gems II, 1991: red, green, blue and a common exponent, in runs.
"""

from __future__ import annotations

import re

import numpy as np

MAGICS = (b"#?RADIANCE\n", b"#?RGBE\n")
_GAMMA = np.float64(np.float32(1) / np.float32(2.2))
#: scanlines of other widths are never in runs
_SHORTEST_RUNS, _LONGEST_RUNS = 8, 32767
#: header lines and their length; those of real files are a few
_HEADER_BYTES = 65536


class DamagedPictureError(ValueError):
    """The file is no Radiance picture that SHADERed reads."""


def size(data: bytes) -> tuple[int, int]:
    """Width and height by the header."""
    width, height, _ = _header(data)
    return width, height


def read(data: bytes) -> np.ndarray:
    """The pixels, (h, w, 4) uint8, top row first; alpha is 255."""
    width, height, start = _header(data)
    return to_bytes(_decode(data, start, width, height))


def to_bytes(rgbe: np.ndarray) -> np.ndarray:
    """(..., 4) bytes of mantissas and exponent as (..., 4) uint8 RGBA."""
    scale = np.ldexp(np.float32(1), rgbe[..., 3:].astype(np.int32) - 136).astype(np.float32)
    scale[rgbe[..., 3:] == 0] = 0
    linear = rgbe[..., :3].astype(np.float32) * scale
    encoded = (linear.astype(np.float64) ** _GAMMA).astype(np.float32) * np.float32(255) + np.float32(0.5)
    rgba = np.full(rgbe.shape, 255, np.uint8)
    rgba[..., :3] = np.clip(encoded, 0, 255).astype(np.uint8)
    return rgba


def _header(data: bytes) -> tuple[int, int, int]:
    head = data[:_HEADER_BYTES]
    end = head.find(b"\n\n")
    if not head.startswith(MAGICS) or end < 0 or b"\nFORMAT=32-bit_rle_rgbe" not in head[: end + 1]:
        raise DamagedPictureError("it is no Radiance picture of RGBE")
    line = re.compile(rb"-Y +(\d{1,9}) +\+X +(\d{1,9})[^\n]*\n").match(head, end + 2)
    if not line:
        raise DamagedPictureError("its rows are not from the top and from the left")
    return int(line[2]), int(line[1]), line.end()


def _decode(data: bytes, start: int, width: int, height: int) -> np.ndarray:
    runs = _SHORTEST_RUNS <= width <= _LONGEST_RUNS and re.compile(rb"\x02\x02[\x00-\x7f]").match(data, start)
    if not runs:
        flat = data[start : start + 4 * width * height]
        if len(flat) < 4 * width * height:
            raise DamagedPictureError("it ends too early")
        return np.frombuffer(flat, np.uint8).reshape(height, width, 4)
    rgbe = np.empty((height, 4, width), np.uint8)
    position = start
    for row in rgbe:
        if data[position : position + 4] != bytes((2, 2, width >> 8, width & 255)):
            raise DamagedPictureError("a row of it does not begin as it should")
        position = _decode_row(data, position + 4, row.reshape(-1), width)
    return rgbe.transpose(0, 2, 1)


def _decode_row(data: bytes, position: int, row: np.ndarray, width: int) -> int:
    """Fills ``row``, one channel after the other; gives the position after it."""
    for first in range(0, 4 * width, width):
        at, end = first, first + width
        while at < end:
            if position + 1 >= len(data):
                raise DamagedPictureError("it ends too early")
            count = data[position]
            is_run = count > 128
            count -= 128 * is_run
            values = data[position + 1 : position + 2] if is_run else data[position + 1 : position + 1 + count]
            if count == 0 or count > end - at or len(values) not in (1, count):
                raise DamagedPictureError("a run of it is too long")
            row[at : at + count] = np.frombuffer(values, np.uint8)
            position += 1 + len(values)
            at += count
    return position
