"""The inputs that errors are measured at: a fixed set for each function, from its domain, spread as surfaces meet them.

Numbers are spread evenly over their interval, one in 64 of them near an end instead, down to 1e-4 of its width. Names
of the field's notation belong together, so that no input is one that cannot be:

- ``l``, ``v``, ``n`` (and ``h``), unit vectors: n anywhere, the viewer's and every second light's cosine to it spread
  evenly; the other lights are where the highlight is, their half vectors distributed as a GGX surface of that roughness
  has them. Both are above the horizon, by a cosine of 1e-4 at least.
- ``NoL``, ``NoV``, ``NoH``, ``LoH``, ``VoH``, ``LoV``: the cosines of such vectors, n.l and n.v both spread evenly.
- ``roughness`` is spread evenly in its interval, and ``alpha`` is a roughness squared.
- ``metalness`` is 0 in a third of the inputs, 1 in a third, and spread evenly in the last.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..calling.function import Function
from ..searching.domain import ROW, Domain
from ..searching.inputs import named_leaves
from ..searching.spaces import SIMPLE, Interval, Unit

COUNT = 1 << 17
SEED = 1
#: the domain of shade()
SHADE = {name: "unit" for name in "lvn"} | {"m.albedo": "color", "m.metalness": "[0,1]", "m.roughness": "[0,1]"}
#: the least cosine to the normal, and the nearest to an end of an interval as a share of it
GRAZING = 1e-4
_NEAR_AN_END = 64  # one in so many
_VECTORS = ("l", "v", "n", "h")
_COSINES = {"NoL": "nl", "NoV": "nv", "NoH": "nh", "LoH": "lh", "VoH": "vh", "LoV": "lv"}
#: an interval wider than this has no even spread that means anything
_WIDE = 1e6


def inputs(function: Function, domain: Mapping[str, Any], count: int) -> dict[str, np.ndarray]:
    """``count`` inputs of a function from a domain, always the same: parts by dotted names, (count, *shape), floats as
    float64. DomainError when the domain does not fit the function."""
    where = Domain.of(function, domain)
    random = np.random.default_rng(SEED)
    leaves = named_leaves(where.signature)
    found = where.batch({ROW: random.integers(0, where.rows, (count, 1))} | _drawn(where, count, random)).flat
    found = {name: a.astype(np.float64) if a.dtype.kind == "f" else np.array(a) for name, a in found.items()}
    own = {name: space for name, space in where.spaces.items() if leaves[name].type.base == "float"}
    for name, space in own.items():
        if isinstance(space, Unit):
            found[name] = _unit(random.standard_normal((count, space.width)))
        elif space.high - space.low <= _WIDE:
            found[name] = _interval(_last(name), space, found[name].shape, random)
    _geometry(found, own, random)
    return found


def _drawn(where: Domain, count: int, random: np.random.Generator) -> dict[str, np.ndarray]:
    """Any values of the spaces, what stays of them being those that no even spread is for."""
    drawn = {}
    for name, space in where.spaces.items():
        places = random.integers(0, SIMPLE, count)
        drawn[name] = space.near(places, random.random((count, space.simple.shape[1])))
    return drawn


def _last(name: str) -> str:
    return name.rpartition(".")[2]


def _interval(name: str, space: Interval, shape: tuple[int, ...], random: np.random.Generator) -> np.ndarray:
    low, high = float(space.low), float(space.high)
    if name == "alpha" and low >= 0:
        return spread(random, shape, np.sqrt(low), np.sqrt(high)) ** 2
    values = spread(random, shape, low, high)
    if name == "metalness":
        third = random.integers(0, 3, shape)
        values = np.where(third == 0, low, np.where(third == 1, high, values))
    return values


def spread(random: np.random.Generator, shape: int | tuple[int, ...], low: float, high: float) -> np.ndarray:
    """Evenly over low ... high, but for one in 64, which is near an end, as near as 1e-4 of the width."""
    near = random.integers(0, _NEAR_AN_END, shape)
    away = 10 ** random.uniform(np.log10(GRAZING), 0, shape)
    share = np.where(near == 0, away, np.where(near == 1, 1 - away, random.uniform(GRAZING, 1, shape)))
    return low + (high - low) * share


# ---- Directions ------------------------------------------------------------------------------------------------------


def _geometry(found: dict[str, np.ndarray], own: Mapping[str, Any], random: np.random.Generator) -> None:
    """Puts directions of one surface in place of what has their names."""
    vectors = {_last(n): n for n, s in own.items() if _last(n) in _VECTORS and isinstance(s, Unit) and s.width == 3}
    cosines = {_last(n): n for n, s in own.items() if _last(n) in _COSINES and found[n].ndim == 1}
    if len(vectors) + len(cosines) < 2:
        return
    roughness = _roughness(found, own, random)
    made = directions(roughness, random, highlights="n" in vectors and "l" in vectors)
    for name, place in vectors.items():
        found[place] = made[name]
    for name, place in cosines.items():
        one, other = (made[letter] for letter in _COSINES[name])
        cosine = np.sum(one * other, axis=-1)
        found[place] = np.clip(cosine, float(own[place].low), float(own[place].high))


def _roughness(found: dict[str, np.ndarray], own: Mapping[str, Any], random: np.random.Generator) -> np.ndarray:
    for name in own:
        if found[name].ndim == 1 and _last(name) in ("roughness", "alpha"):
            return np.sqrt(np.abs(found[name])) if _last(name) == "alpha" else np.abs(found[name])
    return spread(random, len(next(iter(found.values()))), 0.0, 1.0)


def directions(roughness: np.ndarray, random: np.random.Generator, *, highlights: bool) -> dict[str, np.ndarray]:
    """Unit vectors l, v, n and h (count, 3) in double; with ``highlights`` every second h is a GGX surface's."""
    count = len(roughness)
    v = _direction(spread(random, count, 0.0, 1.0), np.zeros(count))
    l = _direction(spread(random, count, 0.0, 1.0), random.uniform(0, 2 * np.pi, count))  # noqa: E741
    if highlights:
        # the tangent of the angle of h to n that a share u of a GGX surface's area stays below [Walter et al. 2007, 35]
        u = random.random(count)
        tangent = roughness**2 * np.sqrt(u / (1 - u))
        h = _direction(1 / np.sqrt(1 + tangent**2), random.uniform(0, 2 * np.pi, count))
        mirrored = 2 * np.sum(v * h, axis=1, keepdims=True) * h - v
        taken = (np.arange(count) % 2 == 0) & (mirrored[:, 2] > GRAZING)
        l = np.where(taken[:, None], _unit(mirrored), l)  # noqa: E741
    n = np.broadcast_to([0.0, 0.0, 1.0], (count, 3))
    turn = rotations(count, random)
    turned = {name: _unit(np.einsum("nij,nj->ni", turn, vector)) for name, vector in zip("lvn", (l, v, n), strict=True)}
    return turned | {"h": _unit(turned["l"] + turned["v"])}


def _direction(cosine: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    sine = np.sqrt((1 - cosine) * (1 + cosine))
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], axis=-1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def rotations(count: int, random: np.random.Generator) -> np.ndarray:
    """(count, 3, 3) rotations, none more likely than another: from quaternions of four normal numbers."""
    w, x, y, z = _unit(random.standard_normal((count, 4))).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)
