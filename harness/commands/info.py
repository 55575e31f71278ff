"""``harness info``: what computes the numbers, and what each backend can do."""

from __future__ import annotations

import argparse
import json

SHORT = "show what computes: backends, drivers, limits, precision, versions"
DESCRIPTION = """\
Shows what computes here: the versions of the compiler and the libraries, the processor, and for each backend (osmesa,
egl, glfw; HARNESS_BACKEND chooses) its driver, limits and precision, or why it does not work.

  harness info
  harness info --backend egl
  harness info --format json
"""
#: each backend is asked in a process with limits of its own
IN_WORKER = False


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Which backends, and how they are shown."""
    parser.add_argument("--backend", choices=("osmesa", "egl", "glfw"), help="this alone (all)")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="(text)")


def run(options: argparse.Namespace) -> int:
    """Prints them. 1 where the backend that was asked for, or each one, does not work."""
    from ..info import versions
    from ..info_backends import backend, backends

    known = versions()
    found = [backend(options.backend)] if options.backend else backends()
    works = [b for b in found if b.trouble is None]
    if options.format == "json":
        shown = {b.name: {"trouble": b.trouble} if b.trouble else b.facts for b in found}
        print(json.dumps({"versions": known, "backends": shown}, indent=2))
        return 0 if works else 1
    _print_table([[name, value] for name, value in known.items()])
    if works:
        print()
        _print_table(
            [["", *(b.name for b in works)], *([name, *(b.facts[name] for b in works)] for name in works[0].facts)]
        )
    for b in found:
        if b.trouble:
            print(f"\n{b.name} does not work here: {b.trouble}")
    return 0 if works else 1


def _print_table(rows: list[list[str]]) -> None:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(f"{text:{width}}" for text, width in zip(row, widths, strict=True)).rstrip())
