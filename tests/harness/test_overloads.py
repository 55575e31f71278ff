"""Which of several functions of one name is called."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, shader

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
