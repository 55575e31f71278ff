"""Writes a small project that can be handed in, for the tests of that."""

from __future__ import annotations

from pathlib import Path

from sprj_files import QUAD_VERT, shader_pass, texture, write_project, write_texture

from harness.submission import exercise

FRAGMENT = """#version 330
#ifdef GL_GOOGLE_include_directive
#extension GL_GOOGLE_include_directive : enable
#endif
#include "library/tint.glsl"
uniform sampler2D picture;
in vec2 uv;
out vec4 color;
void main()
{
    if (uv.x > 0.5)
        discard;
    color = vec4(tint(texture(picture, uv).rgb), 1.0);
}
"""
TINT = """// What is above.

// A colour made redder; <b> & co. are no tags.
vec3 tint(
    vec3 c)
{
    return c * vec3(1.0, 0.5, 0.25);
}
"""
EXERCISE = """
title = "Small <& sweet>"
course = "Course"
summary = "Summary"
alt = "A half"
tests = ["tests"]

[[part]]
name = "1"
title = "A tint"
points = 3
asked = "A tint."
done = "It is there."
tests = ["tests/test_small.py::test_that_passes"]
[[part.region]]
pass = "Quad"
caption = "The left half."
[[part.shader]]
file = "shaders/library/tint.glsl"
function = "tint"
"""
TESTS = """import pytest

@pytest.mark.parametrize("n", range(3))
def test_that_passes(n):
    pass

@pytest.mark.skip
def test_that_is_skipped():
    pass
"""
NAMES = [
    "project.sprj",
    "report.html",
    "shaders/library/tint.glsl",
    "shaders/quad.frag",
    "shaders/quad.vert",
    "textures/red.png",
]


def write_small(folder: Path) -> Path:
    """A project of one pass, drawn to the left half, with an include, a texture, tests, and files it does not use."""
    for name in ("shaders/library", "textures", "docs", "tests"):
        (folder / name).mkdir(parents=True)
    (folder / "shaders/quad.vert").write_text(QUAD_VERT)
    (folder / "shaders/quad.frag").write_text(FRAGMENT)
    (folder / "shaders/library/tint.glsl").write_text(TINT)
    (folder / "shaders/unused.glsl").write_text(TINT)
    write_texture(folder, "textures/red.png", (200, 100, 50))
    write_texture(folder, "textures/unused.png")
    (folder / "textures/make_textures.py").write_text("")
    (folder / exercise.FILE).write_text(EXERCISE)
    (folder / "tests/test_small.py").write_text(TESTS)
    layout = '<inputlayout><item value="Position" semantic="P" /><item value="Texcoord" semantic="T" /></inputlayout>'
    passes = shader_pass(fragment="shaders/quad.frag", extra=layout).replace('"quad.vert"', '"shaders/quad.vert"')
    settings = '<entry type="ipaths"><path>shaders</path></entry>'
    return write_project(folder, passes, objects=texture("textures/red.png"), settings=settings)


def replace(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
