"""Meshes, buffers, textures, targets and draws of harness.h; part of the package's face."""

from __future__ import annotations

import ctypes
import enum
import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from . import _done, _library, _made, gl_enums

_INT, _UINT, _SIZE, _POINTER, _TEXT = ctypes.c_int, ctypes.c_uint32, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_char_p
_I32, _U32, _F32 = ctypes.c_int32, ctypes.c_uint32, ctypes.c_float


class Field(enum.IntEnum):
    """Fields of a vertex, as hn_field."""

    POSITION = 0
    NORMAL = 1
    TEXCOORD = 2
    TANGENT = 3
    BITANGENT = 4
    COLOR = 5

    @property
    def attribute(self) -> Attribute:
        """What an attribute location that reads this field reads."""
        return Attribute(_COMPONENTS[self], offset=4 * sum(_COMPONENTS[:self]))


_COMPONENTS = (3, 3, 2, 3, 3, 4)
#: floats in an hn_vertex
VERTEX_FLOATS = sum(_COMPONENTS)


class Stencil(NamedTuple):
    """One side of the stencil test, as hn_stencil: all by GL's enumerations."""

    function: int = gl_enums.GL_EQUAL
    fail: int = gl_enums.GL_KEEP
    depth_fail: int = gl_enums.GL_KEEP
    passed: int = gl_enums.GL_KEEP


class State(NamedTuple):
    """What a draw does with faces and fragments, as hn_state; the default is that of the start of SHADERed's passes."""

    fill: int = gl_enums.GL_FILL
    cull: int = gl_enums.GL_BACK
    front: int = gl_enums.GL_CCW
    depth_clamp: bool = False
    depth_test: bool = True
    depth_write: bool = True
    depth_function: int = gl_enums.GL_LESS
    blend: bool = False
    blend_functions: tuple[int, int] = (gl_enums.GL_FUNC_ADD, gl_enums.GL_FUNC_ADD)
    blend_factors: tuple[int, int, int, int] = (gl_enums.GL_ONE, gl_enums.GL_ZERO, gl_enums.GL_ONE, gl_enums.GL_ZERO)
    blend_color: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    stencil_test: bool = False
    stencil_reference: int = 0
    stencil_read_mask: int = 0xFFFFFFFF
    stencil_write_mask: int = 0xFFFFFFFF
    stencil_front: Stencil = Stencil()
    stencil_back: Stencil = Stencil()


class _Stencil(ctypes.Structure):
    _fields_ = [("function", _U32), ("fail", _U32), ("depth_fail", _U32), ("passed", _U32)]


class _State(ctypes.Structure):
    _fields_ = [
        ("fill", _U32),
        ("cull", _U32),
        ("front", _U32),
        ("depth_clamp", _I32),
        ("depth_test", _I32),
        ("depth_write", _I32),
        ("depth_function", _U32),
        ("blend", _I32),
        ("blend_functions", _U32 * 2),
        ("blend_factors", _U32 * 4),
        ("blend_color", _F32 * 4),
        ("stencil_test", _I32),
        ("stencil_reference", _I32),
        ("stencil_read_mask", _U32),
        ("stencil_write_mask", _U32),
        ("stencil_front", _Stencil),
        ("stencil_back", _Stencil),
    ]


class Attribute(NamedTuple):
    """What an attribute location reads, as hn_attribute; without a ``buffer``, the vertices of the mesh."""

    components: int
    type: int = gl_enums.GL_FLOAT
    stride: int = 4 * VERTEX_FLOATS
    offset: int = 0
    buffer: Buffer | None = None
    divisor: int = 0


class _Attribute(ctypes.Structure):
    _fields_ = [
        ("buffer", _U32),
        ("type", _U32),
        ("components", _I32),
        ("stride", _I32),
        ("offset", ctypes.c_uint64),
        ("divisor", _U32),
    ]


class _Call(ctypes.Structure):
    _fields_ = [
        ("program", _U32),
        ("mesh", _POINTER),
        ("n_vertices", _I32),
        ("topology", _U32),
        ("attributes", ctypes.POINTER(_Attribute)),
        ("n_attributes", _I32),
        ("instanced", _I32),
        ("instances", _I32),
        ("patch_vertices", _I32),
        ("state", ctypes.POINTER(_State)),
    ]


