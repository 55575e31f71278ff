"""``harness call``: one call of a GLSL function."""

from __future__ import annotations

import argparse
import ast
import re
from typing import Any

from ..errors import CallError
from . import _shader

SHORT = "call a GLSL function"
DESCRIPTION = """\
Calls a function of a GLSL file and prints what it returns. Values are numbers, vectors as 1,2,3 or [1,2,3], true and
false; members of a struct are given by their names; a longer list is a batch, and everything broadcasts as in numpy.

  harness call shaders/brdf.glsl D_GGX NoH=1 alpha=0.25
  harness call shaders/brdf.glsl F_Schlick F0=0.04,0.04,0.04 LoH=[0,0.5,1]
  harness call shaders/brdf.glsl shade l=0,0,1 v=0,0,1 n=0,0,1 m.albedo=1,1,1 m.metalness=0 m.roughness=0.5
  harness call shaders/color.glsl srgb_to_linear c=0.5,0.5,0.5 -D SRGB_DECODE=SRGB_PIECEWISE
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, the function and its arguments."""
    _shader.add_arguments(parser)
    parser.add_argument("function", metavar="FUNCTION", help="its name")
    parser.add_argument("values", nargs="*", metavar="NAME=VALUE", help="arguments, and uniforms that it reads")


def run(options: argparse.Namespace) -> None:
    """Prints what the function returns."""
    functions = _shader.load(options)
    arguments: dict[str, Any] = {}
    for name, text in (_shader.pair(text, "an argument") for text in options.values):
        *path, last = name.split(".")
        place = arguments
        for part in path:
            place = place.setdefault(part, {})
            if not isinstance(place, dict):
                raise CallError(f"{part} is given both as a value and by its members")
        place[last] = _value(name, text)
    _print_result(functions[options.function](**arguments))


def _value(name: str, text: str) -> Any:
    python = re.sub(r"\b(true|false)\b", lambda m: m[1].capitalize(), text)
    try:
        return ast.literal_eval(python)
    except (ValueError, SyntaxError):
        pass
    try:
        return float(text)  # inf, nan
    except ValueError:
        raise CallError(f"{name}={text}: {text!r} is no number, vector such as 1,2,3, true or false") from None


def _print_result(result: Any) -> None:
    if hasattr(result, "_asdict"):
        for name, value in result._asdict().items():
            print(f"{name} = {_text(value)}")
    else:
        print(_text(result))


def _text(value: Any) -> str:
    """Numbers with all their digits: what is read back is the same float32."""
    if hasattr(value, "_asdict"):
        return "{" + ", ".join(f"{name}: {_text(member)}" for name, member in value._asdict().items()) + "}"
    if getattr(value, "ndim", 0):
        return "[" + ", ".join(_text(element) for element in value) + "]"
    return str(value)
