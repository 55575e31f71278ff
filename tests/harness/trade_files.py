"""Writes a model of one term with two rungs beside the shaders of a project, and tells the trade of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import trade_data

MODEL = """
#ifndef WHITE
#define WHITE 0
#endif
struct Material { vec3 albedo; float metalness; float roughness; };
vec3 light(vec3 c)
{
#if WHITE == 1
    return c + c * c;
#else
    return c;
#endif
}
vec3 shade(vec3 l, vec3 v, vec3 n, Material m) { return l * light(m.albedo); }
"""
LADDER = """
[[term]]
name = "light"
title = "Light"
macro = "WHITE"
file = "model.glsl"
function = "light"
exact = "0"
inputs = { c = "color" }
[[term.rung]]
value = "0"
title = "none"
source = "-"
domain = "everywhere"
suits = ["mobile"]
[[term.rung]]
value = "1"
title = "more"
source = "-"
domain = "everywhere"
suits = ["desktop"]
[[preset]]
name = "exact"
title = "exact"
source = "-"
macros = { WHITE = "0" }
"""
#: a product, an addition and a product, of three components each, as harness/costing/spirv_cost.py weighs them
OPERATIONS = {"0": 3.0, "1": 9.0, "exact": 3.0}


def write_model(folder: Path) -> None:
    """model.glsl and ladder.toml."""
    (folder / "model.glsl").write_text(MODEL)
    (folder / "ladder.toml").write_text(LADDER)


def trade() -> dict[str, Any]:
    """What was measured of it, where no driver tells cycles."""
    data = trade_data.trade()
    entry = data["presets"][0]

    def measured(name: str) -> dict[str, Any]:
        return entry | {"name": name, "cost": {"spirv": OPERATIONS[name]}}

    term = data["terms"][0] | {"name": "light", "macro": "WHITE", "rungs": [measured("0"), measured("1")]}
    return data | {"targets": [], "terms": [term], "presets": [measured("exact")]}
