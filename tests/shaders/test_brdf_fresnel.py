"""fresnel() and what it is made of, on each rung: the published formula of a metal, and of the dielectric."""

from __future__ import annotations

import ladder_reference
import numpy as np
import pytest
from ladder_reference import FRESNEL
from reference import mp  # at its 50 digits
from rungs import BRDF

from harness import assert_ulp

U = 2.0**-24
LOH = np.unique(
    np.float32([0, 1e-7, 1e-4, 0.01, 0.1, 1 / 7, 0.3, 0.5, 0.8, 0.99, 1, *np.random.default_rng(2).random(40)])
)
F0 = np.float32([[0.05, 0.3, 0.5], [0.9, 0.95, 1.0], [0.0401, 0.77, 0.041]])
ABOVE = np.nextafter(np.float32(0.04), np.float32(1))
#: llvmpipe's pow(x, 5) is off by 81 ulp where measured, its exp2 by less than 1e-6 of its argument up to 12.5
ULP = {"F_POW": 100, "F_MULTIPLY": 11, "F_GAUSSIAN": 60, "F_DIELECTRIC": 11, "F_F82": 24}


def test_every_rung_has_a_formula():
    assert set(ULP) == set(FRESNEL) == set(BRDF["BRDF_F"])


def colours(cosines):
    """Each cosine with each F0: (n, 3), (n,)."""
    return np.repeat(F0, len(cosines), 0), np.tile(cosines, len(F0))


@pytest.mark.parametrize("rung", FRESNEL)
def test_of_a_metal_it_is_its_formula(library, mode, rung):
    f0, c = colours(LOH)
    brdf = library("brdf.glsl", mode, BRDF_F=rung)
    want = FRESNEL[rung][0](f0.astype(float), c.astype(float)[:, None])
    assert_ulp(brdf.fresnel(f0, c), want, max_ulp=ULP[rung])
    assert_ulp(brdf.F_metal(f0, c), want, max_ulp=ULP[rung])


def test_the_gaussian_is_karis(library, mode):
    """The weight of white alone: a wrong sixth digit would be 60 ulp at 1. llvmpipe's exp2 is within 16."""
    got = library("brdf.glsl", mode, BRDF_F="F_GAUSSIAN").schlick_weight(LOH)
    assert_ulp(got, ladder_reference.gaussian(0, LOH.astype(float)), max_ulp=24)


@pytest.mark.parametrize("rung", FRESNEL)
def test_of_the_dielectric_it_is_its_formula(library, mode, rung):
    brdf = library("brdf.glsl", mode, BRDF_F=rung)
    want = FRESNEL[rung][1](LOH.astype(float))
    # Fresnel's: differences of cosines that are 5 times as large as what is left, squared
    ulp = 20 if rung == "F_DIELECTRIC" else ULP[rung]
    assert_ulp(brdf.F_dielectric(LOH), want, max_ulp=ulp)
    assert_ulp(brdf.fresnel(np.float32([0.04] * 3), LOH), np.repeat(want[:, None], 3, 1), max_ulp=ulp)


@pytest.mark.parametrize("rung", ["F_DIELECTRIC", "F_F82"])
def test_above_the_dielectrics_F0_is_a_metal(library, mode, rung):
    """Each colour by itself; between them lies one float."""
    c = np.float32(0.1)
    got = library("brdf.glsl", mode, BRDF_F=rung).fresnel([0.0, np.float32(0.04), ABOVE], c)
    metal, one = (f(*a) for f, a in zip(FRESNEL[rung], ((float(ABOVE), float(c)), (float(c),)), strict=True))
    assert abs(metal - one) > 100 * U
    assert_ulp(got, [one, one, metal], max_ulp=24)


def test_what_a_dielectric_lets_in_is_the_rest(library, mode):
    """1 - F at 50 digits; and near grazing angles, where 1.0 - F would have none."""
    got = library("brdf.glsl", mode).fresnel_dielectric(LOH)
    for g, c in zip(got[:, 1], LOH, strict=True):
        c, n = mp.mpf(float(c)), mp.mpf("1.5")
        t = mp.sqrt(1 - (1 - c**2) / n**2)
        want = 2 * n * t * c * ((1 / (c + n * t)) ** 2 + (1 / (n * c + t)) ** 2)
        assert abs(mp.mpf(float(g)) - want) <= 12 * 2 * U * want
    assert got[0].tolist() == [1, 0]


def test_at_normal_incidence_the_dielectric_is_F0(library, mode):
    got = library("brdf.glsl", mode).fresnel_dielectric(1)
    assert_ulp(got, [0.04, 0.96], max_ulp=4)


