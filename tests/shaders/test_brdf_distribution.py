"""distribution() on each of its rungs: GGX of the angle between n and h, as far as the rung has digits."""

from __future__ import annotations

import ladder_reference
import mpmath as mp
import numpy as np
import pytest
import reference
from rungs import BRDF

from harness import assert_ulp

U = 2.0**-24
UP = np.float32([0, 0, 1])
FROM_COSINE = ("D_EXERCISE", "D_ONE_MINUS")
ROUGHNESSES = np.float32([1e-5, 1e-3, 0.01, 0.045, 0.089, 0.2, 0.5, 0.8, 1])


def pairs(seed=3, n=400):
    """l and v above the horizon, mirror images of each other in half of them but for a little; float32."""
    random = np.random.default_rng(seed)
    cosine, azimuth = random.uniform(0.05, 1, (2, n)), random.uniform(0, 2 * np.pi, (2, n))
    near = np.arange(n) % 2 == 0
    cosine[1, near] = np.minimum(cosine[0, near] * (1 + 10.0 ** random.uniform(-6, -2, near.sum())), 1)
    azimuth[1, near] = azimuth[0, near] + np.pi + 10.0 ** random.uniform(-6, -2, near.sum())
    sine = np.sqrt(1 - cosine**2)
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], -1).astype(np.float32)


def half_vector(l, v):  # noqa: E741
    """Exactly: H and its length, of float32 vectors."""
    H = tuple(mp.mpf(float(a)) + mp.mpf(float(b)) for a, b in zip(l, v, strict=True))
    return H, mp.sqrt(reference.dot(H, H))


@pytest.fixture(scope="module")
def upright():
    """l, v, alpha, and D toward n = +z with its squared sine, at 50 digits."""
    l, v = pairs()  # noqa: E741
    alpha = np.resize(ROUGHNESSES**2, len(l)).astype(np.float32)
    wanted, sines = [], []
    for a, b, al in zip(l, v, alpha, strict=True):
        H, length = half_vector(a, b)
        cos2 = (H[2] / length) ** 2
        al2 = mp.mpf(float(al)) ** 2
        sines.append((H[0] ** 2 + H[1] ** 2) / length**2)
        wanted.append(al2 / (mp.pi * (sines[-1] + al2 * cos2) ** 2))
    return l, v, alpha, np.array(wanted, float), np.array(sines, float)


@pytest.mark.parametrize("rung", ["D_CROSS", "D_PROJECT"])
def test_from_the_sine_it_is_the_formula_to_ulps_however_small_the_angle(library, mode, rung, upright):
    """Toward +z neither cross product nor projection rounds: n has no error that could tilt it."""
    l, v, alpha, want, _ = upright  # noqa: E741
    got = library("brdf.glsl", mode, BRDF_D=rung).distribution(l, v, UP, alpha)
    # H rounds once; each of sin2 and cos2 within 4 roundings of it; their sums, alpha^2, products, a quotient: k within
    # 13, and D goes with its square
    assert_ulp(got, want, max_ulp=2 * 13 + 3)


def test_in_half_precisions_form_it_is_the_formula_with_its_guards(library, mode, upright):
    l, v, alpha, formula, sin2 = upright  # noqa: E741
    got = library("brdf.glsl", mode, BRDF_D="D_HALF").distribution(l, v, UP, alpha)
    H = l.astype(float) + v
    want = ladder_reference.D_HALF(sin2, 1 - sin2, alpha.astype(float), (H * H).sum(1))
    most = ladder_reference.HALF_MOST
    assert (want > most).sum() > 10 and (want < 0.5 * formula).sum() > 10 and (want < 1).any()
    assert_ulp(got, np.minimum(want, most), max_ulp=2 * 13 + 3)  # as above


def test_in_half_precisions_form_the_guard_is_not_felt_where_half_has_digits(upright):
    """From roughness 0.089 up, both cosines 0.07 and more: (0.0079 16 0.07)^2 is above the least divisor."""
    l, v, alpha, formula, sin2 = upright  # noqa: E741
    H = l.astype(float) + v
    here = (alpha >= 0.0079) & (np.minimum(l[:, 2], v[:, 2]) > 0.07)
    assert here.sum() > 100
    got = ladder_reference.D_HALF(sin2, 1 - sin2, alpha.astype(float), (H * H).sum(1))
    np.testing.assert_allclose(got[here], formula[here], rtol=1e-13)


@pytest.mark.parametrize("rung", FROM_COSINE)
def test_from_the_cosine_it_is_the_formula_to_the_rounding_of_the_cosine(library, mode, rung, upright):
    l, v, alpha, want, sin2 = upright  # noqa: E741
    got = library("brdf.glsl", mode, BRDF_D=rung).distribution(l, v, UP, alpha)
    # n.h is off by 6 U, which goes twice into d = sin^2 + alpha^2 cos^2, and D with d^2
    d = sin2 + alpha.astype(float) ** 2 * (1 - sin2)
    bound = 2 * (2 * 6 + 3) * U / d + 12 * U
    has_digits = bound < 0.3
    assert 100 < has_digits.sum() < len(d)
    assert (np.abs(got / want - 1)[has_digits] <= bound[has_digits]).all()
    # without digits it stays a number within the lobe
    peak = 1 / (np.pi * alpha.astype(float) ** 2)
    assert ((got >= 0) & (got <= peak * (1 + 12 * U))).all()


