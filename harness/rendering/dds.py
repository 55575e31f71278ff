"""DirectDraw surfaces (.dds) as SHADERed's own loader reads them, its slips included.

It unpacks colours of 5 and 6 bits by shifting, leaves alpha of DXT3 at 0...15, takes the colour's code for alpha's in
DXT5, and knows no mipmaps. What it writes beyond its memory is refused here.
"""

from __future__ import annotations

import struct

import numpy as np

_HEADER = struct.Struct("<4s7I44x8I5I")
_FLAGS_NEEDED, _TEXTURE, _FOURCC = 0x1007, 0x1000, 0x4
_DXT1, _DXT3, _DXT5 = (b"DXT1",), (b"DXT2", b"DXT3"), (b"DXT4", b"DXT5")
_UNKNOWN = (b"DX10", b"ATI1", b"ATI2", b"A2XY")


class DamagedSurfaceError(ValueError):
    """The file is no surface that SHADERed reads."""


def size(data: bytes) -> tuple[int, int, int]:
    """Width, height and depth by the header."""
    width, height, depth, *_ = _header(data)
    return width, height, depth


def read(data: bytes) -> np.ndarray:
    """The pixels, (depth, h, w, 4) uint8, bottom row first."""
    width, height, depth, code, bits, masks = _header(data)
    if code in _UNKNOWN:
        raise DamagedSurfaceError(f"of the kind {code.decode()} SHADERed shows whatever is in memory")
    if code in _DXT1 + _DXT3 + _DXT5:
        if width % 4 or height % 4 or (depth > 1 and code not in _DXT5):
            raise DamagedSurfaceError(
                "compressed, its sides are no multiples of 4, or it has a depth: SHADERed crashes"
            )
        pixels = _blocks(data, width, height, depth, code)
    else:
        pixels = _plain(data, width, height, depth, bits // 8, masks)
    return np.ascontiguousarray(pixels[:, ::-1])


def _header(data: bytes) -> tuple[int, int, int, bytes | None, int, tuple[int, ...]]:
    if len(data) < _HEADER.size:
        raise DamagedSurfaceError("it ends too early")
    fields = _HEADER.unpack_from(data)
    magic, length, flags, height, width, _, depth, _, _, format_flags, code, bits, *masks, caps, _, _, _, _ = fields
    if magic != b"DDS " or length != 124 or flags & _FLAGS_NEEDED != _FLAGS_NEEDED or not caps & _TEXTURE:
        raise DamagedSurfaceError("it is no DDS texture")
    four = struct.pack("<I", code) if format_flags & _FOURCC else None
    return max(width, 1), max(height, 1), max(depth, 1), four, bits, tuple(masks)


def _plain(
    data: bytes, width: int, height: int, depth: int, bytes_per_pixel: int, masks: tuple[int, ...]
) -> np.ndarray:
    count = width * height * depth
    body = np.frombuffer(data, np.uint8, offset=_HEADER.size)
    if not 1 <= bytes_per_pixel <= 4 or body.size < count * bytes_per_pixel:
        raise DamagedSurfaceError("it ends too early, or its pixels have no 8 to 32 bits")
    body = body[: count * bytes_per_pixel].reshape(count, bytes_per_pixel)
    words = np.zeros((count, 4), np.uint8)
    words[:, :bytes_per_pixel] = body
    numbers = words.view("<u4")[:, 0]
    channels = []
    for k, mask in enumerate(masks):
        if k == 3 and mask == 0:
            channels.append(np.full(count, 255, np.uint8))
            continue
        lowest = (mask & -mask).bit_length() - 1 if mask else 0
        # Fewer than 8 bits are shifted up, more are cut off at the top.
        up = max(8 - mask.bit_count(), 0)
        channels.append((((numbers & mask) >> lowest) << up).astype(np.uint8))
    return np.stack(channels, axis=-1).reshape(depth, height, width, 4)


def _blocks(data: bytes, width: int, height: int, depth: int, code: bytes) -> np.ndarray:
    across, down = width // 4, height // 4
    length = 8 if code in _DXT1 else 16
    count = across * down * depth
    body = np.frombuffer(data, np.uint8, offset=_HEADER.size)
    if body.size < count * length:
        raise DamagedSurfaceError("it ends too early")
    blocks = np.ascontiguousarray(body[: count * length].reshape(count, length))
    pixels = _colors(np.ascontiguousarray(blocks[:, -8:]), has_black=code in _DXT1)
    if code in _DXT3:
        nibbles = np.stack([blocks[:, :8] & 15, blocks[:, :8] >> 4], axis=-1).reshape(count, 16)
        pixels[..., 3] = nibbles
    elif code in _DXT5:
        pixels[..., 3] = _alphas(blocks)
    tiles = pixels.reshape(depth, down, across, 4, 4, 4)
    return tiles.transpose(0, 1, 3, 2, 4, 5).reshape(depth, height, width, 4)


def _codes(blocks: np.ndarray) -> np.ndarray:
    """The 16 codes of 2 bits in the last 4 bytes of blocks (n, 8)."""
    codes = np.ascontiguousarray(blocks[:, -4:]).view("<u4")
    return (codes >> (2 * np.arange(16, dtype=np.uint32))) & 3


def _colors(blocks: np.ndarray, *, has_black: bool) -> np.ndarray:
    """(n, 16, 4) uint8 of the colour halves of blocks (n, 8)."""
    ends = blocks[:, :4].copy().view("<u2")
    rgb = np.stack([(ends & 0xF800) >> 8, (ends & 0x7E0) >> 3, (ends & 0x1F) << 3], axis=-1).astype(np.int32)
    first, second = rgb[:, 0], rgb[:, 1]
    four = ((ends[:, 0] > ends[:, 1]) | (not has_black))[:, None]
    third = np.where(four, (2 * first + second) // 3, (first + second) // 2)
    fourth = np.where(four, (first + 2 * second) // 3, 0)
    table = np.stack([first, second, third, fourth], axis=1)
    pixels = np.full((len(blocks), 16, 4), 255, np.uint8)
    pixels[..., :3] = np.take_along_axis(table, _codes(blocks)[..., None].astype(np.int64), axis=1)
    return pixels


def _alphas(blocks: np.ndarray) -> np.ndarray:
    """(n, 16) of DXT5 blocks (n, 16). Codes 0 and 1 are the colour's, which is SHADERed's slip."""
    first, second = blocks[:, 0:1].astype(np.int32), blocks[:, 1:2].astype(np.int32)
    packed = np.zeros((len(blocks), 8), np.uint8)
    packed[:, :6] = blocks[:, 2:8]
    code = ((packed.view("<u8") >> (3 * np.arange(16, dtype=np.uint64))) & 7).astype(np.int32)
    six = ((8 - code) * first + (code - 1) * second) // 7
    # C divides towards 0.
    four = np.trunc(((6 - code) * first + (code - 1) * second) / 5).astype(np.int32)
    four = np.where(code == 6, 0, np.where(code == 7, 255, four))
    between = np.where(first > second, six, four)
    color = _codes(blocks)
    return np.where(color == 0, first, np.where(color == 1, second, between)).astype(np.uint8)
