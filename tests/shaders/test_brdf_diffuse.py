"""diffuse() on each rung, and what the rungs are made of: the published formula, in float64 or at 50 digits."""

from __future__ import annotations

import ladder_reference
import numpy as np
import pytest
from ladder_reference import FRESNEL
from reference import mp  # at its 50 digits
from rungs import BRDF

from harness import assert_ulp

COSINES = np.float32([0, 1e-7, 1e-3, 0.05, 0.3, 0.5, 0.8, 0.999, 1])
ROUGHNESSES = np.float32([0.001, 0.1, 0.5, 0.9, 1])
ALBEDO = np.float32([0.0, 0.3, 1.0])


def grid(*axes):
    return [g.ravel() for g in np.meshgrid(*axes)]


def test_what_is_left_of_the_fifth_power(library, mode):
    """1 - (1 - c)^5 at 50 digits, as c goes to 0 too; cosines above 1 count as 1."""
    c = np.float32([1e-30, 1e-7, 1e-4, 0.01, 0.1, 0.5, 0.9, 0.9999, 1])
    want = [float(1 - (1 - mp.mpf(float(x))) ** 5) for x in c]
    fifth_rest = library("brdf.glsl", mode).fifth_rest
    assert_ulp(fifth_rest(c), want, max_ulp=6)
    assert fifth_rest(0) == 0
    above = np.nextafter(np.float32(1), np.float32(2))
    assert fifth_rest(above) == above


def test_shirleys_is_the_formula(library, mode):
    NoL, NoV = grid(COSINES, COSINES)
    l, v = (x.astype(float) for x in (NoL, NoV))  # noqa: E741
    # the reference in float64 has 1e-16 of 1 left near 0
    got = library("brdf.glsl", mode).diffuse_shirley(NoL, NoV)
    assert_ulp(got, ladder_reference.shirley(l, v), max_ulp=18, atol_near_zero=1e-15)


def test_burleys_is_the_formula(library, mode):
    NoL, NoV, LoH, r = grid(COSINES, COSINES, COSINES, ROUGHNESSES)
    got = library("brdf.glsl", mode).diffuse_burley(NoL, NoV, LoH, r)
    want = ladder_reference.burley(*(x.astype(float) for x in (NoL, NoV, LoH, r)))
    # each factor is 1/2 at least, of numbers up to 2.5: 4 roundings of those, a few of it, twice
    assert_ulp(got, want, max_ulp=2 * (4 * 2.5 + 6))


def directions():
    """Unit vectors above the horizon, and their cosines."""
    random = np.random.default_rng(6)
    l, v = random.standard_normal((2, 120, 3))  # noqa: E741
    l, v = (np.float32(a / np.linalg.norm(a, axis=1, keepdims=True)) for a in (l, v))  # noqa: E741
    l[:, 2], v[:, 2] = np.abs(l[:, 2]), np.abs(v[:, 2])
    v[:40] = l[:40] * np.float32([-1, -1, 1])  # s is least
    v[40:60] = l[40:60]  # and greatest
    return l, v


def eon_exactly(albedo, r, NoL, NoV, LoV):
    """pi f of the paper at 50 digits, with its polynomial for the albedos."""
    albedo, r, i, o, LoV = (mp.mpf(float(x)) for x in (albedo, r, NoL, NoV, LoV))
    c1, c2 = mp.mpf(1) / 2 - 2 / (3 * mp.pi), mp.mpf(2) / 3 - 28 / (15 * mp.pi)

    def E(cosine):
        x = 1 - cosine
        g = mp.fsum(mp.mpf(str(c)) * x ** (k + 1) for k, c in enumerate(ladder_reference.EON_G))
        return min((1 + r * g) / (1 + c1 * r), mp.mpf(1))

    s = LoV - i * o
    t = max(i, o) if s > 0 else mp.mpf(1)
    A = 1 / (1 + c1 * r)
    average = A * (1 + c2 * r)
    several = albedo**2 * average / (1 - albedo * (1 - average)) * (1 - E(i)) * (1 - E(o)) / (1 - average)
    return albedo * A * max(1 + r * s / t, mp.mpf(0)) + several


