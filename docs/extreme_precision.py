"""By how much each precision falls short of double, form by form: the last table of extremes.md."""

from __future__ import annotations

import numpy as np
from extreme_scenes import TERM_OF, term

#: how many inputs of each form are tried
COUNT = 4096
#: less than the smallest normal half is no error: half precision has fewer and fewer digits below
HALF_NORMAL = 2.0**-14
#: the share that an error may be
LIMIT = 0.01


def _inputs(name: str) -> list:
    """Inputs of a term's function, always the same: directions where the highlight is, cosines down to grazing."""
    random = np.random.default_rng(1)
    roughness = 10 ** random.uniform(-2.5, 0, COUNT)
    if name == "decode":
        return [np.repeat(np.arange(256)[:, None] / 255, 3, 1)]
    if name == "F":
        return [random.uniform(0.02, 1, (COUNT, 3)), random.uniform(0, 1, COUNT)]
    NoL, NoV = 10 ** random.uniform(-3, 0, (2, COUNT))
    if name == "V":
        return [NoL, NoV, np.cos((np.arccos(NoL) + np.arccos(NoV)) / 2), roughness**2]
    if name == "multi":
        return [random.uniform(0.02, 1, (COUNT, 3)), NoV, roughness]
    n, across = (_unit(random.standard_normal((COUNT, 3))) for _ in range(2))
    u = random.uniform(0, 0.99, COUNT)[:, None]
    h = _unit(n + roughness[:, None] ** 2 * np.sqrt(u / (1 - u)) * _unit(np.cross(n, across)))
    v = _unit(
        h * random.uniform(0.05, 1, COUNT)[:, None] + 0.5 * _unit(np.cross(h, random.standard_normal((COUNT, 3))))
    )
    l = 2 * (v * h).sum(-1, keepdims=True) * h - v  # noqa: E741
    if name == "D":
        return [l, v, n, roughness**2]
    return [l, v, n, {"albedo": random.uniform(0, 1, (COUNT, 3)), "metalness": 0.0, "roughness": roughness}]


def _unit(a: np.ndarray) -> np.ndarray:
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def _rounded(value, kind):
    if isinstance(value, dict):
        return {name: _rounded(item, kind) for name, item in value.items()}
    return np.asarray(value).astype(kind).astype(float)


def lost(form: str, mode: str) -> float:
    """The share of the inputs of a term where a form is not finite, or more than 1 % off what it is in double; in
    double, more than 1 % off the form that is exact."""
    of = TERM_OF[form]
    inputs = [_rounded(value, np.float16 if mode == "mediump" else np.float32) for value in _inputs(of.name)]
    reference = term(of.exact if mode == "double" else form, "double")(*inputs)
    got = np.asarray(term(form, mode)(*inputs), float)
    with np.errstate(invalid="ignore"):
        fine = np.abs(got - reference) <= np.maximum(LIMIT * np.abs(reference), HALF_NORMAL)
    if fine.ndim > 1:
        fine = fine.all(-1)
    return float(np.mean(~fine))
