"""``harness view``: a SHADERed project live in a window."""

from __future__ import annotations

import argparse

from .render import size

SHORT = "show a .sprj live in a window"
DESCRIPTION = """\
Shows a SHADERed project (.sprj) in a window, drawn anew whenever one of its files changes. What is wrong then is said
in the window's title and on stderr, and the last good picture stays. Drag to rotate the camera, turn the wheel to zoom;
H prints the keys: save a picture, write the camera into the .sprj, toggle features, step through the rungs of the
shaders' ladders, show the difference to the reference rungs.

  harness view project.sprj
  harness view project.sprj --size 1920x1080
"""

#: until the user closes it
TIME_LIMIT = None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, and the window's size."""
    parser.add_argument("project", metavar="PROJECT.sprj")
    parser.add_argument("--size", type=size, default=(1280, 720), metavar="WxH", help="pixels (1280x720)")
    parser.add_argument("--frames", type=_count, metavar="N", help="close after N rounds of events and drawing")


def run(options: argparse.Namespace) -> None:
    """Shows it until its window is closed."""
    from ..viewing.view import view

    view(options.project, options.size, options.frames)


def _count(text: str) -> int:
    count = int(text)
    if count < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return count
