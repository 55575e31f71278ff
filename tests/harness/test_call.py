"""Calling GLSL functions on numpy arrays: what goes in comes out, in numpy's shapes.

Expected values are the arguments themselves, numpy's own arithmetic on small integers (exact in float32), or by hand.
"""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest

from harness import CallError, shader

#: bits that a copy could damage: zeros, smallest and largest denormal and normal, infinities, NaN of either kind
FLOAT_BITS = np.array(
    """00000000 80000000 00000001 80000001 007fffff 00800000 3f800000 7f7fffff 7f800000 ff800000
    7fc00000 7fc12345 ffc00001 7f800001 7fa00001 ffffffff""".split()
)
FLOAT_BITS = np.array([int(bits, 16) for bits in FLOAT_BITS], np.uint32)
EXTREMES = {
    "float": FLOAT_BITS.view(np.float32),
    "int": np.array([0, 1, -1, 2**31 - 1, -(2**31), 2**24 + 1], np.int32),
    "uint": np.array([0, 1, 2**31, 2**32 - 1, 2**24 + 1], np.uint32),
    "bool": np.array([True, False]),
}
PREFIXES = {"": "float", "i": "int", "u": "uint", "b": "bool"}
TYPES = [
    *PREFIXES.values(),
    *(f"{prefix}vec{n}" for prefix in PREFIXES for n in (2, 3, 4)),
    *("mat2", "mat3", "mat4", "mat2x3", "mat2x4", "mat3x2", "mat3x4", "mat4x2", "mat4x3"),
]


def shape_of(kind: str) -> tuple[int, ...]:
    """A matCxR has C columns and R rows; numpy has rows first."""
    if match := re.fullmatch(r"mat(\d)(?:x(\d))?", kind):
        return int(match[2] or match[1]), int(match[1])
    match = re.fullmatch(r"\w*vec(\d)", kind)
    return (int(match[1]),) if match else ()


def base_of(kind: str) -> str:
    return kind if kind in EXTREMES else PREFIXES[re.sub(r"(vec|mat)\w+", "", kind)]


def values(kind: str, count: int, seed: int = 0) -> np.ndarray:
    """``count`` values of a type, of extremes in another order each."""
    extremes = EXTREMES[base_of(kind)]
    return np.random.default_rng(seed).choice(extremes, (count, *shape_of(kind)))


def assert_same_bits(got, want) -> None:
    got, want = np.asarray(got), np.asarray(want)
    assert got.dtype == want.dtype
    assert got.shape == want.shape
    assert got.tobytes() == want.tobytes()


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """Functions that many tests call, compiled once a mode."""
    path = tmp_path_factory.mktemp("shared") / "shared.glsl"
    text = "".join(f"{t} swap_{t}(inout {t} a, {t} b) {{ {t} old = a; a = b; return old; }}\n" for t in TYPES)
    path.write_text(text + SHARED)
    made = shader(path)
    return {mode: made.with_mode(mode) for mode in ("as-written", "precise")}


SHARED = """
float id(float x) { return x; }
vec3 id3(vec3 v) { return v; }
uint id_uint(uint x) { return x; }
int id_int(int x) { return x; }
bool id_bool(bool x) { return x; }
float sum(float a, float b) { return a + b; }
vec3 scaled(vec3 v, float s) { return v * s; }
float sum4(float a, vec2 b, float c, mat2 d) { return a + b.x + b.y + c + d[0][0] + d[0][1] + d[1][0] + d[1][1]; }
vec3 transcendental(vec3 v, float s) { return pow(abs(v), vec3(s)) + exp(sin(v.zxy)) / (1.0 + sqrt(abs(v))); }
"""


# ---- Types -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", TYPES)
def test_every_type_goes_in_and_comes_back_bit_for_bit(shared, mode, kind):
    """As in, inout and returned value: NaN keep their payloads, zeros their signs, denormals and integers all bits."""
    a, b = values(kind, 40, seed=1), values(kind, 40, seed=2)
    returned, left = shared[mode][f"swap_{kind}"](a, b)
    assert_same_bits(returned, a)
    assert_same_bits(left, b)


@pytest.mark.parametrize("kind", ["float", "ivec2", "uvec3", "bvec4", "mat3x2"])
def test_a_single_value_has_no_dimension_of_its_own(shared, kind):
    a, b = values(kind, 2, seed=3)
    returned, left = shared["as-written"][f"swap_{kind}"](a, b)
    assert_same_bits(returned, a)
    assert_same_bits(left, b)


