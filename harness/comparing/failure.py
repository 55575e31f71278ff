"""The report of a failure: how many, the worst in decimal and hexadecimal, where it is, and how to repeat it."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..searching.inputs import Batch

if TYPE_CHECKING:
    from ..calling.function import Function


@dataclass(frozen=True)
class Comparison:
    """One result beside its expectation: what is ``bad``, how ``severe`` (inf: no number), and words for both."""

    name: str
    got: np.ndarray
    want: np.ndarray
    bad: np.ndarray
    severity: np.ndarray
    said: str
    detail: Callable[[tuple[int, ...]], str]


def fail(comparisons: Sequence[Comparison], function: Function | None = None, batch: Batch | None = None) -> None:
    """AssertionError when anything is bad; the message shows the worst of all, in the results' order where equal."""
    __tracebackhide__ = True  # pytest shows the test's own line
    failed = [c for c in comparisons if c.bad.any()]
    if not failed:
        return
    worst = max(failed, key=lambda c: np.max(c.severity[c.bad]))
    place = np.unravel_index(np.argmax(np.where(worst.bad, worst.severity, -1.0)), worst.bad.shape)
    index = tuple(map(int, place))
    bad, total = sum(int(c.bad.sum()) for c in failed), sum(c.bad.size for c in comparisons)
    shown = f"{worst.name} at {index}" if worst.name else f"at {index}"
    message = (
        f"{bad} of {total} values are {worst.said}; the worst, {shown}: "
        f"got {number(worst.got[index])}, want {number(worst.want[index])}, {worst.detail(index)}"
    )
    if function is not None:
        message = in_function(message, function, batch, index[: len(batch.shape)])
    raise AssertionError(message)


def in_function(message: str, function: Function, batch: Batch, index: tuple[int, ...]) -> str:
    """A message led by the function's place and followed by one input and the command that evaluates it alone."""
    file, line = batch.signature.origin
    lines = [f"{file}:{line}: {batch.signature}: {message}", *shown_inputs(batch.element(index))]
    return "\n    ".join([*lines, function.command(batch.arguments(), index)])


def shown_inputs(element: Batch) -> list[str]:
    """The inputs of one evaluation, a line each, in decimal and hexadecimal."""
    uniforms = [f"{name} = {value}" for name, value in element.uniforms.items()]
    return [*(f"{name} = {numbers(value)}" for name, value in element.flat.items()), *uniforms]


def numbers(value: np.ndarray) -> str:
    """A number, vector or matrix, with all its digits: ``0.5 (0x1p-1)``, ``[1.0, 0.0] ([0x…, 0x…])``."""
    value = np.asarray(value)
    if not value.ndim:
        return number(value, short=True)
    if value.dtype.kind != "f":
        return _listed(value, str)
    return f"{_listed(value, str)} ({_listed(value, hexadecimal)})"


def hexadecimal(value: float) -> str:
    """As C's %a and float.fromhex() have it, without the zeros at the end: ``0x1.8p+1`` is 3."""
    return re.sub(r"\.?0+p", "p", float(value).hex(), count=1) if np.isfinite(value) and value else float(value).hex()


def number(value: np.generic, short: bool = False) -> str:
    """Decimal and hexadecimal of a float, decimal of the rest; ``short``: as few digits as tell float32 apart."""
    if np.asarray(value).dtype.kind != "f":
        return str(value)
    return f"{value if short else float(value)!s} ({hexadecimal(value)})"


def _listed(value: np.ndarray, text: Callable) -> str:
    if value.ndim:
        return f"[{', '.join(_listed(v, text) for v in value)}]"
    return text(value[()])
