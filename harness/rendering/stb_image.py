"""Files that stb_image 2.22, by which SHADERed loads textures, reads otherwise than Pillow, or not at all.

PPM and PGM: binary ones of 8 bits alone, whose bytes are taken as they are whatever the largest value is said to be.
BMP: none in runs; of 32 bits without masks the fourth byte is alpha, unless it is 0 everywhere. TGA: colours of 16 bits
have no alpha. GIF: the first picture; what is transparent is black, and what it leaves free has the background colour.
"""

from __future__ import annotations

import re
import struct

import numpy as np
from PIL import Image

#: of Pillow's, those that it concerns
FORMATS = ("PPM", "BMP", "TGA", "GIF")

_PNM = re.compile(rb"P[56](?:\s|#[^\n\r]*[\n\r])+(\d+)(?:\s|#[^\n\r]*[\n\r])+(\d+)(?:\s|#[^\n\r]*[\n\r])+(\d+)\s")
_BMP_RAW, _BMP_RUNS = 0, (1, 2)
#: of which a BMP's header can be, and those of them that have no masks
_BMP_HEADERS, _BMP_PLAIN = (12, 40, 56, 108, 124), (40, 56)
_TGA_GRAYS = (3, 11)


class UnreadFileError(ValueError):
    """SHADERed does not read the file; the message says which of its properties it is."""


def rgba(image: Image.Image, data: bytes) -> np.ndarray | None:
    """(h, w, 4) uint8, top row first, of the file ``data`` that Pillow has opened as ``image``; None where the two
    read it alike. UnreadFileError where only Pillow reads it."""
    if image.format == "PPM":
        return _pnm(data)
    if image.format == "BMP":
        return _bmp(data)
    if image.format == "GIF":
        return _gif(image)
    if image.format == "TGA" and data[16] in (15, 16) and data[2] not in _TGA_GRAYS:
        return np.asarray(image.convert("RGB").convert("RGBA"))
    return None


def _pnm(data: bytes) -> np.ndarray:
    match = _PNM.match(data)
    if match is None or int(match[3]) > 255:
        raise UnreadFileError("SHADERed reads PPM and PGM in binary, of 8 bits, alone")
    width, height = int(match[1]), int(match[2])
    channels = 3 if data.startswith(b"P6") else 1
    pixels = np.frombuffer(data, np.uint8, width * height * channels, match.end())
    made = np.full((height, width, 4), 255, np.uint8)
    made[..., :3] = pixels.reshape(height, width, channels)
    return made


def _gif(image: Image.Image) -> np.ndarray:
    left, top, right, bottom = image.tile[0][1]
    background, palette = image.info.get("background", 0), image.global_palette
    made = np.array(image.convert("RGBA"))
    made[made[..., 3] == 0] = 0
    free = np.ones(made.shape[:2], bool)
    free[top:bottom, left:right] = False
    color = palette.palette[3 * background :][:3] if palette else b""
    made[free] = (*color.ljust(3, b"\0"), 255) if background > 0 else (0, 0, 0, 0)
    return made


def _bmp(data: bytes) -> np.ndarray | None:
    (start,) = struct.unpack_from("<I", data, 10)
    (header,) = struct.unpack_from("<I", data, 14)
    if header not in _BMP_HEADERS:
        raise UnreadFileError(f"its header has {header} bytes, which SHADERed does not read")
    if header == 12:
        return None
    width, height, _, bits, packing = struct.unpack_from("<iiHHI", data, 18)
    if packing in _BMP_RUNS:
        raise UnreadFileError("it is in runs, which SHADERed does not read")
    if header not in _BMP_PLAIN or (bits, packing) != (32, _BMP_RAW):
        return None
    rows = np.frombuffer(data, np.uint8, width * abs(height) * 4, start).reshape(abs(height), width, 4)
    made = rows[:: -1 if height > 0 else 1, :, [2, 1, 0, 3]].copy()
    if not made[..., 3].any():
        made[..., 3] = 255
    return made
