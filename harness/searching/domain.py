"""Domains: where the inputs of a function may come from, in a few words for each parameter, weighted to the edges.

``{"n": "unit", "x": "[0,1]", "m.albedo": "color", "k": [1, 2, 3]}``: parameters, or members of a struct by dotted
names, to

- ``"[a,b]"``   every number in a ... b; a round bracket leaves out the end. Both zeros and denormals are in ``[0,1]``.
- ``"unit"``    unit vectors, each rounded to float32
- ``"color"``   every component in 0 ... 1; ``"float"`` all finite floats, ``"int"`` all integers, ``"bool"``
- anything else values: one, or an array of them as in a call. Arrays are taken together, row by row, so that inputs
  which belong together stay together; one row alone is a constant.

Names that are no parameter set uniforms, to one value. Inputs are drawn so that edges meet edges: zeros of both signs,
denormals, the smallest normal, 1 and its neighbours, the ends; vectors that are equal, opposite, mirror images, at
right angles to another, or almost so; numbers that are equal or opposite.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..calling import arguments
from ..errors import CallError, DomainError
from ..language.signature import Array, Signature, Struct
from .inputs import Batch, named_leaves
from .spaces import SIMPLE, WORDS, Space, Unit, from_ordered, ordered, space

if TYPE_CHECKING:
    from ..calling.function import Function

ROW = ""  # the column of the rows of given values: no part has this name
#: ways in which one input may depend on another of the same kind
RELATIONS = ("none", "equal", "opposite", "almost equal", "almost opposite", "mirror image", "at right angles")


@dataclass(frozen=True)
class Domain:
    """The inputs of one overload: spaces of some parts, rows of given values of the others, and uniforms."""

    signature: Signature
    spaces: Mapping[str, Space]
    table: Mapping[str, np.ndarray]
    uniforms: Mapping[str, Any]

    @classmethod
    def of(cls, f: Function, words: Mapping[str, Any]) -> Domain:
        """Reads a domain for a function. DomainError, CallError when they do not fit each other."""
        signature = _overload(f, words)
        parts = named_leaves(signature)
        names = {p.name for p in signature.inputs}
        owners = {name: next((o for o in _owners(name) if o in words), None) for name in parts}
        used = {owner for owner in owners.values() if owner}
        uniforms = {}
        for name, value in words.items():
            if name in used:
                continue
            if isinstance(value, str) or name.partition(".")[0].partition("[")[0] in names:
                raise DomainError(f"{signature} has no input {name}; there are: {', '.join(parts)}", *signature.origin)
            uniforms[name] = value
        spaces = {}
        for name, owner in owners.items():
            if owner and isinstance(words[owner], str):
                spaces[name] = space(words[owner], name, parts[name])
            elif owner is None and parts[name].type.base == "bool":
                spaces[name] = space("bool", name, parts[name])
        missing = [name for name in parts if name not in spaces and owners[name] is None]
        if missing:
            raise DomainError(f"{signature} needs a domain for {', '.join(missing)}: {WORDS}", *signature.origin)
        return cls(signature, spaces, _table(f, signature, words, spaces), uniforms)

    @cached_property
    def rows(self) -> int:
        """Rows of given values; 1 where there are none."""
        return max([1, *(len(array) for array in self.table.values())])

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """What is chosen anew for each input: the parts that have a space, and the row of the given values."""
        return (*self.spaces, ROW)

    def batch(self, flat: Mapping[str, np.ndarray]) -> Batch:
        """Inputs from arrays (n, width) for the ``columns``: of ROW the numbers of the given rows."""
        count = len(flat[ROW])
        made = {}
        for name, leaf in named_leaves(self.signature).items():
            if name in flat:
                values = flat[name]
            else:
                given = self.table[name]
                values = given[flat[ROW][:, 0] if len(given) > 1 else np.zeros(count, np.int64)]
            made[name] = np.ascontiguousarray(values, leaf.dtype).reshape(count, *leaf.type.shape)
        return Batch(self.signature, made, (count,), self.uniforms)

    # ---- Drawing -----------------------------------------------------------------------------------------------------

    def edges(self, at_most: int, random: np.random.Generator) -> Batch:
        """Inputs that are edges, as ``edge_columns`` has them."""
        return self.batch(self.edge_columns(at_most, random))

    def edge_columns(self, at_most: int, random: np.random.Generator) -> dict[str, np.ndarray]:
        """Every combination of edges and given rows; where those are too many, ``at_most`` of them by chance."""
        counts = [self.rows if name == ROW else self.spaces[name].edges for name in self.columns]
        total = int(np.prod(counts, dtype=object)) if counts else 1
        if total <= at_most:
            places = np.array(list(itertools.product(*map(range, counts))), np.int64).reshape(total, len(counts))
        else:
            places = random.integers(0, counts, (at_most, len(counts)))
        return self._simple(places)

    def sample(self, count: int, random: np.random.Generator) -> Batch:
        """Inputs by chance, as ``draw`` has them."""
        return self.batch(self.draw(count, random))

    def draw(self, count: int, random: np.random.Generator) -> dict[str, np.ndarray]:
        """Columns by chance: simple values in every third part, others near them, every third input with a relation."""
        places = random.integers(0, [SIMPLE] * len(self.spaces) + [self.rows], (count, len(self.columns)))
        exact = random.random((count, len(self.columns))) < 1 / 3
        flat = self._simple(places)
        for k, (name, own) in enumerate(self.spaces.items()):
            noise = random.random((count, own.simple.shape[1]))
            flat[name] = np.where(exact[:, k : k + 1], flat[name], own.near(places[:, k], noise))
        relation = random.integers(0, len(RELATIONS), count) * (random.random(count) < 1 / 3)
        self.relate(flat, relation, random.random(count))
        return flat

    def _simple(self, places: np.ndarray) -> dict[str, np.ndarray]:
        flat = {name: own.at(places[:, k]) for k, (name, own) in enumerate(self.spaces.items())}
        return {**flat, ROW: places[:, -1:]}

    @cached_property
    def related(self) -> tuple[tuple[str, str], ...]:
        """Parts of which the second may be made dependent on the first: of one kind and width, a vector or a number."""

        def kind(own: Space):
            return type(own), own.simple.shape[1], own.simple.dtype

        pairs = itertools.combinations(self.spaces.items(), 2)
        return tuple((a, b) for (a, one), (b, other) in pairs if kind(one) == kind(other) and one.simple.dtype == "f4")

    def relate(self, flat: dict[str, np.ndarray], relation: np.ndarray, noise: np.ndarray) -> None:
        """Makes one part depend on another, in place, where ``relation`` is not 0; ``noise``: which, and how near."""
        if not self.related:
            return
        pair = (noise * len(self.related)).astype(np.int64)
        share = np.modf(noise * len(self.related))[0]
        for k, (first, second) in enumerate(self.related):
            chosen = np.flatnonzero((pair == k) & (relation > 0))
            if len(chosen):
                own = self.spaces[second]
                made = _related(flat, first, second, relation[chosen], share[chosen], chosen, self._axis(first, second))
                flat[second][chosen] = own.clip(made)

    def _axis(self, *but: str) -> str | None:
        """A third unit vector, about which two others may be mirror images."""
        return next((n for n, own in self.spaces.items() if isinstance(own, Unit) and n not in but), None)


def samples(f: Function, domain: Mapping[str, Any], n: int = 10_000, seed: int = 0) -> dict[str, Any]:
    """``n`` inputs from a domain, edges first, as the keywords of a call: ``f(**samples(f, {"x": "unit"}))``."""
    return inputs_of(f, domain, n, seed).arguments()


def inputs_of(f: Function, domain: Mapping[str, Any], n: int, seed: int) -> Batch:
    """At most ``n`` inputs from a domain: all there are, if it has only given values, else edges and then chance."""
    if n < 1:
        raise DomainError(f"n has to be 1 or more, and is {n}")
    where, random = Domain.of(f, domain), np.random.default_rng(seed)
    if not where.spaces:
        return where.batch({ROW: np.arange(where.rows)[:, None]})
    edges = where.edges(max(1, n // 2), random)
    return joined([edges, where.sample(n - edges.size, random)]) if n > edges.size else edges


def joined(batches: list[Batch]) -> Batch:
    """One-dimensional batches of the same function, one after the other."""
    flat = {name: np.concatenate([b.flat[name] for b in batches]) for name in batches[0].flat}
    return replace(batches[0], flat=flat, shape=(sum(b.size for b in batches),))


def _related(
    flat: Mapping[str, np.ndarray],
    first: str,
    second: str,
    relation: np.ndarray,
    share: np.ndarray,
    chosen: np.ndarray,
    axis: str | None,
) -> np.ndarray:
    one, other = flat[first][chosen].astype(np.float64), flat[second][chosen].astype(np.float64)
    width = one.shape[1]
    step = 10.0 ** (-9 * share[:, None])
    if width == 1:
        steps = np.rint(2.0 ** (24 * share[:, None])).astype(np.int64)
        largest = ordered(np.float32([np.finfo(np.float32).max]))
        near = from_ordered(np.minimum(ordered(one.astype(np.float32)) + steps, largest)).astype(np.float64)
    else:
        near = one + step * other
    about = flat[axis][chosen].astype(np.float64) if axis and flat[axis].shape[1] == width else np.eye(width)[-1]
    mirror = 2 * about * np.sum(about * one, axis=1, keepdims=True) - one
    across = other - one * np.sum(one * other, axis=1, keepdims=True) + (share[:, None] < 0.5) * step * one
    cases = [one, -one, near, -near, mirror, across if width > 1 else -one]
    return np.select([relation[:, None] == k for k in range(1, len(RELATIONS))], cases, other)


# ---- Reading -------------------------------------------------------------------------------------------------------


def _owners(name: str) -> Iterator[str]:
    """A dotted name and those of what it is part of: m.albedo, m; w[0], w."""
    yield name
    for k in range(len(name) - 1, 0, -1):
        if name[k] in ".[":
            yield name[:k]


def _overload(f: Function, words: Mapping[str, Any]) -> Signature:
    roots = {name.partition(".")[0].partition("[")[0] for name in words}
    fitting = [s for s in f.signatures if roots >= {p.name for p in s.inputs if not _is_bool(p)}]
    if len(fitting) > 1:  # the one that uses most of the names; the others are uniforms
        most = max(len(s.inputs) for s in fitting)
        fitting = [s for s in fitting if len(s.inputs) == most]
    if len(fitting) == 1 or len(f.signatures) == 1:
        return fitting[0] if fitting else f.signatures[0]
    listed = "".join(f"\n    {s}" for s in f.signatures)
    found = "more than one overload has" if fitting else "no overload has"
    raise DomainError(f"{f.__name__}: {found} the inputs {', '.join(sorted(roots))}; there are:{listed}")


def _is_bool(parameter) -> bool:
    return getattr(parameter.type, "base", None) == "bool"


def _table(
    f: Function, signature: Signature, words: Mapping[str, Any], spaces: Mapping[str, Space]
) -> dict[str, np.ndarray]:
    """The given values as arrays (rows, ...) of what has no space, all of the same length or 1."""
    table = {}
    for p in signature.inputs:
        if not any(p.name in _owners(n) and not isinstance(v, str) for n, v in words.items()):
            continue
        parts = {n: leaf for n, leaf in named_leaves(signature).items() if p.name in _owners(n)}
        chosen = [(n, leaf) for n, leaf in parts.items() if n not in spaces]
        filled = _filled(p.type, p.name, words, spaces)
        try:
            arrays = dict(zip(parts, arguments.numbers(p, filled), strict=True))
        except CallError as error:
            raise CallError(f"{error.message}; it is {signature}", *signature.origin) from None
        for name, leaf in chosen:
            array = arrays[name].astype(leaf.dtype)
            table[name] = array.reshape(-1, *leaf.type.shape)
    lengths = {len(array) for array in table.values()} - {1}
    if len(lengths) > 1 or 0 in lengths:
        listed = ", ".join(f"{len(array)} of {name}" for name, array in table.items())
        raise DomainError(f"the given values do not go together, row by row: {listed}", *signature.origin)
    return table


def _filled(kind, name: str, words: Mapping[str, Any], spaces: Mapping[str, Space]) -> Any:
    """A parameter's value as for a call, with anything where a space will give it."""
    if name in words and not isinstance(words[name], str):
        return words[name]
    if isinstance(kind, Struct):
        return {member: _filled(inner, f"{name}.{member}", words, spaces) for member, inner in kind.members}
    if isinstance(kind, Array):
        return [_filled(kind.element, f"{name}[{k}]", words, spaces) for k in range(kind.length)]
    return np.zeros(kind.shape, np.bool_)