@pytest.mark.parametrize("roughness", ROUGHNESSES)
def test_eon_is_the_papers_formula(library, mode, roughness):
    l, v = directions()  # noqa: E741
    NoL, NoV = l[:, 2], v[:, 2]
    LoV = np.float32((l.astype(float) * v).sum(1))
    got = library("brdf.glsl", mode).diffuse_eon(ALBEDO, roughness, NoL, NoV, LoV)
    for k in range(len(l)):
        r, i, o = float(roughness), float(NoL[k]), float(NoV[k])
        s = abs(float(LoV[k])) + i * o
        t = max(i, o) if LoV[k] > i * o else 1.0
        for g, a in zip(got[k], ALBEDO, strict=True):
            want = eon_exactly(a, r, i, o, LoV[k])
            # 1 + r s/t cancels toward 0, s of a difference; the rest are a few positive factors
            bound = 2.0**-24 * float(a) * (4 + 6 * r * s / t) + 30 * 2.0**-24 * float(want)
            assert abs(mp.mpf(float(g)) - want) <= bound


def test_eons_polynomial_is_near_its_closed_form():
    """To 0.1 %, as the paper says of it."""
    cosine, r = np.meshgrid(np.linspace(1e-4, 1, 500), np.linspace(0, 1, 30))
    fit, exact = ladder_reference.eon_albedo(cosine, r), ladder_reference.eon_albedo_exact(cosine, r)
    assert np.abs(fit / exact - 1).max() < 1e-3


def test_eon_of_a_smooth_surface_is_lamberts(library, mode):
    l, v = directions()  # noqa: E741
    got = library("brdf.glsl", mode).diffuse_eon(ALBEDO, 0, l[:, 2], v[:, 2], (l * v).sum(1))
    np.testing.assert_array_equal(got, np.tile(ALBEDO, (len(l), 1)))


def test_eon_is_not_negative_where_rounding_makes_the_cosines_opposite(library, mode):
    """s = -1 to a little beyond: 1 + s is 0 at least. And at both horizons, s > 0, it is a number."""
    eon = library("brdf.glsl", mode).diffuse_eon
    beyond = np.nextafter(np.float32(-1), np.float32(-2))
    assert (eon(ALBEDO, 1, 0, 0, [beyond, -1.0]) >= 0).all()
    assert (eon(np.float32([0.5] * 3), 1, 0, 0, beyond) == 0).all()
    assert np.isfinite(eon(ALBEDO, 1, 0, 0, [1.0, 1e-30])).all()


def test_eon_at_the_horizon_loses_nothing(library, mode):
    """There its polynomial is above the closed form, which is 1: single scattering alone, with s = 0, is left."""
    A = 1 / (1 + ladder_reference.EON_C1)
    for NoL, NoV in ((0, 1), (1, 0)):
        got = library("brdf.glsl", mode).diffuse_eon(np.float32([1, 1, 1]), 1, NoL, NoV, 0)
        assert_ulp(got, A, max_ulp=4)


def test_eon_at_the_horizon_goes_with_the_larger_cosine(library, mode):
    """s/max(NoL, NoV), where the guard of the divisor takes no part: 1e-30 over 1e-32 is 100."""
    got = library("brdf.glsl", mode).diffuse_eon(np.float32([0.5] * 3), 1, 0, np.float32(1e-32), np.float32(1e-30))
    A = 1 / (1 + ladder_reference.EON_C1)
    assert_ulp(got, 0.5 * A * 101, max_ulp=8)


WEIGHTS = {
    "DIFFUSE_LAMBERT": lambda i, o, c, r: 1 + 0 * i,
    "DIFFUSE_F0": lambda i, o, c, r: 0.96 + 0 * i,
    "DIFFUSE_SHIRLEY": lambda i, o, c, r: ladder_reference.shirley(i, o),
    "DIFFUSE_BURLEY": ladder_reference.burley,
    "DIFFUSE_ENERGY": lambda i, o, c, r: ladder_reference.energy_share(o, r, FRESNEL["F_MULTIPLY"][1], 1),
}


