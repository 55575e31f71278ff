"""Projects of the SHADERed conformance kit: no errors in those that SHADERed draws, one in each broken project."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from harness.check import check, report

ROOT = Path(__file__).resolve().parents[3]
KIT = Path(os.environ.get("SHADERED_CONFORMANCE", ROOT.parent / "shared" / "conformance"))
COPIES = sorted((ROOT / "tests" / "conformance").glob("*/project.sprj"))
MANIFEST = KIT / "manifest.json"
KIT_CASES = json.loads(MANIFEST.read_text()) if MANIFEST.is_file() else {"cases": [], "errors": []}

#: what is found in cases that work, apart from what ``harness render`` does not draw: each holds, and is no error
EXPECTED = {
    "04-camera-distance-min": ["HS011"],
    "05-camera-distance-max": ["HS011"],
    "13-constants": ["HS203", "HS202"],
    "14-system-variables": ["HS205"],
    "16-functions": ["HS204"],
    "18-uniform-structs": ["HS207", "HS208"],
    "19-item-values": ["HS210", "HS210"],
    "24-texture-slots-quirk": ["HS301"],
    "25-texture-vflip": ["HS403", "HS403"],
    "32-model-no-tangents": ["HS502"],
    "34-render-texture-mrt": ["HS204"],
    "43-pbr-sphere": ["HS503", "HS503"],
    "46-texture-jpeg": ["HS403"],
}
OF_THE_RENDERER = ("HS007", "HS008", "HS402")  # HS402: kinds of images


def assert_no_errors(project: Path) -> None:
    found = check(project)
    assert [f for f in found if f.severity == "error"] == []
    codes = [f.code for f in found if f.code not in OF_THE_RENDERER]
    assert codes == EXPECTED.get(project.parent.name, [])


@pytest.mark.parametrize("project", COPIES, ids=lambda path: path.parent.name)
def test_a_case_that_works_has_no_errors(project):
    assert_no_errors(project)


@pytest.mark.skipif(not KIT_CASES["cases"], reason="the conformance kit is not at hand")
@pytest.mark.parametrize("case", KIT_CASES["cases"], ids=lambda case: case["name"])
def test_a_case_of_the_kit_has_no_errors(case):
    assert_no_errors(KIT / case["project"])


@pytest.mark.skipif(not KIT_CASES["errors"], reason="the conformance kit is not at hand")
@pytest.mark.parametrize("case", KIT_CASES["errors"], ids=lambda case: case["name"])
def test_a_broken_project_is_reported_as_the_manifest_says(case):
    found = check(KIT / case["project"])
    assert [f for f in found if f.severity == "error"]
    text = report.text(found).replace("\\", "/").lower()
    assert all(part.lower() in text for part in case["must_mention"])
    if "must_mention_line" in case:
        wanted = case["must_mention_line"]
        assert any(f.file.endswith(wanted["file"]) and f.line in wanted["line"] for f in found)
    if case.get("must_not_mention_file_content"):
        assert Path("/etc/hostname").read_text().strip().lower() not in text
