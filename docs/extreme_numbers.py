"""The numbers of extremes.md. Each is asked for in the texts themselves, as {family[words]:format}.

A family is one of the functions in FAMILIES; its words are the arguments. {peak[D_HALF as-written .02]:.2f} is
peak("D_HALF", "as-written", ".02"), printed with two digits. MODES among the words says in what arithmetic.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import extreme_scenes as scenes
import numpy as np
from extreme_precision import lost
from extreme_scenes import GREY, LIGHT, MODES, VIEWER, close_up, model, term

from harness import ulp_difference

#: side of the grids that are measured
SIZE = 128


class Measured(float):
    """A number that is printed as a text has it: 15 % with a space that does not break, 4e37, ∞."""

    def __format__(self, form: str) -> str:
        if np.isinf(self):
            return "∞"
        return re.sub(r"e\+?(-?)0*", r"e\1", super().__format__(form)).replace("%", "\N{NO-BREAK SPACE}%")


class Family:
    """A function of words, asked by index, once for each: ``Family(f)["a b"]`` is ``f("a", "b")``."""

    def __init__(self, measure: Callable[..., float]):
        self._measure = cache(measure)

    def __getitem__(self, words: str) -> Measured:
        return Measured(self._measure(*words.split()))


def mode_of(words: str) -> str:
    """The arithmetic that a number was measured in: `precise` where its words have none."""
    return next((word for word in words.split() if word in MODES), "precise")


# ---- Distribution ----------------------------------------------------------------------------------------------------


def highlight(form: str, mode: str, roughness: float, size: int = SIZE) -> np.ndarray:
    """D around its peak, as far as three times alpha, as a share of the peak that it should have."""
    alpha = roughness**2
    d = term(form, mode)(LIGHT, VIEWER, close_up(3 * alpha, size), alpha)
    return np.asarray(d, float) * (np.pi * alpha**2)


def highlight_error(form: str, mode: str, roughness: str, quantile: str = "1") -> float:
    """The largest relative error of D around its peak, or the one that a share of the pixels do not exceed."""
    exact = highlight("D_CROSS", "double", float(roughness))
    with np.errstate(invalid="ignore"):
        error = np.abs(highlight(form, mode, float(roughness)) / exact - 1)
    return float(np.quantile(np.where(np.isnan(error), np.inf, error), float(quantile), method="nearest"))


def unsafe(form: str, mode: str, limit: str) -> float:
    """The largest roughness, in hundredths up to 0.6, at which D is off by more than ``limit`` anywhere around its
    peak."""
    for roughness in np.arange(60, 0, -1) / 100:
        exact = highlight("D_CROSS", "double", roughness, 24)
        if not np.all(np.abs(highlight(form, mode, roughness, 24) / exact - 1) <= float(limit)):
            return float(roughness)
    return 0.0


def highlight_broken(form: str, mode: str, roughness: str) -> float:
    """The share of the pixels around the peak of D that are NaN or infinite."""
    return float(np.mean(~np.isfinite(highlight(form, mode, float(roughness)))))


def peak(form: str, mode: str, roughness: str, length: str = "1") -> float:
    """D at h = n as a share of 1/(pi alpha^2), n being of this length."""
    alpha = float(roughness) ** 2
    d = term(form, mode)(VIEWER, VIEWER, VIEWER * float(length), alpha)
    return float(d) * np.pi * alpha**2


def sine2(roughness: str) -> float:
    """alpha^2: the square of the sine at which D has fallen to a quarter."""
    return float(roughness) ** 4


def true_peak(roughness: str) -> float:
    """The peak of D, 1/(pi alpha^2)."""
    return 1 / (np.pi * float(roughness) ** 4)


def brightest(form: str, mode: str, limit: str = "65504") -> float:
    """The largest roughness, in thousandths, at which D at h = n is not below a limit; the largest half is 65504."""
    roughness = np.arange(1, 1001) / 1000
    d = term(form, mode)(VIEWER, VIEWER, VIEWER, roughness**2)
    return float(roughness[~(np.asarray(d, float) < float(limit))].max(initial=0))


# ---- Visibility ------------------------------------------------------------------------------------------------------


def visibility(form: str, mode: str, NoL: str, NoV: str, alpha: str) -> float:
    """V at two cosines, with l and v on opposite sides of the normal."""
    i, o = float(NoL), float(NoV)
    return float(term(form, mode)(i, o, np.cos((np.arccos(i) + np.arccos(o)) / 2), float(alpha)))


def visibility_ratio(form: str, mode: str, NoL: str, NoV: str, alpha: str) -> float:
    """V there as a multiple of the exact V."""
    return visibility(form, mode, NoL, NoV, alpha) / visibility("V_EXACT", "double", NoL, NoV, alpha)


def visibility_off(form: str, mode: str, roughness: str) -> float:
    """The largest relative deviation from the exact V, over cosines of 1/256 and more."""
    NoL, NoV, LoH = scenes.cosines(SIZE)
    alpha = float(roughness) ** 2
    exact = term("V_EXACT", "double")(NoL, NoV, LoH, alpha)
    return float(np.abs(term(form, mode)(NoL, NoV, LoH, alpha) / exact - 1).max())


def dark_side(mode: str, roughness: str, *forms: str) -> float:
    """The share of the unlit part of a sphere where shade is NaN or infinite."""
    n, inside = scenes.sphere(SIZE)
    values = model("shade", mode, *forms)(LIGHT, VIEWER, n, {**GREY, "roughness": float(roughness)})
    unlit = inside & (n @ LIGHT < 0)
    return float(np.mean(~np.isfinite(values[unlit]).all(-1)))


# ---- Fresnel ---------------------------------------------------------------------------------------------------------

COSINES = np.linspace(0, 1, 1001, dtype=np.float32)
#: from far to near 1, evenly in the logarithm of 1 - l.h
NEAR_ONE = (1 - 2.0 ** -np.linspace(0, 18, 512)).astype(np.float32)


def fresnel(form: str, mode: str, F0: str, LoH: str) -> float:
    """F at one angle."""
    return float(term(form, mode)([float(F0)] * 3, float(LoH))[0])


def fresnel_error(form: str, mode: str) -> np.ndarray:
    """Error of F in units in the last place, over NEAR_ONE, where F0 is 0: that of the power alone."""
    exact = term(form, "double")([0.0] * 3, NEAR_ONE)[..., 0]
    return ulp_difference(term(form, mode)([0.0] * 3, NEAR_ONE)[..., 0], exact)


def fresnel_ulp(form: str, mode: str) -> float:
    """The largest error of F where F0 is 0, in units in the last place."""
    return float(fresnel_error(form, mode).max())


def fresnel_deviation(form: str, mode: str, F0: float, reference: str) -> np.ndarray:
    """F relative to another form in double, less 1, over COSINES."""
    exact = term(reference, "double")([F0] * 3, COSINES)[..., 0]
    return np.asarray(term(form, mode)([F0] * 3, COSINES)[..., 0], float) / exact - 1


def fresnel_off(form: str, mode: str, F0: str, reference: str) -> float:
    """The largest relative deviation of F from another form in double."""
    return float(np.abs(fresnel_deviation(form, mode, float(F0), reference)).max())


def fresnel_off_at(form: str, mode: str, F0: str, reference: str) -> float:
    """The angle between l and h, in degrees, where that is."""
    at = np.abs(fresnel_deviation(form, mode, float(F0), reference)).argmax()
    return float(np.degrees(np.arccos(COSINES[at])))


# ---- Energy ----------------------------------------------------------------------------------------------------------


def furnace_most(surface: str, roughness: str, *forms: str) -> float:
    """The most that a white `metal` or `dielectric` returns in a white furnace, toward any cosine of 0.01 and more."""
    return float(scenes.furnace(forms, float(roughness), surface == "metal").max())


def furnace_least(surface: str, roughness: str, *forms: str) -> float:
    """The least."""
    return float(scenes.furnace(forms, float(roughness), surface == "metal").min())


def exchanged(roughness: float, surface: str, *forms: str) -> np.ndarray:
    """How many times as much goes from l to v as from v to l, over the cosines of both."""
    NoL, NoV, _ = scenes.cosines(SIZE)
    l, v = scenes.opposite(NoL, NoV)  # noqa: E741
    shade = model("shade", "precise", *forms)
    material = {**(scenes.METAL if surface == "metal" else scenes.WHITE), "roughness": roughness}
    there = shade(l, v, VIEWER, material)[..., 0] / NoL
    back = shade(v, l, VIEWER, material)[..., 0] / NoV
    return there / back


def reciprocity(roughness: str, surface: str, *forms: str) -> float:
    """The largest of these ratios."""
    return float(exchanged(float(roughness), surface, *forms).max())


# ---- Colour ----------------------------------------------------------------------------------------------------------

CODES = np.arange(256)


def _decoded(form: str, mode: str) -> np.ndarray:
    return np.asarray(term(form, mode)(np.repeat(CODES[:, None] / 255, 3, 1))[:, 0], float)


def code_error(form: str, mode: str) -> np.ndarray:
    """By how many codes each of the 256 is off, when it is decoded by a form and encoded by the standard's curve."""
    encode = scenes.color("double").linear_to_srgb
    shown = encode(np.repeat(_decoded(form, mode)[:, None], 3, 1))[:, 0]
    return np.rint(255 * np.asarray(shown, float)) - CODES


