"""``harness trade``: what each choice in a shading model costs, and how wrong it is."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

SHORT = "measure accuracy against cost, for every choice in a shading model"
DESCRIPTION = """\
Measures every rung of the ladder that stands beside a project's shaders (ladder.toml), and every preset:

  error     of the formula against the exact one, and of rounding against double
  extremes  how many of a million inputs give a value that is not finite, or negative
  energy    what a white furnace gets back
  scene     how the project's picture changes
  cost      instructions and cycles on GPUs that need not be there (`make cost` installs the driver)
  time      nanoseconds on what computes here

and writes trade.json, trade.md and index.html, a page with plots, maps of the errors and pictures, into a folder. The
first lines of the page, and of the summary that is printed, say which preset to take. A rung or preset alone, by its
name, is measured in seconds; its row is printed, and nothing is written.

  harness trade
  harness trade project.sprj -o build/trade
  harness trade --rung V_HAMMON
"""
#: it takes minutes, and starts workers of its own
TIME_LIMIT = None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, one rung of its ladder, and where to write."""
    parser.add_argument("project", metavar="PROJECT.sprj", nargs="?", default="project.sprj", help="(%(default)s)")
    alone = parser.add_mutually_exclusive_group()
    alone.add_argument("--rung", metavar="NAME", help="this rung or preset alone: print its row")
    alone.add_argument("-o", "--output", metavar="DIR", default="build/trade", help="(%(default)s)")
    parser.add_argument(
        "--readme",
        metavar="README.md",
        help="write the table of the presets into it, between its marks, and docs/trade.json beside it",
    )


def run(options: argparse.Namespace) -> None:
    """Measures, writes the files when all is measured, and prints the summary."""
    from .. import ladder
    from ..projects import sprj
    from ..trade import choices, illustrate, markdown, measure, write

    project = sprj.read(options.project)
    rungs = ladder.of_project(project)
    readme = options.readme and Path(options.readme)
    if readme:
        write.check(readme)  # before the minutes that it takes
    with _progress() as progress:
        data = measure.measure(options.project, rungs, options.rung, progress)
        if options.rung is None:
            said = lambda text: progress(1, 1, text)  # noqa: E731
            pictures = illustrate.pictures(options.project, rungs, said)
            maps = illustrate.maps(choices.choices(project, rungs), said)
    if options.rung is not None:
        print(markdown.row(data, options.rung), end="")
        return
    write.files(Path(options.output), data, pictures, maps)
    if readme:
        write.readme_and_data(readme, data)
    print(markdown.document(data), end="")


@contextlib.contextmanager
def _progress() -> Iterator[Callable[[int, int, str], None]]:
    """A bar at a terminal, and nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda done, total, text: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("measuring", total=None)
        yield lambda done, total, text: bar.update(task, completed=done, total=total, description=text)
