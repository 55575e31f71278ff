"""Variants of project.sprj, and small projects around its shaders, for the tests of the scene."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from harness.projects import sprj
from harness.projects.project import Pass, Project, Shader
from harness.rendering import prepare
from harness.rendering.render import draw

ROOT = Path(__file__).resolve().parents[2]
PROJECT = ROOT / "project.sprj"
SIZE = (320, 180)


def floats(project: Project, size: tuple[int, int] = SIZE) -> np.ndarray:
    """The framebuffer of a project: (h, w, 4) float32, top row first."""
    return draw(project, prepare.prepare(project), *size).read_floats()[::-1]


def only(project: Project, pass_name: str, items: Iterable[str] | None = None) -> Project:
    """The project with one pass, and of it the named items."""
    (kept,) = (p for p in project.passes if p.name == pass_name)
    if items is not None:
        kept = replace(kept, items=tuple(i for i in kept.items if i.name in set(items)))
    return replace(project, passes=(kept,))


def with_values(project: Project, **values: tuple[float, ...]) -> Project:
    """The project with other constants for variables of all its passes."""

    def changed(p: Pass) -> Pass:
        return replace(
            p, variables=tuple(replace(v, value=values[v.name]) if v.name in values else v for v in p.variables)
        )

    return replace(project, passes=tuple(changed(p) for p in project.passes))


def with_item_values(project: Project, variable: str, value: Callable[[str], tuple[float, ...]]) -> Project:
    """The project with other values of a variable for the items that have their own."""

    def changed(p: Pass) -> Pass:
        values = (replace(v, value=value(v.item)) if v.variable.name == variable else v for v in p.item_values)
        return replace(p, item_values=tuple(values))

    return replace(project, passes=tuple(changed(p) for p in project.passes))


def with_fragment(project: Project, path: Path) -> Project:
    """The project with another fragment shader in all its passes."""
    shader = Shader(os.path.relpath(path, ROOT), 0)
    return replace(project, passes=tuple(replace(p, fragment=shader) for p in project.passes))


def read_project() -> Project:
    return sprj.read(PROJECT)


# ---- A small project around pbr.vert and pbr.frag -----------------------------------------------------------------

#: white key light from over the viewer's shoulder, the others off
LIGHTS = {
    "key_direction": (0.4, 0.5, 0.8),
    "key_irradiance": (2.0, 2.0, 2.0),
    "fill_direction": (1, 0, 0),
    "fill_irradiance": (0, 0, 0),
    "rim_direction": (0, 1, 0),
    "rim_irradiance": (0, 0, 0),
}
MAPS = ("ALBEDO", "ROUGHNESS", "METALNESS", "NORMAL")
ITEM = '<item name="Pot" type="model"><filepath>models/teapot.glb</filepath><scaleX>0.6</scaleX><y>-0.8</y></item>'


def constant_map(path: Path, *rgb: int) -> None:
    """An image of one colour."""
    Image.fromarray(np.full((4, 4, 3), rgb, np.uint8)).save(path)


def write_small_project(
    folder: Path,
    maps: dict[str, Path],
    constants: dict[str, tuple[float, ...]],
    macros: dict[str, str] | None = None,
    item: str = ITEM,
) -> Path:
    """A project of one item with the shaders of this one; what is not in ``maps`` is a constant.

    Textures are not filtered: llvmpipe filters bytes in fixed point, and rounds.
    """
    shutil.copytree(ROOT / "shaders", folder / "shaders", dirs_exist_ok=True)
    (folder / "models").mkdir(exist_ok=True)
    shutil.copy(ROOT / "models" / "teapot.glb", folder / "models")
    defines = {f"HAS_{name}_MAP": "1" for name in maps} | (macros or {})
    layout = ["Position", "Normal"]
    layout += ["Texcoord"] if maps else []
    layout += ["Tangent"] if "NORMAL" in maps else []
    layout += ["Bitangent"] if "NORMAL" in maps and "HAS_MIRRORED_UV" in defines else []

    def variable(name: str, value: tuple[float, ...]) -> str:
        kind = "float" if len(value) == 1 else f"float{len(value)}"
        row = "".join(f"<value>{v!r}</value>" for v in value)
        return f'<variable type="{kind}" name="{name}"><row>{row}</row></variable>'

    textures = "".join(
        f'<object type="texture" path="{maps[name]}" vflip="true" min_filter="Nearest" mag_filter="Nearest">'
        f'<bind slot="{slot}" name="Main" /></object>'
        for slot, name in enumerate(n for n in MAPS if n in maps)
    )
    path = folder / "project.sprj"
    path.write_text(
        f"""<?xml version="1.0"?>
<project version="2"><pipeline><pass name="Main" type="shader" active="true">
<shader type="vs" path="shaders/pbr.vert" entry="main" /><shader type="ps" path="shaders/pbr.frag" entry="main" />
<inputlayout>{"".join(f'<item value="{v}" semantic="{v.upper()}" />' for v in layout)}</inputlayout>
<items>{item}</items>
<variables>
<variable type="float4x4" name="view_projection" system="ViewProjection" />
<variable type="float4x4" name="model" system="GeometryTransform" />
<variable type="float4x4" name="model_inverse" system="GeometryTransform" invert="true" />
<variable type="float3" name="camera_position" system="CameraPosition3" />
{"".join(variable(name, value) for name, value in (LIGHTS | constants).items())}
</variables>
<macros>{"".join(f'<define name="{n}" active="true">{v}</define>' for n, v in defines.items())}</macros>
</pass></pipeline><objects>{textures}</objects><cameras />
<settings>
<entry type="camera" fp="false"><distance>5</distance><pitch>20</pitch><yaw>200</yaw><roll>0</roll></entry>
<entry type="clearcolor" r="0" g="0" b="0" a="1" /><entry type="ipaths"><path>shaders</path></entry>
</settings></project>
"""
    )
    return path
