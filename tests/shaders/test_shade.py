"""shade(): the model of the exercise, for every input."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import reference
from extremes import extremes

from harness import assert_ulp

U = 2.0**-24
#: what float32 arithmetic may add, and how much of the vectors' own rounding
ARITHMETIC = 2e-6
FLOORS = 4
#: radians: D_PROJECT rounds as if n had been turned. Its length is 1 to U, which n (n.H) takes twice; n.H, a sum
#: of three products, rounds by 3 U, and the difference H - n (n.H) by U.
TURN = 6 * U


def arguments(scenes):
    """The scenes as the shader gets them: l, v, n and the material, float32."""
    l, v, n = (np.array([reference.rounded(getattr(s, a)) for s in scenes]) for a in "lvn")  # noqa: E741
    names = ("albedo", "metalness", "roughness")
    material = {a: np.array([getattr(s.material, a) for s in scenes], np.float32) for a in names}
    return l, v, n, material


class Expectation:
    """What the reference says of a scene, and how much of it rounding the vectors to float32 leaves."""

    def __init__(self, scene):
        self.scene = scene
        self.want = reference.shade(scene.l, scene.v, scene.n, scene.material)
        floats = [reference.vector(*map(float, reference.rounded(a))) for a in (scene.l, scene.v, scene.n)]
        rounded = reference.shade(*floats, scene.material)
        #: the relative change that rounding the vectors causes: what no arithmetic on float32 vectors can mend
        self.floor = max((abs(r - w) / w for r, w in zip(rounded, self.want, strict=True) if w), default=mp.mpf(0))

    def turned(self, angle):
        """The least and the most that the reference says of each channel when n is turned, toward h and across."""
        l, v, n = self.scene.l, self.scene.v, self.scene.n  # noqa: E741
        across = reference.cross(n, reference.direction("0.3", "0.1"))
        found = [self.want]
        for side in (reference.unit(across), reference.unit(reference.cross(n, across))):
            for sign in (angle, -angle):
                turned = reference.unit(tuple(a + sign * b for a, b in zip(n, side, strict=True)))
                found.append(reference.shade(l, v, turned, self.scene.material))
        return [(min(channel), max(channel)) for channel in zip(*found, strict=True)]


@pytest.fixture(scope="module")
def expectations():
    """The scenes, each in several orientations, which share the largest of their floors.

    A single orientation's floor can be near 0 by luck, while the roundings inside the shader are of the same size as
    those of its vectors and have other luck. Where n = +z, rounding keeps mirror images exact: it stands alone.
    """
    groups = reference.scenes()
    found = [Expectation(s) for group in groups for s in group]
    start = 0
    for group in groups:
        members = found[start : start + len(group)]
        turned = [e for e in members if not e.scene.upright]
        shared = max((e.floor for e in turned), default=mp.mpf(0))
        for e in turned:
            e.floor = shared
        start += len(group)
    return found


def assert_within_the_floor(got, expectations, share=FLOORS, turn=0.0):
    """Where it is not: within what the model says of an n that is turned by ``turn``."""
    for values, e in zip(got, expectations, strict=True):
        for channel, (g, w) in enumerate(zip(values, e.want, strict=True)):
            assert np.isfinite(g), e.scene.name
            value, tolerance = mp.mpf(float(g)), (ARITHMETIC + share * e.floor) * w
            least, most = e.turned(turn)[channel] if turn and abs(value - w) > tolerance else (w, w)
            assert least - tolerance <= value <= most + tolerance, f"{e.scene.name}: got {g}, want {float(w)}"


def test_shade_is_the_model_at_the_extremes(library, mode, expectations):
    got = library("brdf.glsl", mode).shade(*arguments([e.scene for e in expectations]))
    assert_within_the_floor(got, expectations, turn=TURN)


def test_only_mirrors_need_the_turn_of_n(library, mode, expectations):
    """Below roughness 0.01, where h = n: elsewhere the vectors' own rounding is more."""
    others = [e for e in expectations if e.scene.material.roughness >= 0.01]
    assert len(others) > len(expectations) / 2
    got = library("brdf.glsl", mode).shade(*arguments([e.scene for e in others]))
    assert_within_the_floor(got, others)


