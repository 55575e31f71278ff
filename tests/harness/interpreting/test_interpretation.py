"""The interpreter as an engine of calls: its data, uniforms and errors, and float32 that is the driver's to the bit."""

from __future__ import annotations

import random

import numpy as np
import pytest
from command_line import main

from harness import CallError, GlslError, shader
from harness.interpreting.interpretation import LANES, PRECISIONS, Interpretation


def interpreted(function, precision="float32"):
    """The function of another shader object, evaluated by the interpreter."""
    (signature,) = function.signatures
    library = function._library
    library.compiled[signature, function.mode] = Interpretation(library.source, signature, precision)
    return function


def expression(choose: random.Random, depth: int) -> str:
    """A random expression of a, b and c, of operations that llvmpipe rounds as IEEE has them."""
    if depth == 0 or choose.random() < 0.1:
        return choose.choice(["a", "b", "c", "1.1", "3.3", "(-1.5)", "v.y", "v.z"])
    x, y, z = (expression(choose, depth - 1) for _ in range(3))
    forms = ["({x} + {y})", "({x} - {y})", "({x} * {y})", "({x} / {y})", "sqrt(abs({x}))", "floor({x})", "fract({x})"]
    forms += ["min({x}, {y})", "max({x}, {y})", "clamp({x}, -1.0, 2.0)", "mix({x}, {y}, {z})", "step({x}, {y})"]
    forms += ["({x} < {y} ? {z} : {x})", "chosen({x}, {y})", "dot(vec3({x}, {y}, {z}), v)", "length(vec2({x}, {y}))"]
    forms += ["abs({x})", "(-{x})", "ceil({x})", "trunc({x})", "mod({x}, 0.7)", "inversesqrt(abs({x}))", "summed({x})"]
    return choose.choice(forms).format(x=x, y=y, z=z)


@pytest.mark.parametrize("seed", range(2))
def test_random_expressions_agree_with_the_driver_to_the_bit(tmp_path, seed):
    """Where the result is finite; inputs and literals are such that no value is denormal, which the driver flushes.

    The sign of a zero is left out: of min(0, -0) it is open, and Mesa drops that of constants such as floor(0.1).
    """
    choose = random.Random(seed)
    vectors = range(8)
    outs = ", ".join(f"out vec4 r{k}" for k in vectors)
    lines = [f"r{k} = vec4({', '.join(expression(choose, 4) for _ in range(4))});" for k in vectors]
    text = """
    float chosen(float x, float y) { if (x > y) { if (x > 1.0) return x - y; y = -y; } else x += 0.5; return x * y; }
    float summed(float x) { float s = 0.0; for (int i = 0; i < 5; ++i) { if (s > x) break; s += 0.3 * x; } return s; }
    """
    path = tmp_path / "random.glsl"
    path.write_text(f"{text}\nvoid f(float a, float b, float c, vec3 v, {outs}) {{ {' '.join(lines)} }}\n")
    numbers = np.random.default_rng(seed)
    a, b, c = numbers.uniform(-4, 4, (3, 500)).astype(np.float32)
    v = numbers.uniform(-2, 2, (500, 3)).astype(np.float32)
    ours, driver = interpreted(shader(path).f), shader(path, mode="precise").f
    for got, want in zip(ours(a, b, c, v), driver(a, b, c, v), strict=True):
        ordinary = np.isfinite(got) & np.isfinite(want)
        assert ordinary.mean() > 0.3
        np.testing.assert_array_equal(got[ordinary], want[ordinary])


# ---- Double ----------------------------------------------------------------------------------------------------------


def test_double_takes_its_inputs_as_float32_and_gives_float64(functions):
    f = functions("float f(float x) { return x; }", mode="double").f
    assert f(0.1).dtype == np.float64
    assert f(0.1) == float(np.float32(0.1))


def test_with_mode_changes_to_double_and_back(functions):
    called = functions("float f(float x) { return x / 3.0; }")
    assert called.with_mode("double").f(1) == 1 / 3
    assert called.with_mode("double").with_mode("precise").f(1) == np.float32(1) / np.float32(3)


