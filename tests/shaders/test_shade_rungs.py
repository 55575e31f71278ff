"""shade() over the whole ladder: the product and sum of its terms, whichever rungs they are on, and always a number."""

from __future__ import annotations

import functools

import ladder_reference
import numpy as np
import pytest
import reference
from extremes import extremes
from rungs import BRDF, DEFAULT, LADDER, PRESETS, SINGLE, name

from harness.searching.domain import samples
from harness.trade import extremes as trade_extremes

U = 2.0**-24
#: cosines are off by 3 U, against 0.1 at least; d of D, 1/16 at least here, by 9 U if it is from n.h, and twice into D;
#: 1 - F and 1 - E by U against 1, of which 1/10 is left at least; sums and products of some 20 positive numbers
TOLERANCE = 2 * (2 * 3 + 3) * U * 16 + 4 * 3 * U / 0.1 + 40 * U
MODES = ("mediump", "double")
#: llvmpipe's pow(x, 5) and exp2, in ulp
POW_ULP = 100


#: combinations in which one guard has to outdo what another lets through
TOGETHER = [
    {"BRDF_V": "V_KELEMEN", "BRDF_D": "D_ONE_MINUS"},
    {"BRDF_V": "V_KELEMEN", "BRDF_D": "D_EXERCISE", "BRDF_MULTI": "MULTI_FITTED"},
    {"BRDF_V": "V_SEPARABLE", "BRDF_D": "D_EXERCISE", "BRDF_MULTI": "MULTI_FITTED"},
    {"BRDF_V": "V_HAMMON", "BRDF_D": "D_EXERCISE"},
]


@functools.cache
def middle():
    """l, v, n, albedo, metalness, roughness, float32: roughness 0.5 and above, cosines 0.1 and above."""
    random = np.random.default_rng(31)
    l, v = random.standard_normal((2, 4000, 3))  # noqa: E741
    n = random.standard_normal((4000, 3))
    l, v, n = (np.float32(a / np.linalg.norm(a, axis=1, keepdims=True)) for a in (l, v, n))  # noqa: E741
    lit = ((n * l).sum(1) > 0.1) & ((n * v).sum(1) > 0.1)
    count = lit.sum()
    assert count > 500
    kinds = np.float32([0, 1, 0.3])
    return (
        *(a[lit] for a in (l, v, n)),
        random.random((count, 3), np.float32),
        kinds[np.arange(count) % 3],
        random.uniform(0.5, 1, count).astype(np.float32),
    )


def called(function, l, v, n, albedo, metalness, roughness):  # noqa: E741
    return function(l, v, n, {"albedo": albedo, "metalness": metalness, "roughness": roughness})


def assert_is_its_terms(brdf, macros):
    inputs = middle()
    got = called(brdf.shade, *inputs)
    want = ladder_reference.shade(*(x.astype(float) for x in inputs), {**DEFAULT, **macros})
    more = POW_ULP * U if macros.get("BRDF_F") in ("F_POW", "F_GAUSSIAN") else 0
    np.testing.assert_allclose(got, want, rtol=TOLERANCE + more, atol=0)


@pytest.mark.parametrize("rung", [{}, *SINGLE, *PRESETS, *TOGETHER], ids=name)
def test_a_rung_or_preset_is_the_sum_of_its_terms(library, mode, rung):
    assert_is_its_terms(library("brdf.glsl", mode, **rung), rung)


def test_every_rung_is_another_model_or_the_same_to_rounding():
    """The reference can tell the rungs apart that are models of their own."""
    inputs = [x.astype(float) for x in middle()]
    same = {"D_EXERCISE", "D_CROSS", "D_ONE_MINUS", "D_HALF", "F_POW"}
    default = ladder_reference.shade(*inputs, DEFAULT)
    for rung in SINGLE:
        differs = np.abs(ladder_reference.shade(*inputs, {**DEFAULT, **rung}) / default - 1).max() > 100 * TOLERANCE
        assert differs != (set(rung.values()) <= same), rung


