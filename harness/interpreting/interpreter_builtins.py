"""The built-in functions of GLSL (SPIR-V's set GLSL.std.450) over numpy batches; values as in ``interpreter_ops``.

Each follows the formula of the GLSL specification (4.60, chapter 8), operation by operation, each rounded.
Transcendental functions are computed in float64 and rounded; in float64 they are numpy's.

What GLSL leaves open: inversesqrt(x) is 1 / sqrt(x), normalize(v) is v inversesqrt(dot(v, v)) and fma() rounds twice,
all as Mesa has them, so that what has no transcendental function in it agrees with the driver to the bit. min, max and
clamp give the operand that is a number, as IEEE 754's minNum and maxNum; comparisons with NaN are false, so that
step(edge, NaN) is 1; sign(NaN) is NaN. round() takes ties to even. pow(x, y) is NaN for x < 0, as on GPUs; otherwise
it is IEEE's, with pow(0, 0) = 1.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .interpreter_ops import Value, bit_count, bit_reverse, dot, wide


def _constant(value: float, like: np.ndarray) -> np.ndarray:
    return np.array([value], like.dtype)


def _fract(x: np.ndarray) -> np.ndarray:
    return x - np.floor(x)


def _inverse_sqrt(x: np.ndarray) -> np.ndarray:
    return _constant(1, x) / np.sqrt(x)


def _pow(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.where(x < 0, np.nan, np.power(x, y))


def _clamp(x: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    return np.fmin(np.fmax(x, low), high)


def _mix(x: np.ndarray, y: np.ndarray, a: np.ndarray) -> np.ndarray:
    return x * (_constant(1, x) - a) + y * a


def _step(edge: np.ndarray, x: np.ndarray) -> np.ndarray:
    return np.where(x < edge, _constant(0, x), _constant(1, x))


def _smoothstep(low: np.ndarray, high: np.ndarray, x: np.ndarray) -> np.ndarray:
    t = _clamp((x - low) / (high - low), _constant(0, x), _constant(1, x))
    return t * t * (_constant(3, x) - _constant(2, x) * t)


def _length(x: np.ndarray) -> np.ndarray:
    return np.sqrt(dot(x, x)) if x.ndim > 1 else np.abs(x)


def _distance(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return _length(a - b)


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[[1, 2, 0]] * b[[2, 0, 1]] - b[[1, 2, 0]] * a[[2, 0, 1]]


def _normalize(x: np.ndarray) -> np.ndarray:
    return x * _inverse_sqrt(_product(x, x))


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """dot() that takes scalars too."""
    return dot(a, b) if a.ndim > 1 else a * b


def _face_forward(n: np.ndarray, i: np.ndarray, reference: np.ndarray) -> np.ndarray:
    return np.where(_product(reference, i) < 0, n, -n)


def _reflect(i: np.ndarray, n: np.ndarray) -> np.ndarray:
    return i - _constant(2, i) * _product(n, i) * n


def _refract(i: np.ndarray, n: np.ndarray, eta: np.ndarray) -> np.ndarray:
    one = _constant(1, i)
    cosine = _product(n, i)
    k = one - eta * eta * (one - cosine * cosine)
    return np.where(k < 0, _constant(0, i), eta * i - (eta * cosine + np.sqrt(k)) * n)


def _minor(m: np.ndarray, column: int, row: int) -> np.ndarray:
    size = len(m)
    return m[[c for c in range(size) if c != column]][:, [r for r in range(size) if r != row]]


def _determinant(m: np.ndarray) -> np.ndarray:
    """Along the first column."""
    if len(m) == 1:
        return m[0, 0]
    total = None
    for row in range(len(m)):
        term = m[0, row] * _determinant(_minor(m, 0, row))
        total = term if total is None else total - term if row % 2 else total + term
    return total


def _inverse(m: np.ndarray) -> np.ndarray:
    """The adjugate over the determinant."""
    size = range(len(m))
    cofactor = [[_determinant(_minor(m, c, r)) * _constant((-1) ** (c + r), m) for c in size] for r in size]
    return np.stack([np.stack(column) for column in cofactor]) / _determinant(m)


def _frexp(x: np.ndarray) -> list[np.ndarray]:
    significand, exponent = np.frexp(x)
    return [significand, exponent.astype(np.int32)]


def _find_lowest(x: np.ndarray) -> np.ndarray:
    bits = x.view(np.uint32)
    lowest = bits & (~bits + np.uint32(1))
    return bit_count(lowest - np.uint32(1)) - np.where(bits == 0, 33, 0).astype(np.int32)


def _find_highest(x: np.ndarray) -> np.ndarray:
    bits = bit_reverse(x.view(np.uint32))
    return np.where(bits == 0, -1, 31 - _find_lowest(bits)).astype(np.int32)


def _find_highest_signed(x: np.ndarray) -> np.ndarray:
    return _find_highest(np.where(x < 0, ~x, x).view(np.uint32))


def _packer(low: float, scale: float, bits: int) -> Callable:
    def pack(v: np.ndarray) -> np.ndarray:
        rounded = np.rint(_clamp(v, _constant(low, v), _constant(1, v)) * _constant(scale, v))
        words = rounded.astype(np.int64) & ((1 << bits) - 1)
        return sum(word << (k * bits) for k, word in enumerate(words)).astype(np.uint32)

    return pack


def _fields(word: np.ndarray, bits: int, signed: bool) -> np.ndarray:
    """The fields of a word from the lowest on, as (32 / bits, n)."""
    fields = np.stack([(word >> np.uint32(k)) & np.uint32((1 << bits) - 1) for k in range(0, 32, bits)])
    kind = {(8, True): np.int8, (8, False): np.uint8, (16, True): np.int16, (16, False): np.uint16}[bits, signed]
    return fields.astype(kind)


def _unpacker(scale: float, bits: int) -> Callable:
    def unpack(word: np.ndarray, dtype: np.dtype) -> np.ndarray:
        signed = scale in (127, 32767)
        values = _fields(word, bits, signed).astype(dtype) / np.array([scale], dtype)
        return _clamp(values, np.array([-1], dtype), np.array([1], dtype)) if signed else values

    return unpack


def _pack_half(v: np.ndarray) -> np.ndarray:
    bits = v.astype(np.float16).view(np.uint16).astype(np.uint32)
    return bits[0] | (bits[1] << np.uint32(16))


def _unpack_half(word: np.ndarray, dtype: np.dtype) -> np.ndarray:
    return _fields(word, 16, False).view(np.float16).astype(dtype)


#: number in GLSL.std.450 -> (GLSL's name, the function); those of UNPACKED take the float type as well
BUILTINS: dict[int, tuple[str, Callable[..., Value]]] = {
    1: ("round", np.rint),
    2: ("roundEven", np.rint),
    3: ("trunc", np.trunc),
    4: ("abs", np.abs),
    5: ("abs", np.abs),
    6: ("sign", np.sign),
    7: ("sign", np.sign),
    8: ("floor", np.floor),
    9: ("ceil", np.ceil),
    10: ("fract", _fract),
    11: ("radians", wide(np.radians)),
    12: ("degrees", wide(np.degrees)),
    13: ("sin", wide(np.sin)),
    14: ("cos", wide(np.cos)),
    15: ("tan", wide(np.tan)),
    16: ("asin", wide(np.arcsin)),
    17: ("acos", wide(np.arccos)),
    18: ("atan", wide(np.arctan)),
    19: ("sinh", wide(np.sinh)),
    20: ("cosh", wide(np.cosh)),
    21: ("tanh", wide(np.tanh)),
    22: ("asinh", wide(np.arcsinh)),
    23: ("acosh", wide(np.arccosh)),
    24: ("atanh", wide(np.arctanh)),
    25: ("atan", wide(np.arctan2)),
    26: ("pow", wide(_pow)),
    27: ("exp", wide(np.exp)),
    28: ("log", wide(np.log)),
    29: ("exp2", wide(np.exp2)),
    30: ("log2", wide(np.log2)),
    31: ("sqrt", np.sqrt),
    32: ("inversesqrt", _inverse_sqrt),
    33: ("determinant", _determinant),
    34: ("inverse", _inverse),
    35: ("modf", np.modf),
    37: ("min", np.fmin),
    38: ("min", np.minimum),
    39: ("min", np.minimum),
    40: ("max", np.fmax),
    41: ("max", np.maximum),
    42: ("max", np.maximum),
    43: ("clamp", _clamp),
    44: ("clamp", lambda x, low, high: np.minimum(np.maximum(x, low), high)),
    45: ("clamp", lambda x, low, high: np.minimum(np.maximum(x, low), high)),
    46: ("mix", _mix),
    48: ("step", _step),
    49: ("smoothstep", _smoothstep),
    50: ("fma", lambda a, b, c: a * b + c),
    52: ("frexp", _frexp),
    53: ("ldexp", np.ldexp),
    54: ("packSnorm4x8", _packer(-1, 127, 8)),
    55: ("packUnorm4x8", _packer(0, 255, 8)),
    56: ("packSnorm2x16", _packer(-1, 32767, 16)),
    57: ("packUnorm2x16", _packer(0, 65535, 16)),
    58: ("packHalf2x16", _pack_half),
    60: ("unpackSnorm2x16", _unpacker(32767, 16)),
    61: ("unpackUnorm2x16", _unpacker(65535, 16)),
    62: ("unpackHalf2x16", _unpack_half),
    63: ("unpackSnorm4x8", _unpacker(127, 8)),
    64: ("unpackUnorm4x8", _unpacker(255, 8)),
    66: ("length", _length),
    67: ("distance", _distance),
    68: ("cross", _cross),
    69: ("normalize", _normalize),
    70: ("faceforward", _face_forward),
    71: ("reflect", _reflect),
    72: ("refract", _refract),
    73: ("findLSB", _find_lowest),
    74: ("findMSB", _find_highest_signed),
    75: ("findMSB", _find_highest),
    79: ("min", np.fmin),
    80: ("max", np.fmax),
    81: ("clamp", _clamp),
}
UNPACKED = {60, 61, 62, 63, 64}
