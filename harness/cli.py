"""The command line: parses, runs one of the ``commands``, and turns errors into one message and exit code 1."""

from __future__ import annotations

import argparse
import pkgutil
import sys
from collections.abc import Sequence
from importlib import import_module

from . import commands, worker
from .errors import HarnessError


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command. 0: done. 1: the input is at fault, said on stderr. 2: wrong usage."""
    options = _parser().parse_args(arguments)
    try:
        if options.time_limit is None:
            return _reported(options)
        if getattr(options, "watch", False):
            from .watch import follow

            follow(options.project, lambda: _in_worker_reported(options))
        return _in_worker(options)
    except HarnessError as error:
        return _report(error)
    except KeyboardInterrupt:
        return 130


def _in_worker(options: argparse.Namespace) -> int:
    return worker.run(lambda: _reported(options), options.time_limit)


def _in_worker_reported(options: argparse.Namespace) -> int:
    try:
        return _in_worker(options)
    except HarnessError as error:  # the worker's end: out of time, crashed
        return _report(error)


def _reported(options: argparse.Namespace) -> int:
    try:
        return options.run(options) or 0
    except HarnessError as error:
        return _report(error)


def _report(error: HarnessError) -> int:
    print(f"harness: {error}" if error.file is None else str(error), file=sys.stderr)
    return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="harness",
        description="Calls GLSL functions and renders SHADERed projects, without a display or a GPU.",
        epilog="Exit codes: 0 done; 1 the input is at fault, one message says why; 2 wrong usage.",
    )
    listed = parser.add_subparsers(required=True, metavar="COMMAND")
    for name in sorted(module.name for module in pkgutil.iter_modules(commands.__path__)):
        if name.startswith("_"):
            continue
        command = import_module(f"{commands.__name__}.{name}")
        made = listed.add_parser(
            name,
            help=command.SHORT,
            description=command.DESCRIPTION,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        made.set_defaults(run=command.run, time_limit=None)
        command.add_arguments(made)
        seconds = getattr(command, "TIME_LIMIT", worker.SECONDS)
        if seconds is not None:
            made.add_argument(
                "--time-limit",
                type=_positive,
                default=seconds,
                metavar="S",
                help="give up after S seconds (%(default)g)",
            )
    return parser


def _positive(text: str) -> float:
    value = float(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


if __name__ == "__main__":
    sys.exit(main())
