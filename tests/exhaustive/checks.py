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

#: a quarter above what was measured where pow() takes part, which differs from one maker's processor to the other's
CHECKS = {
    "sRGB decode, by the standard": Check(
        "color.glsl", "srgb_to_linear", "srgb_decode", ulp=20, absolute=7e-7, back=0, defines=PIECEWISE
    ),
    "sRGB decode, c^2.2": Check("color.glsl", "srgb_to_linear", "power_decode", ulp=150, absolute=5e-7, back=0),
    "sRGB decode, cubic": Check(
        "color.glsl", "srgb_to_linear", "cubic_decode", ulp=2.4, absolute=1.1e-7, back=0, defines=CUBIC
    ),
    # the standard's own two pieces do not meet: at 0.0031308 the curve goes back by 7 ulp, once
    "sRGB encode": Check("color.glsl", "linear_to_srgb", "srgb_encode", ulp=14, absolute=3.5e-7, back=8),
    "Schlick's weight": Check("brdf.glsl", "schlick_weight", "schlick_weight", ulp=6.9, absolute=2.7e-7, back=0),
    "Schlick's weight, pow": Check(
        "brdf.glsl", "schlick_weight", "schlick_weight", ulp=110, absolute=1.1e-6, back=0, defines=POW
    ),
}
