"""The macros of the ladder's rungs and presets, for tests that go through all of them."""

from __future__ import annotations

import itertools
from pathlib import Path

from harness import ladder

LADDER = ladder.load(Path(__file__).resolve().parents[2] / "shaders" / "ladder.toml")
#: the macros of brdf.glsl and their values
BRDF = {term.macro: [rung.value for rung in term.rungs] for term in LADDER.terms if term.file == "brdf.glsl"}
#: what each is where nothing is said
DEFAULT = {macro: LADDER.preset("default").macros[macro] for macro in BRDF}
#: each rung but the defaults, by itself
SINGLE = [{macro: value} for macro, values in BRDF.items() for value in values if value != DEFAULT[macro]]
PRESETS = [{m: p.macros[m] for m in BRDF if p.macros[m] != DEFAULT[m]} for p in LADDER.presets if p.name != "default"]


def name(rung: dict[str, str]) -> str:
    """For the ids of tests."""
    return "-".join(rung.values()) or "default"


def pairs() -> list[dict[str, str]]:
    """Whole models in which every two rungs of different terms meet: as few as a greedy choice finds."""
    macros = list(BRDF)
    left = {
        frozenset([(a, x), (b, y)])
        for a, b in itertools.combinations(macros, 2)
        for x, y in itertools.product(BRDF[a], BRDF[b])
    }
    everything = [dict(zip(macros, values, strict=True)) for values in itertools.product(*BRDF.values())]
    found = []
    while left:
        best = max(everything, key=lambda model: len(_pairs(model) & left))
        found.append(best)
        left -= _pairs(best)
    return found


def _pairs(model: dict[str, str]) -> set[frozenset]:
    return {frozenset(pair) for pair in itertools.combinations(model.items(), 2)}
