"""The steps in the comment of shade(), one by one at 50 digits: what it computes is what the exercise writes."""

from __future__ import annotations

from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
import reference
from reference import cross, dot, unit

from harness import shader

#: what 50 digits leave of an equation between numbers of about 1
CLOSE = mp.mpf(10) ** -42
PI, DIELECTRIC_F0 = mp.pi, mp.mpf(4) / 100


def scenes():
    """Anywhere over the hemisphere; and at the extremes, where there is a half vector and a highlight."""
    extremes = [group[0] for group in reference.scenes()]
    lit = [s for s in extremes if min(dot(s.n, s.l), dot(s.n, s.v)) > 0 and s.material.roughness > 0]
    return reference.random_scenes(50, seed=3) + lit


def names(scene):
    """The numbers that the comment speaks of, each from its definition there: none from another that a step proves."""
    s = SimpleNamespace(l=scene.l, v=scene.v, n=scene.n, albedo=[mp.mpf(a) for a in scene.material.albedo])
    s.m, s.alpha = mp.mpf(scene.material.metalness), mp.mpf(scene.material.roughness) ** 2
    s.H = tuple((p + q) / 2 for p, q in zip(s.l, s.v, strict=True))
    s.h = unit(s.H)
    s.nH, s.c = dot(s.n, s.H), dot(s.l, s.h)
    s.HH, s.sin2 = dot(s.H, s.H), dot(cross(s.n, s.H), cross(s.n, s.H))
    s.x = 1 - s.c
    s.w = s.x**5
    s.q, s.y, s.W = (1 - s.x**2) / 2, 1 - s.x**4, 1 - s.w
    s.A, s.G = s.m * s.W, (1 - s.m) * s.W
    s.B, s.Z = s.w + DIELECTRIC_F0 * s.G, s.W - DIELECTRIC_F0 * s.G
    return s


@pytest.fixture(scope="module")
def everywhere():
    return [names(scene) for scene in scenes()]


def highlight(s):
    """D V, from the exercise's terms."""
    return reference.D_GGX(dot(s.n, s.h), s.alpha) * reference.V_SmithGGXCorrelated(
        dot(s.n, s.l), dot(s.n, s.v), s.alpha
    )


def fresnel(s, albedo):
    """Schlick's F of a material, from the exercise's F0."""
    return reference.F_Schlick(DIELECTRIC_F0 * (1 - s.m) + s.m * albedo, s.c)


def test_step_1_cosines_without_a_unit_half_vector(everywhere):
    for s in everywhere:
        assert abs((dot(s.n, s.l) + dot(s.n, s.v)) / 2 - s.nH) < CLOSE
        assert abs(mp.sqrt(s.HH) - s.c) < CLOSE
        assert abs(dot(s.n, s.h) * mp.sqrt(s.HH) - s.nH) < CLOSE


def test_step_2_sine_and_cosine_make_the_length(everywhere):
    for s in everywhere:
        p = tuple(a - b * s.nH for a, b in zip(s.H, s.n, strict=True))
        assert abs(dot(p, p) + s.nH**2 - s.HH) < CLOSE * s.HH
        assert abs(dot(p, p) - s.sin2) < CLOSE * s.HH


def test_step_2_a_normal_that_is_not_quite_unit_is_one_that_is_turned(everywhere):
    """By |n|^2 - 1, which is 2 U at most and makes p longer along n; then 4 U for the roundings of n.H and p."""
    for s in everywhere:
        for e in (mp.mpf(2) ** -24, -(mp.mpf(2) ** -24)):
            n = tuple((1 + e) * a for a in s.n)
            p = tuple(a - b * dot(n, s.H) for a, b in zip(s.H, n, strict=True))
            along = dot(p, s.n)
            assert abs(dot(p, p) - along**2 - s.sin2) < CLOSE * s.HH
            assert abs(along) <= 2.01 * abs(e) * s.nH
    assert 6 * mp.mpf(2) ** -24 < 4e-7


def test_step_3_the_distribution_from_sine_and_cosine(everywhere):
    for s in everywhere:
        k = s.alpha * s.HH / (s.sin2 + s.alpha**2 * s.nH**2)
        # 1 + (n.h)^2 (alpha^2 - 1) cancels down to alpha^2, and is squared
        assert abs(k**2 / PI / reference.D_GGX(dot(s.n, s.h), s.alpha) - 1) < CLOSE / s.alpha**2