def test_what_is_left_of_the_albedo_knows_of_several_reflections(library, mode):
    """With BRDF_MULTI the highlight is larger, and less is left."""
    NoV, r = grid(COSINES, ROUGHNESSES)
    o, rough = NoV.astype(float), r.astype(float)
    several = 1 + 0.04 * ladder_reference.energy_lost(o, rough)
    want = ladder_reference.energy_share(o, rough, FRESNEL["F_MULTIPLY"][1], several)
    got = library("brdf.glsl", mode, BRDF_MULTI="MULTI_FITTED").diffuse_energy(NoV, r)
    np.testing.assert_allclose(got, want, rtol=0, atol=3e-6)


def test_every_rung_is_tested():
    assert set(BRDF["BRDF_DIFFUSE"]) == {*WEIGHTS, "DIFFUSE_FRESNEL", "DIFFUSE_EON"}


@pytest.mark.parametrize("rung", BRDF["BRDF_DIFFUSE"])
@pytest.mark.parametrize("metalness", [0.0, 0.25, 1.0])
def test_the_brdf_is_its_formula(library, mode, rung, metalness):
    """Of the dielectric part, the albedo over pi times the rung's weight."""
    l, v = directions()  # noqa: E741
    roughness = np.resize(ROUGHNESSES, len(l))
    material = {"albedo": [0.0, 0.3, 0.9], "metalness": metalness, "roughness": roughness}
    got = library("brdf.glsl", mode, BRDF_DIFFUSE=rung).diffuse(l, v, [0, 0, 1], material)
    a, b, r = (x.astype(float) for x in (l, v, roughness))
    albedo, m = np.float32([0.0, 0.3, 0.9]).astype(float), metalness
    i, o, LoV = a[:, 2], b[:, 2], (a * b).sum(1)
    c = np.minimum(np.linalg.norm(a + b, axis=1) / 2, 1)
    if rung == "DIFFUSE_FRESNEL":
        F = m * ladder_reference.schlick(albedo, c[:, None]) + (1 - m) * ladder_reference.schlick(0.04, c[:, None])
        weighted = albedo * (1 - F)
    elif rung == "DIFFUSE_EON":
        weighted = ladder_reference.eon(albedo, r[:, None], i[:, None], o[:, None], LoV[:, None])
    else:
        weighted = albedo * WEIGHTS[rung](i, o, c, r)[:, None]
    # against 1: 1 - F and 1 - E round once more than what they are taken from; s of EON, over a cosine
    tolerance = 1e-5 if rung == "DIFFUSE_EON" else 40 * 2.0**-24
    np.testing.assert_allclose(got, (1 - m) / np.pi * weighted, rtol=tolerance, atol=0 if m == 1 else 3e-6 / np.pi)


@pytest.mark.parametrize("rung", ["DIFFUSE_SHIRLEY", "DIFFUSE_ENERGY"])
def test_a_direction_behind_counts_as_one_at_the_horizon(library, mode, rung):
    diffuse = library("brdf.glsl", mode, BRDF_DIFFUSE=rung).diffuse
    material = {"albedo": [0.5, 0.2, 1], "metalness": 0, "roughness": 0.5}
    n, up, behind, beside = [0, 0, 1], [0.6, 0, 0.8], [0.8, 0, -0.6], [1, 0, 0]
    np.testing.assert_array_equal(diffuse(behind, up, n, material), diffuse(beside, up, n, material))
    np.testing.assert_array_equal(diffuse(up, behind, n, material), diffuse(up, beside, n, material))


@pytest.mark.parametrize("rung", [r for r in BRDF["BRDF_DIFFUSE"] if r != "DIFFUSE_EON"])
def test_cosines_that_rounding_lifts_above_one_count_as_one(library, mode, rung):
    """All but EON's l.v, which it does not clamp: it enters as it is."""
    diffuse = library("brdf.glsl", mode, BRDF_DIFFUSE=rung).diffuse
    material = {"albedo": [0.5, 0.2, 1], "metalness": 0, "roughness": 0.5}
    long, one = np.float32([0, 0, 1.0000001]), [0, 0, 1]
    np.testing.assert_array_equal(diffuse(long, long, long, material), diffuse(one, one, one, material))
