"""``harness cost``: what one call of a GLSL function costs on real GPUs."""

from __future__ import annotations

import argparse
import sys

from ..costing.chips import CHIPS, TARGETS
from . import _shader

SHORT = "count what a GLSL function costs on GPUs"
DESCRIPTION = """\
Compiles one GLSL function for GPUs that need not be there, and prints what the machine code costs beyond a null shader
with the same inputs and outputs: instructions, latency and cycles a wave of 64 (inverse throughput) by the driver's
model of the chip, and vector registers (of the whole shader). The last line is a count of SPIR-V operations, weighted
(transcendental 4, division 5, clamp and negation 0), which needs no driver.

  harness cost shaders/brdf.glsl shade
  harness cost shaders/brdf.glsl shade -D BRDF_V=V_HAMMON --target navi21
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, the function and the chips."""
    _shader.add_arguments(parser)
    parser.add_argument("function", metavar="FUNCTION", help="its name")
    parser.add_argument(
        "--target",
        type=lambda text: text.split(","),
        default=list(TARGETS),
        metavar="A,B",
        help=f"chips, of {', '.join(CHIPS)} ({','.join(TARGETS)})",
    )


def run(options: argparse.Namespace) -> None:
    """Prints a table, and on stderr why there are no chips in it when there is no driver."""
    from ..costing import isa, spirv_cost

    function = _shader.load(options)[options.function]
    count = spirv_cost.weighted_count(function)
    reason = isa.unavailable()
    if reason is None:
        costs = [isa.cost(function, target) for target in options.target]
        print(f"{costs[0].driver:<12}{'instructions':>14}{'VGPRs':>8}{'latency':>10}{'cycles':>9}")
        for cost in costs:
            note = "  latency flattered by branches" if cost.branches else ""
            print(
                f"{cost.target:<12}{cost.instructions:>14}{cost.vgprs:>8}{cost.latency:>10}"
                f"{cost.inverse_throughput:>9}{note}"
            )
    else:
        print(f"harness: no GPU's instructions: {reason}", file=sys.stderr)
    print(f"{'SPIR-V':<12}{count:>14g}")
