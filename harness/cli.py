"""The command line: ``harness render`` and ``harness call``. Turns errors into one message and exit code 1."""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Sequence
from typing import Any

from . import worker
from .errors import CallError, HarnessError

_RENDER_HELP = """\
Renders a SHADERed project (.sprj) to the picture that SHADERed shows of it, without a display or a GPU.

  harness render project.sprj -o picture.png
  harness render project.sprj -o poster.png --size 1920x1080 --supersample 4
"""
_CALL_HELP = """\
Calls a function of a GLSL file and prints what it returns. Values are numbers, vectors as 1,2,3 or [1,2,3], true and
false; members of a struct are given by their names; a longer list is a batch, and everything broadcasts as in numpy.

  harness call shaders/brdf.glsl D_GGX NoH=1 alpha=0.25
  harness call shaders/brdf.glsl F_Schlick F0=0.04,0.04,0.04 LoH=[0,0.5,1]
  harness call shaders/brdf.glsl shade l=0,0,1 v=0,0,1 n=0,0,1 m.albedo=1,1,1 m.metalness=0 m.roughness=0.5
  harness call shaders/color.glsl srgb_to_linear c=0.5,0.5,0.5 -D SRGB_DECODE=SRGB_PIECEWISE
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command. 0: done. 1: the input is at fault, said on stderr. 2: wrong usage."""
    options = _parser().parse_args(arguments)
    try:
        return worker.run(lambda: _reported(options), options.time_limit)
    except HarnessError as error:
        return _report(error)
    except KeyboardInterrupt:
        return 130


def _reported(options: argparse.Namespace) -> int:
    try:
        options.command(options)
    except HarnessError as error:
        return _report(error)
    return 0


def _report(error: HarnessError) -> int:
    print(f"harness: {error}" if error.file is None else str(error), file=sys.stderr)
    return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="harness",
        description="Calls GLSL functions and renders SHADERed projects, without a display or a GPU.",
        epilog="Exit codes: 0 done; 1 the input is at fault, one message says why; 2 wrong usage.",
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, function, short: str, description: str) -> argparse.ArgumentParser:
        made = commands.add_parser(
            name, help=short, description=description, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        made.set_defaults(command=function)
        made.add_argument(
            "--time-limit",
            type=_positive,
            default=worker.SECONDS,
            metavar="S",
            help="give up after S seconds (%(default)g)",
        )
        return made

    render = command("render", _render, "render a .sprj to a PNG", _RENDER_HELP)
    render.add_argument("project", metavar="PROJECT.sprj")
    render.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the picture to write")
    render.add_argument("--size", type=_size, default=(1280, 720), metavar="WxH", help="pixels (1280x720)")
    render.add_argument(
        "--supersample",
        type=int,
        choices=(1, 2, 4, 8),
        default=1,
        help="average N x N pixels into one (1)",
        metavar="N",
    )

    call = command("call", _call, "call a GLSL function", _CALL_HELP)
    call.add_argument("file", metavar="FILE", help="a GLSL file, with or without main()")
    call.add_argument("function", metavar="FUNCTION", help="its name")
    call.add_argument("values", nargs="*", metavar="NAME=VALUE", help="arguments, and uniforms that it reads")
    call.add_argument("-D", "--define", action="append", default=[], metavar="NAME=VALUE", help="a macro")
    call.add_argument(
        "-I", "--include", action="append", default=[], metavar="DIR", help="where includes are looked for"
    )
    call.add_argument("--mode", default="as-written", help="as-written (default), precise or double")
    return parser


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 1280x720")
    return int(match[1]), int(match[2])


def _positive(text: str) -> float:
    value = float(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def _render(options: argparse.Namespace) -> None:
    from .picture import write_png  # not needed, and not paid for, by the other commands
    from .render import render

    pixels = render(options.project, options.size, options.supersample)
    write_png(options.output, pixels)
    if sys.stderr.isatty():
        print(f"{options.output}: {options.size[0]} x {options.size[1]}", file=sys.stderr)


def _call(options: argparse.Namespace) -> None:
    from .call import shader

    defines = dict(_pair(text, "a macro") for text in options.define)
    functions = shader(options.file, defines, options.include, options.mode)
    arguments: dict[str, Any] = {}
    for name, text in (_pair(text, "an argument") for text in options.values):
        *path, last = name.split(".")
        place = arguments
        for part in path:
            place = place.setdefault(part, {})
            if not isinstance(place, dict):
                raise CallError(f"{part} is given both as a value and by its members")
        place[last] = _value(name, text)
    _print_result(functions[options.function](**arguments))


def _pair(text: str, what: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals and what == "a macro":
        return name, "1"
    if not equals or not name:
        raise CallError(f"{text!r} is not {what} of the form NAME=VALUE")
    return name, value


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


if __name__ == "__main__":
    sys.exit(main())
