"""Arguments of a GLSL function: from numpy's arrays, dicts and tuples to the arrays of numbers they are made of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import CallError, did_you_mean
from ..language.leaf import leaves
from ..language.signature import DTYPES, Array, Numeric, Opaque, Parameter, Signature, Struct, Type
from .results import tuple_type
from .texture_argument import SAMPLERS, Texture


def bind(signature: Signature, args: Sequence, kwargs: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Arguments by parameter name, and the keywords that name no parameter. CallError when one is missing or twice."""
    names = [p.name for p in signature.inputs]
    if len(args) > len(names):
        raise CallError(f"{signature.name} takes {counted(len(names), 'argument')}, got {len(args)}")
    given = dict(zip(names, args, strict=False))
    rest = {}
    for name, value in kwargs.items():
        if name in given:
            raise CallError(f"{signature.name} got {name} twice")
        (given if name in names else rest)[name] = value
    missing = [name for name in names if name not in given]
    if missing:
        hint = next((hint for name in rest if (hint := did_you_mean(name, missing))), "")
        got = f", got {', '.join(rest)}" if rest else ""
        raise CallError(f"{signature.name} lacks {', '.join(missing)}{got}{hint}")
    return given, rest


def numbers(parameter: Parameter, value: Any) -> list[np.ndarray] | Texture:
    """The leaves of an argument, in the order of ``leaves``: arrays (..., *shape of the leaf). A texture as it is.

    No number is copied that lies in an array already. CallError says what was expected and what was got.
    """
    if isinstance(parameter.type, Opaque) and parameter.type.name in SAMPLERS:
        if not isinstance(value, Texture):
            raise CallError(f"{parameter.name} is a {parameter.type}: a harness.Texture, got {type(value).__name__}")
        return value
    return list(_leaf_arrays(parameter.type, value, parameter.name))


def conversions(signature: Signature, given: Mapping[str, list[np.ndarray]]) -> int:
    """How many leaves of the arguments are not of the parameter's own base type."""
    return sum(
        array.dtype.kind != np.dtype(DTYPES[leaf.type.base]).kind
        for p in numeric(signature)
        for leaf, array in zip(leaves(p.type), given[p.name], strict=True)
    )


def numeric(signature: Signature) -> list[Parameter]:
    """The parameters that are given as arrays, those that are textures left out."""
    return [p for p in signature.inputs if not isinstance(p.type, Opaque)]


def dense(kind: Type) -> tuple[Numeric, tuple[int, ...]] | None:
    """The numbers and the shape of a type that is one array in numpy; None for what holds a structure."""
    if isinstance(kind, Array) and (inner := dense(kind.element)):
        return inner[0], (kind.length, *inner[1])
    return (kind, kind.shape) if isinstance(kind, Numeric) and kind.base in DTYPES else None


def array(number: Numeric, shape: tuple[int, ...], value: Any, name: str, kind: Type) -> np.ndarray:
    """A numeric argument as an array whose last dimensions are ``shape`` and whose numbers the type can hold."""
    try:
        made = np.asarray(value)
    except ValueError as error:
        raise CallError(f"{name} is no array: {error}") from None
    allowed = {"float": "fiub", "int": "iu", "uint": "iu", "bool": "b"}[number.base]
    if made.dtype.kind not in allowed:
        raise CallError(f"{name} is {a(kind)}, got {_described(made)}")
    if len(shape) > made.ndim or made.shape[made.ndim - len(shape) :] != shape:
        dimensions = ", ".join(["...", *map(str, shape)])
        raise CallError(f"{name} is {a(kind)}: an array of shape ({dimensions}), got {made.shape}")
    if number.base in ("int", "uint") and made.size:
        limits = np.iinfo(DTYPES[number.base])
        if made.min() < limits.min or made.max() > limits.max:
            raise CallError(f"{name} is {a(kind)}: {limits.min} ... {limits.max}, got a number beyond")
    return made


def a(kind: Type) -> str:
    """The name of a type after its article."""
    return f"{'an' if str(kind)[0].lower() in 'aeio' else 'a'} {kind}"


def counted(number: int, what: str) -> str:
    """``1 argument``, ``2 arguments``."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def _described(made: np.ndarray) -> str:
    """What an array of the wrong type is, in the terms of who gave it."""
    if made.dtype.kind == "O" and made.ndim == 0:
        if isinstance(made.item(), Iterator):
            return "an iterator: stream() takes one, chunk by chunk"
        return f"{made.item()!r}" if made.item() is None else f"an object of type {type(made.item()).__name__}"
    nan = " (nan among them)" if made.dtype.kind == "f" and np.isnan(made).any() else ""
    return f"numbers of type {made.dtype}{nan}"


def _leaf_arrays(kind: Type, value: Any, name: str) -> Iterator[np.ndarray]:
    if isinstance(kind, Struct):
        members = _members(kind, value, name)
        for member, inner in kind.members:
            yield from _leaf_arrays(inner, members[member], f"{name}.{member}")
    elif isinstance(kind, Numeric) and kind.base in DTYPES:
        yield array(kind, kind.shape, value, name, kind)
    elif found := dense(kind):  # an array of numbers
        whole = array(*found, value, name, kind)
        batch = whole.ndim - len(found[1])
        for place in np.ndindex(found[1][: len(found[1]) - len(found[0].shape)]):
            yield whole[(slice(None),) * batch + place]
    elif isinstance(kind, Array):
        if not isinstance(value, Sequence) or len(value) != kind.length:
            got = len(value) if isinstance(value, Sequence) else type(value).__name__
            raise CallError(f"{name} is {a(kind)}: {counted(kind.length, 'value')}, got {got}")
        for k in range(kind.length):
            yield from _leaf_arrays(kind.element, value[k], f"{name}[{k}]")
    else:
        raise CallError(f"{name} is {a(kind)}, which cannot be given as an array")


def _members(kind: Struct, value: Any, name: str) -> Mapping[str, Any]:
    """The members of a structure given as a dict, or as what a function returned."""
    wanted = [member for member, _ in kind.members]
    members = value._asdict() if hasattr(value, "_asdict") else value
    if getattr(value, "_fields", None) == tuple_type(str(kind), tuple(wanted))._fields:
        members = dict(zip(wanted, value, strict=True))
    if isinstance(members, Mapping) and set(members) == set(wanted):
        return members
    expected = f"{name} is {a(kind)}: a dict of {', '.join(wanted)}"
    if not isinstance(members, Mapping):
        raise CallError(f"{expected}, got {type(value).__name__}")
    unknown = [str(member) for member in members if member not in wanted]
    hint = next((hint for member in unknown if (hint := did_you_mean(member, wanted))), "")
    raise CallError(f"{expected}, got {', '.join(map(str, members)) or 'none'}{hint}")
