"""The Python face of the native library: harness.h through ctypes, with numpy arrays and exceptions.

Nothing is decided here: each class or function is one of harness.h's, and what that file says holds.
"""

from __future__ import annotations

import ctypes
import enum
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import NativeError
from . import gl_enums

BACKENDS = ("osmesa", "egl", "glfw")
BACKEND_VARIABLE = "HARNESS_BACKEND"  # which of them, where the caller does not choose
LIBRARY_VARIABLE = "HARNESS_NATIVE_LIB"  # names another build of the library, e.g. with sanitizers


class Stage(enum.IntEnum):
    """Shader stages, as hn_stage."""

    VERTEX = 0
    FRAGMENT = 1


class Field(enum.IntEnum):
    """Fields of a vertex, as hn_field."""

    POSITION = 0
    NORMAL = 1
    TEXCOORD = 2
    TANGENT = 3
    BITANGENT = 4
    COLOR = 5


class Variable(NamedTuple):
    """An active uniform or attribute: ``type`` is GL's enumeration, ``size`` the length of an array."""

    type: int
    size: int
    location: int


class State(NamedTuple):
    """What a draw does with the faces that it meets, as hn_state; ``cull`` and ``front`` are GL's enumerations."""

    cull: int = gl_enums.GL_BACK
    front: int = gl_enums.GL_CCW
    depth_clamp: bool = False


START_OF_PASS = State()


class _Variable(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char * 256),
        ("type", ctypes.c_uint32),
        ("size", ctypes.c_int32),
        ("location", ctypes.c_int32),
    ]


class _Input(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("data", ctypes.c_void_p),
        ("base", ctypes.c_uint32),
        ("components", ctypes.c_uint32),
        ("count", ctypes.c_size_t),
    ]


class _Output(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("components", ctypes.c_uint32)]


class _State(ctypes.Structure):
    _fields_ = [("cull", ctypes.c_uint32), ("front", ctypes.c_uint32), ("depth_clamp", ctypes.c_int)]


#: floats in an hn_vertex: position 3, normal 3, texcoord 2, tangent 3, bitangent 3, colour 4
VERTEX_FLOATS = 18

_INT, _UINT, _SIZE = ctypes.c_int, ctypes.c_uint32, ctypes.c_size_t
_POINTER, _TEXT = ctypes.c_void_p, ctypes.c_char_p
_VARIABLES = ctypes.POINTER(_Variable)

#: function of harness.h -> (result, arguments). A `char *` that is the caller's comes as _POINTER, to be freed.
_PROTOTYPES = {
    "hn_error": (_TEXT, []),
    "hn_free": (None, [_POINTER]),
    "hn_context_choose": (_INT, [_TEXT]),
    "hn_context_open": (_INT, []),
    "hn_context_close": (None, []),
    "hn_context_info": (_TEXT, []),
    "hn_context_take_error": (_INT, []),
    "hn_glsl_check": (_INT, [_INT, _TEXT, _INT]),
    "hn_glsl_preprocess": (_POINTER, [_INT, _TEXT]),
    "hn_glsl_tree": (_POINTER, [_INT, _TEXT]),
    "hn_glsl_spirv": (_INT, [_INT, _TEXT, ctypes.POINTER(_POINTER), ctypes.POINTER(_SIZE)]),
    "hn_glsl_version": (_TEXT, []),
    "hn_glsl_spirv_vulkan": (_INT, [_INT, _TEXT, ctypes.POINTER(_POINTER), ctypes.POINTER(_SIZE)]),
    "hn_program_create": (_UINT, [_TEXT, _TEXT]),
    "hn_program_delete": (None, [_UINT]),
    "hn_program_uniforms": (_INT, [_UINT, _VARIABLES, _INT]),
    "hn_program_attributes": (_INT, [_UINT, _VARIABLES, _INT]),
    "hn_program_uniform": (_INT, [_UINT, ctypes.c_int32, _UINT, ctypes.c_int32, _POINTER]),
    "hn_program_uniform_read": (_INT, [_UINT, ctypes.c_int32, _UINT, _INT, _POINTER]),
    "hn_evaluate": (_INT, [_UINT, ctypes.POINTER(_Input), _INT, ctypes.POINTER(_Output), _INT, _SIZE]),
    "hn_program_create_compute": (_UINT, [_TEXT]),
    "hn_compute": (_INT, [_UINT, ctypes.POINTER(_Input), _INT, ctypes.POINTER(_Output), _INT, _SIZE, _UINT]),
    "hn_compute_available": (_INT, []),
    "hn_compute_head": (_TEXT, []),
    "hn_compute_limit": (_SIZE, [_UINT]),
    "hn_evaluate_vertex": (_TEXT, []),
    "hn_evaluate_limit": (_SIZE, []),
    "hn_mesh_load": (_POINTER, [_TEXT]),
    "hn_mesh_create": (_POINTER, [_POINTER, _SIZE, _POINTER, _SIZE]),
    "hn_mesh_delete": (None, [_POINTER]),
    "hn_texture_create": (_UINT, [_INT, _INT, _POINTER, _UINT, _UINT, _UINT, _UINT]),
    "hn_texture_create_as": (_UINT, [_UINT, _INT, _INT, _POINTER, _UINT, _UINT, _UINT, _UINT]),
    "hn_texture_delete": (None, [_UINT]),
    "hn_texture_bind": (_INT, [_INT, _UINT]),
    "hn_target_create": (_POINTER, [_INT, _INT, _INT]),
    "hn_target_delete": (None, [_POINTER]),
    "hn_target_clear": (_INT, [_POINTER, _POINTER]),
    "hn_draw": (_INT, [_POINTER, _UINT, _POINTER, ctypes.POINTER(_INT), _INT, ctypes.POINTER(_State)]),
    "hn_target_read_bytes": (_INT, [_POINTER, _POINTER]),
    "hn_target_read_floats": (_INT, [_POINTER, _POINTER]),
}


