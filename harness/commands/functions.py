"""``harness functions``: what can be called in a GLSL file."""

from __future__ import annotations

import argparse
import textwrap

from . import _shader

SHORT = "list the functions of a GLSL file"
DESCRIPTION = """\
Lists the functions of a GLSL file, those of its includes too: the signature of each, where it is, and the comment
above it.

  harness functions shaders/brdf.glsl
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file."""
    _shader.add_arguments(parser)


def run(options: argparse.Namespace) -> None:
    """Prints a signature and a comment for each function."""
    for function in _shader.load(options):
        first, *rest = function.__doc__.split("\n")
        print(first)
        if rest:
            print(textwrap.indent("\n".join(rest).strip("\n"), "    "))
