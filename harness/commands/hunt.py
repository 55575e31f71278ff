"""``harness hunt``: the worst inputs of a GLSL function, and a test of them."""

from __future__ import annotations

import argparse
import ast
import contextlib
import shlex
import sys
from collections.abc import Callable, Iterator
from typing import Any

from ..errors import DomainError
from . import _shader

SHORT = "search for the inputs at which a function is at its worst"
DESCRIPTION = """\
Searches a domain for the inputs at which a function of a GLSL file is at its worst: edges first, then inputs drawn
around them, then what lies near the worst so far. Prints the worst input, and a pytest test of it.

  harness hunt shaders/brdf.glsl D_GGX --domain NoH=[0,1] --domain alpha=[0,1]
  harness hunt shaders/brdf.glsl shade --domain l=unit --domain v=unit --domain n=0,0,1 --domain m=[0,1] \\
      --find nonfinite,negative --seconds 60
  harness hunt shaders/brdf.glsl F_Schlick --domain F0=color --domain LoH=[0,1] --find ulp --find monotone:LoH
  harness hunt shaders/color.glsl linear_to_srgb --exhaustive --domain c=[0,1] --find ulp --max-ulp 2000

A domain is an interval such as [0,1] or (0,1], unit (vectors), color, float, int, bool, or a value such as 0.5 or
0,0,1; members of a struct are named m.roughness, and m=[0,1] is all of them. What --find looks for:

  nonfinite      a result that is NaN or infinite (the default)
  negative       a result below 0
  ulp            a result more than --max-ulp ulps off the same source in double
  monotone:X     a result that goes back, by more than --max-ulp ulps, while X goes from one end to the other
  symmetric:A,B  a result that changes, by more than --max-ulp ulps, when A and B change places

The same --seed and number of samples find the same, with any number of workers. --exhaustive tries every float32 of
the one interval instead, for a function of one float, or of one vector that treats its components alike.

Exit codes: 0 nothing was found; 1 something was, or the input is at fault (said on stderr); 2 wrong usage.
"""
TIME_LIMIT = None  # it starts workers, and --seconds limits it


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The file, the function, its domain, what to find and how long."""
    _shader.add_arguments(parser)
    parser.add_argument("function", metavar="FUNCTION", help="its name")
    parser.add_argument("--domain", action="append", default=[], metavar="NAME=DOMAIN", help="where it comes from")
    parser.add_argument("--find", action="append", default=[], metavar="WHAT", help="what to look for (nonfinite)")
    parser.add_argument("--max-ulp", type=float, default=4.0, metavar="U", help="ulps that are let pass (%(default)g)")
    effort = parser.add_mutually_exclusive_group()
    effort.add_argument("--samples", type=int, default=1_000_000, metavar="N", help="evaluations (%(default)s)")
    effort.add_argument("--seconds", type=float, metavar="S", help="as many as S seconds allow")
    effort.add_argument("--exhaustive", action="store_true", help="every float32 of the one interval")
    parser.add_argument("--seed", type=int, default=0, metavar="K", help="of the chance in it (%(default)s)")
    parser.add_argument("--workers", type=int, metavar="N", help="processes (as many as there are cores)")
    parser.add_argument("--scheduler", metavar="tcp://HOST:PORT", help="of a Dask cluster that does the work")
    parser.add_argument("-o", "--output", metavar="TEST.py", help="write the test there instead of printing it")


def run(options: argparse.Namespace) -> int:
    """Prints what was found. 1 when something was."""
    function = _shader.load(options)[options.function]
    domain = {name: _domain(text) for name, text in (_shader.pair(text, "a domain") for text in options.domain)}
    find = [part for text in options.find for part in _parts(text)] or ["nonfinite"]
    if options.exhaustive:
        return _exhaustive(options, function, domain, find)
    from ..searching.hunt import hunt

    with _progress(f"hunting in {options.function}") as progress:
        findings = hunt(
            function,
            domain,
            find,
            samples=options.samples,
            seconds=options.seconds,
            seed=options.seed,
            max_ulp=options.max_ulp,
            scheduler=options.scheduler,
            workers=options.workers,
            progress=progress,
        )
    for finding in findings:
        _print_finding(finding)
    bad = [finding for finding in findings if finding.bad]
    if bad:
        _write_test(bad, options, findings[0].samples)
    return 1 if bad else 0


def _exhaustive(options: argparse.Namespace, function: Any, domain: dict[str, Any], find: list[str]) -> int:
    from ..exhaustive import exhaustive_goals

    with _progress(f"every float of {options.function}") as progress:
        report, bad = exhaustive_goals(
            function,
            domain,
            find,
            max_ulp=options.max_ulp,
            scheduler=options.scheduler,
            workers=options.workers,
            progress=progress,
        )
    print(report)
    return 1 if bad else 0


def _parts(text: str) -> Iterator[str]:
    """The goals of a list: a comma also stands inside ``symmetric:A,B``."""
    parts = text.split(",")
    while parts:
        part = parts.pop(0)
        if part.startswith("symmetric:") and parts:
            part += f",{parts.pop(0)}"
        yield part


def _domain(text: str) -> Any:
    """A value where it is one, such as 0.5 or 0,0,1, else the words of a domain; [0,1] is an interval."""
    if text.startswith(("[", "(")) and text.count(",") == 1 and "[" not in text[1:]:
        return text
    try:
        return ast.literal_eval({"true": "True", "false": "False"}.get(text, text))
    except (ValueError, SyntaxError):
        return text


def _print_finding(finding: Any) -> None:
    from ..comparing.failure import numbers, shown_inputs

    goal, trial = finding.goal, finding.trial
    where = f"{finding.inputs.signature} in {finding.samples} samples"
    if goal.kind in ("nonfinite", "negative") and not finding.bad:
        print(f"{goal}: nothing found of {where}")
        return
    how = "" if goal.kind in ("nonfinite", "negative") else f", {finding.score:.4g} ulp"
    print(f"{goal}: {'found' if finding.bad else 'nothing beyond the limit; the worst'} of {where}{how}")
    for line in shown_inputs(finding.inputs):
        print(f"    {line}")
    if goal.kind == "monotone":
        lower, upper = trial.steps(goal.names[0])
        first, second, *_ = trial.path(goal.names[0])
        print(f"    at {goal.names[0]} = {numbers(lower[0, 0])}: {numbers(first[0])}")
        print(f"    at {goal.names[0]} = {numbers(upper[0, 0])}: {numbers(second[0])}")
        return
    print(f"    got {numbers(trial.got[0])}")
    if goal.kind == "ulp":
        print(f"    in double {numbers(trial.double[0])}")
    if goal.kind == "symmetric":
        print(f"    with {' and '.join(goal.names)} in each other's place {numbers(trial.swapped(*goal.names)[0])}")


def _write_test(bad: list[Any], options: argparse.Namespace, samples: int) -> None:
    from pathlib import Path

    from ..searching.regression import test_module

    words = ["harness", "hunt", options.file, options.function]
    words += [word for text in options.domain for word in ("--domain", text)]
    words += [word for text in options.find for word in ("--find", text)]
    words += [word for text in options.define for word in ("-D", text)]
    words += [word for text in options.include for word in ("-I", text)]
    words += ["--mode", options.mode] if options.mode != "as-written" else []
    words += ["--max-ulp", f"{options.max_ulp:g}", "--samples", str(samples), "--seed", str(options.seed)]
    defines = dict(_shader.pair(text, "a macro") for text in options.define)
    target = Path(options.output) if options.output else None
    text = test_module(bad, options.file, defines, options.include, options.mode, shlex.join(words), target)
    if target is None:
        print(f"\n{text}", end="")
        return
    part = target.with_name(f".{target.name}.part")
    try:
        part.write_text(text)
        part.replace(target)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise DomainError(f"cannot be written: {error.strerror}", target) from None


@contextlib.contextmanager
def _progress(what: str) -> Iterator[Callable[[float], None]]:
    """A bar on stderr, if that is a terminal."""
    if not sys.stderr.isatty():
        yield lambda share: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=1.0)
        yield lambda share: bar.update(task, completed=share)
