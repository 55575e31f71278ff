"""What entries are compared by."""

from __future__ import annotations

import pytest

from harness.trade import figures
from harness.trade.pareto import Point


def entry(model=0.25, written=0.5, precise=0.125, cycles=100):
    at = {"median": 0, "max": 1, "at": {}}
    return {
        "name": "it",
        "model": {"p99": model, **at},
        "roundoff": {"as-written": {"p99": written, **at}, "precise": {"p99": precise, **at}},
        "cost": {"navi21": {"cycles": cycles}, "spirv": 50},
    }


def test_the_error_is_the_formulas_and_that_of_the_worse_rounding():
    assert figures.error(entry()) == 0.75
    assert figures.error(entry(written=0.125, precise=0.5)) == 0.75


@pytest.mark.parametrize("missing", [{"model": None}, {"roundoff": None}, {"cost": None}, {"cost": {"spirv": 50}}])
def test_what_was_not_measured_is_left_out(missing):
    assert figures.points([entry() | missing], "navi21") == []


def test_a_point_is_an_entrys_cost_and_error():
    assert figures.points([entry()], "navi21") == [Point("it", 100, 0.75)]
