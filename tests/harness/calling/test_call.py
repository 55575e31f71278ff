"""The functions of a file, by name: those of its includes, behind its macros, of an entry point; and their list."""

from __future__ import annotations

import copy
import re

import numpy as np
import pytest
from glsl_values import assert_same_bits

from harness import shader

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


# ---- The list of them ------------------------------------------------------------------------------------------------

LISTED = "float f(float x) { return x; } float f(vec2 x) { return x.x; } float _g(float x) { return x; }"


def test_a_function_by_attribute_is_that_by_index(shared):
    assert shared["as-written"].sum is shared["as-written"]["sum"]


def test_functions_are_listed(functions):
    made = functions(LISTED)
    assert {"f", "_g", "with_mode"} <= set(dir(made))
    assert [f.__name__ for f in made] == ["f", "_g"]
    assert re.fullmatch(r"<shader \S*test\.glsl: f, _g>", repr(made))
    assert repr(made.f) == "<GLSL float f(float x); float f(vec2 x)>"


def test_keys_are_completed_to_functions_and_to_overloads(functions):
    """IPython asks for them after made[\"."""
    made = functions(LISTED)
    keys = made._ipython_key_completions_()
    assert keys == ["f", "_g", "f(float)", "f(vec2)", "_g(float)"]
    assert all(made[key] for key in keys)


def test_a_name_that_begins_with_an_underscore_is_one(functions):
    assert functions(LISTED)._g(2) == 2


def test_it_can_be_copied(functions):
    """Python's copies ask an object for attributes before it has any."""
    assert copy.copy(functions(LISTED))._g(2) == 2


def test_its_mode_is_told(functions):
    made = functions(LISTED, mode="precise")
    assert (made.mode, made.f.mode, made.with_mode("as-written").mode) == ("precise", "precise", "as-written")
