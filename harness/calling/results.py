"""What a GLSL function returns: from flat arrays of numbers to numpy's shapes, and named tuples that read well."""

from __future__ import annotations

import keyword
from collections import namedtuple
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from ..language.signature import Array, Numeric, Signature, Struct, Type

_SHOWN = 4  # the length of a dimension that a repr shows all of: vectors and matrices are shown whole


def shaped(signature: Signature, outputs: Sequence[Sequence[np.ndarray]], batch: tuple[int, ...]) -> Any:
    """The result of a function from the leaves (count, size) of its outputs: one value, or a named tuple of several."""
    values = [_shaped(kind, iter(leaf), batch) for (_, kind), leaf in zip(signature.outputs, outputs, strict=True)]
    if len(values) == 1:
        return values[0]
    return tuple_type(signature.name, tuple(name for name, _ in signature.outputs))(*values)


def _shaped(kind: Type, values: Iterator[np.ndarray], batch: tuple[int, ...]) -> Any:
    """The value of a type from its leaves: arrays (*batch, *shape), named tuples for structs."""
    if isinstance(kind, Struct):
        members = [_shaped(inner, values, batch) for _, inner in kind.members]
        return tuple_type(str(kind), tuple(name for name, _ in kind.members))(*members)
    if isinstance(kind, Array):
        elements = [_shaped(kind.element, values, batch) for _ in range(kind.length)]
        return tuple(elements) if isinstance(elements[0], tuple) else np.stack(elements, axis=len(batch))
    value = next(values).reshape(batch + kind.shape)
    value = value.astype(np.bool_) if kind.base == "bool" else value
    return value if value.ndim else value[()]


def is_plane(kind: Type) -> bool:
    """Whether a result of this type is, without a copy, the very array that it was read back into."""
    return isinstance(kind, Numeric) and kind.base != "bool" and kind.rows * kind.columns <= 4


def arrays(result: Any) -> Iterator[np.ndarray]:
    """The arrays of a result, one after another."""
    if isinstance(result, tuple):
        for part in result:
            yield from arrays(part)
    else:
        yield result


def rebuilt(result: Any, parts: Iterator[np.ndarray]) -> Any:
    """A result of the same structure with other arrays."""
    if not isinstance(result, tuple):
        return next(parts)
    values = [rebuilt(part, parts) for part in result]
    return result._make(values) if hasattr(result, "_make") else tuple(values)


@cache  # to make a class takes longer than to evaluate a small batch
def tuple_type(name: str, fields: tuple[str, ...]) -> type:
    """A named tuple. What Python takes for no name becomes one: that of the type gets a _, of a field its place."""
    made = namedtuple(name + "_" * keyword.iskeyword(name), fields, rename=True)
    made.__repr__ = _readable
    made.__reduce__ = lambda value: (_made, (name, fields, *value))  # pickle does not find a class that no module has
    return made


def _made(name: str, fields: tuple[str, ...], *values) -> tuple:
    return tuple_type(name, fields)(*values)


def _readable(value: Any) -> str:
    """The repr of a named tuple: GLSL's name of the type, every member by its name, of long arrays the ends."""
    members = (f"{name}={_short(member)}" for name, member in zip(value._fields, value, strict=True))
    return f"{type(value).__name__}({', '.join(members)})"


def _short(value: Any) -> str:
    if isinstance(value, tuple):
        return repr(value) if hasattr(value, "_fields") else f"({', '.join(map(_short, value))})"
    text = _ends(np.asarray(value))
    return f"{text} {value.shape}" if "..." in text else text


def _ends(value: np.ndarray) -> str:
    """The numbers of an array, of long dimensions only the first and the last."""
    if not value.ndim:
        return str(value[()])
    if len(value) > _SHOWN:
        return f"[{_ends(value[0])}, ..., {_ends(value[-1])}]"
    return f"[{', '.join(map(_ends, value))}]"
