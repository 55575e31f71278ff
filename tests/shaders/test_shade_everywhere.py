"""shade() is finite, not negative, and computes with nothing but numbers, wherever its inputs meet."""

from __future__ import annotations

import pytest
from rungs import PRESETS, SINGLE, name

from harness import assert_finite

DOMAIN = {"l": "unit", "v": "unit", "n": "unit", "m.albedo": "color", "m": "[0,1]"}


def test_all_that_shade_computes_is_finite(library):
    assert_finite(library("brdf.glsl").shade, DOMAIN, n=30_000, nonnegative=True)


@pytest.mark.parametrize("rung", [*SINGLE, *PRESETS], ids=name)
def test_all_that_shade_computes_is_finite_on_every_rung(library, rung):
    assert_finite(library("brdf.glsl", **rung).shade, DOMAIN, n=3_000, nonnegative=True)


def test_shade_is_finite_at_many_inputs(library, mode):
    assert_finite(library("brdf.glsl", mode).shade, DOMAIN, n=300_000, seed=1, nonnegative=True, intermediates=False)
