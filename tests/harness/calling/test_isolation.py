"""Functions evaluated in a worker process: the same results and errors, and the caller outlives what goes wrong."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from harness import shader
from harness.calling import isolation
from harness.errors import CallError, GlslError, HarnessError

SLOW = """\
float slow(float x, float y) {
    for (int i = 0; i < 60000; ++i) x = sin(x + y);
    return x;
}
float quick(float x) { return x * 2.0; }
"""
#: a quarter of a million of slow()'s sequences: half a minute of two cores
COLUMN, ROW = np.ones((500, 1)), np.ones(500)

TYPES = """\
struct Pair { vec2 v; int n; };
uniform float gain;
uniform vec3 list[2];
Pair pair(Pair p, mat2 m, out bool high, inout uint u) { high = p.v.x > 1.0; u += 1u; return Pair(m * p.v, p.n + 1); }
float gained(float x) { return gain * x + list[1].z; }
"""


def workers() -> set[int]:
    """The worker processes that this one has started and that still run."""
    gc.collect()  # exceptions of other tests hold their frames in circles, and these their shaders
    found = set()
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, parent = path.read_text().rpartition(")")[2].split()[:2]
            ours = int(parent) == os.getpid() and b"harness" in path.with_name("cmdline").read_bytes()
        except OSError:  # gone meanwhile
            continue
        if ours and state != "Z":
            found.add(int(path.parent.name))
    return found


@pytest.fixture
def isolated(functions):
    def load(text, **options):
        return functions(text, isolated=True, **options)

    return load


@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    """One for most tests: whatever they do to its worker, there is another for the next."""
    file = tmp_path_factory.mktemp("isolation") / "test.glsl"
    file.write_text(SLOW)
    return shader(file, isolated=True)


@pytest.fixture
def victim(slow):
    """The worker of ``slow``, which runs."""
    slow.quick(1)
    (process,) = workers()
    return process


# ---- The same as without ---------------------------------------------------------------------------------------------


def test_all_kinds_of_values_come_back_as_they_do_here(functions, isolated, mode):
    arguments = (
        {"v": np.random.default_rng(1).random((7, 2)) * 2, "n": np.arange(7)},
        [[1, 2], [3, 4]],
        np.uint32([5] * 6 + [2**32 - 1]),
    )
    here = functions(TYPES, mode=mode).pair(*arguments)
    there = isolated(TYPES, mode=mode).pair(*arguments)
    assert here._fields == there._fields
    for a, b in zip((*here.result, *here[1:]), (*there.result, *there[1:]), strict=True):
        assert a.dtype == b.dtype and np.array_equal(a, b)
    assert there.high.any() and not there.high.all()


def test_uniforms_are_set_for_each_call(isolated):
    functions = isolated(TYPES)
    assert functions.gained(3.0, gain=2.0, list=[[0, 0, 0], [0, 0, 1]]) == 7
    assert functions.gained([1.0, 2.0], gain=-1.0, list=np.zeros((2, 3))).tolist() == [-1, -2]


@pytest.mark.parametrize("count", [0, 1, 5])
def test_a_batch_of_any_size(slow, count):
    got = slow.quick(np.arange(count))
    assert got.shape == (count,) and got.dtype == np.float32
    assert got.tolist() == [2 * k for k in range(count)]


def test_a_batch_larger_than_the_shared_memory_goes_through_in_parts(slow):
    x = np.arange(isolation._WINDOW_BYTES // 8, dtype=np.float32)  # 4 bytes in and 4 out each, but 12 are reckoned
    assert np.array_equal(slow.quick(x), x * 2)


def test_the_faces_are_the_same(functions, isolated):
    here, there = functions(TYPES), isolated(TYPES)
    assert repr(there) == repr(here) and dir(there) == dir(here)
    assert there.pair.__doc__ == here.pair.__doc__
    assert there.with_mode("precise").gained(1.0, gain=1.0, list=np.zeros((2, 3))) == 1


def test_nothing_is_evaluated_in_the_callers_process(tmp_path):
    """GL is not started here, so that whatever it does, it does it to the worker."""
    (tmp_path / "f.glsl").write_text(SLOW)
    code = (
        "from harness import native, shader, HarnessError\n"
        "assert shader('f.glsl', isolated=True).quick(4) == 8\n"
        "try: native.context_info()\n"
        "except HarnessError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, timeout=60)
    assert "no context" in done.stdout and done.stderr == ""


def test_several_threads_may_call(slow):
    """The context belongs to one thread, and that is the worker's."""
    got = [None] * 4

    def call(k):
        got[k] = [slow.quick(100 * k + i).item() for i in range(20)]

    threads = [threading.Thread(target=call, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert got == [[2 * (100 * k + i) for i in range(20)] for k in range(4)]


# ---- Errors ----------------------------------------------------------------------------------------------------------


def test_an_error_is_the_same_with_its_file_and_line(functions, isolated, slow):
    for text in ("float f(float x) {\n    return y;\n}\n", "float f(float x) { return x; }\nfloat g(float x) {\n"):
        with pytest.raises(GlslError) as here:
            functions(text)
        with pytest.raises(GlslError) as there:
            isolated(text)
        assert str(there.value) == str(here.value) and there.value.line == here.value.line
    with pytest.raises(CallError, match="no mode 'exact'"):
        isolated(SLOW, mode="exact")
    with pytest.raises(CallError, match="quick lacks x"):
        slow.quick()


def test_an_error_that_only_the_compiled_function_makes(isolated):
    """The unset uniform is known from the driver, in the worker."""
    with pytest.raises(CallError, match=r"test.glsl:5: gained reads the uniform float gain"):
        isolated(TYPES).gained(1.0, list=np.zeros((2, 3)))


def test_limits_want_a_process(functions):
    with pytest.raises(CallError, match="isolated=True"):
        functions(SLOW, time_limit=1)


# ---- What goes wrong -------------------------------------------------------------------------------------------------


def test_an_endless_call_is_stopped_and_the_next_works(isolated):
    functions = isolated(SLOW, time_limit=2)
    start = time.monotonic()
    with pytest.raises(HarnessError, match=r"test.glsl:1: slow was stopped: it took longer than its limit of 2 s"):
        functions.slow(COLUMN, ROW)
    assert time.monotonic() - start < 15
    assert functions.quick([3, 4]).tolist() == [6, 8]
    assert np.isfinite(functions.slow(1, 1))  # compiled anew in the new process


@pytest.mark.parametrize("name", ["SIGSEGV", "SIGABRT", "SIGKILL"])
def test_a_crash_in_the_middle_of_a_call_is_an_error_and_the_next_works(slow, victim, name):
    crash = threading.Timer(0.3, os.kill, (victim, getattr(signal, name)))
    crash.start()
    with pytest.raises(HarnessError, match=rf"test.glsl:1: slow: its worker process died \({name}\)"):
        slow.slow(COLUMN, ROW)
    assert slow.quick([3, 4]).tolist() == [6, 8]
    assert victim not in workers()


def test_a_worker_that_died_between_two_calls_costs_one_error(slow, victim):
    os.kill(victim, signal.SIGKILL)
    with pytest.raises(HarnessError, match=r"died \(SIGKILL\)"):
        slow.quick(1)
    assert slow.quick(1) == 2


def test_a_crash_of_the_compiler_is_an_error(isolated, monkeypatch):
    monkeypatch.setattr(isolation, "_compile", _crash)
    functions = isolated(SLOW)
    with pytest.raises(HarnessError, match=r"test.glsl:5: quick: its worker process died \(SIGSEGV\)"):
        functions.quick(1)
    monkeypatch.undo()
    assert functions.quick(1) == 2


def _crash(*arguments):
    os.kill(os.getpid(), signal.SIGSEGV)


def test_a_worker_with_too_little_memory_to_work_is_an_error(isolated):
    with pytest.raises(HarnessError, match=r"worker process died.* \(SIG.*its limit is 1 MiB"):
        isolated(SLOW, memory_limit=1 << 20)


def test_memory_is_limited():
    worker = isolation.Worker(memory_bytes=2 << 30)
    with pytest.raises(HarnessError, match=r"a.glsl:3: f needs more than its limit of 2048 MiB of memory"):
        worker.call("f", ("a.glsl", 3), bytearray, 3 << 30)
    assert len(worker.call("f", ("a.glsl", 3), bytearray, 1 << 20)) == 1 << 20


def test_an_interrupt_leaves_no_answer_for_the_next_call(slow):
    slow.quick(1)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        slow.slow(COLUMN, ROW)
    assert slow.quick([3, 4]).tolist() == [6, 8]


def test_the_process_ends_with_the_shader(isolated):
    before = workers()
    functions = isolated(SLOW)
    assert functions.quick(1) == 2
    assert len(workers()) == len(before) + 1
    del functions
    assert workers() == before