def decode_off(form: str, mode: str) -> float:
    """The largest absolute deviation from the standard's curve."""
    return float(np.abs(_decoded(form, mode) - _decoded("SRGB_PIECEWISE", "double")).max())


def code_off(form: str, mode: str) -> float:
    """The most that a code is off."""
    return float(np.abs(code_error(form, mode)).max())


def codes_changed(form: str, mode: str) -> float:
    """How many of the 256 codes change."""
    return float(np.count_nonzero(code_error(form, mode)))


def darkest(form: str, mode: str) -> float:
    """The darkest code that is not black as a share of what it stands for."""
    return float(_decoded(form, mode)[1] / _decoded("SRGB_PIECEWISE", "double")[1])


# ---- Whole models ----------------------------------------------------------------------------------------------------


def shaded(function: str, mode: str, roughness: str, where: str) -> float:
    """What a grey dielectric returns: at `mirror`, l and v equal to n; at `through`, l = -v with l above the surface;
    at `horizon`, both directions exactly in the plane of the surface."""
    l, v = {  # noqa: E741
        "mirror": (VIEWER, VIEWER),
        "through": (np.array([0.6, 0, 0.8]), -np.array([0.6, 0, 0.8])),
        "horizon": (np.array([1.0, 0, 0]), np.array([0, 1.0, 0])),
    }[where]
    return float(model(function, mode)(l, v, VIEWER, {**GREY, "roughness": float(roughness)})[0])


