"""Small scenes of the project's own shaders for the tests of tuning: one pass, two balls, three lights."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
SIZE = (96, 54)

LIGHTS = {
    "key_direction": (-0.5, 0.7, 0.75),
    "key_irradiance": (2.5, 2.4, 2.2),
    "fill_direction": (0.9, 0.15, 0.45),
    "fill_irradiance": (0.5, 0.6, 0.8),
    "rim_direction": (0.45, 0.6, -0.66),
    "rim_irradiance": (1.8, 2.0, 2.4),
}
#: bytes of maps that are the same everywhere
FLAT, ROUGH = (128, 128, 255), (153, 153, 153)

_TEXT = """<?xml version="1.0"?>
<!-- bälls, by hand -->
<project version="2">
  <pipeline>
    <pass name="Balls" type="shader" active="true">
      <shader type="vs" path="shaders/pbr.vert" entry="main" />
      <shader type="ps" path="shaders/pbr.frag" entry="main" />
      <inputlayout>{layout}
      </inputlayout>
      <rendertexture />
      <items>
        <item name="Ball" type="geometry"><type>Sphere</type><width>1</width><x>-1.1</x></item>
        <item name="Box" type="geometry"><type>Cube</type><width>1.4</width><x>1.1</x><yaw>0.5</yaw></item>
      </items>
      <variables>
        <variable type="float4x4" name="view_projection" system="ViewProjection" />
        <variable type="float4x4" name="model" system="GeometryTransform" />
        <variable type="float4x4" name="model_inverse" system="GeometryTransform" invert="true" />
        <variable type="float3" name="camera_position" system="CameraPosition3" />{variables}
      </variables>
      <macros>{macros}
      </macros>
    </pass>
  </pipeline>
  <objects>{objects}
  </objects>
  <cameras />
  <settings>
    <entry type="camera" fp="false"><distance>5</distance><pitch>20</pitch><yaw>200</yaw><roll>0</roll></entry>
    <entry type="clearcolor" r="0" g="0" b="0" a="1" />
    <entry type="usealpha" val="false" />
    <entry type="ipaths"><path>shaders</path></entry>
  </settings>
  <plugindata />
</project>
"""


def define(name: str, value: str) -> str:
    """A macro of the pass, in its line."""
    return f'\n        <define name="{name}" active="true">{value}</define>'


def variable(name: str, *values: float) -> str:
    """A constant of the pass, in its line."""
    kind = "float" if len(values) == 1 else f"float{len(values)}"
    row = "".join(f"<value>{v:g}</value>" for v in values)
    return f'\n        <variable type="{kind}" name="{name}"><row>{row}</row></variable>'


def attribute(value: str) -> str:
    """An item of the input layout, in its line."""
    return f'\n        <item value="{value}" semantic="{value.upper()}" />'


def bound(path: str, slot: int) -> str:
    """A texture of the pass, in its lines."""
    return (
        f'\n    <object type="texture" path="{path}" min_filter="Linear_MipmapLinear" mag_filter="Linear">'
        f'\n      <bind slot="{slot}" name="Balls" />\n    </object>'
    )


def text(
    constants: Mapping[str, tuple[float, ...]],
    macros: Mapping[str, str] | None = None,
    textures: tuple[str, ...] = (),
    layout: tuple[str, ...] = ("Position", "Normal"),
) -> str:
    """The .sprj."""
    return _TEXT.format(
        layout="".join(map(attribute, layout)),
        variables="".join(variable(n, *v) for n, v in (LIGHTS | dict(constants)).items()),
        macros="".join(define(n, v) for n, v in (macros or {}).items()),
        objects="".join(bound(path, k) for k, path in enumerate(textures)),
    )


def write(folder: Path, text: str) -> Path:
    """The project with its shaders, in a folder that is there."""
    shutil.copytree(ROOT / "shaders", folder / "shaders", dirs_exist_ok=True)
    path = folder / "scene.sprj"
    path.write_bytes(text.encode())
    return path


def rough_dielectric(folder: Path) -> Path:
    """Plastic whose metalness is a number, 0, with texture coordinates that nothing reads."""
    constants = {"albedo": (0.7, 0.2, 0.1), "roughness": (1,), "metalness": (0,)}
    return write(folder, text(constants, layout=("Position", "Normal", "Texcoord")))


def smooth_metal(folder: Path) -> Path:
    """Polished metal, which has no diffuse part."""
    return write(folder, text({"albedo": (1, 0.77, 0.34), "roughness": (0.25,), "metalness": (1,)}))


def textured(folder: Path) -> Path:
    """Coloured stripes with a roughness map of one value, a metalness map of 0 and a normal map that is flat."""
    stripes = np.zeros((32, 32, 3), np.uint8)
    stripes[:, :16], stripes[:, 16:] = (200, 120, 60), (60, 100, 190)
    Image.fromarray(stripes).save(folder / "Color.png")
    for name, color in {"Roughness": ROUGH, "Metalness": (0, 0, 0), "NormalGL": FLAT}.items():
        Image.new("RGB", (8, 8), color).save(folder / f"{name}.png")
    macros = {f"HAS_{name}_MAP": "1" for name in ("ALBEDO", "ROUGHNESS", "METALNESS", "NORMAL")}
    maps = ("Color.png", "Roughness.png", "Metalness.png", "NormalGL.png")
    return write(folder, text({}, macros, maps, ("Position", "Normal", "Texcoord", "Tangent")))
