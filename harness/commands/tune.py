"""``harness tune``: the cheapest shaders of a project that keep its picture within a budget."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
from collections.abc import Callable, Iterator
from fractions import Fraction

from ..costing.chips import CHIPS
from .render import size

SHORT = "choose the cheapest rungs that keep a .sprj's picture within a budget"
DESCRIPTION = """\
Looks for what a SHADERed project (.sprj) can do without and still show the same picture, within a budget, from several
views round it. Per pass: maps that are constants, metalness that is all 0 or 1, unread textures and attributes; and of
each term of the ladder (ladder.toml beside the shaders) the cheapest rung. The reference is the project with every term
on the rung of one preset; costs are those of the whole fragment stage on a GPU that need not be there.

  harness tune project.sprj --budget 1/255
  harness tune project.sprj --flip 0.05 --target vega10
  harness tune project.sprj --budget 2/255 --write

The choice is within the budget, and no single step further down is: no cheaper rung of one term in one pass. --write
puts it into the file, of which all other bytes stay.

Exit codes: 0 done, also where there is nothing to gain; 1 the project is at fault; 2 wrong usage.
"""

#: seconds; hundreds of pictures may be drawn
TIME_LIMIT = 900.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, the budget, what it is compared with, from where, and what is done with the answer."""
    parser.add_argument("project", metavar="PROJECT.sprj")
    parser.add_argument(
        "--budget",
        type=_budget,
        metavar="N/255",
        help="how much any channel of any pixel may change (1/255, unless --flip is given)",
    )
    parser.add_argument("--flip", type=_share, metavar="E", help="how large the mean FLIP error of any view may be")
    parser.add_argument(
        "--target", choices=list(CHIPS), default="navi21", metavar="CHIP", help=f"{', '.join(CHIPS)} (navi21)"
    )
    parser.add_argument("--reference", default="exact", metavar="PRESET", help="of the ladder (exact)")
    parser.add_argument(
        "--views", type=_count, default=8, metavar="N", help="round the scene, the project's own first (8)"
    )
    parser.add_argument("--size", type=size, default=(640, 360), metavar="WxH", help="of the pictures (640x360)")
    parser.add_argument("--write", action="store_true", help="write the choice into the project")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="of what is printed (text)")


def run(options: argparse.Namespace) -> None:
    """Prints what was chosen, and writes it where that is asked for."""
    from ..tune import Budget, report, tune

    limit = options.budget
    if limit is None and options.flip is None:
        limit = 1.0
    with _progress() as drawn:
        tuning = tune(
            options.project,
            Budget(limit, options.flip),
            target=options.target,
            reference=options.reference,
            n_views=options.views,
            size=options.size,
            write_back=options.write,
            drawn=drawn,
        )
    if options.format == "json":
        sys.stdout.write(report.as_json(tuning))
    else:
        sys.stdout.write(report.text(tuning, written_to=options.project if options.write else None))


@contextlib.contextmanager
def _progress() -> Iterator[Callable[[], None] | None]:
    """A count of the pictures at a terminal, and nothing elsewhere: nobody knows how many it will take."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("tuning"), BarColumn(), TextColumn("{task.completed:.0f} pictures"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("tuning", total=None)
        yield lambda: bar.advance(task)


def _budget(text: str) -> float:
    """A share such as 1/255 or 0.004, in 1/255."""
    try:
        value = 255 * Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r} is no share such as 1/255") from None
    if not 0 <= value <= 255:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return float(value)


def _share(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and 0 <= value <= 1):
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return value


def _count(text: str) -> int:
    value = int(text)
    if not 1 <= value <= 360:
        raise argparse.ArgumentTypeError(f"{text} is not from 1 to 360")
    return value
