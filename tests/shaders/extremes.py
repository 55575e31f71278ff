"""Batches of extreme inputs for the shading model: float32 unit vectors and materials, in numpy."""

from __future__ import annotations

import numpy as np


def _cosines(random: np.random.Generator, n: int) -> np.ndarray:
    """Anywhere, near 0 and near 1 in every magnitude, exactly 0, grazing; one in ten on the far side."""
    kinds = [
        random.random(n),
        10 ** random.uniform(-38, 0, n),
        1 - 10 ** random.uniform(-16, 0, n),
        np.zeros(n),
        10 ** random.uniform(-9, -2, n),
    ]
    return np.choose(random.integers(0, len(kinds), n), kinds) * np.where(random.random(n) < 0.1, -1, 1)


def _directions(cosine: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    sine = np.sqrt(np.maximum(1 - cosine * cosine, 0))
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), cosine], -1)


def _rotations(random: np.random.Generator, n: int) -> np.ndarray:
    """(n, 3, 3) rotation matrices from normal-distributed quaternions."""
    w, x, y, z = (q := random.standard_normal((n, 4))).T / np.linalg.norm(q, axis=1)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def extremes(n: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict[str, np.ndarray]]:
    """l, v, n (n, 3) and n materials: mirror images, l = v, near opposites on the horizon, l = -v, roughness to 1e-20.

    In six of ten n is +z, where mirror images stay exact in float32; the others are turned as a whole.
    """
    random = np.random.default_rng(seed)
    azimuth = random.random(n) * 2 * np.pi
    near = 10 ** random.uniform(-9, 0, n)
    apart = np.choose(random.integers(0, 4, n), [np.full(n, np.pi), np.zeros(n), near * np.pi, np.pi + near / 10])
    cos_l = _cosines(random, n)
    cos_v = np.where(random.random(n) < 0.3, cos_l, _cosines(random, n))
    l, v = _directions(cos_l, azimuth), _directions(cos_v, azimuth + apart)  # noqa: E741
    normal = np.tile([0.0, 0.0, 1.0], (n, 1))
    turned = np.flatnonzero(random.random(n) < 0.4)
    rotations = _rotations(random, len(turned))
    for vectors in (l, v, normal):
        vectors[turned] = np.einsum("nij,nj->ni", rotations, vectors[turned])
    opposite = random.random(n) < 0.1
    v[opposite] = -l[opposite]

    roughness = [random.random(n), np.zeros(n), 10 ** random.uniform(-20, 0, n), np.ones(n)]
    metalness = [np.zeros(n), np.ones(n), random.random(n), 1 - 10 ** random.uniform(-9, 0, n)]
    black_or_white = random.integers(0, 2, (n, 3))
    material = {
        "albedo": np.where(random.random((n, 3)) < 0.4, black_or_white, random.random((n, 3))).astype(np.float32),
        "metalness": np.choose(random.integers(0, 4, n), metalness).astype(np.float32),
        "roughness": np.choose(random.integers(0, 4, n), roughness).astype(np.float32),
    }
    return l.astype(np.float32), v.astype(np.float32), normal.astype(np.float32), material
