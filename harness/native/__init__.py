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
    GEOMETRY = 2
    TESS_CONTROL = 3
    TESS_EVALUATION = 4
    COMPUTE = 5


class Variable(NamedTuple):
    """An active uniform or attribute: ``type`` is GL's enumeration, ``size`` the length of an array."""

    type: int
    size: int
    location: int


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
    "hn_context_integers": (_INT, [_UINT, _INT, ctypes.POINTER(ctypes.c_int32)]),
    "hn_context_precision": (
        _INT,
        [_UINT, _UINT, ctypes.POINTER(ctypes.c_int32), ctypes.POINTER(ctypes.c_int32)],
    ),
    "hn_glsl_check": (_INT, [_INT, _TEXT, _INT]),
    "hn_glsl_preprocess": (_POINTER, [_INT, _TEXT]),
    "hn_glsl_tree": (_POINTER, [_INT, _TEXT]),
    "hn_glsl_spirv": (_INT, [_INT, _TEXT, ctypes.POINTER(_POINTER), ctypes.POINTER(_SIZE)]),
    "hn_glsl_version": (_TEXT, []),
    "hn_glsl_spirv_vulkan": (_INT, [_INT, _TEXT, ctypes.POINTER(_POINTER), ctypes.POINTER(_SIZE)]),
    "hn_program_create": (_UINT, [_TEXT, _TEXT]),
    "hn_program_create_stages": (_UINT, [ctypes.POINTER(_TEXT)]),
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
}


#: kind of a numpy type -> type of a texel's numbers
_BASES = {"f": gl_enums.GL_FLOAT, "i": gl_enums.GL_INT, "u": gl_enums.GL_UNSIGNED_INT}


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


def context_is_open() -> bool:
    """Whether the process has its context: then it must not be forked, for a child would wait for threads it lacks."""
    return _library.hn_context_info() is not None


def context_info() -> dict[str, str]:
    """What draws: ``renderer``, ``version``, ``glsl`` and ``backend`` of the open context."""
    text = _library.hn_context_info()
    if text is None:
        raise _error()
    return dict(zip(("renderer", "version", "glsl", "backend"), text.decode().split("\n"), strict=True))


def context_integers(name: int, count: int = 1) -> tuple[int, ...]:
    """GL's limit of that name, such as GL_MAX_TEXTURE_SIZE: ``count`` numbers. NativeError where GL knows it not."""
    values = (ctypes.c_int32 * count)()
    _done(_library.hn_context_integers(name, count, values))
    return tuple(values)


def context_precision(stage: int, precision: int) -> tuple[int, int, int]:
    """Binary logarithms of the smallest and largest magnitude, and bits, of GL_HIGH_FLOAT and the like in a stage.

    NativeError where the driver does not say.
    """
    exponents, bits = (ctypes.c_int32 * 2)(), ctypes.c_int32()
    _done(_library.hn_context_precision(stage, precision, exponents, ctypes.byref(bits)))
    return exponents[0], exponents[1], bits.value


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
    def of_stages(cls, texts: Mapping[Stage, str]) -> Program:
        """A program of these stages, to draw with or, of a compute stage alone, to dispatch."""
        program = cls.__new__(cls)
        listed = (ctypes.c_char_p * len(Stage))(*(texts[s].encode() if s in texts else None for s in Stage))
        program._take(_library.hn_program_create_stages(listed), compute=False)
        return program

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


from .drawing import (  # noqa: E402, I001 (it needs what is above)
    Attribute as Attribute,
    Buffer as Buffer,
    Call as Call,
    Field as Field,
    Mesh as Mesh,
    Sampling as Sampling,
    State as State,
    Stencil as Stencil,
    Target as Target,
    Texture as Texture,
    bind_image as bind_image,
    bind_texture as bind_texture,
    dispatch as dispatch,
)
