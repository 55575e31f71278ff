"""The command line within this process, which may hold a GL context: what holds one must not be forked."""

from __future__ import annotations

from harness import cli


def main(arguments: list[str]) -> int:
    """As ``cli.main``, without a worker process and its limits."""
    return cli._reported(cli._parser().parse_args(arguments))
