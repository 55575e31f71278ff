"""Packing: against numpy's own halves and roundings, and there and back."""

import numpy as np
import pytest

from harness import assert_ulp


@pytest.fixture
def packing(shader):
    return shader("packing.glsl")


def unit_vectors(count=20_000, seed=2):
    v = np.random.default_rng(seed).standard_normal((count, 3))
    axes = np.concatenate([np.eye(3), -np.eye(3), [[0, 0.6, 0.8], [0.6, 0, -0.8], [-0.6, -0.8, 0]]])
    return np.concatenate([v / np.linalg.norm(v, axis=1, keepdims=True), axes]).astype(np.float32)


def test_octahedral_there_and_back(packing):
    n = unit_vectors()
    p = packing.to_octahedral(n)
    assert np.abs(p).max() <= 1
    # a few roundings at coordinates of at most 1, stretched by at most sqrt(3) on the way back
    assert np.abs(packing.from_octahedral(p) - n.astype(np.float64)).max() < 16 * 2.0**-24


def test_octahedral_of_the_axes(packing):
    n = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0]]
    assert packing.to_octahedral(n).tolist() == [[1, 0], [0, 1], [0, 0], [-1, 0], [0, -1]]
    assert np.abs(packing.to_octahedral([0.0, 0.0, -1.0])).tolist() == [1, 1]


def test_unorm8_rounds_to_the_nearest_level(packing):
    v = np.random.default_rng(3).uniform(-0.2, 1.2, (20_000, 4)).astype(np.float32)
    exact = np.clip(v.astype(np.float64), 0, 1) * 255
    levels = packing.pack_unorm8(v)[:, None].view(np.uint8).astype(np.float64)
    assert np.abs(levels - exact).max() <= 0.5 + 255 * 2.0**-23  # of the product, and of the sum before floor()


def test_unorm8_of_every_level_there_and_back(packing):
    levels = np.arange(256, dtype=np.uint32) * np.uint32(0x01010101)
    values = packing.unpack_unorm8(levels)
    assert_ulp(values, np.arange(256)[:, None] / 255.0, max_ulp=0.5 + 2.5)  # GLSL grants a division 2.5
    assert np.array_equal(packing.pack_unorm8(values), levels)


def test_every_half_is_read_as_numpy_reads_it(packing):
    bits = np.arange(1 << 16, dtype=np.uint16)
    want = bits.view(np.float16).astype(np.float32)
    got = packing.from_half(bits)
    number = ~np.isnan(want)
    assert np.array_equal(got[number], want[number]) and np.isnan(got[~number]).all()


def test_every_half_is_written_as_it_was(packing):
    bits = np.arange(1 << 16, dtype=np.uint16)
    halves = bits.view(np.float16)
    number = ~np.isnan(halves)
    assert np.array_equal(packing.to_half(halves.astype(np.float32))[number], bits[number])


def test_halves_are_rounded_as_numpy_rounds(packing):
    """Floats of all exponents, and the ties between two halves, where only one of the two is even."""
    x = np.random.default_rng(4).integers(0, 1 << 32, 50_000, dtype=np.uint32).view(np.float32)
    halves = np.arange(0x7BFF, dtype=np.uint16).view(np.float16).astype(np.float32)
    ties = (halves[1:] + halves[:-1]) / 2
    largest = np.float32([65504, 65519.996, 65520, 65536, -65520, np.inf, -np.inf, 2.0**-25, 2.0**-24, 3 * 2.0**-26])
    x = np.concatenate([x[~np.isnan(x)], ties, -ties, largest])
    with np.errstate(over="ignore"):
        want = x.astype(np.float16).view(np.uint16)
    assert np.array_equal(packing.to_half(x), want)


def test_rgbe_there_and_back(packing):
    """Within half a level of the largest component's: a level is at most 1/128 of it."""
    color = np.random.default_rng(5).lognormal(0, 8, (20_000, 3)).astype(np.float32)
    e = packing.to_rgbe(color)
    assert e.max() <= 255 and np.all(e[:, :3].max(axis=1) >= 128)
    error = np.abs(packing.from_rgbe(e).astype(np.float64) - color) / color.max(axis=1, keepdims=True)
    assert error.max() <= 0.5 / 128 * (1 + 2.0**-20)
    assert packing.from_rgbe(packing.to_rgbe([0.0, 0.0, 0.0])).tolist() == [0, 0, 0]
