"""What functions a file has. Expected: the declarations as they are written, read by hand."""

from __future__ import annotations

import numpy as np
import pytest

from harness import GlslError, shader
from harness.language.signature import Array, Numeric, Struct


def signature(functions, text: str, name: str = "f"):
    (found,) = functions(text)[name].signatures
    return found


STRUCTS = """#version 430
struct Inner { float x; vec2 y; };
struct Outer { Inner one; Inner two[2]; mat2 m; };
"""
#: as it is written -> as it is shown, where that differs
DECLARATIONS = {
    "float f()": None,
    "float f(void)": "float f()",
    "float f(float x)": None,
    "float f(in float x)": "float f(float x)",
    "float f(const float x)": "float f(float x)",
    "float f(const in float x)": "float f(float x)",
    "float f(out float x)": None,
    "float f(inout float x)": None,
    "void f(out float x, float y, inout vec3 z)": None,
    "highp float f(highp float x)": "float f(float x)",
    "mediump vec3 f(in lowp vec3 x, out mediump vec2 y)": "vec3 f(vec3 x, out vec2 y)",
    "float f(precise float x)": "float f(float x)",
    "float f(precise in float x, precise inout vec2 y)": "float f(float x, inout vec2 y)",
    "int f(int x, ivec2 y, ivec3 z, ivec4 w)": None,
    "uint f(uint x, uvec2 y, uvec3 z, uvec4 w)": None,
    "bool f(bool x, bvec2 y, bvec3 z, bvec4 w)": None,
    "double f(double x, dvec2 y, dvec3 z, dvec4 w, dmat3 m)": None,
    "mat2 f(mat3 a, mat4 b)": None,
    "mat2x3 f(mat2x4 a, mat3x2 b, mat3x4 c, mat4x2 d, mat4x3 e)": None,
    "mat2x2 f(mat3x3 a, mat4x4 b)": "mat2 f(mat3 a, mat4 b)",
    "float f(float x[3])": "float f(float[3] x)",
    "float f(float[3] x)": None,
    "float[3] f(const in float x[3])": "float[3] f(float[3] x)",
    "float[2][3] f(float[2][3] x)": None,
    "float[2][3] f(float[3] x[2])": "float[2][3] f(float[2][3] x)",
    "mat2x3[4] f(out mat2x3[4] x)": None,
    "Inner f(Inner s)": None,
    "Outer f(inout Outer s)": None,
    "Inner[2] f(Outer s[3])": "Inner[2] f(Outer[3] s)",
    "Inner[2][3] f(out Inner[2][3] s)": None,
    "float f(sampler2D t, samplerCube c)": None,
    "float f(isampler2D t, sampler2DShadow s)": None,
    "float f(float a,\n\n      float b)": "float f(float a, float b)",
    "float f(float x_1, float _x)": None,
}


@pytest.mark.parametrize("declaration", DECLARATIONS)
def test_a_declaration_is_read_as_it_is_written(functions, declaration):
    result = declaration.removeprefix("highp ").removeprefix("mediump ").split(" f(")[0]
    body = "{}" if result == "void" else f"{{ {result} r; return r; }}"
    assert str(signature(functions, f"{STRUCTS}{declaration} {body}")) == (DECLARATIONS[declaration] or declaration)


def test_parameters_without_a_name_get_one_each(functions):
    assert str(signature(functions, "float f(float, vec2 y, int) { return y.x; }")) == (
        "float f(float unnamed_1, vec2 y, int unnamed_3)"
    )


def test_types_are_told_by_their_numbers(functions):
    found = signature(functions, "mat2x3[4] f(ivec3 v, bool b) { mat2x3[4] r; return r; }")
    assert found.result == Array(Numeric("float", rows=3, columns=2), 4)
    assert [p.type for p in found.parameters] == [Numeric("int", 3), Numeric("bool")]


def test_a_matrix_has_its_rows_first_in_numpy():
    """GLSL's mat2x3 has 2 columns of 3 rows."""
    assert Numeric("float", rows=3, columns=2).shape == (3, 2)


