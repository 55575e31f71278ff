"""Fixtures of the calling journey's tests."""

from __future__ import annotations

import pytest

from harness import shader


@pytest.fixture
def functions(tmp_path):
    """Compiles a text; what comes back has a function of GLSL as each of its attributes."""

    def compile(text: str, **options):
        path = tmp_path / "test.glsl"
        path.write_text(text)
        return shader(path, **options)

    return compile
