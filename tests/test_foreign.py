"""A repository that is not this one, with GLSL and tests of its own, which has nothing but this package installed."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import pytest

TESTS = 31  # in each mode


@pytest.fixture
def foreign(root, tmp_path):
    return shutil.copytree(root / "tests" / "foreign", tmp_path / "foreign")


def run(folder, *options):
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", *options]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=300)


@pytest.mark.parametrize("processes", [0, 2])
def test_its_tests_pass_in_each_mode_and_the_report_says_what_computed(foreign, processes):
    if processes:
        pytest.importorskip("xdist", reason="pytest-xdist is not installed")
    done = run(foreign, "--junitxml=report.xml", *(["-n", str(processes)] if processes else []))
    assert done.returncode == 0, done.stdout + done.stderr
    assert re.search(rf"\b{2 * TESTS} passed", done.stdout)
    assert len(re.findall(r"^GLSL: \S.*, glslang [\d.]+, ", done.stdout, re.MULTILINE)) == 1

    cases = list(ElementTree.parse(foreign / "report.xml").iter("testcase"))
    properties = [{p.get("name"): p.get("value") for p in case.iter("property")} for case in cases]
    modes = [p["glsl_mode"] for p in properties]
    assert modes.count("as-written") == modes.count("precise") == TESTS
    for told, case in zip(properties, cases, strict=True):
        assert told["glsl_mode"] in re.search(r"\[(.*)\]", case.get("name"))[1]
    assert all("glslang" in p["glsl_driver"] for p in properties)


def test_a_wrong_function_fails_its_test_alone(foreign):
    """The ties between two halves go to the even one; a rounding that is up at every tie is caught."""
    packing = foreign / "glsl" / "packing.glsl"
    text = packing.read_text()
    packing.write_text(text.replace("rest == half_way && (kept & 1u) == 1u", "rest == half_way"))
    assert packing.read_text() != text
    done = run(foreign, "tests/test_packing.py", "-q", "--glsl-modes=as-written")
    assert done.returncode == 1
    assert re.findall(r"^FAILED (\S+)", done.stdout, re.MULTILINE) == [
        "tests/test_packing.py::test_halves_are_rounded_as_numpy_rounds[as-written]"
    ]


def test_a_picture_that_changed_fails_and_can_be_accepted(foreign):
    noise = foreign / "glsl" / "noise.glsl"
    noise.write_text(noise.read_text().replace("0x9E3779B1u", "0x9E3779B3u"))
    options = "tests/test_noise.py", "-q", "--glsl-modes=precise", "-k", "picture"
    done = run(foreign, *options)
    assert done.returncode == 1 and "pytest --update-golden" in done.stdout
    assert "1 failed" in done.stdout
    assert "golden file written" in run(foreign, *options, "--update-golden").stdout
    assert run(foreign, *options).returncode == 0
