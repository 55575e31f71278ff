"""The set of extreme inputs: that it has what it states; and counts of what breaks, of shaders that break as known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from harness.trade import extremes

N = 1 << 14


@pytest.fixture(scope="module")
def flat():
    return extremes.inputs(N)


def dot(a, b):
    return np.sum(a.astype(float) * b, axis=-1)


def test_there_are_a_million(brdf):
    assert extremes.COUNT >= 2**20


def test_it_is_always_the_same(flat):
    again = extremes.inputs(N)
    assert all(np.array_equal(again[name], flat[name]) for name in flat)


def test_the_inputs_are_what_shade_is_defined_for(flat):
    for name in "lvn":
        assert np.abs(np.linalg.norm(flat[name].astype(float), axis=1) - 1).max() < 2e-7
    for name in ("m.albedo", "m.metalness", "m.roughness"):
        assert flat[name].min() == 0 and flat[name].max() == 1


#: kind -> (how to tell it, the least share of the inputs that are of it)
KINDS = {
    "l = v = n": (lambda x: (x.l == x.v).all(1) & (x.l == x.n).all(1), 1 / 9),
    "l = -v": (lambda x: (x.l == -x.v).all(1), 1 / 8),
    "l = -v on the horizon": (lambda x: (x.l == -x.v).all(1) & (dot(x.l, x.n) == 0), 1 / 100),
    "l nearly -v": (lambda x: (x.l != -x.v).any(1) & (dot(x.l, x.v) < -0.999999), 1 / 16),
    "nearly opposite just above the horizon, unequal cosines": (
        lambda x: (dot(x.l, x.n) > 0)
        & (dot(x.v, x.n) > 9 * dot(x.l, x.n))
        & (dot(x.v, x.n) < 0.01)
        & (dot(x.l, x.v) < 0),
        1 / 40,
    ),
    "mirror images": (lambda x: mirrored(x), 1 / 16),
    "mirror images at roughness 0": (lambda x: mirrored(x) & (x.roughness == 0), 1 / 120),
    "behind the surface": (lambda x: dot(x.l, x.n) < -0.1, 1 / 120),
    "roughness 0": (lambda x: x.roughness == 0, 1 / 7),
    "denormal roughness": (lambda x: (x.roughness > 0) & (x.roughness < 2.0**-126), 1 / 7),
    "roughness 1e-6": (lambda x: x.roughness == np.float32(1e-6), 1 / 60),
}


def mirrored(x):
    return (x.n[:, 2] == 1) & (x.l[:, :2] == -x.v[:, :2]).all(1) & (x.l[:, 2] == x.v[:, 2])


@pytest.mark.parametrize("kind", KINDS)
def test_it_has(flat, kind):
    inputs = SimpleNamespace(**{name: flat[name] for name in "lvn"}, roughness=flat["m.roughness"])
    find, share = KINDS[kind]
    assert find(inputs).mean() >= share


def test_what_breaks_is_counted_in_evaluations(model, flat):
    """NaN in two channels at roughness 0, Inf where the albedo's red is 1, negative where metalness is above 0.5."""
    function = model("""
        vec3 c = m.metalness > 0.5 ? vec3(-1.0, 0.5, 0.5) : vec3(0.5);
        if (m.roughness == 0.0) c.yz = vec2(m.roughness / m.roughness);
        if (m.albedo.r == 1.0) c.z = 1.0 / (m.albedo.r - 1.0);
        return c;
    """)
    broken = (flat["m.roughness"] == 0) | (flat["m.albedo"][:, 0] == 1)
    found = extremes.count_broken(function.with_mode("double"), flat)
    assert found == {"non_finite": int(broken.sum()), "negative": int((flat["m.metalness"] > 0.5).sum())}
    assert 0 < found["non_finite"] < N and 0 < found["negative"] < N


def test_minus_zero_is_not_negative(model, flat):
    assert extremes.count_broken(model("return m.albedo * -0.0;"), flat) == {"non_finite": 0, "negative": 0}


@pytest.mark.parametrize("mode", ["as-written", "precise", "double"])
def test_the_projects_model_never_breaks(brdf, flat, mode):
    assert extremes.count_broken(brdf().shade.with_mode(mode), flat) == {"non_finite": 0, "negative": 0}
