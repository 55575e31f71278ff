"""Fixtures of the trade's tests: the project's shading model, and a small project with a ladder of its own."""

from __future__ import annotations

import pytest
from sprj_files import write_quad

from harness import ladder, shader

LADDER = """
[[term]]
name = "gain"
title = "Gain"
macro = "GAIN"
file = "brdf.glsl"
function = "gain"
exact = "GAIN_ONE"
inputs = {{ x = "[1,2]" }}
{rungs}

[[term]]
name = "tone"
title = "Tone"
macro = "TONE"
file = "tone.glsl"
function = "tone"
exact = "TONE_TWICE"
inputs = {{ c = "[0,1]" }}

[[term.rung]]
value = "TONE_PLAIN"
title = "Plain"
source = "by hand"
domain = "everywhere"
suits = []

[[term.rung]]
value = "TONE_TWICE"
title = "Twice"
source = "by hand"
domain = "everywhere"
suits = []

[[preset]]
name = "exact"
title = "Exact"
source = "by hand"
macros = {{ GAIN = "GAIN_ONE", TONE = "TONE_TWICE" }}
"""
RUNG = """
[[term.rung]]
value = "{0}"
title = "{0}"
source = "by hand"
domain = "everywhere"
suits = ["desktop"]
"""
MODEL = """
#define GAIN_ONE 0
#define GAIN_MORE 1
#define GAIN_BROKEN 2
#ifndef GAIN
#define GAIN GAIN_ONE
#endif

struct Material { vec3 albedo; float metalness; float roughness; };

float gain(float x)
{
#if GAIN == GAIN_MORE
    return x * 1.25;
#elif GAIN == GAIN_BROKEN
    return x / 0.0 * 0.0;
#else
    return x;
#endif
}

vec3 shade(vec3 l, vec3 v, vec3 n, Material m)
{
    return m.albedo * gain(max(dot(n, l), 0.0) * 0.318309886 + m.roughness * m.metalness * 0.0);
}
"""
TONE = """
#define TONE_PLAIN 0
#define TONE_TWICE 1
#ifndef TONE
#define TONE TONE_PLAIN
#endif
float tone(float c) { return c * (1.0 + float(TONE)); }
"""


@pytest.fixture
def small(tmp_path):
    """A project of one quad, lit by ``shade``, and its ladder: (path of the project, ladder)."""

    def write(rungs=("GAIN_ONE", "GAIN_MORE"), model: str = MODEL):
        (tmp_path / "brdf.glsl").write_text(model)
        (tmp_path / "tone.glsl").write_text(TONE)
        body = "color = vec4(vec3(tone(gain(0.2))), 1.0);"
        project = write_quad(tmp_path, body, '#include "brdf.glsl"\n#include "tone.glsl"')
        (tmp_path / ladder.FILE).write_text(LADDER.format(rungs="".join(map(RUNG.format, rungs))))
        return project, ladder.load(tmp_path / ladder.FILE)

    return write


@pytest.fixture(scope="session")
def brdf(root):
    """Functions of the project's shading model, compiled once a set of macros."""
    compiled = {}

    def load(**macros):
        key = tuple(sorted(macros.items()))
        if key not in compiled:
            compiled[key] = shader(root / "shaders" / "brdf.glsl", macros)
        return compiled[key]

    return load


@pytest.fixture
def model(functions):
    """A shading function with a body of its own: ``model("return m.albedo;")``."""

    def compile(body: str):
        struct = "struct Material { vec3 albedo; float metalness; float roughness; };"
        return functions(f"{struct}\nvec3 shade(vec3 l, vec3 v, vec3 n, Material m) {{ {body} }}").shade

    return compile
