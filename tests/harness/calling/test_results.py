"""What a call returns: every type as it went in, structures and several outputs as named tuples.

Expected values are the arguments themselves, numpy's own arithmetic on small integers (exact in float32), or by hand.
"""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from glsl_values import TYPES, assert_same_bits, shape_of, values

from harness import shader

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


READABLE = """#version 430
struct Inner { float x; ivec2 k; };
struct Material { vec3 albedo; Inner inner; bool on; Inner two[1]; };
Material f(float x, out mat2 m)
{
    Inner inner = Inner(x / 4.0, ivec2(1, 2));
    m = mat2(1, 2, 3, 4);
    return Material(vec3(x), inner, x > 0.0, Inner[1](inner));
}
"""


@pytest.mark.parametrize(
    ("x", "text"),
    [
        (
            1,
            "f(result=Material(albedo=[1.0, 1.0, 1.0], inner=Inner(x=0.25, k=[1, 2]), on=True, "
            "two=(Inner(x=0.25, k=[1, 2]))), m=[[1.0, 3.0], [2.0, 4.0]])",
        ),
        (
            [1] * 5,
            "f(result=Material(albedo=[[1.0, 1.0, 1.0], ..., [1.0, 1.0, 1.0]] (5, 3), "
            "inner=Inner(x=[0.25, ..., 0.25] (5,), k=[[1, 2], ..., [1, 2]] (5, 2)), on=[True, ..., True] (5,), "
            "two=(Inner(x=[0.25, ..., 0.25] (5,), k=[[1, 2], ..., [1, 2]] (5, 2)))), "
            "m=[[[1.0, 3.0], [2.0, 4.0]], ..., [[1.0, 3.0], [2.0, 4.0]]] (5, 2, 2))",
        ),
    ],
)
def test_what_comes_back_reads_well(functions, x, text):
    """GLSL's names, one line, of long arrays the ends and the shape."""
    assert repr(functions(READABLE).f(x)) == text


def test_what_comes_back_can_be_pickled(functions):
    """To be sent to another process, nested or of several outputs."""
    got = functions(READABLE).f([1, 2])
    back = pickle.loads(pickle.dumps(got))
    assert type(back) is type(got)
    assert type(back.result.inner) is type(got.result.inner)
    assert repr(back) == repr(got)


def test_the_types_of_one_call_are_those_of_the_next(functions):
    made = functions("void f(out float x, out float y) { x = 1.0; y = 2.0; }")
    assert type(made.f()) is type(made.f())