def test_a_scalar_comes_back_as_numpys_scalar(shared):
    assert type(shared["as-written"].id(1)) is np.float32
    assert type(shared["as-written"].id_int(1)) is np.int32
    assert type(shared["as-written"].id_bool(True)) is np.bool_


@pytest.mark.parametrize("value", [True, False])
def test_a_bool_is_told_from_its_opposite(shared, mode, value):
    assert shared[mode].id_bool(value) == value


def test_nothing_that_moves_is_flushed(shared, mode):
    """Arithmetic makes 0 of a denormal here; an assignment does not."""
    denormals = np.array([1, 2, 0x7FFFFF, 0x80000001], np.uint32).view(np.float32)
    assert_same_bits(shared[mode].id(denormals), denormals)


@pytest.mark.parametrize("size", ["2", "3", "4", "2x3", "2x4", "3x2", "3x4", "4x2", "4x3"])
def test_a_matrix_times_a_vector_is_numpys_product(functions, size):
    rows, columns = shape_of(f"mat{size}")
    made = functions(
        f"vec{rows} right(mat{size} m, vec{columns} v) {{ return m * v; }}\n"
        f"vec{columns} left(vec{rows} v, mat{size} m) {{ return v * m; }}"
    )
    random = np.random.default_rng(4)
    m = random.integers(-9, 9, (5, rows, columns))
    v, w = random.integers(-9, 9, (5, columns)), random.integers(-9, 9, (5, rows))
    np.testing.assert_array_equal(made.right(m, v), (m @ v[..., None])[..., 0])
    np.testing.assert_array_equal(made.left(w, m), (w[:, None] @ m)[:, 0])


def test_a_product_of_matrices_is_numpys(functions):
    random = np.random.default_rng(5)
    a, b = random.integers(-9, 9, (4, 3, 2)), random.integers(-9, 9, (4, 2, 4))
    np.testing.assert_array_equal(functions("mat4x3 f(mat2x3 a, mat4x2 b) { return a * b; }").f(a, b), a @ b)


def test_a_matrix_made_of_columns_has_them_as_columns(functions):
    got = functions("mat2x3 f(vec3 a, vec3 b) { return mat2x3(a, b); }").f([1, 2, 3], [4, 5, 6])
    np.testing.assert_array_equal(got, [[1, 4], [2, 5], [3, 6]])


def test_integer_arithmetic_wraps_at_32_bits(functions, mode):
    made = functions("int f(int x) { return x * 3; } uint g(uint x) { return x + 2u; }", mode=mode)
    x = np.array([2**31 - 1, -(2**31), 12345], np.int32)
    with np.errstate(over="ignore"):
        np.testing.assert_array_equal(made.f(x), x * np.int32(3))
    np.testing.assert_array_equal(made.g(np.uint32([2**32 - 1, 5])), [1, 7])


# ---- Structures and arrays -------------------------------------------------------------------------------------------

STRUCTS = """#version 430
struct Inner { float x; ivec2 k; };
struct Outer { Inner one; mat2 m; bool on; };
Outer id(Outer s) { return s; }
Inner inner(Outer s) { return s.one; }
Outer changed(Outer s) { s.one.x += 1.0; s.on = !s.on; return s; }
void put(inout Outer s, float x, out Inner old) { old = s.one; s.one.x = x; }
Inner[2] both(Inner a, Inner b) { return Inner[2](a, b); }
Inner[2] turned(Inner s[2]) { return Inner[2](s[1], s[0]); }
float[3] id_array(float x[3]) { return x; }
vec2[3] id_vectors(vec2 x[3]) { return x; }
mat2x3[2] id_matrices(mat2x3 x[2]) { return x; }
float[2][3] id_arrays(float[2][3] x) { return x; }
bool[2] id_bools(bool x[2]) { return x; }
"""
OUTER = {"one": {"x": 1.5, "k": [2, -3]}, "m": [[1, 2], [3, 4]], "on": True}


@pytest.fixture(scope="module")
def structs(tmp_path_factory):
    path = tmp_path_factory.mktemp("structs") / "structs.glsl"
    path.write_text(STRUCTS)
    made = shader(path)
    return {mode: made.with_mode(mode) for mode in ("as-written", "precise")}