def test_the_command_line_has_double(root, capfd):
    arguments = ["call", str(root / "shaders/brdf.glsl"), "D_GGX", "NoH=1", "alpha=0.25", "--mode", "double"]
    assert main(arguments) == 0
    assert float(capfd.readouterr().out) == pytest.approx(16 / np.pi, rel=1e-14)


# ---- Data ------------------------------------------------------------------------------------------------------------

DATA = """
struct Inner { vec2 v; bool b; };
struct Outer { Inner inner[2]; mat2x3 m; int n[3]; };
Outer moved(Outer o, int k, out mat3x2 t, inout uvec3 u)
{
    o.inner[k].v.yx += vec2(1.0, 2.0);
    o.inner[1 - k].b = !o.inner[1 - k].b;
    o.m[k][2] = 9.0;
    o.n[k] = o.n[2] + o.n[k + 1];
    t = transpose(o.m);
    u[k] = u.z;
    return o;
}
float table(int k) { float t[4] = float[](0.5, 1.5, 2.5, 3.5); return t[k]; }
float component(vec3 v, int k) { return v[k]; }
float kept(vec3 v, int k, bool store) { if (store) v[k] = 7.0; return v[k]; }
vec3 placed(vec3 v, int k) { v[k] = 7.0; return v; }
"""


def test_structures_arrays_matrices_and_their_parts(functions):
    inner = [{"v": [[1, 2], [1, 2]], "b": [True, False]}, {"v": [3, 4], "b": True}]
    outer = {"inner": inner, "m": [[1, 2], [3, 4], [5, 6]], "n": [10, 20, 30]}
    got = functions(DATA, mode="double").moved(outer, [0, 1], [1, 2, 3])
    o = got.result
    assert o.inner[0].v.tolist() == [[3, 3], [1, 2]]
    assert o.inner[1].v.tolist() == [[3, 4], [5, 5]]
    assert o.inner[0].b.tolist() == [True, True]
    assert o.inner[1].b.tolist() == [False, True]
    assert o.m.tolist() == [[[1, 2], [3, 4], [9, 6]], [[1, 2], [3, 4], [5, 9]]]
    assert o.n.tolist() == [[50, 20, 30], [10, 60, 30]]
    assert got.t.tolist() == [[[1, 3, 9], [2, 4, 6]], [[1, 3, 5], [2, 4, 9]]]
    assert got.u.tolist() == [[3, 2, 3], [1, 3, 3]]


@pytest.mark.parametrize("many", [False, True])
def test_an_index_known_at_run_time_reads_and_writes_its_own_place(functions, many):
    called = functions(DATA, mode="double")
    v = [[4.0, 5, 6]] * 3 if many else [4.0, 5, 6]
    assert called.table([0, 3, 2]).tolist() == [0.5, 3.5, 2.5]
    assert called.component(v, [2, 0, 1]).tolist() == [6, 4, 5]
    assert called.placed(v, [2, 0, 1]).tolist() == [[4, 5, 7], [7, 5, 6], [4, 7, 6]]


def test_a_place_is_written_in_the_lanes_that_take_part(functions):
    assert functions(DATA, mode="double").kept([4, 5, 6], [0, 1, 2], [True, False, True]).tolist() == [7, 5, 7]


def test_an_index_beyond_the_end_is_that_of_the_end(functions):
    assert functions(DATA, mode="double").table([-5, 4, 1000]).tolist() == [0.5, 3.5, 3.5]


def test_a_batch_of_many_chunks_is_in_order_for_vectors_and_scalars(functions):
    x, v = np.arange(3 * LANES + 1.0), np.arange(3.0 * (3 * LANES + 1)).reshape(-1, 3)
    f = functions("vec3 f(float x, vec3 v, float w) { return x * v + w; }", mode="double").f
    np.testing.assert_array_equal(f(x, v, 2), x[:, None] * v + 2)


