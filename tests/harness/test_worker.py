"""The worker process: what runs in it cannot hang, crash or exhaust the caller."""

from __future__ import annotations

import subprocess
import sys
import time

import pytest

#: run in a fresh interpreter, as the command line does: this one may hold a GL context, which must not be forked
PRELUDE = """
import os, signal, sys, time
from harness import worker
from harness.errors import HarnessError
"""


def run(code):
    return subprocess.run([sys.executable, "-c", PRELUDE + code], capture_output=True, text=True, timeout=60)


def test_the_exit_code_is_the_works():
    assert run("sys.exit(worker.run(lambda: 3))").returncode == 3


def test_what_the_work_prints_is_printed_once():
    done = run("print('before'); sys.exit(worker.run(lambda: print('within') or 0))")
    assert done.stdout == "before\nwithin\n"


def test_endless_work_is_ended():
    start = time.monotonic()
    done = run(
        "try: worker.run(lambda: time.sleep(1000), seconds=0.2)\nexcept HarnessError as e: print(e)\n"
        "try: os.waitpid(-1, 0)\nexcept ChildProcessError: print('no child is left')"
    )
    assert "ran out of time" in done.stdout
    assert "no child is left" in done.stdout
    assert time.monotonic() - start < 30


@pytest.mark.parametrize("signal", ["SIGSEGV", "SIGABRT", "SIGFPE"])
def test_a_crash_is_an_error(signal):
    done = run(f"try: worker.run(lambda: os.kill(os.getpid(), signal.{signal}))\nexcept HarnessError as e: print(e)")
    assert f"crashed ({signal})" in done.stdout
    assert done.returncode == 0


def test_memory_is_limited():
    done = run("sys.exit(worker.run(lambda: len(bytearray(1 << 32)), memory_bytes=1 << 31))")
    assert done.returncode == 1
    assert "memory" in done.stderr
    assert "Traceback" not in done.stderr


def test_the_work_changes_nothing_in_the_caller():
    assert run("x = []; worker.run(lambda: x.append(1) or 0); sys.exit(len(x))").returncode == 0


def test_a_shader_that_takes_too_long_is_ended(root, tmp_path):
    """A quarter of a million sequences of 60000 sines: half a minute of two cores, were it not for the limit."""
    (tmp_path / "slow.glsl").write_text(
        "float slow(float x, float y) { for (int i = 0; i < 60000; ++i) x = sin(x + y); return x; }\n"
    )
    column, row = ",".join(["[1]"] * 500), ",".join(["1"] * 500)
    command = [sys.executable, "-m", "harness.cli", "call", "slow.glsl", "slow", f"x=[{column}]", f"y=[{row}]"]
    done = subprocess.run([*command, "--time-limit", "1.5"], capture_output=True, text=True, cwd=tmp_path, timeout=60)
    assert done.returncode == 1
    assert "ran out of time after 1.5 s" in done.stderr
