"""The trace of a call: every float on the way, named, with file and line; where a hidden NaN begins."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from harness import CallError, shader
from harness.interpreting import trace as traces


def lines_of(text: str, marker: str) -> list[int]:
    return [n for n, line in enumerate(text.splitlines(), 1) if marker in line]


STEPS = """
struct Pair { float a; vec2 b; };
float helper(float x, out float doubled, inout Pair p)
{
    doubled = x * 2.0;
    p.b.y = doubled;
    return x + doubled;
}
float f(float x, vec3 v, int n)
{
    const float K = 0.5;
    Pair p = Pair(x, v.xy);
    float d;
    float h = helper(x * K, d, p);
    vec3 w = v;
    w.zx = vec2(h, d);
    float t[3];
    t[1] = dot(w, v);
    t[n] = -x;
    mat2x3 m = mat2x3(v, w);
    return x > 0.0 ? t[1] * p.b.y : (h - d) * m[1].z;
}
"""


@pytest.fixture
def traced(functions):
    return functions(STEPS).f.trace([1, -2], [[1, 2, 3], [4, 5, 6]], 0)


def test_every_float_is_there_in_the_order_of_its_making(traced):
    assert [local.name for local in traced] == [
        *("x", "v", "K", "p.a", "p.b", "x * K"),
        *("x", "p.a", "p.b", "doubled", "p.b.y", "helper()"),
        *("d", "p.a", "p.b", "h", "w", "w.z", "w.x", "t[1]", "t[n]", "m"),
        *("t[1] * p.b.y", "h - d", "(h - d) * m[1].z", "f()"),
    ]


def test_each_has_the_line_where_it_is_made(traced):
    where = {local.name: local.line for local in traced}
    for name, text in {
        "doubled": "doubled = x",
        "w.z": "w.zx",
        "t[n]": "t[n]",
        "h - d": "return x >",
        "m": "mat2x3 m",
    }.items():
        assert [where[name]] == lines_of(STEPS, text)


def test_values_are_those_of_float32(traced):
    values = {local.name: local.values for local in traced}
    assert values["h"].tolist() == [1.5, -3]
    assert values["w.x"].tolist() == [1, -2]
    assert values["t[1]"].tolist() == [1 + 4 + 4.5, -8 + 25 - 18]
    assert values["h"].dtype == np.float32
    np.testing.assert_array_equal(traced.result, [(1 + 4 + 4.5) * 1, (-3 + 2) * -3])


def test_what_one_value_has_comes_after_the_batch(traced):
    shapes = {local.name: local.values.shape for local in traced}
    assert (shapes["h"], shapes["v"], shapes["m"]) == ((2,), (2, 3), (2, 3, 2))
    m = traced["m"][0].values
    assert m[0].tolist() == [[1, 1], [2, 2], [3, 1.5]]


def test_what_is_not_executed_is_nan_and_said_so(traced):
    (product,), (difference,) = traced["t[1] * p.b.y"], traced["h - d"]
    assert product.executed.tolist() == [True, False]
    assert difference.executed.tolist() == [False, True]
    np.testing.assert_array_equal(product.values, [9.5, np.nan])
    np.testing.assert_array_equal(difference.values, [np.nan, -1])
    assert not product.non_finite.any()
    assert traced.first_non_finite() is None


def test_a_call_of_scalars_has_no_batch(functions):
    trace = functions(STEPS).f.trace(1, [1, 2, 3], 0)
    assert trace["h"][0].values.shape == trace["h"][0].executed.shape == ()
    assert trace.result == np.float32(9.5)


def test_a_batch_has_the_shape_of_its_arguments(functions):
    trace = functions(STEPS).f.trace([[1], [-1]], np.ones((4, 3)), 0)
    assert trace["w"][0].values.shape == (2, 4, 3)
    assert trace["h - d"][0].executed.shape == (2, 4)


@pytest.mark.parametrize("precision", ["float16", "float32", "float64"])
def test_the_precision_is_that_asked_for(functions, precision):
    trace = functions("float f(float x) { float third = x / 3.0; return third * 0.1; }").f.trace(1, precision=precision)
    kind = np.dtype(precision).type
    assert trace["third"][0].values.dtype == precision
    assert trace["third"][0].values == kind(1) / kind(3)
    assert trace.result == kind(1) / kind(3) * kind(0.1)


HIDDEN = {
    "max(0/0, 0)": ("float f(float x) { return max(x / x, 0.0); }", [1, 0], "x / x", (1,)),
    "in a variable": ("float f(float x) { float y = x / x; return clamp(y, 0.0, 1.0); }", [1, 0], "y", (1,)),
    "in a component": (
        "float f(float x) { vec3 v = vec3(1.0); v.y = sqrt(x); return max(v.y, 0.0) + v.x; }",
        [1, -1],
        "v.y",
        (1,),
    ),
    "in a function called": (
        "float g(float x) { return log(x); } float f(float x) { return min(g(x), 1.0); }",
        [1, 2, -1],
        "g()",
        (2,),
    ),
    "Inf before NaN": ("float f(float x) { float y = 1.0 / x; return max(y - y, 0.0); }", [1, 0], "y", (1,)),
    "overflow": ("float f(float x) { return 1.0 / (x * x); }", [1, 1e30], "x * x", (1,)),
    "in a branch": (
        "float f(float x) { float y = 0.0; if (x < 0.0) y = sqrt(x); return max(y, 0.0); }",
        [1, -4],
        "y",
        (1,),
    ),
    "normalize(0)": ("float f(float x) { return max(normalize(vec3(x)).x, 0.0); }", [1, 0], "normalize(vec3(x))", (1,)),
    "constants alone": ("float f(float x) { return max(0.0 / 0.0, x); }", [1, 2], "0.0 / 0.0", (0,)),
    "never assigned": ("float f(float x) { float y; return max(y * x, 0.0); }", [1, 2], "y * x", (0,)),
}


@pytest.mark.parametrize("case", HIDDEN)
def test_the_origin_of_a_hidden_nan_is_found(functions, case):
    text, x, name, element = HIDDEN[case]
    called = functions(text)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        trace = called.f.trace(x)
    assert np.isfinite(trace.result).all()
    origin = trace.first_non_finite()
    assert (origin.name, origin.element) == (name, element)


NOT_HIDDEN = {
    "a branch not taken": ("float f(float x) { if (x < 0.0) return sqrt(x); return x; }", [1, 4]),
    "the other side of ?:": ("float f(float x) { return x > 0.0 ? log(x) + 1.0 : 0.0; }", [1, 0]),
    "after a loop was left": (
        "float f(float x) { for (int i = 0; i < 3; ++i) { if (x < 1.0) break; x = sqrt(x - 1.0); } return x; }",
        [1, 0.5, 5],
    ),
    "an argument": ("float f(float x) { return max(x * 2.0, 0.0); }", [1, np.nan, np.inf]),
}


@pytest.mark.parametrize("case", NOT_HIDDEN)
def test_what_is_not_computed_or_was_given_is_no_origin(functions, case):
    text, x = NOT_HIDDEN[case]
    assert functions(text).f.trace(x).first_non_finite() is None


def test_nothing_is_executed_after_a_discard(functions):
    text = "float g(float x) { if (x < 0.0) discard; return x; } float f(float x) { float y = g(x) * 2.0; return y; }"
    trace = functions(text).f.trace([1, -1])
    assert trace["y"][0].executed.tolist() == [True, False]
    np.testing.assert_array_equal(trace.result, [2, np.nan])


def test_a_loop_has_each_of_its_rounds(functions):
    text = "float f(float x) { float y = 8.0; for (int i = 0; i < 4; ++i) { if (y <= x) break; y -= 2.0; } return y; }"
    rounds = functions(text).f.trace([0, 5])["y"]
    assert [local.executed.tolist() for local in rounds] == [[True, True]] * 3 + [[True, False]] * 2
    np.testing.assert_array_equal([local.values for local in rounds[:4]], [[8, 8], [6, 6], [4, 4], [2, np.nan]])


def test_the_origin_in_a_loop_is_the_round_where_it_begins(functions):
    text = (
        "float f(float x) { float y = 0.0; for (int i = 0; i < 4; ++i) y += sqrt(x - float(i)); return max(y, 0.0); }"
    )
    trace = functions(text).f.trace([3, 1.5, 0.5])
    origin = trace.first_non_finite()
    assert origin.name == "sqrt(x - float(i))"
    assert origin.element == (2,)
    assert trace["sqrt(x - float(i))"].index(origin.local) == 1


def test_lines_are_those_of_the_users_files(tmp_path):
    part = "#define HALF(x) ((x) * 0.5)\n\nfloat g(float x)\n{ return HALF(x) / x; }\n"
    (tmp_path / "part.glsl").write_text(part)
    (tmp_path / "main.glsl").write_text('\n#include "part.glsl"\nfloat f(float x)\n{\n    return max(g(x), 0.0);\n}\n')
    origin = shader(tmp_path / "main.glsl").f.trace(0).first_non_finite()
    assert origin.file.endswith("part.glsl")
    assert origin.line == 4
    assert str(origin).endswith("part.glsl:4: g() is nan")


def test_a_trace_reads_as_a_table(functions):
    text = "float f(float x)\n{\n    float y = sqrt(x);\n    return max(y, 0.5);\n}\n"
    trace = functions(text).f.trace([[4, -1, 9]])
    lines = str(trace).splitlines()
    assert lines[0] == "trace of float f(float x)"
    assert [line.split() for line in lines[1:5]] == [
        ["name", "min", "max", "not", "finite"],
        [f"{trace[0].file}:1", "x", "-1", "9"],
        [f"{trace[0].file}:3", "y", "2", "3", "1"],
        [f"{trace[0].file}:4", "f()", "0.5", "3"],
    ]
    assert lines[5].endswith("test.glsl:3: y is nan at element (0, 1)")
    assert repr(trace["y"][0]).endswith("test.glsl:3: y, 1 of 3 not finite>")


def test_a_function_that_yields_nothing_is_traced_too(functions):
    trace = functions("float g = 0.0; void f(float x) { g = x / x; }").f.trace([1, 0])
    assert trace.result == ()
    assert trace.first_non_finite().name == "g"


def test_uniforms_and_structures_are_given_as_in_a_call(functions):
    text = "struct S { float a; vec2 b; }; uniform float u; float f(S s) { return s.a * u + s.b.x; }"
    trace = functions(text).f.trace({"a": [1, 2], "b": [3, 4]}, u=10)
    assert [local.name for local in trace] == ["s.a", "s.b", "s.a * u", "f()"]
    assert trace.result.tolist() == [13, 23]


def test_a_long_expression_is_shortened(functions):
    text = "float f(float x) { return max(" + " + ".join(["x * 0.123456"] * 20) + ", 0.0); }"
    assert max(len(local.name) for local in functions(text).f.trace(1)) <= 48


def test_an_unknown_precision_lists_those_that_there_are(functions):
    with pytest.raises(CallError, match="no precision 'double'; there are: float32, float64, float16"):
        functions("float f(float x) { return x; }").f.trace(1, precision="double")


def test_what_does_not_fit_in_memory_is_refused(functions, monkeypatch):
    monkeypatch.setattr(traces, "BYTES_MAX", 1 << 20)
    called = functions("float f(float x) { float y = 0.0; for (int i = 0; i < 300; ++i) y += x; return y; }")
    assert len(called.f.trace(np.ones(100))) > 300
    with pytest.raises(CallError, match="trace fewer elements at once"):
        called.f.trace(np.ones(10_000))


def test_the_shading_model_is_finite_on_its_way_and_the_exercises_is_not(library):
    l, v, n = [0, 0, 1], [0, 0, -1], [0, 0, 1]  # noqa: E741
    material = {"albedo": [1, 1, 1], "metalness": 0, "roughness": 0.5}
    brdf = library("brdf.glsl")
    assert brdf.shade.trace(l, v, n, material).first_non_finite() is None
    assert brdf.shade_exercise.trace(l, v, n, material).first_non_finite().name == "h"
