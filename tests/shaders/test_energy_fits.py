"""energy.glsl: the fits are the polynomials that fit_energy.py prints, and as good as their comments say."""

from __future__ import annotations

import math

import ladder_reference
import numpy as np
import pytest
from ladder_reference import dielectric, schlick
from test_energy import AVERAGE_ALBEDO, COSINES, DIRECTIONAL_ALBEDO, gauss, reflected, viewer

from harness import assert_ulp

#: what the comments say: a white metal in a furnace with all that is lost returned; the albedo of a dielectric, and by
#: the exact Fresnel term
LOST, ALBEDO, ALBEDO_EXACT = 0.013, 0.007, 0.019


def albedos(cosine, roughness, nodes=90):
    """By quadrature over l in float64: E, and the albedo of the dielectric by Schlick and by Fresnel.

    The lobe is a peak around the mirror direction, where l is sampled evenly in the plane of h = (tan x, tan y, 1).
    """
    a = roughness**2
    x, w = gauss(nodes, -math.pi / 2, math.pi / 2)
    y, w_y = gauss(nodes, 0, math.pi / 2)
    X, Y = np.meshgrid(a * np.tan(x), a * np.tan(y), indexing="ij")
    weights = 2 * np.outer(w * a / np.cos(x) ** 2, w_y * a / np.cos(y) ** 2)
    cos_h = 1 / np.sqrt(1 + X**2 + Y**2)
    v_h = (X * math.sqrt(1 - cosine**2) + cosine) * cos_h
    NoL = 2 * v_h * cos_h - cosine
    lit = (NoL > 0) & (v_h > 0)
    NoL, c = np.where(lit, NoL, 1), np.where(lit, v_h, 1)
    D = ladder_reference.D_GGX(1 - cos_h**2, cos_h**2, a)
    f = D * ladder_reference.V_EXACT(NoL, cosine, c, a) * NoL * 4 * c * cos_h**3 * weights * lit
    return f.sum(), (f * schlick(0.04, c)).sum(), (f * dielectric(c)).sum()


def test_the_quadrature_is_right():
    """It stops at the horizon, a step that it does not resolve: to two digits."""
    for roughness, values in DIRECTIONAL_ALBEDO.items():
        for cosine, want in zip(COSINES, values, strict=True):
            assert albedos(cosine, roughness)[0] == pytest.approx(want, abs=5e-3)


@pytest.fixture(scope="module")
def anywhere():
    """Cosines, roughnesses, and the three albedos there."""
    random = np.random.default_rng(12)
    cosine, roughness = random.random(100) ** 1.5 * 0.999 + 1e-3, random.uniform(0.02, 1, 100)
    return cosine, roughness, np.array([albedos(*pair) for pair in zip(cosine, roughness, strict=True)]).T


def test_the_fits_are_as_good_as_their_comments_say(library, mode, anywhere):
    cosine, roughness, (E, by_schlick, exactly) = anywhere
    brdf = library("brdf.glsl", mode)
    lost = brdf.energy_lost(cosine, roughness).astype(float)
    effective = brdf.energy_cosine(cosine, roughness).astype(float)
    assert 0.6 * LOST < np.abs(E * (1 + lost) - 1).max() < LOST + 3e-3
    assert 0.6 * ALBEDO < np.abs(E * schlick(0.04, effective) - by_schlick).max() < ALBEDO + 3e-3
    assert 0.6 * ALBEDO_EXACT < np.abs(E * dielectric(effective) - exactly).max() < ALBEDO_EXACT + 3e-3


@pytest.mark.parametrize("roughness", DIRECTIONAL_ALBEDO)
def test_with_what_is_lost_a_white_metal_returns_all(library, mode, roughness):
    """Against the published figures, which no quadrature of ours made."""
    lost = library("brdf.glsl", mode).energy_lost(COSINES, roughness).astype(float)
    assert np.abs(np.array(DIRECTIONAL_ALBEDO[roughness]) * (1 + lost) - 1).max() < LOST


@pytest.mark.parametrize("roughness", AVERAGE_ALBEDO)
def test_the_average_of_what_is_not_lost(library, roughness):
    x, weights = gauss(20, 0, 1)
    E = 1 / (1 + library("brdf.glsl").energy_lost(x, roughness).astype(float))
    assert float(weights @ (E * 2 * x)) == pytest.approx(AVERAGE_ALBEDO[roughness], rel=LOST)


@pytest.mark.parametrize("name", ["energy_lost", "energy_cosine"])
def test_it_is_the_polynomial(library, mode, name):
    """Where terms cancel, the error is of their size: up to 60, and 4."""
    cosine, roughness = (g.ravel() for g in np.meshgrid(np.linspace(0, 1, 41), np.linspace(0.01, 1, 40)))
    cosine, roughness = np.float32(cosine), np.float32(roughness)
    got = library("brdf.glsl", mode)[name](cosine, roughness)
    want = getattr(ladder_reference, name)(cosine.astype(float), roughness.astype(float))
    size = 60 * 0.25 if name == "energy_lost" else 4
    np.testing.assert_allclose(got, want, rtol=0, atol=4 * size * 2.0**-24)


