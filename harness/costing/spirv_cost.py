"""What a GLSL function costs by its SPIR-V alone: weighted counts of operations, where no driver for a GPU is.

The weights are a GPU's as far as all agree: a multiply or an add is 1 a component, a transcendental 4, a division a
reciprocal and a multiply; what is a modifier of another instruction is free (negation, absolute value, clamping to
constants), and so is moving numbers. Over variants of one shading model such counts go with the machine's own to a
correlation of .98 and more on GCN and Mali, .81 on Intel; counting all operations alike ranks pow(x, 5) below three
multiplies, which is wrong. Every block counts in full, a loop's once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..calling.call import Function
from ..interpreting import spirv
from . import cost_stage

TRANSCENDENTAL = 4.0
DIVISION = 5.0

_EXT_INST, _ENTRY_POINT, _CALL = 12, 15, 57
_TYPE_VECTOR, _TYPE_MATRIX = 23, 24
_CONSTANTS = (43, 44)  # scalar, composite
_CONSTRUCT = 80  # a vector of parts
_FUNCTION, _FUNCTION_END = 54, 56
_DIVISIONS = {134, 135, 136}  # unsigned, signed, float
_REMAINDERS = {137, 138, 139, 140, 141}
_DOT, _MATRIX_TIMES_MATRIX = 148, 146
_MATRIX_PRODUCTS = {144, 145}  # vector by matrix, matrix by vector
#: one instruction a component: arithmetic, conversions, comparisons, logic, select, bits, derivatives
_SIMPLE = {
    *(128, 129, 130, 131, 132, 133, 142, 143, 147),
    *range(109, 114),
    *range(154, 158),
    *range(164, 192),
    *range(194, 206),
    *range(207, 216),
}
#: sampling and fetching: as slow as a transcendental to issue, and what memory takes is another matter
_IMAGES = set(range(87, 99))

#: instructions of GLSL.std.450 -> cost a component; those of the next table depend on the vector as a whole
_EXTENDED = {
    **dict.fromkeys((1, 2, 3, 8, 9, 10), 1.0),  # rounding, floor, ceil, fract
    **dict.fromkeys((4, 5), 0.0),  # abs
    **dict.fromkeys((6, 7), 2.0),  # sign
    **dict.fromkeys((11, 12), 1.0),  # radians, degrees
    **dict.fromkeys((13, 14), TRANSCENDENTAL + 1),  # sin and cos take turns
    15: 2 * TRANSCENDENTAL + 2 + TRANSCENDENTAL,  # tan
    **dict.fromkeys((16, 17), TRANSCENDENTAL + 8),  # asin, acos: a polynomial and a root
    **dict.fromkeys((18, 25), DIVISION + 10),  # atan
    **dict.fromkeys(range(19, 25), 3 * TRANSCENDENTAL),  # hyperbolic
    26: 2 * TRANSCENDENTAL + 1,  # pow: exp2(y log2(x))
    **dict.fromkeys((27, 28), TRANSCENDENTAL + 1),  # exp, log
    **dict.fromkeys((29, 30, 31, 32), TRANSCENDENTAL),  # exp2, log2, sqrt, inversesqrt
    **dict.fromkeys((35, 36), 2.0),  # modf
    **dict.fromkeys((*range(37, 43), 50, 79, 80), 1.0),  # min, max, fma
    **dict.fromkeys((46, 48), 2.0),  # mix, step
    49: DIVISION + 5,  # smoothstep
    **dict.fromkeys((*range(51, 66), *range(73, 79)), 1.0),  # bits of floats, interpolation
}
_CLAMPS = {43, 44, 45, 81}


def weighted_count(function: Function) -> float:
    """The weighted operations of one call. CallError when the function cannot be counted (``cost_stage.stages``)."""
    return count_words(cost_stage.stages(function).fragment)


def count_words(words: np.ndarray) -> float:
    """The weighted operations of what the entry point of a module calls; of itself nothing counts."""
    module = _Module(words)
    return sum(module.cost(called) for called in module.calls[module.entry])


def count_stage(words: np.ndarray) -> float:
    """The weighted operations of a whole stage, its entry point's own too."""
    module = _Module(words)
    return module.cost(module.entry)


class _Module:
    """The functions of a module, each with its own operations' weight and its calls."""

    def __init__(self, words: np.ndarray):
        self._widths: dict[int, int] = {}  # of types: numbers in a value
        self._columns: dict[int, int] = {}  # of matrix types
        self._types: dict[int, int] = {}  # result -> its type
        self._constants: set[int] = set()
        self._own: dict[int, float] = {}
        self.calls: dict[int, list[int]] = {}
        self.entry = 0
        current = 0
        for code, operands in spirv.instructions(words.tolist()):
            if code == _ENTRY_POINT:
                self.entry = operands[1]
            elif code in (_TYPE_VECTOR, _TYPE_MATRIX):
                self._widths[operands[0]] = self._widths.get(operands[1], 1) * operands[2]
                self._columns[operands[0]] = operands[2]
            elif code == _FUNCTION:
                current = operands[1]
                self._own[current], self.calls[current] = 0.0, []
            elif code in _CONSTANTS:
                self._constants.add(operands[1])
            elif code == _CONSTRUCT and self._constants.issuperset(operands[2:]):
                self._constants.add(operands[1])
            elif current and code == _CALL:
                self.calls[current].append(operands[2])
            elif current and code != _FUNCTION_END:
                self._own[current] += self._weight(code, operands)
            if len(operands) > 1:
                self._types[operands[1]] = operands[0]

    def cost(self, function: int) -> float:
        """Its own and that of what it calls; GLSL has no recursion."""
        return self._own[function] + sum(map(self.cost, self.calls[function]))

    def _width(self, value: int) -> int:
        return self._widths.get(self._types.get(value, 0), 1)

    def _weight(self, code: int, operands: Sequence[int]) -> float:
        width = self._widths.get(operands[0], 1) if operands else 1
        if code in _SIMPLE:
            return width
        if code in _DIVISIONS:
            return width * (1.0 if operands[3] in self._constants else DIVISION)
        if code in _REMAINDERS:
            return width * (DIVISION + 2)
        if code == _DOT:
            return self._width(operands[2])
        if code in _MATRIX_PRODUCTS:
            return max(self._width(operands[2]), self._width(operands[3]))
        if code == _MATRIX_TIMES_MATRIX:
            return width * self._columns[self._types[operands[2]]]
        if code in _IMAGES:
            return TRANSCENDENTAL
        if code == _EXT_INST:
            return self._extended(operands[3], width, operands[4:])
        return 0.0

    def _extended(self, instruction: int, width: int, arguments: Sequence[int]) -> float:
        if instruction in _CLAMPS:
            return 0.0 if set(arguments[1:]) <= self._constants else 2.0 * width
        if instruction in _EXTENDED:
            return width * _EXTENDED[instruction]
        of_argument = self._width(arguments[0])
        return {
            33: 9.0,  # determinant
            34: 30.0 + DIVISION,  # inverse
            66: of_argument + TRANSCENDENTAL,  # length
            67: 2 * of_argument + TRANSCENDENTAL,  # distance
            68: 6.0,  # cross
            69: 2 * width + TRANSCENDENTAL,  # normalize
            70: 2.0 * width,  # faceforward
            71: 2 * width + 1.0,  # reflect
            72: 3 * width + 6.0 + TRANSCENDENTAL,  # refract
        }.get(instruction, float(width))
