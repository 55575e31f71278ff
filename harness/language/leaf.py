"""The numeric parts of a GLSL type, which are what moves through GL."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import CallError
from .signature import DTYPES, Array, Numeric, Opaque, Struct, Type


@dataclass(frozen=True)
class Leaf:
    """A numeric part of a value: ``path`` leads to it in GLSL (``.albedo``, ``[2]``), ``keys`` in Python."""

    path: str
    keys: tuple[str | int, ...]
    type: Numeric

    @cached_property
    def size(self) -> int:
        """How many numbers it has."""
        return self.type.rows * self.type.columns

    @cached_property
    def components(self) -> int:
        """Numbers per texel of its buffer: as many as divide it evenly, for each fetch costs."""
        return next(n for n in (4, 3, 2, 1) if self.size % n == 0)

    @cached_property
    def texels(self) -> int:
        """Texels per value."""
        return self.size // self.components

    @cached_property
    def dtype(self) -> np.dtype:
        """numpy's type of the 4-byte numbers that go through GL."""
        return np.dtype(np.uint32 if self.type.base == "bool" else DTYPES[self.type.base])


def leaves(kind: Type, path: str = "", keys: tuple[str | int, ...] = ()) -> Iterator[Leaf]:
    """The numeric parts of a type. CallError for what is no data."""
    if isinstance(kind, Struct):
        for name, member in kind.members:
            yield from leaves(member, f"{path}.{name}", (*keys, name))
    elif isinstance(kind, Array):
        for k in range(kind.length):
            yield from leaves(kind.element, f"{path}[{k}]", (*keys, k))
    elif isinstance(kind, Opaque) or kind.base not in DTYPES:
        raise CallError(f"values of type {kind} cannot be passed as arrays")
    else:
        yield Leaf(path, keys, kind)
