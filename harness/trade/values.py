"""Evaluates GLSL functions for the trade: on float32 inputs as every call does, or in double on inputs in double."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..calling.function import Function
from ..comparing.failure import hexadecimal
from ..errors import CallError
from ..language.signature import Signature
from ..searching import inputs
from ..searching.inputs import Batch

Flat = Mapping[str, np.ndarray]


def only(function: Function) -> Signature:
    """The signature of a function that is not overloaded. CallError of one that is."""
    if len(function.signatures) > 1:
        raise CallError(f"{function.__name__} is overloaded, so there is not one to be measured", *function.origin)
    return function.signatures[0]


def values(function: Function, flat: Flat) -> np.ndarray:
    """All numbers that a function yields, (n, numbers) float64, in the function's mode.

    ``flat`` maps its numeric parts (``inputs.named_leaves``) to arrays (n, *shape of the part). In every mode but
    double they are rounded to float32, which is what GLSL gets; in double they go in as they are, so that a vector can
    be of length 1 to 16 digits, and what differs between two formulas is the formulas.
    """
    signature = only(function)
    count = len(next(iter(flat.values())))
    if function.mode != "double":
        rounded = {name: np.asarray(array, leaf.dtype) for (name, leaf), array in _paired(signature, flat)}
        found = inputs.results(function(**Batch(signature, rounded, (count,), {}).arguments()))
        return np.concatenate([array.reshape(count, -1) for array in found.values()], axis=1).astype(np.float64)
    evaluation = function._ready(signature, {})
    arrays = {
        buffer: np.ascontiguousarray(flat[f"{parameter}{leaf.path}"], np.float64 if leaf.dtype.kind == "f" else None)
        .reshape(count, -1)
        for parameter, buffers in evaluation.inputs
        for buffer, leaf in buffers
    }  # fmt: skip
    parts = [part for output in evaluation.run(arrays, count) for part in output]
    return np.concatenate(parts, axis=1).astype(np.float64)


def _paired(signature: Signature, flat: Flat):
    return (((name, leaf), flat[name]) for name, leaf in inputs.named_leaves(signature).items())


def rounded(flat: Flat) -> dict[str, np.ndarray]:
    """The inputs as GLSL gets them: floats rounded to float32."""
    return {name: a.astype(np.float32) if a.dtype.kind == "f" else a for name, a in flat.items()}


def shown(flat: Flat, index: int) -> dict[str, dict[str, object]]:
    """One of the inputs by name, as numbers (``at``) and in hexadecimal (``hex``); vectors as lists."""
    element = {name: array[index] for name, array in flat.items()}
    return {
        "at": {name: value.tolist() for name, value in element.items()},
        "hex": {name: _in_hexadecimal(value) for name, value in element.items()},
    }


def _in_hexadecimal(value: np.ndarray) -> object:
    if np.ndim(value):
        return [_in_hexadecimal(part) for part in value]
    return hexadecimal(value) if value.dtype.kind == "f" else str(value)
