"""The ladder's terms in float64 numpy, each as its publication writes it: what the rungs are held against.

Cosines are arrays in 0...1; a colour has its components last. Where float64 would cancel, see reference.py in mpmath.
"""

from __future__ import annotations

import math

import numpy as np

N_DIELECTRIC = 1.5
F0_DIELECTRIC = 0.04

# ---- Distribution, of the squared sine and cosine of the angle between n and h ---------------------------------------


def D_GGX(sin2, cos2, alpha):
    """alpha^2/(pi cos^4 (alpha^2 + tan^2)^2), Walter et al. 2007, eq. 33."""
    return alpha**2 / (math.pi * (cos2 * alpha**2 + sin2) ** 2)


# ---- Visibility ------------------------------------------------------------------------------------------------------


def V_of(G1, NoL, NoV):
    """Masking and shadowing independent: G1(l) G1(v)/(4 NoL NoV)."""
    return G1(NoL) * G1(NoV) / (4 * NoL * NoV)


def V_EXACT(NoL, NoV, LoH, alpha):
    """G = 1/(1 + Lambda(l) + Lambda(v)), Heitz 2014, eq. 99."""

    def smith_lambda(x):
        return (np.sqrt(1 + alpha**2 * (1 - x**2) / x**2) - 1) / 2

    return 1 / (1 + smith_lambda(NoL) + smith_lambda(NoV)) / (4 * NoL * NoV)


def V_HAMMON(NoL, NoV, LoH, alpha):
    return 0.5 / (2 * NoL * NoV * (1 - alpha) + (NoL + NoV) * alpha)


def V_SCHLICK(NoL, NoV, LoH, alpha):
    k = alpha / 2
    return V_of(lambda x: x / (x * (1 - k) + k), NoL, NoV)


def V_KARIS(NoL, NoV, LoH, alpha):
    k = (np.sqrt(alpha) + 1) ** 2 / 8
    return V_of(lambda x: x / (x * (1 - k) + k), NoL, NoV)


def V_SEPARABLE(NoL, NoV, LoH, alpha):
    """G1 = 2/(1 + sqrt(1 + alpha^2 tan^2)), Walter et al. 2007, eq. 34."""
    return V_of(lambda x: 2 / (1 + np.sqrt(1 + alpha**2 * (1 - x**2) / x**2)), NoL, NoV)


def V_KELEMEN(NoL, NoV, LoH, alpha):
    return 1 / (4 * LoH**2) + 0 * NoL


# ---- Fresnel: of a metal of F0, and of the dielectric ----------------------------------------------------------------


def schlick(F0, LoH):
    return F0 + (1 - F0) * (1 - LoH) ** 5


def gaussian(F0, LoH):
    """Karis 2013, eq. 5."""
    return F0 + (1 - F0) * 2 ** ((-5.55473 * LoH - 6.98316) * LoH)


def dielectric(LoH, n=N_DIELECTRIC):
    """Fresnel's equations by way of Snell's law."""
    refracted = np.sqrt(1 - (1 - LoH**2) / n**2)
    perpendicular = (LoH - n * refracted) / (LoH + n * refracted)
    parallel = (n * LoH - refracted) / (n * LoH + refracted)
    return (perpendicular**2 + parallel**2) / 2


def f82(F0, LoH, tint):
    """Schlick's term less a multiple of LoH (1 - LoH)^6 that makes it tint times itself at LoH = 1/7."""
    at7 = schlick(F0, 1 / 7)
    b = at7 * (1 - tint) / (1 / 7 * (1 - 1 / 7) ** 6)
    return np.maximum(schlick(F0, LoH) - b * LoH * (1 - LoH) ** 6, 0)


#: rung -> (F of a metal of F0, F of the dielectric)
FRESNEL = {
    "F_POW": (schlick, lambda LoH: schlick(F0_DIELECTRIC, LoH)),
    "F_MULTIPLY": (schlick, lambda LoH: schlick(F0_DIELECTRIC, LoH)),
    "F_GAUSSIAN": (gaussian, lambda LoH: gaussian(F0_DIELECTRIC, LoH)),
    "F_DIELECTRIC": (schlick, dielectric),
    "F_F82": (lambda F0, LoH: f82(F0, LoH, 0.9), lambda LoH: schlick(F0_DIELECTRIC, LoH)),
}

# ---- Diffuse: pi f over the albedo -----------------------------------------------------------------------------------


def shirley(NoL, NoV):
    """21/(20 pi (1 - F0)) (1 - F(NoL)) (1 - F(NoV)), Shirley et al. 1997, with Schlick's F."""
    left = (1 - schlick(F0_DIELECTRIC, NoL)) * (1 - schlick(F0_DIELECTRIC, NoV))
    return 21 / (20 * (1 - F0_DIELECTRIC)) * left


def burley(NoL, NoV, LoH, roughness):
    """Burley 2012, 5.3: Schlick's weights with F_D90 = 0.5 + 2 roughness cos^2 in the place of 1."""
    F_D90 = 0.5 + 2 * LoH**2 * roughness
    return (1 + (F_D90 - 1) * (1 - NoL) ** 5) * (1 + (F_D90 - 1) * (1 - NoV) ** 5)


