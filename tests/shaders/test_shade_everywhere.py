"""shade() is finite, not negative, and computes with nothing but numbers, wherever its inputs meet."""

from __future__ import annotations

import pytest
from test_shade import RUNGS

from harness import assert_finite

DOMAIN = {"l": "unit", "v": "unit", "n": "unit", "m.albedo": "color", "m": "[0,1]"}


@pytest.mark.parametrize("rung", RUNGS, ids=lambda r: "-".join(r.values()) or "default")
def test_all_that_shade_computes_is_finite(library, rung):
    assert_finite(library("brdf.glsl", **rung).shade, DOMAIN, n=30_000, nonnegative=True)


def test_shade_is_finite_at_many_inputs(library, mode):
    assert_finite(library("brdf.glsl", mode).shade, DOMAIN, n=300_000, seed=1, nonnegative=True, intermediates=False)
