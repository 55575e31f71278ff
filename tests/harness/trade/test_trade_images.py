"""False colours: what is larger is lighter, and what is nothing looks like it."""

from __future__ import annotations

import numpy as np
import pytest

from harness.trade import images


def lightness(pixels):
    return pixels[..., :3] @ [0.2126, 0.7152, 0.0722]


def test_a_larger_error_is_lighter():
    light = lightness(images.heat(np.geomspace(images.SMALLEST, images.LARGEST, 64)[None]))[0]
    assert np.all(np.diff(light) > 0)


def test_decades_are_evenly_apart_in_color():
    """The scale under the maps is linear in the logarithm."""
    exponents = np.linspace(0, 1, 8)
    errors = images.SMALLEST * (images.LARGEST / images.SMALLEST) ** exponents
    assert np.abs(images.heat(errors[None]).astype(int) - images.scale(8)).max() <= 1


def test_what_is_outside_of_the_disk_is_transparent_and_what_is_infinite_is_white():
    made = images.heat(np.array([[np.nan, np.inf, 0.0, 7.0]]))[0]
    assert made[0, 3] == 0
    assert made[1].tolist() == [255] * 4
    assert np.array_equal(made[2], images.scale(2)[0, 0])
    assert np.array_equal(made[3], images.scale(2)[0, 1])


def one_pixel(*channels):
    return np.array([[[*channels, 255]]], np.uint8)


def test_equal_pictures_are_dark():
    same = one_pixel(10, 20, 30)
    assert np.array_equal(images.difference(same, same, 64), images.scale(2)[:, :1])
    assert images.amplification(same, same) == 1


def test_a_difference_has_no_sign():
    a, b = one_pixel(10, 200, 30), one_pixel(10, 190, 30)
    assert np.array_equal(images.difference(a, b, 8), images.difference(b, a, 8))
    assert lightness(images.difference(a, b, 8)) > lightness(images.difference(a, a, 8))


@pytest.mark.parametrize(("most", "factor"), [(1, 128), (2, 64), (3, 64), (9, 16), (127, 2), (128, 1), (255, 1)])
def test_the_amplification_is_a_power_of_two_that_clips_nothing(most, factor):
    got = images.amplification(one_pixel(0, most, 0), one_pixel(0, 0, 0))
    assert got == factor
    assert most * got <= 255 < 2 * most * got


def test_one_pixel_in_a_hundred_may_be_clipped():
    """Else a glint would leave the rest in the dark."""
    off = np.ones((1, 200, 4), np.uint8)
    off[0, :1] = 255
    assert images.amplification(off, np.zeros_like(off)) == 128
    off[0, :4] = 255
    assert images.amplification(off, np.zeros_like(off)) == 1
