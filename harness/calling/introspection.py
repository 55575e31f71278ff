"""What Python's own tools show of a GLSL function: ``inspect.signature``, and with it help() and editors."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Sequence

from ..language.signature import Signature


def python_signature(overloads: Sequence[Signature]) -> inspect.Signature:
    """Parameters by their GLSL names and types; of several overloads only that they take arguments."""
    kind = inspect.Parameter
    rest = [kind("out", kind.KEYWORD_ONLY, default=None), kind("uniforms", kind.VAR_KEYWORD)]
    if len(overloads) > 1:
        return inspect.Signature([kind("args", kind.VAR_POSITIONAL), *rest])
    signature = overloads[0]
    parameters = [
        kind(p.name + "_" * keyword.iskeyword(p.name), kind.POSITIONAL_OR_KEYWORD, annotation=str(p.type))
        for p in signature.inputs
    ]
    yields = [str(type) for _, type in signature.outputs]
    returned = yields[0] if len(yields) == 1 else f"({', '.join(yields)})"
    rest = [p for p in rest if p.name not in [given.name for given in parameters]]
    return inspect.Signature([*parameters, *rest], return_annotation=returned)
