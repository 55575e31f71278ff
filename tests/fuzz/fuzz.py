"""Spoils projects at random and looks whether the reader, the include expander, the check and the renderer bear it.

    python tests/fuzz/fuzz.py [--seed S] [--seconds N] [--workers N] [--corpus FOLDER] [--case K [--keep FOLDER]]

Case k of a seed is the same everywhere and at any number of workers. Each runs in a process with limits on time and
memory; what hangs, crashes or raises what is no HarnessError is printed with the command that repeats it.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
from collections import Counter
from pathlib import Path

import campaign
import cases

ROOT = Path(__file__).resolve().parent.parent.parent


def main() -> int:
    """0: everything was borne."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seed", default="")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--workers", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--corpus", action="append", default=[])
    parser.add_argument("--case", type=int)
    parser.add_argument("--keep")
    options = parser.parse_args()
    seed = options.seed or str(random.SystemRandom().randrange(10**6))
    projects = cases.corpus(ROOT, options.corpus)
    again = f"make fuzz SEED={seed}" + "".join(f" CORPUS={folder}" for folder in options.corpus)
    if options.case is not None:
        project = projects[options.case % len(projects)]
        target, spoilt, _ = cases.describe(project, seed, options.case)
        print(f"{target}: {', '.join(map(os.path.relpath, spoilt))}")
        print(cases.run(project, seed, options.case, options.keep))
        return 0
    print(f"seed {seed}, {len(projects)} projects, {options.workers} workers, {options.seconds:g} s", flush=True)
    outcomes: Counter[str] = Counter()
    wrong: dict[str, list[int]] = {}
    for number, right, what in sorted(campaign.fuzz(projects, seed, options.seconds, None, options.workers)):
        outcomes[what if right else "WRONG"] += 1
        if not right:
            wrong.setdefault(what, []).append(number)
    for what, numbers in wrong.items():
        print(f"\n{what.rstrip()}\n{len(numbers)} cases; repeat one: {again} CASE={numbers[0]}")
    print("\n".join(f"{count:8} {what}" for what, count in sorted(outcomes.items())))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
