"""Row groups 3 and 4: whole processes, from their start to their end: a picture of the project, and a first call.

Cold is with an empty folder for Mesa's compiled shaders, warm with the same folder again. Programs and libraries are in
the system's file cache either way.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from PIL import Image

from . import ROOT
from .table import Row

SIZE = 1280, 720
RENDER_WARM_AIM = 1.0  # seconds
FIRST_CALL_WARM_AIM = 0.4
FIRST_CALL = "import sys, harness; print(harness.shader(sys.argv[1]).D_GGX(1, .25))"
D_GGX_EXPECTED = 5.093  # 1 / (pi alpha^2)


class ProcessError(Exception):
    """A process did not do its work; the text says what it said."""


def seconds(command: Sequence[str], environment: Mapping[str, str], check: Callable[[str], bool]) -> float:
    """Wall time of a command that must succeed, and whose output on stdout must pass ``check``."""
    start = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, env=environment)
    elapsed = time.perf_counter() - start
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise ProcessError(f"exit code {done.returncode}: {last}")
    if not check(done.stdout):
        raise ProcessError("it succeeded, but what it made is wrong")
    return elapsed


def _cold_and_warm(
    measured: str, rounds: int, run: Callable[[Mapping[str, str]], float], warm_aim: float | None, progress
) -> list[Row]:
    found: dict[str, list[float]] = {"cold": [], "warm": []}
    for k in range(rounds):
        progress(f"{measured}: round {k + 1} of {rounds}")
        with tempfile.TemporaryDirectory() as cache:
            environment = {n: v for n, v in os.environ.items() if n != "MESA_SHADER_CACHE_DISABLE"}
            environment["MESA_SHADER_CACHE_DIR"] = cache
            try:
                for state in found:
                    found[state].append(run(environment))
            except (ProcessError, OSError) as error:
                return [Row(measured, state, note=f"could not be measured: {error}") for state in found]
    return [
        Row(measured, "cold", "s", tuple(found["cold"]), note="no compiled shaders kept"),
        Row(measured, "warm", "s", tuple(found["warm"]), aim=warm_aim),
    ]


def render_rows(size: tuple[int, int], rounds: int, progress: Callable[[str], None]) -> list[Row]:
    """``harness render project.sprj`` to a written PNG."""
    command = Path(sys.executable).with_name("harness")
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"

        def run(environment):
            picture.unlink(missing_ok=True)
            arguments = [command, "render", "project.sprj", "-o", picture, "--size", f"{size[0]}x{size[1]}"]
            return seconds(list(map(str, arguments)), environment, lambda _: _picture_size(picture) == size)

        measured = f"render {size[0]}x{size[1]}"
        return _cold_and_warm(measured, rounds, run, RENDER_WARM_AIM if size == SIZE else None, progress)


def _picture_size(file: Path) -> tuple[int, int]:
    with Image.open(file) as picture:
        return picture.size


def first_call_rows(rounds: int, progress: Callable[[str], None]) -> list[Row]:
    """``import harness``, ``shader()`` and a first ``D_GGX(1, .25)``."""
    command = [sys.executable, "-c", FIRST_CALL, "shaders/brdf.glsl"]

    def run(environment):
        return seconds(command, environment, lambda out: abs(float(out) - D_GGX_EXPECTED) < 1e-3)

    return _cold_and_warm("import and first call", rounds, run, FIRST_CALL_WARM_AIM, progress)
