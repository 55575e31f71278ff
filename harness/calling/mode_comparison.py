"""One call in several modes, and how far the results lie from those of the most accurate one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..comparing.compare import ulp_difference
from ..errors import HarnessError
from ..language.signature import Array, Struct, Type
from . import command, results
from .arguments import counted, dense
from .overloads import Chosen

#: the most accurate first
ACCURACY = ("double", "precise", "as-written", "mediump")


class Difference(NamedTuple):
    """The largest of a mode: in ulps of float32, in absolute terms, and the element with the most ulps."""

    ulp: float
    absolute: float
    index: tuple[int, ...]
    inputs: str  # the arguments of that element, as on a command line


class ModeComparison(dict):
    """Results by mode. ``reference`` is the most accurate mode, ``worst[mode]`` the ``Difference`` of another.

    NaN and NaN do not differ, NaN and a number do by infinity. Integers, and bool as 0 and 1, differ by so many ulps as
    they lie apart. ``refused`` are the errors of the modes that there is no result in. As text it is a table.
    """

    def __init__(self, chosen: Chosen, by_mode: Mapping[str, Any], refused: Mapping[str, HarnessError]):
        super().__init__(by_mode)
        self._chosen = chosen
        self.refused = dict(refused)

    @property
    def reference(self) -> str:
        """The mode that the others are measured against."""
        return min(self, key=ACCURACY.index)

    @cached_property
    def worst(self) -> dict[str, Difference]:
        """The largest difference of each mode but the reference."""
        return {mode: self._difference(self[mode]) for mode in self if mode != self.reference}

    def _difference(self, result: Any) -> Difference:
        dimensions = (n for _, kind in self._chosen.signature.outputs for n in _value_dimensions(kind))
        parts = zip(results.arrays(result), results.arrays(self[self.reference]), dimensions, strict=True)
        ulps, absolute = [], []
        for got, want, own in parts:
            apart = _apart(got, want)
            steps = ulp_difference(got, want) if np.asarray(want).dtype.kind == "f" else apart
            components = tuple(range(apart.ndim - own, apart.ndim))
            ulps.append(steps.max(axis=components, initial=0))
            absolute.append(apart.max(initial=0))
        per_element = np.max(ulps, axis=0)
        if not per_element.size:
            return Difference(0.0, 0.0, (), "")
        index = tuple(map(int, np.unravel_index(np.argmax(per_element), per_element.shape)))
        inputs = " ".join(f"{name}={text}" for name, text in command.single(self._chosen, index))
        return Difference(float(per_element.max()), float(max(absolute)), index, inputs)

    def __repr__(self):
        signature = self._chosen.signature
        first = next(results.arrays(self[self.reference]))
        own = next(_value_dimensions(signature.outputs[0][1]))
        count = int(np.prod(np.shape(first)[: np.ndim(first) - own]))
        file, line = signature.origin
        rows = [("mode", "ulp", "absolute", "largest at")]
        for mode in self:
            if mode == self.reference:
                rows.append((mode, "", "", "what the others are compared with"))
                continue
            worst = self.worst[mode]
            place = f"{list(worst.index)} {worst.inputs}".removeprefix("[] ") if worst.ulp else ""
            rows.append((mode, f"{worst.ulp:.4g}", f"{worst.absolute:.3g}", place))
        rows += [(mode, "-", "-", error.message.split("\n")[0]) for mode, error in self.refused.items()]
        widths = [max(len(row[k]) for row in rows) for k in range(3)]
        table = (f"{a:<{widths[0]}}  {b:>{widths[1]}}  {c:>{widths[2]}}  {d}".rstrip() for a, b, c, d in rows)
        return "\n".join([f"{signature}    [{file}:{line}], {counted(count, 'evaluation')}", *table])


def _apart(got: Any, want: Any) -> np.ndarray:
    """|got - want| in float64: 0 where both are NaN or the same infinity, infinity where only one is."""
    got, want = np.asarray(got, np.float64), np.asarray(want, np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        apart = np.abs(got - want)
    same = (got == want) | (np.isnan(got) & np.isnan(want))
    return np.where(same, 0.0, np.where(np.isnan(apart), np.inf, apart))


def _value_dimensions(kind: Type) -> Iterator[int]:
    """For each array of a result of this type, how many of its last dimensions are one value's."""
    if isinstance(kind, Struct):
        for _, member in kind.members:
            yield from _value_dimensions(member)
    elif found := dense(kind):
        yield len(found[1])
    elif isinstance(kind, Array):
        for _ in range(kind.length):
            yield from _value_dimensions(kind.element)
