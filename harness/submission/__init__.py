"""A project made ready to hand in: checked, tested, packed with a report, unpacked elsewhere and rendered again."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from ..errors import HarnessError
from ..language.glsl import shown_path
from ..picture import write
from ..processes.worker import MEMORY_BYTES, SECONDS
from ..projects import sprj
from ..projects.project import Project
from . import archive, contents, evidence, exercise, report

REPORT = "report.html"
SIZE, SUPERSAMPLE = (1920, 1080), 2


class Limits(NamedTuple):
    """What checking or drawing the project may take: seconds, and bytes of memory."""

    seconds: float = SECONDS
    memory_bytes: int = MEMORY_BYTES


LIMITS = Limits()


@dataclass(frozen=True)
class Submission:
    """What was written: the archive, the names in it, and its size in bytes."""

    path: Path
    names: tuple[str, ...]
    size: int


def make(
    project: str | os.PathLike,
    output: str | os.PathLike,
    *,
    size: tuple[int, int] = SIZE,
    supersample: int = SUPERSAMPLE,
    tests: bool = True,
    limits: Limits = LIMITS,
    progress: Callable[[str], None] = lambda said: None,
) -> Submission:
    """Writes the archive of a project, whole or not at all. ``progress`` is told each step.

    HarnessError, and nothing is written, when the check finds errors, a test fails, evidence that docs/exercise.toml
    names is not there, or the unpacked archive does not show the same picture.
    """
    path, output = Path(project), Path(output)
    parts = exercise.read(path)
    progress(f"checking {path}")
    findings = _check(path.parent, path.name, limits)
    files = contents.files(path)
    if REPORT in files:
        raise HarnessError(f"the project has a file {REPORT} of its own, where the report goes", path)
    read = sprj.read(path)
    quoted = _quoted(path, read, parts)
    progress(f"rendering {size[0]} x {size[1]}")
    picture = _render(path.parent, path.name, size, supersample, limits)
    found = _evidence(path, read, parts, quoted, tests, progress)
    progress("writing the report")
    files[REPORT] = report.write(path, parts, found, picture, findings, sorted(files)).encode()
    packed = archive.pack(files)
    progress("unpacking it elsewhere, checking and rendering it again")
    _verify(packed, path.name, files, findings, picture, size, supersample, limits)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HarnessError(f"cannot make the folder: {error.strerror}", output.parent) from error
    write(output, lambda file: file.write(packed))
    return Submission(output, tuple(sorted(files)), len(packed))


def _quoted(path: Path, read: Project, parts: exercise.Exercise) -> list[list[evidence.Quoted]]:
    """The lines of shaders for each part. Cheap, so it comes first; so are tests that are not there."""
    evidence.check_tests_exist(parts, path.parent)
    return [[evidence.quote(parts, read, q) for q in part.quotations] for part in parts.parts]


def _evidence(
    path: Path,
    read: Project,
    parts: exercise.Exercise,
    quoted: list[list[evidence.Quoted]],
    tests: bool,
    progress: Callable[[str], None],
) -> report.Evidence:
    """All evidence. The project has been drawn by a process with limits before, so it is drawn in this one."""
    regions = evidence.Regions(parts, read)
    for part in parts.parts:
        for region in part.regions:
            regions.box(region.pass_name)  # before the tests, which take longer
    costs = evidence.costs(parts, path.parent)
    trade = evidence.trade(read, progress)
    results = None
    if tests:
        progress(f"running the tests in {', '.join(parts.tests)}")
        results = evidence.run_tests(parts, path.parent)
    return report.Evidence(quoted, regions, results, costs, trade)


def _check(folder: Path, name: str, limits: Limits) -> list[dict[str, Any]]:
    """The findings of ``harness check`` as its JSON has them, none of them errors."""
    done = _harness(folder, limits, "check", name, "--format", "json")
    try:
        findings = json.loads(done.stdout)["findings"]
    except ValueError:
        raise HarnessError(f"harness check ended with {done.returncode}: {done.stderr.strip()}") from None
    errors = [f for f in findings if f["severity"] == "error"]
    if errors:
        lines = (f"{f['file']}:{f['line']}: {f['code']}: {f['message']}; fix: {f['fix']}" for f in errors)
        raise HarnessError("the check finds errors, so nothing is packed:\n" + "\n".join(lines))
    return findings


def _render(folder: Path, name: str, size: tuple[int, int], supersample: int, limits: Limits) -> np.ndarray:
    """The picture, (h, w, 4) uint8, by a process of its own in the project's folder."""
    with tempfile.TemporaryDirectory() as temporary:
        picture = Path(temporary) / "picture.png"
        how = ["--size", f"{size[0]}x{size[1]}", "--supersample", str(supersample)]
        done = _harness(folder, limits, "render", name, "-o", str(picture), *how)
        if done.returncode:
            raise HarnessError(f"the project cannot be rendered: {done.stderr.strip()}")
        return np.asarray(Image.open(picture).convert("RGBA"))


def _harness(folder: Path, limits: Limits, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A command in a process and a folder of its own: nothing of this one helps it to find files."""
    command: Sequence[str] = (sys.executable, "-P", "-m", "harness.cli", *arguments)
    command = (*command, "--time-limit", str(limits.seconds), "--memory", str(limits.memory_bytes))
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def _verify(
    packed: bytes,
    name: str,
    files: dict[str, bytes],
    findings: list[dict[str, Any]],
    picture: np.ndarray,
    size: tuple[int, int],
    supersample: int,
    limits: Limits,
) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        archive.unpack(packed, folder)
        there = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
        if there != files:
            raise HarnessError(f"unpacked, the archive does not have the files of {shown_path(name)}")
        if _check(folder, name, limits) != findings:
            raise HarnessError("unpacked, the check finds something else: the project depends on what is not packed")
        again = _render(folder, name, size, supersample, limits)
        if not np.array_equal(again, picture):
            raise HarnessError("unpacked, the picture is another: the project depends on what is not packed")
