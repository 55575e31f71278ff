"""Work on many items in parallel: each result once, whatever becomes of the workers, here or on a Dask cluster."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from functools import partial
from pathlib import Path

import pytest

from harness import shader
from harness.errors import CallError, HarnessError
from harness.processes import jobs
from harness.searching.hunt import ISLAND, hunt

# ---- The work: functions of this module, which the workers import ----------------------------------------------------


def squared(x):
    return x * x


def fail_at(wrong, x):
    if x == wrong:
        raise CallError("no such thing", "a.glsl", 7)
    return x


def divided(x):
    return 1 / x


def unsendable(x):
    return lambda: x


def die_once(folder, victim, x):
    """``x``; but the first to work on ``victim`` dies of it, halfway."""
    if x == victim:
        with contextlib.suppress(FileExistsError):
            (folder / "died").mkdir()
            os.kill(os.getpid(), signal.SIGKILL)
    return x


def always_die(folder, x):
    (folder / str(os.getpid())).touch()
    os.kill(os.getpid(), signal.SIGSEGV)


def process_of(x):
    return os.getpid()


def wait_for_ever(folder, x):
    (folder / str(os.getpid())).touch()
    time.sleep(1000)


def fail_beside_a_long_item(folder, x):
    if x == 0:
        wait_for_ever(folder, x)
    eventually(lambda: any(folder.iterdir()))
    raise CallError("no such thing")


def cosines(seconds, file, x):
    """Of one item a call of a shader, and who made it; slow enough for someone to come and kill the worker."""
    from harness import shader

    value = shader(file).wave(x / 8).tobytes()
    (file.parent / "done").joinpath(f"{x}-{time.monotonic_ns()}").write_text(str(os.getpid()))
    time.sleep(seconds)
    return value


# ---- Here ------------------------------------------------------------------------------------------------------------


def test_each_item_has_its_result_once_with_its_index():
    got = list(jobs.run(squared, range(3, 40), workers=2))
    assert sorted(got) == [(i, (i + 3) ** 2) for i in range(37)]


def test_no_items_no_results():
    assert list(jobs.run(squared, [])) == []


def test_the_work_is_done_in_other_processes_as_many_as_asked_for():
    processes = {pid for _, pid in jobs.run(process_of, range(50), workers=2)}
    assert len(processes) == 2 and os.getpid() not in processes


def test_items_are_read_only_as_fast_as_they_are_worked_through():
    """An endless sequence of items can be worked through, and what is left is not waited for."""
    taken = []

    def items():
        x = 0
        while True:
            taken.append(x)
            yield x
            x += 1

    results = jobs.run(squared, items(), workers=2)
    got = [next(results) for _ in range(10)]
    results.close()
    assert len(taken) <= 10 + 2
    assert all(result == index**2 for index, result in got)


def test_an_item_whose_worker_is_killed_is_run_again(tmp_path):
    got = list(jobs.run(partial(die_once, tmp_path, 5), range(12), workers=2))
    assert (tmp_path / "died").exists()
    assert sorted(got) == [(i, i) for i in range(12)]


def test_an_item_that_kills_every_worker_is_named(tmp_path):
    with pytest.raises(HarnessError, match=r"died 3 times \(SIGSEGV\) on item 0: 'the culprit'"):
        list(jobs.run(partial(always_die, tmp_path), ["the culprit"], workers=2))
    assert len(list(tmp_path.iterdir())) == 3


def test_an_error_of_the_work_arrives_with_its_file_and_line():
    with pytest.raises(CallError) as caught:
        list(jobs.run(partial(fail_at, 4), range(8), workers=2))
    assert (caught.value.message, caught.value.file, caught.value.line) == ("no such thing", "a.glsl", 7)
    assert str(caught.value) == "a.glsl:7: no such thing"


def test_any_other_exception_says_where_it_was_raised():
    with pytest.raises(ZeroDivisionError) as caught:
        list(jobs.run(divided, [0], workers=1))
    assert "in divided" in caught.value.__notes__[0]


def test_a_result_that_cannot_be_sent_is_an_error():
    with pytest.raises(TypeError, match="cannot be sent"):
        list(jobs.run(unsendable, [1], workers=1))


def alive(pid: int) -> bool:
    """Whether it runs: a dead child that nobody has waited for does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def eventually(condition, seconds=20.0):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


