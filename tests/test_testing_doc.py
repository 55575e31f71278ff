"""What docs/testing.md says, done."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest


@pytest.fixture
def text(root):
    return (root / "docs" / "testing.md").read_text()


def test_its_example_fails_as_shown_and_passes_when_mended(text, tmp_path):
    wrong, right = re.findall(r"```glsl\n(.*?)```", text, re.DOTALL)
    (tmp_path / "test_sphere.py").write_text(re.search(r"```python\n(import.*?)```", text, re.DOTALL)[1])
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--tb=short"]

    (tmp_path / "sphere.glsl").write_text(wrong)
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    shown = re.search(r"```\n(E .*?)```", text, re.DOTALL)[1]
    assert shown in done.stdout and "2 failed" in done.stdout, done.stdout

    (tmp_path / "sphere.glsl").write_text(right)
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0 and "2 passed" in done.stdout, done.stdout


def test_its_call_of_an_isolated_shader_works(text, root, monkeypatch):
    from harness import shader

    monkeypatch.chdir(root / "tests" / "foreign" / "glsl")
    names = {"shader": shader}
    exec(re.search(r"```python\n(noise = .*?)```", text, re.DOTALL)[1], names)
    assert names["noise"].gradient_noise([3.0, 4.0]) == 0
