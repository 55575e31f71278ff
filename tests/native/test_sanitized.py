"""The C library's own tests, under AddressSanitizer and UndefinedBehaviorSanitizer."""

from __future__ import annotations

import shutil
import subprocess

import pytest


@pytest.mark.skipif(not shutil.which("cmake") or not shutil.which("ninja"), reason="cmake and ninja build the C tests")
def test_the_c_library_passes_its_tests_under_the_sanitizers(root):
    build = root / "build" / "sanitize"
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DHARNESS_TESTS=ON", "-DHARNESS_SANITIZE=ON"]
    for command in (
        ["cmake", "-S", root, "-B", build, *options],
        ["cmake", "--build", build],
        ["ctest", "--test-dir", build, "--output-on-failure"],
    ):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
