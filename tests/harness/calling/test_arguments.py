"""Arguments of a call: however an array lies in memory, its numbers arrive, rounded once to GLSL's."""

from __future__ import annotations

import tempfile

import numpy as np
import pytest
from glsl_values import EXTREMES, assert_same_bits

from harness.calling.evaluation import Evaluation

# ---- How an array lies in memory -------------------------------------------------------------------------------------


def misaligned(x):
    """The same numbers one byte off any alignment."""
    return np.frombuffer(b"\0" + x.tobytes(), x.dtype, offset=1).reshape(x.shape)


def read_only(x):
    x = x.copy()
    x.flags.writeable = False
    return x


class Frame:
    """What gives its numbers to numpy alone, as the columns of pandas do."""

    def __init__(self, x):
        self.x = x

    def __array__(self, dtype=None, copy=None):
        return np.array(self.x, dtype)


def mapped(x):
    """A file in memory, read-only."""
    with tempfile.NamedTemporaryFile() as file:
        np.save(file, x)
        file.flush()
        return np.load(file.name, mmap_mode="r")


LAYOUTS = {
    "every other": lambda x: np.repeat(x, 2, axis=0)[::2],
    "reversed": lambda x: x[::-1].copy()[::-1],
    "reversed components": lambda x: x[..., ::-1].copy()[..., ::-1],
    "Fortran": np.asfortranarray,
    "big-endian": lambda x: x.astype(x.dtype.newbyteorder(">")),
    "read-only": read_only,
    "one number in": lambda x: np.concatenate([x[:1], x])[1:],
    "one byte in": misaligned,
    "one vector repeated": lambda x: np.broadcast_to(x[0], x.shape),
    "one component repeated": lambda x: np.broadcast_to(x[:, :1], x.shape),
    "list": lambda x: x.tolist(),
    "list of arrays": list,
    "float64": lambda x: x.astype(np.float64),
    "float16": lambda x: x.astype(np.float16),
    "int64": lambda x: x.astype(np.int64),
    "uint8": lambda x: x.astype(np.uint8),
    "bool": lambda x: x.astype(bool),
    "what has __array__": Frame,
    "memory-mapped": mapped,
    "tuples": lambda x: tuple(map(tuple, x)),
    "subclass": lambda x: np.ma.masked_array(x),
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("count", [1, 5, 100])
def test_an_array_may_lie_in_memory_as_it_likes(shared, layout, count):
    x = LAYOUTS[layout]((np.arange(3 * count) % 256).astype(np.float32).reshape(count, 3))
    np.testing.assert_array_equal(shared["as-written"].id3(x), np.asarray(x, np.float32))


@pytest.mark.parametrize("offset", [1, 2, 3, 4, 5])
def test_an_input_need_not_be_aligned_for_the_driver(shared, offset):
    """Inputs are read in place where they lie on 16 bytes, and copied elsewhere."""
    x = np.arange(1000, dtype=np.float32)
    assert_same_bits(shared["as-written"].id(x[offset:]), x[offset:])
    v = np.arange(3000, dtype=np.float32)[offset : offset + 2700].reshape(900, 3)
    assert_same_bits(shared["as-written"].id3(v), v)


@pytest.mark.parametrize("dtype", [">f4", ">f8", ">i4", ">u2"])
def test_big_endian_numbers_keep_their_value(shared, dtype):
    np.testing.assert_array_equal(shared["as-written"].id(np.array([1, 2, 300], dtype)), [1, 2, 300])


def test_big_endian_nan_keep_their_bits(shared):
    x = EXTREMES["float"]
    assert_same_bits(shared["as-written"].id(x.astype(">f4")), x)


def test_nothing_that_is_repeated_is_written_out(shared, monkeypatch):
    """One value for a whole batch goes to GL as one value, however it is repeated."""
    given = []
    run = Evaluation.run
    monkeypatch.setattr(Evaluation, "run", lambda self, flat, count: given.append(flat) or run(self, flat, count))
    x = np.arange(6.0).reshape(2, 3)
    for one in (7, [[7]], np.broadcast_to(7.0, (2, 3)), np.full((2, 1), 7)[:1]):
        np.testing.assert_array_equal(shared["as-written"].sum(x, one), x + 7)
        assert [len(array) for array in given[-1].values()] == [6, 1]


def test_no_input_is_modified(functions):
    """Not even one that the function assigns to, or that is inout."""
    made = functions("float f(inout vec3 v, float x, float y) { v = vec3(x); x = 9.0; y = 8.0; return x; }")
    arrays = [np.ones((1000, 3), np.float32), np.full(1000, 2, np.float32), np.arange(1000.0)]
    before = [array.copy() for array in arrays]
    made.f(*arrays)
    for array, copy in zip(arrays, before, strict=True):
        assert_same_bits(array, copy)


def test_a_result_is_no_view_of_its_argument(shared):
    x = np.ones(100, np.float32)
    got = shared["as-written"].id(x)
    got[:] = 2
    assert (x == 1).all()


# ---- Rounding on the way in ------------------------------------------------------------------------------------------


def test_float64_is_rounded_once_to_the_nearest_float32(shared):
    """Halfway cases to even: 1 + 2^-24 to 1, 1 + 3 2^-24 up; a hair above the half goes up; over the top is Inf."""
    x = np.array([1 + 2.0**-24, 1 + 3 * 2.0**-24, 1 + 2.0**-24 + 2.0**-50, 0.1, 1e-45, 7e-46, 3.5e38, -1e300])
    want = np.float32([1, 1 + 2.0**-22, 1 + 2.0**-23, 0.1, 2.0**-149, 0, np.inf, -np.inf])
    assert_same_bits(shared["as-written"].id(x), want)


@pytest.mark.filterwarnings("error")
def test_rounding_to_infinity_is_no_warning(shared):
    assert shared["as-written"].id(1e300) == np.inf


def test_integers_are_rounded_once(shared):
    """2^24 + 1 and 2^62 + 2^38 lie halfway: to even."""
    x = np.array([2**24 + 1, 2**24 + 3, 2**62 + 2**38, 2**62 + 2**38 + 1])
    assert_same_bits(shared["as-written"].id(x), np.float32([2**24, 2**24 + 4, 2.0**62, 2.0**62 + 2.0**39]))


@pytest.mark.parametrize(
    ("name", "value"),
    [("id_int", -5), ("id_int", np.int64(2**31 - 1)), ("id_uint", np.uint64(2**32 - 1)), ("id_int", np.uint8(200))],
)
def test_integers_of_any_width_are_taken_where_they_fit(shared, name, value):
    assert shared["as-written"][name](value) == value