def test_a_structure_goes_in_as_a_dict_and_comes_back_as_a_named_tuple(structs, mode):
    got = structs[mode].id(OUTER)
    assert got._fields == ("one", "m", "on")
    assert (got.one.x, got.on) == (1.5, True)
    np.testing.assert_array_equal(got.one.k, [2, -3])
    np.testing.assert_array_equal(got.m, OUTER["m"])


def test_a_structure_that_comes_back_can_be_given_again(structs, mode):
    once = structs[mode].changed(OUTER)
    twice = structs[mode].changed(once)
    assert (once.one.x, once.on, twice.one.x, twice.on) == (2.5, False, 3.5, True)
    assert structs[mode].inner(twice).x == 3.5


def test_the_members_of_a_structure_broadcast(structs):
    s = {"one": {"x": np.arange(3.0), "k": [2, -3]}, "m": np.ones((2, 1, 2, 2)), "on": True}
    got = structs["as-written"].id(s)
    assert (got.one.x.shape, got.one.k.shape, got.m.shape, got.on.shape) == ((2, 3), (2, 3, 2), (2, 3, 2, 2), (2, 3))
    np.testing.assert_array_equal(got.one.x, [[0, 1, 2]] * 2)


def test_members_are_told_by_their_names_in_any_order(structs):
    assert structs["as-written"].id(dict(reversed(OUTER.items()))).one.x == 1.5


def test_structures_come_back_from_out_and_inout(structs, mode):
    got = structs[mode].put(OUTER, [7, 8])
    assert got._fields == ("s", "old")
    np.testing.assert_array_equal(got.s.one.x, [7, 8])
    np.testing.assert_array_equal(got.old.x, [1.5, 1.5])


def test_arrays_of_structures_are_tuples(structs, mode):
    a, b = {"x": [1, 2], "k": [0, 0]}, {"x": 3, "k": [1, 1]}
    made = structs[mode].both(a, b)
    np.testing.assert_array_equal(made[0].x, [1, 2])
    np.testing.assert_array_equal(made[1].x, [3, 3])
    turned = structs[mode].turned(made)
    np.testing.assert_array_equal(turned[1].x, [1, 2])
    np.testing.assert_array_equal(structs[mode].turned([a, b])[0].k, [[1, 1]] * 2)


@pytest.mark.parametrize(
    ("name", "shape"),
    [("id_array", (3,)), ("id_vectors", (3, 2)), ("id_matrices", (2, 3, 2)), ("id_arrays", (2, 3))],
)
@pytest.mark.parametrize("batch", [(), (4,), (2, 0), (2, 5)])
def test_arrays_of_numbers_are_dimensions_before_those_of_their_elements(structs, mode, name, shape, batch):
    x = np.arange(np.prod(batch + shape), dtype=np.float32).reshape(batch + shape)
    assert_same_bits(structs[mode][name](x), x)


def test_an_array_of_bools(structs):
    np.testing.assert_array_equal(structs["as-written"].id_bools([[True, False], [False, False]]), [[1, 0], [0, 0]])


def test_names_that_python_keeps_for_itself(functions):
    """lambda is Smith's; a field that Python refuses is told by its place, and goes back in so."""
    made = functions(
        "struct S { float def; float _x; float is; }; S f(S s) { return s; } "
        "float lambda(float in_, out float class_) { class_ = in_; return 1.0; }"
    )
    got = made["lambda"](3)
    assert (type(got).__name__, got.result, got.class_) == ("lambda_", 1, 3)
    back = made.f({"def": 1, "_x": 2, "is": 3})
    assert back == (1, 2, 3)
    assert made.f(back) == back


# ---- Several outputs -------------------------------------------------------------------------------------------------


def test_several_outputs_are_a_named_tuple(functions, mode):
    made = functions(
        "float f(float x, out vec2 twice, inout int k) { twice = vec2(2.0 * x); k += 1; return -x; }", mode=mode
    )
    got = made.f([1, 2], k=3)
    assert got._fields == ("result", "twice", "k")
    np.testing.assert_array_equal(got.result, [-1, -2])
    np.testing.assert_array_equal(got.twice, [[2, 2], [4, 4]])
    np.testing.assert_array_equal(got.k, [4, 4])


def test_a_void_function_gives_its_only_output(functions):
    np.testing.assert_array_equal(functions("void f(float x, out float y) { y = x; }").f([1, 2]), [1, 2])


def test_what_comes_back_reads_well(functions):
    got = functions("float halves(float x, out float rest) { rest = x / 4.0; return x / 2.0; }").halves(2)
    assert re.fullmatch(r"halves\(result=(np\.float32\()?1\.0\)?, rest=(np\.float32\()?0\.5\)?\)", repr(got))