def test_inputs_and_outputs_follow_the_directions(functions):
    found = signature(functions, "float f(float a, out vec2 b, inout int c) { return a; }")
    assert [p.name for p in found.inputs] == ["a", "c"]
    assert [(name, str(kind)) for name, kind in found.outputs] == [("result", "float"), ("b", "vec2"), ("c", "int")]


def test_void_is_no_output(functions):
    assert [name for name, _ in signature(functions, "void f(out float x) { x = 1.0; }").outputs] == ["x"]


# ---- Structures ------------------------------------------------------------------------------------------------------


def test_structures_are_known_to_the_innermost(functions):
    inner = Struct((("x", Numeric("float")), ("y", Numeric("float", 2))), "Inner")
    outer = Struct((("one", inner), ("two", Array(inner, 2)), ("m", Numeric("float", 2, 2))), "Outer")
    found = signature(functions, f"{STRUCTS} Outer f(Outer s) {{ return s; }}")
    assert found.result == outer
    assert found.parameters[0].type == outer


TWINS = """
struct Point { float x; float y; };
struct Size { float x; float y; };
struct HasPoint { Point it; };
struct HasSize { Size it; };
"""


@pytest.mark.parametrize(
    "declaration",
    [
        "Point f(Size s)",
        "Size f(Point s)",
        "Point[2] f(Size[2] s)",
        "Size[2] f(Point[3] s)",
        "HasPoint f(HasSize s)",
        "HasSize[2] f(HasPoint[2] s)",
        "void f(out Size s, inout Point p)",
    ],
)
def test_structures_with_the_same_members_stay_apart(functions, declaration):
    result = declaration.split(" f(")[0]
    body = "{}" if result == "void" else f"{{ {result} r; return r; }}"
    assert str(signature(functions, f"{TWINS}{declaration} {body}")) == declaration


def test_what_a_structure_holds_is_named_after_its_own_declaration(functions):
    """The two differ in nothing but which of the twins they hold."""
    made = functions(f"{TWINS} HasSize f(Size s) {{ return HasSize(s); }}").f({"x": 1, "y": 2})
    assert type(made).__name__ == "HasSize"
    assert type(made.it).__name__ == "Size"


def test_structures_with_the_same_members_convert_by_hand(functions):
    swapped = functions(TWINS + "Size f(Point p) { return Size(p.y, p.x); }").f({"x": [1, 2], "y": 3})
    assert type(swapped).__name__ == "Size"
    np.testing.assert_array_equal(swapped.y, [1, 2])


@pytest.mark.parametrize(
    "declaration",
    [
        "struct S { float x; } g;",
        "uniform struct S { float x; } g;",
        "const struct S { float x; } G = S(1.0);",
        "struct { float y; } anonymous; struct S { float x; };",
        "struct S { float x; }; S g[2], h;",
    ],
)
def test_a_structure_is_found_wherever_it_is_declared(functions, declaration):
    assert str(signature(functions, declaration + "S f() { return S(2.0); }")) == "S f()"


def test_a_structure_within_a_function_is_its_own(functions):
    text = "struct S { float x; }; S f() { struct T { float y; } t; t.y = 3.0; return S(t.y); }"
    assert functions(text).f() == (3.0,)


# ---- Which functions, and where --------------------------------------------------------------------------------------


def test_functions_keep_their_order(functions):
    made = functions("float c() { return 1.0; }\nfloat a() { return 1.0; }\nfloat b() { return 1.0; }")
    assert repr(made).endswith("test.glsl: c, a, b>")


def test_a_prototype_is_no_function_of_its_own(functions):
    text = "float f(float x);\nfloat g() { return f(1.0); }\nfloat f(float x) { return x; }"
    assert signature(functions, text).origin[1] == 3


def test_a_prototype_without_a_body_is_not_there(functions):
    assert not hasattr(functions("float f(float x);\nfloat g() { return 1.0; }"), "f")


