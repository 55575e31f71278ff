"""How much light the model returns: quadrature of the shader's own output over the hemisphere.

The microfacet normal h is integrated instead of l: in polar coordinates around n with t = tan(theta), where
l = 2 (v.h) h - v is above the horizon for t below a root known in closed form, the integrand is smooth, and
Gauss-Legendre converges at once.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import reference

#: Single-scattering GGX with F = 1: directional albedo E(mu, roughness) by adaptive quadrature, good to 2e-12.
COSINES = [0.05, 0.1, 0.2, 0.5, 1.0]
DIRECTIONAL_ALBEDO = {
    0.1: [0.9762076, 0.9941240, 0.9985874, 0.9997421, 0.9998986],
    0.3: [0.9074379, 0.8843244, 0.9140263, 0.9750895, 0.9906655],
    0.5: [0.9331317, 0.8916224, 0.8481600, 0.8572634, 0.9158124],
    0.7: [0.9137248, 0.8619134, 0.7927155, 0.7039735, 0.6977504],
    1.0: [0.8477739, 0.7602105, 0.6416481, 0.4506939, 1 - math.log(2)],
}
#: The same averaged over the hemisphere, weighted with the cosine: 2 integral of E(mu) mu dmu.
AVERAGE_ALBEDO = {0.1: 0.9994905, 0.3: 0.9765067, 0.5: 0.8823234, 0.7: 0.7074311, 1.0: 0.4091371}
#: Half a unit of the sixth digit. The float32 noise of 40 000 samples averages out below it.
SIX_DIGITS = 5e-7
#: A white dielectric in a white furnace, by the exercise's model: (roughness, cosine, what it returns).
FURNACE_MAXIMUM = [(0.045, 0.01, 1.857), (0.3, 0.001, 1.377), (1.0, 0.001, 1.018)]
NODES = 400


def gauss(n, low, high):
    x, w = np.polynomial.legendre.leggauss(n)
    return low + (high - low) * (x + 1) / 2, w * (high - low) / 2


def viewer(cosine):
    """A float32 direction at a cosine to +z, and its azimuth: of many, the one whose length is nearest to 1.

    An error of 3e-8 in the length of v, which float32 allows, moves E(0.05) by 8e-7; it is no error of the shader.
    """
    azimuth = np.linspace(0, 1, 4001)
    sine = math.sqrt(1 - cosine**2)
    v = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.full_like(azimuth, cosine)], -1)
    v = v.astype(np.float32).astype(float)
    v = v[np.argmin(np.abs((v**2).sum(-1) - 1))]
    return v, math.atan2(v[1], v[0])


def reflected(shade, cosine, roughness, material, nodes=NODES):
    """The integral of shade over l by way of h, for a lobe as narrow as the roughness says."""
    v, azimuth = viewer(cosine)
    phi, w_phi = gauss(nodes, 0, math.pi)
    a = roughness**2
    along = math.sqrt(1 - cosine**2) * np.cos(phi)
    t_end = (along + np.sqrt(along**2 + cosine**2)) / cosine
    # u = atan(t/a) spreads the lobe, which is 1/(a^2 + t^2)^2, evenly
    u, w_u = gauss(nodes, 0, 1)
    end = np.arctan(t_end / a)[:, None]
    t = a * np.tan(end * u)
    dt = a * (1 + (t / a) ** 2) * end
    cos_h = 1 / np.sqrt(1 + t**2)
    sin_h = t * cos_h
    h = np.stack([sin_h * np.cos(phi + azimuth)[:, None], sin_h * np.sin(phi + azimuth)[:, None], cos_h], -1)
    v_h = h @ v
    l = 2 * v_h[..., None] * h - v  # noqa: E741
    values = shade(l, v, [0, 0, 1], {**material, "roughness": roughness})[..., 0].astype(float)
    # dl = 4 (v.h) dh, dh = sin dtheta dphi = t/(1 + t^2)^(3/2) dt dphi; both halves of phi are alike
    integrand = values * 4 * v_h * t * cos_h**3 * dt
    return 2 * float(w_phi @ (integrand @ w_u))


def scattered(shade, cosine, material):
    """The integral of the diffuse part: at roughness 0 it is all there is, and smooth but for |l + v| at l = -v."""
    v = np.array([math.sqrt(1 - cosine**2), 0.0, cosine])
    mu, w_mu = gauss(NODES, 0, 1)
    phi, w_phi = gauss(NODES, 0, math.pi)
    sine = np.sqrt(1 - mu**2)
    l = np.stack(np.broadcast_arrays(sine * np.cos(phi)[:, None], sine * np.sin(phi)[:, None], mu), -1)  # noqa: E741
    values = shade(l, v, [0, 0, 1], {**material, "roughness": 0.0})[..., 0].astype(float)
    return 2 * float(w_phi @ (values @ w_mu))


WHITE_METAL = {"albedo": [1, 1, 1], "metalness": 1.0}
BLACK = {"albedo": [0, 0, 0], "metalness": 0.0}
WHITE = {"albedo": [1, 1, 1], "metalness": 0.0}


def furnace(shade, cosine, roughness):
    """What a white dielectric returns of a white furnace toward a cosine: highlight and diffuse part apart."""
    return reflected(shade, cosine, roughness, BLACK) + scattered(shade, cosine, WHITE)


@pytest.mark.parametrize("roughness", DIRECTIONAL_ALBEDO)
def test_directional_albedo(library, mode, roughness):
    shade = library("brdf.glsl", mode).shade
    got = [reflected(shade, cosine, roughness, WHITE_METAL) for cosine in COSINES]
    np.testing.assert_allclose(got, DIRECTIONAL_ALBEDO[roughness], rtol=0, atol=SIX_DIGITS)


@pytest.mark.parametrize("roughness", AVERAGE_ALBEDO)
def test_average_albedo(library, mode, roughness):
    """Over mu = x^2, which spreads the horizon, where E of a smooth surface bends sharply."""
    shade = library("brdf.glsl", mode).shade
    x, weights = gauss(20, 0, 1)
    values = np.array([reflected(shade, mu, roughness, WHITE_METAL) for mu in x**2])
    assert float(weights @ (values * 4 * x**3)) == pytest.approx(AVERAGE_ALBEDO[roughness], abs=SIX_DIGITS)


@pytest.mark.parametrize(("roughness", "cosine", "stated"), FURNACE_MAXIMUM)
def test_the_furnaces_maximum(library, mode, roughness, cosine, stated):
    """The exercise's weight 1 - F(h.l) is not energy conserving: a stated property of the model, not hidden."""
    shade = library("brdf.glsl", mode).shade
    assert furnace(shade, cosine, roughness) == pytest.approx(stated, abs=5e-4)


