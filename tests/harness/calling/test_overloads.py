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


# ---- By signature ----------------------------------------------------------------------------------------------------

SIGNED = """#version 430
struct S { float x; };
int f() { return 1; }
int f(float x) { return 2; }
int f(const in vec3 v, highp float s) { return 3; }
int f(vec3 v, int s) { return 4; }
int f(float x[3]) { return 5; }
int f(float x[3][2]) { return 6; }
int f(S s, out float x) { x = 1.0; return 7; }
int g(float x) { return 8; }
"""


@pytest.fixture(scope="module")
def signed(tmp_path_factory):
    path = tmp_path_factory.mktemp("signed") / "signed.glsl"
    path.write_text(SIGNED)
    return shader(path)


@pytest.mark.parametrize(
    ("text", "which"),
    [
        ("f()", 0),
        ("f(void)", 0),
        ("f( )", 0),
        ("f(float)", 1),
        ("int f(float x)", 1),
        ("  f (  in   float  y ) ", 1),
        ("f(vec3, float)", 2),
        ("f(vec3,float)", 2),
        ("int f(const in vec3 normal, mediump float)", 2),
        ("f(vec3, int)", 3),
        ("f(float[3])", 4),
        ("f(float x[3])", 4),
        ("f(float [ 3 ] x)", 4),
        ("f(float[3][2])", 5),
        ("f(float x[3][2])", 5),
        ("f(float[2] x[3])", 5),
        ("f(S, out float)", 6),
        ("f(S,float)", 6),
    ],
)
def test_an_overload_is_selected_by_its_types(signed, text, which):
    """Space, qualifiers, names of parameters and the returned type do not matter."""
    assert signed[text].signatures == (signed.f.signatures[which],)
    assert signed.f[text].signatures == (signed.f.signatures[which],)


def test_what_shows_an_overload_selects_it(signed):
    for signature in signed.f.signatures:
        assert signed[str(signature)].signatures == (signature,)


def test_a_selected_overload_is_called_where_the_arguments_fit_several(overloads):
    x = np.ones((2, 2))
    assert overloads["f(mat2)"](x) == 3
    assert overloads["f(vec2)"](x).tolist() == [2, 2]
    assert overloads.f["f(float)"].with_mode("precise")(x).tolist() == [[1, 1], [1, 1]]


def test_a_function_alone_of_its_name_can_be_selected_too(signed):
    assert signed["int g(float x)"](1) == 8


@pytest.mark.parametrize("text", ["f(vec2)", "f(float, vec3)", "f(float[2])", "f(s)", "f(float"])
def test_an_overload_that_is_not_there_is_refused_with_those_that_are(signed, text):
    with pytest.raises(CallError) as caught:
        signed[text]
    listed = "".join(f"\n    {signature}" for signature in signed.f.signatures)
    assert caught.value.message == f"no overload {text}; there are:{listed}"
    assert caught.value.file.endswith("signed.glsl")
