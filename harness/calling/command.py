"""The line for a shell that evaluates a GLSL function once: ``harness call FILE FUNCTION NAME=VALUE ...``."""

from __future__ import annotations

import shlex
from collections.abc import Iterator

import numpy as np

from ..errors import CallError
from ..language import values
from ..language.leaf import leaves
from ..language.signature import Array, Struct, Type
from .arguments import dense, numeric
from .batches import common_batch
from .library import Library
from .overloads import Chosen, key
from .texture_argument import Texture


def line(library: Library, chosen: Chosen, mode: str, index: int | tuple[int, ...] | None) -> str:
    """The line for one element of a call's batch. CallError where it is not said which."""
    signature = chosen.signature
    several = sum(other.name == signature.name for other in library.signatures) > 1
    words = ["harness", "call", library.path, key(signature) if several else signature.name]
    for name, text in single(chosen, index):
        words.append(f"{name}={text}")
    for name, value in chosen.rest.items():
        words.append(f"{name}={_texture(name, value) if isinstance(value, Texture) else values.written(value)}")
    for p in signature.inputs:
        if isinstance(chosen.numbers[p.name], Texture):
            words.append(f"{p.name}={_texture(p.name, chosen.numbers[p.name])}")
    for name, text in library.defines.items():
        words += ["-D", f"{name}={text}"]
    for folder in library.include_dirs:
        words += ["-I", folder]
    if mode != "as-written":
        words += ["--mode", mode]
    return shlex.join(words)


def _texture(name: str, texture: Texture) -> str:
    """A texture as ``harness call`` takes it. CallError where it cannot be had from a file alone."""
    if texture.file is None:
        raise CallError(f"{name} is {texture}, which no command line can give: only a picture's file, all else default")
    return texture.file


def single(chosen: Chosen, index: int | tuple[int, ...] | None) -> list[tuple[str, str]]:
    """(name, value as text) of the arguments of one element; members of structures by their own names."""
    signature = chosen.signature
    given = [
        (leaf, array)
        for p in numeric(signature)
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
    return [pair for p in numeric(signature) for pair in _pairs(p.type, p.name, one)]


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
