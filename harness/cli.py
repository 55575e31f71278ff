"""The command line: parses, runs one of the ``commands``, and turns errors into one message and exit code 1."""

from __future__ import annotations

import argparse
import pkgutil
import sys
from collections.abc import Sequence
from importlib import import_module

from . import commands
from .commands import _limits as limits
from .errors import HarnessError
from .processes import worker


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command. 0: done. 1: the input is at fault, said on stderr. 2: wrong usage."""
    options = _parser().parse_args(arguments)
    try:
        if not options.in_worker:
            return _reported(options)
        if getattr(options, "watch", False):
            from .viewing.watch import follow

            follow(options.project, lambda: _in_worker_reported(options))
        return _in_worker(options)
    except HarnessError as error:
        return _report(error, options)
    except KeyboardInterrupt:
        return 130


def _in_worker(options: argparse.Namespace) -> int:
    return worker.run(lambda: _reported(options), options.time_limit, options.memory)


def _in_worker_reported(options: argparse.Namespace) -> int:
    try:
        return _in_worker(options)
    except HarnessError as error:  # the worker's end: out of time, crashed
        return _report(error, options)


def _reported(options: argparse.Namespace) -> int:
    try:
        return options.run(options) or 0
    except HarnessError as error:
        return _report(error, options)


def _report(error: HarnessError, options: argparse.Namespace) -> int:
    text = f"harness: {error}" if error.file is None else str(error)
    if options.in_worker and worker.SAID_OF_MEMORY.search(error.message):  # a driver's own word
        text += f" ({worker.too_much(options.memory)})"
    print(text, file=sys.stderr)
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
        in_worker = getattr(command, "IN_WORKER", True)
        made.set_defaults(run=command.run, in_worker=in_worker, time_limit=None)
        command.add_arguments(made)
        if in_worker:
            limits.add_arguments(made, getattr(command, "TIME_LIMIT", worker.SECONDS))
    return parser


if __name__ == "__main__":
    sys.exit(main())