class Sampling(NamedTuple):
    """How a texture is sampled, as hn_sampling, by GL's enumerations."""

    min_filter: int = gl_enums.GL_LINEAR
    mag_filter: int = gl_enums.GL_LINEAR
    wrap_s: int = gl_enums.GL_REPEAT
    wrap_t: int = gl_enums.GL_REPEAT
    wrap_r: int = gl_enums.GL_REPEAT


class _Sampling(ctypes.Structure):
    _fields_ = [(name, _U32) for name in Sampling._fields]


_SAMPLING = ctypes.POINTER(_Sampling)
_PROTOTYPES = {
    "hn_mesh_load": (_POINTER, [_TEXT]),
    "hn_mesh_create": (_POINTER, [_POINTER, _SIZE, _POINTER, _SIZE]),
    "hn_mesh_delete": (None, [_POINTER]),
    "hn_mesh_stray_faces": (_SIZE, [_POINTER]),
    "hn_buffer_create": (_UINT, [_SIZE, _POINTER]),
    "hn_buffer_delete": (None, [_UINT]),
    "hn_buffer_bind": (_INT, [_INT, _UINT]),
    "hn_buffer_read": (_INT, [_UINT, _SIZE, _POINTER]),
    "hn_dispatch": (_INT, [_UINT, _UINT, _UINT, _UINT]),
    "hn_texture_create": (_UINT, [_INT, _INT, _INT, _POINTER, _SAMPLING]),
    "hn_texture_create_as": (_UINT, [_U32, _INT, _INT, _POINTER, _SAMPLING]),
    "hn_texture_create_cube": (_UINT, [_INT, _INT, _POINTER, _SAMPLING]),
    "hn_texture_create_empty": (_UINT, [_INT, _INT, _INT, _UINT, _SAMPLING]),
    "hn_texture_delete": (None, [_UINT]),
    "hn_texture_bind": (_INT, [_INT, _UINT, _UINT]),
    "hn_image_bind": (_INT, [_INT, _UINT, _UINT, _INT]),
    "hn_texture_read": (_INT, [_UINT, _UINT, _POINTER]),
    "hn_target_create": (_POINTER, [_INT, _INT, _UINT]),
    "hn_target_join": (_POINTER, [ctypes.POINTER(_POINTER), _INT, _INT, _INT]),
    "hn_target_delete": (None, [_POINTER]),
    "hn_target_texture": (_UINT, [_POINTER]),
    "hn_target_clear_color": (_INT, [_POINTER, _INT, _POINTER]),
    "hn_target_clear_depth": (_INT, [_POINTER, _INT]),
    "hn_target_read_bytes": (_INT, [_POINTER, _POINTER]),
    "hn_target_read_floats": (_INT, [_POINTER, _POINTER]),
    "hn_draw": (_INT, [_POINTER, ctypes.POINTER(_Call)]),
}
for _name, (_result, _arguments) in _PROTOTYPES.items():
    _function = getattr(_library, _name)
    _function.restype, _function.argtypes = _result, _arguments


class Mesh:
    """Vertices and indices on the GL side. Use ``load`` or ``create``."""

    def __init__(self, handle: int):
        self._handle = handle

    @classmethod
    def load(cls, path: str | Path) -> Mesh:
        """All meshes of a model file, read as SHADERed reads them."""
        return cls(_made(_library.hn_mesh_load(os.fsencode(path))))

    @classmethod
    def create(cls, vertices: np.ndarray, indices: np.ndarray | None = None) -> Mesh:
        """A mesh from ``vertices`` (n, 18), fields in the order of Field, and ``indices`` (m,) or none."""
        vertices = np.ascontiguousarray(vertices, np.float32)
        if vertices.ndim != 2 or vertices.shape[1] != VERTEX_FLOATS:
            raise ValueError(f"vertices of shape {vertices.shape}, not (n, {VERTEX_FLOATS})")
        if indices is None:
            return cls(_made(_library.hn_mesh_create(vertices.ctypes.data, len(vertices), None, 0)))
        indices = np.ascontiguousarray(indices, np.uint32)
        return cls(
            _made(_library.hn_mesh_create(vertices.ctypes.data, len(vertices), indices.ctypes.data, indices.size))
        )

    @property
    def stray_faces(self) -> int:
        """How many faces of the file are no triangles."""
        return _library.hn_mesh_stray_faces(self._handle)

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.hn_mesh_delete(self._handle)


