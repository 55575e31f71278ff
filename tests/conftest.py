"""Fixtures of all tests: the modes, the shader files, and a header that says what computed the numbers."""

from __future__ import annotations

from pathlib import Path

import pytest

import harness
from harness.info import info

ROOT = Path(__file__).resolve().parent.parent

collect_ignore = ["foreign"]  # a repository of its own, which test_foreign.py copies and tests


def pytest_report_header(config):
    return ", ".join(f"{name} {value}" for name, value in info().items())


@pytest.fixture(params=["as-written", "precise"])
def mode(request):
    """Both arithmetics: a driver may rewrite plain code into something better than what was written."""
    return request.param


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def library():
    """Functions of a file in shaders/, compiled once a set of macros: ``library("brdf.glsl", BRDF_F="F_POW")``."""
    compiled = {}

    def load(name: str, mode: str = "as-written", **defines):
        key = (name, mode, tuple(sorted(defines.items())))
        if key not in compiled:
            compiled[key] = harness.shader(ROOT / "shaders" / name, defines=defines, mode=mode)
        return compiled[key]

    return load
