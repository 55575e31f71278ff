"""Energy: how much of a white furnace's light a white surface returns, and whether light may go the other way round.

The furnace is the integral of ``shade`` over the light's directions, by Gauss-Legendre quadrature in double: for each
roughness of ROUGHNESS and cosine of the viewer of COSINES, of a white dielectric and of a white metal. What a black
dielectric and a white metal reflect is integrated over the half vector h instead of l, in polar coordinates around n
with t = tan(theta): over arctan(t/alpha) up to t = 10 alpha, which spreads a GGX highlight evenly, and over theta
beyond, 50 and 40 nodes, for 90 azimuths; l = 2 (v.h) h - v is above the horizon up to a t known in closed form. What a
white dielectric has beyond a black one, which is diffuse and smooth, is integrated over the cosine and the azimuth of
l, 90 x 90 nodes. Both are good to 1e-6 where the viewer's cosine is 0.05 and more, to 2e-4 below.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from ..calling.function import Function
from . import sampling
from .model import checked, surface
from .values import Flat, values

ROUGHNESS = (0.045, 0.1, 0.3, 0.5, 0.7, 1.0)
COSINES = (0.001, 0.01, 0.05, 0.1, 0.2, 0.5, 1.0)
#: of the azimuth and of a cosine; of the highlight's angle; and beyond it, from so many alpha on
NODES = 90
LOBE_NODES, TAIL_NODES = 50, 40
LOBE = 10.0
#: the inputs that reciprocity is tried at, the first of those of sampling.py
PAIRS = 1 << 15


def energy(shade: Function) -> dict[str, Any]:
    """``furnace_max`` and ``furnace_min`` of both materials, and of each, and ``reciprocity``.

    ``dielectric`` and ``metal`` have each a ``max`` and a ``min``, and the roughness and the cosine of the viewer of
    both, ``max_at`` and ``min_at``. CallError when it is not called as ``shade`` is.
    """
    double = checked(shade).with_mode("double")
    nodes = [(roughness, cosine) for roughness in ROUGHNESS for cosine in COSINES]
    found = {
        "dielectric": _extent({node: dielectric(double, *node) for node in nodes}),
        "metal": _extent({node: highlight(double, *node, albedo=1.0, metalness=1.0) for node in nodes}),
    }
    return {
        "furnace_max": max(part["max"] for part in found.values()),
        "furnace_min": min(part["min"] for part in found.values()),
        "reciprocity": reciprocity(shade),
        **found,
    }


def _extent(returned: dict[tuple[float, float], float]) -> dict[str, Any]:
    """NaN, if it is anywhere, is the largest and the smallest."""
    largest, smallest = (pick(returned, key=_nan_last(returned, sign)) for pick, sign in ((max, 1), (min, -1)))
    told = {"max": returned[largest], "max_at": largest, "min": returned[smallest], "min_at": smallest}
    return {
        name: dict(zip(("roughness", "cosine"), value, strict=True)) if name.endswith("_at") else value
        for name, value in told.items()
    }


def _nan_last(returned: dict, sign: int):
    return lambda node: sign * math.inf if math.isnan(returned[node]) else returned[node]


def dielectric(double: Function, roughness: float, cosine: float) -> float:
    """What a white dielectric returns of a white furnace toward a cosine."""
    return highlight(double, roughness, cosine, albedo=0.0, metalness=0.0) + _diffuse(double, roughness, cosine)


def _gauss(low: float, high: float, nodes: int = NODES) -> tuple[np.ndarray, np.ndarray]:
    x, weights = np.polynomial.legendre.leggauss(nodes)
    return low + (high - low) * (x + 1) / 2, weights * (high - low) / 2


def highlight(double: Function, roughness: float, cosine: float, *, albedo: float, metalness: float) -> float:
    """The integral of shade() over l, by way of h: for what has a highlight and nothing else."""
    l, weights = _half_vectors(roughness, cosine)  # noqa: E741
    return float(weights @ values(double, surface(l, _viewer(cosine), albedo, metalness, roughness))[:, 0])


def _viewer(cosine: float) -> np.ndarray:
    return np.array([math.sqrt((1 - cosine) * (1 + cosine)), 0.0, cosine])


@cache
def _half_vectors(roughness: float, cosine: float) -> tuple[np.ndarray, np.ndarray]:
    """Directions l (nodes, 3) and their weights: a GGX highlight spread evenly."""
    v, alpha = _viewer(cosine), roughness**2
    phi, w_phi = _gauss(0, math.pi)
    along = v[0] * np.cos(phi)
    end = ((along + np.sqrt(along**2 + cosine**2)) / cosine)[:, None]
    middle = np.minimum(LOBE * alpha, end)
    share, w_share = _gauss(0, 1, LOBE_NODES)
    angle = np.arctan(middle / alpha)
    lobe = alpha * np.tan(angle * share)
    d_lobe = alpha * (1 + (lobe / alpha) ** 2) * angle * w_share
    share, w_share = _gauss(0, 1, TAIL_NODES)
    angle = np.arctan(end) - np.arctan(middle)
    tail = np.tan(np.arctan(middle) + angle * share)
    d_tail = (1 + tail**2) * angle * w_share
    t, dt = np.concatenate([lobe, tail], axis=1), np.concatenate([d_lobe, d_tail], axis=1)
    cos_h = 1 / np.sqrt(1 + t**2)
    sin_h = t * cos_h
    h = np.stack([sin_h * np.cos(phi)[:, None], sin_h * np.sin(phi)[:, None], cos_h], axis=-1)
    v_h = h @ v
    l = 2 * v_h[..., None] * h - v  # noqa: E741
    l /= np.linalg.norm(l, axis=-1, keepdims=True)  # noqa: E741
    # dl = 4 (v.h) dh and dh = t / (1 + t^2)^(3/2) dt dphi; both halves of phi are alike
    weights = 2 * w_phi[:, None] * dt * (4 * v_h * t * cos_h**3)
    return l.reshape(-1, 3), weights.ravel()


@cache
def _hemisphere() -> tuple[np.ndarray, np.ndarray]:
    """Directions l (nodes, 3) and their weights: the hemisphere evenly."""
    mu, w_mu = _gauss(0, 1)
    phi, w_phi = _gauss(0, math.pi)
    sine = np.sqrt(1 - mu**2)
    l = np.stack(np.broadcast_arrays(sine * np.cos(phi)[:, None], sine * np.sin(phi)[:, None], mu), axis=-1)  # noqa: E741
    return l.reshape(-1, 3), 2 * np.outer(w_phi, w_mu).ravel()


def _diffuse(double: Function, roughness: float, cosine: float) -> float:
    """The integral over l of what a white dielectric has beyond a black one."""
    l, weights = _hemisphere()  # noqa: E741
    white, black = (values(double, surface(l, _viewer(cosine), albedo, 0.0, roughness))[:, 0] for albedo in (1.0, 0.0))
    return float(weights @ (white - black))


def reciprocity(shade: Function, flat: Flat | None = None) -> float:
    """The largest relative difference of the BRDF, shade() / n.l, with l and v the other way round, in double.

    Relative to the larger of the two; 0 is reciprocal, 1 the most.
    """
    double = shade.with_mode("double")
    flat = sampling.inputs(shade, sampling.SHADE, PAIRS) if flat is None else flat
    there = values(double, flat) / np.sum(flat["n"] * flat["l"], axis=1)[:, None]
    back = values(double, {**flat, "l": flat["v"], "v": flat["l"]}) / np.sum(flat["n"] * flat["v"], axis=1)[:, None]
    larger = np.maximum(np.abs(there), np.abs(back))
    return float(np.max(np.abs(there - back) / np.where(larger > 0, larger, 1)))