@pytest.mark.parametrize("rung", ["D_CROSS", "D_PROJECT", "D_HALF"])
def test_a_turned_lobe_is_the_formula_to_the_rounding_of_its_vectors(library, mode, rung):
    random = np.random.default_rng(5)
    l, v = pairs(7, 300)  # noqa: E741
    turn = np.linalg.qr(random.standard_normal((len(l), 3, 3)))[0]
    n = np.float32(turn[:, :, 2])
    l, v = (np.float32(np.einsum("nij,nj->ni", turn, a)) for a in (l, v))  # noqa: E741
    alpha = np.resize(np.float32([0.04, 0.25, 1]), len(l)).astype(np.float32)
    got = library("brdf.glsl", mode, BRDF_D=rung).distribution(l, v, n, alpha)
    for g, a, b, c, al in zip(got, l, v, n, alpha, strict=True):
        H, length = half_vector(a, b)
        normal = reference.unit(reference.vector(*map(float, c)))
        across = reference.cross(normal, H)
        sin2 = reference.dot(across, across) / length**2
        al2 = mp.mpf(float(al)) ** 2
        divisor = sin2 + al2 * (1 - sin2)
        want = al2 / (mp.pi * divisor**2)
        # the sine is off by 6 U from products of components up to 1, and by the rounding of n; sin^2 by twice that
        bound = 2 * (2 * 9 * U * mp.sqrt(sin2) + (9 * U) ** 2) / divisor + 40 * U
        assert abs(mp.mpf(float(g)) / want - 1) <= bound


BEHIND = [([0.6, 0, -0.8], [0, 0.8, -0.6]), ([0, 0, -1], [0.6, 0, -0.8])]
BESIDE = [([0.6, 0, 0.8], [0.6, 0, -0.8])]


@pytest.mark.parametrize("rung", BRDF["BRDF_D"])
def test_toward_the_back_it_is_what_it_is_at_right_angles(library, mode, rung):
    """n.h is 0 at least, as the exercise clamps it: D(0) = alpha^2/pi."""
    alpha = np.float32([0.01, 0.3, 1])
    distribution = library("brdf.glsl", mode, BRDF_D=rung).distribution
    for l, v in BESIDE + BEHIND:  # noqa: E741
        assert_ulp(distribution(l, v, UP, alpha), alpha.astype(float) ** 2 / np.pi, max_ulp=8)


@pytest.mark.parametrize("rung", BRDF["BRDF_D"])
def test_a_mirror_and_opposite_vectors_give_numbers(library, mode, rung):
    distribution = library("brdf.glsl", mode, BRDF_D=rung).distribution
    assert distribution(UP, UP, UP, 0) == 0
    alpha = np.float32([0, 0.5, 1])
    opposite = distribution([0.6, 0, 0.8], [-0.6, 0, -0.8], UP, alpha)
    # n.h counts as 0; D_HALF has neither sine nor cosine then, and a divisor
    assert_ulp(opposite, 0 * alpha if rung == "D_HALF" else alpha.astype(float) ** 2 / np.pi, max_ulp=6)


@pytest.mark.parametrize("rung", [r for r in BRDF["BRDF_D"] if r != "D_HALF"])
def test_a_half_vector_as_short_as_the_guard(library, mode, rung):
    """Where |H|^2 is 1e-37, as much again is added to it, as a sine: half of the square is the cosine's."""
    half = np.float32([0, 0, 0.5 * 1e-37**0.5])
    alpha = np.float32([0.1, 0.5])
    a2 = alpha.astype(float) ** 2
    got = library("brdf.glsl", mode, BRDF_D=rung).distribution(half, half, UP, alpha)
    assert_ulp(got, a2 / (np.pi * (0.5 + 0.5 * a2) ** 2), max_ulp=40)


def test_a_cosine_that_rounding_lifts_above_one_counts_as_one(library, mode):
    """1 - n.h would be below 0 by 1e-7, which is alpha^2 and more here: the peak stays."""
    long = np.float32([0, 0, 1.0000001])
    alpha = np.float32([3e-3, 5e-4, 2e-4])
    got = library("brdf.glsl", mode, BRDF_D="D_ONE_MINUS").distribution(long, long, long, alpha)
    assert_ulp(got, 1 / (np.pi * alpha.astype(float) ** 2), max_ulp=16)


@pytest.mark.parametrize("rung", [r for r in BRDF["BRDF_D"] if r != "D_HALF"])
def test_the_peak_grows_until_the_guard(library, mode, rung):
    """At h = n it is 1/(pi alpha^2), where alpha^2 in the divisor is never below 1e-26."""
    alpha = np.float32([1e-20, 1e-14, 1e-13, 1e-12, 1e-10, 1e-5, 0.1, 1])
    a = alpha.astype(float)
    got = library("brdf.glsl", mode, BRDF_D=rung).distribution(UP, UP, UP, alpha)
    assert_ulp(got, (a / (a**2 + 1e-26)) ** 2 / np.pi, max_ulp=12)


def test_the_peak_in_half_precisions_form(library, mode):
    """It falls again where 256 alpha^2 is below the least divisor."""
    alpha = np.float32([1e-7, 1e-6, 1e-5, 5e-5, 1.1e-4, 4e-4, 0.002, 0.0024, 0.01, 1])
    want = np.minimum(ladder_reference.D_HALF(0, 1, alpha.astype(float), 4), ladder_reference.HALF_MOST)
    assert (want == ladder_reference.HALF_MOST).sum() == 3 and want[0] < 1
    got = library("brdf.glsl", mode, BRDF_D="D_HALF").distribution(UP, UP, UP, alpha)
    assert_ulp(got, want, max_ulp=12)
