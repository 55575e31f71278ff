"""What is told of the machine and the libraries."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from harness import info_backends, native
from harness.info import info
from harness.info_backends import backend


def test_the_versions_are_those_of_the_packages():
    known = info()
    assert re.fullmatch(r"\d+\.\d+\.\d+", known["glslang"])
    assert known["numpy"] == version("numpy") and known["shader-harness"] == version("shader-harness")
    assert known["OpenGL"].startswith(("3.", "4."))


@pytest.mark.skipif(not Path("/var/lib/dpkg").is_dir(), reason="asks Debian for the versions of its packages")
def test_mesa_and_glslang_are_those_that_debian_installed():
    asked = ["dpkg-query", "-W", "-f", "${Package}=${Version}\n", "libosmesa6", "glslang-dev"]
    told = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    versions = dict(line.split("=") for line in told.splitlines())
    assert versions["libosmesa6"].startswith(info()["Mesa"])
    assert versions["glslang-dev"].startswith(info()["glslang"])


def test_the_processor_has_a_name():
    names = re.findall(r"^model name\s*: (.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    assert info()["CPU"] in names or not names


def run(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "harness.cli", "info", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=100)


@pytest.fixture(scope="module")
def osmesa():
    """What is told of the default backend."""
    known = backend("osmesa")
    assert known.trouble is None
    return known.facts


def test_limits_are_at_least_what_opengl_promises(osmesa):
    """OpenGL 3.3 core, table 6.48 and on."""
    least = {"texture side": 1024, "3D texture side": 256, "cube map side": 1024, "array layers": 256}
    least |= {"buffer texels": 65536, "render buffer side": 1024, "colour attachments": 8, "draw buffers": 8}
    least |= {"samples (MSAA)": 4, "vertex attributes": 16, "varyings, floats": 60, "fragment samplers": 16}
    least |= {"vertex uniforms, floats": 1024, "fragment uniforms, floats": 1024, "samplers in all": 48}
    for name, promised in least.items():
        assert int(osmesa[name]) >= promised, name
    assert osmesa["viewport"] == f"{osmesa['render buffer side']} x {osmesa['render buffer side']}"


def test_highp_is_single_precision(osmesa):
    """GLSL ES 3.20, 4.7.4: at least 2^-126 ... 2^127 and 23 bits; a signed integer of 32 bits."""
    assert re.fullmatch(r"2\^-12[67] ... 2\^127, 23 bits", osmesa["highp float"])
    assert osmesa["highp int"].startswith("-2^31")


def test_what_is_measured_on_llvmpipe(osmesa):
    """llvmpipe multiplies and adds apart, also in fma(), by SSE: to nearest. It flushes denormals where it draws."""
    if "llvmpipe" not in osmesa["driver"]:
        pytest.skip("another driver")
    assert osmesa["rounding"] == "to nearest, ties to even"
    for name in ("a * b + c", "precise a * b + c", "fma(a, b, c)"):
        assert osmesa[name] == "two roundings"
    assert (osmesa["denormals"], osmesa["denormals, drawn"]) == ("kept", "flushed to 0")
    assert osmesa["modes"].startswith("as-written, precise") and osmesa["modes"].endswith("double")


@pytest.mark.parametrize(
    ("rounded", "named"),
    [
        (np.float32, "to nearest, ties to even"),
        (lambda x: np.float32(math.trunc(x * 2**23) / 2**23), "toward 0"),
        (lambda x: np.float32(math.copysign(math.ceil(abs(x) * 2**23), x) / 2**23), "away from 0"),
        (
            lambda x: np.float32(math.copysign(math.floor(abs(x) * 2**23 + 0.5), x) / 2**23),
            "to nearest, ties away from 0",
        ),
    ],
)
def test_roundings_are_told_apart(rounded, named):
    probes = SimpleNamespace(sum=lambda a, b: rounded(float(a) + float(b)))
    assert info_backends._rounding(probes) == named


def test_contraction_is_noticed():
    exact = lambda a, b, c: np.float32(float(a) * float(b) + float(c))  # noqa: E731
    assert info_backends._contraction(exact) == "one rounding (fused)"
    assert info_backends._contraction(lambda a, b, c: np.float32(a * b) + c) == "two roundings"


def test_the_command_shows_a_column_for_each_backend_that_works():
    done = run()
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert re.split(r"  +", lines[0]) == ["shader-harness", version("shader-harness")]
    heading = next(line for line in lines if line.startswith(" "))
    driver = next(line for line in lines if line.startswith("driver "))
    assert driver[heading.index("osmesa") :].startswith(info()["driver"])
    told = {line.split()[0] for line in lines if " does not work here: " in line}
    assert set(heading.split()) | told == set(native.BACKENDS)


def test_a_backend_that_does_not_work_is_a_line_and_exit_code_1():
    environment = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    done = run("--backend", "glfw", **environment)
    assert done.returncode == 1
    assert "glfw does not work here: " in done.stdout.splitlines()[-1] and "display" in done.stdout
    told = json.loads(run("--format", "json", **environment).stdout)["backends"]
    assert list(told["glfw"]) == ["trouble"] and told["osmesa"]["driver"]


def test_a_backend_that_crashes_or_hangs_is_told(monkeypatch):
    monkeypatch.setattr(info_backends, "_serve", _crash)
    assert backend("osmesa").trouble == "its process died (SIGSEGV)"
    monkeypatch.setattr(info_backends, "_serve", _hang)
    monkeypatch.setattr(info_backends, "SECONDS", 0.1)
    assert backend("osmesa").trouble == "does not answer within 0.1 s"


def _crash(connection, name):
    os.kill(os.getpid(), signal.SIGSEGV)


def _hang(connection, name):
    time.sleep(1000)
