"""SPIR-V's arithmetic, comparisons, conversions and bit operations over numpy batches.

A value holds its lanes, the elements of the batch, in the last dimension: a scalar (n,), a vector (components, n), a
matrix (columns, rows, n), an array one dimension more in front. What all lanes share has n = 1, and broadcasts. Every
operation is rounded once, to nearest even, to the type of its operands; nothing is contracted or reordered; denormals
are kept.

Where GLSL leaves the result open: division of integers by zero gives all ones, shifts count modulo 32, % of integers
takes the sign of the divisor, and a float beyond an integer type becomes its nearest value, NaN 0.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

Value = np.ndarray | list  # a list for structures and for arrays of them


def wide(function: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
    """A function computed in float64 and rounded to the type of its arguments: right in all but rare near-ties."""

    def rounded(*values: np.ndarray) -> np.ndarray:
        if values[0].dtype == np.float64:
            return function(*values)
        return function(*(v.astype(np.float64) for v in values)).astype(values[0].dtype)

    return rounded


# ---- Vectors and matrices --------------------------------------------------------------------------------------------


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The sum of the products of components, added from the last on: GLSL leaves the order open, and this is Mesa's."""
    products = a * b
    total = products[-1]
    for product in products[-2::-1]:
        total = total + product
    return total


