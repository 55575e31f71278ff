"""The spaces that inputs of a shader come from: intervals, all floats, unit vectors, colours; weighted to their edges.

A space holds 256 simple values, the simplest first, and knows what lies near each: ``at`` gives the simple values
themselves, ``near`` others around them that together cover the space, ``clip`` brings back what a search moved outside.
Values are arrays (n, numbers of one value), float32, int32 or uint32 as GLSL gets them.
"""

from __future__ import annotations

import itertools
import re
from functools import cached_property

import numpy as np

from ..errors import DomainError
from ..language.leaf import Leaf

SIMPLE = 256  # the simple values of a space
_SMALLEST_NORMAL = 2.0**-126
_LARGEST = float(np.finfo(np.float32).max)
_EVEN = 1e4  # as far from 0 numbers are spread evenly
_EDGES = (
    *(0.0, 1.0, 0.5, -1.0, -0.5, 2.0, -2.0, -0.0, 0.25, 0.75, 10.0, -10.0),
    *(1 - 2.0**-24, 1 + 2.0**-23, -1 + 2.0**-24, -1 - 2.0**-23),
    *(_SMALLEST_NORMAL, -_SMALLEST_NORMAL, 2.0**-149, -(2.0**-149)),
    *(_SMALLEST_NORMAL - 2.0**-149, 2.0**-149 - _SMALLEST_NORMAL),
    *(2.0**-64, 2.0**-24, 2.0**-12, 0.1, 2.0**24, 2.0**64, -(2.0**64), _LARGEST, -_LARGEST),
    *(2.0**-140, 1e-20, 1e-3, 1e3, 1e10, 2.0**63 * 2, 1e38, -1e38, np.pi, -np.pi, np.pi / 2),
)


def ordered(values: np.ndarray) -> np.ndarray:
    """float32 as int64 in the same order, one apart where floats are neighbours; both zeros are 0."""
    bits = np.ascontiguousarray(values, np.float32).view(np.int32).astype(np.int64)
    return np.where(bits < 0, -(bits & 0x7FFFFFFF), bits)


def from_ordered(keys: np.ndarray) -> np.ndarray:
    """The float32 of these places in the order."""
    keys = np.asarray(keys, np.int64)
    bits = np.where(keys < 0, -keys | 0x80000000, keys)
    return bits.astype(np.uint32).view(np.float32)


def _van_der_corput(count: int) -> np.ndarray:
    """1/2, 1/4, 3/4, 1/8, ...: each new point in a gap of those before."""
    k = np.arange(1, count + 1)
    return sum(((k >> b) & 1) / 2.0 ** (b + 1) for b in range(int(count).bit_length()))


def _mixed(count: int, width: int) -> np.ndarray:
    """(count, width) whole numbers, the same each time, that look like chance: which edges meet in a vector."""
    return np.random.default_rng(width).integers(0, 1 << 30, (count, width))


class Space:
    """Where one numeric part of the inputs comes from."""

    #: the simple values, (SIMPLE, width)
    simple: np.ndarray
    #: how many of them, from the first, are edges
    edges: int

    def at(self, place: np.ndarray) -> np.ndarray:
        """The simple values of these numbers, 0 ... SIMPLE − 1."""
        return self.simple[place]

    def near(self, place: np.ndarray, noise: np.ndarray) -> np.ndarray:
        """A value near each of these simple ones; ``noise`` (n, width), 0 ... 1, says which."""
        raise NotImplementedError

    def clip(self, values: np.ndarray) -> np.ndarray:
        """The nearest values of the space."""
        raise NotImplementedError


