"""``python -m bench``: one run, one table."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from pathlib import Path

from . import machine, memory, processes, shade, table

EPILOG = """\
what is measured:
  shade     shaders/brdf.glsl over N evaluations, arrays in, a new array out, all compiled and warm: the harness, numpy
            (float32, in blocks), numba (all cores), and moderngl on the same software renderer in two ways. Each in
            its own process, by turns. Who does not agree with the harness is not timed. A sample is the mean over
            calls that fill 0.2 s; "x harness" is the median beside the harness's.
  memory    what one call needs at its peak, with the inputs and the started library already resident:
            (inputs + peak resident set - resident set before) / (inputs + outputs). 1 is the least there can be.
  render    `harness render project.sprj`, from the start of the process to the written PNG. Cold: an empty folder for
            Mesa's compiled shaders; warm: the same folder again.
  import    a fresh Python: import harness, shader(), one D_GGX(1, .25). Cold and warm likewise.

The median counts; min and max show how quiet the machine was. A missed aim is no failure (exit code 0), for a busy
machine misses it; a row that could not be measured, or a contender that disagrees, is (exit code 1). A missing
package is neither. pip install -e ".[bench]" brings numba and moderngl.
"""


def _arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m bench",
        description="Measures the harness beside numpy, numba and moderngl, and prints one table. Takes a minute.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--quick", action="store_true", help="a smoke test: few evaluations, few rounds, no aims")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the table there as Markdown, too")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write all samples, machine and versions there, too")
    return parser.parse_args(arguments)


def _progress(message: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\x1b[K{message}", end="", file=sys.stderr, flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Measures, prints, and gives the exit code."""
    options = _arguments(arguments)
    others = machine.Others()
    if options.quick:
        rows, renderer = shade.rows((1_000, 20_000), rounds=2, seconds=0.01, progress=_progress)
        rows += memory.rows(100_000, rounds=1, progress=_progress)
        rows += processes.render_rows((320, 180), rounds=1, progress=_progress)
        rows += processes.first_call_rows(rounds=1, progress=_progress)
        rows = [dataclasses.replace(row, aim=None) for row in rows]
    else:
        rows, renderer = shade.rows(shade.COUNTS, rounds=9, seconds=0.2, progress=_progress)
        rows += memory.rows(memory.COUNT, rounds=5, progress=_progress)
        rows += processes.render_rows(processes.SIZE, rounds=7, progress=_progress)
        rows += processes.first_call_rows(rounds=7, progress=_progress)
    _progress("")
    described = machine.describe(renderer, others.share())
    print(f"{machine.text(described)}\n{table.text(rows)}", end="")
    if options.markdown:
        options.markdown.write_text(table.markdown(rows), encoding="utf-8")
    if options.json:
        data = described | {"rows": [row.data() for row in rows]}
        options.json.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    return int(any(not row.samples and not row.absent for row in rows))


if __name__ == "__main__":
    sys.exit(main())
