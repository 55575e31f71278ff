"""What a GLSL function costs on real GPUs, none needed: Mesa's AMD driver compiles for chips that are not there.

The figures are those of the machine code, from the driver's own model of the chip, beyond a null stage with the same
inputs and outputs. They are deterministic for one version of Mesa. The program ``harness_isa`` gets them, a process of
its own: the driver's environment and its crashes stay apart.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .. import native
from ..calling.call import Function
from ..errors import NativeError
from . import cost_stage
from .chips import CHIPS, TARGETS

#: chips that the driver compiles for -> GPUs that have their instructions
PROGRAM_VARIABLE = "HARNESS_ISA"  # names another build of the program, e.g. with sanitizers
SECONDS = 60.0

_INSTALL = "on Debian: make cost"


@dataclass(frozen=True)
class Cost:
    """Of one call of a function, beyond the null stage; ``vgprs`` alone is of the whole stage. Or of a whole stage.

    ``inverse_throughput`` is in cycles a wave of 64, every block in full. ``latency`` is the driver's own, which
    weights a block under a divergent if by 0.75: where there are ``branches`` it is flattered.
    """

    target: str
    instructions: int
    vgprs: int
    latency: int
    inverse_throughput: int
    branches: bool
    driver: str  # "Mesa 22.3.6"


@cache
def unavailable() -> str | None:
    """Why nothing can be compiled here, or None when it can."""
    try:
        _run((), TARGETS[0])
    except NativeError as error:
        return error.message
    return None


def cost(function: Function, target: str = "navi21") -> Cost:
    """The cost of a function, as written, on a chip of CHIPS.

    CallError when it cannot be counted (``cost_stage.stages``), NativeError when there is no such chip or no driver.
    """
    return costs([function], target)[0]


def costs(functions: Sequence[Function], target: str) -> list[Cost]:
    """The costs of several functions on one chip, for little more than the driver's start."""
    if target not in CHIPS:
        raise NativeError(f"no target {target!r}; there are: {', '.join(CHIPS)}")
    made = [cost_stage.stages(function) for function in functions]
    pairs = [(stages.vertex, fragment) for stages in made for fragment in (stages.fragment, stages.null)]
    compiled = iter(_run(pairs, target))
    return [_difference(target, whole, null) for whole, null in zip(compiled, compiled, strict=True)]


def whole(pairs: Sequence[tuple[np.ndarray, np.ndarray]], target: str) -> list[Cost]:
    """The costs of whole fragment stages, nothing taken off: SPIR-V of (a vertex stage, the fragment stage) each.

    They may read a uniform buffer in binding 0 of set 0, and textures in bindings 1 to 16. NativeError as ``costs``.
    """
    if target not in CHIPS:
        raise NativeError(f"no target {target!r}; there are: {', '.join(CHIPS)}")
    return [_cost(target, compiled) for compiled in _run(pairs, target)]


def _cost(target: str, compiled: dict[str, Any]) -> Cost:
    counted = compiled["statistics"]
    return Cost(
        target=target,
        instructions=counted["Instructions"],
        vgprs=counted["VGPRs"],
        latency=counted["Latency"],
        inverse_throughput=_inverse_throughput(target, compiled),
        branches=_has_branches(compiled["assembly"]),
        driver=compiled["driver"],
    )


def _difference(target: str, whole: dict[str, Any], null: dict[str, Any]) -> Cost:
    counted, free = _cost(target, whole), _cost(target, null)
    return replace(
        counted,
        instructions=counted.instructions - free.instructions,
        latency=counted.latency - free.latency,
        inverse_throughput=counted.inverse_throughput - free.inverse_throughput,
    )


# ---- The driver's model of the chip, from the assembly --------------------------------------------------------------

_BLOCK = re.compile(r"^BB\d+:", re.MULTILINE)
#: a vector instruction, and how often the listing says that it comes again
_VECTOR = re.compile(r"^\t(v_\w+).*(?:\n\t\(then repeated (\d+) times\))?", re.MULTILINE)
_TRANSCENDENTAL = re.compile(r"v_(rcp|sqrt|rsq|exp|log|sin|cos)_")
_INTEGER_PRODUCT = re.compile(r"v_mul_(lo|hi)_[iu]32")
_GCN = ("tahiti", "polaris10", "vega10")


def _has_branches(assembly: str) -> bool:
    return len(_BLOCK.findall(assembly)) > 1


def _inverse_throughput(target: str, compiled: dict[str, Any]) -> int:
    """Cycles a wave of 64. The driver's own figure, but where there are branches, of which it takes a part only.

    There the vector unit's cycles are summed over all blocks, as the driver does in a single one: on GCN 4 for an
    instruction, 16 for a transcendental or a 32-bit product; on RDNA 2, and 8 for a product, transcendentals having a
    unit of their own that takes 8. (Double precision takes longer, and is not counted so.)
    """
    assembly = compiled["assembly"]
    if not _has_branches(assembly):
        return compiled["statistics"]["Inverse Throughput"]
    return vector_cycles(assembly, target)


def vector_cycles(assembly: str, target: str) -> int:
    """Cycles that the instructions of all blocks take of the busiest vector unit."""
    instructions = [name for name, again in _VECTOR.findall(assembly) for _ in range(1 + int(again or 0))]
    transcendental = sum(bool(_TRANSCENDENTAL.match(i)) for i in instructions)
    products = sum(bool(_INTEGER_PRODUCT.match(i)) for i in instructions)
    if target in _GCN:
        return 4 * len(instructions) + 12 * (transcendental + products)
    return max(2 * len(instructions) + 6 * products, 8 * transcendental)


# ---- The program ----------------------------------------------------------------------------------------------------


def _program() -> str:
    # An editable installation keeps what it built in a second folder of the package.
    built = (Path(folder, "harness_isa") for folder in native.__path__)
    path = os.environ.get(PROGRAM_VARIABLE) or next((os.fspath(p) for p in built if p.is_file()), None)
    if path is None:
        raise NativeError(f"harness_isa, which asks the driver, is not built; {_INSTALL}")
    return path


def _environment(target: str) -> dict[str, str]:
    """The driver of the chip alone, unless the user has chosen drivers himself."""
    environment = dict(os.environ, RADV_FORCE_FAMILY=target)
    if not {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"} & set(environment):
        environment.setdefault("VK_LOADER_DRIVERS_SELECT", "radeon*")
    return environment


def _run(pairs: Sequence[tuple[np.ndarray, np.ndarray]], target: str) -> list[dict[str, Any]]:
    """What the driver says of pairs of a vertex and a fragment stage."""
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for k, words in enumerate(words for pair in pairs for words in pair):
            paths.append(os.path.join(folder, f"{k}.spv"))
            Path(paths[-1]).write_bytes(words.tobytes())
        try:
            done = subprocess.run(
                [_program(), *paths], env=_environment(target), capture_output=True, text=True, timeout=SECONDS
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise NativeError(f"harness_isa does not run: {error}") from error
    if done.returncode:
        said = done.stderr.strip() or f"it ended with {done.returncode}"
        raise NativeError(f"nothing can be compiled for {target}: {said}; {_INSTALL}")
    return [json.loads(line) for line in done.stdout.splitlines()]