def test_the_ends(library, mode):
    """A mirror loses nothing, nor does a viewer at the horizon see it lost; 0/0 is 0."""
    brdf = library("brdf.glsl", mode)
    assert brdf.energy_lost(0, 0) == 0 and brdf.energy_cosine(0, 0) == 0
    assert (brdf.energy_lost([0, 0, 0], [1e-10, 0.3, 1]) == 0).all()
    assert (brdf.energy_lost([1e-10, 0.3, 1], 0) == 0).all()
    assert_ulp(brdf.energy_cosine([1e-10, 0.3, 1], 0), np.float32([1e-10, 0.3, 1]), max_ulp=1)
    # both so small that the guard takes no part yet: s = 1/2, as at any size
    want = 0.25 * np.polynomial.polynomial.polyval(0.5, ladder_reference.LOST[:, 0])
    assert_ulp(brdf.energy_lost(np.float32(1e-30), np.float32(1e-15)), want, max_ulp=40)


def test_the_fit_of_the_cosine_is_not_negative(library, mode):
    """Its polynomial is, by 2e-5, near the horizon of a very smooth surface."""
    assert library("brdf.glsl", mode).energy_cosine(1.665e-5, 0.001243) == 0
    assert (library("brdf.glsl", mode).energy_cosine(np.float32([1e-4, 0.5]), np.float32(0.001243)) > 0).all()


def test_the_ratio_that_they_are_functions_of(library, mode):
    """NoV/(NoV + alpha) down to 1e-30; 0/0 is 0, by 1e-37 in the divisor."""
    energy_s = library("brdf.glsl", mode).energy_s
    assert energy_s(0, 0) == 0
    assert_ulp(energy_s(np.float32([1e-30, 0.25]), np.float32([3e-30, 0.75])), [0.25, 0.25], max_ulp=3)
    assert_ulp(energy_s(np.float32(1e-37), 0), 0.5, max_ulp=3)


# ---- White furnaces --------------------------------------------------------------------------------------------------

#: the highlight to 1e-4
HIGHLIGHT_NODES = 100


def furnace(brdf, cosine, roughness, metalness=0.0):
    """What a white surface returns toward a cosine: the highlight of shade() by way of h, and diffuse() over l."""
    highlight = {"albedo": [metalness] * 3, "metalness": metalness}
    total = reflected(brdf.shade, cosine, roughness, highlight, HIGHLIGHT_NODES)
    v, _ = viewer(cosine)
    mu, w = gauss(40, 0, 1)
    phi, w_phi = gauss(40, 0, 2 * math.pi)
    sine = np.sqrt(1 - mu**2)
    l = np.stack(np.broadcast_arrays(sine * np.cos(phi)[:, None], sine * np.sin(phi)[:, None], mu), -1)  # noqa: E741
    white = {"albedo": [1, 1, 1], "metalness": metalness, "roughness": roughness}
    return total + float(w_phi @ (brdf.diffuse(l, v, [0, 0, 1], white)[..., 0].astype(float) * mu @ w))


MU = [0.003, 0.03, 0.2, 0.5, 1.0]


@pytest.mark.parametrize(("roughness", "most", "at_grazing"), [(0.045, 1.000, 0.88), (1.0, 0.974, 0.09)])
def test_shirleys_furnace(library, roughness, most, at_grazing):
    """It never returns more than it gets, and least near the horizon: the published figures."""
    brdf = library("brdf.glsl", BRDF_DIFFUSE="DIFFUSE_SHIRLEY")
    values = [furnace(brdf, cosine, roughness) for cosine in (0.001, 0.1, 0.8, 1.0)]
    assert max(values) == pytest.approx(most, abs=1e-3)
    assert values[0] == pytest.approx(at_grazing, abs=1e-2)
    assert values[0] == min(values)


@pytest.mark.parametrize("roughness", [0.045, 0.3, 1.0])
def test_what_is_left_of_the_albedo_conserves_energy(library, roughness):
    """1 and 1 exactly; here to the errors of both fits."""
    brdf = library("brdf.glsl", BRDF_DIFFUSE="DIFFUSE_ENERGY")
    values = [furnace(brdf, mu, roughness) for mu in MU]
    assert 1 - LOST - ALBEDO < min(values) and max(values) < 1 + LOST + ALBEDO


@pytest.mark.parametrize("roughness", [0.045, 0.3, 1.0])
@pytest.mark.parametrize("metalness", [0.0, 1.0])
def test_the_offline_preset_conserves_energy(library, roughness, metalness):
    brdf = library("brdf.glsl", BRDF_F="F_DIELECTRIC", BRDF_DIFFUSE="DIFFUSE_ENERGY", BRDF_MULTI="MULTI_FITTED")
    values = [furnace(brdf, mu, roughness, metalness) for mu in MU]
    assert 1 - LOST - ALBEDO_EXACT < min(values) and max(values) < 1 + LOST + ALBEDO_EXACT


@pytest.mark.parametrize("roughness", [0.2, 1.0])
def test_a_white_eon_surface_conserves_energy(library, roughness):
    """To the 0.1 % of its polynomial."""
    brdf = library("brdf.glsl", BRDF_DIFFUSE="DIFFUSE_EON")
    for cosine in (0.05, 0.3, 0.8, 1.0):
        black = reflected(brdf.shade, cosine, roughness, {"albedo": [0, 0, 0], "metalness": 0.0}, HIGHLIGHT_NODES)
        assert furnace(brdf, cosine, roughness) - black == pytest.approx(1, abs=2e-3)
