"""The arguments of ``shade`` that every contender gets: the same numbers in every process."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

#: n.l and n.v keep away from 0, where the model jumps to 0 and the last bit of a dot product decides
LEAST_COSINE = 0.01
#: below it the rounding of n x H shows in the result, and contenders differ by more than their speed
LEAST_ROUGHNESS = 0.1


class Inputs(NamedTuple):
    """Float32 arrays: l, v, n, albedo (N, 3), metalness and roughness (N,)."""

    l: np.ndarray  # noqa: E741 -- the field's name of it
    v: np.ndarray
    n: np.ndarray
    albedo: np.ndarray
    metalness: np.ndarray
    roughness: np.ndarray

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return sum(array.nbytes for array in self)


def inputs(count: int) -> Inputs:
    """``count`` lit points: l and v on the side of n, materials uniform in 0...1 but for roughness; always the same."""
    random = np.random.default_rng(1)

    def unit(vectors):
        vectors /= np.sqrt(np.einsum("ij,ij->i", vectors, vectors))[:, None]
        return vectors

    def direction():
        return unit(random.standard_normal((count, 3), dtype=np.float32))

    def above(n):
        x = direction()
        x *= np.copysign(np.float32(1), np.einsum("ij,ij->i", n, x))[:, None]
        x += np.float32(2 * LEAST_COSINE) * n
        return unit(x)

    n = direction()
    roughness = LEAST_ROUGHNESS + (1 - LEAST_ROUGHNESS) * random.random(count, dtype=np.float32)
    return Inputs(
        l=above(n),
        v=above(n),
        n=n,
        albedo=random.random((count, 3), dtype=np.float32),
        metalness=random.random(count, dtype=np.float32),
        roughness=np.minimum(roughness, np.float32(1)),
    )
