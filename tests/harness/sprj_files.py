"""Writes small SHADERed projects for the tests of the reader and the renderer."""

from __future__ import annotations

from pathlib import Path

#: a full-screen quad: location 0 is its position, 1 its texture coordinate
QUAD_VERT = """#version 330
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texcoord;
out vec2 uv;
void main()
{
    uv = texcoord;
    gl_Position = vec4(position, 0.0, 1.0);
}
"""

QUAD_ITEM = '<item name="{name}" type="geometry"><type>ScreenQuadNDC</type></item>'

SHADERS = """<shader type="vs" path="quad.vert" entry="main" />
<shader type="ps" path="{fragment}" entry="main" />"""


def shader_pass(name: str = "Quad", *, fragment: str = "quad.frag", items: str | None = None, extra: str = "") -> str:
    """A pass with a full-screen quad, or other items, and what else is given."""
    items = QUAD_ITEM.format(name=f"{name}Item") if items is None else items
    return f"""<pass name="{name}" type="shader" active="true">
{SHADERS.format(fragment=fragment)}
<items>
{items}
</items>
{extra}
</pass>
"""


def write_project(folder: Path, passes: str, *, objects: str = "", settings: str = "", rest: str = "") -> Path:
    """A version 2 project in ``folder``."""
    path = folder / "project.sprj"
    path.write_text(
        f"""<?xml version="1.0"?>
<project version="2">
<pipeline>
{passes}
</pipeline>
<objects>
{objects}
</objects>
<settings>
{settings}
</settings>
{rest}
</project>
"""
    )
    return path


def write_quad(folder: Path, body: str, declarations: str = "", *, extra: str = "", **rest: str) -> Path:
    """A project with one full-screen pass, whose fragment shader sets ``vec4 color`` in ``body``."""
    (folder / "quad.vert").write_text(QUAD_VERT)
    (folder / "quad.frag").write_text(
        f"""#version 330
{declarations}
in vec2 uv;
out vec4 color;
void main()
{{
    color = vec4(uv, 0.0, 1.0);
    {body}
}}
"""
    )
    return write_project(folder, shader_pass(extra=extra), **rest)


def line_of(path: Path, text: str) -> int:
    """The number of the one line that contains ``text``."""
    (line,) = [n for n, line in enumerate(path.read_text().splitlines(), 1) if text in line]
    return line