#: kind of a numpy type -> type of a texel's numbers
_BASES = {"f": gl_enums.GL_FLOAT, "i": gl_enums.GL_INT, "u": gl_enums.GL_UNSIGNED_INT}


#: format of a texture -> numpy's type of its numbers
_TEXELS = {
    gl_enums.GL_RGBA8: np.uint8,
    gl_enums.GL_RGBA32F: np.float32,
    gl_enums.GL_RGBA32I: np.int32,
    gl_enums.GL_RGBA32UI: np.uint32,
}


def _load() -> ctypes.CDLL:
    # An editable installation keeps what it built in a second folder of this package.
    built = (Path(folder, "libharness.so") for folder in __path__)
    path = os.environ.get(LIBRARY_VARIABLE) or next((p for p in built if p.is_file()), "libharness.so")
    try:
        library = ctypes.CDLL(os.fspath(path))
    except OSError as error:
        raise NativeError(f"the native library does not load ({error}); build it with: make build") from error
    for name, (result, arguments) in _PROTOTYPES.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


_library = _load()


def _error() -> NativeError:
    return NativeError(_library.hn_error().decode(errors="replace"))


def _done(status: int) -> int:
    if status < 0:
        raise _error()
    return status


def _made(handle: int | None) -> int:
    if not handle:
        raise _error()
    return handle


def _address(array: np.ndarray) -> int:
    """Where an array lies; several times faster than ``array.ctypes.data``, which shows in small batches."""
    return array.__array_interface__["data"][0]


def _take_text(pointer: int | None) -> str:
    text = ctypes.string_at(_made(pointer)).decode(errors="replace")
    _library.hn_free(pointer)
    return text


def choose_backend(name: str) -> None:
    """Says which library makes the context, one of BACKENDS, before the first use.

    Processes started from here use it too. NativeError when there is no such backend, or this process has drawn with
    another.
    """
    _done(_library.hn_context_choose(name.encode()))
    os.environ[BACKEND_VARIABLE] = name


def open_context() -> None:
    """Opens the process's one context; does nothing when it is open."""
    if name := os.environ.get(BACKEND_VARIABLE):
        _done(_library.hn_context_choose(name.encode()))
    _done(_library.hn_context_open())


def context_info() -> dict[str, str]:
    """What draws: ``renderer``, ``version``, ``glsl`` and ``backend`` of the open context."""
    text = _library.hn_context_info()
    if text is None:
        raise _error()
    return dict(zip(("renderer", "version", "glsl", "backend"), text.decode().split("\n"), strict=True))


def take_error() -> str | None:
    """The errors of GL that no operation has reported yet, which are forgotten by this."""
    return None if _library.hn_context_take_error() == 0 else str(_error())


def glslang_version() -> str:
    """glslang's, as "12.0.0"."""
    return _library.hn_glsl_version().decode()


