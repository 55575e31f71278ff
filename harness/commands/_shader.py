"""What every command that loads a GLSL file has in common: FILE, -D, -I and --mode."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from ..errors import CallError

if TYPE_CHECKING:
    from ..calling.call import Shader


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, its macros, its include folders, the mode."""
    parser.add_argument("file", metavar="FILE", help="a GLSL file, with or without main()")
    parser.add_argument("-D", "--define", action="append", default=[], metavar="NAME=VALUE", help="a macro")
    parser.add_argument(
        "-I", "--include", action="append", default=[], metavar="DIR", help="where includes are looked for"
    )
    parser.add_argument(
        "--mode", default="as-written", help="the arithmetic: as-written (default), precise, mediump or double"
    )


def load(options: argparse.Namespace) -> Shader:
    """The functions of the file. GlslError when it does not compile."""
    from ..calling.call import shader

    defines = dict(pair(text, "a macro") for text in options.define)
    return shader(options.file, defines, options.include, options.mode)


def pair(text: str, what: str) -> tuple[str, str]:
    """NAME=VALUE as two strings; a macro may have no value, and is 1 then."""
    name, equals, value = text.partition("=")
    if not equals and what == "a macro":
        return name, "1"
    if not equals or not name:
        raise CallError(f"{text!r} is not {what} of the form NAME=VALUE")
    return name, value
