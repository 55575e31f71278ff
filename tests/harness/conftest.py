"""Fixtures of the calling journey's tests."""

from __future__ import annotations

import pytest
from glsl_values import TYPES

from harness import shader


@pytest.fixture
def functions(tmp_path):
    """Compiles a text; what comes back has a function of GLSL as each of its attributes."""

    def compile(text: str, **options):
        path = tmp_path / "test.glsl"
        path.write_text(text)
        return shader(path, **options)

    return compile


@pytest.fixture(scope="session")
def shared(tmp_path_factory):
    """Functions that many tests call, compiled once a mode."""
    path = tmp_path_factory.mktemp("shared") / "shared.glsl"
    text = "".join(f"{t} swap_{t}(inout {t} a, {t} b) {{ {t} old = a; a = b; return old; }}\n" for t in TYPES)
    path.write_text(text + SHARED)
    made = shader(path)
    return {mode: made.with_mode(mode) for mode in ("as-written", "precise")}


SHARED = """
float id(float x) { return x; }
vec3 id3(vec3 v) { return v; }
uint id_uint(uint x) { return x; }
int id_int(int x) { return x; }
bool id_bool(bool x) { return x; }
float sum(float a, float b) { return a + b; }
vec3 scaled(vec3 v, float s) { return v * s; }
float sum4(float a, vec2 b, float c, mat2 d) { return a + b.x + b.y + c + d[0][0] + d[0][1] + d[1][0] + d[1][1]; }
vec3 transcendental(vec3 v, float s) { return pow(abs(v), vec3(s)) + exp(sin(v.zxy)) / (1.0 + sqrt(abs(v))); }
"""
