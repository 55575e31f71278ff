"""Calls GLSL functions on numpy arrays and renders SHADERed projects, without a display or a GPU.

What is public is imported when it is first asked for: pytest loads our plugin into every project's tests, and most of
them have nothing to do with shaders, numpy or OpenGL.
"""

from importlib import import_module
from typing import Any

#: module -> the public names in it
_PUBLIC = {
    "calling.call": ("shader",),
    "comparing.compare": (
        "assert_close",
        "assert_finite",
        "assert_ulp",
        "elementwise",
        "error_budget",
        "ulp_difference",
    ),
    "searching.domain": ("samples",),
    "errors": (
        "CallError",
        "CompareError",
        "DomainError",
        "GlslError",
        "HarnessError",
        "LadderError",
        "NativeError",
        "ProjectError",
    ),
    "rendering.render": ("render", "render_floats"),
    "calling.texture_argument": ("Texture",),
}
_HOMES = {name: module for module, names in _PUBLIC.items() for name in names}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)


def __dir__() -> list[str]:
    return [*globals(), *__all__]
