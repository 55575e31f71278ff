"""Mode mediump is IEEE's half precision, operation by operation; what GLSL ES 3.10 does not take is said so.

Expected values come from numpy's float16, which rounds each operation once, to nearest, ties to even, as IEEE 754 asks.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from harness import CallError, GlslError, native
from harness.calling import evaluation

HALF = np.float16
#: every half there is, NaN and Inf included, against four others
ALL = np.repeat(np.arange(1 << 16, dtype=np.uint16).view(HALF), 4)
OTHERS = np.random.default_rng(1).permutation(ALL)


@pytest.fixture
def half(functions):
    """Compiles a text in mode mediump; skips where the driver has no half precision."""
    native.open_context()
    if not evaluation._computes_in_half():
        pytest.skip("this driver computes mediump in single precision")
    return lambda text: functions(text, mode="mediump")


def test_llvmpipe_has_half_precision_where_the_processor_has():
    """What the other tests are skipped without."""
    native.open_context()
    flags = Path("/proc/cpuinfo")
    if "llvmpipe" not in native.context_info()["renderer"] or not (flags.is_file() and " f16c" in flags.read_text()):
        pytest.skip("another driver, or a processor without f16c")
    assert evaluation._computes_in_half()


def same(got, want) -> bool:
    """Bit for bit the halves wanted, but any NaN is as good as any other."""
    want = np.asarray(want)
    assert got.dtype == np.float32
    assert want.dtype == HALF
    want = want.astype(np.float32)
    return bool(((np.isnan(got) & np.isnan(want)) | (got.view(np.uint32) == want.view(np.uint32))).all())


# ---- Arithmetic ------------------------------------------------------------------------------------------------------

OPERATIONS = {
    "a + b": lambda a, b: a + b,
    "a - b": lambda a, b: a - b,
    "a * b": lambda a, b: a * b,
    "a / b": lambda a, b: a / b,
    "sqrt(a)": lambda a, b: np.sqrt(a),
    "-a": lambda a, b: -a,
    "a * 0.1": lambda a, b: a * HALF(0.1),
    "a + 0.0": lambda a, b: a + HALF(0),
    "a * 0.0": lambda a, b: a * HALF(0),
    "a * 3 + 2": lambda a, b: a * HALF(3) + HALF(2),
    "a * b + a": lambda a, b: a * b + a,
    "(a + b) - a": lambda a, b: (a + b) - a,
    "1.0 + a * a * (b - 1.0)": lambda a, b: HALF(1) + a * a * (b - HALF(1)),
    "a / b / a": lambda a, b: a / b / a,
    "floor(a * 3.0)": lambda a, b: np.floor(a * HALF(3)),
}


@pytest.mark.parametrize("written", OPERATIONS)
def test_every_operation_rounds_to_half(half, written):
    """For all halves: overflow to Inf, gradual underflow (denormals are kept), NaN."""
    got = half(f"float f(float a, float b) {{ return {written}; }}").f(ALL, OTHERS)
    with np.errstate(all="ignore"):
        assert same(got, OPERATIONS[written](ALL, OTHERS))


def test_numbers_are_rounded_to_half_on_the_way_in(half):
    """To nearest, ties to even: 65519 is below the middle of the largest half and what would follow it, 65520 is it."""
    x = np.float32(
        [1 + 2**-11, 1 + 3 * 2**-11, 0.1, 65519, 65520, 70000, -1e30, 2**-24, 2**-25, 1.01 * 2**-25, 1e-40, np.inf]
    )
    x = np.concatenate([x, np.random.default_rng(2).standard_normal(20_000).astype(np.float32)])
    with np.errstate(over="ignore"):
        assert same(half("float f(float x) { return x; }").f(x), x.astype(HALF))
        assert same(half("float f(float x) { return x * 3.0; }").f(x), x.astype(HALF) * HALF(3))


@pytest.mark.parametrize("written", ["a + b", "a - b", "a * b", "a / b", "sqrt(a)"])
def test_an_operation_is_one_on_the_rounded_numbers(half, written):
    """The driver would compute a single operation in single precision from what comes in."""
    a, b = np.random.default_rng(3).uniform(0.1, 10, (2, 20_000)).astype(np.float32)
    got = half(f"float f(float a, float b) {{ return {written}; }}").f(a, b)
    want = OPERATIONS[written](a.astype(HALF), b.astype(HALF))
    assert not np.array_equal(want, OPERATIONS[written](a, b).astype(HALF))
    assert same(got, want)


@pytest.mark.parametrize(
    ("text", "arguments", "want"),
    [
        ("float f(float a, float b) { return a + b; }", (1, 2**-11), 1),
        ("float f(float a, float b) { float s = a + b; return s - a; }", (2048, 1), 0),
        ("float f(float a) { return a * a; }", (256,), np.inf),
        ("float f(float a) { return a * 0.5; }", (2**-24,), 0),
        ("float g(float a) { return a * a; } float f(float a) { return g(a) - 65504.0; }", (255.9,), -32),
        ("bool f(float a, float b) { return a + b == a; }", (1, 2**-11), True),
        ("bool f(float a, float b) { return a == b; }", (1, 1 + 2**-12), True),
        ("float f(float a, float b) { return a < b ? 1.0 : 2.0; }", (1, 1 + 2**-12), 2),
        ("uint f(float a) { return floatBitsToUint(a); }", (1 + 2**-12,), 0x3F800000),
        ("int f(float a) { return int(a + 1.0); }", (2048,), 2048),
        ("float f(int i) { float x = float(i); return x + 1.0; }", (2048,), 2048),
        ("void f(float a, out float b, inout float c) { b = a + 1.0; c = c + b; }", (2048, 1), (2048, 2048)),
        ("float f(float a[2]) { float s[2]; s[1] = a[0] + a[1]; return s[1]; }", ([2048, 1],), 2048),
        ("vec2 f(mat2 m, vec2 v) { return m * v; }", ([[1, 2**-11], [0, 2]], [1, 1]), [1, 2]),
        ("struct S { float x; vec2 y; }; S f(S s) { s.x += s.y.y; return s; }", ({"x": 2048, "y": [0.1, 1]},),
         (2048, [HALF(0.1), 1])),
        ("float s = 0.0; float f(float a, float b) { s = a + b; return s - b; }", (2048, 1), 2047),
        ("float f(float a) { return a; } vec2 f(vec2 a, float b) { return a + b; }", ([2048, 0], 1), [2048, 1]),
        ("const float k = 2048.0; float f(float a) { return k + a; }", (1,), 2048),
        ("float f(float a) { return a + dFdx(a) + 1.0; }", (2048,), 2048),
    ],
)  # fmt: skip
def test_functions_run_in_half(half, text, arguments, want):
    """Each case is another in single precision."""
    got = half(text).f(*arguments)
    for g, w in zip(got, want, strict=True) if isinstance(got, tuple) else ((got, want),):
        np.testing.assert_array_equal(g, np.asarray(w, np.float32) if np.asarray(g).dtype.kind == "f" else w)


def test_a_uniform_is_rounded_too(half):
    made = half("uniform float u; uniform vec2 w[2]; float f(float x) { return x + u * 1.0 + w[1].y; }")
    assert made.f(1, u=2**-11, w=[[0, 0], [0, 0]]) == 1
    assert made.f(1, u=0, w=[[0, 0], [0, 2**-11]]) == 1


@pytest.mark.parametrize(
    ("text", "want"),
    [
        ("float f(highp float a, highp float b) { highp float s = a + b; return s - a == 0.0 ? 0.0 : 1.0; }", 1),
        ("highp float f(highp float a, highp float b) { return a + b; }", 1 + 2**-11),
        ("precision highp float; float f(float a, float b) { return a + b; }", 1 + 2**-11),
        ("struct S { highp float x; }; S f(highp float a, highp float b) { return S(a + b); }", 1 + 2**-11),
        ("void f(highp float a, highp float b, out highp float c) { c = a + b; }", 1 + 2**-11),
        ("float f(highp float a, float b) { return a + b; }", 1),
        ("highp vec2[2] f(highp float a, highp float b) { return vec2[2](vec2(a), vec2(a + b)); }",
         [[1, 1], [1 + 2**-11] * 2]),
    ],
)  # fmt: skip
def test_what_is_declared_highp_keeps_single_precision(half, text, want):
    got = half(text).f(1, 2**-11)
    np.testing.assert_array_equal(got[0] if isinstance(got, tuple) else got, np.float32(want))


def test_an_argument_that_is_declared_highp_comes_in_as_it_is(half):
    x = np.float32(1 + 2**-20)
    assert half("highp float f(highp float a) { return a; }").f(x) == x
    assert half("struct S { highp float x; float y; }; S f(S s) { return s; }").f({"x": x, "y": x}) == (x, 1)


def test_integers_stay_32_bits_wide(half):
    made = half(
        "uint f(uint x) { x ^= x >> 16; x *= 0x45d9f3bu; return x ^ (x >> 16); } int g(int x) { return x * 3; }"
    )
    x = np.uint32([1, 12345, 2**31, 2**32 - 1])
    y = (x ^ (x >> np.uint32(16))) * np.uint32(0x45D9F3B)
    np.testing.assert_array_equal(made.f(x), y ^ (y >> np.uint32(16)))
    assert made.g(100_001) == 300_003


def test_the_projects_shaders_run_in_half(root, half, library):
    """At roughness 1 nothing overflows: ten roundings of 2^-11 each, and what Schlick's fifth power makes of them."""
    brdf = library("brdf.glsl", mode="mediump")
    single = library("brdf.glsl")
    n = np.float32([0, 0, 1])
    angle = np.linspace(0.1, 1.2, 50)
    l = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)  # noqa: E741
    material = {"albedo": [0.8, 0.5, 0.2], "metalness": 0.5, "roughness": 1}
    got, want = brdf.shade(l, n, n, material), single.shade(l, n, n, material)
    assert not np.array_equal(got, want)
    np.testing.assert_allclose(got, want, rtol=30 * 2**-11)
    np.testing.assert_array_equal(got, got.astype(HALF).astype(np.float32))