def dot_angle(mode: str) -> float:
    """Of the exercise's model at roughness 0: how far h may be from n, in degrees, for it to be NaN or infinite."""
    angle = np.radians(np.linspace(0, 4, 4001))
    n = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], -1)
    values = model("shade_exercise", mode)(VIEWER, VIEWER, n, {**GREY, "roughness": 0.0})
    return float(np.degrees(angle[~np.isfinite(values).all(-1)].max(initial=0)))


def on_the_way(function: str) -> np.ndarray:
    """Of a sphere lit from exactly behind: where a value that the function computes on the way is not finite."""
    n, inside = scenes.sphere(SIZE)
    trace = model(function, "double").trace(-VIEWER, VIEWER, n, {**GREY, "roughness": 0.3})
    return inside & np.any([local.non_finite for local in trace], axis=0)


def hidden(function: str) -> float:
    """The share of such a sphere where that is so."""
    return float(np.mean(on_the_way(function)[scenes.sphere(SIZE)[1]]))


# ---- All ------------------------------------------------------------------------------------------------------------

_MEASURES = [
    *(highlight_error, unsafe, highlight_broken, peak, true_peak, sine2, brightest),
    *(visibility, visibility_ratio, visibility_off, dark_side),
    *(fresnel, fresnel_ulp, fresnel_off, fresnel_off_at, furnace_most, furnace_least, reciprocity),
    *(decode_off, code_off, codes_changed, darkest, shaded, dot_angle, hidden, lost),
]
FAMILIES = {measure.__name__: Family(measure) for measure in _MEASURES}