@pytest.mark.parametrize("rung", [{}, *PRESETS], ids=name)
def test_the_functions_of_the_terms_are_what_shade_is_made_of(library, rung):
    """(diffuse + distribution visibility F compensation) n.l, by the shader's own functions."""
    l, v, n, albedo, metalness, roughness = middle()  # noqa: E741
    brdf = library("brdf.glsl", **rung)
    material = {"albedo": albedo, "metalness": metalness, "roughness": roughness}
    NoL, NoV = (np.float32((n.astype(float) * a).sum(1)) for a in (l, v))
    LoH = np.float32(np.linalg.norm(l.astype(float) + v, axis=1) / 2)
    F0 = np.float32(0.04 * (1 - metalness[:, None]) + albedo * metalness[:, None])
    highlight = brdf.distribution(l, v, n, roughness**2) * brdf.visibility(NoL, NoV, LoH, roughness**2)
    specular = highlight[:, None] * brdf.F_material(material, LoH) * brdf.compensation(F0, NoV, roughness)
    want = (specular.astype(float) + brdf.diffuse(l, v, n, material)) * NoL[:, None]
    more = 2 * POW_ULP * U if rung.get("BRDF_F") in ("F_POW", "F_GAUSSIAN") else 0
    np.testing.assert_allclose(brdf.shade(l, v, n, material), want, rtol=2 * TOLERANCE + more, atol=0)


def test_fresnel_of_a_pure_material_is_that_of_its_F0(library):
    """Of the dielectric, and of a metal brighter than it, on every rung."""
    LoH = np.linspace(0, 1, 50, dtype=np.float32)
    for rung in BRDF["BRDF_F"]:
        brdf = library("brdf.glsl", BRDF_F=rung)
        for albedo, metalness in (([0.9, 0.5, 0.1], 1), ([0.9, 0.5, 0.1], 0)):
            F0 = albedo if metalness else [0.04] * 3
            got = brdf.F_material({"albedo": albedo, "metalness": metalness, "roughness": 0.5}, LoH)
            np.testing.assert_allclose(brdf.fresnel(F0, LoH), got, rtol=4 * U, atol=0)


@pytest.mark.parametrize("rung", ["D_CROSS", "D_PROJECT", "D_HALF"])
def test_a_sharp_highlight_is_its_formula_to_ulps(library, mode, rung):
    """A black dielectric toward +z, where neither cross product nor projection rounds; h beside n by a little."""
    random = np.random.default_rng(8)
    cosine, azimuth = random.uniform(0.2, 1, 500), random.uniform(0, 2 * np.pi, 500)
    apart = azimuth + np.pi + 10.0 ** random.uniform(-4, -2, 500)
    sine = np.sqrt(1 - cosine**2)
    l, v = (np.stack([sine * np.cos(a), sine * np.sin(a), cosine], -1) for a in (azimuth, apart))  # noqa: E741
    zero = np.zeros(500, np.float32)
    black, roughness = np.zeros((500, 3), np.float32), np.full(500, 0.07, np.float32)
    inputs = np.float32(l), np.float32(v), np.tile(np.float32([0, 0, 1]), (500, 1)), black, zero, roughness
    got = called(library("brdf.glsl", mode, BRDF_D=rung).shade, *inputs)
    want = ladder_reference.shade(*(x.astype(float) for x in inputs), {**DEFAULT, "BRDF_D": rung})
    np.testing.assert_allclose(got, want, rtol=60 * U, atol=0)


# ---- Every input -----------------------------------------------------------------------------------------------------


@functools.cache
def everywhere():
    return extremes(100_000, seed=23)


@functools.cache
def beyond():
    """h = n, at both horizons with unequal cosines, where D V leaves float's range; white metals and mixtures."""
    cosines = [10.0**-k for k in (4, 5, 6, 7, 8, 10, 13, 15, 20, 37)]
    cos_l, cos_v, roughness = np.meshgrid(cosines, cosines, 10 ** np.linspace(-12, -2, 81), indexing="ij")
    l, v = (np.stack(np.broadcast_arrays(x, y, c), -1) for x, y, c in ((0.6, 0.8, cos_l), (-0.6, -0.8, cos_v)))  # noqa: E741
    metalness = np.resize([1.0, 1.0, 0.5], roughness.shape)
    return (
        np.float32(l),
        np.float32(v),
        [0, 0, 1],
        {"albedo": [1, 1, 1], "metalness": metalness, "roughness": roughness},
    )


