"""What the numbers were measured on: without it they say nothing."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import re
import time
from pathlib import Path

PACKAGES = "numpy", "numba", "moderngl"
QUIET = 0.05  # share of the processors that others may use before the table warns of it


class Others:
    """How much of the machine other programs used since this object was made: they slow down what is measured."""

    def __init__(self):
        self._start, self._all, self._own = time.monotonic(), _busy_of_all(), _busy_of_own()

    def share(self) -> float | None:
        """Share of all processors, 0...1; None where the system does not tell."""
        if self._all is None:
            return None
        busy = _busy_of_all() - self._all - (_busy_of_own() - self._own)
        return max(0.0, busy / ((time.monotonic() - self._start) * os.cpu_count()))


def busy_seconds(stat: str, ticks_per_second: int) -> float:
    """Seconds that the processors have worked, from the text of /proc/stat."""
    user, nice, system, _idle, _wait, irq, soft_irq, steal = map(int, stat.splitlines()[0].split()[1:9])
    return (user + nice + system + irq + soft_irq + steal) / ticks_per_second


def _busy_of_all() -> float | None:
    stat = Path("/proc/stat")
    return busy_seconds(stat.read_text(), os.sysconf("SC_CLK_TCK")) if stat.exists() else None


def _busy_of_own() -> float:
    return sum(os.times()[:4])  # our own, and that of the children that have ended


def cpu(cpuinfo: str) -> str:
    """The processor's name, from the text of /proc/cpuinfo."""
    found = re.search(r"^model name\s*:\s*(.+)$", cpuinfo, re.MULTILINE)
    return found[1] if found else platform.processor() or "unknown"


def versions(renderer: str) -> dict[str, str]:
    """Versions of what took part; ``renderer`` is what the harness draws with, and names Mesa's."""
    mesa = re.search(r"Mesa (\S+)", renderer)
    found = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = "not installed"
    return found | {"mesa": mesa[1] if mesa else "unknown"}


def describe(renderer: str, others: float | None) -> dict:
    """All of it; ``others`` is the share of the processors that other programs used meanwhile."""
    cpuinfo = Path("/proc/cpuinfo")
    return {
        "machine": f"{platform.machine()}, {platform.system()} {platform.release()}",
        "cpu": cpu(cpuinfo.read_text() if cpuinfo.exists() else ""),
        "cores": len(os.sched_getaffinity(0)),
        "others": others,
        "renderer": renderer,
        "versions": versions(renderer),
    }


def text(machine: dict) -> str:
    """A line or two that stand above the table."""
    used = ", ".join(f"{name} {version}" for name, version in machine["versions"].items())
    lines = [f"{machine['cpu']}, {machine['cores']} cores, {machine['machine']}; {machine['renderer']}", used]
    if machine["others"] is None or machine["others"] > QUIET:
        share = "an unknown share" if machine["others"] is None else f"{machine['others']:.0%}"
        lines.append(f"NOT QUIET: other programs used {share} of the processors meanwhile; all times are too long.")
    return "\n".join(lines) + "\n"
