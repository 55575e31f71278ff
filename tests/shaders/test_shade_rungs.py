"""shade() on each rung of the ladder: the formula of that rung, where it has digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import reference

U = 2.0**-24
#: cosines are off by 3 U, against 0.1 at least; d of the exercise's D, 1/16 at least here, by 9 U, and twice into D;
#: what the better forms lose is less
TOLERANCE = 2 * (2 * 3 + 3) * U * 16 + 4 * 3 * U / 0.1
#: llvmpipe's pow(x, 5), in ulp
POW_ULP = 100


@pytest.fixture(scope="module")
def middle():
    """Scenes of roughness 0.5 and above, cosines 0.1 and above; the vectors as rounded."""
    found = [s for s in reference.random_scenes(500, seed=17) if s.material.roughness >= 0.5]
    found = [s for s in found if min(reference.dot(s.n, s.l), reference.dot(s.n, s.v)) >= 0.1]
    assert len(found) > 30
    return found


def called(function, scenes):
    """The function's values, and for each scene its vectors as the function got them."""
    l, v, n = (np.array([reference.rounded(getattr(s, a)) for s in scenes]) for a in "lvn")  # noqa: E741
    names = ("albedo", "metalness", "roughness")
    got = function(l, v, n, {a: np.array([getattr(s.material, a) for s in scenes], np.float32) for a in names})
    return got, [[reference.vector(*map(float, row)) for row in rows] for rows in zip(l, v, n, strict=True)]


@pytest.mark.parametrize(
    ("rung", "V", "more"),
    [
        ({"BRDF_D": "D_EXERCISE"}, reference.V_SmithGGXCorrelated, 0),
        ({"BRDF_V": "V_HAMMON"}, reference.V_Hammon, 0),
        ({"BRDF_F": "F_POW"}, reference.V_SmithGGXCorrelated, POW_ULP * U),
    ],
    ids=lambda r: "-".join(r.values()) if isinstance(r, dict) else "",
)
def test_a_rung_is_its_formula(library, mode, middle, rung, V, more):
    got, vectors = called(library("brdf.glsl", mode, **rung).shade, middle)
    want = [reference.shade(*lvn, s.material, V) for lvn, s in zip(vectors, middle, strict=True)]
    np.testing.assert_allclose(got, np.array(want, float), rtol=TOLERANCE + more, atol=0)


def test_lamberts_diffuse_part_takes_no_notice_of_what_is_reflected(library, mode, middle):
    """A black dielectric's highlight, which is that of any dielectric, and albedo/pi n.l."""
    scenes = [s for s in middle if s.material.metalness == 0]
    assert len(scenes) > 10
    got, vectors = called(library("brdf.glsl", mode, BRDF_DIFFUSE="DIFFUSE_LAMBERT").shade, scenes)
    want = []
    for (l, v, n), s in zip(vectors, scenes, strict=True):  # noqa: E741
        highlight = reference.shade(l, v, n, reference.Material((0.0,) * 3, 0.0, s.material.roughness))
        NoL = reference.dot(reference.unit(n), l)
        want.append([h + mp.mpf(a) / mp.pi * NoL for h, a in zip(highlight, s.material.albedo, strict=True)])
    np.testing.assert_allclose(got, np.array(want, float), rtol=TOLERANCE, atol=0)


def test_what_a_rung_leaves_out_is_not_all_there_is(library, middle):
    """The rungs that are other models differ from the default by more than the tolerance: the tests can tell them."""
    for rung in ({"BRDF_V": "V_HAMMON"}, {"BRDF_DIFFUSE": "DIFFUSE_LAMBERT"}):
        default, _ = called(library("brdf.glsl").shade, middle)
        got, _ = called(library("brdf.glsl", **rung).shade, middle)
        assert np.abs(got / default.astype(float) - 1).max() > 100 * TOLERANCE