class Buffer:
    """Bytes on the GL side, for vertices and storage blocks."""

    def __init__(self, data: bytes):
        self.size = len(data)
        self._name = _made(_library.hn_buffer_create(len(data), data))

    def bind(self, binding: int) -> None:
        """Makes it the shader storage buffer of ``binding``."""
        _done(_library.hn_buffer_bind(binding, self._name))

    def read(self) -> bytes:
        """What it holds now."""
        data = ctypes.create_string_buffer(self.size)
        _done(_library.hn_buffer_read(self._name, self.size, data))
        return data.raw

    def __del__(self):
        if getattr(self, "_name", 0):
            _library.hn_buffer_delete(self._name)


def dispatch(program, groups: Sequence[int]) -> None:
    """Runs a compute program over (x, y, z) ``groups``."""
    _done(_library.hn_dispatch(program._name, *groups))


#: GL's formats -> numpy's types of their numbers
_TEXELS = {
    gl_enums.GL_RGBA8: np.uint8,
    gl_enums.GL_RGBA32F: np.float32,
    gl_enums.GL_RGBA32I: np.int32,
    gl_enums.GL_RGBA32UI: np.uint32,
}


class Texture:
    """A texture of any kind; ``target`` is GL's: GL_TEXTURE_2D, GL_TEXTURE_3D or GL_TEXTURE_CUBE_MAP."""

    def __init__(self, name: int, target: int, shape: tuple[int, ...]):
        self._name, self.target = _made(name), target
        #: height and width, before them the depth of a 3D texture
        self.shape = shape

    @classmethod
    def create(cls, pixels: np.ndarray, sampling: Sampling) -> Texture:
        """8-bit RGBA with mipmaps; ``pixels`` (h, w, 4) or (d, h, w, 4) uint8 with row 0 at v = 0."""
        pixels = _rgba(pixels, (3, 4))
        *depth, height, width, _ = pixels.shape
        name = _library.hn_texture_create(width, height, *(depth or [0]), pixels.ctypes.data, _Sampling(*sampling))
        return cls(name, gl_enums.GL_TEXTURE_3D if depth else gl_enums.GL_TEXTURE_2D, pixels.shape[:-1])

    @classmethod
    def of_format(cls, texels: np.ndarray, gl_format: int, sampling: Sampling) -> Texture:
        """RGBA of a format of _TEXELS with mipmaps, integers without; ``texels`` (h, w, 4) with row 0 at v = 0."""
        texels = np.ascontiguousarray(texels, _TEXELS[gl_format])
        height, width, channels = texels.shape
        if channels != 4:
            raise ValueError(f"texels of shape {texels.shape}, not (h, w, 4)")
        name = _library.hn_texture_create_as(gl_format, width, height, texels.ctypes.data, _Sampling(*sampling))
        return cls(name, gl_enums.GL_TEXTURE_2D, (height, width))

    @classmethod
    def cube(cls, faces: np.ndarray, sampling: Sampling) -> Texture:
        """A cube map without mipmaps; ``faces`` (6, h, w, 4) uint8: +x -x +y -y +z -z, top row first."""
        faces = _rgba(faces, (4,))
        _, height, width, _ = faces.shape
        name = _library.hn_texture_create_cube(width, height, faces.ctypes.data, _Sampling(*sampling))
        return cls(name, gl_enums.GL_TEXTURE_CUBE_MAP, (height, width))

    @classmethod
    def empty(cls, shape: tuple[int, ...], gl_format: int, sampling: Sampling) -> Texture:
        """Zeros of an internal format; ``shape`` is (h, w) or (d, h, w)."""
        *depth, height, width = shape
        name = _library.hn_texture_create_empty(width, height, *(depth or [0]), gl_format, _Sampling(*sampling))
        return cls(name, gl_enums.GL_TEXTURE_3D if depth else gl_enums.GL_TEXTURE_2D, shape)

    def bind(self, unit: int) -> None:
        """Makes it the texture of ``unit``."""
        bind_texture(unit, self.target, self._name)

    def read(self) -> np.ndarray:
        """(h, w, 4) or (d, h, w, 4) float32, row 0 at v = 0."""
        pixels = np.empty((*self.shape, 4), np.float32)
        _done(_library.hn_texture_read(self.target, self._name, pixels.ctypes.data))
        return pixels

    def __del__(self):
        if getattr(self, "_name", 0):
            _library.hn_texture_delete(self._name)


def _rgba(pixels: np.ndarray, dimensions: tuple[int, ...]) -> np.ndarray:
    pixels = np.ascontiguousarray(pixels, np.uint8)
    if pixels.ndim not in dimensions or pixels.shape[-1] != 4:
        raise ValueError(f"pixels of shape {pixels.shape}, not (..., h, w, 4)")
    return pixels