def test_from_the_cross_product_it_is_the_model_without_a_turn_of_n(library, mode, expectations):
    got = library("brdf.glsl", mode, BRDF_D="D_CROSS").shade(*arguments([e.scene for e in expectations]))
    assert_within_the_floor(got, expectations)


def test_shade_is_the_model_in_the_middle(library, mode):
    expectations = [Expectation(s) for s in reference.random_scenes(400, seed=7)]
    got = library("brdf.glsl", mode).shade(*arguments([e.scene for e in expectations]))
    assert_within_the_floor(got, expectations)


def test_the_scenes_can_tell_a_worse_form(library, expectations):
    """The exercise's own arrangement fails the same test: the tolerance is not too wide to notice."""
    with pytest.raises(AssertionError):
        got = library("brdf.glsl", "precise").shade_exercise(*arguments([e.scene for e in expectations]))
        assert_within_the_floor(got, expectations, turn=TURN)


@pytest.mark.parametrize("function", ["shade", "shade_exercise"])
def test_both_arrangements_agree_where_both_have_digits(library, mode, function):
    """Roughness 0.5 and above, cosines 0.1 and above: 1 - (n.h)^2 (1 - alpha^2) is at least 1/16, its error 3 U."""
    scenes = [s for s in reference.random_scenes(600, seed=11) if s.material.roughness >= 0.5]
    scenes = [s for s in scenes if min(reference.dot(s.n, s.l), reference.dot(s.n, s.v)) >= 0.1]
    assert len(scenes) > 40
    expectations = [Expectation(s) for s in scenes]
    got = library("brdf.glsl", mode)[function](*arguments(scenes))
    # n.h of float32 vectors is off by 3 U, which goes with 2 (n.h) into d, and D with d^2
    spread = 2 * (2 * 3 + 3) * U * 16
    for values, e in zip(got, expectations, strict=True):
        for g, w in zip(values, e.want, strict=True):
            assert abs(mp.mpf(float(g)) - w) <= (ARITHMETIC + FLOORS * e.floor + spread) * w


# ---- Every input -----------------------------------------------------------------------------------------------------


def test_shade_is_finite_and_not_negative(library, mode):
    got = library("brdf.glsl", mode).shade(*extremes(500_000, seed=2))
    assert np.isfinite(got).all()
    assert (got >= 0).all()


@pytest.mark.parametrize(
    ("cos_l", "cos_v"), [(-0.5, 0.5), (0.5, -0.5), (0.0, 0.5), (0.5, 0.0), (0.0, 0.0), (-1.0, 1.0)]
)
@pytest.mark.parametrize("roughness", [0.0, 0.3, 1.0])
def test_back_side_and_horizon_are_black(library, mode, cos_l, cos_v, roughness):
    l, v = reference.direction(cos_l, 0), reference.direction(cos_v, "0.5")  # noqa: E741
    material = {"albedo": [1, 1, 1], "metalness": 0.5, "roughness": roughness}
    got = library("brdf.glsl", mode).shade(reference.rounded(l), reference.rounded(v), [0, 0, 1], material)
    assert (got == 0).all()


@pytest.mark.parametrize("cos_v", [2.0**-126, 1e-37, 1e-30, 1e-10])
def test_a_viewer_however_little_above_the_horizon_sees_the_surface(library, mode, cos_v):
    """Down to the smallest normal float. White and rough: the highlight has no edge here, and both parts count."""
    l, v, n = (np.float32(a) for a in ((0.6, 0, 0.8), (-1, 0, cos_v), (0, 0, 1)))  # noqa: E741
    white = reference.Material((1.0, 1.0, 1.0), 0.0, 1.0)
    got = library("brdf.glsl", mode).shade(l, v, n, {"albedo": [1, 1, 1], "metalness": 0, "roughness": 1})
    want = reference.shade(*(reference.vector(*map(float, a)) for a in (l, v, n)), white)
    # |l|^2 is 1 to 2 U only, which the reference's h takes along and shade's does not: with the dozen roundings, 16 U
    np.testing.assert_allclose(got, np.array(want, float), rtol=16 * U, atol=0)


