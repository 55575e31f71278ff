"""Transfer functions and the tone curve against their formulas in mpmath."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from harness import assert_ulp, ulp_difference

CODES = np.arange(256, dtype=np.float32) / np.float32(255)
#: 0, the ends of the linear pieces and their neighbours, 1, a sweep, and any
ANY = np.random.default_rng(21).random(200, np.float32)
STORED = np.unique(np.concatenate([np.float32([0, 1e-30, 1e-5, 0.04045, 0.040450003, 1]), CODES, ANY]))
LINEAR = np.unique(np.concatenate([np.float32([0, 1e-30, 1e-5, 0.0031308, 0.0031309, 1]), CODES**2, ANY]))
#: llvmpipe's pow, in ulp: it is exp2(y log2(x)), and log2 near 1 has no more than absolute accuracy (measured to 81)
POW_ULP = 100


def grey(values):
    """(n,) to (n, 3)."""
    return np.repeat(np.asarray(values, np.float32)[:, None], 3, axis=1)


def decode_exact(c):
    """IEC 61966-2-1."""
    c = mp.mpf(float(c))
    return c / mp.mpf("12.92") if c <= mp.mpf("0.04045") else ((c + mp.mpf("0.055")) / mp.mpf("1.055")) ** mp.mpf("2.4")


def encode_exact(c):
    """IEC 61966-2-1."""
    c = mp.mpf(float(c))
    if c <= mp.mpf("0.0031308"):
        return c * mp.mpf("12.92")
    return mp.mpf("1.055") * c ** (1 / mp.mpf("2.4")) - mp.mpf("0.055")


def decode_power(c):
    """The exercise's approximation."""
    return mp.mpf(float(c)) ** mp.mpf("2.2")


def decode_square(c):
    return mp.mpf(float(c)) ** 2


def decode_cubic(c):
    """The polynomial of the comment, at the coefficients it states."""
    c = mp.mpf(float(c))
    return c * (c * (c * mp.mpf("0.305306011") + mp.mpf("0.682171111")) + mp.mpf("0.012522878"))


RUNGS = {
    "SRGB_POWER": (decode_power, POW_ULP),
    "SRGB_PIECEWISE": (decode_exact, POW_ULP),
    "SRGB_CUBIC": (decode_cubic, 6),  # six roundings, nothing cancels
    "SRGB_SQUARE": (decode_square, 1),
}


@pytest.mark.parametrize("rung", RUNGS)
def test_decoding_is_its_formula(library, mode, rung):
    formula, ulps = RUNGS[rung]
    got = library("color.glsl", mode, SRGB_DECODE=rung).srgb_to_linear(grey(STORED))
    # below 1e-37 a result is denormal, and llvmpipe makes it 0
    assert_ulp(got, grey([formula(c) for c in STORED]), max_ulp=ulps, atol_near_zero=1e-37)


def test_the_exercises_power_is_the_default(library):
    color = library("color.glsl")
    np.testing.assert_array_equal(
        color.srgb_to_linear(grey(STORED)), library("color.glsl", SRGB_DECODE="SRGB_POWER").srgb_to_linear(grey(STORED))
    )


@pytest.mark.parametrize(("rung", "stated"), [("SRGB_POWER", 0.0085), ("SRGB_CUBIC", 0.0017), ("SRGB_SQUARE", 0.0425)])
def test_a_decoding_is_as_wrong_as_its_comment_says(library, rung, stated):
    sweep = np.linspace(0, 1, 2001, dtype=np.float32)
    got = library("color.glsl", SRGB_DECODE=rung).srgb_to_linear(grey(sweep))[:, 0]
    error = max(abs(mp.mpf(float(g)) - decode_exact(c)) for g, c in zip(got, sweep, strict=True))
    assert stated - 5e-5 <= error <= stated + 5e-5


def test_encoding_is_the_standards_curve(library, mode):
    got = library("color.glsl", mode).linear_to_srgb(grey(LINEAR))
    # 1.055 p - 0.055 cancels: near the joint it is an eighth of p, so p's ulps count eight times
    assert_ulp(got, grey([encode_exact(c) for c in LINEAR]), max_ulp=POW_ULP / 4 * 8)


def test_every_code_survives_decoding_and_encoding(library, mode):
    color = library("color.glsl", mode, SRGB_DECODE="SRGB_PIECEWISE")
    back = color.linear_to_srgb(color.srgb_to_linear(grey(CODES)))
    np.testing.assert_array_equal(np.rint(back[:, 0] * 255), np.arange(256))


@pytest.mark.parametrize(
    ("function", "joint", "slope"),
    [("srgb_to_linear", 0.04045, 1 / 12.92), ("linear_to_srgb", 0.0031308, 12.92)],
)
def test_the_pieces_join_where_the_standard_says(library, mode, function, joint, slope):
    """IEC 61966-2-1: the straight piece up to the joint and including it, the power from there on.

    The straight piece is one operation with one rounded constant: within 2 ulp. The other lies 7 ulp and more from it
    at the joint; pow is coarse enough to come near it by chance, but not often.
    """
    color = library("color.glsl", mode, SRGB_DECODE="SRGB_PIECEWISE")
    last_digit = 1e-5 if joint > 0.01 else 1e-7
    around = np.linspace(joint - last_digit, joint + last_digit, 401).astype(np.float32)
    around = np.unique(np.append(around, np.float32(joint)))
    straight = ulp_difference(color[function](grey(around))[:, 0], around.astype(float) * slope) <= 2
    assert straight[around <= np.float32(joint)].all()
    assert straight[around > np.float32(joint)].mean() < 0.1


def test_the_cubic_begins_with_its_slope(library, mode):
    """2^-60 c rounds nothing, and the terms above the first are too small to take part."""
    got = library("color.glsl", mode, SRGB_DECODE="SRGB_CUBIC").srgb_to_linear(grey([2.0**-60]))
    np.testing.assert_array_equal(got, 2.0**-60 * grey([0.012522878]))


@pytest.mark.parametrize("function", ["srgb_to_linear", "linear_to_srgb", "tone_map"])
def test_what_lies_outside_is_cut_off(library, mode, function):
    got = library("color.glsl", mode)[function](grey([-1, -1e-30, 1.5, 1e30, np.inf]))
    assert_ulp(got, grey([0, 0, 1, 1, 1]), max_ulp=1)  # 1.055 - 0.055 rounds twice


def test_reinhards_curve_is_his(library, mode):
    """c (1 + c/W^2)/(1 + c), Reinhard et al. 2002, eq. 4; W = 4."""
    radiance = np.float32([0, 1e-6, 0.01, 0.18, 1, 2, 3.99, 4])
    got = library("color.glsl", mode, TONE_CURVE="TONE_REINHARD").tone_map(grey(radiance))
    want = [mp.mpf(float(c)) * (1 + mp.mpf(float(c)) / 16) / (1 + mp.mpf(float(c))) for c in radiance]
    assert_ulp(got, grey(want), max_ulp=5)


def test_reinhards_curve_begins_at_black(library, mode):
    got = library("color.glsl", mode, TONE_CURVE="TONE_REINHARD").tone_map(grey([-1e30, -4, -1, -0.5, -1e-30, 0]))
    assert (got == 0).all()


def test_reinhards_curve_ends_at_white(library, mode):
    got = library("color.glsl", mode, TONE_CURVE="TONE_REINHARD", TONE_WHITE=2.0).tone_map(grey([2, 5, 1e38, np.inf]))
    assert_ulp(got, 1.0, max_ulp=1)
