"""``harness submission``: a project made ready to hand in."""

from __future__ import annotations

import argparse
import sys

from . import _limits, render

SHORT = "check, test and pack a .sprj with a report, to hand in"
DESCRIPTION = """\
Packs a SHADERed project to hand it in: the .sprj, the shaders, textures and models that it uses, and report.html, a
page with the picture, the parts of the exercise and the evidence for each. What the parts are is said by
docs/exercise.toml beside the project. Nothing is packed when `harness check` finds errors or a test fails, or when the
archive, unpacked into an empty folder, is not checked and rendered there as here. One project always gives one archive,
byte for byte.

  harness submission
  harness submission project.sprj -o build/submission.zip --no-tests
"""
#: the tests take minutes; the check and the picture are made by processes with limits
IN_WORKER = False


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, the archive, the picture's size, and whether tests are run."""
    parser.add_argument("project", metavar="PROJECT.sprj", nargs="?", default="project.sprj")
    parser.add_argument("-o", "--output", default="build/submission.zip", metavar="OUT.zip", help="(%(default)s)")
    parser.add_argument("--no-tests", action="store_true", help="do not run the tests; the report says so")
    parser.add_argument(
        "--size", type=render.size, default=(1920, 1080), metavar="WxH", help="of the picture (1920x1080)"
    )
    parser.add_argument("--supersample", type=int, choices=(1, 2, 4, 8), default=2, metavar="N", help="(2)")
    _limits.add_arguments(parser, render.TIME_LIMIT)


def run(options: argparse.Namespace) -> None:
    """Writes the archive; at a terminal says what it is doing."""
    from ..submission import Limits, make

    said = _say if sys.stderr.isatty() else lambda text: None
    made = make(
        options.project,
        options.output,
        size=options.size,
        supersample=options.supersample,
        tests=not options.no_tests,
        limits=Limits(options.time_limit, options.memory),
        progress=lambda text: said(f"{text} ..."),
    )
    said(f"{made.path}: {len(made.names)} files, {made.size / 1e6:.1f} MB")


def _say(text: str) -> None:
    print(text, file=sys.stderr)
