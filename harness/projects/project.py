"""What a SHADERed project says, as plain immutable data, every part with its line in the .sprj."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


@dataclass(frozen=True)
class VariableType:
    """A type of variable: ``name`` in the .sprj, ``glsl`` in shaders, the shape of its rows of values."""

    name: str
    glsl: str
    rows: int
    columns: int

    @property
    def size(self) -> int:
        """How many numbers it has."""
        return self.rows * self.columns

    @property
    def base(self) -> str:
        """Of what kind they are: float, int or bool."""
        return self.name.rstrip("x1234567890")


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

_MATRIX = ("float4x4",)
#: functions that compute a variable -> how many numbers they take, and of which types they can be
FUNCTIONS = {
    "MatrixIdentity": (0, _MATRIX),
    "MatrixLookAtLH": (9, _MATRIX),
    "MatrixLookToLH": (9, _MATRIX),
    "MatrixOrthographicLH": (4, _MATRIX),
    "MatrixPerspectiveFovLH": (4, _MATRIX),
    "MatrixPerspectiveLH": (4, _MATRIX),
    "MatrixRotationAxis": (4, _MATRIX),
    "MatrixRotationNormal": (4, _MATRIX),
    "MatrixRotationRollPitchYaw": (3, _MATRIX),
    "MatrixRotationX": (1, _MATRIX),
    "MatrixRotationY": (1, _MATRIX),
    "MatrixRotationZ": (1, _MATRIX),
    "MatrixScaling": (3, _MATRIX),
    "MatrixTranslation": (3, _MATRIX),
    "ScalarCos": (1, ("float",)),
    "ScalarSin": (1, ("float",)),
    "VectorNormalize": (4, ("float2", "float3", "float4")),
}
#: those that take names instead: of a variable, of a camera, of an item and one of its properties
NAME_FUNCTIONS = {
    "Pointer": (1, tuple(VARIABLE_TYPES)),
    "CameraSnapshot": (1, _MATRIX),
    "ObjectProperty": (2, ("float3", "float4")),
}

#: kinds of vertex data, as ``<inputlayout>`` names them; the last eight are meant for buffers
LAYOUT_VALUES = (
    "Position",
    "Normal",
    "Texcoord",
    "Tangent",
    "Bitangent",
    "Color",
    "BufferFloat",
    "BufferFloat2",
    "BufferFloat3",
    "BufferFloat4",
    "BufferInt",
    "BufferInt2",
    "BufferInt3",
    "BufferInt4",
)

SHAPES = ("Cube", "ScreenQuad", "Circle", "Triangle", "Sphere", "Plane", "ScreenQuadNDC")

Number = float | int | bool
Vector3 = tuple[float, float, float]
Color = tuple[float, float, float, float]


@dataclass(frozen=True)
class Variable:
    """A uniform of a pass. ``value`` is its constant, flat: a matrix column by column, as GLSL has it."""

    name: str
    type: VariableType
    value: tuple[Number, ...]
    system: str | None  # the system value that it has instead, a key of SYSTEM_TYPES
    invert: bool
    line: int
    last_frame: bool = False  # the system value of the frame before
    function: str | None = None  # what computes it instead, a key of FUNCTIONS or NAME_FUNCTIONS
    arguments: tuple[float, ...] | tuple[str, ...] = ()


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
class Blend:
    """How a fragment's colour joins what is there; names as in the .sprj."""

    color_source: str = "Source Alpha"
    color_destination: str = "Inverse Source Alpha"
    color_function: str = "Add"
    alpha_source: str = "Source Alpha"
    alpha_destination: str = "Inverse Source Alpha"
    alpha_function: str = "Add"
    factor: Color = (1.0, 1.0, 1.0, 1.0)


@dataclass(frozen=True)
class StencilSide:
    """The stencil test of front or of back faces; names as in the .sprj."""

    function: str = "Equal"
    fail: str = "Keep"
    depth_fail: str = "Keep"
    passed: str = "Keep"


@dataclass(frozen=True)
class Stencil:
    """The stencil test. The reference is 1, always; what the .sprj calls so is the mask of the comparison."""

    read_mask: int = 0xFF
    write_mask: int = 0
    front: StencilSide = StencilSide()
    back: StencilSide = StencilSide()


@dataclass(frozen=True)
class RenderState:
    """How items are drawn. ``cull`` leaves out the back faces, or the front ones when ``cull_front``; ``ccw`` says
    which faces are front. The default is the state at the start of a pass."""

    cull: bool = True
    cull_front: bool = False
    ccw: bool = True
    depth_clamp: bool = False
    wireframe: bool = False
    depth_test: bool = True
    depth_write: bool = True
    depth_function: str = "Less"
    blend: Blend | None = None
    stencil: Stencil | None = None


@dataclass(frozen=True, kw_only=True)
class Item:
    """Something drawn. ``rotation`` is pitch, yaw and roll in radians: about x, y and z."""

    name: str
    state: RenderState
    position: Vector3
    rotation: Vector3
    scale: Vector3
    line: int
    instances: int | None = None  # None: not instanced
    instance_buffer: str | None = None


@dataclass(frozen=True, kw_only=True)
class Geometry(Item):
    """A built-in shape, one of SHAPES; ``size`` is its width, height and depth, read as each shape does."""

    shape: str
    size: Vector3
    topology: str = "TriangleList"


@dataclass(frozen=True, kw_only=True)
class Model(Item):
    """A model file, relative to the project's folder."""

    path: str


@dataclass(frozen=True, kw_only=True)
class VertexBuffer(Item):
    """The rows of a buffer object as vertices; location k reads field k of the buffer's format."""

    buffer: str
    topology: str = "TriangleList"


