"""Row group 2: the memory that one call of ``shade`` needs at its peak.

A fresh process makes the inputs and calls once with few of them, so that libraries, context and compiled shader are
resident. Then it notes its resident set, sets the kernel's high-water mark back to it, calls with all, and reads it:

    total = inputs + (peak - before)        ratio = total / (inputs + outputs)

The new output array lies in peak - before. 1 is a call that needs nothing beyond its inputs and outputs.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from . import ROOT
from .table import Row

COUNT = 4_000_000
AIM = 3.0
MIB = 1 << 20
_STATUS, _CLEAR_REFS = Path("/proc/self/status"), Path("/proc/self/clear_refs")
_RESET_PEAK = "5"  # proc(5): sets VmHWM back to VmRSS


class Usage(NamedTuple):
    """Bytes: of the arrays, and resident before the call and at its peak."""

    inputs: int
    outputs: int
    before: int
    peak: int

    @property
    def extra(self) -> int:
        """What the call needed beyond its inputs and outputs."""
        return self.peak - self.before - self.outputs

    @property
    def ratio(self) -> float:
        """All that the call needed, in units of inputs + outputs."""
        return (self.inputs + self.outputs + self.extra) / (self.inputs + self.outputs)


def resident(status: str) -> tuple[int, int]:
    """Bytes resident now and at the peak, from the text of /proc/PID/status."""
    fields = dict(line.split(":", 1) for line in status.splitlines() if ":" in line)
    return tuple(int(fields[name].split()[0]) * 1024 for name in ("VmRSS", "VmHWM"))


def usage(count: int) -> Usage:
    """Measures this process, once."""
    from . import shade_harness
    from .inputs import inputs

    shade = shade_harness.contender()
    x = inputs(count)
    shade(inputs(1))
    _CLEAR_REFS.write_text(_RESET_PEAK)
    before, _ = resident(_STATUS.read_text())
    radiance = shade(x)
    _, peak = resident(_STATUS.read_text())
    return Usage(x.nbytes, radiance.nbytes, before, peak)


def rows(count: int, rounds: int, progress) -> list[Row]:
    """The rows, from ``rounds`` fresh processes."""
    measured = f"memory, N = {count:_}".replace("_", " ")
    found = []
    for k in range(rounds):
        progress(f"memory: process {k + 1} of {rounds}")
        done = subprocess.run(
            [sys.executable, "-m", "bench.memory", str(count)], capture_output=True, text=True, cwd=ROOT
        )
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            return [Row(measured, "harness", note=f"could not be measured: {last}")]
        found.append(Usage(*json.loads(done.stdout)))
    sizes = f"inputs {found[0].inputs / MIB:.1f} MiB, outputs {found[0].outputs / MIB:.1f} MiB"
    return [
        Row(
            measured,
            "total",
            "x (inputs + outputs)",
            tuple(u.ratio for u in found),
            aim=AIM if count == COUNT else None,
            note=sizes,
        ),
        Row(measured, "extra", "MiB", tuple(u.extra / MIB for u in found), note="beyond inputs and outputs"),
    ]


if __name__ == "__main__":
    print(json.dumps(usage(int(sys.argv[1]))))