def test_the_types_of_one_call_are_those_of_the_next(functions):
    made = functions("void f(out float x, out float y) { x = 1.0; y = 2.0; }")
    assert type(made.f()) is type(made.f())


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


# ---- How an array lies in memory -------------------------------------------------------------------------------------


def misaligned(x):
    """The same numbers one byte off any alignment."""
    return np.frombuffer(b"\0" + x.tobytes(), x.dtype, offset=1).reshape(x.shape)


def read_only(x):
    x = x.copy()
    x.flags.writeable = False
    return x


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


# ---- Which function --------------------------------------------------------------------------------------------------

OVERLOADS = """
int f(float x) { return 1; }
int f(vec2 x) { return 2; }
int f(mat2 x) { return 3; }
int f(float x, float y) { return 4; }
int g(float x) { return 1; }
int g(int x) { return 2; }
int g(uint x) { return 3; }
int g(bool x) { return 4; }
int h(float x, out float y) { y = x; return 1; }
int h(float x, vec3 y) { return 2; }
int k(float x) { return 1; }
int k(float x, float u) { return 2; }
"""


@pytest.fixture(scope="module")
def overloads(tmp_path_factory):
    path = tmp_path_factory.mktemp("overloads") / "overloads.glsl"
    path.write_text(OVERLOADS)
    return shader(path)


@pytest.mark.parametrize(
    ("name", "arguments", "which"),
    [
        ("f", [1], 1),
        ("f", [[1, 2, 3]], 1),
        ("f", [1, 2], 4),
        ("f", [[1, 2, 3], 2], 4),
        ("g", [1.0], 1),
        ("g", [1], 2),
        ("g", [np.int64(1)], 2),
        ("g", [np.uint32(1)], 3),
        ("g", [True], 4),
        ("k", [1], 1),
        ("k", [1, 2], 2),
        ("h", [1, [1, 2, 3]], 2),
    ],
)
def test_an_overload_is_chosen_by_shape_type_and_number(overloads, name, arguments, which):
    got = overloads[name](*arguments)
    assert (np.asarray(got) == which).all()


def test_an_out_parameter_is_not_given(overloads):
    assert overloads.h(3) == (1, 3)


def test_an_overload_is_chosen_by_keyword(overloads):
    assert overloads.k(x=1, u=2) == 2


def test_an_overload_that_could_be_two_is_refused(overloads):
    """(2, 2) is a matrix, two vectors, or four numbers."""
    with pytest.raises(CallError, match="more than one overload fits") as caught:
        overloads.f(np.ones((2, 2)))
    assert "int f(mat2 x)" in caught.value.message


def test_arguments_by_keyword_in_any_order(shared):
    np.testing.assert_array_equal(shared["as-written"].scaled(s=2, v=[1, 2, 3]), [2, 4, 6])
    np.testing.assert_array_equal(shared["as-written"].scaled([1, 2, 3], s=2), [2, 4, 6])


def test_a_function_by_attribute_is_that_by_index(shared):
    assert shared["as-written"].sum is shared["as-written"]["sum"]


def test_functions_are_listed(overloads):
    assert set("fghk") <= set(dir(overloads))
    assert repr(overloads.k) == "<GLSL int k(float x); int k(float x, float u)>"


# ---- Uniforms --------------------------------------------------------------------------------------------------------

UNIFORMS = """#version 330
uniform float gain;
uniform vec3 offset;
uniform mat3 m;
uniform mat2 m2;
uniform int k;
uniform ivec2 k2;
uniform uint u;
uniform bool on;
uniform bvec3 flags;
uniform float weights[4];
uniform vec2 points[2];
uniform mat2 turns[2];
uniform struct Light { vec3 color; float power; } light;
uniform struct Spot { float x; } spots[2];
layout(std140) uniform Block { float of_block; };
uniform sampler2D map;
float gained(float x) { return gain * x; }
vec3 moved(vec3 v) { return v + offset; }
vec3 right(vec3 v) { return m * v; }
vec2 left(vec2 v) { return v * m2; }
int added(int x) { return x + k + k2.y + int(u); }
float if_on(float x) { return on ? x : -x; }
float if_flag(float x) { return flags.y ? x : -x; }
float weighted(int i) { return weights[i]; }
float first_weights(float x) { return weights[0] + 10.0 * weights[1]; }
float point(int i) { return points[i].y; }
vec2 turned(int i, vec2 v) { return turns[i] * v; }
float lit(float x) { return light.color.y * light.power * x; }
float spot(float x) { return spots[0].x + spots[1].x * x; }
float blocked(float x) { return of_block * x; }
vec4 sampled(vec2 uv) { return texture(map, uv); }
float plain(float x) { return x; }
uniform mat2x3 wide;
uniform uvec3 counts;
vec3 widened(vec2 v) { return wide * v; }
uvec3 counted(uint k) { return counts + k; }
"""
M = np.arange(9).reshape(3, 3)


