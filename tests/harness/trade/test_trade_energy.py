"""The furnace and reciprocity. Expected: integrals in closed form, and those of adaptive quadrature elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness import CallError
from harness.trade import energy, sampling

#: single-scattering GGX with F = 1, directional albedo by adaptive quadrature, good to 2e-12; roughness -> cosines
ALBEDO = {
    0.1: {0.05: 0.9762076, 0.2: 0.9985874, 1.0: 0.9998986},
    0.5: {0.05: 0.9331317, 0.2: 0.8481600, 1.0: 0.9158124},
    1.0: {0.05: 0.8477739, 0.2: 0.6416481, 1.0: 1 - math.log(2)},
}
#: a white dielectric by the exercise's model: it returns more than it gets
FURNACE = [(0.045, 0.01, 1.857), (0.3, 0.001, 1.377), (1.0, 0.001, 1.018)]


@pytest.fixture(scope="module")
def double(brdf):
    return brdf().shade.with_mode("double")


@pytest.mark.parametrize("roughness", ALBEDO)
def test_white_metal(double, roughness):
    got = [energy.highlight(double, roughness, cosine, albedo=1, metalness=1) for cosine in ALBEDO[roughness]]
    np.testing.assert_allclose(got, list(ALBEDO[roughness].values()), rtol=0, atol=1e-6)


@pytest.mark.parametrize(("roughness", "cosine", "stated"), FURNACE)
def test_white_dielectric(double, roughness, cosine, stated):
    assert energy.dielectric(double, roughness, cosine) == pytest.approx(stated, abs=6e-4)


def test_the_project_returns_most_where_it_is_stated(brdf, monkeypatch):
    monkeypatch.setattr(energy, "ROUGHNESS", (0.045, 0.3, 1.0))
    monkeypatch.setattr(energy, "COSINES", (0.01, 1.0))
    found = energy.energy(brdf().shade)
    assert found["furnace_max"] == found["dielectric"]["max"] == pytest.approx(1.857, abs=6e-4)
    assert found["dielectric"]["max_at"] == {"roughness": 0.045, "cosine": 0.01}
    assert found["furnace_min"] == found["metal"]["min"] == pytest.approx(1 - math.log(2), abs=1e-6)
    assert found["metal"]["min_at"] == {"roughness": 1.0, "cosine": 1.0}
    assert found["reciprocity"] < 1e-9


def test_Lambert_returns_all(model, monkeypatch):
    """The integral of n.l/pi is 1 for every viewer; a metal of the same formula, too."""
    monkeypatch.setattr(energy, "ROUGHNESS", (0.045, 1.0))
    found = energy.energy(model("return m.albedo * max(dot(n, l), 0.0) / 3.14159265358979;"))
    assert found["furnace_max"] == pytest.approx(1, abs=1e-9)
    assert found["furnace_min"] == pytest.approx(1, abs=1e-9)
    assert found["reciprocity"] < 1e-12


def test_light_that_goes_one_way_only_is_a_defect(model):
    """A BRDF of n.v: back it is n.l, and the difference relative to the larger is 1 - smaller/larger."""
    function = model("return m.albedo * max(dot(n, l), 0.0) * dot(n, v);")
    flat = sampling.inputs(function, sampling.SHADE, 1000)
    cosines = [np.sum(flat["n"] * flat[name], axis=1) for name in "lv"]
    expected = np.max(1 - np.minimum(*cosines) / np.maximum(*cosines))
    assert energy.reciprocity(function, flat) == pytest.approx(expected, rel=1e-9)


def test_what_is_not_a_number_is_not_hidden(model):
    found = energy.energy(model("return m.roughness == 1.0 ? vec3(0.0 / (m.roughness - 1.0)) : m.albedo;"))
    assert math.isnan(found["dielectric"]["max"]) and math.isnan(found["furnace_max"])


def test_what_is_not_called_as_shade_is_refused(functions):
    with pytest.raises(CallError, match="shade"):
        energy.energy(functions("vec3 f(vec3 l, vec3 v) { return l; }").f)
