"""The project's functions interpreted: in float32 they are the driver's ``precise`` to the bit, in double formulas."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import reference
from extremes import extremes

from harness import shader
from harness.interpreting.interpretation import Interpretation


def interpreted(function, precision="float32"):
    """The function of another shader object, evaluated by the interpreter."""
    (signature,) = function.signatures
    library = function._library
    library.compiled[signature, function.mode] = Interpretation(library.source, signature, precision)
    return function


def assert_same_bits(got, want):
    """Equal, the signs of zeros too; NaN is NaN, whatever its bits."""
    assert got.dtype == want.dtype
    np.testing.assert_array_equal(got, want)
    np.testing.assert_array_equal(np.signbit(got) & (got == 0), np.signbit(want) & (want == 0))


RANDOM = np.random.default_rng(8)
N = 20_000
T, S, R = RANDOM.random((3, N)).astype(np.float32)
C = RANDOM.random((N, 3)).astype(np.float32)
L_, V_, NORMAL, MATERIAL = extremes(N, 3)

EXACT = [
    ("brdf.glsl", "D_GGX", (T, S), {}),
    ("brdf.glsl", "V_SmithGGXCorrelated", (T, S, R), {}),
    ("brdf.glsl", "V_Hammon", (T, S, R), {}),
    ("brdf.glsl", "F_Schlick", (C, T), {}),
    ("brdf.glsl", "schlick_weight", (T,), {}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {"BRDF_D": "D_EXERCISE", "BRDF_V": "V_HAMMON"}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {"BRDF_DIFFUSE": "DIFFUSE_LAMBERT"}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {"BRDF_D": "D_PROJECT", "BRDF_F": "F_F82"}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {"BRDF_D": "D_HALF", "BRDF_DIFFUSE": "DIFFUSE_EON"}),
    ("brdf.glsl", "shade", (L_, V_, NORMAL, MATERIAL), {"BRDF_F": "F_DIELECTRIC", "BRDF_MULTI": "MULTI_FITTED"}),
    ("brdf.glsl", "shade_exercise", (L_, V_, NORMAL, MATERIAL), {}),
    ("color.glsl", "srgb_to_linear", (C * 1.5 - 0.2,), {"SRGB_DECODE": "SRGB_CUBIC"}),
    ("color.glsl", "tone_map", (C * 6 - 1,), {"TONE_CURVE": "TONE_REINHARD"}),
    ("color.glsl", "tone_map", (C * 6 - 1,), {}),
    ("normal_map.glsl", "decode_normal", (C,), {"NORMAL_MAP_DX": 1}),
    ("normal_map.glsl", "perturb_normal", (NORMAL, V_, C), {}),
    ("normal_map.glsl", "perturb_normal_mirrored", (NORMAL, V_, np.float32(-1), C), {}),
]


@pytest.mark.parametrize(("file", "name", "arguments", "defines"), EXACT, ids=lambda p: p if isinstance(p, str) else "")
def test_float32_is_the_drivers_precise_arithmetic(root, library, file, name, arguments, defines):
    ours = interpreted(shader(root / "shaders" / file, defines=defines)[name])
    assert_same_bits(ours(*arguments), library(file, "precise", **defines)[name](*arguments))


#: (function, macros, ulp): what llvmpipe's pow is off by, measured; ours is the nearest float32
TRANSCENDENTAL = [
    ("brdf.glsl", "schlick_weight", (T,), {"BRDF_F": "F_POW"}, 100),
    ("color.glsl", "srgb_to_linear", (C,), {}, 40),
    ("color.glsl", "srgb_to_linear", (C,), {"SRGB_DECODE": "SRGB_PIECEWISE"}, 40),
    ("color.glsl", "linear_to_srgb", (C,), {}, 40),
]


@pytest.mark.parametrize(("file", "name", "arguments", "defines", "ulp"), TRANSCENDENTAL)
def test_with_pow_float32_is_near_the_driver(root, library, file, name, arguments, defines, ulp):
    ours = interpreted(shader(root / "shaders" / file, defines=defines)[name])
    np.testing.assert_array_max_ulp(ours(*arguments), library(file, "precise", **defines)[name](*arguments), ulp)


# ---- Double ----------------------------------------------------------------------------------------------------------

COSINES = [0.0, 1e-7, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0]
ALPHAS = [1e-6, 1e-3, 0.05, 0.3, 1.0]
EPSILON = 2.0**-52


def rounded(*values):
    return [float(np.float32(v)) for v in values]


def test_double_D_is_the_formula(root):
    """Few roundings; 1 + NoH^2 (alpha^2 - 1) loses up to what it is smaller than 1 by. PI has 15 digits: 1.1e-15."""
    f = shader(root / "shaders/brdf.glsl", mode="double").D_GGX
    for cosine in rounded(*COSINES):
        for alpha in rounded(*ALPHAS):
            want = reference.D_GGX(cosine, alpha)
            loss = 1 / (1 + mp.mpf(cosine) ** 2 * (mp.mpf(alpha) ** 2 - 1))
            assert abs(f(cosine, alpha) / want - 1) < 2e-15 + 8 * EPSILON * loss


@pytest.mark.parametrize("name", ["V_SmithGGXCorrelated", "V_Hammon"])
def test_double_V_is_the_formula(root, name):
    """A dozen roundings, nothing cancels: 1 - alpha^2 below, for the product of NoV with it is subtracted from NoV."""
    f = shader(root / "shaders/brdf.glsl", mode="double")[name]
    for cosines in [(c, d) for c in rounded(*COSINES[1:]) for d in rounded(*COSINES[1:])]:
        for alpha in rounded(*ALPHAS):
            want = getattr(reference, name)(*cosines, alpha)
            assert abs(f(*cosines, alpha) / want - 1) < 16 * EPSILON


@pytest.mark.parametrize("rung", ["F_MULTIPLY", "F_POW"])
def test_double_F_is_the_formula(root, rung):
    """(1 - LoH)^5 magnifies the rounding of 1 - LoH, which is exact or half an ulp, fivefold; pow is off by an ulp."""
    f = shader(root / "shaders/brdf.glsl", {"BRDF_F": rung}, mode="double").F_Schlick
    for cosine in rounded(*COSINES, 0.3):
        want = [reference.F_Schlick(F0, cosine) for F0 in rounded(0.04, 0.5, 1.0)]
        got = f(rounded(0.04, 0.5, 1.0), cosine)
        assert all(abs(g / w - 1) < 16 * EPSILON for g, w in zip(got, want, strict=True))


def test_double_shade_is_the_model_where_the_vectors_are_exactly_unit(root):
    """l, v, n along the axes: no rounding of vectors comes between the shader and the formulas, in 40 roundings."""
    f = shader(root / "shaders/brdf.glsl", mode="double").shade
    up, z = reference.vector(0, 0, 1), [0, 0, 1]
    for albedo, metalness in reference.MATERIALS:
        for roughness in (0.02, 0.2, 0.5, 1.0):
            single = reference.Material(tuple(rounded(*albedo)), *rounded(metalness, roughness))
            want = reference.shade(up, up, up, single)
            got = f(z, z, z, {"albedo": albedo, "metalness": metalness, "roughness": roughness})
            assert all(abs(g - w) <= 40 * EPSILON * abs(w) for g, w in zip(got, want, strict=True))


def test_double_shade_is_nearer_the_model_than_float32(root):
    """What remains is that float32 vectors are not quite unit (1e-7), which a half vector at roughness 0.5 multiplies
    by less than 20; a third of it at least is gone with the round-off."""
    scenes = [s for s in reference.random_scenes(60, 4) if s.material.roughness > 0.3]
    vectors = [np.array([reference.rounded(getattr(s, a)) for s in scenes]) for a in "lvn"]
    names = ("albedo", "metalness", "roughness")
    material = {a: np.array([getattr(s.material, a) for s in scenes], np.float32) for a in names}
    exact = [[reference.vector(*map(float, row)) for row in rows] for rows in vectors]
    want = [reference.shade(*three, s.material) for *three, s in zip(*exact, scenes, strict=True)]
    want = np.array([[float(c) for c in w] for w in want])
    both = shader(root / "shaders/brdf.glsl")
    errors = {mode: abs(both.with_mode(mode).shade(*vectors, material) / want - 1) for mode in ("precise", "double")}
    assert errors["double"].max() < 2e-6
    assert np.median(errors["double"]) < np.median(errors["precise"])


def test_double_decodes_and_encodes_srgb_by_the_standard(root):
    """pow of float64 is good to an ulp, and the exponents 2.4 and 1/2.4 times the logarithm magnify half an ulp."""
    decode = shader(root / "shaders/color.glsl", {"SRGB_DECODE": "SRGB_PIECEWISE"}, mode="double").srgb_to_linear
    encode = shader(root / "shaders/color.glsl", mode="double").linear_to_srgb
    for x in rounded(0.0, 0.003, 0.04, 0.0405, 0.2, 0.7, 1.0):
        value, a = mp.mpf(x), mp.mpf("0.055")
        linear, stored = value / mp.mpf("12.92"), value * mp.mpf("12.92")
        if value > mp.mpf("0.04045"):
            linear = ((value + a) / (1 + a)) ** mp.mpf("2.4")
        if value > mp.mpf("0.0031308"):
            stored = (1 + a) * value ** (1 / mp.mpf("2.4")) - a
        np.testing.assert_allclose(decode([x] * 3), float(linear), rtol=2e-15)
        np.testing.assert_allclose(encode([x] * 3), float(stored), rtol=2e-15)