@pytest.mark.parametrize("inputs", [everywhere, beyond], ids=lambda f: f.__name__)
@pytest.mark.parametrize("rung", [*SINGLE, *PRESETS, *TOGETHER], ids=name)
def test_shade_is_finite_and_not_negative_on_every_rung(library, mode, rung, inputs):
    got = library("brdf.glsl", mode, **rung).shade(*inputs())
    assert np.isfinite(got).all()
    assert got.min() >= 0


@pytest.mark.parametrize("rung", [*SINGLE, *PRESETS], ids=name)
def test_back_side_and_horizon_are_black(library, mode, rung):
    brdf = library("brdf.glsl", mode, **rung)
    for cos_l, cos_v in ((-0.5, 0.5), (0.5, -0.5), (0.0, 0.5), (0.5, 0.0), (0.0, 0.0), (-1.0, 1.0)):
        l, v = reference.direction(cos_l, 0), reference.direction(cos_v, "0.5")  # noqa: E741
        material = {"albedo": [1, 1, 1], "metalness": 0.5, "roughness": [0, 0.3, 1]}
        assert (brdf.shade(reference.rounded(l), reference.rounded(v), [0, 0, 1], material) == 0).all()


@pytest.mark.parametrize("term", LADDER.terms, ids=lambda term: term.name)
def test_every_term_by_itself_is_finite_and_not_negative(library, term):
    """At all inputs of its domain that the ladder states, zeros, denormals and opposite vectors among them."""
    for rung in term.rungs:
        function = library(term.file, **{term.macro: rung.value})[term.function]
        got = function(**samples(function, term.inputs, 5_000))
        assert np.isfinite(got).all(), rung.value
        assert got.min() >= 0, rung.value


def test_half_precisions_form_is_the_formula_with_its_guards(library, mode):
    """h = n and h beside it, cosines that its guards are felt at, and roughnesses; white metals and dielectrics.

    Toward +z, where nothing rounds but H, so that the guards are not hidden.
    """
    cosines = np.float32([1, 0.3, 1e-2, 1e-3, 1e-4, 3e-5, 1.6e-5, 1e-6])
    beside, roughnesses = [0, 1e-3, 0.3], np.float32([1e-3, 0.02, 0.03, 0.05, 0.089, 0.3, 1])
    grid = np.meshgrid(cosines, cosines, beside, roughnesses, [0, 1], indexing="ij")
    cos_l, cos_v, apart, roughness, metalness = (x.ravel() for x in grid)
    sin_l, sin_v = (np.sqrt(1 - x.astype(float) ** 2) for x in (cos_l, cos_v))
    l = np.float32(np.stack([sin_l, 0 * sin_l, cos_l], -1))  # noqa: E741
    v = np.float32(np.stack([-sin_v * np.cos(apart), sin_v * np.sin(apart), cos_v], -1))
    n, white = np.tile(np.float32([0, 0, 1]), (len(l), 1)), np.ones((len(l), 3), np.float32)
    inputs = l, v, n, white, np.float32(metalness), np.float32(roughness)
    for rung in ({"BRDF_V": "V_EXACT"}, {"BRDF_V": "V_HAMMON"}, {"BRDF_V": "V_SCHLICK"}, {"BRDF_V": "V_SEPARABLE"}):
        macros = {"BRDF_D": "D_HALF", **rung}
        got = called(library("brdf.glsl", mode, **macros).shade, *inputs)
        want = ladder_reference.shade(*(x.astype(float) for x in inputs), {**DEFAULT, **macros})
        most = ladder_reference.HALF_MOST
        assert (want >= most).any() and (want == 0).any()
        # n.l/2pi less what is behind cancels down to 0.0077; and 1 - F, of at most n.l/pi, is from 1 - (1 - c)^5
        bound = (100 + 1 / 0.0077) * U * want + 8 * U * cos_l[:, None] / np.pi
        assert (np.abs(got - want) <= bound).all()


