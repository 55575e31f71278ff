"""DirectDraw surfaces as SHADERed's loader reads them: texels worked out by hand from its rules."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from harness.rendering import dds, textures

RGBA = (0xFF, 0xFF00, 0xFF0000, 0xFF000000)


def surface(width: int, height: int, body: bytes, *, depth=0, code=b"", bits=32, masks=RGBA, flags=0x1007) -> bytes:
    kind = 4 if code else 0x41
    fourcc = struct.unpack("<I", code)[0] if code else 0
    fields = (124, flags, height, width, 0, depth, 0, 32, kind, fourcc, bits, *masks, 0x1000, 0, 0, 0, 0)
    return b"DDS " + struct.pack("<7I44x8I5I", *fields) + body


def test_the_bottom_row_comes_first():
    found = dds.read(surface(1, 2, bytes((1, 2, 3, 4, 5, 6, 7, 8))))
    np.testing.assert_array_equal(found, [[[(5, 6, 7, 8)], [(1, 2, 3, 4)]]])


@pytest.mark.parametrize(
    "bits, masks, pixel, expected",
    [
        # Fewer than 8 bits are shifted up and not spread: white is 248, 252, 248.
        (16, (0xF800, 0x7E0, 0x1F, 0), 0xFFFF, (248, 252, 248, 255)),
        (24, (0xFF0000, 0xFF00, 0xFF, 0), 0x112233, (0x11, 0x22, 0x33, 255)),
        (8, (0xFF, 0, 0, 0), 0x7F, (0x7F, 0, 0, 255)),
        # Of ten bits the upper two are lost.
        (32, (0x3FF, 0xFFC00, 0x3FF00000, 0xC0000000), 0x3FF | 1 << 10 | 3 << 30, (0xFF, 1, 0, 0xC0)),
    ],
)
def test_masks(bits, masks, pixel, expected):
    body = pixel.to_bytes(bits // 8, "little")
    np.testing.assert_array_equal(dds.read(surface(1, 1, body, bits=bits, masks=masks))[0, 0, 0], expected)


def block(first: int, second: int, codes: list[int]) -> bytes:
    packed = sum(code << (2 * k) for k, code in enumerate(codes))
    return struct.pack("<HHI", first, second, packed)


RED, BLUE = 0xF800, 0x001F
CODES = [0, 1, 2, 3] + [0] * 12


def test_dxt1():
    top = dds.read(surface(4, 4, block(RED, BLUE, CODES), code=b"DXT1"))[0, 3]
    # (2 * 248 + 0) / 3 = 165 and 248 / 3 = 82, cut off.
    np.testing.assert_array_equal(top, [(248, 0, 0, 255), (0, 0, 248, 255), (165, 0, 82, 255), (82, 0, 165, 255)])
    other = dds.read(surface(4, 4, block(BLUE, RED, CODES), code=b"DXT1"))[0, 3]
    # The smaller first: the mean, and black that is opaque.
    np.testing.assert_array_equal(other, [(0, 0, 248, 255), (248, 0, 0, 255), (124, 0, 124, 255), (0, 0, 0, 255)])


def test_blocks_go_to_the_right_and_down():
    bodies = [block(value, value, [0] * 16) for value in (1, 2, 3, 4)]
    found = dds.read(surface(8, 8, b"".join(bodies), code=b"DXT1"))[0, :, :, 2] // 8
    np.testing.assert_array_equal(found[::-1][[0, 0, 7, 7], [0, 7, 0, 7]], (1, 2, 3, 4))


def test_the_alpha_of_dxt3_is_not_spread():
    body = bytes(range(0x10, 0x90, 0x10)) + block(RED, BLUE, CODES)
    top = dds.read(surface(4, 4, body, code=b"DXT3"))[0, 3]
    # Nibbles, the lower first: 0, 1, 0, 2.
    np.testing.assert_array_equal(top[:, 3], (0, 1, 0, 2))


@pytest.mark.parametrize(
    "first, second, alpha_code, color, expected",
    [
        (200, 100, 5, 0, 200),  # the colour's code 0 and 1 take the ends
        (200, 100, 5, 1, 100),
        (200, 100, 5, 2, (3 * 200 + 4 * 100) // 7),
        (100, 200, 5, 2, (100 + 4 * 200) // 5),
        (100, 200, 6, 2, 0),
        (100, 200, 7, 2, 255),
        (255, 0, 0, 2, (8 * 255) // 7 % 256),  # too much for a byte
    ],
)
def test_the_alpha_of_dxt5(first, second, alpha_code, color, expected):
    body = bytes((first, second)) + alpha_code.to_bytes(6, "little") + block(RED, BLUE, [color] + [0] * 15)
    assert dds.read(surface(4, 4, body, code=b"DXT5"))[0, 3, 0, 3] == expected


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"DDS " + b"\0" * 124,
        surface(1, 1, b""),
        surface(1, 1, b"\0" * 4, flags=0),
        surface(1, 1, b"\0" * 8, bits=64),
        surface(1, 1, b"", bits=0),
        surface(6, 4, b"\0" * 64, code=b"DXT1"),
        surface(4, 4, b"\0" * 64, code=b"DXT1", depth=2),
        surface(4, 4, b"\0" * 7, code=b"DXT1"),
        surface(4, 4, b"\0" * 64, code=b"DX10"),
    ],
)
def test_surfaces_that_shadered_does_not_read(data):
    with pytest.raises(dds.DamagedSurfaceError):
        dds.read(data)


def test_as_a_texture(tmp_path):
    path = tmp_path / "t.dds"
    path.write_bytes(surface(1, 2, bytes((1, 2, 3, 4, 5, 6, 7, 8))))
    assert textures.size(path) == (1, 2, 1)
    np.testing.assert_array_equal(textures.read(path)[:, 0], [(5, 6, 7, 8), (1, 2, 3, 4)])
    np.testing.assert_array_equal(textures.read(path, vflip=True)[:, 0], [(1, 2, 3, 4), (5, 6, 7, 8)])
    assert textures.read(path, volume=True).shape == (1, 2, 1, 4)


def test_a_surface_by_another_name_is_none(tmp_path):
    path = tmp_path / "t.png"
    path.write_bytes(surface(1, 1, b"\0" * 4))
    with pytest.raises(textures.TextureError, match="damaged or of a kind"):
        textures.read(path)
