"""Which preset to take for a phone, a desktop and ground truth, and what one gives up: computed, by stated rules."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from . import figures, text
from .figures import HALF, SINGLE, Entry, broken

#: how far a desktop's picture may be from the reference's, in 1/255 of a channel of any pixel
BUDGET = 1.0
#: what a white furnace may return beyond what it gets, and still make no light: fits of energy are not better
FURNACE = 0.02


@dataclass(frozen=True)
class Answer:
    """The preset ``name`` for a ``use``, ``why`` it, and what one ``gives_up`` with it, a phrase each.

    ``name`` is None where the figures that the rule needs were not measured; ``why`` then says so.
    """

    use: str
    name: str | None
    why: str
    gives_up: tuple[str, ...]


def answers(data: Mapping[str, Any]) -> list[Answer]:
    """For a phone, a desktop and ground truth, in this order."""
    return [_phone(data), _desktop(data), _truth(data)]


def _phone(data: Mapping[str, Any]) -> Answer:
    presets = [p for p in data["presets"] if broken(p, HALF) is not None and figures.operations(p) is not None]
    if not presets:
        return Answer("a phone", None, "no preset has both its extremes in half precision and its cost", ())
    kept, rule = _soundest(presets, HALF, "half precision, which phones compute in")
    chosen = min(kept, key=figures.operations)
    weight = (
        f"{text.plain(figures.operations(chosen))} weighted SPIR-V operations (no chip of a phone is among the targets)"
    )
    return Answer("a phone", chosen["name"], f"the cheapest {rule}: {weight}", _gives_up(data, chosen))


def _desktop(data: Mapping[str, Any]) -> Answer:
    presets = [p for p in data["presets"] if broken(p, SINGLE) is not None and _total(data, p) is not None]
    if not presets:
        return Answer("a desktop", None, "no preset has both its extremes in single precision and its cycles", ())
    kept, rule = _soundest(presets, SINGLE, "single precision")
    alike = [p for p in kept if _alike(data, p)]
    if not alike:
        why = f"none {rule} is known to draw the scene within {BUDGET:g}/255 of {data['reference']}"
        return Answer("a desktop", None, why, ())
    chosen = min(alike, key=lambda p: _total(data, p))
    if chosen["name"] == data["reference"]:
        why = f"the reference: no cheaper one {rule} draws the scene within {BUDGET:g}/255 of it"
    else:
        why = f"the cheapest {rule} and draws the scene within {BUDGET:g}/255 of {data['reference']}"
    return Answer("a desktop", chosen["name"], f"{why}: {_cycles(data, chosen)}", _gives_up(data, chosen))


def _truth(data: Mapping[str, Any]) -> Answer:
    presets = [p for p in data["presets"] if broken(p, SINGLE) is not None and p["energy"]]
    presets = [p for p in presets if figures.error(p) is not None]
    if not presets:
        return Answer("ground truth", None, "no preset has its extremes, its energy and its error", ())
    kept, rule = _soundest(presets, SINGLE, "single precision")
    lawful = [p for p in kept if _excess(p) == 0]
    if lawful:
        chosen = min(lawful, key=figures.rounding)
        returned = text.plain(chosen["energy"]["furnace_max"], 4)
        law = f"to {text.percent(FURNACE)}: a white furnace gets back at most {returned} of what it gave"
        why = f"the most accurate {rule} and makes no light, {law}"
    else:
        chosen = min(kept, key=figures.error)
        why = f"the most accurate {rule}; all of them make light"
    return Answer("ground truth", chosen["name"], why, _gives_up(data, chosen))


def _soundest(presets: Sequence[Entry], modes: Sequence[str], where: str) -> tuple[list[Entry], str]:
    """Those that break at the fewest of the extreme inputs, and that said in words."""
    fewest = min(broken(p, modes) for p in presets)
    kept = [p for p in presets if broken(p, modes) == fewest]
    inputs = text.count(kept[0]["extremes"]["inputs"])
    if fewest == 0:
        return kept, f"that is finite and not negative at all {inputs} extreme inputs in {where}"
    return kept, f"of those that break at the fewest extreme inputs ({text.count(fewest)} of {inputs}) in {where}"


def _alike(data: Mapping[str, Any], preset: Entry) -> bool:
    return preset["name"] == data["reference"] or (preset["scene"] is not None and preset["scene"]["max"] <= BUDGET)


def _total(data: Mapping[str, Any], preset: Entry) -> float | None:
    """Cycles on all targets together, or weighted operations where no driver told cycles."""
    found = [figures.cycles(preset, target) for target in data["targets"]]
    return figures.operations(preset) if not found or None in found else sum(found)


def _cycles(data: Mapping[str, Any], preset: Entry) -> str:
    found = [(target, figures.cycles(preset, target)) for target in data["targets"]]
    if not found or any(cycles is None for _, cycles in found):
        return f"{text.plain(figures.operations(preset))} weighted SPIR-V operations"
    (first, least), *others = found
    return ", ".join([f"{least:g} cycles on {first}", *(f"{cycles:g} on {target}" for target, cycles in others)])


def _gives_up(data: Mapping[str, Any], preset: Entry) -> tuple[str, ...]:
    """What is worse than it could be: beside the cheapest of the presets, and beside the reference."""
    said = [_speed(data, preset), *_likeness(data, preset), *_breaks(preset), _light(preset)]
    return tuple(phrase for phrase in said if phrase)


def _speed(data: Mapping[str, Any], preset: Entry) -> str | None:
    known = [p for p in data["presets"] if _total(data, p) is not None]
    if preset not in known:
        return None
    cheapest = min(known, key=lambda p: _total(data, p))
    more = _total(data, preset) / _total(data, cheapest) - 1
    if more <= 0:
        return None
    return f"{text.percent(more)} more cycles than {cheapest['name']}" + _slower(preset, cheapest)


def _slower(preset: Entry, cheapest: Entry) -> str:
    """The same by the clock, on each device that timed both."""
    clocks = {(t["backend"], t["device"]): t["ns"] for t in cheapest["time"] or ()}
    both = [(text.short(t["device"]), t["ns"], clocks.get((t["backend"], t["device"]))) for t in preset["time"] or ()]
    told = [f"{text.plain(ns)} ns for {text.plain(least)} on {device}" for device, ns, least in both if least]
    return f" ({'; '.join(told)})" if told else ""


def _likeness(data: Mapping[str, Any], preset: Entry) -> list[str]:
    reference = data["reference"]
    if preset["name"] == reference:
        return []
    said = []
    if preset["model"] and preset["model"]["p99"]:
        said.append(
            f"values that differ from those of {reference} by {text.number(preset['model']['p99'])} (99th percentile)"
        )
    scene = preset["scene"]
    if scene and scene["max"]:
        seen = "" if scene["flip"] is None else f"ꟻLIP {text.number(scene['flip'])}, "
        most = f"up to {scene['max']:g}/255 of the scene's picture"
        said.append(f"{most} ({seen}{text.percent(scene['changed'])} of the pixels change)")
    return said


def _breaks(preset: Entry) -> list[str]:
    inputs = (preset["extremes"] or {}).get("inputs")
    counts = [(name, broken(preset, modes)) for name, modes in (("single", SINGLE), ("half", HALF))]
    return [
        f"{text.count(n)} of {text.count(inputs)} extreme inputs break in {name} precision" for name, n in counts if n
    ]


def _light(preset: Entry) -> str | None:
    if not preset["energy"] or _excess(preset) == 0:
        return None
    return f"energy: a white furnace gets back up to {text.plain(preset['energy']['furnace_max'])} times what it gave"


def _excess(preset: Entry) -> float:
    """What a white furnace gets back beyond what it gave; infinite where that is no number."""
    returned = preset["energy"]["furnace_max"]
    return math.inf if returned is None or math.isnan(returned) else max(returned - 1 - FURNACE, 0)