def test_the_mobile_preset_is_finite_and_not_negative_in_half_precision(library):
    """At the extremes that the trade counts, a sixteenth of them."""
    (mobile,) = (preset.macros for preset in LADDER.presets if preset.name == "mobile")
    function = library("brdf.glsl", "mediump", **{macro: mobile[macro] for macro in BRDF}).shade
    assert trade_extremes.count_broken(function, trade_extremes.inputs(1 << 16)) == {"non_finite": 0, "negative": 0}


def test_half_precisions_form_keeps_its_digits_in_half_precision(library):
    """Against the same in double, of the same inputs as halves, from roughness 0.089 and cosines of 0.05."""
    random = np.random.default_rng(41)
    l, v, n = random.standard_normal((3, 20_000, 3))  # noqa: E741
    near = np.arange(20_000) % 2 == 0
    l, n = (a / np.linalg.norm(a, axis=1, keepdims=True) for a in (l, n))  # noqa: E741
    mirrored = 2 * (l * n).sum(1, keepdims=True) * n - l + 10 ** random.uniform(-3, 0, (20_000, 1)) * v
    v = np.where(near[:, None], mirrored, v)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    lit = ((n * l).sum(1) >= 0.05) & ((n * v).sum(1) >= 0.05)
    count = lit.sum()
    materials = random.random((count, 3)), random.choice([0, 0.3, 1], count), random.uniform(0.089, 1, count)
    inputs = [np.float32(np.float16(x)) for x in (l[lit], v[lit], n[lit], *materials)]
    for rung in ({"BRDF_V": "V_HAMMON", "BRDF_DIFFUSE": "DIFFUSE_LAMBERT"}, {}):
        half, double = (called(library("brdf.glsl", m, BRDF_D="D_HALF", **rung).shade, *inputs) for m in MODES)
        errors = np.abs(half / double - 1)
        assert np.median(errors) < 2**-9 and np.quantile(errors, 0.99) < 0.02


def test_Kelemens_highlight_is_his_until_its_end(library, mode):
    """1e37, where D V would leave float's range; a white metal with h = n, l and v at cosines as small."""
    c = np.float32([0.1, 1e-4, 1e-8, 1e-9, 1e-11, 1e-15])
    l, v = (np.stack(np.broadcast_arrays(x, 0.0, c), -1) for x in (1.0, -1.0))  # noqa: E741
    metal = {"albedo": [1, 1, 1], "metalness": 1, "roughness": 1e-6}
    got = library("brdf.glsl", mode, BRDF_V="V_KELEMEN", BRDF_D="D_ONE_MINUS").shade(l, v, [0, 0, 1], metal)[:, 0]
    cosine, a = c.astype(float), float(np.float32(1e-6)) ** 2
    want = np.minimum((a / (a**2 + 1e-26)) ** 2 / np.pi / (4 * cosine), 1e37)
    assert (want == 1e37).any() and (want < 1e36).any()
    np.testing.assert_allclose(got, want, rtol=100 * U)


def test_half_precisions_highlight_tells_its_cosines(library, mode):
    """In 0...1, also behind the surface and of vectors that rounding made too long."""
    highlight = library("brdf.glsl", mode, BRDF_D="D_HALF").highlight
    long = np.float32([0, 0, 1.0000001])
    for l, v, n, NoL, NoV in (  # noqa: E741
        ([0, 0.8, 0.6], [0.6, 0, 0.8], [0, 0, 1], 0.6, 0.8),
        ([0, 0.6, 0.8], [0, 0.8, -0.6], [0, 0, 1], 0.8, 0),
        ([0, 0.8, -0.6], [0, 0.6, 0.8], [0, 0, 1], 0, 0.8),
        (long, long, long, 1, 1),
    ):
        _, g = highlight(np.float32(l), np.float32(v), n, 0.25)
        np.testing.assert_allclose([g.NoL, g.NoV], [NoL, NoV], rtol=2 * U, atol=0)
        np.testing.assert_allclose(g.c2, np.float64(g.c) ** 2, rtol=2 * U)
