"""Uniforms that a called function reads, given by keyword."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, shader

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
layout(std140) uniform Block { float of_block; layout(row_major) mat2 turn, unread; float gains[2]; };
layout(std140) uniform Camera { vec4 eye; float near, far; } camera;
uniform Many { Spot spot; float q; } many[2];
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
vec2 block_turned(vec2 x) { return turn * x * gains[1]; }
float depth(float z) { return (z - camera.near) / (camera.far - camera.near); }
float several(float x) { return x * many[0].spot.x + many[1].q; }
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
        ("blocked", [3], {"of_block": 2}, 6),
        ("block_turned", [[1, 10]], {"turn": [[1, 2], [3, 4]], "gains": [0, 2]}, [42, 86]),
        ("depth", [5], {"camera.near": 1, "camera.far": 9}, 0.5),  # the block's other members are not asked for
        ("several", [5], {"many[0].spot.x": 2, "many[1].q": 3}, 13),
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
        ("blocked", 1, {}, "blocked reads the uniform float of_block: give it by its name"),
        ("depth", 1, {"camera.near": 1}, "depth reads the uniform float camera.far: give it by its name"),
        ("depth", 1, {"near": 1}, "depth(float z) has no parameter near and reads no such uniform"),
        ("depth", 1, {"camera.eye": [0, 0, 0, 1]}, "has no parameter camera.eye and reads no such uniform"),
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


# ---- Values that the file gives --------------------------------------------------------------------------------------

INITIALISED = """#version 430
uniform float gain = 2.0, bare, power = 3.0;
uniform vec3 tint = vec3(1, 2, 3);
uniform float weights[2] = float[2](5.0, 7.0);
const float K = 4.0; // no uniform, though it has a value
uniform float after;
float f(float x) { return gain * x; }
float both(float x) { return gain * x + power * bare * K; }
vec3 tinted(float x) { return tint * x; }
float weighted(int k) { return weights[k]; }
float last(float x) { return after * x; }
"""


def test_a_uniform_that_the_file_gives_a_value_has_it(functions, mode):
    made = functions(INITIALISED, mode=mode)
    assert made.f(3) == 6
    assert made.both(3, bare=1) == 6 + 12
    np.testing.assert_array_equal(made.tinted(2), [2, 4, 6])
    np.testing.assert_array_equal(made.weighted([0, 1]), [5, 7])


def test_a_call_that_gives_another_value_does_not_change_the_files(functions, mode):
    made = functions(INITIALISED, mode=mode)
    assert [made.f(3), made.f(3, gain=5), made.f(3), made.f(3, gain=7), made.f(3, gain=5)] == [6, 15, 6, 21, 15]
    assert made.both(3, bare=1, gain=1) == 3 + 12
    assert made.both(3, bare=1, power=1) == 6 + 4
    assert made.both(3, bare=1) == 6 + 12


@pytest.mark.parametrize(("name", "lacks"), [("both", "bare"), ("last", "after")])
def test_a_uniform_beside_those_with_a_value_has_none(functions, name, lacks):
    with pytest.raises(CallError, match=f"{name} reads the uniform float {lacks}: give it by its name"):
        functions(INITIALISED)[name](1)
