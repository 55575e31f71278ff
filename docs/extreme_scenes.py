"""What the measurements and the pictures of extremes.md look at: the forms of the ladder, surfaces, a white furnace.

Directions are unit vectors, +z toward the viewer; grids of normals are (size, size, 3), rows from the top down.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

import harness
from harness import ladder

ROOT = Path(__file__).resolve().parent.parent
LADDER = ladder.load(ROOT / "shaders" / "ladder.toml")
TERMS = {term.name: term for term in LADDER.terms}
#: the term of each form, by the value of its macro
TERM_OF = {rung.value: term for term in LADDER.terms for rung in term.rungs}
MODES = ("as-written", "precise", "mediump", "double")

VIEWER = np.array([0.0, 0.0, 1.0])
LIGHT = np.array([-1.0, 1.0, 1.2]) / math.sqrt(3.44)
HALF = (LIGHT + VIEWER) / np.linalg.norm(LIGHT + VIEWER)

GREY = {"albedo": [0.5, 0.5, 0.5], "metalness": 0.0}
WHITE = {"albedo": [1.0, 1.0, 1.0], "metalness": 0.0}
BLACK = {"albedo": [0.0, 0.0, 0.0], "metalness": 0.0}
METAL = {"albedo": [1.0, 1.0, 1.0], "metalness": 1.0}


def term(form: str, mode: str) -> harness.Function:
    """The function that computes a term by one of its forms."""
    of = TERM_OF[form]
    return _shader(of.file, mode, ((of.macro, form),))[of.function]


def model(name: str, mode: str, *forms: str) -> harness.Function:
    """``shade`` or ``shade_exercise``, by these forms, and by the default where none is of a term."""
    return _shader("brdf.glsl", mode, tuple((TERM_OF[form].macro, form) for form in forms))[name]


def color(mode: str):
    """The functions of color.glsl."""
    return _shader("color.glsl", mode, ())


@cache
def _shader(file: str, mode: str, defines: tuple[tuple[str, str], ...]):
    return harness.shader(ROOT / "shaders" / file, defines=dict(defines), mode=mode)


# ---- Surfaces --------------------------------------------------------------------------------------------------------


def sphere(size: int) -> tuple[np.ndarray, np.ndarray]:
    """Normals of a sphere, seen from afar, and where it is; +z beside it."""
    x, y = _plane(size)
    x, y = x * size / (size - 6), y * size / (size - 6)
    inside = x * x + y * y < 1
    z = np.sqrt(np.where(inside, 1 - x * x - y * y, 1))
    return np.where(inside[..., None], np.stack([x, y, z], -1), VIEWER), inside


def close_up(angle: float, size: int) -> np.ndarray:
    """Normals around HALF, up to an angle (radians) from it at the sides: where the highlight is."""
    right = np.cross([0.0, 1.0, 0.0], HALF)
    right /= np.linalg.norm(right)
    x, y = (math.tan(angle) * c[..., None] for c in _plane(size))
    n = HALF + x * right + y * np.cross(HALF, right)
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def _plane(size: int) -> tuple[np.ndarray, np.ndarray]:
    c = (2 * np.arange(size) + 1) / size - 1
    return np.meshgrid(c, -c)


def cosines(size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """n.l, from left to right, n.v, from below upward, and l.h, for l and v on opposite sides of n. None is 0."""
    c = (np.arange(size) + 0.5) / size
    NoL, NoV = np.meshgrid(c, c[::-1])
    return NoL, NoV, np.cos((np.arccos(NoL) + np.arccos(NoV)) / 2)


def opposite(NoL: np.ndarray, NoV: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """l and v on opposite sides of +z, at these cosines to it."""

    def direction(cosine, side):
        return np.stack([side * np.sqrt(1 - cosine**2), np.zeros_like(cosine), cosine], -1)

    return direction(NoL, 1), direction(NoV, -1)


# ---- A white furnace -------------------------------------------------------------------------------------------------

NODES = 64
COSINES = np.concatenate([[0.01, 0.03], np.linspace(0.06, 1, 30)])


@cache
def furnace(forms: tuple[str, ...], roughness: float, metal: bool) -> np.ndarray:
    """What a white metal, or a white dielectric, returns toward COSINES of light 1 from everywhere.

    The highlight is integrated over the half vector, its tangent spread as GGX is, and the diffuse part over l.
    """
    returned = _highlight(model("shade", "precise", *forms), {**(METAL if metal else BLACK), "roughness": roughness})
    if not metal:
        chosen = [form for form in forms if TERM_OF[form].name == "diffuse"] or [TERMS["diffuse"].exact]
        returned = returned + _diffuse(term(chosen[0], "precise"), {**WHITE, "roughness": roughness})
    return returned


def _gauss(low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    x, w = np.polynomial.legendre.leggauss(NODES)
    return low + (high - low) * (x + 1) / 2, w * (high - low) / 2


def _viewers() -> tuple[np.ndarray, np.ndarray]:
    """Sines of the viewers' angles, and the viewers, over (cosine, azimuth, angle)."""
    sine = np.sqrt(1 - COSINES**2)
    return sine[:, None], np.stack([sine, np.zeros_like(sine), COSINES], -1)[:, None, None]


def _highlight(shade: harness.Function, material: dict) -> np.ndarray:
    """As in tests/shaders/test_energy.py: dl = 4 (v.h) dh, and t = tan(theta) ends where l meets the horizon."""
    a = material["roughness"] ** 2
    sine_v, v = _viewers()
    phi, w_phi = _gauss(0, math.pi)
    across = sine_v * np.cos(phi)
    end = np.arctan((across + np.sqrt(across**2 + COSINES[:, None] ** 2)) / COSINES[:, None] / a)[..., None]
    u, w_u = _gauss(0, 1)
    t = a * np.tan(end * u)
    cosine = 1 / np.sqrt(1 + t * t)
    sine = t * cosine
    h = np.stack([sine * np.cos(phi)[:, None], sine * np.sin(phi)[:, None], cosine], -1)
    v_h = (h * v).sum(-1)
    values = shade(2 * v_h[..., None] * h - v, v, VIEWER, material)[..., 0].astype(float)
    weight = 4 * v_h * t * cosine**3 * a * (1 + (t / a) ** 2) * end
    return 2 * (values * weight @ w_u) @ w_phi


def _diffuse(scatter: harness.Function, material: dict) -> np.ndarray:
    NoL, w_mu = _gauss(0, 1)
    phi, w_phi = _gauss(0, math.pi)
    sine = np.sqrt(1 - NoL**2)
    x, y = sine * np.cos(phi)[:, None], sine * np.sin(phi)[:, None]
    l = np.stack(np.broadcast_arrays(x, y, NoL), -1)  # noqa: E741
    values = scatter(l, _viewers()[1], VIEWER, material)[..., 0].astype(float)
    return 2 * (values * NoL @ w_mu) @ w_phi
