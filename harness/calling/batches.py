"""Evaluates a GLSL function for the elements of a batch: broadcasts, and cuts what would need copies into blocks.

What is in place already (numbers of GLSL's own types, one after another) goes through in one piece, without a copy.
Everything else, memory-mapped files too, is converted a block at a time, so that memory beyond the arguments and the
results does not grow with the batch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import CallError
from ..language.leaf import Leaf
from ..language.signature import Signature
from . import results
from .arguments import counted
from .evaluation import Evaluation

BLOCK = 1 << 18  # elements: the cost of starting a block is lost in it, and its buffers are a few MiB


@dataclass(frozen=True)
class _Input:
    """The numbers of a leaf, as they were given: an array (*batch, *shape of the leaf)."""

    buffer: str
    name: str
    leaf: Leaf
    array: np.ndarray

    @property
    def batch(self) -> tuple[int, ...]:
        return self.array.shape[: self.array.ndim - len(self.leaf.type.shape)]


def evaluate(evaluation: Evaluation, arguments: Mapping[str, list[np.ndarray]], out: Any = None) -> Any:
    """The result for arguments given as leaves by parameter name. CallError when they do not broadcast.

    ``out``: an array, or a tuple of arrays, of the result's shapes that it is written into, and that is returned.
    """
    inputs = _inputs(evaluation, arguments)
    batch = _batch(evaluation.signature, inputs)
    if out is not None:
        return _into(evaluation, inputs, batch, out)
    if math.prod(batch) <= BLOCK or _in_place(evaluation.signature, inputs, batch):
        return _evaluate(evaluation, inputs, batch)
    blocks = _blocks(evaluation, inputs, batch)
    index, first = next(blocks)
    cut = len(batch) - sum(not isinstance(k, slice) for k in index)
    whole = [np.empty(batch + part.shape[cut:], part.dtype) for part in results.arrays(first)]
    _store(whole, index, first)
    for index, part in blocks:
        _store(whole, index, part)
    return results.rebuilt(first, iter(whole))


def at_once(evaluation: Evaluation, arguments: Mapping[str, list[np.ndarray]]) -> tuple[Any, tuple[int, ...]]:
    """The result of ``evaluate`` and the shape of the batch, all its elements in one piece."""
    inputs = _inputs(evaluation, arguments)
    batch = _batch(evaluation.signature, inputs)
    return _evaluate(evaluation, inputs, batch), batch


def _inputs(evaluation: Evaluation, arguments: Mapping[str, list[np.ndarray]]) -> list[_Input]:
    return [
        _Input(buffer, name, leaf, array)
        for name, buffers in evaluation.inputs
        for (buffer, leaf), array in zip(buffers, arguments[name], strict=True)
    ]


def common_batch(shapes: Sequence[tuple[int, ...]]) -> tuple[int, ...]:
    """The shape that shapes broadcast to. ValueError when they do not."""
    first = shapes[0] if shapes else ()
    return first if all(shape == first for shape in shapes) else np.broadcast_shapes(*shapes)


def _batch(signature: Signature, inputs: Sequence[_Input]) -> tuple[int, ...]:
    try:
        return common_batch([given.batch for given in inputs])
    except ValueError:
        shapes = ", ".join(f"{given.name}{given.leaf.path} {given.batch}" for given in inputs)
        message = f"the arguments do not broadcast: {shapes}; it is {signature}"
        raise CallError(message, *signature.origin) from None


def _in_place(signature: Signature, inputs: Sequence[_Input], batch: tuple[int, ...]) -> bool:
    """Whether neither arguments nor results need a copy."""
    return all(results.is_plane(kind) for _, kind in signature.outputs) and all(
        _is_single(given.array, len(given.batch))
        or (given.batch == batch and given.array.dtype == given.leaf.dtype and given.array.flags.c_contiguous)
        for given in inputs
    )


def _is_single(array: np.ndarray, batch_ndim: int) -> bool:
    """Whether one value is repeated over the whole batch."""
    if not batch_ndim:
        return True
    pairs = zip(array.shape[:batch_ndim], array.strides[:batch_ndim], strict=True)
    return array.size > 0 and all(n == 1 or stride == 0 for n, stride in pairs)


def _evaluate(evaluation: Evaluation, inputs: Sequence[_Input], batch: tuple[int, ...]) -> Any:
    """The result for a batch that is small, or needs no copies."""
    flat = {given.buffer: _flat(given, batch) for given in inputs}
    return results.shaped(evaluation.signature, evaluation.run(flat, math.prod(batch)), batch)


def _flat(given: _Input, batch: tuple[int, ...]) -> np.ndarray:
    """An array (count, size), or (1, size) where one value is repeated, of the leaf's numbers."""
    leaf, array, own = given.leaf, given.array, given.batch
    if _is_single(array, len(own)):
        array = array[(0,) * len(own)]
    elif own != batch:
        array = np.broadcast_to(array, batch + leaf.type.shape)
    if array.dtype != leaf.dtype:
        with np.errstate(over="ignore"):  # beyond float32 is Inf, as in GLSL
            array = array.astype(leaf.dtype)
    return np.ascontiguousarray(array).reshape(-1, leaf.size)