def test_a_mirror_shows_its_diffuse_part_alone(library, mode):
    """Roughness 0 with h = n: no highlight from a light without extent, (1 - F) albedo/pi NoL stays."""
    albedo = np.float32([0.8, 0.4, 0.1])
    got = library("brdf.glsl", mode).shade(
        [0, 0, 1], [0, 0, 1], [0, 0, 1], {"albedo": albedo, "metalness": 0, "roughness": 0}
    )
    assert_ulp(got, (1 - 0.04) * albedo.astype(float) / np.pi, max_ulp=6)


def test_a_highlight_grows_as_the_model_says_until_float_ends(library, mode):
    """With l = v = n it is D/4 = 1/(4 pi alpha^2), where alpha^2 in the divisor of k is never below 1e-26."""
    roughness = np.float32([1e-18, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 1e-2])
    alpha2 = roughness.astype(float) ** 4
    got = library("brdf.glsl", mode).shade(
        [0, 0, 1], [0, 0, 1], [0, 0, 1], {"albedo": [1, 1, 1], "metalness": 1, "roughness": roughness}
    )[:, 0]
    share = (1 + 1e-26 / alpha2) ** -2
    assert share[roughness >= 1e-6].min() > 0.98
    assert share[roughness >= 1e-4].min() > 1 - U
    np.testing.assert_allclose(got, share / (4 * np.pi * alpha2), rtol=12 * U, atol=0)


def test_where_the_model_is_beyond_all_floats_shade_is_a_number(library, mode):
    """A white metal, h = n, at both horizons with unequal cosines: F is 1, and D V has no limit as alpha goes to 0."""
    cosines = [10.0**-k for k in (4, 5, 6, 7, 8, 10, 13, 20, 37)]
    cos_l, cos_v, roughness = np.meshgrid(cosines, cosines, 10 ** np.linspace(-12, -2, 81), indexing="ij")
    l, v = (np.stack(np.broadcast_arrays(x, y, c), -1) for x, y, c in ((0.6, 0.8, cos_l), (-0.6, -0.8, cos_v)))  # noqa: E741
    metal = {"albedo": [1, 1, 1], "metalness": 1, "roughness": roughness}
    got = library("brdf.glsl", mode).shade(l, v, [0, 0, 1], metal)
    assert np.isfinite(got).all()
    assert got.min() >= 0
    white = reference.Material((1.0, 1.0, 1.0), 1.0, 1e-8)
    vectors = (reference.vector(*map(float, np.float32(a))) for a in (l[7, 7, 0], v[7, 7, 0], (0, 0, 1)))
    assert min(reference.shade(*vectors, white)) > mp.mpf("3.4e38")
    assert got.max() > 1e36


def test_the_last_trace_of_a_dielectric_in_a_metal_scatters_as_the_model_says(library, mode):
    """1 - metalness is exact however near to 1 metalness is. At roughness 0 the diffuse part is all there is."""
    metalness = np.float32(1) - np.float32(2) ** -np.arange(1, 25)
    got = library("brdf.glsl", mode).shade(
        [0, 0, 1], [0, 0, 1], [0, 0, 1], {"albedo": [0.5] * 3, "metalness": metalness, "roughness": 0}
    )[:, 0]
    m = metalness.astype(float)
    F = 0.04 * (1 - m) + 0.5 * m
    np.testing.assert_allclose(got, (1 - m) * (1 - F) * 0.5 / np.pi, rtol=8 * U, atol=0)


def test_metals_have_no_diffuse_part(library, mode):
    """Far from the mirror direction a smooth metal is dark, whatever its colour."""
    l, v = reference.rounded(reference.direction(0.9, 0)), reference.rounded(reference.direction(0.5, 0))  # noqa: E741
    metal = library("brdf.glsl", mode).shade(l, v, [0, 0, 1], {"albedo": [1, 1, 1], "metalness": 1, "roughness": 0})
    assert (metal == 0).all()