@pytest.fixture(scope="module")
def uniforms(tmp_path_factory):
    path = tmp_path_factory.mktemp("uniforms") / "uniforms.glsl"
    path.write_text(UNIFORMS)
    made = shader(path)
    return {mode: made.with_mode(mode) for mode in ("as-written", "precise")}


@pytest.mark.parametrize(
    ("name", "arguments", "given", "want"),
    [
        ("gained", [[1, 2]], {"gain": 3}, [3, 6]),
        ("gained", [[1, 2]], {"gain": np.float64(0.5)}, [0.5, 1]),
        ("moved", [[1, 2, 3]], {"offset": [10, 20, 30]}, [11, 22, 33]),
        ("right", [[1, 2, 3]], {"m": M}, M @ [1, 2, 3]),
        ("left", [[1, 2]], {"m2": [[1, 2], [3, 4]]}, [7, 10]),
        ("added", [5], {"k": -7, "k2": [0, 100], "u": 1}, 99),
        ("if_on", [2], {"on": True}, 2),
        ("if_on", [2], {"on": False}, -2),
        ("if_flag", [2], {"flags": [False, True, False]}, 2),
        ("weighted", [[0, 1, 2, 3]], {"weights": [5, 6, 7, 8]}, [5, 6, 7, 8]),
        ("first_weights", [0], {"weights": [5, 6, 7, 8]}, 65),  # of an array the driver knows only what is read
        ("point", [[0, 1]], {"points": [[1, 2], [3, 4]]}, [2, 4]),
        ("turned", [[0, 1], [1, 2]], {"turns": [[[1, 2], [3, 4]], [[0, 1], [1, 0]]]}, [[5, 11], [2, 1]]),
        ("lit", [2], {"light.color": [0, 3, 0], "light.power": 5}, 30),
        ("spot", [2], {"spots[0].x": 3, "spots[1].x": 5}, 13),
        ("widened", [[1, 2]], {"wide": [[1, 2], [3, 4], [5, 6]]}, [5, 11, 17]),
        ("counted", [1], {"counts": [0, 7, 4294967294]}, [1, 8, 4294967295]),
        ("plain", [1], {}, 1),
    ],
)
def test_a_uniform_is_given_by_its_name(uniforms, mode, name, arguments, given, want):
    np.testing.assert_array_equal(uniforms[mode][name](*arguments, **given), want)


def test_calls_with_other_uniforms_do_not_remember(uniforms, mode):
    for gain in (2, 3, 2):
        assert uniforms[mode].gained(1, gain=gain) == gain
    for scale in (1, 2):
        np.testing.assert_array_equal(uniforms[mode].right([1, 2, 3], m=M * scale), scale * M @ [1, 2, 3])


def test_uniforms_of_two_functions_are_their_own(uniforms):
    made = uniforms["as-written"]
    assert made.gained(1, gain=5) == 5
    np.testing.assert_array_equal(made.moved([0, 0, 0], offset=[1, 2, 3]), [1, 2, 3])
    assert made.gained(1, gain=6) == 6


@pytest.mark.parametrize(
    ("name", "argument", "given", "message"),
    [
        ("gained", 1, {}, "gained reads the uniform float gain: give it by its name"),
        ("weighted", 1, {}, "weighted reads the uniform float[4] weights: give it by its name"),
        ("weighted", 1, {"weights": [1, 2, 3]}, "weights is a float[4]: an array of shape (..., 4), got (3,)"),
        ("weighted", 1, {"weights": 1}, "weights is a float[4]: an array of shape (..., 4), got ()"),
        ("weighted", 1, {"weights[0]": 1}, "no parameter weights[0] and reads no such uniform"),
        ("right", [1, 2, 3], {"m": np.ones((2, 3, 3))}, "uniform m is one mat3, not an array of them"),
        ("gained", 1, {"gain": 1, "offset": [1, 2, 3]}, "has no parameter offset and reads no such uniform"),
        ("if_on", 1, {"on": 1}, "on is a bool, got numbers of type int64"),
        ("sampled", [0, 0], {"map": 1}, "map is a sampler2D: give it a harness.Texture, got int"),
        ("sampled", [0, 0], {}, "sampled reads the uniform sampler2D map: give it a Texture by its name"),
        ("blocked", 1, {}, "of_block of a uniform block, which cannot be given"),
    ],
)
def test_a_uniform_that_does_not_fit_is_refused(uniforms, name, argument, given, message):
    with pytest.raises(CallError) as caught:
        uniforms["as-written"][name](argument, **given)
    assert message in caught.value.message


