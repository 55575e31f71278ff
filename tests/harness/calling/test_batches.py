"""Batches of a call: they broadcast as in numpy, and each element is by itself, whatever the batch's size."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from glsl_values import assert_same_bits

from harness import CallError

# ---- Broadcasting ----------------------------------------------------------------------------------------------------

SHAPES = [(), (1,), (3,), (1, 1), (2, 1), (1, 3), (2, 3), (0,), (2, 0), (4, 1, 3), (4, 2, 1)]


def numbers(shape, start=0):
    return np.arange(start, start + np.prod(shape), dtype=np.float32).reshape(shape)


@pytest.mark.parametrize(("a", "b"), list(itertools.product(SHAPES, SHAPES)))
def test_two_scalars_broadcast_as_in_numpy(shared, a, b):
    x, y = numbers(a), numbers(b, 100)
    try:
        want = x + y
    except ValueError:
        with pytest.raises(CallError, match="do not broadcast"):
            shared["as-written"].sum(x, y)
        return
    got = shared["as-written"].sum(x, y)
    assert np.shape(got) == want.shape
    np.testing.assert_array_equal(got, want)


@pytest.mark.parametrize(("a", "b"), list(itertools.product(SHAPES[::2], SHAPES)))
def test_a_vectors_last_dimension_takes_no_part(shared, a, b):
    v, s = numbers((*a, 3)), numbers(b, 100)
    try:
        want = v * s[..., None]
    except ValueError:
        with pytest.raises(CallError, match="do not broadcast"):
            shared["as-written"].scaled(v, s)
        return
    got = shared["as-written"].scaled(v, s)
    assert got.shape == want.shape
    np.testing.assert_array_equal(got, want)


def test_four_arguments_of_four_shapes_broadcast_together(shared, mode):
    a, b, c, d = numbers((2, 1, 1)), numbers((3, 1, 2)), numbers((4,)), numbers((1, 4, 2, 2))
    want = a + b.sum(-1) + c + d.sum((-1, -2))
    np.testing.assert_array_equal(shared[mode].sum4(a, b, c, d), want)


# ---- Batches ---------------------------------------------------------------------------------------------------------

TILE = 1024
COUNTS = [1, 2, 15, 16, 17, 255, 256, 257, TILE - 1, TILE, TILE + 1, 16 * TILE + 1, TILE**2 - 1, TILE**2, TILE**2 + 1]


@pytest.mark.parametrize("count", [*COUNTS, 3 * TILE**2 + 5])
def test_every_element_comes_back_to_its_place(shared, count):
    """Numbered elements, around the borders of the tiles that a batch is drawn in."""
    x = np.arange(count, dtype=np.uint32) ^ np.uint32(0xA5A50000)
    assert_same_bits(shared["as-written"].id_uint(x), x)


@pytest.mark.parametrize("count", [17, TILE + 1, TILE**2 + 1])
def test_an_argument_given_once_is_the_same_for_all(shared, count):
    x = np.arange(count, dtype=np.float32)
    np.testing.assert_array_equal(shared["as-written"].sum(x, 1), x + 1)
    np.testing.assert_array_equal(shared["as-written"].sum(np.float32([1]), x), x + 1)


def test_a_small_batch_after_a_large_one(shared):
    """What stays from one to the next must not show."""
    for count in (70_000, 3, 1, 2000, 5):
        x = np.arange(count, dtype=np.float32)
        assert_same_bits(shared["as-written"].id(x), x)


def test_an_element_does_not_depend_on_its_batch(shared, mode):
    """Alone, in a slice, in any order: the same bits."""
    random = np.random.default_rng(6)
    v, s = random.standard_normal((2000, 3)).astype(np.float32), random.random(2000, np.float32) * 3
    f = shared[mode].transcendental
    whole = f(v, s)
    for k in [0, 1, 2, 3, 15, 16, 17, 500, 1023, 1024, 1999]:
        assert_same_bits(f(v[k], s[k]), whole[k])
    for size in (2, 15, 16, 17, 1000):
        assert_same_bits(f(v[-size:], s[-size:]), whole[-size:])
    order = random.permutation(2000)
    assert_same_bits(f(v[order], s[order]), whole[order])


def test_an_argument_given_once_counts_as_much_as_one_given_often(shared, mode):
    v = np.random.default_rng(7).standard_normal((300, 3)).astype(np.float32)
    f = shared[mode].transcendental
    assert_same_bits(f(v, 1.7), f(v, np.full(300, 1.7)))
    assert_same_bits(f(v[0], np.full(300, 1.7)), np.broadcast_to(f(v[0], 1.7), (300, 3)))


def test_the_same_call_gives_the_same_bits(shared, mode):
    v = np.random.default_rng(8).standard_normal((5000, 3)).astype(np.float32)
    first = shared[mode].transcendental(v, 0.3)
    for _ in range(3):
        assert_same_bits(shared[mode].transcendental(v, 0.3), first)
