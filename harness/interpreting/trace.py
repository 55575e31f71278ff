"""Every float that a GLSL function computes on the way to its result: finds where a hidden NaN begins."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import CallError
from ..language.glsl import Source
from ..language.signature import Signature
from . import trace_names
from .interpretation import Interpretation
from .interpreter_memory import Mask
from .interpreter_ops import Value
from .spirv import Type

#: the most that one trace may hold
BYTES_MAX = 2 << 30


@dataclass(frozen=True, eq=False)
class Local:
    """One assignment, operation, parameter or returned value, with its values for the whole batch.

    ``values`` has the batch's shape and then that of one value, (components) or (rows, columns); NaN where
    ``executed``, of the batch's shape, is False: there the statement was not reached. ``born`` says where a value that
    is not finite was made from operands that all are.
    """

    name: str
    file: str
    line: int
    values: np.ndarray
    executed: np.ndarray
    born: np.ndarray

    @property
    def non_finite(self) -> np.ndarray:
        """Where, over the batch, it was reached and a component of it is NaN or infinite."""
        return self.executed & ~_all_finite(self.values, self.executed.ndim)

    def __repr__(self):
        count = int(self.non_finite.sum())
        told = f", {count} of {self.executed.size} not finite" if count else ""
        return f"<{self.file}:{self.line}: {self.name}{told}>"


@dataclass(frozen=True, eq=False)
class Origin:
    """Where a value that is not finite begins: a Local, and the first element of the batch where it does."""

    local: Local
    element: tuple[int, ...]

    @property
    def name(self) -> str:
        """The Local's."""
        return self.local.name

    @property
    def file(self) -> str:
        """The Local's."""
        return self.local.file

    @property
    def line(self) -> int:
        """The Local's."""
        return self.local.line

    def __str__(self):
        value = self.local.values[self.element]
        where = f" at element {self.element if len(self.element) > 1 else self.element[0]}" if self.element else ""
        return f"{self.local.file}:{self.local.line}: {self.local.name} is {value}{where}"


class Trace(Sequence):
    """The Locals of one call, in the order in which they were computed; a loop has those of each round.

    ``result`` is what the call returns. ``trace["NoH"]`` are all Locals of that name.
    """

    def __init__(self, signature: Signature, result, locals_: Sequence[Local], finite: np.ndarray):
        """``finite`` says, over the batch, where all arguments are."""
        self.signature, self.result, self._locals, self._finite = signature, result, tuple(locals_), finite

    def __len__(self) -> int:
        return len(self._locals)

    def __iter__(self) -> Iterator[Local]:
        return iter(self._locals)

    def __getitem__(self, key):
        if isinstance(key, str):
            return [local for local in self._locals if local.name == key]
        return self._locals[key]

    def first_non_finite(self) -> Origin | None:
        """The first Local that became NaN or infinite where its own operands were finite; None where none did.

        Where there is none such, but something is not finite all the same although every argument is (a variable that
        was never assigned), it is the first that is.
        """
        for local in self._locals:
            if local.born.any():
                return Origin(local, _first(local.born))
        for local in self._locals:
            bad = local.non_finite & self._finite
            if bad.any():
                return Origin(local, _first(bad))
        return None

    def __repr__(self):
        rows = [("", "name", "min", "max", "not finite")]
        rows += [(f"{x.file}:{x.line}", x.name, *_range(x), str(int(x.non_finite.sum()) or "")) for x in self._locals]
        widths = [max(len(row[k]) for row in rows) for k in range(5)]
        lines = ["  ".join(f"{cell:{'>' if k > 1 else '<'}{widths[k]}}" for k, cell in enumerate(row)) for row in rows]
        origin = self.first_non_finite()
        told = [f"first not finite: {origin}"] if origin else []
        return "\n".join([f"trace of {self.signature}", *(line.rstrip() for line in lines), *told])


def _first(mask: np.ndarray) -> tuple[int, ...]:
    return tuple(int(k) for k in np.unravel_index(int(np.argmax(mask)), mask.shape)) if mask.ndim else ()


def _range(local: Local) -> tuple[str, str]:
    finite = local.values[np.isfinite(local.values)] if local.values.ndim else local.values
    return (f"{finite.min():.7g}", f"{finite.max():.7g}") if finite.size else ("", "")