def matrix_times_vector(m: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Column by column: m[0] v[0] + m[1] v[1] + ..."""
    total = m[0] * v[0]
    for column, factor in zip(m[1:], v[1:], strict=True):
        total = total + column * factor
    return total


def vector_times_matrix(v: np.ndarray, m: np.ndarray) -> np.ndarray:
    return np.stack([dot(v, column) for column in m])


def matrix_times_matrix(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.stack([matrix_times_vector(a, column) for column in b])


def outer_product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.stack([a * factor for factor in b])


def transpose(m: np.ndarray) -> np.ndarray:
    return m.swapaxes(0, 1)


# ---- Integers --------------------------------------------------------------------------------------------------------


def _u(a: np.ndarray) -> np.ndarray:
    return a.view(np.uint32)


def _s(a: np.ndarray) -> np.ndarray:
    return a.view(np.int32)


def _divided(a: np.ndarray, b: np.ndarray, rounded: Callable) -> np.ndarray:
    """The quotient of 32-bit integers, which float64 holds closely enough to be rounded right; -1 for / 0."""
    quotient = rounded(a.astype(np.float64) / np.where(b == 0, 1, b))
    return np.where(b == 0, -1, quotient).astype(np.int64)


def _wrapped(a: np.ndarray, dtype: type) -> np.ndarray:
    return (a & 0xFFFFFFFF).astype(np.uint32).view(dtype)


def signed_division(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return _wrapped(_divided(a, b, np.trunc), np.int32)


def unsigned_division(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return _wrapped(_divided(a, b, np.floor), np.uint32)


def _remainder(rounded: Callable, dtype: type) -> Callable:
    def remainder(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        exact = a.astype(np.int64) - _divided(a, b, rounded) * b.astype(np.int64)
        return np.where(b == 0, -1, _wrapped(exact, dtype).astype(np.int64)).astype(dtype)

    return remainder


def float_to_int(dtype: type) -> Callable:
    """Toward zero; what is beyond the type becomes its nearest value, and NaN 0."""
    limits = np.iinfo(dtype)

    def convert(a: np.ndarray) -> np.ndarray:
        clipped = np.clip(np.trunc(a.astype(np.float64)), limits.min, limits.max)
        return np.where(np.isnan(a), 0, clipped).astype(np.int64).astype(dtype)

    return convert


def _bits(count: np.ndarray) -> np.ndarray:
    """``count`` ones, 0...32."""
    return ((np.uint64(1) << count.astype(np.uint64)) - np.uint64(1)).astype(np.uint32)


def bit_field_insert(base: np.ndarray, insert: np.ndarray, offset: np.ndarray, bits: np.ndarray) -> np.ndarray:
    shift = _u(offset) & np.uint32(31)
    mask = _bits(_u(bits)) << shift
    return ((_u(base) & ~mask) | ((_u(insert) << shift) & mask)).view(base.dtype)


def bit_field_extract_unsigned(base: np.ndarray, offset: np.ndarray, bits: np.ndarray) -> np.ndarray:
    return ((_u(base) >> (_u(offset) & np.uint32(31))) & _bits(_u(bits))).view(base.dtype)


def bit_field_extract_signed(base: np.ndarray, offset: np.ndarray, bits: np.ndarray) -> np.ndarray:
    field = _s(bit_field_extract_unsigned(base, offset, bits)).astype(np.int64)
    sign = np.int64(1) << np.maximum(bits.astype(np.int64) - 1, 0)
    return _wrapped(np.where(bits == 0, 0, (field ^ sign) - sign), np.int32)


def bit_reverse(a: np.ndarray) -> np.ndarray:
    bits = _u(a)
    for shift, mask in ((1, 0x55555555), (2, 0x33333333), (4, 0x0F0F0F0F), (8, 0x00FF00FF), (16, 0x0000FFFF)):
        by, mask = np.uint32(shift), np.uint32(mask)
        bits = ((bits >> by) & mask) | ((bits & mask) << by)
    return bits.view(a.dtype)


def bit_count(a: np.ndarray) -> np.ndarray:
    bits = _u(a)
    return sum((bits >> np.uint32(k)) & np.uint32(1) for k in range(32)).astype(np.int32)


def _product(dtype: type) -> Callable:
    """(low, high) words of the product of 64 bits."""
    long = np.int64 if dtype == np.int32 else np.uint64

    def extended(a: np.ndarray, b: np.ndarray) -> list[np.ndarray]:
        product = a.view(dtype).astype(long) * b.view(dtype).astype(long)
        low, high = product & long(0xFFFFFFFF), product >> long(32)
        return [low.astype(np.uint32).view(dtype), high.astype(dtype)]

    return extended


def _carry(a: np.ndarray, b: np.ndarray) -> list[np.ndarray]:
    total = a + b
    return [total, (total < a).astype(np.uint32)]


def _borrow(a: np.ndarray, b: np.ndarray) -> list[np.ndarray]:
    return [a - b, (a < b).astype(np.uint32)]


def _shift(operation: np.ufunc, view: Callable) -> Callable:
    return lambda a, b: operation(view(a), view(b) & view(b).dtype.type(31)).view(a.dtype)


def _signed(operation: Callable) -> Callable:
    return lambda a, b: operation(_s(a), _s(b))


def _unsigned(operation: Callable) -> Callable:
    return lambda a, b: operation(_u(a), _u(b))


def _integer(operation: Callable) -> Callable:
    """Of operands whose signs may differ; the result has the type of the first."""
    return lambda a, b: operation(_u(a), _u(b)).view(a.dtype)


def _ordered(comparison: Callable) -> Callable:
    return lambda a, b: comparison(a, b) & (a == a) & (b == b)


def _unordered(comparison: Callable) -> Callable:
    return lambda a, b: comparison(a, b) | (a != a) | (b != b)


def select(condition: np.ndarray, a: Value, b: Value) -> Value:
    """a where the condition holds, else b."""
    if isinstance(a, list):
        return [select(condition, p, q) for p, q in zip(a, b, strict=True)]
    return np.where(condition, a, b)


#: opcode -> (how GLSL writes it, the operation); {} stands for an operand
OPERATIONS: dict[int, tuple[str, Callable[..., Value]]] = {
    84: ("transpose({})", transpose),
    126: ("-{}", np.negative),
    127: ("-{}", np.negative),
    128: ("{} + {}", _integer(np.add)),
    129: ("{} + {}", np.add),
    130: ("{} - {}", _integer(np.subtract)),
    131: ("{} - {}", np.subtract),
    132: ("{} * {}", _integer(np.multiply)),
    133: ("{} * {}", np.multiply),
    134: ("{} / {}", _unsigned(unsigned_division)),
    135: ("{} / {}", _signed(signed_division)),
    136: ("{} / {}", np.divide),
    137: ("{} % {}", _unsigned(_remainder(np.floor, np.uint32))),
    138: ("{} % {}", _signed(_remainder(np.trunc, np.int32))),
    139: ("{} % {}", _signed(_remainder(np.floor, np.int32))),
    141: ("mod({}, {})", lambda x, y: x - y * np.floor(x / y)),
    142: ("{} * {}", np.multiply),
    143: ("{} * {}", np.multiply),
    144: ("{} * {}", vector_times_matrix),
    145: ("{} * {}", matrix_times_vector),
    146: ("{} * {}", matrix_times_matrix),
    147: ("outerProduct({}, {})", outer_product),
    148: ("dot({}, {})", dot),
    149: ("uaddCarry({}, {})", _carry),
    150: ("usubBorrow({}, {})", _borrow),
    151: ("umulExtended({}, {})", _product(np.uint32)),
    152: ("imulExtended({}, {})", _product(np.int32)),
    154: ("any({})", lambda a: a.any(axis=0)),
    155: ("all({})", lambda a: a.all(axis=0)),
    156: ("isnan({})", np.isnan),
    157: ("isinf({})", np.isinf),
    164: ("{} == {}", np.equal),
    165: ("{} != {}", np.not_equal),
    166: ("{} || {}", np.logical_or),
    167: ("{} && {}", np.logical_and),
    168: ("!{}", np.logical_not),
    169: ("({} ? {} : {})", select),
    170: ("{} == {}", _unsigned(np.equal)),
    171: ("{} != {}", _unsigned(np.not_equal)),
    172: ("{} > {}", _unsigned(np.greater)),
    173: ("{} > {}", _signed(np.greater)),
    174: ("{} >= {}", _unsigned(np.greater_equal)),
    175: ("{} >= {}", _signed(np.greater_equal)),
    176: ("{} < {}", _unsigned(np.less)),
    177: ("{} < {}", _signed(np.less)),
    178: ("{} <= {}", _unsigned(np.less_equal)),
    179: ("{} <= {}", _signed(np.less_equal)),
    180: ("{} == {}", np.equal),
    181: ("{} == {}", _unordered(np.equal)),
    182: ("{} != {}", _ordered(np.not_equal)),
    183: ("{} != {}", np.not_equal),
    184: ("{} < {}", np.less),
    185: ("{} < {}", _unordered(np.less)),
    186: ("{} > {}", np.greater),
    187: ("{} > {}", _unordered(np.greater)),
    188: ("{} <= {}", np.less_equal),
    189: ("{} <= {}", _unordered(np.less_equal)),
    190: ("{} >= {}", np.greater_equal),
    191: ("{} >= {}", _unordered(np.greater_equal)),
    194: ("{} >> {}", _shift(np.right_shift, _u)),
    195: ("{} >> {}", _shift(np.right_shift, _s)),
    196: ("{} << {}", _shift(np.left_shift, _u)),
    197: ("{} | {}", _integer(np.bitwise_or)),
    198: ("{} ^ {}", _integer(np.bitwise_xor)),
    199: ("{} & {}", _integer(np.bitwise_and)),
    200: ("~{}", np.invert),
    201: ("bitfieldInsert({}, {}, {}, {})", bit_field_insert),
    202: ("bitfieldExtract({}, {}, {})", bit_field_extract_signed),
    203: ("bitfieldExtract({}, {}, {})", bit_field_extract_unsigned),
    204: ("bitfieldReverse({})", bit_reverse),
    205: ("bitCount({})", bit_count),
}


def common_lanes(values: Sequence[np.ndarray]) -> list[np.ndarray]:
    """The values, each with as many lanes as the widest: (..., n)."""
    lanes = max(v.shape[-1] for v in values)
    return [v if v.shape[-1] == lanes else np.broadcast_to(v, (*v.shape[:-1], lanes)) for v in values]


def stacked(values: Sequence[Value]) -> np.ndarray:
    """One value of the parts given: a vector of scalars, a matrix of columns."""
    return np.stack(common_lanes(values))
