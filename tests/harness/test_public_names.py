"""``harness`` itself: its names are found when they are asked for, in whatever order its modules are imported."""

from __future__ import annotations

import subprocess
import sys

import pytest

import harness


def run(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_every_public_name_is_there():
    assert all(getattr(harness, name) is not None for name in harness.__all__)
    assert set(harness.__all__) <= set(dir(harness))
    assert {"shader", "render", "assert_ulp", "HarnessError"} <= set(harness.__all__)


def test_a_name_that_is_not_there_is_an_error_of_python():
    with pytest.raises(AttributeError, match="no attribute 'nix'"):
        _ = harness.nix
    with pytest.raises(ImportError):
        exec("from harness import nix")


def test_the_package_alone_imports_nothing_slow():
    assert run("import sys, harness; print({'numpy', 'harness.native'} & {*sys.modules})") == "set()\n"
