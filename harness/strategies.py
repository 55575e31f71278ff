"""Hypothesis strategies for inputs of shaders: one example is a whole batch, and shrinks to one simple input.

    @given(batches(brdf.D_GGX, {"NoH": "[0,1]", "alpha": "(0,1]"}))
    def test_D_is_not_negative(inputs):
        assert (brdf.D_GGX(**inputs) >= 0).all()

A batch is drawn by numpy, from a seed that Hypothesis draws: a thousand inputs cost what one costs. What else it draws
only makes batches simpler, and is for shrinking: fewer inputs, for each part one of the simple values of its domain
instead, the simplest first, and numbers of few binary digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DomainError, HarnessError
from .language.leaf import Leaf
from .language.signature import Numeric
from .searching.domain import RELATIONS, ROW, Domain
from .searching.spaces import SIMPLE, Interval, Space, space

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

    from .calling.function import Function

_NEAR = 256  # values near a simple one, itself the first
_WHOLE = 4  # one in so many batches loses its end, or its beginning
_OFTEN = 8  # one in so many has the same simple value of a part in all inputs
_SIMPLER = 64  # of the simple values, these at first
_SEEDS = 256
_DIGITS = 23  # binary digits of a float32 after the first


def batches(f: Function, domain: Mapping[str, Any], size: int = 1000) -> SearchStrategy[dict[str, Any]]:
    """Batches of up to ``size`` inputs of ``f`` from a domain (harness/searching/domain.py), as the keywords of a call.

    DomainError, CallError when the domain does not suit the function.
    """
    strategies = _hypothesis()
    where = Domain.of(f, domain)
    if size < 1:
        raise DomainError(f"a batch has to have 1 input or more, not {size}")

    @strategies.composite
    def batch(draw) -> dict[str, Any]:
        # The first inputs of a batch, and of those the last: the fewest of the first that fail end with one that does,
        # which a bisection finds; and then the fewest of the last are that one.
        first = draw(strategies.integers(1, _WHOLE * size))
        last = draw(strategies.integers(1, _WHOLE * size))
        flat = where.draw(size, np.random.default_rng(draw(strategies.integers(0, _SEEDS - 1))))
        flat = {name: column[:first][-last:].copy() for name, column in flat.items()}
        for name, column in flat.items():
            simple = draw(strategies.integers(0, _OFTEN * _SIMPLER))  # from _SIMPLER on: as they are
            if simple < _SIMPLER:
                column[:] = simple % where.rows if name == ROW else where.spaces[name].at(np.array([simple]))
        digits = draw(strategies.integers(0, 4 * _DIGITS))
        for name, own in where.spaces.items():
            if digits < _DIGITS and isinstance(own, Interval) and flat[name].dtype.kind == "f":
                flat[name] = own.clip(_rounded(flat[name], digits))
        return where.batch(flat).arguments()

    return batch()


def _rounded(values: np.ndarray, digits: int) -> np.ndarray:
    """The nearest float32 of so many binary digits after the first."""
    significand, exponent = np.frexp(values.astype(np.float64))
    with np.errstate(over="ignore"):  # the largest, which the space brings back
        return np.ldexp(np.rint(np.ldexp(significand, digits + 1)), exponent - digits - 1).astype(np.float32)


def floats(low: float | None = None, high: float | None = None) -> SearchStrategy[np.float32]:
    """A float32 in low ... high, or any finite one, weighted to the edges: 0, denormals, 1, its neighbours, large."""
    words = "float" if low is None and high is None else _interval(low, high)
    return _one(space(words, "floats", _leaf(1)))


def unit_interval() -> SearchStrategy[np.float32]:
    """A float32 in 0 ... 1, weighted to the ends."""
    return floats(0.0, 1.0)


def unit_vectors(width: int = 3) -> SearchStrategy[np.ndarray]:
    """A unit vector, rounded to float32: axes, diagonals, almost along an axis, and any."""
    return _one(space("unit", "unit_vectors", _leaf(width)))


def unit_pairs(width: int = 3) -> SearchStrategy[tuple[np.ndarray, np.ndarray]]:
    """Two unit vectors, often equal, opposite, mirror images or at right angles, exactly so or almost."""
    strategies = _hypothesis()
    own = space("unit", "unit_pairs", _leaf(width))
    where = Domain(None, {"a": own, "b": own}, {}, {})

    def pair(one: np.ndarray, other: np.ndarray, relation: int, noise: float) -> tuple[np.ndarray, np.ndarray]:
        flat = {"a": one[None], "b": other[None].copy()}
        where.relate(flat, np.array([relation]), np.array([noise]))
        return flat["a"][0], flat["b"][0]

    relations = strategies.integers(0, len(RELATIONS) - 1)
    noise = strategies.integers(0, 255).map(lambda k: k / 256)
    return strategies.builds(pair, _one(own), _one(own), relations, noise)


def _hypothesis() -> Any:
    """Hypothesis' strategies, wanted by those who call this module alone."""
    try:
        import hypothesis.strategies
    except ImportError:
        raise HarnessError("strategies need Hypothesis: pip install 'hypothesis>=6.100,<7'") from None
    return hypothesis.strategies


def _leaf(width: int) -> Leaf:
    return Leaf("", (), Numeric("float", width))


def _interval(low: float | None, high: float | None) -> str:
    largest = float(np.finfo(np.float32).max)
    return f"[{-largest if low is None else float(low)!r},{largest if high is None else float(high)!r}]"


def _one(own: Space) -> SearchStrategy[Any]:
    """One value of a space, from the number of a simple value and of one near it."""
    strategies = _hypothesis()

    def value(near: int, simple: int) -> Any:
        place = np.array([simple])
        noise = np.random.default_rng([near, simple]).random(own.simple.shape[1])  # the same numbers, the same value
        made = (own.near(place, noise[None]) if near else own.at(place))[0]
        return made if len(made) > 1 else made[0]

    return strategies.builds(value, strategies.integers(0, _NEAR - 1), strategies.integers(0, SIMPLE - 1))
