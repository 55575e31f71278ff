"""``harness call``: one call of a GLSL function."""

from __future__ import annotations

import argparse
import re
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, Any

from ..errors import CallError
from . import _shader

if TYPE_CHECKING:
    from ..calling.function import Function

SHORT = "call a GLSL function"
DESCRIPTION = """\
Calls a function of a GLSL file and prints what it returns. Values are numbers, in decimal or hexadecimal, vectors as
1,2,3 or [1,2,3], true and false; a texture is the path of a picture; members of a struct are given by their names; a
longer list is a batch, and everything broadcasts as in numpy. --mode all compares the modes.

  harness call shaders/brdf.glsl D_GGX NoH=1 alpha=0x1p-2
  harness call shaders/brdf.glsl 'F_Schlick(vec3, float)' F0=0.04,0.04,0.04 LoH=[0,0.5,1]
  harness call shaders/brdf.glsl shade l=0,0,1 v=0,0,1 n=0,0,1 m.albedo=1,1,1 m.metalness=0 m.roughness=0.5
  harness call shaders/color.glsl srgb_to_linear c=0.5,0.5,0.5 -D SRGB_DECODE=SRGB_PIECEWISE
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, the function and its arguments."""
    _shader.add_arguments(parser)
    parser.add_argument("function", metavar="FUNCTION", help="its name, or 'name(vec3, float)' for one overload")
    parser.add_argument("values", nargs="*", metavar="NAME=VALUE", help="arguments, and uniforms that it reads")


def run(options: argparse.Namespace) -> None:
    """Prints what the function returns."""
    compared = options.mode == "all"
    if compared:
        options.mode = "as-written"
    function = _shader.load(options)[options.function]
    arguments = _arguments(function, (_shader.pair(text, "an argument") for text in options.values))
    if compared:
        print(function.compare(**arguments))
    else:
        _print_result(function(**arguments))


def _arguments(function: Function, given: Iterable[tuple[str, str]]) -> dict[str, Any]:
    """Arguments and uniforms by name, structures put together from their members."""
    from ..calling.texture_argument import SAMPLERS, Texture
    from ..language.values import read

    inputs = [p for signature in function.signatures for p in signature.inputs]
    parameters = {p.name for p in inputs}
    textures = {p.name for p in inputs if str(p.type) in SAMPLERS}
    arguments: dict[str, Any] = {}
    for name, text in given:
        try:
            value = Texture(text) if name in textures else read(text)
        except CallError as error:
            raise CallError(f"{name}={text}: {error.message}") from None
        _put(arguments, name, value, parameters)
    return {name: _lists(value) for name, value in arguments.items()}


def _put(arguments: dict[Any, Any], name: str, value: Any, parameters: Collection[str]) -> None:
    """Puts a value in its place: ``m.albedo`` into the dict m, ``l[0].power`` into a dict of dicts.

    The members of a uniform keep their whole names.
    """
    path = [int(part) if part.isdigit() else part for part in re.split(r"\]?[.\[]|\]", name) if part]
    if not path or path[0] not in parameters:
        path = [name]
    place = arguments
    for part in path[:-1]:
        place = place.setdefault(part, {})
        if not isinstance(place, dict):
            raise CallError(f"{part} is given both as a value and by its members")
    if path[-1] in place:
        raise CallError(f"{name} is given twice")
    place[path[-1]] = value


def _lists(value: Any) -> Any:
    """What was given by numbers in brackets as a list, in their order."""
    if not isinstance(value, dict):
        return value
    if all(isinstance(part, int) for part in value):
        return [_lists(value[part]) for part in sorted(value)]
    return {name: _lists(member) for name, member in value.items()}


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
    if isinstance(value, tuple) or getattr(value, "ndim", 0):
        return "[" + ", ".join(_text(element) for element in value) + "]"
    return str(value)
