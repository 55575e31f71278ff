"""Pictures on disk: whole or not at all."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from harness import HarnessError
from harness.picture import write_png, write_targets


def test_a_png_holds_the_pixels(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 4), np.uint8)
    write_png(tmp_path / "p.png", pixels)
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "p.png")), pixels)


def test_nothing_but_the_picture_is_left(tmp_path):
    write_png(tmp_path / "p.png", np.zeros((2, 2, 4), np.uint8))
    assert [p.name for p in tmp_path.iterdir()] == ["p.png"]


def test_a_picture_that_fails_leaves_the_old_one(tmp_path):
    (tmp_path / "p.png").write_bytes(b"old")
    with pytest.raises(TypeError):
        write_png(tmp_path / "p.png", np.zeros((2, 2, 7), np.uint8))
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("p.png", b"old")]


def test_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(HarnessError, match="cannot write the file"):
        write_png(tmp_path / "gone" / "p.png", np.zeros((2, 2, 4), np.uint8))


def test_targets_as_numbers_and_as_pictures(tmp_path):
    floats = np.array([[[0, 0.5, 1, 1]], [[-1, np.nan, 7, 0.25]]], np.float32)
    write_targets(tmp_path / "new", {"rt": floats})
    np.testing.assert_array_equal(np.load(tmp_path / "new" / "rt.npy"), floats)
    # The top row of the picture is the last of the array; 0.5 * 255 = 127.5 and 0.25 * 255 = 63.75.
    pixels = np.asarray(Image.open(tmp_path / "new" / "rt.png"))
    np.testing.assert_array_equal(pixels, [[[0, 0, 255, 64]], [[0, 128, 255, 255]]])


def test_targets_stay_in_their_folder(tmp_path):
    write_targets(tmp_path / "t", {"../out": np.zeros((1, 1, 4), np.float32)})
    assert sorted(p.name for p in (tmp_path / "t").iterdir()) == ["..%2Fout.npy", "..%2Fout.png"]
    assert [p.name for p in tmp_path.iterdir()] == ["t"]


def test_a_folder_that_cannot_be(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(HarnessError, match="cannot make the folder"):
        write_targets(tmp_path / "file" / "t", {})