def glsl_check(stage: Stage, text: str, *, spirv: bool) -> None:
    """Raises NativeError with glslang's lines when the stage does not compile."""
    _done(_library.hn_glsl_check(stage, text.encode(), int(spirv)))


def glsl_preprocess(stage: Stage, text: str) -> str:
    """The text after the preprocessor, with the same line numbers."""
    return _take_text(_library.hn_glsl_preprocess(stage, text.encode()))


def glsl_tree(stage: Stage, text: str) -> str:
    """glslang's dump of the syntax tree, uncalled functions included."""
    return _take_text(_library.hn_glsl_tree(stage, text.encode()))


def glsl_spirv(stage: Stage, text: str) -> np.ndarray:
    """A stage with a main() as SPIR-V, uint32 words: what main() reaches, not optimised, with names and lines."""
    return _spirv(_library.hn_glsl_spirv, stage, text)


def glsl_spirv_vulkan(stage: Stage, text: str) -> np.ndarray:
    """The same for Vulkan, without lines."""
    return _spirv(_library.hn_glsl_spirv_vulkan, stage, text)


def _spirv(function: Callable, stage: Stage, text: str) -> np.ndarray:
    words, count = _POINTER(), _SIZE()
    _done(function(stage, text.encode(), ctypes.byref(words), ctypes.byref(count)))
    copied = np.frombuffer(ctypes.string_at(words, 4 * count.value), np.uint32)
    _library.hn_free(words)
    return copied


def evaluate_vertex() -> str:
    """The vertex stage that ``evaluate`` wants."""
    return _library.hn_evaluate_vertex().decode()


def evaluate_limit() -> int:
    """The most texels an input of ``evaluate`` may have."""
    return _library.hn_evaluate_limit()


def compute_available() -> bool:
    """Whether the open context has compute stages."""
    return bool(_library.hn_compute_available())


def compute_head() -> str:
    """What a compute stage for ``Program.evaluate`` begins with, after its #version."""
    return _library.hn_compute_head().decode()


def compute_limit(components: int) -> int:
    """The most elements of so many components that a compute program can be evaluated for at once."""
    return _library.hn_compute_limit(components)


class Program:
    """A linked program of a vertex and a fragment stage, or by ``compute`` of a compute stage.

    NativeError on failure: ``vertex: LOG``, ``fragment: LOG``, ``compute: LOG`` or ``link: LOG``.
    """

    def __init__(self, vertex: str, fragment: str):
        self._take(_library.hn_program_create(vertex.encode(), fragment.encode()), compute=False)

    @classmethod
    def compute(cls, text: str) -> Program:
        """A program of one compute stage."""
        program = cls.__new__(cls)
        program._take(_library.hn_program_create_compute(text.encode()), compute=True)
        return program

    def _take(self, name: int, *, compute: bool) -> None:
        self._name = _made(name)
        self._is_compute = compute
        self._evaluate = _library.hn_compute if compute else _library.hn_evaluate
        self.uniforms = self._variables(_library.hn_program_uniforms)
        self.attributes = self._variables(_library.hn_program_attributes)

    def _variables(self, query) -> dict[str, Variable]:
        count = _done(query(self._name, None, 0))
        found = (_Variable * count)()
        _done(query(self._name, found, count))
        return {v.name.decode(): Variable(v.type, v.size, v.location) for v in found}

    def set_uniform(self, name: str, gl_type: int, values: np.ndarray) -> None:
        """Sets the uniform ``name`` of GL type ``gl_type``; 4-byte values, matrices column by column.

        Of an array uniform as many elements are set as there are values for.
        """
        values = np.ascontiguousarray(values)
        variable = self.uniforms[name]
        count = values.size // gl_enums.COMPONENTS.get(gl_type, 1)
        _done(_library.hn_program_uniform(self._name, variable.location, gl_type, count, values.ctypes.data))

    def uniform(self, name: str, count: int = 1) -> np.ndarray:
        """The values of the first ``count`` elements of a numeric uniform, (count, components), matrices by columns.

        float32, or int32 for all types that are no floats.
        """
        variable = self.uniforms[name]
        is_float = gl_enums.GLSL_TYPE_NAMES[variable.type].startswith(("float", "vec", "mat"))
        values = np.empty((count, gl_enums.COMPONENTS.get(variable.type, 1)), np.float32 if is_float else np.int32)
        for k, value in enumerate(values):
            where, size = variable.location + k, value.size
            _done(_library.hn_program_uniform_read(self._name, where, variable.type, size, _address(value)))
        return values

    def evaluate(
        self, inputs: Mapping[str, np.ndarray], outputs: Sequence[np.ndarray], count: int, each: int = 1
    ) -> None:
        """Runs the fragment or compute stage for ``count`` elements; an invocation of a compute stage does ``each``.

        ``inputs`` maps the name of a buffer sampler to a C-contiguous array (texels, components) of float32, int32 or
        uint32; ``outputs`` are C-contiguous float32 arrays (count, components), filled in place.
        """
        extra = (each,) if self._is_compute else ()
        ins = (_Input * len(inputs))(
            *(
                (name.encode(), _address(array), _BASES[array.dtype.kind], array.shape[1], array.shape[0])
                for name, array in inputs.items()
            )
        )
        outs = (_Output * len(outputs))(*((_address(array), array.shape[1]) for array in outputs))
        _done(self._evaluate(self._name, ins, len(ins), outs, len(outs), count, *extra))

    def __del__(self):
        if getattr(self, "_name", 0):
            _library.hn_program_delete(self._name)