def test_metals_reflect_their_own_colour(library, mode):
    """At normal incidence F is F0, the albedo; with roughness 1 D V is 1/pi times 1/4."""
    albedo = np.float32([1.0, 0.71, 0.29])
    got = library("brdf.glsl", mode).shade(
        [0, 0, 1], [0, 0, 1], [0, 0, 1], {"albedo": albedo, "metalness": 1, "roughness": 1}
    )
    assert_ulp(got, albedo.astype(float) / (4 * np.pi), max_ulp=10)


def scattered_inputs(n, seed):
    """Unit vectors above the horizon and a material; float32."""
    random = np.random.default_rng(seed)

    def hemisphere():
        d = random.standard_normal((n, 3))
        d[:, 2] = np.abs(d[:, 2])
        return (d / np.linalg.norm(d, axis=1, keepdims=True)).astype(np.float32)

    return hemisphere(), hemisphere(), random


@pytest.mark.parametrize("albedo", [0.0, 0.8], ids=["specular", "whole"])
def test_reciprocity(library, mode, albedo):
    """f(l, v) = f(v, l), where shade = f NoL. H, n.H, |n x H| and V are sums of the same two terms in either order."""
    l, v, random = scattered_inputs(20_000, seed=5)  # noqa: E741
    material = {"albedo": [albedo] * 3, "metalness": 0, "roughness": random.random(len(l), np.float32)}
    shade = library("brdf.glsl", mode).shade
    forth = shade(l, v, [0, 0, 1], material).astype(float) * v[:, 2:]
    back = shade(v, l, [0, 0, 1], material).astype(float) * l[:, 2:]
    # NoL/pi, D V NoL, two products and a sum after it, on both sides
    np.testing.assert_allclose(forth, back, rtol=2 * 8 * U, atol=0)


def test_isotropy(library, mode):
    """Turning everything changes nothing beyond what rounding the turned vectors does."""
    groups = [g for g in reference.scenes() if g[0].material.roughness >= 0.2]
    shade = library("brdf.glsl", mode).shade
    for group in groups:
        floors = [Expectation(s).floor for s in group]
        got = shade(*arguments(group)).astype(float)
        spread = got.max(0) - got.min(0)
        assert (spread <= 2 * (ARITHMETIC + FLOORS * float(max(floors))) * got.max(0)).all(), group[0].name


def test_the_same_whether_an_argument_is_one_or_many(library, mode):
    """Nothing is folded because it is constant."""
    l, v, random = scattered_inputs(1000, seed=9)  # noqa: E741
    shade = library("brdf.glsl", mode).shade
    one = shade(l, v, [0, 0, 1], {"albedo": [0.5, 0.2, 0.1], "metalness": 0.25, "roughness": 0.3})
    many = shade(
        l,
        v,
        np.tile(np.float32([0, 0, 1]), (1000, 1)),
        {
            "albedo": np.tile(np.float32([0.5, 0.2, 0.1]), (1000, 1)),
            "metalness": np.full(1000, 0.25, np.float32),
            "roughness": np.full(1000, 0.3, np.float32),
        },
    )
    np.testing.assert_array_equal(one, many)


@pytest.mark.parametrize("cosine", [1e-37**0.5, 1e-37])
def test_the_guards_are_felt_by_cosines_as_small_alone(library, mode, cosine):
    """h = n, at both horizons: 1e-37 is added to the square of the sine, and to V's divisor, 2 cos alpha here."""
    c, alpha, one = np.float32(cosine).astype(float), np.float64(0.5), np.float32(1)
    got, _ = library("brdf.glsl", mode).highlight([one, 0, c], [-one, 0, c], [0, 0, 1], alpha)
    k = alpha * (1e-37 + c**2) / (1e-37 + alpha**2 * c**2)
    want = k**2 / np.pi * 0.5 / (2 * c * alpha + 1e-37) * c
    np.testing.assert_allclose(got, want, rtol=40 * U, atol=0)
