"""Model errors. Expected: known differences, and the published and measured ones of Hammon's visibility term."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError
from harness.trade import sampling
from harness.trade.model import disk, hemisphere, model


def test_a_known_error_has_its_quantiles(functions):
    """x + x^2/1024 for x: relative error x/1024, x spread evenly over 0 ... 1 but for one in 32, near the ends."""
    compiled = functions("float f(float x) { return x + x * x / 1024.0; } float exact(float x) { return x; }")
    found = model(compiled.f, compiled.exact, sampling.inputs(compiled.f, {"x": "[0,1]"}, 1 << 16))
    assert found["median"] == pytest.approx(0.5 / 1024, rel=0.01)
    assert found["p99"] == pytest.approx(0.99 / 1024, rel=0.01)
    assert found["max"] == pytest.approx(1 / 1024, rel=0.001) and found["at"]["x"] > 0.999


def test_only_the_formulas_count_not_their_rounding(functions):
    """n.n of a unit vector is 1 to 16 digits: in float32 vectors it would be off by 1e-7."""
    compiled = functions("float f(vec3 n) { return dot(n, n); } float one(vec3 n) { return 1.0; }")
    assert model(compiled.f, compiled.one, sampling.inputs(compiled.f, {"n": "unit"}, 1000))["max"] < 1e-15


@pytest.mark.parametrize(("roughness", "median", "largest"), [(0.2, 0.05, 0.28), (0.5, 0.12, 0.21)])
def test_Hammons_visibility(brdf, roughness, median, largest):
    """Measured elsewhere, to two digits: 5 and 28 % at roughness 0.2, 12 and 21 % at 0.5."""
    shaders = brdf()
    domain = {"NoL": "[0,1]", "NoV": "[0,1]", "alpha": roughness**2}
    flat = sampling.inputs(shaders.V_Hammon, domain, 1 << 16)
    found = model(shaders.V_Hammon, shaders.V_SmithGGXCorrelated, flat)
    assert found["median"] == pytest.approx(median, abs=0.01) and found["max"] == pytest.approx(largest, abs=0.01)


def test_Hammons_visibility_is_exact_at_roughness_1(brdf):
    shaders = brdf()
    flat = sampling.inputs(shaders.V_Hammon, {"NoL": "[0,1]", "NoV": "[0,1]", "alpha": 1.0}, 1000)
    assert model(shaders.V_Hammon, shaders.V_SmithGGXCorrelated, flat)["max"] < 1e-15


# ---- The hemisphere --------------------------------------------------------------------------------------------------


def test_the_disk_is_the_hemisphere_seen_from_above():
    directions = disk(64)
    inside = ~np.isnan(directions[..., 0])
    assert inside.mean() == pytest.approx(np.pi / 4, abs=0.01)
    np.testing.assert_allclose(np.linalg.norm(directions[inside], axis=-1), 1, rtol=1e-12)
    assert directions[0, 32, 1] > 0 > directions[-1, 32, 1] and directions[32, 0, 0] < 0 < directions[32, -1, 0]


def test_the_map_is_that_of_the_light(model):
    """Off by 1 + (l.x)/8: an error |l.x|/8 of the exact value at each place; nothing is told outside of the disk."""
    exact, off = model("return m.albedo * dot(n, l);"), model("return m.albedo * dot(n, l) * (1.0 + l.x / 8.0);")
    found = hemisphere(off, exact, view=60, roughness=0.3, size=32)
    np.testing.assert_allclose(found, np.abs(disk(32)[..., 0]) / 8, rtol=1e-9)
    assert np.isnan(found[0, 0])


def test_the_viewer_stands_to_the_right(model):
    """At 60 degrees from the normal toward +x; roughness, metalness and the grey 0.5 arrive."""
    wanted = "dot(abs(v - vec3(sqrt(0.75), 0.0, 0.5)), vec3(1.0)) < 1e-6 && abs(m.roughness - 0.3) < 1e-6"
    right = model(f"return ({wanted} && m.metalness == 1.0 && n.z == 1.0) ? m.albedo : vec3(9.0);")
    found = hemisphere(right, model("return vec3(0.5);"), view=60, roughness=0.3, metalness=1, size=8)
    assert np.nanmax(found) == 0


def test_what_is_not_called_as_shade_is_refused(functions):
    f = functions("float f(vec3 l) { return l.x; }").f
    with pytest.raises(CallError, match="float f"):
        hemisphere(f, f, view=60, roughness=0.3)
