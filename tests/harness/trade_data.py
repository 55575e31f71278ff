"""A trade as ``measure`` gives it, with figures of the size of real ones, to be put into words and pictures."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

TARGETS = ("vega10", "navi21", "gfx1100")
LAVAPIPE = {"backend": "osmesa", "device": "llvmpipe (LLVM 15.0.6, 256 bits)"}
GPU = {"backend": "egl", "device": "Some GPU <& more>"}

# Term: title, macro, exact, default, and of each rung the 99th percentile of the model's error and of rounding (as
# written, precise, mediump), cycles on the three chips, and how many extremes are not finite in mediump.
TERMS = {
    "D": ("Distribution", "BRDF_D", "D_EXERCISE", "D_CROSS", {
        "D_EXERCISE": (0, 0.11, 0.13, 1, (316, 122, 122), 21012),
        "D_CROSS": (0, 1.6e-4, 1.6e-4, 0.2, (288, 114, 114), 10),
        "D_ONE_MINUS": (0, 0.16, 0.16, 1, (308, 124, 124), 2782),
        "D_HALF": (0, 2e-4, 2e-4, 0.02, (300, 120, 120), 0),
    }),
    "V": ("Visibility", "BRDF_V", "V_EXACT", "V_EXACT", {
        "V_EXACT": (0, 3e-7, 3e-7, 3e-3, (288, 114, 114), 10),
        "V_HAMMON": (0.27, 2e-7, 2e-7, 2e-3, (248, 106, 106), 0),
        "V_SCHLICK": (0.86, 2e-7, 2e-7, 2e-3, (252, 108, 108), 0),
        "V_KARIS": (0.97, 2e-7, 2e-7, 2e-3, (256, 110, 110), 0),
        "V_SEPARABLE": (0.96, 4e-7, 4e-7, 4e-3, (284, 113, 113), 10),
        "V_KELEMEN": (0.99, 1e-7, 1e-7, 1e-3, (232, 98, 98), 0),
    }),
    "F": ("Fresnel", "BRDF_F", "F_MULTIPLY", "F_MULTIPLY", {
        "F_POW": (0, 3e-6, 3e-6, 4e-2, (320, 118, 118), 0),
        "F_MULTIPLY": (0, 2e-7, 2e-7, 2e-3, (288, 114, 114), 0),
        "F_GAUSSIAN": (0.069, 3e-6, 3e-6, 4e-2, (304, 116, 116), 0),
        "F_DIELECTRIC": (0.2, 3e-7, 3e-7, 3e-3, (352, 134, 134), 0),
        "F_F82": (0.1, 3e-7, 3e-7, 3e-3, (330, 128, 128), 0),
    }),
    "diffuse": ("Diffuse", "BRDF_DIFFUSE", "DIFFUSE_FRESNEL", "DIFFUSE_FRESNEL", {
        "DIFFUSE_FRESNEL": (0, 2e-7, 2e-7, 2e-3, (288, 114, 114), 0),
        "DIFFUSE_LAMBERT": (0.9, 1e-7, 1e-7, 2e-3, (264, 102, 102), 0),
        "DIFFUSE_F0": (0.85, 1e-7, 1e-7, 2e-3, (268, 104, 104), 0),
        "DIFFUSE_SHIRLEY": (0.7, 3e-7, 3e-7, 2e-3, (310, 124, 124), 0),
        "DIFFUSE_BURLEY": (0.6, 3e-7, 3e-7, 2e-3, (364, 154, 154), 0),
        "DIFFUSE_EON": (0.9, 4e-7, 4e-7, 2e-3, (420, 170, 170), 0),
        "DIFFUSE_ENERGY": (0.5, 3e-7, 3e-7, 2e-3, (330, 130, 130), 0),
    }),
    "multi": ("Multiple scattering", "BRDF_MULTI", "MULTI_NONE", "MULTI_NONE", {
        "MULTI_NONE": (0, 0, 0, 0, (288, 114, 114), 0),
        "MULTI_FITTED": (0.4, 3e-7, 3e-7, 2e-3, (320, 128, 128), 0),
    }),
    "decode": ("sRGB decode", "SRGB_DECODE", "SRGB_PIECEWISE", "SRGB_POWER", {
        "SRGB_POWER": (0.9, 2e-6, 2e-6, 2e-2, (408, 148, 148), 0),
        "SRGB_PIECEWISE": (0, 2e-6, 2e-6, 2e-2, (468, 168, 168), 0),
        "SRGB_CUBIC": (0.05, 2e-7, 2e-7, 2e-3, (348, 138, 138), 0),
        "SRGB_SQUARE": (0.99, 6e-8, 6e-8, 6e-4, (300, 120, 120), 0),
    }),
}  # fmt: skip
# Preset: as above, then non-finite in single precision, furnace maximum, scene max and ꟻLIP, ns.
PRESETS = {
    "exercise": (0, 0.11, 0.13, 1, (360, 138, 138), 21012, 50848, 1.857, 9, 0.012, 1.5),
    "exact": (0, 1.6e-4, 1.6e-4, 0.2, (288, 114, 114), 10, 0, 1.857, 0, 0.0, 0.85),
    "desktop": (0.27, 0.16, 0.16, 0.9, (250, 107, 107), 2782, 0, 1.857, 1, 0.009, 0.8),
    "mobile": (0.99, 2e-4, 2e-4, 0.02, (210, 88, 88), 0, 0, 1.9, 23, 0.06, 0.6),
    "offline": (0.5, 1.7e-4, 1.7e-4, 0.25, (480, 190, 190), 12, 0, 1.0004, 12, 0.03, 2.1),
}


def spread(p99: float) -> dict[str, Any]:
    """A distribution of errors with this 99th percentile."""
    return {"median": p99 / 30, "p99": p99, "max": p99 * 3, "at": {"NoL": 0.25, "alpha": 0.01}}


def entry(name: str, macros: dict[str, str], figures: tuple) -> dict[str, Any]:
    model, written, precise, half, cycles, broken_half, broken, furnace, most, flip, ns = figures
    return {
        "name": name,
        "title": f"The {name}",
        "source": "Somebody 2017, p. 84",
        "domain": "everywhere",
        "suits": ["desktop", "mobile"],
        "macros": macros,
        "roundoff": {"as-written": spread(written), "precise": spread(precise), "mediump": spread(half)},
        "model": spread(model),
        "scene": {"max": most, "mean": most / 40, "flip": flip, "changed": most / 50},
        "extremes": {
            "inputs": 1_048_576,
            "as-written": {"non_finite": broken, "negative": 0},
            "precise": {"non_finite": broken, "negative": 3 if broken else 0},
            "mediump": {"non_finite": broken_half, "negative": 0},
            "double": {"non_finite": 0, "negative": 0},
        },
        "energy": {"furnace_max": furnace, "furnace_min": 0.4, "reciprocity": 1e-7},
        "cost": {
            **{
                target: {"instructions": n // 2, "vgprs": 24, "latency": n + 1, "cycles": n}
                for target, n in zip(TARGETS, cycles, strict=True)
            },
            "spirv": cycles[1] - 10,
        },
        "time": [
            {**LAVAPIPE, "ns": ns, "low": ns * 0.9, "high": ns * 1.2, "ratio": ns / 0.85},
            {**GPU, "ns": ns / 100, "low": ns / 110, "high": ns / 90, "ratio": ns / 0.85},
        ],
        "missing": {},
    }


def trade() -> dict[str, Any]:
    """A new one at each call, to be changed at will."""
    terms = []
    for name, (title, macro, exact, default, rungs) in TERMS.items():
        entries = [
            entry(rung, {macro: rung}, (*figures, 0, 1.857, figures[0] * 10, figures[0] / 10, 1.0))
            for rung, figures in rungs.items()
        ]
        terms.append(
            {"name": name, "title": title, "macro": macro, "exact": exact, "default": default, "rungs": entries}
        )
    return copy.deepcopy(
        {
            "schema": 1,
            "machine": {
                "cpu": "Some CPU",
                "driver": "Mesa 22.3.6",
                "glslang": "12.0.0",
                "harness": "0.1.0",
                "costs": "Mesa 22.3.6",
            },
            "targets": list(TARGETS),
            "reference": "exact",
            "scene": {"project": "project.sprj", "size": [64, 36]},
            "terms": terms,
            "presets": [entry(name, {"BRDF_V": "V_EXACT"}, figures) for name, figures in PRESETS.items()],
        }
    )


def without(data: dict[str, Any], part: str, reason: str) -> dict[str, Any]:
    """The trade where a part could not be measured."""
    for measured in every_entry(data):
        measured[part] = None
        measured["missing"][part] = reason
    return data


def every_entry(data: dict[str, Any]) -> list[dict[str, Any]]:
    return data["presets"] + [rung for term in data["terms"] for rung in term["rungs"]]


def pictures() -> dict[str, np.ndarray]:
    """The scene by each preset, (36, 64, 4) uint8: a ramp, brighter by the preset's own largest difference."""
    ramp = np.linspace(0, 200, 64).astype(np.uint8)
    made = {}
    for name, figures in PRESETS.items():
        made[name] = np.full((36, 64, 4), 255, np.uint8)
        made[name][..., :3] = (ramp + np.uint8(figures[8]))[None, :, None]
    return made


def maps() -> dict[str, dict[str, np.ndarray]]:
    """The errors of each rung over the hemisphere of directions, NaN outside."""
    y, x = np.mgrid[-1:1:33j, -1:1:33j]
    r2 = x * x + y * y
    disc = np.where(r2 <= 1, r2, np.nan)
    return {
        rung: {"formula": disc * figures[0], "rounding": disc * figures[2]}
        for term in TERMS.values()
        for rung, figures in term[4].items()
    }
