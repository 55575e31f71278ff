"""The inputs of a GLSL function as one flat batch: a name, such as ``m.albedo``, and an array for each numeric part."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import CallError
from ..language.leaf import Leaf, leaves
from ..language.signature import Array, Signature, Struct, Type

if TYPE_CHECKING:
    from ..calling.function import Function


def named_leaves(signature: Signature) -> dict[str, Leaf]:
    """The numeric parts of all that a caller gives, by dotted names, in the order of the parameters."""
    try:
        return {f"{p.name}{leaf.path}": leaf for p in signature.inputs for leaf in leaves(p.type)}
    except CallError as error:
        raise CallError(f"{error.message}; it is {signature}", *signature.origin) from None


@dataclass(frozen=True)
class Batch:
    """Inputs of one overload: ``flat[name]`` has the shape ``(*shape, *shape of the part)``; uniforms are apart."""

    signature: Signature
    flat: Mapping[str, np.ndarray]
    shape: tuple[int, ...]
    uniforms: Mapping[str, Any]

    @classmethod
    def of(cls, f: Function, inputs: Mapping[str, Any]) -> Batch:
        """The arguments of a call by name, rounded to what GLSL gets and broadcast. CallError when they do not fit."""
        signature, numbers, uniforms = f._overload((), dict(inputs))
        parts = named_leaves(signature)
        arrays = [array for p in signature.inputs for array in numbers[p.name]]
        own = [a.shape[: a.ndim - len(leaf.type.shape)] for a, leaf in zip(arrays, parts.values(), strict=True)]
        try:
            shape = np.broadcast_shapes(*own)
        except ValueError:
            listed = ", ".join(f"{name} {s}" for name, s in zip(parts, own, strict=True))
            raise CallError(f"the inputs do not broadcast: {listed}; it is {signature}", *signature.origin) from None
        flat = {}
        with np.errstate(over="ignore"):  # beyond float32 is Inf, as in GLSL
            for (name, leaf), array in zip(parts.items(), arrays, strict=True):
                flat[name] = np.broadcast_to(array.astype(leaf.dtype, copy=False), shape + leaf.type.shape)
        return cls(signature, flat, shape, uniforms)

    @property
    def size(self) -> int:
        """How many evaluations it asks for."""
        return math.prod(self.shape)

    def arguments(self) -> dict[str, Any]:
        """The keywords of the call, uniforms too."""
        nested = {p.name: _nested(p.type, p.name, self.flat, len(self.shape)) for p in self.signature.inputs}
        return {**nested, **self.uniforms}

    def element(self, index: Sequence[int]) -> Batch:
        """The inputs of one evaluation."""
        index = tuple(index)
        return replace(self, flat={name: array[index] for name, array in self.flat.items()}, shape=())

    def rows(self, chosen: Any) -> Batch:
        """Those of a one-dimensional batch that an index array, a mask or a slice chooses."""
        flat = {name: array[chosen] for name, array in self.flat.items()}
        return replace(self, flat=flat, shape=next(iter(flat.values())).shape[:1])

    def expected(self, reference: Callable) -> Any:
        """What a reference makes of the same inputs, as rounded: float64 arrays, by position; uniforms by name."""
        doubles = {
            name: array.astype(np.float64) if array.dtype.kind == "f" else array for name, array in self.flat.items()
        }
        nested = [_nested(p.type, p.name, doubles, len(self.shape)) for p in self.signature.inputs]
        if isinstance(reference, elementwise):
            return reference.over(nested, self.shape, self.uniforms)
        return reference(*nested, **self.uniforms)


def _nested(kind: Type, path: str, flat: Mapping[str, np.ndarray], dimensions: int) -> Any:
    """The value of a type from its flat parts: dicts for structs, one array for an array of numbers."""
    if isinstance(kind, Struct):
        return {name: _nested(member, f"{path}.{name}", flat, dimensions) for name, member in kind.members}
    if isinstance(kind, Array):
        elements = [_nested(kind.element, f"{path}[{k}]", flat, dimensions) for k in range(kind.length)]
        return np.stack(elements, axis=dimensions) if all(isinstance(e, np.ndarray) for e in elements) else elements
    array = np.asarray(flat[path])
    return array != 0 if kind.base == "bool" else array


def results(value: Any, name: str = "result") -> dict[str, np.ndarray]:
    """What a call or a reference returned as flat arrays: named tuples and dicts by member, other tuples by place."""
    if hasattr(value, "_asdict"):
        value = value._asdict()
    if isinstance(value, tuple):
        value = {f"[{k}]": member for k, member in enumerate(value)}
    if not isinstance(value, Mapping):
        return {name: np.asarray(value)}
    flat = {}
    for member, inner in value.items():
        outer = "" if name == "result" else name
        joined = f"{outer}{member}" if member.startswith("[") or not outer else f"{outer}.{member}"
        flat |= results(inner, joined)
    return flat


class elementwise:  # noqa: N801
    """A reference that takes one input at a time, as mpmath does: ``assert_ulp(f, elementwise(exact), ...)``.

    It gets numbers as float, vectors and matrices as float64 arrays, structs as dicts, and returns a number (mpmath's
    too) or an array; what comes of it is float64.
    """

    def __init__(self, reference: Callable):
        self.reference = reference

    def __call__(self, *arguments: Any, **uniforms: Any) -> Any:
        """The reference at one input."""
        return self.reference(*arguments, **uniforms)

    def over(self, arguments: Sequence[Any], shape: tuple[int, ...], uniforms: Mapping[str, Any]) -> np.ndarray:
        """The reference at each of the inputs: an array (*shape, ...)."""
        each = [self.reference(*(_one(a, index) for a in arguments), **uniforms) for index in np.ndindex(shape)]
        made = np.array(each, np.float64)
        return made.reshape(shape + made.shape[1:])


def _one(argument: Any, index: tuple[int, ...]) -> Any:
    if isinstance(argument, Mapping):
        return {name: _one(member, index) for name, member in argument.items()}
    if isinstance(argument, list):
        return [_one(member, index) for member in argument]
    value = argument[index]
    return value if np.ndim(value) else value.item()
