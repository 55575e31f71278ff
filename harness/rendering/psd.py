"""Photoshop pictures (.psd) as SHADERed loads them: the merged picture of an RGB document, 8 bits a channel.

Format: Adobe Photoshop File Formats Specification. As in SHADERed's reader only documents in RGB are read, of 16 bits
the upper 8 count, and colour is freed of the white that Photoshop mixes into it where alpha is neither 0 nor 255.
"""

from __future__ import annotations

import struct

import numpy as np

MAGIC = b"8BPS"
_HEADER = struct.Struct(">4sH6xHIIHH")
_RGB = 3
_RAW, _RUNS = 0, 1
_MOST_CHANNELS = 16


class DamagedDocumentError(ValueError):
    """The file is no Photoshop document that SHADERed reads."""


def size(data: bytes) -> tuple[int, int]:
    """Width and height by the header."""
    _, height, width, _ = _header(data)
    return width, height


def read(data: bytes) -> np.ndarray:
    """The pixels, (h, w, 4) uint8, top row first; alpha is 255 where the document has none."""
    channels, height, width, depth = _header(data)
    at = _HEADER.size
    for _ in range(3):  # colours, resources, layers: each begins with its length
        at += 4 + _number(data, at, ">I")
    packing = _number(data, at, ">H")
    at += 2
    wanted = min(channels, 4)
    if packing == _RAW:
        step = depth // 8
        planes = np.frombuffer(_slice(data, at, wanted * height * width * step), np.uint8)
        planes = planes.reshape(wanted, height, width, step)[..., 0]
    elif packing == _RUNS and depth == 8:
        at += 2 * channels * height  # the lengths of the rows, which their runs tell too
        planes = _unpacked(data, at, wanted * height * width).reshape(wanted, height, width)
    elif packing == _RUNS:
        raise DamagedDocumentError("16 bits in runs, which SHADERed reads as if they were 8")
    else:
        raise DamagedDocumentError(f"its pixels are packed in the way {packing}, which SHADERed does not read")
    rgba = np.zeros((height, width, 4), np.uint8)
    rgba[..., 3] = 255
    rgba[..., :wanted] = np.moveaxis(planes, 0, -1)
    if channels >= 4:
        _unmix(rgba)
    return rgba


def _header(data: bytes) -> tuple[int, int, int, int]:
    """Channels, height, width, bits."""
    if len(data) < _HEADER.size:
        raise DamagedDocumentError("its header is cut off")
    magic, version, channels, height, width, depth, mode = _HEADER.unpack_from(data)
    if magic != MAGIC or version != 1:
        raise DamagedDocumentError(f"a document of version {version}, which SHADERed does not read")
    if mode != _RGB or depth not in (8, 16) or channels > _MOST_CHANNELS:
        raise DamagedDocumentError(
            f"{channels} channels of {depth} bits in colour mode {mode}; SHADERed reads RGB (mode 3) of 8 or 16 bits"
        )
    return channels, height, width, depth


def _slice(data: bytes, start: int, count: int) -> bytes:
    if start + count > len(data):
        raise DamagedDocumentError("its pixels are cut off")
    return data[start : start + count]


def _number(data: bytes, at: int, kind: str) -> int:
    return struct.unpack(kind, _slice(data, at, struct.calcsize(kind)))[0]


def _unpacked(data: bytes, at: int, count: int) -> np.ndarray:
    """PackBits: a byte n below 128 says that n + 1 bytes follow, one above that the next stands 257 - n times."""
    out = bytearray()
    while len(out) < count:
        n = _slice(data, at, 1)[0]
        at += 1
        if n < 128:
            out += _slice(data, at, n + 1)
            at += n + 1
        elif n > 128:
            out += _slice(data, at, 1) * (257 - n)
            at += 1
    if len(out) > count:
        raise DamagedDocumentError("its runs are longer than its rows")
    return np.frombuffer(bytes(out), np.uint8)


def _unmix(rgba: np.ndarray) -> None:
    """c = c' a + 255 (1 - a), solved for c' in single precision; what is no byte wraps around, as in SHADERed."""
    mixed = (rgba[..., 3] != 0) & (rgba[..., 3] != 255)
    pixels = rgba[mixed].astype(np.float32)
    inverse = np.float32(1) / (pixels[:, 3:] / np.float32(255))
    color = pixels[:, :3] * inverse + np.float32(255) * (np.float32(1) - inverse)
    rgba[mixed, :3] = color.astype(np.int32).astype(np.uint8)
