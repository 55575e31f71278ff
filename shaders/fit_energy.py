"""Makes the coefficients of energy.glsl: least squares against quadrature, reweighted until the largest error is least.

    python shaders/fit_energy.py

E(mu, roughness) is the albedo of single-scattering GGX with F = 1 toward a cosine mu, and w the mean of (1 - l.h)^5
over what it reflects. Fitted are q = (1 - E)/E, where the error counts that it leaves in a white furnace,
E (1 + q) - 1, and the cosine c with (1 - c)^5 = w, where the error counts that it leaves in the albedo of a
dielectric, E (0.04 + 0.96 w).
"""

from __future__ import annotations

import math

import numpy as np

NODES = 120


def gauss(n: int, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Gauss-Legendre quadrature."""
    x, w = np.polynomial.legendre.leggauss(n)
    return low + (high - low) * (x + 1) / 2, w * (high - low) / 2


def albedo(mu: float, roughness: float) -> tuple[float, float]:
    """E and E w, integrated over the normals h of microfacets: theta from n, t = tan(theta) = a tan(u), azimuth phi."""
    a = roughness**2
    phi, w_phi = gauss(NODES, 0, math.pi)
    across = math.sqrt(1 - mu * mu) * np.cos(phi)
    end = np.arctan((across + np.sqrt(across**2 + mu**2)) / mu / a)[:, None]  # there l is at the horizon
    u, w_u = gauss(NODES, 0, 1)
    t = a * np.tan(end * u)
    cosine = 1 / np.sqrt(1 + t * t)
    v_h = (across[:, None] * t + mu) * cosine
    NoL = np.maximum(2 * v_h * cosine - mu, 0)
    D = a**2 / (math.pi * (1 + cosine**2 * (a**2 - 1)) ** 2)
    V = 0.5 / (mu * np.sqrt(a**2 + (1 - a**2) * NoL**2) + NoL * np.sqrt(a**2 + (1 - a**2) * mu**2))
    # dl = 4 (v.h) dh, dh = t cos^3 dt dphi, dt = a (1 + (t/a)^2) end du
    reflected = 4 * D * V * NoL * v_h * t * cosine**3 * a * (1 + (t / a) ** 2) * end
    return 2 * float(w_phi @ (reflected @ w_u)), 2 * float(w_phi @ (reflected * (1 - v_h) ** 5 @ w_u))


def fitted(basis: np.ndarray, values: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, float]:
    """Coefficients that make the largest |basis @ c - values| scale small, and that error: Lawson's reweighting."""
    weights = np.ones_like(values)
    best = None, math.inf
    for _ in range(200):
        share = np.sqrt(weights) * scale
        c = np.linalg.lstsq(basis * share[:, None], values * share, rcond=None)[0]
        error = np.abs(basis @ c - values) * scale
        if error.max() < best[1]:
            best = c, error.max()
        weights = weights * (error / error.max()) ** 0.5 + 1e-12
        weights /= weights.mean()
    return best


def main() -> None:
    cosines = np.concatenate([[1e-3], gauss(40, 0, 1)[0] ** 1.5, [1.0]])
    roughnesses = np.concatenate([[0.01, 0.03], gauss(38, 0.045, 1)[0], [1.0]])
    mu, r = (grid.ravel() for grid in np.meshgrid(cosines, roughnesses))
    E, E_w = np.array([albedo(*pair) for pair in zip(mu, r, strict=True)]).T
    a = r * r
    s = mu / (mu + a)

    terms = [(i, j) for i in range(3) for j in range(4)]
    c, error = fitted(np.stack([s * (1 - s) * s**i * a**j for i, j in terms], 1), (1 - E) / E, E)
    print(f"q/(s (1 - s)), rows by powers of s, columns by powers of alpha; furnace within {error:.4f}")
    print(np.array2string(c.reshape(3, 4), precision=4, suppress_small=True))

    terms = [(i, j) for i in range(4) for j in range(4 - i)]
    cosine = 1 - (E_w / E) ** 0.2
    slope = np.maximum(5 * (1 - cosine) ** 4 * 0.96 * E, 0.02)  # of the albedo in the cosine
    c, error = fitted(np.stack([r * s**i * r**j for i, j in terms], 1), cosine - mu, slope)
    print(f"(c - mu)/roughness, by powers of s and roughness; albedo of a dielectric within about {error:.4f}")
    for (i, j), value in zip(terms, c, strict=True):
        print(f"s^{i} r^{j}  {value:.4f}")


if __name__ == "__main__":
    main()
