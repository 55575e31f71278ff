"""The worker process: what runs in it cannot hang, crash or exhaust the caller."""

from __future__ import annotations

import subprocess
import sys
import time

import pytest

#: run in a fresh interpreter, as the command line does: this one may hold a GL context, which must not be forked
PRELUDE = """
import os, signal, sys, time
from harness.processes import worker
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
    assert (done.returncode, done.stderr) == (1, "harness: needs more than 2G of memory; --memory allows more\n")


def test_memory_that_others_see_is_limited():
    """No limit of the system's counts it: it is looked at, and the child ended."""
    work = (
        "m = mmap.mmap(-1, 1 << 29)\ndef fill():\n    for k in range(0, 1 << 29, 4096): m[k] = 1\n    time.sleep(100)\n"
    )
    done = run(f"import mmap\n{work}try: worker.run(fill, memory_bytes=1 << 28)\nexcept HarnessError as e: print(e)")
    assert done.stdout == "needs more than 256M of memory; --memory allows more\n"


def test_processes_of_the_work_have_its_limit():
    start = "[sys.executable, '-c', 'bytearray(1 << 31)']"
    done = run(f"import subprocess; sys.exit(worker.run(lambda: subprocess.call({start}), memory_bytes=1 << 30))")
    assert done.returncode == 1
    assert "MemoryError" in done.stderr


def test_a_crash_for_want_of_memory_says_so():
    """As a C++ library ends: it has most of what it may, gets no more, and aborts."""
    work = "def work():\n    x = bytearray(3 << 28); time.sleep(0.2); os.kill(os.getpid(), signal.SIGABRT)\n"
    done = run(f"{work}try: worker.run(work, memory_bytes=1 << 30)\nexcept HarnessError as e: print(e)")
    assert done.stdout == "needs more than 1G of memory; --memory allows more (SIGABRT)\n"


def test_the_last_words_of_a_library_are_part_of_the_error():
    work = "def work(): os.write(2, b'one\\nassertion failed: x\\n'); os.kill(os.getpid(), signal.SIGSEGV)\n"
    done = run(f"{work}try: worker.run(work)\nexcept HarnessError as e: print(e)")
    assert done.stdout.endswith(": assertion failed: x\n")
    assert done.stderr == ""


def test_what_a_library_prints_is_shown_at_the_end():
    done = run("sys.exit(worker.run(lambda: os.write(2, b'a warning\\n') and print('first', file=sys.stderr) or 0))")
    assert (done.returncode, done.stderr) == (0, "first\na warning\n")


def test_killed_by_the_system():
    done = run("try: worker.run(lambda: os.kill(os.getpid(), signal.SIGKILL))\nexcept HarnessError as e: print(e)")
    assert "was killed (SIGKILL), as the system does when it is short of memory" in done.stdout


def test_the_child_does_not_outlive_its_parent():
    """The parent is killed while its child sleeps; the pipe that both hold is closed when both are gone."""
    code = "worker.run(lambda: print('begun', flush=True) or time.sleep(5) or print('alone', flush=True))"
    with subprocess.Popen([sys.executable, "-c", PRELUDE + code], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout.readline() == "begun\n"
        parent.kill()
        assert parent.stdout.read() == ""


def test_a_file_that_is_being_written_leaves_nothing_when_the_writer_is_killed(tmp_path):
    save = "lambda file: (file.write(b'half'), file.flush(), os.kill(os.getpid(), signal.SIGKILL))"
    done = run(f"from harness.picture import write\nworker.run(lambda: write({str(tmp_path / 'out.png')!r}, {save}))")
    assert "SIGKILL" in done.stderr
    assert list(tmp_path.iterdir()) == []


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


def test_a_process_with_a_context_is_not_forked():
    done = run("from harness import native; native.open_context(); worker.run(lambda: 0)")
    assert "must not be forked" in done.stderr.splitlines()[-1]
