"""The reference itself against an independent implementation: Mitsuba 3's GGX."""

from __future__ import annotations

import numpy as np
import pytest
import reference

mitsuba = pytest.importorskip("mitsuba", reason="Mitsuba 3 has no build for this machine")

#: Mitsuba computes in float32; its D takes about ten roundings, worse only where the lobe is narrow
MITSUBA_RTOL = 1e-5


@pytest.fixture(scope="module")
def mi():
    mitsuba.set_variant("scalar_rgb")
    return mitsuba


ALPHAS = [0.05, 0.2, 0.5, 1.0]
ANGLES = [0.0, 0.1, 0.3, 0.7, 1.2, 1.5]


@pytest.mark.parametrize("alpha", ALPHAS)
def test_D_is_mitsubas(mi, alpha):
    distribution = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, sample_visible=False)
    for theta in ANGLES:
        h = [float(np.sin(theta)), 0.0, float(np.cos(theta))]
        assert float(distribution.eval(h)) == pytest.approx(
            float(reference.D_GGX(np.cos(theta), alpha)), rel=MITSUBA_RTOL / alpha
        )


@pytest.mark.parametrize("alpha", ALPHAS)
def test_smiths_G1_is_mitsubas(mi, alpha):
    """Mitsuba's G is separable, G1(l) G1(v), the exercise's height-correlated; they share G1 = 1/(1 + Lambda)."""
    distribution = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, sample_visible=False)
    for theta in ANGLES:
        v = [float(np.sin(theta)), 0.0, float(np.cos(theta))]
        G1 = 1 / (1 + reference.smith_lambda(np.cos(theta), alpha))
        assert float(distribution.smith_g1(v, [0, 0, 1])) == pytest.approx(float(G1), rel=MITSUBA_RTOL)
