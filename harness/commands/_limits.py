"""What every command that takes untrusted shaders or projects has in common: --time-limit and --memory."""

from __future__ import annotations

import argparse

from ..processes import worker


def add_arguments(parser: argparse.ArgumentParser, seconds: float | None) -> None:
    """Both limits; only that on memory where ``seconds``, the default, is None."""
    if seconds is not None:
        parser.add_argument(
            "--time-limit",
            "--timeout",
            type=_positive,
            default=seconds,
            metavar="S",
            help="give up after S seconds (%(default)g)",
        )
    parser.add_argument(
        "--memory",
        type=_memory,
        default=worker.MEMORY_BYTES,
        metavar="LIMIT",
        help=f"give up when a process needs more, such as 512M ({worker.shown_memory(worker.MEMORY_BYTES)})",
    )


def _positive(text: str) -> float:
    value = float(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def _memory(text: str) -> int:
    try:
        return worker.memory(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
