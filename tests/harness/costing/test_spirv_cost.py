"""The weighted count of SPIR-V operations: the weights one by one, and how well they stand for a GPU."""

from __future__ import annotations

import numpy as np
import pytest

from harness import ladder, shader
from harness.costing import isa, spirv_cost


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("float f(float x, float y) { return x + y; }", 1),
        ("vec3 f(vec3 x, vec3 y) { return x * y - x; }", 6),
        ("vec3 f(vec3 x) { return -x; }", 0),
        ("vec3 f(vec3 x) { return abs(x).zyx; }", 0),
        ("vec3 f(vec3 x) { return clamp(x, 0.0, 1.0); }", 0),
        ("float f(float x, float y) { return clamp(x, 0.0, y); }", 2),
        ("float f(vec3 x, vec3 y) { return dot(x, y); }", 3),
        ("vec3 f(vec3 x, float y) { return x * y; }", 3),
        ("float f(float x, float y) { return x / y; }", 5),
        ("float f(float x) { return x / 3.0; }", 1),
        ("vec2 f(vec2 x) { return sqrt(x); }", 8),
        ("float f(float x) { return pow(x, 5.0); }", 9),
        ("vec3 f(vec3 x) { return normalize(x); }", 10),
        ("vec3 f(vec3 x, vec3 y) { return cross(x, y); }", 6),
        ("vec3 f(mat3 m, vec3 x) { return m * x; }", 9),
        ("mat3 f(mat3 m, mat3 x) { return m * x; }", 27),
        ("float f(float x, float y) { return x > y ? x : y; }", 2),
        ("float g(float x) { return sqrt(x); } float f(float x) { return g(x) + g(g(x)); }", 13),
        ("float g(float x) { return sqrt(x); } float f(float x) { return x * x; }", 1),
        ("float f(float x) { if (x > 1.0) return sqrt(x); return exp2(x); }", 9),
        ("ivec2 f(ivec2 x, bool b) { return x; }", 0),
    ],
)
def test_the_weight_of(functions, text, count):
    assert spirv_cost.weighted_count(functions(text).f) == count


@pytest.fixture
def variants(root):
    """shade() by products, and by pow."""
    brdf = root / "shaders" / "brdf.glsl"
    return [shader(brdf, {"BRDF_F": rung}).shade for rung in ("F_MULTIPLY", "F_POW")]


def test_pow_is_dearer_than_products(variants):
    """Counting all operations alike says the opposite."""
    exact, by_pow = map(spirv_cost.weighted_count, variants)
    assert by_pow > exact


@pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))
def test_the_count_goes_with_the_cycles_of_gcn(root):
    """.997 was found over every rung of shade(), from .83 to 2 times the default's cycles."""
    steps = ladder.load(root / "shaders" / "ladder.toml")
    rungs = [{term.macro: rung.value} for term in steps.terms if term.file == "brdf.glsl" for rung in term.rungs]
    found = [shader(root / "shaders" / "brdf.glsl", defines).shade for defines in rungs]
    counts = [spirv_cost.weighted_count(function) for function in found]
    cycles = [cost.inverse_throughput for cost in isa.costs(found, "vega10")]
    assert np.corrcoef(counts, cycles)[0, 1] > 0.99
