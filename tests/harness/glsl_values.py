"""Values of every type of GLSL that is data, extremes among them, for the tests of calls."""

from __future__ import annotations

import re

import numpy as np

#: bits that a copy could damage: zeros, smallest and largest denormal and normal, infinities, NaN of either kind
FLOAT_BITS = np.array(
    """00000000 80000000 00000001 80000001 007fffff 00800000 3f800000 7f7fffff 7f800000 ff800000
    7fc00000 7fc12345 ffc00001 7f800001 7fa00001 ffffffff""".split()
)
FLOAT_BITS = np.array([int(bits, 16) for bits in FLOAT_BITS], np.uint32)
EXTREMES = {
    "float": FLOAT_BITS.view(np.float32),
    "int": np.array([0, 1, -1, 2**31 - 1, -(2**31), 2**24 + 1], np.int32),
    "uint": np.array([0, 1, 2**31, 2**32 - 1, 2**24 + 1], np.uint32),
    "bool": np.array([True, False]),
}
PREFIXES = {"": "float", "i": "int", "u": "uint", "b": "bool"}
TYPES = [
    *PREFIXES.values(),
    *(f"{prefix}vec{n}" for prefix in PREFIXES for n in (2, 3, 4)),
    *("mat2", "mat3", "mat4", "mat2x3", "mat2x4", "mat3x2", "mat3x4", "mat4x2", "mat4x3"),
]


def shape_of(kind: str) -> tuple[int, ...]:
    """A matCxR has C columns and R rows; numpy has rows first."""
    if match := re.fullmatch(r"mat(\d)(?:x(\d))?", kind):
        return int(match[2] or match[1]), int(match[1])
    match = re.fullmatch(r"\w*vec(\d)", kind)
    return (int(match[1]),) if match else ()


def base_of(kind: str) -> str:
    return kind if kind in EXTREMES else PREFIXES[re.sub(r"(vec|mat)\w+", "", kind)]


def values(kind: str, count: int, seed: int = 0) -> np.ndarray:
    """``count`` values of a type, of extremes in another order each."""
    extremes = EXTREMES[base_of(kind)]
    return np.random.default_rng(seed).choice(extremes, (count, *shape_of(kind)))


def assert_same_bits(got, want) -> None:
    got, want = np.asarray(got), np.asarray(want)
    assert got.dtype == want.dtype
    assert got.shape == want.shape
    assert got.tobytes() == want.tobytes()