def test_step_4_one_minus_the_fifth_power_without_cancelling(everywhere):
    for s in everywhere:
        c, x = s.c, s.x
        q = c - c**2 / 2
        y = 4 * (q - q**2)
        assert abs(2 * q - (1 - x**2)) < CLOSE
        assert abs((1 - x**2) * (1 + x**2) - y) < CLOSE
        assert abs(1 - x**4 - y) < CLOSE
        assert abs(x - x * y - s.w) < CLOSE
        assert abs(c + x * y - s.W) < CLOSE
        # Where c is small, so is what is taken off: q is c but for c/2 of it, y is 4q but for q of it
        assert min(c, x * y) >= 0
        assert c**2 / 2 <= c / 2 and q**2 <= q / 2


def test_step_5_fresnel_is_affine_in_the_albedo(everywhere):
    for s in everywhere:
        for albedo in s.albedo:
            assert abs(s.A * albedo + s.B - fresnel(s, albedo)) < CLOSE


def test_step_6_and_so_is_what_is_left_for_scattering(everywhere):
    for s in everywhere:
        assert abs(1 - s.B - s.Z) < CLOSE
        for albedo in s.albedo:
            assert abs(s.Z - s.A * albedo - (1 - fresnel(s, albedo))) < CLOSE


def test_step_7_the_whole_is_a_quadratic_in_the_albedo_and_not_negative(everywhere):
    for s in everywhere:
        NoL, NoV = dot(s.n, s.l), dot(s.n, s.v)
        D, V = reference.D_GGX(dot(s.n, s.h), s.alpha), reference.V_SmithGGXCorrelated(NoL, NoV, s.alpha)
        S, E = D * V * NoL, (1 - s.m) * NoL / PI
        for albedo in s.albedo:
            F = fresnel(s, albedo)
            exercise = (D * V * F + (1 - s.m) * (1 - F) * albedo / PI) * NoL
            assert abs((S * s.A + E * s.Z - E * s.A * albedo) * albedo + S * s.B - exercise) < CLOSE * (1 + S)
        assert abs(s.Z - s.A - mp.mpf(96) / 100 * s.G) < CLOSE
        assert s.Z >= s.A


def test_the_shaders_locals_are_what_the_comment_calls_them(root):
    """In double, so that its arithmetic is exact here; its vectors are float32 and so unit to 1e-7, which roughness 0.5
    and more magnify by less than 16 in k, and squared."""
    found = [s for s in reference.random_scenes(200, seed=5) if s.material.roughness >= 0.5]
    assert len(found) > 15
    l, v, n = (np.array([reference.rounded(getattr(s, a)) for s in found]) for a in "lvn")  # noqa: E741
    fields = ("albedo", "metalness", "roughness")
    material = {a: np.array([getattr(s.material, a) for s in found], np.float32) for a in fields}
    traced = shader(root / "shaders" / "brdf.glsl", mode="double").shade.trace(l, v, n, material)
    values = {local.name: local.values for local in traced}
    want = [names(s) for s in found]
    for name, of in {
        "alpha": lambda s: s.alpha,
        "NoHH": lambda s: s.nH,
        "sin2": lambda s: s.sin2,
        "cos2": lambda s: s.nH**2,
        "HH": lambda s: s.HH,
        "k": lambda s: mp.sqrt(PI * reference.D_GGX(dot(s.n, s.h), s.alpha)),
        "V": lambda s: reference.V_SmithGGXCorrelated(dot(s.n, s.l), dot(s.n, s.v), s.alpha),
        "lit": lambda s: dot(s.n, s.l) / (2 * PI),
        "c": lambda s: s.c,
        "x": lambda s: s.x,
        "q": lambda s: s.q,
        "y": lambda s: s.y,
        "W": lambda s: s.W,
        "w": lambda s: s.w,
        "A": lambda s: s.A,
        "G": lambda s: s.G,
        "B": lambda s: s.B,
        "E": lambda s: (1 - s.m) * dot(s.n, s.l) / PI,
        "S": lambda s: highlight(s) * dot(s.n, s.l),
        "Z": lambda s: s.Z,
    }.items():
        np.testing.assert_allclose(values[name], [float(of(s)) for s in want], rtol=2e-5, atol=1e-7, err_msg=name)
