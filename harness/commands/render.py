"""``harness render``: a SHADERed project to a PNG."""

from __future__ import annotations

import argparse
import re
import sys

SHORT = "render a .sprj to a PNG"
DESCRIPTION = """\
Renders a SHADERed project (.sprj) to the picture that SHADERed shows of it, without a display or a GPU.

  harness render project.sprj -o picture.png
  harness render project.sprj -o poster.png --size 1920x1080 --supersample 4
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, the picture, its size and quality."""
    parser.add_argument("project", metavar="PROJECT.sprj")
    parser.add_argument("-o", "--output", required=True, metavar="OUT.png", help="the picture to write")
    parser.add_argument("--size", type=_size, default=(1280, 720), metavar="WxH", help="pixels (1280x720)")
    parser.add_argument(
        "--supersample",
        type=int,
        choices=(1, 2, 4, 8),
        default=1,
        help="average N x N pixels into one (1)",
        metavar="N",
    )


def run(options: argparse.Namespace) -> None:
    """Writes the picture."""
    from ..picture import write_png
    from ..render import render

    pixels = render(options.project, options.size, options.supersample)
    write_png(options.output, pixels)
    if sys.stderr.isatty():
        print(f"{options.output}: {options.size[0]} x {options.size[1]}", file=sys.stderr)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{0,4})x([1-9]\d{0,4})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 1280x720")
    return int(match[1]), int(match[2])