@pytest.mark.parametrize("roughness", [0.3, 1.0])
def test_the_furnace_returns_most_at_grazing(library, roughness):
    shade = library("brdf.glsl").shade
    grazing = furnace(shade, 0.001, roughness)
    assert all(furnace(shade, cosine, roughness) < grazing for cosine in (0.01, 0.1, 0.3, 0.6, 1.0))


def test_a_black_dielectric_reflects_less_than_it_gets(library, mode):
    shade = library("brdf.glsl", mode).shade
    for roughness in (0.1, 0.5, 1.0):
        for cosine in COSINES:
            assert 0.04 * 0.3 < reflected(shade, cosine, roughness, BLACK) < 1


def test_the_quadrature_knows_the_reference(library):
    """The same integral of the reference at one point, so that the table and the shader are not the only witnesses."""
    import mpmath as mp

    with mp.workdps(15):
        v = reference.direction(0.5, 0)
        white = reference.Material((1.0, 1.0, 1.0), 1.0, 1.0)

        def integrand(mu, phi):
            s = mp.sqrt(1 - mu**2)
            return reference.shade((s * mp.cos(phi), s * mp.sin(phi), mu), v, reference.vector(0, 0, 1), white)[0]

        total = 2 * mp.quad(
            lambda mu: mp.quad(lambda phi: integrand(mu, phi), [0, mp.pi], maxdegree=4), [0, 1], maxdegree=4
        )
    assert float(total) == pytest.approx(DIRECTIONAL_ALBEDO[1.0][3], abs=1e-6)
