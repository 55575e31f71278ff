"""The pictures of extremes.md: each a function that evaluates the shaders, and yields rows of labelled tiles.

The exposure is what radiance is multiplied by before it is encoded. A highlight is shown with the exposure at which the
peak that it should have is 1.
"""

from __future__ import annotations

import numpy as np
from extreme_drawing import Tile, graph, radiance, ratio
from extreme_numbers import CODES, code_error, exchanged, fresnel_deviation, fresnel_error, on_the_way
from extreme_scenes import COSINES as FURNACE_COSINES
from extreme_scenes import (
    GREY,
    LIGHT,
    TERMS,
    VIEWER,
    close_up,
    cosines,
    furnace,
    model,
    sphere,
    term,
)

SIZE = 128
Rows = list[list[Tile]]


def _values(form: str) -> list[str]:
    return [rung.value for rung in TERMS[form].rungs]


def _highlight(form: str, mode: str, roughness: float, length: float = 1.0, size: int = SIZE) -> Tile:
    alpha = roughness**2
    d = term(form, mode)(LIGHT, VIEWER, close_up(3 * alpha, size) * length, alpha)
    return f"{form} r={roughness:g}", radiance(d, np.pi * alpha**2)


def _sphere(label: str, mode: str, roughness: float, *forms: str, function: str = "shade", size: int = SIZE) -> Tile:
    n, inside = sphere(size)
    values = model(function, mode, *forms)(LIGHT, VIEWER, n, {**GREY, "roughness": roughness})[..., 0]
    return label, radiance(values, 4, inside)


def zero() -> Rows:
    """Roughness 0 in half precision: a sphere, and its highlight from near."""
    n = close_up(0.06, SIZE)

    def near(label, function, mode, *forms):
        values = model(function, mode, *forms)(LIGHT, VIEWER, n, {**GREY, "roughness": 0.0})[..., 0]
        return label, radiance(values, 4)

    return [
        [
            _sphere("exercise, mediump", "mediump", 0, function="shade_exercise"),
            near("from near", "shade_exercise", "mediump"),
            _sphere("default, mediump", "mediump", 0),
            near("from near", "shade", "mediump"),
            _sphere("default, float", "as-written", 0),
            near("from near", "shade", "as-written"),
        ]
    ]


def opposite() -> Rows:
    """Light from exactly behind: where a value on the way to the result is not a number."""
    _, inside = sphere(SIZE)

    def traced(function):
        return radiance(np.where(on_the_way(function), np.nan, 0), 1, inside)

    return [[("exercise", traced("shade_exercise")), ("default", traced("shade"))]]


def rounding() -> Rows:
    """The highlight in float32, with no rewriting by the driver."""
    forms = ("D_EXERCISE", "D_ONE_MINUS", "D_PROJECT")
    return [[_highlight(form, "precise", r) for r in (0.1, 0.045, 0.02, 0.01)] for form in forms]


def half() -> Rows:
    """The highlight in half precision."""
    forms = ("D_EXERCISE", "D_ONE_MINUS", "D_PROJECT", "D_CROSS", "D_HALF")

    def default(r):
        return f"default, float r={r:g}", _highlight("D_PROJECT", "as-written", r, size=112)[1]

    return [[*(_highlight(form, "mediump", r, size=112) for form in forms), default(r)] for r in (0.2, 0.1, 0.05)]


def short() -> Rows:
    """The highlight about a normal that is a thousandth too short."""
    forms = ("D_EXERCISE", "D_PROJECT", "D_CROSS")
    return [[_highlight(form, "as-written", r, 0.999) for form in forms] for r in (0.1, 0.045)]


def capped() -> Rows:
    """The highlight up to 65504."""
    return [[_highlight(form, "as-written", r) for r in (0.1, 0.045, 0.03, 0.02)] for form in ("D_HALF", "D_PROJECT")]


def unlit() -> Rows:
    """The unlit side in half precision at roughness 0, by each V."""
    tiles = [_sphere(form, "mediump", 0, form, "D_PROJECT", size=112) for form in _values("V")]
    return [[*tiles, _sphere("default, float", "as-written", 0, size=112)]]