class Interval(Space):
    """Every number of a vector, or the one there is, in low ... high; floats, or whole numbers."""

    def __init__(self, low: float, high: float, width: int, dtype: np.dtype):
        self.dtype, self.width = dtype, width
        self.low, self.high = np.array([low, high]).astype(dtype)
        knots = self._knots()
        self.edges = min(self._edges, SIMPLE // 2) if width > 1 else self._edges
        # a vector: first all its numbers the same edge, then edges that meet by chance, then any
        chosen = np.minimum(np.arange(SIMPLE), len(knots) - 1)[:, None].repeat(width, axis=1)
        if width > 1:
            mixed = _mixed(SIMPLE, width)
            mixed[: SIMPLE * 3 // 4] %= min(self._edges, len(knots))
            chosen[self.edges :] = mixed[self.edges :] % len(knots)
        self._chosen = chosen
        self.knots = knots
        self.simple = knots[chosen]

    def _knots(self) -> np.ndarray:
        """Simple numbers, the simplest first."""
        low, high = float(self.low), float(self.high)
        if self.dtype.kind == "f":
            inside = np.float32([e for e in _EDGES if low <= np.float32(e) <= high])
            down, up = np.nextafter(self.high, self.low), np.nextafter(self.low, self.high)
            edges = np.concatenate([inside[:2], [self.low, self.high], inside[2:], [up, down]]).astype(np.float32)
            edges = edges[sorted(np.unique(edges.view(np.uint32), return_index=True)[1])]
            self._edges = len(edges)
            points = _van_der_corput(SIMPLE)
            inner = np.empty(2 * SIMPLE, np.float32)
            first, last = max(low, -_EVEN), min(high, _EVEN)  # all floats evenly would be none but huge ones
            first, last = (first, last) if first < last else (low, high)
            inner[::2] = first + points * (last - first)
            first, last = ordered(np.array([self.low, self.high]))
            inner[1::2] = from_ordered(np.rint(first + points * (last - first)))
            return np.concatenate([edges, np.clip(inner, self.low, self.high)])[:SIMPLE]
        ends = [low, high, low + 1, high - 1]
        inside = [e for e in (0, 1, -1, 2, *ends, 3, 7, 8, 15, 16, 31, 32, 255, 256) if low <= e <= high]
        edges = list(dict.fromkeys(int(e) for e in inside))
        self._edges = len(edges)
        points = np.rint(low + _van_der_corput(SIMPLE) * (high - low))
        return np.array([*edges, *(int(p) for p in points)], np.int64)[:SIMPLE].astype(self.dtype)

    @cached_property
    def _next(self) -> np.ndarray:
        """For each knot the next larger one."""
        order = np.unique(self.knots)
        return order[np.minimum(np.searchsorted(order, self.knots, side="right"), len(order) - 1)]

    def near(self, place: np.ndarray, noise: np.ndarray) -> np.ndarray:
        """Between the simple value and the next: spread evenly, over the exponents, or a few ulps from the simple."""
        chosen = self._chosen[place]
        here, there = self.knots[chosen], self._next[chosen]
        kind, share = np.divmod(noise * 3, 1)
        if self.dtype.kind != "f":
            return np.rint(here + noise * (there.astype(np.float64) - here)).astype(self.dtype)
        first, last = ordered(here), ordered(there)
        evenly = (here + share * (there.astype(np.float64) - here)).astype(np.float32)
        by_exponent = from_ordered(np.rint(first + share * (last - first)))
        close = from_ordered(first + np.rint((2.0 ** (40 * np.abs(share - 0.5)) - 1) * np.sign(share - 0.5)))
        return self.clip(np.select([kind == 0, kind == 1], [evenly, by_exponent], close))

    def clip(self, values: np.ndarray) -> np.ndarray:
        """The nearest values of the interval; the nearest whole ones of a type of whole numbers."""
        if self.dtype.kind != "f":
            return np.rint(np.clip(values, float(self.low), float(self.high))).astype(self.dtype)
        values = np.where(np.isnan(values), self.low, values)
        return np.clip(values, self.low, self.high).astype(np.float32)


class Unit(Space):
    """Unit vectors, each rounded to float32: axes, diagonals, almost along an axis, and any."""

    edges = 64

    def __init__(self, width: int):
        self.width = width
        axes = np.eye(width)[::-1]  # +z first: the normal of most examples
        signs = np.array(np.meshgrid(*[[1, -1]] * width)).reshape(width, -1).T
        two = list(itertools.permutations(axes, 2))
        pairs = [a + s * 10.0**-e * b for e in (0, 2, 4, 7, 12, 19) for a, b in two for s in (1, -1)]
        exact = [axis * s for s in (1, -1) for axis in axes]
        slanted = [0.6 * a + 0.8 * b for a, b in two]
        any_ = np.random.default_rng(width).standard_normal((SIMPLE, width))
        self.simple = _unit(np.array([*exact, *slanted, *signs, *pairs, *any_])[:SIMPLE])

    def near(self, place: np.ndarray, noise: np.ndarray) -> np.ndarray:
        """Turned by an angle of any magnitude from 1e-8 to 1."""
        angle = 10.0 ** (-8 * noise[:, :1])
        mixed = np.modf(noise * 1021.0)[0] * 2 - 1  # other digits of the noise than the angle's
        return _unit(self.simple[place] + angle * 2 * mixed)

    def clip(self, values: np.ndarray) -> np.ndarray:
        """Normalised, and rounded; what has no direction becomes the first axis."""
        return _unit(values)


def _unit(vectors: np.ndarray) -> np.ndarray:
    vectors = np.nan_to_num(np.asarray(vectors, np.float64), posinf=1, neginf=-1)
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    scaled = np.where(largest > 0, vectors / np.where(largest > 0, largest, 1), np.eye(vectors.shape[-1])[-1])
    return (scaled / np.linalg.norm(scaled, axis=-1, keepdims=True)).astype(np.float32)


_INTERVAL = re.compile(r"([\[(])\s*([^,\[\]()]+?)\s*,\s*([^,\[\]()]+?)\s*([\])])")
WORDS = '"unit", "[0,1]", "(0,1]", "[-1e3,1e3]", "color", "float", "int", "bool", or values'


def space(text: str, name: str, leaf: Leaf) -> Space:
    """The space that a word or an interval names, for one part of the inputs. DomainError when it has none."""
    kind, base = leaf.type, leaf.type.base
    words = {
        "float": ("float", -_LARGEST, _LARGEST),
        "color": ("float", 0.0, 1.0),
        "int": ("int uint", *((-(2**31), 2**31 - 1) if base == "int" else (0, 2**32 - 1))),
        "bool": ("bool", 0, 1),
    }
    if text == "unit":
        if base != "float" or kind.columns > 1 or kind.rows == 1:
            raise DomainError(f'{name} is a {kind}: "unit" is for vectors')
        return Unit(kind.rows)
    if text in words:
        bases, low, high = words[text]
        if base not in bases.split():
            raise DomainError(f'{name} is a {kind}: "{text}" is for {bases.replace(" ", " and ")}')
        return Interval(low, high, leaf.size, leaf.dtype)
    match = _INTERVAL.fullmatch(text.strip())
    if not match:
        raise DomainError(f"{name}: {text!r} is no domain; there are {WORDS}")
    return Interval(*_ends(match, name, leaf), leaf.size, leaf.dtype)


def _ends(match: re.Match, name: str, leaf: Leaf) -> tuple[float, float]:
    """The smallest and the largest value of an interval; round brackets leave out the end itself."""
    try:
        low, high = (float(match[k]) for k in (2, 3))
    except ValueError:
        raise DomainError(f"{name}: {match[0]!r} has an end that is no number") from None
    if not (np.isfinite(low) and np.isfinite(high)):
        raise DomainError(f'{name}: {match[0]!r} has an end that is not finite; "float" has all finite numbers')
    whole = leaf.type.base != "float"
    limit = np.iinfo(leaf.dtype) if whole else np.finfo(np.float32)
    if low < float(limit.min) or high > float(limit.max) or (leaf.type.base == "bool" and (low < 0 or high > 1)):
        raise DomainError(f"{name} is a {leaf.type}: {match[0]!r} has an end beyond")
    first, last = np.array([low, high]).astype(leaf.dtype)
    if match[1] == "(" and float(first) <= low:
        first = first + 1 if whole else np.nextafter(first, np.float32(np.inf))
    if match[4] == ")" and float(last) >= high:
        last = last - 1 if whole else np.nextafter(last, np.float32(-np.inf))
    if first > last:
        raise DomainError(f"{name}: {match[0]!r} is empty")
    return float(first), float(last)