def test_overloads_are_all_there_in_order(functions):
    text = "float f(float x) { return x; }\nvec2 f(vec2 x) { return x; }\nfloat f(float x, int y) { return x; }"
    assert list(map(str, functions(text).f.signatures)) == [
        "float f(float x)",
        "vec2 f(vec2 x)",
        "float f(float x, int y)",
    ]


def test_main_is_no_function_to_call(functions):
    assert not hasattr(functions("out vec4 c;\nfloat f() { return 1.0; }\nvoid main() { c = vec4(f()); }"), "main")


def test_a_function_that_nothing_calls_is_there(functions):
    assert hasattr(functions("float f() { return 1.0; }\nfloat g() { return 2.0; }"), "g")


def test_a_function_hidden_by_an_if_is_not_there(functions):
    assert not hasattr(functions("#if 0\nfloat f() { return 1.0; }\n#endif\nfloat g() { return 2.0; }"), "f")


def test_a_function_made_by_a_macro_is_there(functions):
    made = functions("#define MAKE(T, name) T name(T x) { return x; }\nMAKE(float, f)\nMAKE(vec3, g)\n")
    assert str(made.g.signatures[0]) == "vec3 g(vec3 x)"
    assert made.g.signatures[0].origin[1] == 3


@pytest.mark.parametrize("macros", [{}, {"A": 1}, {"A": 1, "B": 2, "C(x)": "x"}])
@pytest.mark.parametrize("version", ["", "#version 400\n"])
def test_the_origin_is_the_line_in_the_file(functions, version, macros):
    """Whatever is put above it."""
    text = version + "// one\n\nfloat f() { return 1.0; }\n"
    (found,) = functions(text, defines=macros).f.signatures
    assert text.split("\n")[found.origin[1] - 1].startswith("float f")


def test_the_origin_of_a_head_on_several_lines_is_one_of_them(functions):
    line = signature(functions, "\n\nfloat\nf(float a,\n  float b)\n{\n    return a;\n}\n").origin[1]
    assert 3 <= line <= 5


def test_the_origin_is_in_the_included_file(tmp_path):
    (tmp_path / "inner.glsl").write_text("// first\nfloat inner() { return 1.0; }\n")
    (tmp_path / "outer.glsl").write_text('#include "inner.glsl"\n\nfloat outer() { return inner(); }\n')
    made = shader(tmp_path / "outer.glsl", defines={"N": 1})
    inner, outer = made.inner.signatures[0].origin, made.outer.signatures[0].origin
    assert (inner[0].endswith("inner.glsl"), inner[1]) == (True, 2)
    assert (outer[0].endswith("outer.glsl"), outer[1]) == (True, 3)


def test_the_docstring_tells_declaration_and_place(functions):
    doc = functions("\nfloat f(float x) { return x; }").f.__doc__
    assert doc.startswith("float f(float x)")
    assert doc.endswith("test.glsl:2]")


def test_a_text_that_does_not_compile_is_refused(functions):
    with pytest.raises(GlslError, match=r"test\.glsl:1: "):
        functions("float f() { return missing; }")


# ---- A file taken apart token by token -------------------------------------------------------------------------------

SMALL = """#version 330
struct S { float x; vec2 y[2]; } g;
layout(location = 0) out vec4 color;
uniform struct { float a; } u;
S f(const in S s, out float r) { r = s.x; return s; }
void main() { float r; if (g.x > 0.0) { color = vec4(f(g, r).x); } }
"""


@pytest.mark.parametrize("last", [False, True], ids=["without one word", "cut off after a word"])
def test_whatever_is_left_of_a_file_compiles_or_is_refused_in_plain_words(functions, last):
    words = SMALL.replace("(", " ( ").replace(")", " ) ").replace(";", " ; ").split(" ")
    refused = 0
    for k in range(len(words)):
        try:
            functions(" ".join(words[:k] if last else words[:k] + words[k + 1 :]))
        except GlslError as error:
            refused += 1
            assert error.message
    assert refused > len(words) / 3
