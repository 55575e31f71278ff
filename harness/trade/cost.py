"""What a function costs on GPUs that need not be there, and by its SPIR-V alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..calling.function import Function
from ..costing import isa, spirv_cost
from ..costing.chips import TARGETS
from ..errors import CallError


def targets() -> tuple[str, ...]:
    """The chips that costs are told for; none where there is no driver for them (``isa.unavailable``)."""
    return () if isa.unavailable() else TARGETS


def costs(functions: Sequence[Function], progress: Callable[[str], None] = lambda _: None) -> list[dict[str, Any]]:
    """Of each function, beyond a null stage of the same inputs and outputs: ``{target: {"instructions", "vgprs",
    "latency", "cycles"}, "spirv": weighted operations}``; ``vgprs`` alone is of the whole stage.

    ``cycles`` are the inverse throughput for a wave of 64, every block in full; ``latency`` is the driver's own.
    ``progress`` is called with each chip before it is compiled for. CallError when a function cannot be counted.
    """
    found = [counted(function) for function in functions]
    for target in targets():
        progress(target)
        for own, cost in zip(found, isa.costs(functions, target), strict=True):
            own[target] = {
                "instructions": cost.instructions,
                "vgprs": cost.vgprs,
                "latency": cost.latency,
                "cycles": cost.inverse_throughput,
            }
    return found


def counted(function: Function) -> dict[str, Any]:
    """The cost by its SPIR-V alone: ``{"spirv": weighted operations}``. CallError when it cannot be counted."""
    return {"spirv": spirv_cost.weighted_count(function)}


def driver(function: Function) -> str | None:
    """The driver that tells costs, such as "Mesa 22.3.6"; None where there is none, or the function has no cost."""
    try:
        return isa.cost(function, targets()[0]).driver if targets() else None
    except CallError:
        return None
