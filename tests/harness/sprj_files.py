"""Writes small SHADERed projects for the tests of the reader and the renderer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from harness import ProjectError
from harness.projects import sprj
from harness.projects.project import Project
from harness.projects.traps import Traps, Warning
from harness.rendering.render import Renderer

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


def row(*values: object) -> str:
    """A ``<row>`` of ``<value>``s."""
    return "<row>" + "".join(f"<value>{v}</value>" for v in values) + "</row>"


def variables(*elements: str) -> str:
    """The ``<variables>`` of a pass, one a line."""
    return "<variables>\n" + "\n".join(elements) + "\n</variables>"


def constant(name: str, variable_type: str, *values: object) -> str:
    """A variable that is a constant."""
    return f'<variable type="{variable_type}" name="{name}">{row(*values)}</variable>'


def item(name: str, tags: str = "", *, kind: str = "geometry") -> str:
    """An item with these tags in it."""
    return f'<item name="{name}" type="{kind}">{tags}</item>'


def read(path: Path) -> Project:
    """The project, of which there is nothing to warn."""
    traps = Traps()
    project = sprj.read(path, traps)
    assert traps.warnings == []
    return project


def refusal(path: Path) -> ProjectError:
    """What the reader says of a project that it refuses."""
    with pytest.raises(ProjectError) as caught:
        sprj.read(path)
    assert caught.value.file == str(path)
    return caught.value


def warned(path: Path) -> tuple[Project, Warning]:
    """A project that the reader has one warning about, and that."""
    traps = Traps()
    project = sprj.read(path, traps)
    (warning,) = traps.warnings
    assert warning.file == str(path)
    return project, warning


#: of the pictures of small projects
SIZE = (4, 3)


def floats(path: Path, size: tuple[int, int] = SIZE) -> np.ndarray:
    """The window: (h, w, 4) float32, top row first."""
    renderer = Renderer(path, size)
    renderer.draw()
    return renderer.floats()


def first_floats(path: Path, size: tuple[int, int] = SIZE) -> np.ndarray:
    """The floats of one pixel."""
    return floats(path, size)[0, 0]


def drawn(path: Path, size: tuple[int, int] = SIZE, **how) -> tuple[np.ndarray, list[str]]:
    """The window's floats and the messages of all warnings."""
    renderer = Renderer(path, size, **how)
    renderer.draw()
    return renderer.floats(), [w.message for w in renderer.warnings]


def write_texture(folder: Path, name: str, color: tuple[int, ...] = (255, 0, 0)) -> None:
    """A picture of one pixel."""
    Image.new("RGBA" if len(color) == 4 else "RGB", (1, 1), color).save(folder / name)


def texture(path: str, slot: int = 0, name: str = "Quad", more: str = "") -> str:
    """A texture object, bound to a pass."""
    return f'<object type="texture" path="{path}" {more}><bind slot="{slot}" name="{name}" /></object>\n'
