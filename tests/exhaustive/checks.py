"""What is asked of each function of one float, with bounds a little above what was measured; and the check itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import curves

from harness import shader
from harness.exhaustive import Exhaustive, exhaustive

SHADERS = Path(__file__).resolve().parents[2] / "shaders"


@dataclass(frozen=True)
class Check:
    """A function of shaders/, its reference of ``curves``, and the largest errors that are let pass."""

    file: str
    function: str
    reference: str
    ulp: float
    absolute: float
    back: float
    defines: dict[str, str] = field(default_factory=dict)

    def run(self, stride: int = 1) -> Exhaustive:
        """The function at every ``stride``-th float of 0 ... 1."""
        function = shader(SHADERS / self.file, self.defines)[self.function]
        return exhaustive(function, 0.0, 1.0, getattr(curves, self.reference), stride=stride)

    def hold(self, found: Exhaustive) -> None:
        """That what was found lies within the bounds."""
        print(f"\n{self.function} {self.defines}\n{found}")
        assert found.non_finite == 0
        assert found.negative == 0
        assert found.ulp.size <= self.ulp
        assert found.absolute.size <= self.absolute
        assert found.back.size <= self.back


PIECEWISE = {"SRGB_DECODE": "SRGB_PIECEWISE"}
CUBIC = {"SRGB_DECODE": "SRGB_CUBIC"}
POW = {"BRDF_F": "F_POW"}

CHECKS = {
    "sRGB decode, by the standard": Check(
        "color.glsl", "srgb_to_linear", "srgb_decode", ulp=100, absolute=1e-6, back=100, defines=PIECEWISE
    ),
    "sRGB decode, c^2.2": Check("color.glsl", "srgb_to_linear", "power_decode", ulp=200, absolute=1e-6, back=100),
    "sRGB decode, cubic": Check(
        "color.glsl", "srgb_to_linear", "cubic_decode", ulp=4, absolute=2e-7, back=0, defines=CUBIC
    ),
    "sRGB encode": Check("color.glsl", "linear_to_srgb", "srgb_encode", ulp=100, absolute=1e-6, back=100),
    "Schlick's weight": Check("brdf.glsl", "schlick_weight", "schlick_weight", ulp=100, absolute=1e-6, back=100),
    "Schlick's weight, pow": Check(
        "brdf.glsl", "schlick_weight", "schlick_weight", ulp=100, absolute=1e-6, back=100, defines=POW
    ),
}
