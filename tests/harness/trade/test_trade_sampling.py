"""The inputs that errors are measured at. Expected: the distributions that the module states, and geometry."""

from __future__ import annotations

import numpy as np
import pytest

from harness.trade import sampling

N = 20_000
#: of a share of N inputs, five standard deviations at most
OFF = 5 * 0.5 / np.sqrt(N)


@pytest.fixture(scope="module")
def surfaces(brdf):
    return sampling.inputs(brdf().shade, sampling.SHADE, N)


def dot(a, b):
    return np.sum(a * b, axis=-1)


def test_vectors_are_unit_in_double_and_above_the_horizon(surfaces):
    for name in "lvn":
        assert np.abs(np.linalg.norm(surfaces[name], axis=1) - 1).max() < 4e-16
    for name in "lv":
        assert dot(surfaces["n"], surfaces[name]).min() > 0.999 * sampling.GRAZING


def test_normals_point_anywhere(surfaces):
    assert np.abs(surfaces["n"].mean(axis=0)).max() < OFF


def test_the_viewers_cosine_and_roughness_are_spread_evenly(surfaces):
    for values in (dot(surfaces["n"], surfaces["v"]), surfaces["m.roughness"]):
        for share in (0.25, 0.5, 0.75):
            assert np.mean(values < share) == pytest.approx(share, abs=OFF)


def test_a_third_is_metal_and_a_third_is_none(surfaces):
    assert np.mean(surfaces["m.metalness"] == 0) == pytest.approx(1 / 3, abs=OFF)
    assert np.mean(surfaces["m.metalness"] == 1) == pytest.approx(1 / 3, abs=OFF)


def test_every_second_light_is_in_the_highlight(surfaces):
    """Of a GGX surface half the facets' area is tilted by less than arctan(alpha), whatever alpha [Walter et al. 2007].

    Lights below the horizon are replaced; where alpha is below 0.1 there are few.
    """
    h = surfaces["l"] + surfaces["v"]
    tangent = np.linalg.norm(np.cross(surfaces["n"], h), axis=1) / dot(surfaces["n"], h)
    smooth = (surfaces["m.roughness"] < 0.3) & (dot(surfaces["n"], surfaces["v"]) > 0.5)
    every_second = smooth & (np.arange(N) % 2 == 0)
    share = np.mean(tangent[every_second] < surfaces["m.roughness"][every_second] ** 2)
    assert share == pytest.approx(0.5, abs=5 * 0.5 / np.sqrt(every_second.sum()))


def test_cosines_are_those_of_one_pair_of_directions(functions):
    """n.h |l + v| = n.l + n.v, and |l + v| = 2 l.h."""
    f = functions("float f(float NoL, float NoV, float NoH, float LoH) { return NoL; }").f
    made = sampling.inputs(f, dict.fromkeys(("NoL", "NoV", "NoH", "LoH"), "[0,1]"), N)
    np.testing.assert_allclose(made["NoH"] * 2 * made["LoH"], made["NoL"] + made["NoV"], rtol=1e-9)
    for name in ("NoL", "NoV"):
        assert np.median(made[name]) == pytest.approx(0.5, abs=OFF)


def test_alpha_is_the_square_of_an_even_roughness(functions):
    made = sampling.inputs(functions("float f(float alpha) { return alpha; }").f, {"alpha": "[0,1]"}, N)
    assert np.mean(made["alpha"] < 0.25) == pytest.approx(0.5, abs=OFF)


def test_an_interval_is_kept_and_its_ends_are_approached(functions):
    made = sampling.inputs(functions("float f(vec2 x) { return x.y; }").f, {"x": "[-3,5]"}, N)["x"]
    assert made.shape == (N, 2) and made.min() >= -3 and made.max() <= 5
    assert made.min() < -3 + 8e-3 and made.max() > 5 - 8e-3
    assert np.mean(made < 1) == pytest.approx(0.5, abs=OFF)


def test_given_values_are_taken(functions):
    f = functions("float f(float x, float k, int j) { return x * k; }").f
    made = sampling.inputs(f, {"x": "[0,1]", "k": [2.0, 3.0], "j": "[4,6]"}, 1000)
    assert set(made["k"]) == {2, 3} and set(made["j"]) == {4, 5, 6}


def test_the_set_is_always_the_same(brdf, surfaces):
    again = sampling.inputs(brdf().shade, sampling.SHADE, N)
    assert all(np.array_equal(again[name], surfaces[name]) for name in again)
