"""Projects of the SHADERed conformance kit: the picture that SHADERed draws, or an error that says why."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from harness import HarnessError, native
from harness.projects.traps import Warning
from harness.rendering.render import render

ROOT = Path(__file__).resolve().parents[2]
COPIES = ROOT / "tests" / "conformance"
KIT = Path(os.environ.get("SHADERED_CONFORMANCE", ROOT.parent / "shared" / "conformance"))

#: cases that do not come out equal to the bit: JPEG decoders differ
NOT_EXACT = ["46-texture-jpeg"]
#: keeps one draw call busy for about half an hour
ENDLESS = "17-endless-loop"


def manifest(kind: str) -> list[dict]:
    path = KIT / "manifest.json"
    return json.loads(path.read_text())[kind] if path.is_file() else []


CASES = manifest("cases")
ERRORS = manifest("errors")
needs_kit = pytest.mark.skipif(not CASES, reason="the conformance kit is not at hand")


def name_of(case: dict) -> str:
    return case["name"]


def differences(expected: Path, actual: np.ndarray, channels: str) -> tuple[np.ndarray, np.ndarray]:
    wanted = np.asarray(Image.open(expected).convert(channels), int)
    assert actual.shape[:2] == wanted.shape[:2]
    return wanted, actual[..., : len(channels)].astype(int)


def check_picture(expected: Path, actual: np.ndarray, tolerance: int = 1, channels: str = "RGB") -> None:
    """The kit's rule: 99.9 % of the pixels within the tolerance, the others on edges and within their range."""
    a, b = differences(expected, actual, channels)
    off = np.abs(a - b).max(-1) > tolerance
    p = np.pad(a, ((1, 1), (1, 1), (0, 0)), mode="edge")
    near = np.stack([p[y : y + a.shape[0], x : x + a.shape[1]] for y in range(3) for x in range(3)])
    low, high = near.min(0), near.max(0)
    edge = ((high - low).max(-1) > 16) & (b >= low - tolerance).all(-1) & (b <= high + tolerance).all(-1)
    largest = np.abs(a - b).max()
    assert off.mean() <= 0.001, f"{off.sum()} pixels are off, by up to {largest}"
    wrong = off & ~edge
    assert not wrong.any(), f"{wrong.sum()} pixels are off that are no edges, by up to {largest}"


@pytest.mark.parametrize("folder", sorted(p for p in COPIES.iterdir() if p.is_dir()), ids=lambda p: p.name)
def test_copied_case(folder):
    height, width = np.asarray(Image.open(folder / "expected.png")).shape[:2]
    check_picture(folder / "expected.png", render(folder / "project.sprj", (width, height)))


@needs_kit
@pytest.mark.parametrize("case", CASES, ids=name_of)
def test_case(case, record_property):
    actual = render(KIT / case["project"], (case["width"], case["height"]))
    expected, channels = KIT / case["expected"], case["channels"]
    a, b = differences(expected, actual, channels)
    record_property("largest difference", int(np.abs(a - b).max()))
    record_property("differing pixels", int((a != b).any(-1).sum()))
    check_picture(expected, actual, case.get("tolerance", 1), channels)


@needs_kit
@pytest.mark.parametrize("case", [c for c in CASES if c["name"] not in NOT_EXACT], ids=name_of)
def test_case_to_the_bit_on_the_same_mesa(case):
    native.open_context()
    if "Mesa 22.3.6" not in native.context_info()["version"]:
        pytest.skip("the kit's pictures are of Mesa 22.3.6")
    actual = render(KIT / case["project"], (case["width"], case["height"]))
    np.testing.assert_array_equal(*differences(KIT / case["expected"], actual, case["channels"]))


def say(case: dict) -> str:
    """What the harness says of a broken project: its error, or where a picture is accepted its warnings."""
    warnings: list[Warning] = []
    try:
        render(KIT / case["project"], (case["width"], case["height"]), warnings=warnings)
    except HarnessError as error:
        return str(error)
    assert case.get("picture_accepted") or (case.get("warning_accepted") and warnings)
    return "\n".join(map(str, warnings))


@needs_kit
@pytest.mark.parametrize("case", [c for c in ERRORS if c["name"] != ENDLESS], ids=name_of)
def test_error(case):
    message = say(case)
    for words in case["must_mention"]:
        assert words.lower() in message.lower()
    if "must_mention_line" in case:
        place = case["must_mention_line"]
        assert any(f"{place['file']}:{line}:" in message for line in place["line"])


@needs_kit
def test_an_endless_loop_is_stopped(tmp_path):
    picture = tmp_path / "p.png"
    command = [sys.executable, "-m", "harness.cli", "render", KIT / "errors" / ENDLESS / "project.sprj"]
    done = subprocess.run(
        [*command, "-o", picture, "--size", "16x12", "--time-limit", "2"], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 1 and "ran out of time" in done.stderr
    assert not picture.exists()
