"""What the README says, done."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from harness import render, shader


@pytest.fixture
def readme(root):
    return (root / "README.md").read_text()


def test_its_python_runs(root, readme, monkeypatch):
    """All blocks one after another, as a reader would type them."""
    monkeypatch.chdir(root)
    names: dict = {}
    blocks = re.findall(r"```python\n(.*?)```", readme, re.DOTALL)
    for block in blocks:
        exec(block, names)
    assert len(blocks) == 2
    assert names["picture"].shape == (180, 320, 4)


def test_its_session_prints_what_it_shows(root, readme, monkeypatch):
    monkeypatch.chdir(root)
    typed, shown = re.search(r"```pycon\n>>> ([^\n]*)\n(.*?)```", readme, re.DOTALL).groups()
    assert f"{eval(typed, {'shader': shader})}\n" == shown


def test_its_failing_test_is_the_documents(root, readme):
    """docs/testing.md has it whole, and is held to what happens."""
    document = (root / "docs" / "testing.md").read_text()
    block = re.search(r"```\n(def test_sag.*?)```", readme, re.DOTALL)[1]
    for line in block.split("\n"):
        assert line.partition("  #")[0].removesuffix(": ...") in document


def test_its_call_prints_what_it_shows(root, readme):
    command, shown = re.search(r"\$ (harness call .*)\n +(\S+)\n", readme).groups()
    arguments = shlex.split(command)[1:]
    done = subprocess.run([sys.executable, "-m", "harness.cli", *arguments], capture_output=True, text=True, cwd=root)
    assert done.stdout.strip() == shown


def test_its_picture_is_the_projects(root):
    """`harness render project.sprj -o docs/scene.png --size 1280x720 --supersample 2` makes it anew."""
    shown = np.asarray(Image.open(root / "docs" / "scene.png").convert("RGB"), int)
    got = render(root / "project.sprj", (1280, 720), supersample=2)[..., :3].astype(int)
    assert np.abs(got - shown).max() <= 1


def test_its_files_are_there(root, readme):
    for target in re.findall(r"\]\(([^)#]+)\)", readme):
        if not target.startswith("http"):
            assert (root / target).exists(), target


def test_its_macros_are_in_the_shaders(root, readme):
    text = "".join(path.read_text() for path in (root / "shaders").iterdir())
    for macro in re.findall(r"`((?:HAS|BRDF|NORMAL_MAP|SRGB|TONE|METALNESS)[A-Z_]*)`", readme):
        assert macro in text, macro
