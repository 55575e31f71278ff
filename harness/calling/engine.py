"""Which engine evaluates a GLSL function in a mode: the driver, or our interpreter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..language.glsl import Source
from ..language.signature import Signature
from .evaluation import Evaluation

if TYPE_CHECKING:  # only mode double pays for it
    from ..interpreting.interpretation import Interpretation


def engine(source: Source, signature: Signature, mode: str) -> Evaluation | Interpretation:
    """The function, ready to be evaluated. GlslError and CallError when it cannot be in this mode."""
    if mode == "double":
        from ..interpreting.interpretation import Interpretation

        return Interpretation(source, signature, "float64")
    return Evaluation(source, signature, mode)
