"""``harness check``: what is wrong with a SHADERed project, without looking at its picture."""

from __future__ import annotations

import argparse
import os
import sys

SHORT = "say what is wrong with a .sprj"
DESCRIPTION = """\
Checks a SHADERed project (.sprj): its shaders by both compilers, uniforms, samplers, textures, models, and what
SHADERed passes over in silence. All findings, each with its place, why it bites and how to mend it.

  harness check project.sprj
  harness check project.sprj --format sarif > check.sarif
  harness check --explain HS503
  harness check --explain all

Exit codes: 0 no errors (with --strict: no warnings either); 1 there are some; 2 wrong usage.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The project, or a code to explain; the format; what counts."""
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("project", metavar="PROJECT.sprj", nargs="?")
    what.add_argument("--explain", metavar="CODE", help="say what a code means, and do nothing else; all: list them")
    parser.add_argument("--format", choices=("text", "json", "sarif"), default="text", help="of the findings (text)")
    parser.add_argument("--strict", action="store_true", help="let warnings make the exit code 1 too")


def run(options: argparse.Namespace) -> int:
    """Prints the findings; 1 where one of them counts."""
    from ..check import check, report
    from ..errors import HarnessError, among

    if options.explain is not None:
        from ..check import RULES

        if options.explain == "all":
            print(report.rules())
        elif options.explain not in RULES:
            raise HarnessError(f"there is no code {options.explain}{among(options.explain, RULES)}")
        else:
            sys.stdout.write(report.explain(options.explain))
        return 0
    found = check(options.project)
    if options.format == "json":
        sys.stdout.write(report.as_json(options.project, found))
    elif options.format == "sarif":
        from importlib.metadata import version

        sys.stdout.write(report.as_sarif(found, version("shader-harness")))
    else:
        color = sys.stdout.isatty() and "NO_COLOR" not in os.environ
        sys.stdout.write(report.text(found, color=color))
    there = report.counts(found)
    return int(there["error"] > 0 or (options.strict and there["warning"] > 0))
