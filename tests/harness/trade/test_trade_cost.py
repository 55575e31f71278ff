"""Costs of functions together. Expected: what each costs alone, and what is known of the fallback."""

from __future__ import annotations

import pytest

from harness import CallError
from harness.costing import isa
from harness.trade import cost

TEXT = "float f(float x, float y) { return x * y + x; } vec3 g(vec3 v) { return v * v + 1.5; }"
needs_driver = pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))


@needs_driver
def test_each_costs_what_it_costs_alone(functions):
    compiled = functions(TEXT)
    told = []
    found = cost.costs([compiled.f, compiled.g], told.append)
    assert told == list(isa.TARGETS) == list(cost.targets())
    alone = isa.cost(compiled.g, "gfx1100")
    assert found[1]["gfx1100"] == {
        "instructions": alone.instructions,
        "vgprs": alone.vgprs,
        "latency": alone.latency,
        "cycles": alone.inverse_throughput,
    }
    assert cost.driver(compiled.f) == alone.driver


def test_without_a_driver_operations_are_counted(functions, monkeypatch):
    """A product and a sum, of one number and of three."""
    monkeypatch.setattr(isa, "unavailable", lambda: "no driver")
    compiled = functions(TEXT)
    assert cost.costs([compiled.f, compiled.g]) == [{"spirv": 2}, {"spirv": 6}]
    assert cost.targets() == ()


def test_what_cannot_be_counted_is_refused(functions):
    with pytest.raises(CallError, match="uniforms"):
        cost.counted(functions("uniform float k; float f(float x) { return x * k; }").f)