def test_the_tint_is_what_82_degrees_show(library, mode):
    """By definition: the tint's share of Schlick's term at LoH = 1/7; nothing changes at 0 and 1."""
    tint = {"F82_TINT": "vec3(0.75, 0.9, 1.0)"}
    f0, c = colours(np.float32([0, 1 / 7, 1]))
    got = library("brdf.glsl", mode, BRDF_F="F_F82", **tint).F_metal(f0, c).reshape(3, 3, 3)
    plain = ladder_reference.schlick(f0.astype(float), c.astype(float)[:, None]).reshape(3, 3, 3)
    assert_ulp(got[:, 1], plain[:, 1] * [0.75, 0.9, 1.0], max_ulp=24)
    assert_ulp(got[:, [0, 2]], plain[:, [0, 2]], max_ulp=11)


def test_what_the_tint_takes_is_its_formula(library, mode):
    """A product of a dozen rounded factors, and the sum in Schlick's term."""
    f0, c = colours(np.float32([0.05, 1 / 7, 0.3, 0.5, 0.75]))
    F, x = f0.astype(float), c.astype(float)[:, None]
    want = (1 - 0.75) * ladder_reference.schlick(F, 1 / 7) * x * (1 - x) ** 6 / (1 / 7 * (6 / 7) ** 6)
    got = library("brdf.glsl", mode, F82_TINT="vec3(0.75)").f82_drop(f0, c)
    assert_ulp(got, want, max_ulp=14)


def test_without_a_tint_it_is_Schlicks(library, mode):
    f0, c = colours(LOH)
    got = library("brdf.glsl", mode, BRDF_F="F_F82", F82_TINT="vec3(1.0)").fresnel(f0, c)
    np.testing.assert_array_equal(got, library("brdf.glsl", mode).fresnel(f0, c))


def test_a_black_tint_leaves_nothing_below_zero(library, mode):
    """Where F0 is small, the multiple of LoH (1 - LoH)^6 exceeds Schlick's term."""
    brdf = library("brdf.glsl", mode, BRDF_F="F_F82", F82_TINT="vec3(0.0)")
    assert (brdf.F_metal([0.0, 0.01, 0.05], 0.4) == 0).all()
    assert (brdf.f82_drop([0.0, 0.01, 0.05], 0.4) > brdf.F_Schlick([0.0, 0.01, 0.05], 0.4)).all()


#: metal -> refractive index n + ik at red, green and blue (Johnson & Christy 1972, 1974; Rakic 1995), the stated tint
METALS = {
    "aluminium": ([1.37 + 7.6j, 0.93 + 6.4j, 0.66 + 5.5j], 0.9),
    "chromium": ([3.1 + 3.3j], 0.75),
    "iron": ([2.9 + 3.1j], 0.75),
    "titanium": ([2.7 + 3.8j], 0.75),
    "gold": ([0.18 + 3.4j, 0.45 + 2.4j, 1.4 + 1.9j], 0.98),
    "copper": ([0.24 + 3.4j, 1.1 + 2.6j, 1.2 + 2.4j], 0.98),
}


@pytest.mark.parametrize("metal", METALS)
def test_the_tints_that_are_stated_are_those_of_the_metals(metal):
    """Fresnel's equations with a complex index, at LoH = 1/7, over Schlick's term; to the digits of the indices."""

    def exact(c, m):
        refracted = np.sqrt(1 - (1 - c**2) / m**2)
        return (
            abs((c - m * refracted) / (c + m * refracted)) ** 2 + abs((m * c - refracted) / (m * c + refracted)) ** 2
        ) / 2

    indices, stated = METALS[metal]
    tints = [exact(1 / 7, m) / ladder_reference.schlick(exact(1, m), 1 / 7) for m in map(complex, indices)]
    assert np.mean(tints) == pytest.approx(stated, abs=0.025)


@pytest.mark.parametrize("rung", FRESNEL)
def test_of_a_material_it_is_a_mixture(library, mode, rung):
    metal, one = FRESNEL[rung]
    albedo, c = np.float32([0.02, 0.5, 1]), np.float32(0.2)
    for metalness in (0, 0.25, 1):
        got = library("brdf.glsl", mode, BRDF_F=rung).F_material(
            {"albedo": albedo, "metalness": metalness, "roughness": 0.5}, c
        )
        want = metalness * metal(albedo.astype(float), float(c)) + (1 - metalness) * one(float(c))
        assert_ulp(got, want, max_ulp=ULP[rung] + 13)
