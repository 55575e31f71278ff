"""Photoshop documents: the bytes that went in, and Pillow as another reader of the same files."""

from __future__ import annotations

import io
import struct

import numpy as np
import pytest
from PIL import Image

from harness.rendering import psd, textures

PLANES = np.random.default_rng(3).integers(0, 256, (5, 3, 7), np.uint8)


def document(planes, *, depth=8, packed=False, mode=3, version=1, sections=(b"", b"", b"")):
    """A document with these channels, (n, h, w)."""
    n, height, width = planes.shape
    head = struct.pack(">4sH6xHIIHH", b"8BPS", version, n, height, width, depth, mode)
    head += b"".join(struct.pack(">I", len(s)) + s for s in sections)
    if packed:
        rows = [pack(row) for plane in planes for row in plane]
        return head + struct.pack(f">H{len(rows)}H", 1, *map(len, rows)) + b"".join(rows)
    return head + b"\0\0" + planes.astype(">u2" if depth == 16 else "u1").tobytes()


def pack(row):
    """PackBits with runs for all that repeats, a no-op between."""
    out, k = b"", 0
    while k < len(row):
        n = next((j for j in range(k, len(row)) if row[j] != row[k]), len(row)) - k
        out += bytes((257 - n, row[k])) if n > 1 else bytes((0, row[k], 128))
        k += n
    return out


@pytest.mark.parametrize("packed", [False, True])
def test_rgb_as_pillow_reads_it(packed):
    planes = PLANES[:3].copy()
    planes[1, :, 2:5] = 9
    data = document(planes, packed=packed)
    assert psd.size(data) == (7, 3)
    found = psd.read(data)
    np.testing.assert_array_equal(found[..., :3], np.asarray(Image.open(io.BytesIO(data)).convert("RGB")))
    assert (found[..., 3] == 255).all()


def test_of_16_bits_the_upper_8_count():
    found = psd.read(document(PLANES[:3].astype(np.uint16) * 256 + 200, depth=16))
    np.testing.assert_array_equal(found[..., :3], np.moveaxis(PLANES[:3], 0, -1))


def test_colours_resources_and_layers_are_passed_over():
    data = document(PLANES[:3], sections=(b"one", b"three", b"four more"))
    np.testing.assert_array_equal(psd.read(data), psd.read(document(PLANES[:3])))


def test_missing_channels_are_0_and_opaque():
    found = psd.read(document(PLANES[:2]))
    assert (found[..., 2] == 0).all() and (found[..., 3] == 255).all()


def test_white_is_taken_out_where_alpha_is_between():
    """Half of (200, 100, 40) over white is stored; nothing is done where alpha is 0 or 255."""
    color, alpha = np.array([200.0, 100.0, 40.0]), 128
    stored = np.round(color * alpha / 255 + 255 - alpha)
    planes = np.array([*np.repeat(stored[:, None], 3, 1), [alpha, 0, 255]], np.uint8)[:, None]
    found = psd.read(document(planes))[0]
    np.testing.assert_allclose(found[0, :3], color, atol=2)  # stored to half a unit, doubled, then cut off
    np.testing.assert_array_equal(found[1:, :3], [stored] * 2)
    np.testing.assert_array_equal(found[:, 3], [128, 0, 255])


def test_more_channels_than_four_are_left_out():
    planes = PLANES.copy()
    planes[3] = 255
    np.testing.assert_array_equal(psd.read(document(planes, packed=True)), np.moveaxis(planes[:4], 0, -1))


def test_a_texture_is_turned_over_like_any_other(tmp_path):
    (tmp_path / "t.psd").write_bytes(document(PLANES[:3]))
    upright = textures.read(tmp_path / "t.psd", vflip=True)
    np.testing.assert_array_equal(upright[..., :3], np.moveaxis(PLANES[:3], 0, -1))
    np.testing.assert_array_equal(textures.read(tmp_path / "t.psd"), upright[::-1])


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (document(PLANES[:3])[:20], "cut off"),
        (document(PLANES[:3])[:-1], "cut off"),
        (document(PLANES[:3], packed=True)[:-3], "cut off"),
        (document(PLANES[:4], mode=4), "SHADERed reads RGB"),
        (document(PLANES[:3], version=2), "version 2"),
        (document(PLANES[:3], depth=16, packed=True), "16 bits in runs"),
        (document(PLANES[:3])[:38] + b"\0\2", "in the way 2"),
    ],
    ids=["header", "pixels", "runs", "cmyk", "large", "16 bits", "zip"],
)
def test_what_shadered_does_not_read_is_refused(tmp_path, data, said):
    (tmp_path / "t.psd").write_bytes(data)
    with pytest.raises(textures.TextureError, match=said):
        textures.read(tmp_path / "t.psd")
