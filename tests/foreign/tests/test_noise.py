"""Noise: what its definition promises at the points of the grid, between them, and on average."""

import numpy as np
import pytest

from harness import assert_ulp


@pytest.fixture
def noise(shader):
    return shader("noise.glsl")


def points(count=20_000, reach=100.0, seed=1):
    return np.random.default_rng(seed).uniform(-reach, reach, (count, 2)).astype(np.float32)


def test_scramble_is_a_bijection_that_changes_half_of_the_bits(noise):
    x = np.arange(1 << 18, dtype=np.uint32)
    mixed = noise.scramble(x)
    assert len(np.unique(mixed)) == len(x)
    for bit in range(32):
        changes = mixed ^ noise.scramble(x ^ np.uint32(1 << bit))
        assert abs(np.unpackbits(changes.view(np.uint8)).mean() - 0.5) < 0.1


def test_value_noise_has_the_values_of_the_grid_at_its_points(noise):
    cells = np.stack(np.meshgrid(np.arange(-8, 8), np.arange(-8, 8)), axis=-1)
    values = noise.grid_value(cells)
    assert np.array_equal(noise.value_noise(cells.astype(np.float32)), values)
    assert np.array_equal(values * 2.0**24 % 1, np.zeros_like(values)) and values.min() >= 0 and values.max() < 1


def test_value_noise_is_half_way_in_the_middle_of_an_edge(noise):
    cells = np.arange(-50, 50)
    ends = [noise.grid_value(np.stack([cells + k, cells], axis=-1)).astype(np.float64) for k in (0, 1)]
    middle = noise.value_noise(np.stack([cells + 0.5, cells], axis=-1))
    assert np.allclose(middle, (ends[0] + ends[1]) / 2, rtol=0, atol=2.0**-23)


def test_noise_is_continuous_across_the_grid(noise):
    """Two sides of a line of the grid: fade is flat there, so that the step is of second order."""
    y = np.linspace(-3, 3, 501, dtype=np.float32)
    for f in (noise.value_noise, noise.gradient_noise):
        left, right = (f(np.stack([np.full_like(y, 2 + side * 2.0**-12), y], axis=-1)) for side in (-1, 1))
        assert np.abs(left - right).max() < 2.0**-10


def test_gradient_noise_is_nothing_at_the_points_of_the_grid(noise):
    cells = np.stack(np.meshgrid(np.arange(-8, 8), np.arange(-8, 8)), axis=-1)
    assert np.all(noise.gradient_noise(cells.astype(np.float32)) == 0)


def test_ranges(noise):
    p = points()
    value, gradient = noise.value_noise(p), noise.gradient_noise(p)
    assert value.min() >= 0 and value.max() < 1 and abs(value.mean() - 0.5) < 0.02
    assert np.abs(gradient).max() < 1 and abs(gradient.mean()) < 0.02


@pytest.mark.parametrize("octaves", [1, 3])
def test_layers_are_octaves_of_value_noise(shader, noise, octaves):
    """The sum in float64; a product and a sum of each octave are rounded, of numbers below 1."""
    p = points(2000)
    want = sum(noise.value_noise(p * np.float32(2**k)).astype(np.float64) * 0.5 ** (k + 1) for k in range(octaves))
    layered = shader("noise.glsl", defines={"OCTAVES": octaves}).layered_noise
    assert_ulp(layered(p), want, max_ulp=octaves)


def test_the_picture_of_it(noise, golden):
    """Additions and products only, which IEEE 754 rounds alike everywhere: one level for their order."""
    y, x = np.mgrid[0:48, 0:64] / np.float32(8)
    golden("layers.png", np.rint(noise.layered_noise(np.stack([x, y], axis=-1)) * 255).astype(np.uint8), atol=1)
