"""The line for a shell that evaluates a GLSL function once: ``harness call FILE FUNCTION NAME=VALUE ...``."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

import numpy as np

from . import values
from .arguments import dense
from .batches import common_batch
from .errors import CallError
from .evaluation import leaves
from .library import Library
from .overloads import Chosen, key
from .signature import Array, Struct, Type


def line(library: Library, chosen: Chosen, mode: str, index: int | tuple[int, ...] | None) -> str:
    """The line for one element of a call's batch. CallError where it is not said which."""
    signature = chosen.signature
    several = sum(other.name == signature.name for other in library.signatures) > 1
    words = ["harness", "call", library.path, key(signature) if several else signature.name]
    for name, text in single(chosen, index):
        words.append(f"{name}={text}")
    for name, value in chosen.rest.items():
        words.append(f"{name}={values.written(value)}")
    for name, text in library.defines.items():
        words += ["-D", f"{name}={text}"]
    for folder in library.include_dirs:
        words += ["-I", folder]
    if mode != "as-written":
        words += ["--mode", mode]
    return shlex.join(words)


def single(chosen: Chosen, index: int | tuple[int, ...] | None) -> list[tuple[str, str]]:
    """(name, value as text) of the arguments of one element; members of structures by their own names."""
    signature = chosen.signature
    given = [
        (leaf, array)
        for p in signature.inputs
        for leaf, array in zip(leaves(p.type), chosen.numbers[p.name], strict=True)
    ]
    batch = common_batch([array.shape[: array.ndim - len(leaf.type.shape)] for leaf, array in given])
    if index is None and batch:
        message = f"{signature.name} is given a batch {batch}: say by an index which evaluation is meant"
        raise CallError(message, *signature.origin)
    place = index if index is not None else ()
    try:
        place = place if isinstance(place, tuple) else np.unravel_index(place, batch or (1,))[: len(batch)]
        if len(place) != len(batch):
            raise IndexError
        one = iter([np.broadcast_to(array, batch + leaf.type.shape)[place] for leaf, array in given])
    except (IndexError, ValueError):
        raise CallError(f"no element {index} in a batch {batch}", *signature.origin) from None
    return [pair for p in signature.inputs for pair in _pairs(p.type, p.name, one)]


def _pairs(kind: Type, name: str, numbers: Iterator[np.ndarray]) -> Iterator[tuple[str, str]]:
    if isinstance(kind, Struct):
        for member, inner in kind.members:
            yield from _pairs(inner, f"{name}.{member}", numbers)
    elif isinstance(kind, Array) and not dense(kind):
        for k in range(kind.length):
            yield from _pairs(kind.element, f"{name}[{k}]", numbers)
    else:
        yield name, values.written(_whole(kind, numbers))


def _whole(kind: Type, numbers: Iterator[np.ndarray]) -> np.ndarray:
    """One value: an array of numbers has a leaf for each of its elements."""
    if isinstance(kind, Array):
        return np.stack([_whole(kind.element, numbers) for _ in range(kind.length)])
    return next(numbers)
