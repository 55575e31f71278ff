"""``assert_finite``: that a function gives numbers everywhere in a domain, and computes with nothing but numbers."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..searching.domain import inputs_of
from ..searching.inputs import Batch, results
from .failure import in_function, numbers

if TYPE_CHECKING:
    from ..calling.function import Function

_TRACED = 1 << 16  # inputs traced at once: every local of each is held in memory


def assert_finite(
    f: Function,
    domain: Mapping[str, Any],
    n: int = 100_000,
    seed: int = 0,
    *,
    nonnegative: bool = False,
    intermediates: bool = True,
    may_overflow: Collection[str] = (),
) -> None:
    """Fails when a result of ``f`` is NaN or infinite, or is negative with ``nonnegative``, at any of ``n`` inputs.

        assert_finite(brdf.shade, {"l": "unit", "v": "unit", "n": [0, 0, 1], "m.albedo": "color", ...})

    ``domain`` says where they come from (searching/domain.py): its edges in every combination, or ``n``/2 of those, and
    others by chance; given values alone, each row once. With ``intermediates`` every local, parameter and returned
    value on the way has to be finite as well: max(NaN, 0) is 0, and hides what went wrong. Those named in
    ``may_overflow`` may be infinite, though not NaN: what is meant to be cut off. The message names the value, its file
    and line, and the input, and has the command that repeats it. AssertionError, or DomainError.
    """
    __tracebackhide__ = True  # pytest shows the test's own line
    batch = inputs_of(f, domain, n, seed)
    returned = results(f(**batch.arguments()))
    _check_results(f, batch, returned, nonnegative, intermediates)
    if intermediates:
        for first in range(0, batch.size, _TRACED):
            _check_locals(f, batch.rows(slice(first, first + _TRACED)), may_overflow)


def _wrong(values: np.ndarray, nonnegative: bool, dimensions: int = 1) -> np.ndarray:
    """Which evaluations have a number in ``values`` (batch, ...) that is not finite, or is negative and must not."""
    if values.dtype.kind != "f":
        return np.zeros(values.shape[:dimensions], bool)
    wrong = ~np.isfinite(values) | (nonnegative & (values < 0))
    return wrong.reshape(*values.shape[:dimensions], -1).any(axis=-1)


def _check_results(
    f: Function, batch: Batch, returned: Mapping[str, np.ndarray], nonnegative: bool, intermediates: bool
) -> None:
    for name, values in returned.items():
        wrong = _wrong(values, nonnegative)
        if not wrong.any():
            continue
        index = int(np.argmax(wrong))
        what = "not finite, or negative" if nonnegative else "not finite"
        message = f"{name} is {what} at {wrong.sum()} of {batch.size} inputs; the first: {numbers(values[index])}"
        if intermediates and (born := _first_local(f, batch.element((index,)))):
            message += f", from {born}"
        raise AssertionError(in_function(message, f, batch, (index,)))


def _first_local(f: Function, element: Batch) -> str | None:
    for local in f.trace(**element.arguments()):
        if not np.isfinite(local.values).all() and local.executed.all():
            return f"{local.name} at {local.file}:{local.line}"
    return None


def _check_locals(f: Function, batch: Batch, may_overflow: Collection[str]) -> None:
    for local in f.trace(**batch.arguments()):
        values = np.asarray(local.values)
        suspect = np.where(np.isinf(values), 0.0, values) if local.name in may_overflow else values
        wrong = _wrong(suspect, False) & local.executed
        if wrong.any():
            index = int(np.argmax(wrong))
            message = (
                f"{local.name} is not finite at {wrong.sum()} of {batch.size} inputs, though the result is; the first: "
                f"{numbers(values[index])}, at {local.file}:{local.line}"
            )
            raise AssertionError(in_function(message, f, batch, (index,)))
