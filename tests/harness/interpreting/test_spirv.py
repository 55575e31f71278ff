"""A SPIR-V module read into dataclasses: what glslang wrote of a text whose parts are known."""

from __future__ import annotations

import numpy as np
import pytest

from harness import native
from harness.interpreting import spirv
from harness.native import Stage

TEXT = """#version 330
struct Inner { mat2x3 m; bool flag; };
struct Outer { Inner inner[2]; uvec4 u; };
uniform float gain[3];
vec3 state = vec3(-0.5);
float twice(float x)
{
    float doubled = x * 2.0;
    return doubled;
}
float looped(const in int n, inout float y, Outer o)
{
    while (y < 1e30)
        y += twice(y) + o.inner[1].m[0].x + gain[n] + state.x;
    return y;
}
void main() { float y; Outer o; looped(3, y, o); }
"""


@pytest.fixture(scope="module")
def module():
    return spirv.read(native.glsl_spirv(Stage.FRAGMENT, TEXT))


def function(module, name):
    return next(f for f in module.functions.values() if f.name == name)


def test_functions_have_their_names_parameters_and_results(module):
    looped = function(module, "looped")
    assert [(name, str(kind.element if kind.kind == "pointer" else kind)) for _, kind, name in looped.parameters] == [
        ("n", "int"),
        ("y", "float"),
        ("o", "Outer"),
    ]
    assert str(looped.result) == "float"
    assert module.functions[module.entry].name == "main"


def test_a_structure_has_its_members_in_order(module):
    outer = function(module, "looped").parameters[2][1].element
    assert [(name, str(kind)) for name, kind in outer.members] == [("inner", "Inner[2]"), ("u", "uvec4")]
    inner = outer.members[0][1].element
    assert [(name, str(kind)) for name, kind in inner.members] == [("m", "mat2x3"), ("flag", "bool")]


def test_a_matrix_is_columns_of_rows(module):
    matrix = function(module, "looped").parameters[2][1].element.members[0][1].element.members[0][1]
    assert matrix.shape == (2, 3)
    assert matrix.number.kind == "float"


def test_what_holds_a_structure_has_no_number(module):
    assert function(module, "looped").parameters[2][1].element.number is None


def test_global_variables_have_their_storage(module):
    storage = {v.name: (v.storage, str(v.type)) for v in module.variables.values()}
    assert storage == {"gain": (spirv.UNIFORM_CONSTANT, "float[3]"), "state": (spirv.PRIVATE, "vec3")}


def test_instructions_have_the_line_of_their_text(module):
    lines = {i.line for block in function(module, "twice").blocks for i in block.instructions}
    assert lines == {8, 9}


def test_a_loop_is_known_by_the_line_where_it_begins(module):
    assert [block.loop for block in function(module, "looped").blocks if block.loop] == [13]


def test_a_float_constant_has_its_bits(module):
    floats = {c.bits for c in module.constants.values() if c.type.kind == "float"}
    assert {int(np.float32(x).view(np.uint32)) for x in (2.0, 1e30, -0.5)} <= floats


def test_a_double_is_spelled_so():
    text = "#version 400\ndvec3 f(double x) { return dvec3(x); }\nvoid main() { f(1.0lf); }\n"
    f = function(spirv.read(native.glsl_spirv(Stage.FRAGMENT, text)), "f")
    assert str(f.result) == "dvec3"
    assert str(f.parameters[0][1].element) == "double"


@pytest.mark.parametrize("words", [[], [1, 2, 3, 4, 5], [0x03022307, 0, 0, 0, 0]])
def test_other_words_are_refused(words):
    with pytest.raises(ValueError, match="not a SPIR-V module"):
        spirv.read(np.array(words, np.uint32))
