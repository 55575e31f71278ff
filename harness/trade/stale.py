"""Whether a trade is still that of the shaders: what can be counted again in seconds is, and compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import cost, tables, text
from .choices import Choice


def differences(data: Mapping[str, Any], chosen: Sequence[Choice]) -> list[str]:
    """What of a trade is another now, a line each: rungs and presets that are not in both, and costs.

    Cycles and instructions are compared where the driver is the one that counted them; the weighted count of SPIR-V
    everywhere.
    """
    told = {entry["name"]: entry for entry in tables.every(data)}
    now = {choice.name: choice for choice in chosen}
    said = [f"{name} is not in it" for name in now if name not in told]
    said += [f"{name} is no longer there" for name in told if name not in now]
    both = {name: choice for name, choice in now.items() if name in told and told[name]["cost"]}
    if not both:
        return said
    functions = [choice.function(choice.whole) for choice in both.values()]
    counted: Sequence[Mapping[str, Any]] = [cost.counted(function) for function in functions]
    if data["targets"] and cost.driver(functions[0]) == data["machine"]["costs"]:
        counted = cost.costs(functions)
    for name, found in zip(both, counted, strict=True):
        before = told[name]["cost"]
        for part in found:
            if found[part] != before.get(part):
                said.append(f"{name} costs {_words(part, found[part])}, not {_words(part, before.get(part))}")
    return said


def _words(part: str, cost: Any) -> str:
    if isinstance(cost, Mapping):
        return f"{', '.join(f'{number} {name}' for name, number in cost.items())} on {part}"
    return f"{text.plain(cost)} weighted operations"
