"""Radiance pictures: bytes by the formula of the format and of the tone curve."""

from __future__ import annotations

import numpy as np
import pytest

from harness.rendering import radiance, textures

HEAD = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"


def picture(width: int, height: int, body: bytes) -> bytes:
    return HEAD + f"-Y {height} +X {width}\n".encode() + body


@pytest.mark.parametrize(
    "rgbe, linear",
    # m * 2^(e - 136)
    [((128, 64, 32, 129), (1, 0.5, 0.25)), ((255, 1, 0, 136), (255, 1, 0)), ((200, 100, 50, 0), (0, 0, 0))],
)
def test_the_tone_curve(rgbe, linear):
    expected = np.floor(255 * np.clip(np.array(linear), 0, 1) ** (1 / 2.2) + 0.5)
    found = radiance.read(picture(1, 1, bytes(rgbe)))
    np.testing.assert_array_equal(found[0, 0], (*expected, 255))


def test_runs_and_flat_rows_are_alike():
    rng = np.random.default_rng(1)
    pixels = rng.integers(100, 140, (3, 9, 4), np.uint8)
    pixels[0, :, 1] = 120  # a run
    flat = picture(9, 3, pixels.tobytes())
    body = b""
    for row in pixels:
        body += bytes((2, 2, 0, 9))
        for channel in row.T:
            if len(set(channel)) == 1:
                body += bytes((128 + 9, channel[0]))
            else:
                body += bytes((4,)) + channel[:4].tobytes() + bytes((5,)) + channel[4:].tobytes()
    np.testing.assert_array_equal(radiance.read(picture(9, 3, body)), radiance.read(flat))
    assert radiance.size(flat) == (9, 3)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"#?RADIANCE\n\n",
        HEAD,
        HEAD + b"+Y 1 +X 1\n\0\0\0\0",
        picture(2, 2, b"\0" * 15),
        picture(9, 1, bytes((2, 2))),
        picture(9, 1, bytes((2, 2, 0, 9, 128 + 10, 1))),
        picture(9, 1, bytes((2, 2, 0, 9, 0, 1))),
        picture(9, 1, bytes((2, 2, 0, 9, 9, 1, 2, 3))),
        picture(9, 2, bytes((2, 2, 0, 9)) + bytes((137, 1)) * 4 + bytes((2, 2, 0, 8))),
        picture(9, 1, bytes((2, 2, 0, 9)) + bytes((137, 1)) * 3),
    ],
)
def test_damaged_pictures(data):
    with pytest.raises(radiance.DamagedPictureError):
        radiance.read(data)


def test_as_a_texture(tmp_path):
    path = tmp_path / "t.png"  # by its content, whatever its name
    path.write_bytes(picture(1, 2, bytes((128, 0, 0, 129, 0, 128, 0, 129))))
    assert textures.size(path) == (1, 2)
    np.testing.assert_array_equal(textures.read(path)[:, 0], [(0, 255, 0, 255), (255, 0, 0, 255)])


def test_a_header_bomb(tmp_path):
    path = tmp_path / "t.hdr"
    path.write_bytes(picture(16000, 100000000, b""))
    with pytest.raises(textures.TextureError, match="not 1 to 16384 a side"):
        textures.read(path)