UNIFORMS = """
struct Light { vec3 colour; float power; };
uniform float gain;
uniform mat2x3 turn;
uniform float weights[3];
uniform Light lights[2];
uniform int unread;
uniform Block { float of_block; };
uniform sampler2D map;
float scale = gain * 2.0;
float gained(float x) { return x * gain; }
vec3 turned(vec2 v) { return turn * v; }
float weighted(int k) { return weights[k]; }
vec3 lit(float x) { return lights[1].colour * x; }
float scaled(float x) { return x * scale; }
float plain(float x) { return x; }
float blocked(float x) { return x * of_block; }
float sampled(float x) { return x > 0.0 ? texture(map, vec2(x)).r : x; }
"""


def test_uniforms_are_given_by_their_names(functions):
    called = functions(UNIFORMS, mode="double")
    assert called.gained(3, gain=2) == 6
    assert called.turned([1, 10], turn=[[1, 2], [3, 4], [5, 6]]).tolist() == [21, 43, 65]
    assert called.weighted([0, 2], weights=[1, 2, 3]).tolist() == [1, 3]
    assert called.lit(2, **{"lights[1].colour": [1, 2, 3]}).tolist() == [2, 4, 6]
    assert called.plain(4) == 4


def test_a_global_that_begins_with_a_uniform_follows_it(functions):
    called = functions(UNIFORMS, mode="double")
    assert called.scaled(1, gain=2) == 4
    assert called.scaled(1, gain=5) == 10


@pytest.mark.parametrize(
    ("name", "given", "message"),
    [
        ("gained", {}, "gained reads the uniform float gain: give it by its name"),
        ("scaled", {}, "scaled reads the uniform float gain: give it by its name"),
        ("plain", {"gain": 1}, "has no parameter gain and reads no such uniform"),
        ("lit", {"lights[0].colour": [1, 2, 3], "lights[1].colour": [1, 2, 3]}, "no parameter lights"),
        ("blocked", {}, "blocked reads the uniform float of_block: give it by its name"),
        ("sampled", {}, "test.glsl:18: a texture or image has no double version"),
    ],
)
def test_a_uniform_that_does_not_fit_is_refused(functions, name, given, message):
    with pytest.raises(CallError, match=message):
        functions(UNIFORMS, mode="double")[name](1, **given)


# ---- What has no version in an arithmetic ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("expression", "what"),
    [
        ("dFdx(x)", "a derivative"),
        ("intBitsToFloat(floatBitsToInt(x))", "the bit pattern of a float"),
        ("texture(map, vec2(x)).r", "a texture or image"),
        ("texelFetch(map, ivec2(0), 0).r", "a texture or image"),
        ("gl_FragCoord.x", "gl_FragCoord"),
    ],
)
def test_what_has_no_double_version_is_refused_with_its_line(functions, tmp_path, expression, what):
    text = f"uniform sampler2D map;\nfloat f(float x)\n{{\n    if (x < 0.0) return x;\n    return {expression};\n}}\n"
    text = "#version 400\n" + text
    called = functions(text, mode="double")
    with pytest.raises(CallError, match=f"^{tmp_path / 'test.glsl'}:6: {what}.* has no double version"):
        called.f([-1, 1])
    assert called.f([-1, -2]).tolist() == [-1, -2]  # not reached, not refused


def test_a_mistake_in_an_included_file_is_told_there(tmp_path):
    (tmp_path / "part.glsl").write_text("\nfloat g(float x) { while (true) x = x; return x; }\n")
    (tmp_path / "main.glsl").write_text('#include "part.glsl"\nfloat f(float x) { return g(x); }\n')
    with pytest.raises(CallError, match="part.glsl:2: a loop does not end"):
        shader(tmp_path / "main.glsl", mode="double").f(1)


def test_a_function_without_a_body_is_refused(functions):
    called = functions(
        "float g(float x); float f(float x) { return g(x); } float h(float x) { return x; }", mode="double"
    )
    assert called.h(1) == 1
    with pytest.raises(GlslError, match="No function definition"):
        called.f(1)


def test_recursion_is_refused(functions):
    with pytest.raises(GlslError, match="Recursion"):
        functions("float f(float x) { return x < 1.0 ? x : f(x - 1.0); }", mode="double").f(1)


def test_there_are_three_precisions():
    assert set(PRECISIONS) == {"float32", "float64", "float16"}
