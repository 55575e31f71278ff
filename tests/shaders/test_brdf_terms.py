"""D, V and F alone, given exact float32 cosines: the formulas of the exercise to the rounding of their operations.

U is the unit roundoff of float32. A result of k roundings is within k U of the formula; U is at most one ulp.
"""

from __future__ import annotations

import itertools

import mpmath as mp
import numpy as np
import pytest
import reference

from harness import assert_ulp

U = 2.0**-24
ONE_BELOW = float(np.nextafter(np.float32(1), np.float32(0)))
TINY_ALPHA = 1e-10
COSINES = [0.0, 1e-7, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999, 0.999999, ONE_BELOW, 1.0]
ROUGHNESSES = [0.0, TINY_ALPHA**0.5, 1e-4, 1e-3, 0.01, 0.045, 0.089, 0.2, 0.5, 0.8, ONE_BELOW, 1.0]
#: llvmpipe's pow(x, 5), in ulp: measured 61 to 81; GLSL asks no less of it than of exp2(5 log2(x))
POW_ULP = 100

RANDOM = np.random.default_rng(20)
COSINES += RANDOM.random(8, np.float32).tolist()
ROUGHNESSES += RANDOM.random(6, np.float32).tolist()
ALPHAS = [float(np.float32(r) ** 2) for r in ROUGHNESSES]


def grid(*axes):
    """Columns of the axes' product, as float32."""
    return np.array(list(itertools.product(*axes)), np.float32).T


def expected(function, *columns):
    return [function(*map(float, row)) for row in zip(*columns, strict=True)]


def test_D_is_the_formula(library, mode):
    NoH, alpha = grid(COSINES, ALPHAS)
    got = library("brdf.glsl", mode).D_GGX(NoH, alpha)
    for g, c, a in zip(got, NoH, alpha, strict=True):
        want = reference.D_GGX(float(c), float(a))
        # d = 1 + NoH^2 (alpha^2 - 1) takes 3 roundings of numbers up to 1, D goes with its square; 6 roundings follow
        d = 1 + mp.mpf(float(c)) ** 2 * (mp.mpf(float(a)) ** 2 - 1)
        bound = 2 * 3 * U / d + 6 * U if d else mp.inf
        if bound < 0.5:
            assert abs(mp.mpf(float(g)) - want) <= bound * want, (c, a)
        else:  # the form has no digits left here; it must still stay below the peak of the lobe
            peak = 1 / (mp.pi * max(mp.mpf(float(a)) ** 2, mp.mpf("1.2e-38")))
            assert 0 <= g <= peak * (1 + 8 * U), (c, a)


def test_V_is_the_formula(library, mode):
    NoL, NoV, alpha = grid(COSINES, COSINES, ALPHAS)
    want = np.array(expected(reference.V_SmithGGXCorrelated, NoL, NoV, alpha), float)
    got = library("brdf.glsl", mode).V_SmithGGXCorrelated(NoL, NoV, alpha)
    # below 0.5/1.2e-38 the guard has no part in it; under the roots squares below the normal range are lost
    plain = (want < 1e37) & (np.minimum(NoL, NoV) * alpha > 1e-18)
    assert plain.sum() > 1000
    assert_ulp(got[plain], want[plain], max_ulp=6)


def test_V_is_finite_where_the_formula_divides_by_zero(library, mode):
    NoL, NoV, alpha = grid(COSINES, COSINES, ALPHAS)
    got = library("brdf.glsl", mode).V_SmithGGXCorrelated(NoL, NoV, alpha)
    assert np.isfinite(got).all()
    assert (got > 0).all()


def test_V_is_the_formula_down_to_the_smallest_normal_number(library, mode):
    """With NoL = 0 and alpha = 1 it is 0.5/NoV; what guards against 0 takes no part above 1.2e-38."""
    NoV = np.float32([1.21e-38, 1.29e-38, 2e-38, 1e-37])
    got = library("brdf.glsl", mode).V_SmithGGXCorrelated(0.0, NoV, 1.0)
    assert_ulp(got, 0.5 / NoV.astype(float), max_ulp=3)


def test_V_follows_from_smith_lambda():
    """The exercise's closed form is G2/(4 NoL NoV) with G2 = 1/(1 + Lambda_i + Lambda_o)."""
    for i, o, a in itertools.product((0.01, 0.3, 0.77, 1), (0.02, 0.5, 1), (0.001, 0.2, 1)):
        G2 = 1 / (1 + reference.smith_lambda(i, a) + reference.smith_lambda(o, a))
        want = G2 / (4 * mp.mpf(i) * mp.mpf(o))
        assert mp.almosteq(reference.V_SmithGGXCorrelated(i, o, a), want, rel_eps=mp.mpf(10) ** -45)


def test_F_is_the_formula(library, mode):
    F0, LoH = grid([0.0, 0.04, 0.5, 1.0], COSINES)
    got = library("brdf.glsl", mode).F_Schlick(np.repeat(F0[:, None], 3, 1), LoH)
    want = np.array(expected(reference.F_Schlick, F0, LoH), float)
    # 1 - LoH rounds once and goes with the fifth power; 3 products, 1 - F0, a product, a sum
    assert_ulp(got, want[:, None], max_ulp=5 + 3 + 3)


def test_F_by_pow_is_the_formula(library, mode):
    F0, LoH = grid([0.0, 0.04, 0.5, 1.0], COSINES)
    got = library("brdf.glsl", mode, BRDF_F="F_POW").F_Schlick(np.repeat(F0[:, None], 3, 1), LoH)
    want = np.array(expected(reference.F_Schlick, F0, LoH), float)
    assert_ulp(got, want[:, None], max_ulp=POW_ULP, atol_near_zero=1e-37)


@pytest.mark.parametrize("LoH", [-1.0, -1e-7, float(np.nextafter(np.float32(1), np.float32(2))), 2.0])
def test_F_clamps_its_cosine(library, mode, LoH):
    got = library("brdf.glsl", mode).F_Schlick([0.04] * 3, LoH)
    assert_ulp(got, 1.0 if LoH < 0 else np.float32(0.04), max_ulp=1)


def test_Hammons_V_is_his_formula(library, mode):
    NoL, NoV, alpha = grid(COSINES[1:], COSINES[1:], ALPHAS)
    got = library("brdf.glsl", mode).V_Hammon(NoL, NoV, alpha)
    want = np.array(expected(reference.V_Hammon, NoL, NoV, alpha), float)
    # mix(x, y, a) may be computed as x + a (y - x): both are within 4 roundings of the larger end
    larger = np.maximum(2 * NoL * NoV, NoL + NoV).astype(float)
    bound = 2 * want**2 * 4 * U * larger + 4 * U * want
    assert (np.abs(got - want) <= bound).all()


def test_Hammons_V_is_finite_where_his_formula_divides_by_zero(library, mode):
    got = library("brdf.glsl", mode).V_Hammon([0.0, 0.0, 1e-30], [0.0, 1.0, 1e-30], 0.0)
    assert np.isfinite(got).all()
    assert (got > 0).all()


def test_Hammons_V_is_exact_at_alpha_one(library):
    """At alpha 1 Smith's V is 0.5/(NoL + NoV), and so is his."""
    NoL, NoV = grid(COSINES[1:], COSINES[1:])
    brdf = library("brdf.glsl")
    assert_ulp(brdf.V_Hammon(NoL, NoV, 1.0), brdf.V_SmithGGXCorrelated(NoL, NoV, 1.0), max_ulp=10)
