"""The exercise's model written from its formulas in mpmath, at 50 digits: what the shaders are held against.

Vectors are tuples of three mpf, unit to float32 at least; the formulas are those of the exercise sheet and of the
papers that it follows, none is rearranged.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import mpmath as mp
import numpy as np

mp.mp.dps = 50

Vector = tuple[mp.mpf, mp.mpf, mp.mpf]


@dataclass(frozen=True)
class Material:
    """As in brdf.glsl; the numbers are float32 values, given exactly."""

    albedo: tuple[float, float, float]
    metalness: float
    roughness: float


def vector(x, y, z) -> Vector:
    return mp.mpf(x), mp.mpf(y), mp.mpf(z)


def dot(a: Vector, b: Vector) -> mp.mpf:
    return mp.fsum(p * q for p, q in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a: Vector) -> Vector:
    length = mp.sqrt(dot(a, a))
    return tuple(p / length for p in a)


def clamp(x: mp.mpf) -> mp.mpf:
    return min(max(x, mp.mpf(0)), mp.mpf(1))


def rounded(a: Vector) -> tuple[np.float32, ...]:
    """The float32 nearest to each component; by way of 53 bits, which matters only in a tie of all digits between."""
    return tuple(np.float32(float(p)) for p in a)


def D_GGX(NoH, alpha) -> mp.mpf:
    """alpha^2 / (pi (1 + (n.h)^2 (alpha^2 - 1))^2); 0 at alpha 0 by agreement: a mirror does not show a point light."""
    NoH, alpha2 = mp.mpf(NoH), mp.mpf(alpha) ** 2
    return alpha2 / (mp.pi * (1 + NoH**2 * (alpha2 - 1)) ** 2) if alpha2 else mp.mpf(0)


def V_SmithGGXCorrelated(NoL, NoV, alpha) -> mp.mpf:
    """0.5 / (mu_o sqrt(alpha^2 + mu_i (mu_i - alpha^2 mu_i)) + mu_i sqrt(alpha^2 + mu_o (mu_o - alpha^2 mu_o)))."""
    i, o, alpha2 = mp.mpf(NoL), mp.mpf(NoV), mp.mpf(alpha) ** 2
    sum_ = o * mp.sqrt(alpha2 + i * (i - alpha2 * i)) + i * mp.sqrt(alpha2 + o * (o - alpha2 * o))
    return mp.mpf("0.5") / sum_ if sum_ else mp.inf


def smith_lambda(cosine, alpha) -> mp.mpf:
    """Smith's Lambda for GGX, (sqrt(1 + alpha^2 tan^2) - 1)/2 (Heitz 2014, eq. 72); G1 = 1/(1 + Lambda)."""
    cosine = mp.mpf(cosine)
    tan2 = (1 - cosine**2) / cosine**2
    return (mp.sqrt(1 + mp.mpf(alpha) ** 2 * tan2) - 1) / 2


def F_Schlick(F0, LoH) -> mp.mpf:
    """F0 + (1 - F0) (1 - (h.l)+)^5."""
    F0 = mp.mpf(F0)
    return F0 + (1 - F0) * (1 - clamp(mp.mpf(LoH))) ** 5


def V_Hammon(NoL, NoV, alpha) -> mp.mpf:
    """0.5 / lerp(2 n.l n.v, n.l + n.v, alpha), Hammon 2017."""
    i, o, alpha = mp.mpf(NoL), mp.mpf(NoV), mp.mpf(alpha)
    return mp.mpf("0.5") / (2 * i * o * (1 - alpha) + (i + o) * alpha)


def shade(l: Vector, v: Vector, n: Vector, m: Material, V=V_SmithGGXCorrelated) -> tuple[mp.mpf, mp.mpf, mp.mpf]:  # noqa: E741
    """(diffuse + specular) (n.l)+; 0 on the back side and at the horizons.

    l and v are taken as they are: their lengths, as rounding leaves them, move h. n is made unit: n.h above 1 has no
    meaning.
    """
    n = unit(n)
    NoL, NoV = dot(n, l), dot(n, v)
    if NoL <= 0 or NoV <= 0:
        return (mp.mpf(0),) * 3
    h = unit(tuple(p + q for p, q in zip(l, v, strict=True)))
    alpha = mp.mpf(m.roughness) ** 2
    metalness = mp.mpf(m.metalness)
    highlight = D_GGX(dot(n, h), alpha) * V(NoL, NoV, alpha) if alpha else mp.mpf(0)
    result = []
    for albedo in map(mp.mpf, m.albedo):
        F = F_Schlick(mp.mpf(0.04) * (1 - metalness) + albedo * metalness, dot(l, h))
        result.append((F * highlight + (1 - metalness) * (1 - F) * albedo / mp.pi) * NoL)
    return tuple(result)


