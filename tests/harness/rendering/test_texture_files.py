"""Texture files as pixels. Expected values are those that SHADERed uploads."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from harness.rendering import textures

TWO_ROWS = np.array([[[10, 20, 30, 40]], [[50, 60, 70, 80]]], np.uint8)


def saved(folder, image: Image.Image, name: str = "t.png", **options):
    path = folder / name
    image.save(path, **options)
    return path


def png(width: int, height: int, data: bytes = b"") -> bytes:
    """A PNG of 8-bit RGBA with that header and that compressed data."""
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)),
        (b"IDAT", data),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in chunks
    )


def test_row_0_is_the_bottom_of_the_image(tmp_path):
    np.testing.assert_array_equal(textures.read(saved(tmp_path, Image.fromarray(TWO_ROWS))), TWO_ROWS[::-1])


def test_with_vflip_row_0_is_the_top(tmp_path):
    path = saved(tmp_path, Image.fromarray(TWO_ROWS))
    np.testing.assert_array_equal(textures.read(path, vflip=True), TWO_ROWS)


def test_gray_fills_the_colours(tmp_path):
    path = saved(tmp_path, Image.new("L", (1, 1), 77))
    np.testing.assert_array_equal(textures.read(path), [[[77, 77, 77, 255]]])


def test_gray_with_alpha_keeps_it(tmp_path):
    path = saved(tmp_path, Image.new("LA", (1, 1), (77, 9)))
    np.testing.assert_array_equal(textures.read(path), [[[77, 77, 77, 9]]])


def test_rgb_is_opaque(tmp_path):
    path = saved(tmp_path, Image.new("RGB", (1, 1), (1, 2, 3)))
    np.testing.assert_array_equal(textures.read(path), [[[1, 2, 3, 255]]])


def test_one_bit_is_black_and_white(tmp_path):
    path = saved(tmp_path, Image.new("1", (1, 1), 1))
    np.testing.assert_array_equal(textures.read(path), [[[255, 255, 255, 255]]])


def test_a_palette_keeps_its_transparent_entry(tmp_path):
    image = Image.new("P", (2, 1))
    image.putpalette([5, 6, 7, 8, 9, 10])
    image.putpixel((1, 0), 1)
    path = saved(tmp_path, image, transparency=1)
    np.testing.assert_array_equal(textures.read(path), [[[5, 6, 7, 255], [8, 9, 10, 0]]])


def test_of_16_bits_the_upper_byte_stays(tmp_path):
    path = saved(tmp_path, Image.fromarray(np.array([[0x12FF, 0x8000]], np.uint16)))
    np.testing.assert_array_equal(textures.read(path)[0, :, 0], [0x12, 0x80])


@pytest.mark.parametrize("name", ["t.bmp", "t.tga"])
def test_other_formats(tmp_path, name):
    path = saved(tmp_path, Image.new("RGB", (1, 1), (1, 2, 3)), name)
    np.testing.assert_array_equal(textures.read(path), [[[1, 2, 3, 255]]])


def refusal(path) -> str:
    with pytest.raises(textures.TextureError) as caught:
        textures.read(path)
    return caught.value.message


def test_a_missing_file(tmp_path):
    assert refusal(tmp_path / "gone.png") == "there is no such file"


def test_a_folder_is_no_file(tmp_path):
    assert refusal(tmp_path) == "there is no such file"


def test_a_file_that_is_no_image(tmp_path):
    path = tmp_path / "t.png"
    path.write_text("not an image")
    assert "damaged or of a kind that is not supported" in refusal(path)


def test_a_format_that_shadered_does_not_read(tmp_path):
    assert "not supported" in refusal(saved(tmp_path, Image.new("RGB", (1, 1)), "t.tiff"))


@pytest.mark.parametrize("name", ["t.gif", "t.ppm", "t.bmp", "t.tga"])
def test_formats_that_keep_every_byte(tmp_path, name):
    path = saved(tmp_path, Image.new("RGB", (1, 1), (255, 0, 51)), name)
    np.testing.assert_array_equal(textures.read(path), [[[255, 0, 51, 255]]])


def test_a_face_is_not_turned_over(tmp_path):
    path = saved(tmp_path, Image.fromarray(TWO_ROWS))
    np.testing.assert_array_equal(textures.read_face(path), TWO_ROWS)


def test_a_face_of_gray_with_alpha_is_left_to_chance(tmp_path):
    path = saved(tmp_path, Image.new("LA", (1, 1)))
    with pytest.raises(textures.TextureError, match="whatever is in memory"):
        textures.read_face(path)


def test_a_truncated_file(tmp_path):
    path = saved(tmp_path, Image.fromarray(np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)))
    path.write_bytes(path.read_bytes()[:5000])
    assert refusal(path).startswith("the file is damaged (")


@pytest.mark.parametrize("width, height", [(60000, 60000), (16385, 1), (1, 16385), (2**31 - 1, 2**31 - 1)])
def test_a_size_beyond_the_limit_is_refused_from_the_header(tmp_path, width, height):
    path = tmp_path / "t.png"
    path.write_bytes(png(width, height, zlib.compress(b"")))
    assert "pixels" in refusal(path)