def test_an_error_ends_what_is_at_work_beside_it(tmp_path):
    with pytest.raises(CallError):
        list(jobs.run(partial(fail_beside_a_long_item, tmp_path), range(2), workers=2))
    (other,) = tmp_path.iterdir()
    assert not alive(int(other.name))


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_outlives_the_caller(tmp_path, sent):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1])\n"
        "from functools import partial; from pathlib import Path\n"
        "import test_jobs; from harness.processes import jobs\n"
        "list(jobs.run(partial(test_jobs.wait_for_ever, Path(sys.argv[2])), range(9), workers=2))\n"
    )
    command = [sys.executable, "-c", code, str(Path(__file__).parent), str(tmp_path)]
    caller = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    try:
        assert eventually(lambda: len(list(tmp_path.iterdir())) == 2), caller.poll()
        workers = [int(path.name) for path in tmp_path.iterdir()]
        assert all(map(alive, workers))
        if sent == signal.SIGINT:
            os.killpg(caller.pid, sent)  # as a terminal's Ctrl-C does
        else:
            caller.send_signal(sent)
        error = caller.communicate(timeout=20)[1]
        assert eventually(lambda: not any(map(alive, workers)))
        assert error.count("Traceback") == (sent == signal.SIGINT)  # the caller's own, and none of a worker's
    finally:
        caller.kill()


# ---- On a cluster ----------------------------------------------------------------------------------------------------


