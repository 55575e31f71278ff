"""The inputs where shading models break: a fixed set, and how many results are not finite, or negative, there.

1 048 576 inputs of ``shade``, always the same. A number "of every magnitude" in 1e-a ... 1e-b has its logarithm spread
evenly. Directions, an eighth of the inputs each, with the azimuth anywhere:

- l = v = n
- l = v at any cosine
- l = -v exactly, l at any cosine of any magnitude, or on the horizon exactly
- l nearly -v: off by an angle of every magnitude in 1e-9 ... 0.1
- l and v on opposite sides just above the horizon, with two cosines of every magnitude in 1e-38 ... 1e-2
- l and v mirror images about n, exactly, at any cosine of any magnitude
- nearly mirror images: off by an angle of every magnitude in 1e-9 ... 0.1
- anything: each cosine is spread evenly, 0, nearly 0, nearly 1, of every magnitude; one in four is behind the surface

In half of them n is +z, where mirror images are exact in float32; the rest are turned together, anywhere. All are
rounded to float32 once, in the end, so that they are unit vectors as far as float32 has them.

Roughness: 0; denormal; of every magnitude in 1e-38 ... 1; 1e-6 ... 1e-1 in powers of ten; 0.045 and 0.089, which
engines clamp to; 1; even. Albedo and metalness: 0, 1, even, nearly 0, nearly 1; the albedo's channels are alike in half
of them.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..calling.function import Function
from . import sampling
from .values import Flat, values

COUNT = 1 << 20
SEED = 2
_ROUGHNESS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.045, 0.089)
_DENORMAL = 2.0**-149


def inputs(count: int) -> dict[str, np.ndarray]:
    """The set, of COUNT, or a smaller one of the same kinds: float32, for ``values.values`` of ``shade``."""
    random = np.random.default_rng(SEED)
    kind = np.arange(count) % 8
    l, v = (np.empty((count, 3)) for _ in range(2))  # noqa: E741
    for k, pairs in enumerate(_PAIRS):
        chosen = np.flatnonzero(kind == k)
        l[chosen], v[chosen] = pairs(len(chosen), random)
    n = np.tile([0.0, 0.0, 1.0], (count, 1))
    turned = np.flatnonzero(np.arange(count) // 8 % 2)
    turn = sampling.rotations(len(turned), random)
    for vectors in (l, v, n):
        vectors[turned] = np.einsum("nij,nj->ni", turn, vectors[turned])
    grey = random.random((count, 1)) < 0.5
    albedo = _shares((count, 3), random)
    made = {
        "l": l,
        "v": v,
        "n": n,
        "m.albedo": np.where(grey, albedo[:, :1], albedo),
        "m.metalness": _shares(count, random),
        "m.roughness": _roughness(count, random),
    }
    return {name: array.astype(np.float32) for name, array in made.items()}


def count_broken(function: Function, flat: Flat) -> dict[str, int]:
    """How many evaluations yield a number that is ``non_finite``, or one that is ``negative``, in the function's mode.

    HarnessError when it cannot be evaluated in it.
    """
    found = values(function, flat)
    with np.errstate(invalid="ignore"):
        return {
            "non_finite": int((~np.isfinite(found)).any(axis=1).sum()),
            "negative": int((found < 0).any(axis=1).sum()),
        }


# ---- Numbers ---------------------------------------------------------------------------------------------------------


def _magnitudes(low: float, high: float, shape, random: np.random.Generator) -> np.ndarray:
    return 10 ** random.uniform(low, high, shape)


def _one_of(kinds: list[np.ndarray], random: np.random.Generator) -> np.ndarray:
    return np.choose(random.integers(0, len(kinds), kinds[0].shape), kinds)


def _shares(shape: int | tuple[int, ...], random: np.random.Generator) -> np.ndarray:
    """Albedo and metalness."""
    near = _magnitudes(-9, -1, shape, random)
    return _one_of([np.zeros(shape), np.ones(shape), random.random(shape), near, 1 - near], random)


def _roughness(count: int, random: np.random.Generator) -> np.ndarray:
    kinds = [
        np.zeros(count),
        _DENORMAL * np.rint(_magnitudes(0, 6.9, count, random)),
        _magnitudes(-38, 0, count, random),
        random.choice(_ROUGHNESS, count),
        np.ones(count),
        random.random(count),
    ]
    return _one_of(kinds, random)


def _cosines(count: int, random: np.random.Generator) -> np.ndarray:
    """Anywhere, 0, of every magnitude, and as near to 1."""
    kinds = [
        random.random(count),
        np.zeros(count),
        _magnitudes(-38, 0, count, random),
        1 - _magnitudes(-16, 0, count, random),
    ]
    return _one_of(kinds, random)


# ---- Pairs of directions, about +z -----------------------------------------------------------------------------------


def _azimuth(count: int, random: np.random.Generator) -> np.ndarray:
    return random.uniform(0, 2 * np.pi, count)


def _direction(cosine: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    sine = np.sqrt((1 - cosine) * (1 + cosine))
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], axis=-1)


def _any(count: int, random: np.random.Generator) -> np.ndarray:
    return _direction(_cosines(count, random), _azimuth(count, random))


def _turned_a_little(vectors: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """By an angle of every magnitude in 1e-9 ... 0.1, toward anywhere."""
    axis = random.standard_normal(vectors.shape)
    across = np.cross(vectors, axis)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    angle = _magnitudes(-9, -1, (len(vectors), 1), random)
    return vectors * np.cos(angle) + across * np.sin(angle)


def _all_alike(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    n = np.tile([0.0, 0.0, 1.0], (count, 1))
    return n, n


def _alike(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l = _any(count, random)  # noqa: E741
    return l, l


def _opposite(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l = _any(count, random)  # noqa: E741
    return l, -l


def _nearly_opposite(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l = _any(count, random)  # noqa: E741
    return l, _turned_a_little(-l, random)


def _horizons(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    azimuth = _azimuth(count, random)
    low, high = (_magnitudes(-38, -2, count, random) for _ in range(2))
    return _direction(low, azimuth), _direction(high, azimuth + np.pi)


def _mirrored(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l = _any(count, random)  # noqa: E741
    return l, l * [-1, -1, 1]


def _nearly_mirrored(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l = _any(count, random)  # noqa: E741
    return l, _turned_a_little(l * [-1, -1, 1], random)


def _anything(count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    l, v = (_any(count, random) for _ in range(2))  # noqa: E741
    for vectors in (l, v):
        vectors[:, 2] *= np.where(random.random(count) < 0.25, -1, 1)
    return l, v


_Pairs = Callable[[int, np.random.Generator], tuple[np.ndarray, np.ndarray]]
_PAIRS: tuple[_Pairs, ...] = (
    _all_alike,
    _alike,
    _opposite,
    _nearly_opposite,
    _horizons,
    _mirrored,
    _nearly_mirrored,
    _anything,
)