def _blocks(
    evaluation: Evaluation, inputs: Sequence[_Input], batch: tuple[int, ...]
) -> Iterator[tuple[tuple[int | slice, ...], Any]]:
    """Cuts a batch into blocks of at most BLOCK elements: the index of each, and its result."""
    axis, inner = 0, math.prod(batch[1:])
    while inner > BLOCK:
        axis += 1
        inner //= batch[axis]
    step = max(1, BLOCK // inner)
    views = [(given, np.broadcast_to(given.array, batch + given.leaf.type.shape)) for given in inputs]
    for outer in np.ndindex(batch[:axis]):
        for first in range(0, batch[axis], step):
            index = (*outer, slice(first, first + step))
            part = [_Input(given.buffer, given.name, given.leaf, view[index]) for given, view in views]
            yield index, _evaluate(evaluation, part, (min(step, batch[axis] - first), *batch[axis + 1 :]))


def _into(evaluation: Evaluation, inputs: Sequence[_Input], batch: tuple[int, ...], out: Any) -> Any:
    whole = list(results.arrays(out))
    inputs = [_apart(given, whole) for given in inputs]
    if math.prod(batch) <= BLOCK:
        blocks = iter([((slice(None),) * len(batch), _evaluate(evaluation, inputs, batch))])
    else:
        blocks = _blocks(evaluation, inputs, batch)
    for n, (index, part) in enumerate(blocks):
        if n == 0:
            cut = len(batch) - sum(not isinstance(k, slice) for k in index)
            _check_out(evaluation.signature, whole, [(batch + p.shape[cut:], p.dtype) for p in results.arrays(part)])
        _store(whole, index, part)
    return out


def _apart(given: _Input, whole: Sequence[Any]) -> _Input:
    """The argument, copied where writing the result would change what of it is still to be read."""
    for array in (array for array in whole if isinstance(array, np.ndarray)):
        same = given.array.__array_interface__ == array.__array_interface__
        if not same and np.may_share_memory(given.array, array):
            return _Input(given.buffer, given.name, given.leaf, given.array.copy())
    return given


def _check_out(signature: Signature, whole: Sequence[Any], wanted: Sequence[tuple[tuple[int, ...], np.dtype]]) -> None:
    if len(whole) != len(wanted):
        raise CallError(f"out: {signature} yields {counted(len(wanted), 'array')}, got {len(whole)}", *signature.origin)
    for array, (shape, dtype) in zip(whole, wanted, strict=True):
        if not isinstance(array, np.ndarray):
            raise CallError(f"out is an array of shape {shape}, got {type(array).__name__}", *signature.origin)
        if array.shape != shape or not np.can_cast(dtype, array.dtype, "same_kind"):
            message = f"out is an array of shape {shape} of {dtype}, got {array.shape} of {array.dtype}"
            raise CallError(message, *signature.origin)
        if not array.flags.writeable:
            raise CallError("out is read-only", *signature.origin)


def _store(whole: Sequence[np.ndarray], index: tuple[int | slice, ...], part: Any) -> None:
    for array, values in zip(whole, results.arrays(part), strict=True):
        array[index] = values
