"""``harness mutate``: whether the tests of a GLSL file notice faults in it."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Iterator

SHORT = "say whether the tests of a GLSL file notice faults in it"
DESCRIPTION = """\
Makes mutants of a GLSL file, each with one small fault, and runs the tests that use the file against each. What no test
notices is shown as a difference. The project itself is left alone: the tests run in a copy.

  harness mutate shaders/noise.glsl --tests tests/
  harness mutate shaders/noise.glsl --tests tests/test_noise.py --only value_noise
  harness mutate shaders/noise.glsl --list
  harness mutate shaders/noise.glsl -o report.json --scheduler tcp://host:8786

A mutant that no test can notice, since it computes the same, is listed with the reason in mutation-equivalent.toml
beside the tests:

  [[equivalent]]
  line = "return x * x;"
  ids = ["noise.glsl:square+2:12:arguments:1-2"]
  reason = "..."

Exit code 0: every mutant is noticed or listed. 1: some are not, or the input is at fault.
"""
IN_WORKER = False  # the tests are the user's own, and mutants have limits


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, its tests, which mutants, and where they run."""
    parser.add_argument("file", metavar="FILE", help="a GLSL file")
    parser.add_argument(
        "--tests",
        nargs="+",
        default=[],
        metavar="PATH",
        help="tests or folders (all that pytest finds by itself)",
    )
    parser.add_argument("--only", metavar="FUNCTION", help="mutants of this function alone")
    parser.add_argument("--list", action="store_true", help="show the mutants, and run none")
    parser.add_argument("--equivalent", metavar="FILE.toml", help="mutants that need not be noticed, with reasons")
    parser.add_argument("-o", "--output", metavar="REPORT.json", help="write what became of each mutant")
    parser.add_argument("--workers", type=_count, metavar="N", help="processes (as many as there are cores)")
    parser.add_argument("--scheduler", metavar="tcp://HOST:PORT", help="a Dask scheduler, whose workers do it")


def run(options: argparse.Namespace) -> int:
    """Prints the survivors and the table."""
    from ..mutating import mutate, mutate_equivalents, mutate_project, mutate_report

    listed = options.equivalent
    if listed is None:
        listed = mutate_equivalents.beside(options.tests, mutate_project.find(options.file, options.tests).root)
    equivalents = mutate_equivalents.Equivalents.read(listed) if listed else None
    mutation = mutate.Mutation(options.file, options.tests, options.only, equivalents)
    if options.list:
        print(mutate_report.listing(mutation))
        return 0
    with _progress(mutation.to_run) as done:
        mutation.run(options.workers, options.scheduler, done)
    survivors = [result for result in mutation.results if result.status == "survived"]
    for result in survivors:
        print(mutate_report.difference(mutation, result))
    print(mutate_report.table(mutation.results))
    if options.output:
        mutate_report.write_json(mutation, options.output)
    return 1 if survivors else 0


@contextlib.contextmanager
def _progress(total: int) -> Iterator[Callable[[int], None]]:
    """A bar at a terminal, and nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda count: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("mutants", total=total)
        yield lambda count: bar.advance(task, count)


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value
