"""Textures that Pillow reads in another way than SHADERed. Expected: the bytes of the files, by stb_image's rules."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from PIL import Image

from harness.rendering import textures

PIXELS = np.random.default_rng(5).integers(0, 256, (3, 2, 4), np.uint8)


def read(folder, name, data):
    (folder / name).write_bytes(data)
    return textures.read(folder / name, vflip=True)


def bmp(pixels, *, packing=0, top_down=False):
    """32 bits: blue, green, red, alpha, the bottom row first."""
    height, width, _ = pixels.shape
    body = pixels[:: 1 if top_down else -1, :, [2, 1, 0, 3]].tobytes()
    info = struct.pack("<IiiHHIIiiII", 40, width, -height if top_down else height, 1, 32, packing, 0, 0, 0, 0, 0)
    return struct.pack("<2sIHHI", b"BM", 54 + len(body), 0, 0, 54) + info + body


@pytest.mark.parametrize("top_down", [False, True])
def test_a_bmp_of_32_bits_has_alpha(tmp_path, top_down):
    np.testing.assert_array_equal(read(tmp_path, "t.bmp", bmp(PIXELS, top_down=top_down)), PIXELS)


def test_a_bmp_whose_alpha_is_0_everywhere_is_opaque(tmp_path):
    found = read(tmp_path, "t.bmp", bmp(PIXELS * np.array([1, 1, 1, 0], np.uint8)))
    np.testing.assert_array_equal(found[..., :3], PIXELS[..., :3])
    assert (found[..., 3] == 255).all()


def test_other_bmps_are_read_as_before(tmp_path):
    Image.fromarray(PIXELS[..., :3]).save(tmp_path / "t.bmp")
    np.testing.assert_array_equal(textures.read(tmp_path / "t.bmp", vflip=True)[..., :3], PIXELS[..., :3])


@pytest.mark.parametrize("attributes", [0, 1])
def test_a_tga_of_16_bits_has_no_alpha(tmp_path, attributes):
    """5 bits each of red, green and blue; the first bit is no alpha, whatever the header says."""
    head = struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 2, 1, 16, attributes)
    found = read(tmp_path, "t.tga", head + struct.pack("<HH", 0x7C1F, 0x8200))
    np.testing.assert_array_equal(found, [[[255, 0, 255, 255], [0, 16 * 255 // 31, 0, 255]]])


@pytest.mark.parametrize(("kind", "channels"), [("P5", 1), ("P6", 3)])
@pytest.mark.parametrize("most", [255, 100])
def test_the_bytes_of_a_ppm_are_taken_as_they_are(tmp_path, kind, channels, most):
    values = np.minimum(PIXELS[..., :channels], most)
    found = read(tmp_path, "t.ppm", f"{kind} 2 # two\n3\n{most}\n".encode() + values.tobytes())
    np.testing.assert_array_equal(found[..., :3], np.broadcast_to(values, (3, 2, 3)))
    assert (found[..., 3] == 255).all()


def gif(background):
    """4 x 1 pixels, of which the first two are drawn: colour 1, and colour 2, which is transparent."""
    colors = bytes((10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120))
    screen = b"GIF89a" + struct.pack("<HHBBB", 4, 1, 0x81, background, 0) + colors
    control = bytes((0x21, 0xF9, 4, 1, 0, 0, 2, 0))
    # Codes of 3 bits, the lowest first: clear, 1, 2, end.
    codes = 4 | 1 << 3 | 2 << 6 | 5 << 9
    return (
        screen
        + control
        + b","
        + struct.pack("<HHHHB", 0, 0, 2, 1, 0)
        + bytes((2, 2, codes & 255, codes >> 8, 0))
        + b";"
    )


@pytest.mark.parametrize(("background", "color"), [(0, [0, 0, 0, 0]), (3, [100, 110, 120, 255])])
def test_what_a_gif_leaves_free_and_what_is_transparent(tmp_path, background, color):
    found = read(tmp_path, "t.gif", gif(background))
    np.testing.assert_array_equal(found, [[[40, 50, 60, 255], [0, 0, 0, 0], color, color]])


def runs():
    """A BMP of 2 x 1 pixels of 8 bits in runs."""
    body = bytes((2, 1, 0, 1))
    info = struct.pack("<IiiHHIIiiII", 40, 2, 1, 1, 8, 1, len(body), 0, 0, 2, 0) + bytes(8)
    return struct.pack("<2sIHHI", b"BM", 14 + len(info) + len(body), 0, 0, 14 + len(info)) + info + body


@pytest.mark.parametrize(
    ("name", "data", "said"),
    [
        ("t.ppm", b"P3 1 1 255 1 2 3\n", "binary, of 8 bits"),
        ("t.pbm", b"P4 8 1\n\xaa", "binary, of 8 bits"),
        ("t.ppm", b"P6 1 1 65535\n123456", "binary, of 8 bits"),
        ("t.bmp", runs(), "in runs"),
        ("t.bmp", bmp(PIXELS)[:14] + struct.pack("<I", 64) + bmp(PIXELS)[18:], "header has 64 bytes"),
        ("t.ppm", b"P6 2 2 255\n123456", "damaged"),
        ("t.bmp", bmp(PIXELS)[:-1], "damaged"),
    ],
    ids=["text", "bits", "16 bits", "runs", "header", "short ppm", "short bmp"],
)
def test_what_shadered_does_not_read_is_refused(tmp_path, name, data, said):
    with pytest.raises(textures.TextureError, match=said):
        read(tmp_path, name, data)