class Mesh:
    """Vertices and triangles on the GL side. Use ``load`` or ``create``."""

    def __init__(self, handle: int):
        self._handle = handle

    @classmethod
    def load(cls, path: str | Path) -> Mesh:
        """All meshes of a model file, read as SHADERed reads them."""
        return cls(_made(_library.hn_mesh_load(os.fsencode(path))))

    @classmethod
    def create(cls, vertices: np.ndarray, indices: np.ndarray | None = None) -> Mesh:
        """A mesh from ``vertices`` (n, 18), fields in the order of Field, and triangle ``indices`` (m,) or none."""
        vertices = np.ascontiguousarray(vertices, np.float32)
        if vertices.ndim != 2 or vertices.shape[1] != VERTEX_FLOATS:
            raise ValueError(f"vertices of shape {vertices.shape}, not (n, {VERTEX_FLOATS})")
        if indices is None:
            return cls(_made(_library.hn_mesh_create(vertices.ctypes.data, len(vertices), None, 0)))
        indices = np.ascontiguousarray(indices, np.uint32)
        return cls(
            _made(_library.hn_mesh_create(vertices.ctypes.data, len(vertices), indices.ctypes.data, indices.size))
        )

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.hn_mesh_delete(self._handle)


class Texture:
    """A texture; ``texels`` (h, w, 4) with row 0 at v = 0, filters and wraps GL's.

    ``texel_format`` is GL's: GL_RGBA8 takes uint8, GL_RGBA32F float32, GL_RGBA32I and GL_RGBA32UI
    int32 and uint32.
    """

    def __init__(
        self,
        texels: np.ndarray,
        min_filter: int,
        mag_filter: int,
        wrap_s: int,
        wrap_t: int,
        texel_format: int = gl_enums.GL_RGBA8,
    ):
        texels = np.ascontiguousarray(texels, _TEXELS[texel_format])
        height, width, channels = texels.shape
        if channels != 4:
            raise ValueError(f"texels of shape {texels.shape}, not (h, w, 4)")
        self._name = _made(
            _library.hn_texture_create_as(
                texel_format, width, height, texels.ctypes.data, min_filter, mag_filter, wrap_s, wrap_t
            )
        )

    def bind(self, unit: int) -> None:
        """Makes it the texture of ``unit``."""
        _done(_library.hn_texture_bind(unit, self._name))

    def __del__(self):
        if getattr(self, "_name", 0):
            _library.hn_texture_delete(self._name)


class Target:
    """A framebuffer as SHADERed's window: 32-bit float colour, 24-bit depth."""

    def __init__(self, width: int, height: int, alpha: bool):
        self.width, self.height = width, height
        self._handle = _made(_library.hn_target_create(width, height, int(alpha)))

    def clear(self, rgba: Sequence[float]) -> None:
        """Sets colour, and depth to 1."""
        color = np.asarray(rgba, np.float32)
        _done(_library.hn_target_clear(self._handle, color.ctypes.data))

    def draw(self, program: Program, mesh: Mesh, fields: Sequence[Field], state: State = START_OF_PASS) -> None:
        """Draws a mesh; attribute location k reads ``fields[k]``."""
        layout = (ctypes.c_int * len(fields))(*fields)
        _done(_library.hn_draw(self._handle, program._name, mesh._handle, layout, len(layout), _State(*state)))

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

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.hn_target_delete(self._handle)