# ---- What GLSL ES does not take --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("#version 400\n\nfloat f(float x) {\nreturn float(double(x)); }", 4),
        ("uniform sampler1D t;\nfloat f(float x) { return texture(t, x).x; }", 1),
        ("float f(float x) {\n\n  return x; }\nuniform sampler2DRect r;", 4),
    ],
)
def test_what_is_not_glsl_es_is_refused_in_its_line(half, text, line):
    made = half(text)
    with pytest.raises(GlslError) as caught:
        made.f(1)
    assert caught.value.line == line
    assert caught.value.file.endswith("test.glsl")
    assert caught.value.message.startswith(
        "in mode mediump the source is compiled as GLSL ES 3.10, which does not take"
    )


def test_it_says_so_in_an_included_file_too(tmp_path, functions, half):
    (tmp_path / "inner.glsl").write_text("float g(float x) {\n  return x; }\nuniform sampler2DRect r;\n")
    with pytest.raises(GlslError, match="in mode mediump") as caught:
        half('#include "inner.glsl"\nfloat f(float x) { return g(x); }').f(1)
    assert caught.value.file.endswith("inner.glsl")
    assert caught.value.line == 3


def test_a_driver_without_half_precision_is_refused(functions, monkeypatch):
    monkeypatch.setattr(evaluation, "_computes_in_half", lambda: False)
    with pytest.raises(CallError, match="computes it in single precision"):
        functions("float f(float x) { return x; }", mode="mediump").f(1)


def test_an_unknown_mode_is_refused(functions):
    with pytest.raises(CallError, match="no mode 'fast'; there are: as-written, precise, mediump"):
        functions("float f(float x) { return x; }", mode="fast")
