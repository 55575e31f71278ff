"""shade_exercise(): the exercise's formulas term by term, where they have digits; every cosine clamped to 0...1."""

from __future__ import annotations

import itertools

import mpmath as mp
import numpy as np
import pytest
import reference

U = 2.0**-24
#: (cosine of l, cosine of v, azimuth between them in turns): ordinary, cosines of l.h and of n below 0.1, viewer behind
#: the surface with n.h above 0 and below
GEOMETRIES = [
    (0.3, 0.8, 0.25),
    (0.05, 0.05, 0.5),
    (0.05, 0.9, 0.3),
    (0.9, 0.05, 0.3),
    (0.8, -0.1, 0.4),
    (0.3, -0.8, 0.25),
    (0.5, -0.9, 0.5),
]
ROUGHNESSES = [0.5, 0.75, 1.0]
#: n.h is off by 3 U of 1, which goes into d = 1 - (n.h)^2 (1 - alpha^2), at least 1/16 here, and twice into D; the
#: cosines are off by 3 U of 0.05 at least; some more roundings
TOLERANCE = 2 * 2 * 3 * U * 16 + 3 * U / 0.05 * 2 + 12 * U


def exercise(l, v, n, m):  # noqa: E741
    """(diffuse + specular) (n.l)+ with every cosine clamped, at 50 digits."""
    h = reference.unit(tuple(a + b for a, b in zip(l, v, strict=True)))
    NoL, NoV, NoH, LoH = (reference.clamp(reference.dot(a, b)) for a, b in ((n, l), (n, v), (n, h), (l, h)))
    alpha = mp.mpf(m.roughness) ** 2
    highlight = reference.D_GGX(NoH, alpha) * reference.V_SmithGGXCorrelated(NoL, NoV, alpha)
    result = []
    for albedo in map(mp.mpf, m.albedo):
        F = reference.F_Schlick(mp.mpf(0.04) * (1 - mp.mpf(m.metalness)) + albedo * m.metalness, LoH)
        result.append((F * highlight + (1 - mp.mpf(m.metalness)) * (1 - F) * albedo / mp.pi) * NoL)
    return result


def scenes(geometries):
    """Every geometry with every roughness in every orientation, the materials taken in turn."""
    materials = itertools.cycle(reference.MATERIALS)
    return [
        reference.scene(geometry, turn, *next(materials), roughness)
        for geometry, roughness, turn in itertools.product(geometries, ROUGHNESSES, reference.TURNS)
    ]


def called(function, found):
    l, v, n = (np.array([reference.rounded(getattr(s, a)) for s in found]) for a in "lvn")  # noqa: E741
    names = ("albedo", "metalness", "roughness")
    return function(l, v, n, {a: np.array([getattr(s.material, a) for s in found], np.float32) for a in names})


def test_it_is_the_exercises_formula(library, mode):
    found = scenes(GEOMETRIES)
    got = called(library("brdf.glsl", mode).shade_exercise, found)
    vectors = ([reference.vector(*map(float, reference.rounded(a))) for a in (s.l, s.v, s.n)] for s in found)
    want = np.array([exercise(*lvn, s.material) for lvn, s in zip(vectors, found, strict=True)], float)
    np.testing.assert_allclose(got, want, rtol=TOLERANCE, atol=0)


def test_a_light_behind_the_surface_is_not_seen(library, mode):
    found = scenes([(cosine, 0.5, 0.3) for cosine in (-1.0, -0.3, -0.01)])
    assert (called(library("brdf.glsl", mode).shade_exercise, found) == 0).all()


def above_one():
    """Rounded unit vectors whose product with themselves is above 1 in float32, in whatever order it is summed."""
    random = np.random.default_rng(8).standard_normal((4000, 3))
    n = (random / np.linalg.norm(random, axis=1, keepdims=True)).astype(np.float32)
    x, y, z = (n * n).T
    return n[((x + y) + z > 1) & (x + (y + z) > 1) & ((x + z) + y > 1)]


DIFFUSE = {"albedo": [1, 1, 1], "metalness": 0, "roughness": 0}
SHARP = {"albedo": [1, 0.5, 0.2], "metalness": 1, "roughness": 0.03}


@pytest.mark.parametrize(("function", "material"), [("shade", DIFFUSE), ("shade", SHARP), ("shade_exercise", DIFFUSE)])
def test_cosines_that_rounding_lifts_above_one_count_as_one(library, mode, function, material):
    """Facing light and viewer, a surface looks the same to the bit however it is turned: n.l and n.v are 1.

    Not the exercise's highlight, whose n.h is rounded when h is normalised.
    """
    call, n = library("brdf.glsl", mode)[function], above_one()
    assert len(n) > 10
    upright = call([0, 0, 1], [0, 0, 1], [0, 0, 1], material)
    np.testing.assert_array_equal(call(n, n, n, material), np.tile(upright, (len(n), 1)))
