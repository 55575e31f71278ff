"""``harness info``: what computes the numbers."""

from __future__ import annotations

import argparse

SHORT = "show what computes: driver, compiler, processor, versions"
DESCRIPTION = """\
Shows what computes the numbers here, for a report of a result that another machine does not get.

  harness info
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """None."""


def run(options: argparse.Namespace) -> None:
    """Prints a line for each."""
    from ..info import info

    known = info()
    width = max(map(len, known))
    for name, value in known.items():
        print(f"{name:{width}}  {value}")
