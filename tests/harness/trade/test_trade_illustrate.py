"""The maps of the page: what each shows, by a model whose errors are known."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from harness import ladder
from harness.trade import illustrate
from harness.trade.choices import Choice

# Off by a tenth where RUNG is 1; (1 + x) - 1 loses the digits of a small x where it is 2.
MODEL = """
#ifndef RUNG
#define RUNG 0
#endif
struct Material { vec3 albedo; float metalness; float roughness; };
vec3 shade(vec3 l, vec3 v, vec3 n, Material m)
{
    float x = 1e-3 * dot(n, l);
#if RUNG == 1
    x *= 1.1;
#elif RUNG == 2
    x = (1.0 + x) - 1.0;
#endif
    return vec3(x) * m.albedo;
}
"""


@pytest.fixture
def maps(tmp_path):
    path = tmp_path / "model.glsl"
    path.write_text(MODEL)

    def choice(value: str, whole: str = "shade") -> Choice:
        rung = ladder.Rung(value, "", "", "", ())
        term = SimpleNamespace(name="it")
        macros, exact = {"RUNG": value}, {"RUNG": "0"}
        return Choice(rung, term, path, [], "shade", whole, {}, macros, exact, exact, {})

    return illustrate.maps([choice("0"), choice("1"), choice("2"), choice("3", whole="decode")])


def disk():
    y, x = np.mgrid[-1 : 1 : illustrate.SIZE * 1j, -1 : 1 : illustrate.SIZE * 1j]
    return x * x + y * y < 0.98


def test_the_map_of_a_formula_is_its_relative_error(maps):
    assert np.allclose(maps["1"]["formula"][disk()], 0.1, atol=1e-9)
    # Nothing but the rounding of doubles: 2^-53 of 1, beside an x of 1e-6 at least.
    assert maps["2"]["formula"][disk()].max() < 1e-9


def test_the_map_of_rounding_is_of_the_same_formula(maps):
    """A formula that is off by a tenth rounds as well as one that is not: three products, each off by 2^-24."""
    for name in ("0", "1"):
        assert np.nanmax(maps[name]["rounding"]) < 1e-6
    # 2^-24 of 1, half an ulp below 2, beside an x of 1e-3 at most
    assert np.nanmedian(maps["2"]["rounding"]) > 1e-5


def test_outside_of_the_disk_there_is_nothing(maps):
    for kinds in maps.values():
        for errors in kinds.values():
            assert errors.shape == (illustrate.SIZE, illustrate.SIZE)
            assert np.isnan(errors[0, 0]) and not np.isnan(errors[disk()]).any()


def test_what_is_no_part_of_the_model_has_no_map(maps):
    assert set(maps) == {"0", "1", "2"}


def test_a_choice_that_does_not_compile_has_no_map(tmp_path):
    path = tmp_path / "broken.glsl"
    path.write_text("vec3 shade(vec3 l) { return nothing; }")
    rung = ladder.Rung("0", "", "", "", ())
    broken = Choice(rung, None, Path(path), [], "shade", "shade", {}, {}, {}, {}, {})
    assert illustrate.maps([broken]) == {}
