"""visibility() and the V of each rung, given exact float32 cosines: its formula to the rounding of its operations."""

from __future__ import annotations

import itertools

import ladder_reference
import numpy as np
import pytest
from rungs import BRDF

from harness import assert_ulp

COSINES = [1e-6, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.9, 0.9999, 1.0, *np.random.default_rng(4).random(5, np.float32)]
ALPHAS = [1e-6, 1e-4, 0.002, 0.04, 0.25, 0.64, 1.0]
#: roundings: each of two factors takes 4 at most, or a square root of a sum of 6; their product and quotient, constants
ULP = {"V_EXACT": 8, "V_SCHLICK": 12, "V_KARIS": 16, "V_SEPARABLE": 14, "V_KELEMEN": 3}


@pytest.fixture(scope="module")
def grid():
    """NoL, NoV, LoH, alpha."""
    NoL, NoV, alpha = np.array(list(itertools.product(COSINES, COSINES, ALPHAS)), np.float32).T
    return NoL, NoV, np.resize(np.float32(COSINES), len(NoL)), alpha


def test_every_rung_has_a_formula():
    assert {*ULP, "V_HAMMON"} == set(BRDF["BRDF_V"])


@pytest.mark.parametrize("rung", ULP)
def test_it_is_its_formula(library, mode, rung, grid):
    want = getattr(ladder_reference, rung)(*(x.astype(float) for x in grid))
    assert_ulp(library("brdf.glsl", mode, BRDF_V=rung).visibility(*grid), want, max_ulp=ULP[rung])


def test_Hammons_is_V_Hammon(library, mode, grid):
    """Which is held against his formula by itself."""
    brdf = library("brdf.glsl", mode, BRDF_V="V_HAMMON")
    np.testing.assert_array_equal(brdf.visibility(*grid), brdf.V_Hammon(grid[0], grid[1], grid[3]))


#: rung -> what is left of 1/0, by the guard in the divisor
AT_ZERO = {
    "V_HAMMON": 0.5 / 1e-37,
    "V_SCHLICK": 0.25 / 1e-37,
    "V_SEPARABLE": 1 / 1e-26,
    "V_KELEMEN": 0.25 / 1e-37,
    "V_EXACT": 0.5 / 1.2e-38,
}


@pytest.mark.parametrize("rung", AT_ZERO)
def test_where_the_formula_divides_by_zero_there_is_a_number(library, mode, rung):
    got = library("brdf.glsl", mode, BRDF_V=rung).visibility(0, 0, 0, 0)
    assert_ulp(got, AT_ZERO[rung], max_ulp=4)


@pytest.mark.parametrize("rung", AT_ZERO)
def test_the_guard_takes_no_part_elsewhere(library, mode, rung):
    """Cosines of 1e-10, and alpha 1: well beyond what any scene has."""
    small = np.float32([1e-10, 1e-7, 1e-10])
    other = np.float32([1e-10, 1e-7, 1])
    one = np.float32(1)
    want = getattr(ladder_reference, rung)(*(x.astype(float) for x in (small, other, small, one)))
    assert_ulp(library("brdf.glsl", mode, BRDF_V=rung).visibility(small, other, small, one), want, max_ulp=16)