def shadowing() -> Rows:
    """V as a multiple of the exact V, n.l rightward and n.v upward."""
    NoL, NoV, LoH = cosines(112)

    def tile(form, roughness):
        exact = term("V_EXACT", "double")(NoL, NoV, LoH, roughness**2)
        return f"{form} r={roughness:g}", ratio(term(form, "as-written")(NoL, NoV, LoH, roughness**2) / exact)

    forms = [form for form in _values("V") if form != "V_EXACT"]
    return [[tile(form, r) for form in forms] for r in (0.2, 0.5, 1.0)]


def power() -> Rows:
    """Errors of (1 - l.h)^5 in units in the last place, over the logarithm of 1 - l.h, from 1 down to 2^-18."""

    def tile(form):
        error = fresnel_error(form, "as-written").reshape(-1, 2).max(1)
        return f"{form}: 0 to 100 ulp", graph(error, 100, signed=False)

    return [[tile(form) for form in ("F_POW", "F_MULTIPLY")]]


def schlick() -> Rows:
    """Relative deviation of F of a dielectric from the exact one, over l.h."""

    def tile(form):
        return f"{form}: -25 to +25 %", graph(fresnel_deviation(form, "double", 0.04, "F_DIELECTRIC")[::4], 0.25)

    return [[tile(form) for form in ("F_MULTIPLY", "F_GAUSSIAN", "F_DIELECTRIC")]]


def step() -> Rows:
    """F for F0 of 0 to 0.1, from left to right, and l.h from 1 below to 0.1 above."""
    F0, LoH = np.meshgrid(np.linspace(0, 0.1, SIZE), np.linspace(0.1, 1, SIZE))
    F0 = np.repeat(F0[..., None], 3, -1)
    forms = ("F_DIELECTRIC", "F_F82", "F_MULTIPLY")
    return [[(form, radiance(term(form, "as-written")(F0, LoH)[..., 0], 4)) for form in forms]]


def _furnace(roughness: float, metal: bool, form: str) -> np.ndarray:
    """What a white sphere returns in a white furnace, which is 1 around it."""
    n, inside = sphere(SIZE)
    return np.where(inside, np.interp(n[..., 2], FURNACE_COSINES, furnace((form,), roughness, metal)), 1.0)


def tint() -> Rows:
    """A white metal in a white furnace."""
    return [[(f"{form} r=0.1", ratio(_furnace(0.1, True, form), 1.25)) for form in ("F_F82", "F_MULTIPLY")]]


def dielectric_furnace() -> Rows:
    """A white dielectric in a white furnace, by each diffuse form."""
    tiles = [(f"{form} r=0.3", ratio(_furnace(0.3, False, form), 1.25)) for form in _values("diffuse")]
    return [tiles[:4], tiles[4:]]


def metal_furnace() -> Rows:
    """A white metal in a white furnace, with and without what is reflected more than once."""
    roughness = (0.3, 0.6, 1.0)
    return [
        [(f"{form} r={r:g}", radiance(_furnace(r, True, form), 0.5)) for r in roughness] for form in _values("multi")
    ]


def exchange() -> Rows:
    """What goes from l to v as a multiple of what goes from v to l, n.l rightward and n.v upward."""
    return [
        [
            ("DIFFUSE_ENERGY r=0.3", ratio(exchanged(0.3, "dielectric", "DIFFUSE_ENERGY"))),
            ("MULTI_FITTED r=1", ratio(exchanged(1.0, "metal", "MULTI_FITTED"))),
            ("default r=0.3", ratio(exchanged(0.3, "dielectric"))),
        ]
    ]


def decoding() -> Rows:
    """The 256 codes and by how many each is off; the upper half of a ramp is by the form, the lower as it was."""

    def tile(form):
        error = code_error(form, "as-written")
        ramp = np.repeat(np.stack([np.clip(CODES + error, 0, 255), CODES]), 16, 0).astype(np.uint8)
        return f"{form}: -10 to +10 codes", np.concatenate([np.repeat(ramp[..., None], 3, -1), graph(error, 10, 84)])

    forms = _values("decode")
    return [[tile(form) for form in forms[:2]], [tile(form) for form in forms[2:]]]


_MAKERS = [
    *(zero, opposite, rounding, half, short, capped, unlit, shadowing, power, schlick),
    *(step, tint, dielectric_furnace, metal_furnace, exchange, decoding),
]
PICTURES = {make.__name__: make for make in _MAKERS}
