"""Variables and pointers of an interpreted shader: loads and stores through paths, for some lanes or all.

Values are as in ``interpreter_ops`` and are never changed in place: a store makes a new one.
"""

from __future__ import annotations

import numpy as np

from .interpreter_ops import Value
from .spirv import Type

Mask = np.ndarray | None  # which lanes take part, (n,); None: all
Path = tuple[int | np.ndarray, ...]  # members, elements, columns, components; an array has an index for each lane


class Numbers:
    """What the numbers of a shader are in numpy: 32-bit floats become ``floating``, all else keeps its type."""

    def __init__(self, floating: type):
        self.floating = np.dtype(floating)

    def dtype(self, scalar: Type) -> np.dtype:
        """numpy's type of a scalar type."""
        if scalar.kind == "float":
            return self.floating if scalar.width == 32 else np.dtype(np.float64)
        return np.dtype({"int": np.int32, "uint": np.uint32, "bool": np.bool_}[scalar.kind])

    def unassigned(self, kind: Type) -> Value:
        """What a variable holds before anything is assigned: NaN, so that it shows; 0 and false."""
        return self.filled(kind, np.nan)

    def filled(self, kind: Type, number: float) -> Value:
        """A value of a type, all its floats this number and all else 0; None for what is no data."""
        if scalar := kind.number:
            return np.full((*kind.shape, 1), number if scalar.kind == "float" else 0, self.dtype(scalar))
        if kind.kind == "struct":
            return [self.filled(member, number) for _, member in kind.members]
        return [self.filled(kind.element, number) for _ in range(kind.length)] if kind.kind == "array" else None


class Cell:
    """A variable."""

    __slots__ = ("value",)

    def __init__(self, value: Value):
        self.value = value

    def load(self) -> Value:
        return self.value

    def store(self, value: Value, mask: Mask) -> None:
        self.value = value if mask is None else merged(mask, value, self.value)


class Place:
    """A part of a variable."""

    __slots__ = ("cell", "path")

    def __init__(self, cell: Cell, path: Path):
        self.cell, self.path = cell, path

    def load(self) -> Value:
        value = self.cell.value
        for index in self.path:
            value = element(value, index)
        return value

    def store(self, value: Value, mask: Mask) -> None:
        self.cell.value = _with(self.cell.value, self.path, value, mask)


def merged(mask: np.ndarray, new: Value, old: Value) -> Value:
    """``new`` in the lanes of the mask, ``old`` in the others."""
    if isinstance(new, list):
        return [merged(mask, a, b) for a, b in zip(new, old, strict=True)]
    return np.where(mask, new, old)


def index_of(lanes: np.ndarray) -> int | np.ndarray:
    """An index for a path: an int where all lanes agree."""
    return int(lanes[0]) if lanes.shape[-1] == 1 else lanes


def element(value: Value, index: int | np.ndarray) -> Value:
    """A part of a value. An index beyond the ends, for which GLSL promises nothing, is that of the nearest end."""
    last = len(value) - 1
    if isinstance(index, int):
        return value[min(max(index, 0), last)]
    index = np.clip(index, 0, last)
    if isinstance(value, list):
        result = value[0]
        for k in range(1, len(value)):
            result = merged(index == k, value[k], result)
        return result
    if value.shape[-1] == 1:
        return np.moveaxis(value[..., 0][index], 0, -1)
    return np.take_along_axis(value, index.reshape((1,) * (value.ndim - 1) + (-1,)), axis=0)[0]


def _with(value: Value, path: Path, new: Value, mask: Mask) -> Value:
    """The value with the part at the path replaced, in the lanes of the mask."""
    if not path:
        return new if mask is None else merged(mask, new, value)
    index, rest = path[0], path[1:]
    last = len(value) - 1
    if not isinstance(index, int):
        for k in range(len(value)):
            here = np.clip(index, 0, last) == k
            here = here if mask is None else here & mask
            if here.any():
                value = _with(value, (k, *rest), new, here)
        return value
    index = min(max(index, 0), last)
    part = _with(value[index], rest, new, mask)
    if isinstance(value, list):
        return [*value[:index], part, *value[index + 1 :]]
    lanes = max(value.shape[-1], part.shape[-1])
    result = np.empty((*value.shape[:-1], lanes), value.dtype)
    result[...] = value
    result[index] = part
    return result
