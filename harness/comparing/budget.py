"""``error_budget``: how much of a function's error is the model's, and how much is its arithmetic's."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import CompareError
from ..searching.domain import inputs_of
from ..searching.inputs import Batch, results
from .failure import hexadecimal, shown_inputs
from .ulp import distance, ulp_difference

if TYPE_CHECKING:
    from ..calling.function import Function


@dataclass(frozen=True)
class Spread:
    """The largest of many errors, what 99 of 100 stay below, and the median. inf: not a number where one should be."""

    max: float
    p99: float
    median: float

    @classmethod
    def of(cls, errors: np.ndarray) -> Spread:
        """Of an array; with values that occur in it, so that an inf stays one error among many."""
        return cls(float(errors.max()), *(float(np.quantile(errors, q, method="higher")) for q in (0.99, 0.5)))


@dataclass(frozen=True)
class Part:
    """One part of the error: absolute, relative to what is right, and in ulps of ``precision``; ``worst`` is its input.

    ``got`` and ``want`` are what there was, and should have been, at the worst input (by ulps).
    """

    absolute: Spread
    relative: Spread
    ulp: Spread
    precision: str
    worst: Batch
    got: float
    want: float


@dataclass(frozen=True)
class ErrorBudget:
    """The parts of a function's error at ``count`` inputs.

    ``model``: the source in double against the reference. ``round_off[mode]``: each mode against the source in double.
    """

    name: str
    count: int
    model: Part
    round_off: Mapping[str, Part]

    def __str__(self):
        kinds = ("absolute", "relative", "ulp")
        rows = [["", *(f"{kind} {what}" for kind in kinds for what in ("max", "p99", "median"))]]
        parts = {"model": self.model, **{f"round-off, {mode}": part for mode, part in self.round_off.items()}}
        for name, part in parts.items():
            spreads = [getattr(part, kind) for kind in kinds]
            rows.append([name, *(f"{v:.3g}" for s in spreads for v in (s.max, s.p99, s.median))])
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        table = ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]) for row in rows]
        worst = [
            f"{name}, worst: {', '.join(shown_inputs(part.worst))}: got {part.got!r} ({hexadecimal(part.got)}), "
            f"want {part.want!r} ({hexadecimal(part.want)}), {part.ulp.max:.3g} ulp of {part.precision}"
            for name, part in parts.items()
        ]
        return "\n".join([f"{self.name}, {self.count} inputs", *table, *worst])

    __repr__ = __str__


def error_budget(
    f: Function,
    reference: Callable,
    inputs: Mapping[str, Any],
    *,
    modes: Sequence[str] = ("as-written", "precise"),
    n: int = 10_000,
    seed: int = 0,
) -> ErrorBudget:
    """Splits the error of ``f`` against ``reference`` into the model's and that of its arithmetic in each of ``modes``.

    The *model* error is what the source in double, where rounding hardly counts, is off the reference: approximations,
    truncated series, constants of few digits. The *round-off* is what the source in another mode is off itself in
    double. ``reference`` gets the inputs as rounded to float32, as float64 arrays and by position (one by one:
    ``elementwise``). ``inputs`` are arrays or domains (harness/searching/domain.py), from which ``n`` are drawn. The
    ulps are float32's, and float16's for "mediump". CompareError when results and reference do not fit.
    """
    batch = inputs_of(f, inputs, n, seed)
    double = results(f.with_mode("double")(**batch.arguments()))
    exact = results(batch.expected(reference))
    round_off = {}
    for mode in modes:
        got = results(f.with_mode(mode)(**batch.arguments()))
        round_off[mode] = _part(got, double, batch, "float16" if mode == "mediump" else "float32")
    return ErrorBudget(f.__name__, batch.size, _part(double, exact, batch, "float32"), round_off)


def _part(got: Mapping[str, np.ndarray], want: Mapping[str, np.ndarray], batch: Batch, precision: str) -> Part:
    if len(got) != len(want):
        raise CompareError(f"{', '.join(got)} were returned, and {', '.join(want)} expected")
    pairs = []
    for (name, g), w in zip(got.items(), want.values(), strict=True):
        w = np.asarray(w, np.float64)
        if w.shape != g.shape:
            raise CompareError(f"{name} has the shape {g.shape}, and {w.shape} is expected")
        pairs.append((g.reshape(batch.size, -1).astype(np.float64), w.reshape(batch.size, -1)))
    g, w = (np.concatenate(side, axis=1) for side in zip(*pairs, strict=True))
    off, ulps = distance(g, w), ulp_difference(g, w, precision)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        relative = np.where(off == 0, 0.0, np.where(np.isfinite(w), off / np.abs(w), np.inf))
    row, column = np.unravel_index(np.argmax(ulps), ulps.shape)
    return Part(
        *(Spread.of(errors) for errors in (off, relative, ulps)),
        precision,
        batch.element((int(row),)),
        float(g[row, column]),
        float(w[row, column]),
    )