@dataclass(frozen=True)
class Pass:
    """A shader pass. Attribute location k reads ``layout[k]``, of LAYOUT_VALUES. ``targets`` are the render textures
    that fragment output k goes to, None for the window."""

    name: str
    vertex: Shader
    fragment: Shader
    layout: tuple[str, ...]
    items: tuple[Geometry | Model | VertexBuffer, ...]
    variables: tuple[Variable, ...]
    item_values: tuple[ItemValue, ...]
    macros: tuple[Macro, ...]
    line: int
    geometry: Shader | None = None
    tess_control: Shader | None = None
    tess_evaluation: Shader | None = None
    patch_vertices: int = 0
    targets: tuple[str | None, ...] = (None,)
    end_state: RenderState = RenderState()  # in which it leaves GL


@dataclass(frozen=True)
class ComputePass:
    """A compute pass, run over ``groups`` (x, y, z) work groups."""

    name: str
    compute: Shader
    groups: tuple[int, int, int]
    variables: tuple[Variable, ...]
    macros: tuple[Macro, ...]
    line: int


@dataclass(frozen=True)
class Bind:
    """An object's place in a pass: the objects of a pass go to its samplers in the order of ``slot``. ``storage``: it
    goes among the images and buffers that a shader can write to, which are counted by themselves."""

    pass_name: str
    slot: int
    line: int
    storage: bool = False


@dataclass(frozen=True, kw_only=True)
class Object:
    """Something that passes can be given. ``name`` is its path where it is a file."""

    name: str
    binds: tuple[Bind, ...]
    line: int


@dataclass(frozen=True, kw_only=True)
class TextureObject(Object):
    """An image file, relative to the project's folder. ``vflip``: v = 0 is its top row, else the bottom. A ``volume``
    is a 3D texture."""

    path: str
    vflip: bool = False
    min_filter: str = "Linear"
    mag_filter: str = "Nearest"
    wrap_s: str = "Repeat"
    wrap_t: str = "Repeat"
    volume: bool = False


@dataclass(frozen=True, kw_only=True)
class CubeMap(Object):
    """Six image files: left right top bottom front back are -x +x +y -y -z +z."""

    faces: tuple[str, ...]  # in GL's order: +x -x +y -y +z -z


@dataclass(frozen=True, kw_only=True)
class KeyboardTexture(Object):
    """256 x 3 pixels that show the keys; all 0 without a keyboard."""


@dataclass(frozen=True, kw_only=True)
class RenderTexture(Object):
    """A texture that passes draw to. ``size`` in pixels, or ``ratio`` of the window; one of them is None."""

    size: tuple[int, int] | None
    ratio: tuple[float, float] | None
    format: str = "RGBA"
    clear: bool = True
    color: Color = (0.0, 0.0, 0.0, 0.0)

    def pixels(self, window: tuple[int, int]) -> tuple[int, int]:
        """Its width and height with a window of that size: cut off, not rounded, in single precision."""
        if self.size is not None:
            return self.size
        width, height = (int(np.float32(r) * np.float32(w)) for r, w in zip(self.ratio, window, strict=True))
        return width, height


@dataclass(frozen=True, kw_only=True)
class Image(Object):
    """A texture that compute passes write to: width, height and, of a 3D one, depth."""

    size: tuple[int, ...]
    format: str


@dataclass(frozen=True, kw_only=True)
class Buffer(Object):
    """``size`` bytes, from the file ``buffers/NAME.buf`` where there is one; ``format`` lists the types of a row."""

    size: int
    format: str

    @property
    def path(self) -> str:
        """The file with its content, relative to the project's folder."""
        return f"buffers/{self.name}.buf"


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
    clear_color: Color
    use_alpha: bool
    include_paths: tuple[str, ...]


#: sampled like textures
Sampled = TextureObject | CubeMap | KeyboardTexture


@dataclass(frozen=True)
class Project:
    """A project: the passes that draw (active, with items) in order, and the objects that they use.

    ``places`` are all items by name, those of inactive passes too: variables may ask where they are. ``cameras`` are
    the snapshots, flat and column by column. ``model_layouts`` are the input layout and the instance buffer that a
    model file has in the whole project.
    """

    file: Path
    passes: tuple[Pass | ComputePass, ...]
    textures: tuple[Sampled, ...]
    settings: Settings
    render_textures: tuple[RenderTexture, ...] = ()
    images: tuple[Image, ...] = ()
    buffers: tuple[Buffer, ...] = ()
    places: Mapping[str, tuple[Vector3, Vector3, Vector3]] = field(default_factory=dict)
    cameras: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    model_layouts: Mapping[str, tuple[tuple[str, ...], str | None]] = field(default_factory=dict)

    def path(self, relative: str) -> Path:
        """A file of the project. As in SHADERed, a leading slash does not lead out of its folder."""
        return Path(f"{self.file.parent}/{relative}")

    @property
    def include_dirs(self) -> list[Path]:
        """Where includes are looked for, in order: the include paths, then the project's folder."""
        return [*(self.file.parent / path for path in self.settings.include_paths), self.file.parent]

    def bound(self, pass_name: str, *, storage: bool = False) -> list[Object]:
        """What a pass is given, in order: by slot, gaps closed; with ``storage`` what it can write to."""
        binds = [(b, o) for o in self.objects for b in o.binds if (b.pass_name, b.storage) == (pass_name, storage)]
        slots = {bind.slot: bound for bind, bound in sorted(binds, key=lambda pair: pair[0].line)}
        return list({slots[slot].name: slots[slot] for slot in sorted(slots)}.values())

    @property
    def objects(self) -> tuple[Object, ...]:
        """All objects."""
        return (*self.textures, *self.render_textures, *self.images, *self.buffers)
