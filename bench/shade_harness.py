"""``shade`` by the harness: arrays in, a new array out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import harness
from harness import native

from . import ROOT
from .inputs import Inputs


def contender() -> Callable[[Inputs], np.ndarray]:
    """The function, compiled at its first call."""
    brdf = harness.shader(ROOT / "shaders" / "brdf.glsl")

    def shade(x: Inputs) -> np.ndarray:
        material = {"albedo": x.albedo, "metalness": x.metalness, "roughness": x.roughness}
        return brdf.shade(x.l, x.v, x.n, material)

    return shade


def renderer() -> str:
    """What draws."""
    native.open_context()
    info = native.context_info()
    return f"{info['renderer']}, {info['version']}"
