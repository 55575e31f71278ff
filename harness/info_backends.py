"""What each backend can do here: driver, limits and precision, asked in a process of its own.

Limits and precisions are what the driver says of itself; how it rounds and whether it contracts is measured, by calls
whose exact results differ by it.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import native
from .errors import HarnessError
from .native import gl_enums as gl
from .processes.process import Process, reply, result_of
from .processes.worker import MEMORY_BYTES

if TYPE_CHECKING:
    from .calling.call import Shader
    from .calling.function import Function

SECONDS = 60.0

#: what is shown -> GL's name for it, and how many numbers it is
_LIMITS = {
    "texture side": (gl.GL_MAX_TEXTURE_SIZE, 1),
    "3D texture side": (gl.GL_MAX_3D_TEXTURE_SIZE, 1),
    "cube map side": (gl.GL_MAX_CUBE_MAP_TEXTURE_SIZE, 1),
    "array layers": (gl.GL_MAX_ARRAY_TEXTURE_LAYERS, 1),
    "buffer texels": (gl.GL_MAX_TEXTURE_BUFFER_SIZE, 1),
    "viewport": (gl.GL_MAX_VIEWPORT_DIMS, 2),
    "render buffer side": (gl.GL_MAX_RENDERBUFFER_SIZE, 1),
    "colour attachments": (gl.GL_MAX_COLOR_ATTACHMENTS, 1),
    "draw buffers": (gl.GL_MAX_DRAW_BUFFERS, 1),
    "dual source buffers": (gl.GL_MAX_DUAL_SOURCE_DRAW_BUFFERS, 1),
    "samples (MSAA)": (gl.GL_MAX_SAMPLES, 1),
    "vertex attributes": (gl.GL_MAX_VERTEX_ATTRIBS, 1),
    "varyings, floats": (gl.GL_MAX_VARYING_COMPONENTS, 1),
    "vertex uniforms, floats": (gl.GL_MAX_VERTEX_UNIFORM_COMPONENTS, 1),
    "fragment uniforms, floats": (gl.GL_MAX_FRAGMENT_UNIFORM_COMPONENTS, 1),
    "vertex samplers": (gl.GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS, 1),
    "fragment samplers": (gl.GL_MAX_TEXTURE_IMAGE_UNITS, 1),
    "samplers in all": (gl.GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, 1),
}
_PRECISIONS = {
    "highp float": gl.GL_HIGH_FLOAT,
    "mediump float": gl.GL_MEDIUM_FLOAT,
    "lowp float": gl.GL_LOW_FLOAT,
    "highp int": gl.GL_HIGH_INT,
    "mediump int": gl.GL_MEDIUM_INT,
    "lowp int": gl.GL_LOW_INT,
}

_PROBES = """#version 400
float id(float x) { return x; }
float half_of(float x) { return x * 0.5; }
float sum(float a, float b) { return a + b; }
float product_sum(float a, float b, float c) { return a * b + c; }
float fused(float a, float b, float c) { return fma(a, b, c); }
"""
#: a file with a derivative is evaluated by a fragment stage, others where they can be by a compute stage
_DRAWN = "#version 400\nfloat half_of(float x) { return x * 0.5 + dFdx(x); }\n"
_ULP = 2.0**-23  # of 1


@dataclass(frozen=True)
class Backend:
    """A backend: what to show of it, by name, in order; or why it does not work here."""

    name: str
    facts: dict[str, str]
    trouble: str | None = None


def backends() -> list[Backend]:
    """All of native.BACKENDS. One that does not work, crashes or hangs costs none of the others."""
    return [backend(name) for name in native.BACKENDS]


def backend(name: str) -> Backend:
    """One backend."""
    process = Process(_serve, name, memory_bytes=MEMORY_BYTES)
    try:
        if not process.connection.poll(SECONDS):
            return Backend(name, {}, f"does not answer within {SECONDS:g} s")
        return Backend(name, result_of(process.connection.recv_bytes()))
    except HarnessError as error:
        return Backend(name, {}, error.message)
    except (EOFError, OSError):
        return Backend(name, {}, f"its process died ({process.end(1.0)})")
    finally:
        process.end()


def _serve(connection: Connection, name: str) -> None:
    with open(os.devnull, "wb") as nowhere:  # where libraries of windows print what the answer says
        os.dup2(nowhere.fileno(), 2)
    connection.send_bytes(reply(_facts, name))


def _facts(name: str) -> dict[str, str]:
    native.choose_backend(name)
    native.open_context()
    context = native.context_info()
    facts = {"driver": context["renderer"], "OpenGL": context["version"], "GLSL": context["glsl"]}
    facts |= {"compute stages": "yes" if native.compute_available() else "no"}
    for shown, (number, count) in _LIMITS.items():
        facts[shown] = _said(partial(_limit, number, count))
    for shown, number in _PRECISIONS.items():
        facts[shown] = _said(partial(_precision, number))
    return facts | _measured()


def _said(ask: Callable[[], str]) -> str:
    try:
        return ask()
    except HarnessError:
        return "not said"


def _limit(number: int, count: int) -> str:
    return " x ".join(map(str, native.context_integers(number, count)))


def _precision(number: int) -> str:
    """Of a fragment stage, and where it is another, of a vertex stage."""
    shown = []
    for stage in (gl.GL_FRAGMENT_SHADER, gl.GL_VERTEX_SHADER):
        low, high, bits = native.context_precision(stage, number)
        shown.append(f"2^-{low} ... 2^{high}, {bits} bits" if bits else f"-2^{low} ... 2^{high}")
    return shown[0] if shown[0] == shown[1] else f"{shown[0]}; vertex {shown[1]}"


def _measured() -> dict[str, str]:
    from .calling.call import shader

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "probes.glsl")
        path.write_text(_PROBES)
        plain = shader(path)
        path = Path(folder, "drawn.glsl")
        path.write_text(_DRAWN)
        drawn = shader(path)

        def modes() -> str:
            works = []
            for mode in ("as-written", "precise", "mediump", "double"):
                try:
                    plain.with_mode(mode).id(1.0)
                    works.append(mode)
                except HarnessError:
                    pass
            return ", ".join(works)

        return {
            "denormals": _said(lambda: _denormals(plain.half_of)),
            "denormals, drawn": _said(lambda: _denormals(drawn.half_of)),
            "rounding": _said(lambda: _rounding(plain.with_mode("precise"))),
            "a * b + c": _said(lambda: _contraction(plain.product_sum)),
            "precise a * b + c": _said(lambda: _contraction(plain.with_mode("precise").product_sum)),
            "fma(a, b, c)": _said(lambda: _contraction(plain.fused)),
            "modes": modes(),
        }


def _denormals(half: Function) -> str:
    """2^-127 as a result. llvmpipe sets the processor's flags for fragment stages, and not for compute stages."""
    return "kept" if half(np.float32(2.0**-126)) == np.float32(2.0**-127) else "flushed to 0"


def _rounding(probes: Shader) -> str:
    """By sums beside 1: a tie to the even number below, one to that above, three quarters, and a quarter, of an ulp."""
    ups = [
        probes.sum(np.float32(sign * (1 + start)), np.float32(sign * step)) != np.float32(sign * (1 + start))
        for sign in (1, -1)
        for start, step in ((0, _ULP / 2), (_ULP, _ULP / 2), (0, _ULP * 0.75), (0, _ULP * 0.25))
    ]
    known = {
        (False, True, True, False) * 2: "to nearest, ties to even",
        (False,) * 8: "toward 0",
        (True,) * 8: "away from 0",
        (True, True, True, False) * 2: "to nearest, ties away from 0",
    }
    return known.get(tuple(map(bool, ups)), "in another way")


def _contraction(function: Function) -> str:
    """(1 + 2^-12)^2 - (1 + 2^-11) is 2^-24, but 0 when the product is rounded first."""
    a, c = np.float32(1 + 2.0**-12), np.float32(-(1 + 2.0**-11))
    return "one rounding (fused)" if function(a, a, c) == np.float32(2.0**-24) else "two roundings"
