"""Colours: against Python's colorsys, published coordinates, and there and back."""

import colorsys

import numpy as np
import pytest


@pytest.fixture
def color(shader):
    return shader("color.glsl")


@pytest.fixture
def rgb():
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 12)] * 3), axis=-1).reshape(-1, 3)
    return np.concatenate([grid, np.random.default_rng(6).random((1000, 3))]).astype(np.float32)


def test_hsv_is_that_of_colorsys(color, rgb):
    want = np.array([colorsys.rgb_to_hsv(*map(float, c)) for c in rgb])
    got = color.rgb_to_hsv(rgb).astype(np.float64)
    hue = np.abs(got[:, 0] - want[:, 0])
    # the hue is a circle; it divides differences of rounded numbers by the chroma, which itself is exact or nearly so
    assert np.minimum(hue, 1 - hue).max() < 1e-6
    assert np.abs(got[:, 1:] - want[:, 1:]).max() < 4 * 2.0**-24


def test_hsv_to_rgb_is_that_of_colorsys(color, rgb):
    want = np.array([colorsys.hsv_to_rgb(*map(float, c)) for c in rgb])
    assert np.abs(color.hsv_to_rgb(rgb) - want).max() < 6 * 8 * 2.0**-24  # six times the hue, a few roundings


@pytest.mark.parametrize(
    ("linear", "published"),  # CSS Color 4, five digits
    [
        ([1, 1, 1], [1.0, 0.0, 0.0]),
        ([1, 0, 0], [0.62796, 0.22486, 0.12585]),
        ([0, 1, 0], [0.86644, -0.23389, 0.17950]),
        ([0, 0, 1], [0.45201, -0.03246, -0.31153]),
    ],
)
def test_oklab_of_white_and_the_primaries(color, linear, published):
    assert np.abs(color.to_oklab(linear) - np.array(published)).max() < 1e-5


def test_oklab_of_greys_is_their_cube_root(color):
    grey = np.geomspace(1e-6, 1, 500)
    got = color.to_oklab(np.repeat(grey[:, None], 3, axis=1))
    # the rows of the published matrices sum to 1 and 0 within 4e-8; pow() is good to 1e-5 here
    assert np.abs(got - np.stack([np.cbrt(grey), 0 * grey, 0 * grey], axis=1)).max() < 2e-5


def test_oklab_there_and_back(color, rgb):
    assert np.abs(color.from_oklab(color.to_oklab(rgb)) - rgb.astype(np.float64)).max() < 1e-4


def test_ycocg_loses_nothing(color):
    steps = np.array([*range(0, 256, 9), 1, 2, 254, 255])
    c = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    y = color.to_ycocg(c)
    assert np.array_equal(color.from_ycocg(y), c)
    assert y[:, 0].min() >= 0 and y[:, 0].max() <= 255 and np.abs(y[:, 1:]).max() <= 255
    grey = np.arange(256)
    assert np.array_equal(color.to_ycocg(np.repeat(grey[:, None], 3, 1)), np.stack([grey, 0 * grey, 0 * grey], axis=1))
