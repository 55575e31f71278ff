"""What a SHADERed project says, as plain immutable data, every part with its line in the .sprj."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class VariableType:
    """A type of variable: ``name`` in the .sprj, ``glsl`` in shaders, the shape of its rows of values."""

    name: str
    glsl: str
    rows: int
    columns: int


def _types() -> dict[str, VariableType]:
    scalars = {"bool": ("bool", "bvec"), "int": ("int", "ivec"), "float": ("float", "vec")}
    types = [VariableType(name, glsl, 1, 1) for name, (glsl, _) in scalars.items()]
    for name, (_, vector) in scalars.items():
        types += [VariableType(f"{name}{n}", f"{vector}{n}", 1, n) for n in (2, 3, 4)]
    types += [VariableType(f"float{n}x{n}", f"mat{n}", n, n) for n in (2, 3, 4)]
    return {t.name: t for t in types}


#: name in the .sprj -> type
VARIABLE_TYPES = _types()

#: values that SHADERed itself gives to a variable with ``system="..."`` -> the type it must have
SYSTEM_TYPES = {
    "Time": "float",
    "TimeDelta": "float",
    "FrameIndex": "int",
    "ViewportSize": "float2",
    "MousePosition": "float2",
    "Mouse": "float4",
    "MouseButton": "float4",
    "View": "float4x4",
    "Projection": "float4x4",
    "ViewProjection": "float4x4",
    "Orthographic": "float4x4",
    "ViewOrthographic": "float4x4",
    "GeometryTransform": "float4x4",
    "IsPicked": "bool",
    "IsSavingToFile": "bool",
    "CameraPosition": "float4",
    "CameraPosition3": "float3",
    "CameraDirection3": "float3",
    "KeysWASD": "int4",
    "PickPosition": "float3",
}

#: kinds of vertex data, as ``<inputlayout>`` names them
LAYOUT_VALUES = ("Position", "Normal", "Texcoord", "Tangent", "Bitangent", "Color")

SHAPES = ("Cube", "ScreenQuad", "Circle", "Triangle", "Sphere", "Plane", "ScreenQuadNDC")

Number = float | int | bool
Vector3 = tuple[float, float, float]


@dataclass(frozen=True)
class Variable:
    """A uniform of a pass. ``value`` is its constant, flat: a matrix column by column, as GLSL has it."""

    name: str
    type: VariableType
    value: tuple[Number, ...]
    system: str | None  # the system value that it has instead, a key of SYSTEM_TYPES
    invert: bool
    line: int


@dataclass(frozen=True)
class ItemValue:
    """The value that ``variable`` has instead while the item named ``item`` is drawn."""

    variable: Variable
    item: str
    value: tuple[Number, ...]
    line: int


@dataclass(frozen=True)
class Macro:
    """An active ``#define name value`` of a pass; ``name`` may be ``F(x)``."""

    name: str
    value: str
    line: int


@dataclass(frozen=True)
class Shader:
    """A stage's file, relative to the project's folder."""

    path: str
    line: int


@dataclass(frozen=True)
class RenderState:
    """How items are drawn: ``cull`` leaves out the back faces, or the front ones when ``cull_front``; ``ccw`` says
    which faces are front."""

    cull: bool = True
    cull_front: bool = False
    ccw: bool = True
    depth_clamp: bool = False


@dataclass(frozen=True, kw_only=True)
class Item:
    """Something drawn. ``rotation`` is pitch, yaw and roll in radians: about x, y and z."""

    name: str
    state: RenderState
    position: Vector3
    rotation: Vector3
    scale: Vector3
    line: int


@dataclass(frozen=True, kw_only=True)
class Geometry(Item):
    """A built-in shape, one of SHAPES; ``size`` is its width, height and depth, read as each shape does."""

    shape: str
    size: Vector3


@dataclass(frozen=True, kw_only=True)
class Model(Item):
    """A model file, relative to the project's folder."""

    path: str


@dataclass(frozen=True)
class Pass:
    """A shader pass that draws to the window. Attribute location k reads ``layout[k]``, of LAYOUT_VALUES."""

    name: str
    vertex: Shader
    fragment: Shader
    layout: tuple[str, ...]
    items: tuple[Geometry | Model, ...]
    variables: tuple[Variable, ...]
    item_values: tuple[ItemValue, ...]
    macros: tuple[Macro, ...]
    line: int


@dataclass(frozen=True)
class Bind:
    """A texture's place in a pass: the textures of a pass go to its samplers in the order of ``slot``."""

    pass_name: str
    slot: int
    line: int


@dataclass(frozen=True)
class TextureObject:
    """An image file, relative to the project's folder. ``vflip``: v = 0 is its top row, else the bottom."""

    path: str
    vflip: bool
    min_filter: str
    mag_filter: str
    wrap_s: str
    wrap_t: str
    binds: tuple[Bind, ...]
    line: int


@dataclass(frozen=True)
class ArcballCamera:
    """Looks at the origin from ``distance``; angles in degrees. ``line`` is None where no entry gives it."""

    distance: float
    pitch: float
    yaw: float
    roll: float
    line: int | None = None


@dataclass(frozen=True)
class FirstPersonCamera:
    """Stands at ``position``; angles in degrees."""

    position: Vector3
    pitch: float
    yaw: float
    line: int


@dataclass(frozen=True)
class Settings:
    """What holds for the whole picture. ``include_paths`` are relative to the project's folder."""

    camera: ArcballCamera | FirstPersonCamera
    clear_color: tuple[float, float, float, float]
    use_alpha: bool
    include_paths: tuple[str, ...]


@dataclass(frozen=True)
class Project:
    """A project: the passes that draw (active, with items) in order, and the textures bound to them."""

    file: Path
    passes: tuple[Pass, ...]
    textures: tuple[TextureObject, ...]
    settings: Settings

    def path(self, relative: str) -> Path:
        """A file of the project. As in SHADERed, a leading slash does not lead out of its folder."""
        return Path(f"{self.file.parent}/{relative}")

    @property
    def include_dirs(self) -> list[Path]:
        """Where includes are looked for, in order: the include paths, then the project's folder."""
        return [*(self.file.parent / path for path in self.settings.include_paths), self.file.parent]