EON_G = (0.0571085289, 0.491881867, -0.332181442, 0.0714429953)
EON_C1 = 0.5 - 2 / (3 * math.pi)
EON_C2 = 2 / 3 - 28 / (15 * math.pi)


def eon_albedo(cosine, r):
    """E of single scattering at albedo 1, by the paper's polynomial."""
    g = sum(c * (1 - cosine) ** (k + 1) for k, c in enumerate(EON_G))
    return (1 + r * g) / (1 + EON_C1 * r)


def eon_albedo_exact(cosine, r):
    """The same in closed form, with arc cosines."""
    sine = np.sqrt(1 - cosine**2)
    G = sine * (np.arccos(cosine) - sine * cosine) + 2 / 3 * (sine / cosine * (1 - sine**3) - sine)
    return (1 + r * G / math.pi) / (1 + EON_C1 * r)


def eon(albedo, r, NoL, NoV, LoV, E=eon_albedo):
    """pi f of Portsmouth, Kutz & Hill 2025: single scattering and what is scattered more than once; r > 0."""
    s = LoV - NoL * NoV
    t = np.where(s > 0, np.maximum(NoL, NoV), 1)
    A = 1 / (1 + EON_C1 * r)
    average = A * (1 + EON_C2 * r)
    several = albedo**2 * average / (1 - albedo * (1 - average))
    lost = np.maximum(1 - E(NoL, r), 0) * np.maximum(1 - E(NoV, r), 0) / (1 - average)
    return albedo * A * (1 + r * s / t) + several * lost


# ---- Energy ----------------------------------------------------------------------------------------------------------

#: as fit_energy.py prints them: by powers of s (rows) and of alpha
LOST = np.array(
    [[-0.0573, -0.6919, 6.5766, -1.6653], [2.0016, 6.9193, -26.358, 10.5495], [-2.017, -5.417, 14.841, 25.2172]]
)
#: by powers of s (rows) and of roughness
COSINE = np.array(
    [[0.1594, 2.1103, -3.3692, 1.5715], [-0.1647, -0.4878, 0.0733, 0], [0.0625, -1.1143, 0, 0], [-0.1187, 0, 0, 0]]
)


def energy_lost(NoV, roughness):
    s = NoV / (NoV + roughness**2)
    return np.maximum(s * (1 - s) * np.polynomial.polynomial.polyval2d(s, roughness**2, LOST), 0)


def energy_cosine(NoV, roughness):
    s = NoV / (NoV + roughness**2)
    return np.clip(NoV + roughness * np.polynomial.polynomial.polyval2d(s, roughness, COSINE), 0, 1)


# ---- The whole -------------------------------------------------------------------------------------------------------


def shade(l, v, n, albedo, metalness, roughness, macros):  # noqa: E741
    """(diffuse + D V F compensation) n.l of a model, given by a rung for each of the macros; both cosines positive."""
    n = n / np.linalg.norm(n, axis=-1, keepdims=True)
    H = l + v
    HH = (H * H).sum(-1)
    LoH = np.minimum(np.sqrt(HH) / 2, 1)
    across = np.cross(n, H)
    NoL, NoV, LoV = ((a * b).sum(-1) for a, b in ((n, l), (n, v), (l, v)))
    alpha = roughness**2
    D = D_GGX((across**2).sum(-1) / HH, (n * H).sum(-1) ** 2 / HH, alpha)
    if macros["BRDF_D"] == "D_HALF":
        D = np.minimum(D, 65504)
    V = globals()[macros["BRDF_V"]](NoL, NoV, LoH, alpha)
    of_metal, of_dielectric = FRESNEL[macros["BRDF_F"]]
    NoL, NoV, LoH, LoV, r, m = (x[:, None] for x in (NoL, NoV, LoH, LoV, roughness, metalness))
    F = m * of_metal(albedo, LoH) + (1 - m) * of_dielectric(LoH)
    several = 1.0
    of_dielectric_several = 1.0
    if macros["BRDF_MULTI"] == "MULTI_FITTED":
        lost = energy_lost(NoV, r)
        several = 1 + (m * albedo + (1 - m) * F0_DIELECTRIC) * lost
        of_dielectric_several = 1 + F0_DIELECTRIC * lost
    scattered = {
        "DIFFUSE_FRESNEL": lambda: albedo * (1 - F),
        "DIFFUSE_LAMBERT": lambda: albedo,
        "DIFFUSE_F0": lambda: albedo * (1 - F0_DIELECTRIC),
        "DIFFUSE_SHIRLEY": lambda: albedo * shirley(NoL, NoV),
        "DIFFUSE_BURLEY": lambda: albedo * burley(NoL, NoV, LoH, r),
        "DIFFUSE_EON": lambda: eon(albedo, r, NoL, NoV, LoV),
        "DIFFUSE_ENERGY": lambda: albedo * energy_share(NoV, r, of_dielectric, of_dielectric_several),
    }[macros["BRDF_DIFFUSE"]]()
    return (F * (D * V)[:, None] * several + (1 - m) * scattered / math.pi) * NoL


def energy_share(NoV, roughness, of_dielectric, several):
    """1 - E: E is what all of GGX reflects, the dielectric's F at the effective cosine, and several reflections."""
    return 1 - of_dielectric(energy_cosine(NoV, roughness)) / (1 + energy_lost(NoV, roughness)) * several