def _all_finite(values: np.ndarray, dimensions: int) -> np.ndarray:
    return np.isfinite(values).all(axis=tuple(range(dimensions, values.ndim)))


class _Recorder:
    """Collects what the interpreter computes, for one chunk of a batch."""

    def __init__(self, lanes: int):
        self.lanes, self.events = lanes, []
        self.bytes = 0

    def __call__(self, name: str, kind: Type, line: int, value: Value, mask: Mask, inputs: list[Value] | None) -> None:
        """``inputs`` are the operands of the operation that made the value; None where none did."""
        if isinstance(value, list):
            members = kind.members if kind.kind == "struct" else [(str(k), kind.element) for k in range(kind.length)]
            form = "{}.{}" if kind.kind == "struct" else "{}[{}]"
            for (member, inner), part in zip(members, value, strict=True):
                self(form.format(name, member), inner, line, part, mask, None)
        elif value.dtype.kind == "f":
            self.bytes += value.size // value.shape[-1] * self.lanes * value.itemsize
            if self.bytes > BYTES_MAX:
                raise CallError(f"a trace of more than {BYTES_MAX >> 30} GiB: trace fewer elements at once")
            self.events.append((name, kind, line, value, mask, self._born(value, mask, inputs)))

    def _born(self, value: np.ndarray, mask: Mask, inputs: list[Value] | None) -> np.ndarray:
        if inputs is None:
            return np.zeros(self.lanes, bool)
        born = ~_finite_lanes(value)
        for operand in inputs:
            if not isinstance(operand, list) and getattr(operand, "dtype", np.dtype(int)).kind == "f" and born.any():
                born = born & _finite_lanes(operand)
        born = np.broadcast_to(born, self.lanes)
        return born if mask is None else born & mask


def _finite_lanes(value: np.ndarray) -> np.ndarray:
    return np.isfinite(value).all(axis=tuple(range(value.ndim - 1)))


class Tracing:
    """An engine of calls that records, with the face of ``interpretation.Interpretation``."""

    def __init__(self, source: Source, signature: Signature, precision: str):
        self.engine = Interpretation(source, signature, precision, trace_names.Names)
        self._source = source
        self.signature, self.inputs, self.outputs = signature, self.engine.inputs, self.engine.outputs
        self.uniforms = self.engine.uniforms
        self.array_length, self.set_uniform = self.engine.array_length, self.engine.set_uniform
        self.initial, self.reset_uniform = self.engine.initial, self.engine.reset_uniform
        self._events: list = []
        self._count = 0
        self._finite = np.ones(0, bool)

    def run(self, arrays: dict[str, np.ndarray], count: int) -> list[list[np.ndarray]]:
        """As ``Interpretation.run``, all elements at once."""
        recorder = _Recorder(count)
        self._count, self._events = count, recorder.events
        if not count:
            return self.engine.run(arrays, count)
        self._finite = np.ones(count, bool)
        for array in arrays.values():
            self._finite &= np.isfinite(array).all(axis=1)
        return self.engine.evaluate(arrays, slice(0, count), recorder)

    def trace(self, result, batch: tuple[int, ...]) -> Trace:
        """What the last run recorded, in the shape of its batch."""
        locals_ = [self._local(batch, *event) for event in self._events]
        return Trace(self.signature, result, locals_, self._finite.reshape(batch))

    def _local(self, batch, name: str, kind: Type, line: int, value: np.ndarray, mask: Mask, born: np.ndarray) -> Local:
        full = np.broadcast_to(value, (*value.shape[:-1], self._count))
        if mask is not None:
            full = np.where(mask, full, np.array(np.nan, value.dtype))
        while kind.kind == "array":
            kind = kind.element
        if kind.kind == "matrix":  # (columns, rows) -> (rows, columns)
            full = full.swapaxes(-3, -2)
        shaped = np.moveaxis(full, -1, 0).reshape(batch + full.shape[:-1])
        executed = np.ones(batch, bool) if mask is None else mask.reshape(batch)
        return Local(name, *self._source.origin(line), shaped, executed, born.reshape(batch))
