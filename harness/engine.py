"""Which engine evaluates a GLSL function in a mode: the driver, or our interpreter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .evaluation import Evaluation
from .glsl import Source
from .signature import Signature

if TYPE_CHECKING:  # only mode double pays for it
    from .interpretation import Interpretation


def engine(source: Source, signature: Signature, mode: str) -> Evaluation | Interpretation:
    """The function, ready to be evaluated. GlslError and CallError when it cannot be in this mode."""
    if mode == "double":
        from .interpretation import Interpretation

        return Interpretation(source, signature, "float64")
    return Evaluation(source, signature, mode)
