"""``exhaustive``: a function of one float at every float32 of an interval, against a reference."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from .comparing.failure import number
from .comparing.ulp import PRECISIONS, ulp_difference
from .errors import CompareError, DomainError
from .language.signature import Numeric
from .processes import jobs
from .searching.goals import goals
from .searching.inputs import named_leaves
from .searching.spaces import Interval, from_ordered, ordered, space

if TYPE_CHECKING:
    from .calling.function import Function

_CHUNK = 1 << 20  # values computed at once
_SLICE = 1 << 24  # values of one piece of work


@dataclass(frozen=True)
class Worst:
    """The largest of an error, and where it is; nothing yet while ``size`` is negative."""

    size: float = -1.0
    at: float = math.nan
    got: float = math.nan
    want: float = math.nan

    def __str__(self):
        return f"{self.size:.4g} at {number(self.at)}: got {number(self.got)}, want {number(self.want)}"


@dataclass(frozen=True)
class Exhaustive:
    """What a function does over all of an interval.

    How many values were tried, at how many the result is not finite or negative (and the first of them), the largest
    error in ulps of float32 and as it is, and how often, and by how many ulps at most, the result goes back from one
    value to the next: against the direction from the first to the last.
    """

    count: int = 0
    non_finite: int = 0
    first_non_finite: float | None = None
    negative: int = 0
    first_negative: float | None = None
    ulp: Worst = Worst()
    absolute: Worst = Worst()
    backward: int = 0
    back: Worst = Worst()

    def __add__(self, other: Exhaustive) -> Exhaustive:
        """Both together; ``other`` has the larger values."""
        return Exhaustive(
            **{name: getattr(self, name) + getattr(other, name) for name in _COUNTS},
            **{name: a if (a := getattr(self, name)) is not None else getattr(other, name) for name in _FIRSTS},
            **{name: max(getattr(self, name), getattr(other, name), key=lambda w: w.size) for name in _WORST},
        )

    def __str__(self):
        lines = [f"{self.count} values", f"not finite: {self.non_finite}", f"negative: {self.negative}"]
        if self.first_non_finite is not None:
            lines[1] += f", first at {number(self.first_non_finite)}"
        if self.first_negative is not None:
            lines[2] += f", first at {number(self.first_negative)}"
        if self.ulp.size >= 0:
            lines += [f"largest error in ulps: {self.ulp}", f"largest absolute error: {self.absolute}"]
        steepest = f", in ulps by {self.back}" if self.backward else ""
        lines.append(f"going back from one value to the next: {self.backward} times{steepest}")
        return "\n".join(lines)


_COUNTS = ("count", "non_finite", "negative", "backward")
_FIRSTS = ("first_non_finite", "first_negative")
_WORST = ("ulp", "absolute", "back")


def exhaustive(
    f: Function,
    low: float,
    high: float,
    reference: Callable | None = None,
    *,
    stride: int = 1,
    flush_denormals: bool = True,
    scheduler: str | None = None,
    workers: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> Exhaustive:
    """``f`` at every float32 from ``low`` to ``high``, −0 too where 0 is, or at every ``stride``-th of them.

    ``f`` takes one float, or one vector, whose components it treats alike: each then carries another value. What it
    returns has the same shape. ``reference``, a function of a module, gets the same values as a float64 array (n,); it
    may be left out. 0 is right for what is below the smallest normal number or just above, unless
    ``flush_denormals=False``. The values stream through ``workers`` processes, or the Dask cluster at ``scheduler``;
    any number of them gives the same. DomainError, CompareError.
    """
    _width(f)
    start, end = map(int, ordered(np.float32([low, high])))
    if not (np.isfinite(low) and np.isfinite(high) and start <= end and stride >= 1):
        raise DomainError(f"every {stride}-th float from {low} to {high}: there are none")
    ends = _results(f, np.float32([low, high])).astype(np.float64)
    try:
        work = pickle.dumps((f, reference, flush_denormals, float(np.sign(ends[1] - ends[0]))))
    except (pickle.PicklingError, AttributeError) as error:
        raise CompareError(f"the reference has to be a function of a module, for other processes: {error}") from None
    starts = range(start, end + 1, _SLICE * stride)
    items = [_Piece(work, first, min(end, first + (_SLICE - 1) * stride), stride, first > start) for first in starts]
    parts: dict[int, Exhaustive] = {}
    alone = len(items) == 1 and scheduler is None  # not worth a process
    done = enumerate(map(_work, items)) if alone else jobs.run(_work, items, scheduler=scheduler, workers=workers)
    for k, part in done:
        parts[k] = part
        progress(len(parts) / len(items))
    total = Exhaustive()
    for k in range(len(items)):
        total += parts[k]
    return total


def exhaustive_goals(
    f: Function, domain: Mapping[str, Any], find: Sequence[str], max_ulp: float, **options: Any
) -> tuple[Exhaustive, bool]:
    """The same for a domain of one interval and the goals of a hunt; with "ulp" against the source in double.

    Returns with it whether anything that was looked for is there. DomainError where a goal needs other inputs.
    """
    signature, wanted = f.signatures[0], goals(find, max_ulp)
    _width(f)
    name = signature.inputs[0].name
    if set(domain) != {name} or not isinstance(domain[name], str):
        raise DomainError(f"{signature} at every float needs one interval, for {name}", *signature.origin)
    where = space(domain[name], name, named_leaves(signature)[name])
    if not isinstance(where, Interval):
        raise DomainError(f"{name}: every float of {domain[name]!r} is no interval")
    for goal in wanted:
        if goal.kind == "symmetric" or goal.names not in ((), (name,)):
            raise DomainError(f"{goal} has no meaning for one float")
    reference = f.with_mode("double") if any(goal.kind == "ulp" for goal in wanted) else None
    report = exhaustive(f, float(where.low), float(where.high), reference, **options)
    found = {
        "nonfinite": report.non_finite > 0,
        "negative": report.negative > 0,
        "ulp": report.ulp.size > max_ulp,
        "monotone": report.back.size > max_ulp,
    }
    return report, any(found[goal.kind] for goal in wanted)


def _width(f: Function) -> int:
    """How many values one evaluation takes."""
    signature = f.signatures[0]
    kinds = [p.type for p in signature.parameters] + [signature.result]
    if len(f.signatures) > 1 or len(kinds) != 2 or kinds[0] != kinds[1] or not _is_vector(kinds[0]):
        raise DomainError(f"{signature} is no function of one float or vector that returns the same", *signature.origin)
    return kinds[0].rows


def _is_vector(kind: Any) -> bool:
    return isinstance(kind, Numeric) and kind.base == "float" and kind.columns == 1


# ---- One piece -----------------------------------------------------------------------------------------------------


@lru_cache(maxsize=2)
def _loaded(work: bytes) -> tuple[Any, Any, bool, float]:
    """The same function for all pieces of a process: compiled once."""
    return pickle.loads(work)


@dataclass(frozen=True)
class _Piece:
    """From one place in the order of floats to another, both included; ``follows``: another piece ends just before."""

    work: bytes
    first: int
    last: int
    stride: int
    follows: bool


def _work(piece: _Piece) -> Exhaustive:
    f, reference, flush_denormals, direction = _loaded(piece.work)
    total = Exhaustive()
    first, stride = piece.first, piece.stride
    before = _results(f, from_ordered(np.array([first - stride]))) if piece.follows else np.empty(0, np.float32)
    for start in range(first, piece.last + 1, _CHUNK * stride):
        values = from_ordered(np.arange(start, min(piece.last, start + (_CHUNK - 1) * stride) + 1, stride))
        zero = np.flatnonzero(values == 0)
        values = np.insert(values, zero, np.float32(-0.0))  # the order of floats has one place for both zeros
        got = _results(f, values)
        total += _errors(values, got, reference, flush_denormals) + _steps(values, got, before, direction)
        before = got[-1:]
    return total


def _results(f: Function, values: np.ndarray) -> np.ndarray:
    """The function at float32 values (n,), as many of them at once as it takes."""
    width = _width(f)
    if width == 1:
        return f(values)
    padded = np.pad(values, (0, -len(values) % width), mode="edge")
    return f(padded.reshape(-1, width)).reshape(-1)[: len(values)]


def _errors(values: np.ndarray, got: np.ndarray, reference: Callable | None, flush_denormals: bool) -> Exhaustive:
    wrong, negative = ~np.isfinite(got), got < 0
    found = Exhaustive(
        count=len(values),
        non_finite=int(wrong.sum()),
        first_non_finite=float(values[np.argmax(wrong)]) if wrong.any() else None,
        negative=int(negative.sum()),
        first_negative=float(values[np.argmax(negative)]) if negative.any() else None,
    )
    if reference is None:
        return found
    want = _expected(reference, values)
    with np.errstate(invalid="ignore", over="ignore"):
        off = np.abs(got - want)
        ulps = off / _spacing(want)
    if flush_denormals:
        ulps[(got == 0) & (np.abs(want) < PRECISIONS["float32"].flushed_below)] = 0
    special = np.flatnonzero(~np.isfinite(ulps))
    ulps[special] = ulp_difference(got[special], want[special])
    off[special] = np.where(np.isfinite(ulps[special]), off[special], ulps[special])

    def worst(errors: np.ndarray) -> Worst:
        k = int(np.argmax(errors))
        return Worst(float(errors[k]), float(values[k]), float(got[k]), float(want[k]))

    return replace(found, ulp=worst(ulps), absolute=worst(np.where(np.isnan(off), 0.0, off)))


def _expected(reference: Callable, values: np.ndarray) -> np.ndarray:
    doubles = values.astype(np.float64)
    width = _width(reference) if hasattr(reference, "signatures") else 1  # the same source in double
    want = np.asarray(_results(reference, doubles) if width > 1 else reference(doubles), np.float64)
    if want.shape != values.shape:
        raise CompareError(f"the reference made the shape {want.shape} of {values.shape}")
    return want


def _spacing(want: np.ndarray) -> np.ndarray:
    """How far apart float32 are at each value: as ulp_difference() has it, and faster."""
    size = np.abs(want)
    rounded = size.astype(np.float32)
    spacing = np.spacing(rounded).astype(np.float64)
    power = np.flatnonzero((rounded.view(np.uint32) & 0x7FFFFF) == 0)  # of two: the value may lie below it
    below = power[rounded[power] > size[power]]
    spacing[below] = np.maximum(spacing[below] / 2, 2.0**-149)
    return spacing


def _steps(values: np.ndarray, got: np.ndarray, before: np.ndarray, direction: float) -> Exhaustive:
    """Where the result goes another way than ``direction``, 1 or -1, from one value to the next; 0: goes any way."""
    results = np.concatenate([before, got])
    lower, upper = results[:-1], results[1:]
    back = np.flatnonzero(upper != lower if direction == 0 else upper < lower if direction > 0 else upper > lower)
    if not len(back):
        return Exhaustive()
    ulps = ulp_difference(upper[back], lower[back])
    k = int(np.argmax(ulps))
    at = values[len(values) - len(upper) + back[k]]
    return Exhaustive(
        backward=len(back), back=Worst(float(ulps[k]), float(at), float(upper[back[k]]), float(lower[back[k]]))
    )
