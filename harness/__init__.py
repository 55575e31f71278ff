"""Calls GLSL functions on numpy arrays and renders SHADERed projects, without a display or a GPU."""

from .call import shader
from .compare import assert_ulp, ulp_difference
from .errors import CallError, GlslError, HarnessError, NativeError, ProjectError
from .render import render, render_floats
from .texture_argument import Texture

__all__ = [
    "CallError",
    "GlslError",
    "HarnessError",
    "NativeError",
    "ProjectError",
    "Texture",
    "assert_ulp",
    "render",
    "render_floats",
    "shader",
    "ulp_difference",
]