def test_a_parameter_hides_the_uniform_of_its_name(functions):
    made = functions("uniform float x; float f(float x) { return x; } float g() { return x; }")
    assert made.f(x=2) == 2
    assert made.g(x=3) == 3


# ---- Files -----------------------------------------------------------------------------------------------------------


def test_functions_of_included_files_can_be_called(tmp_path):
    (tmp_path / "inner.glsl").write_text("float inner(float x) { return 3.0 * x; }\n")
    (tmp_path / "outer.glsl").write_text('#include "inner.glsl"\nfloat outer(float x) { return inner(x) + 1.0; }\n')
    made = shader(tmp_path / "outer.glsl")
    assert (made.inner(2), made.outer(2)) == (6, 7)


def test_functions_behind_macros_can_be_called(functions):
    text = (
        "#define DEFINE(name, op) float name(float a, float b) { return a op b; }\nDEFINE(plus, +)\nDEFINE(minus, -)\n"
    )
    made = functions(text)
    assert (made.plus(5, 2), made.minus(5, 2)) == (7, 3)


def test_macros_change_the_result(functions):
    text = (
        "#ifndef N\n#define N 1.0\n#endif\nfloat f(float x) {\n#if defined(TWICE)\nx *= 2.0;\n#endif\nreturn N * x; }"
    )
    assert functions(text).f(1) == 1
    assert functions(text, defines={"N": 3}).f(1) == 3
    assert functions(text, defines={"N": "5.0", "TWICE": ""}).f(1) == 10


def test_the_functions_of_an_entry_points_file_can_be_called(root, mode):
    """Whatever its inputs, outputs and main() are."""
    made = shader(root / "tests/harness/glsl/entry.frag", mode=mode)
    assert made.twice(3) == 6
    assert made.gained(3, gain=5) == 15
    made = shader(root / "tests/harness/glsl/entry.vert", mode=mode)
    matrix = np.arange(16).reshape(4, 4)
    np.testing.assert_array_equal(made.projected([1, 2, 3], view_projection=matrix), matrix @ [1, 2, 3, 1])


@pytest.mark.parametrize("name", ["pbr.frag", "brdf.glsl"])
def test_the_shading_of_the_scene_can_be_called_where_it_is_used(root, mode, name):
    """At normal incidence Schlick's F is F0, and 1 at grazing incidence."""
    made = shader(root / "shaders" / name, mode=mode)
    np.testing.assert_array_equal(made.F_Schlick([0.25, 0.5, 1], [1, 0]), np.float32([[0.25, 0.5, 1], [1, 1, 1]]))


def test_a_file_gives_the_same_bits_alone_and_included(root, mode):
    random = np.random.default_rng(9)
    NoH, alpha = random.random((2, 5000), np.float32)
    alone = shader(root / "shaders/brdf.glsl", mode=mode)
    included = shader(root / "shaders/pbr.frag", mode=mode)
    assert_same_bits(alone.D_GGX(NoH, alpha), included.D_GGX(NoH, alpha))


def test_an_entry_point_without_functions_has_none(root):
    assert repr(shader(root / "shaders/pbr.vert")).endswith("shaders/pbr.vert: >")


def test_globals_start_anew_for_every_element(functions, mode):
    made = functions("float n = 5.0; float f(float x) { n += x; return n; }", mode=mode)
    np.testing.assert_array_equal(made.f([1, 2, 3]), [6, 7, 8])
    np.testing.assert_array_equal(made.f([1, 2, 3]), [6, 7, 8])


def test_modes_are_apart(shared):
    assert shared["as-written"].with_mode("precise").sum(1, 2) == 3
    assert shared["as-written"].sum(1, 2) == 3
