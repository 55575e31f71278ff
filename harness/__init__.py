"""Calls GLSL functions on numpy arrays and renders SHADERed projects, without a display or a GPU."""

from .call import shader
from .compare import assert_close, assert_finite, assert_ulp, elementwise, error_budget, ulp_difference
from .domain import samples
from .errors import CallError, CompareError, DomainError, GlslError, HarnessError, NativeError, ProjectError
from .render import render, render_floats
from .texture_argument import Texture

__all__ = [
    "CallError",
    "CompareError",
    "DomainError",
    "GlslError",
    "HarnessError",
    "NativeError",
    "ProjectError",
    "Texture",
    "assert_close",
    "assert_finite",
    "assert_ulp",
    "elementwise",
    "error_budget",
    "render",
    "render_floats",
    "samples",
    "shader",
    "ulp_difference",
]