# ---- Scenes ----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Scene:
    """Directions with all their digits, and a material."""

    l: Vector  # noqa: E741
    v: Vector
    n: Vector
    material: Material
    name: str
    upright: bool  # n is +z


def direction(cosine, azimuth) -> Vector:
    """The unit vector at a cosine to +z; the azimuth in turns."""
    cosine = mp.mpf(cosine)
    sine = mp.sqrt(1 - cosine**2)
    return sine * mp.cospi(2 * mp.mpf(azimuth)), sine * mp.sinpi(2 * mp.mpf(azimuth)), cosine


def rotation(axis: Vector, turns) -> list[Vector]:
    """Rodrigues' rotation matrix, as rows."""
    x, y, z = unit(axis)
    c, s = mp.cospi(2 * mp.mpf(turns)), mp.sinpi(2 * mp.mpf(turns))
    return [
        (c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s),
        (y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s),
        (z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)),
    ]


def rotate(rows: list[Vector], a: Vector) -> Vector:
    return tuple(dot(row, a) for row in rows)


ROUGHNESSES = [0.0, 1e-4, 1e-3, 0.01, 0.045, 0.089, 0.2, 0.5, 1.0]
MATERIALS = [((0.0, 0.0, 0.0), 0.0), ((1.0, 1.0, 1.0), 0.0), ((1.0, 0.71, 0.29), 1.0), ((0.8, 0.3, 0.1), 0.5)]
#: (cosine of l, cosine of v, azimuth between them in turns): mirror images, near misses, grazing, ordinary
GEOMETRIES = [
    (1, 1, 0),  # l = v = n
    (0.5, 0.5, 0.5),  # h = n, oblique
    (0.5, 0.5, 0),  # l = v, oblique
    (1e-7, 1e-7, 0.5),  # h = n, at both horizons: l = -v almost
    (1e-7, 1e-7, 0),  # l = v, at the horizon
    (1e-7, 1, 0),
    (1, 1e-7, 0),
    (1e-4, 0.3, 0.4),
    (0.9, 0.9, 0.5001),  # h beside n by a little
    (0.7, 0.7001, 0.5),
    (0.99, 0.98, 0.1),
    (0.3, 0.8, 0.25),
    (-0.3, 0.8, 0.25),  # light behind
    (0.3, -0.8, 0.25),  # viewer behind
    (0, 0.5, 0.3),  # exactly at a horizon
    (0.5, 0, 0.3),
    (0, 0, 0.5),  # l = -v
]
#: None keeps n = +z, where l and v stay exact mirror images of each other after rounding
TURNS = [None, ((1, 2, 3), "0.137"), ((-3, 1, 0.5), "0.41"), ((0.2, -1, 0.7), "0.77"), ((1, 1, -2), "0.29")]


def scenes() -> list[list[Scene]]:
    """Every geometry with every roughness, the materials taken in turn; each in every orientation.

    Exactly at a horizon only upright: turned, the rounding decides on which side of it a vector lies.
    """
    found = []
    for k, (geometry, roughness) in enumerate(itertools.product(GEOMETRIES, ROUGHNESSES)):
        albedo, metalness = MATERIALS[k % len(MATERIALS)]
        turns = TURNS[:1] if 0 in geometry[:2] else TURNS
        found.append([scene(geometry, turn, albedo, metalness, roughness) for turn in turns])
    return found


def scene(geometry, turn, albedo, metalness, roughness) -> Scene:
    """The scene of a geometry, turned as a whole; material numbers are rounded to float32 here, once and for all."""
    cos_l, cos_v, azimuth = geometry
    vectors = [direction(cos_l, 0), direction(cos_v, azimuth), vector(0, 0, 1)]
    if turn:
        rows = rotation(vector(*turn[0]), turn[1])
        vectors = [rotate(rows, a) for a in vectors]
    single = Material(
        tuple(float(np.float32(a)) for a in albedo),
        float(np.float32(metalness)),
        float(np.float32(roughness)),
    )
    name = f"cosines {cos_l}, {cos_v}, azimuth {azimuth}, roughness {roughness}, metalness {metalness}, turn {turn}"
    return Scene(*vectors, single, name, turn is None)


def random_scenes(count: int, seed: int) -> list[Scene]:
    """Directions over the hemisphere and materials over their range, roughness denser where it is small."""
    random = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        geometry = (random.random(), random.random(), random.random())
        turn = (tuple(random.standard_normal(3)), random.random())
        roughness = 10 ** random.uniform(-3, 0)
        found.append(scene(geometry, turn, tuple(random.random(3)), random.choice([0.0, 1.0, 0.3]), roughness))
    return found