class Cluster:
    """A scheduler and its workers, as someone would start them by hand."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.processes = []
        self.log = folder / "cluster.log"
        where = folder / "scheduler.json"
        self._start("scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", where, "--host", "127.0.0.1")
        assert eventually(lambda: where.is_file() and b"tcp://" in where.read_bytes()), self.log.read_text()
        self.address = re.search(r"tcp://[\d.]+:\d+", where.read_text())[0]

    def _start(self, *arguments, **environment):
        here = {"PYTHONPATH": str(Path(__file__).parent), **environment}
        with open(self.log, "ab") as log:
            started = subprocess.Popen(
                [sys.executable, "-m", "dask", *map(str, arguments)],
                env=os.environ | here,
                stdout=log,
                stderr=log,
                cwd=self.folder,
            )
        self.processes.append(started)
        return started

    def worker(self, *options, **environment):
        return self._start("worker", self.address, "--no-nanny", "--no-dashboard", *options, **environment)

    def end(self, processes):
        for process in processes:
            process.kill()
            process.wait()

    def end_workers(self):
        self.end(self.processes[1:])
        del self.processes[1:]
        log = self.log.read_text
        assert eventually(lambda: log().count("Remove worker") == log().count("Register worker")), log()


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    pytest.importorskip("distributed", reason="dask.distributed is not installed: pip install -e .[cluster]")
    started = Cluster(tmp_path_factory.mktemp("cluster"))
    yield started
    started.end(started.processes)


@pytest.fixture
def cluster(scheduler):
    """A scheduler that has no workers yet."""
    yield scheduler
    scheduler.end_workers()


def test_a_cluster_with_a_worker_killed_in_the_middle_computes_the_same(tmp_path, cluster):
    file = tmp_path / "wave.glsl"
    file.write_text("float wave(float x) { return cos(x) * 3.0; }\n")
    (tmp_path / "done").mkdir()
    here = dict(jobs.run(partial(cosines, 0, file), range(24), workers=1))
    done = {path.name for path in (tmp_path / "done").iterdir()}

    killed = cluster.worker("--nthreads", "1")
    cluster.worker("--nthreads", "1")
    there = {}
    for index, result in jobs.run(partial(cosines, 0.05, file), range(24), scheduler=cluster.address):
        assert index not in there
        there[index] = result
        if killed.poll() is None:
            works = (p for p in (tmp_path / "done").iterdir() if p.name not in done)
            if str(killed.pid) in {path.read_text() for path in works}:
                killed.kill()  # it has the next item in hand
                killed.wait()
    assert killed.returncode == -signal.SIGKILL
    assert there == here and len(there) == 24


def test_a_hunt_on_a_cluster_that_loses_a_worker_finds_the_same(tmp_path, cluster):
    file = tmp_path / "wave.glsl"
    file.write_text("float wave(float x) { return cos(x * 40.0) - 0.999; }\n")
    function, what = shader(file).wave, ({"x": "[0,1]"}, ["negative", "ulp"])
    here = hunt(function, *what, samples=6 * ISLAND, seed=3, workers=1)
    killed = cluster.worker("--nthreads", "1")
    cluster.worker("--nthreads", "1")
    threading.Timer(1.0, killed.kill).start()
    there = hunt(function, *what, samples=6 * ISLAND, seed=3, scheduler=cluster.address)
    assert [(f.score, f.inputs.arguments()) for f in there] == [(f.score, f.inputs.arguments()) for f in here]
    killed.wait()


def test_items_for_a_cluster_are_read_only_as_fast_as_they_are_worked_through(cluster):
    cluster.worker("--nthreads", "1")
    items = iter(range(10**9))
    results = jobs.run(squared, items, scheduler=cluster.address)
    assert sorted(next(results) for _ in range(5)) == [(k, k * k) for k in range(5)]
    results.close()
    assert next(items) <= 5 + 2


def test_an_error_of_the_work_arrives_from_a_cluster(cluster):
    cluster.worker("--nthreads", "1")
    with pytest.raises(CallError, match="a.glsl:7: no such thing"):
        list(jobs.run(partial(fail_at, 1), range(3), scheduler=cluster.address))


def test_a_worker_of_several_threads_is_refused(cluster):
    cluster.worker("--nthreads", "2")
    with pytest.raises(HarnessError, match=r"worker tcp://\S+ runs 2 threads.*--nthreads 1"):
        list(jobs.run(squared, range(3), scheduler=cluster.address))


@pytest.mark.parametrize(
    ("startup", "said"),
    [
        ("import sys; sys.modules['harness'] = None", "has no shader-harness"),
        ("import importlib.metadata as m; m.version = lambda name: '0.0.1'", "has shader-harness 0.0.1"),
    ],
    ids=["none", "another"],
)
def test_a_worker_without_this_version_of_the_package_is_refused(tmp_path, cluster, startup, said):
    (tmp_path / "sitecustomize.py").write_text(startup)
    cluster.worker("--nthreads", "1", PYTHONPATH=str(tmp_path))
    with pytest.raises(HarnessError, match=rf"worker tcp://\S+ {said}, and [\d.]+ is needed: pip"):
        list(jobs.run(squared, range(3), scheduler=cluster.address))


def test_work_that_a_worker_cannot_import_is_an_error(tmp_path, cluster):
    cluster.worker("--nthreads", "1", PYTHONPATH="")
    with pytest.raises(ImportError, match="test_jobs"):
        list(jobs.run(squared, range(3), scheduler=cluster.address))


def test_a_cluster_that_loses_all_workers_is_an_error(tmp_path, cluster, monkeypatch):
    monkeypatch.setattr(jobs, "_WORKERS_SECONDS", 0.5)
    registered = cluster.log.read_text().count("Registered to")
    worker = cluster.worker("--nthreads", "1")
    assert eventually(lambda: cluster.log.read_text().count("Registered to") > registered)
    results = jobs.run(partial(die_once, tmp_path, 1), range(3), scheduler=cluster.address)
    with pytest.raises(HarnessError, match="has no workers"):
        list(results)
    assert worker.wait() == -signal.SIGKILL


def test_a_cluster_without_workers_is_an_error(cluster, monkeypatch):
    monkeypatch.setattr(jobs, "_WORKERS_SECONDS", 0.2)
    with pytest.raises(HarnessError, match=rf"{cluster.address} has no workers; start some with: dask worker"):
        list(jobs.run(squared, range(3), scheduler=cluster.address))


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense://x:1", "tcp://127.0.0.1"])
def test_an_address_where_no_scheduler_answers_is_an_error(monkeypatch, address):
    pytest.importorskip("distributed", reason="dask.distributed is not installed: pip install -e .[cluster]")
    monkeypatch.setattr(jobs, "_CONNECT_SECONDS", 0.3)
    with pytest.raises(HarnessError, match=f"no Dask scheduler answers at {address}"):
        list(jobs.run(squared, range(3), scheduler=address))


def test_without_distributed_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(HarnessError, match=r"pip install 'shader-harness\[cluster\]'"):
        list(jobs.run(squared, range(3), scheduler="tcp://127.0.0.1:8786"))