def bind_texture(unit: int, target: int, name: int) -> None:
    """Makes the texture called ``name`` that of ``unit``, 0 for none."""
    _done(_library.hn_texture_bind(unit, target, name))


def bind_image(unit: int, texture: Texture, gl_format: int) -> None:
    """Binds a texture to an image unit, all its layers, to be read and written as of that format."""
    layered = int(texture.target == gl_enums.GL_TEXTURE_3D)
    _done(_library.hn_image_bind(unit, texture._name, gl_format, layered))


class Call(NamedTuple):
    """One draw, as hn_call."""

    program: object
    attributes: Sequence[Attribute]
    mesh: Mesh | None = None
    n_vertices: int = 0
    topology: int = gl_enums.GL_TRIANGLES
    instances: int | None = None  # None: not instanced
    patch_vertices: int = 0
    state: State = State()


class Target:
    """What is drawn to: a colour texture of an internal format, with depth and stencil of its own."""

    def __init__(self, width: int, height: int, gl_format: int):
        self.width, self.height = width, height
        self._joined: tuple[Target, ...] = ()
        self._handle = _made(_library.hn_target_create(width, height, gl_format))

    @classmethod
    def join(cls, targets: Sequence[Target], width: int, height: int) -> Target:
        """Several as one: fragment output i goes to target i; depth and stencil are those of the last."""
        joined = cls.__new__(cls)
        joined.width, joined.height, joined._joined = width, height, tuple(targets)
        handles = (_POINTER * len(targets))(*(t._handle for t in targets))
        joined._handle = _made(_library.hn_target_join(handles, len(targets), width, height))
        return joined

    def bind(self, unit: int) -> None:
        """Makes its colour the texture of ``unit``."""
        bind_texture(unit, gl_enums.GL_TEXTURE_2D, _library.hn_target_texture(self._handle))

    def clear_color(self, index: int, rgba: Sequence[float]) -> None:
        """Sets the colour of the target, or of the one of that index of joined ones."""
        color = np.asarray(rgba, np.float32)
        _done(_library.hn_target_clear_color(self._handle, index, color.ctypes.data))

    def clear_depth(self, write_depth: bool = True) -> None:
        """Sets the stencil to 0 and, with ``write_depth``, the depth to the farthest."""
        _done(_library.hn_target_clear_depth(self._handle, int(write_depth)))

    def draw(self, call: Call) -> None:
        """Draws. NativeError also where GL itself refuses the combination of stages and topology."""
        _done(_library.hn_draw(self._handle, _prepared(call)))

    def read_bytes(self) -> np.ndarray:
        """(h, w, 4) uint8, bottom row first: clamped to 0...1 and rounded by GL."""
        pixels = np.empty((self.height, self.width, 4), np.uint8)
        _done(_library.hn_target_read_bytes(self._handle, pixels.ctypes.data))
        return pixels

    def read_floats(self) -> np.ndarray:
        """(h, w, 4) float32, bottom row first: as drawn."""
        pixels = np.empty((self.height, self.width, 4), np.float32)
        _done(_library.hn_target_read_floats(self._handle, pixels.ctypes.data))
        return pixels

    def read_texels(self) -> np.ndarray:
        """(h, w, 4) float32, bottom row first: as a shader samples it."""
        pixels = np.empty((self.height, self.width, 4), np.float32)
        texture = _library.hn_target_texture(self._handle)
        _done(_library.hn_texture_read(gl_enums.GL_TEXTURE_2D, texture, pixels.ctypes.data))
        return pixels

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.hn_target_delete(self._handle)


def _prepared(call: Call) -> _Call:
    attributes = (_Attribute * len(call.attributes))(
        *(
            _Attribute(a.buffer._name if a.buffer else 0, a.type, a.components, a.stride, a.offset, a.divisor)
            for a in call.attributes
        )
    )
    *plain, functions, factors, color = call.state[:11]
    state = _State(
        *plain,
        (_U32 * 2)(*functions),
        (_U32 * 4)(*factors),
        (_F32 * 4)(*color),
        *call.state[11:15],
        _Stencil(*call.state.stencil_front),
        _Stencil(*call.state.stencil_back),
    )
    return _Call(
        call.program._name,
        call.mesh._handle if call.mesh else None,
        call.n_vertices,
        call.topology,
        attributes,
        len(attributes),
        int(call.instances is not None),
        call.instances or 0,
        call.patch_vertices,
        ctypes.pointer(state),
    )
