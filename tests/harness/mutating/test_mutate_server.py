"""The process that runs a project's tests again and again: what becomes of them, and of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time

import pytest

TESTS = """\
import os, pathlib, subprocess, time

FILE = pathlib.Path(__file__).with_name("f.txt")


def test_first():
    assert os.path.islink(FILE.with_name("large.bin"))
    assert FILE.with_name("large.bin").stat().st_size == 1 << 20


def test_file():
    text = FILE.read_text()
    if text == "hang":
        started = subprocess.Popen(["sleep", "1000"])
        pathlib.Path(os.environ["STARTED"]).write_text(str(started.pid))
        time.sleep(1000)
    while text == "spin":
        pass
    if text == "crash":
        os.kill(os.getpid(), 11)
    assert text in ("as it is", "other")


def test_last():
    assert FILE.read_text() != "neither"
"""


class Asker:
    """The other end of a server."""

    def __init__(self, folder):
        (folder / "tmp").mkdir()
        self.environment = os.environ | {"TMPDIR": str(folder / "tmp"), "STARTED": str(folder / "started")}
        command = [sys.executable, "-m", "harness.mutating.mutate_server"]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(command, env=self.environment, **pipes)
        files = ["test_f.py", "f.txt", "large.bin", "gone.txt"]
        self.send({"root": str(folder), "files": files, "file": "f.txt", "within": ".", "tests": []})

    def send(self, request):
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()

    def run(self, text, warm, seconds=30.0):
        """(status, name of the test) for a text of the file."""
        tests = [[f"test_f.py::{name}", seconds] for name in ("test_last", "test_file")]
        self.send({"text": text, "tests": tests, "warm": warm})
        reply = json.loads(self.process.stdout.readline())
        return reply["status"], (reply["by"] or "").removeprefix("test_f.py::")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("project")
    (folder / "test_f.py").write_text(TESTS)
    (folder / "f.txt").write_text("as it is")
    (folder / "large.bin").write_bytes(bytes(1 << 20))
    return folder


@pytest.fixture(scope="module")
def server(folder):
    asker = Asker(folder)
    yield asker
    asker.process.stdin.close()
    asker.process.wait(20)
    assert list((folder / "tmp").iterdir()) == []


def is_alive(pid):
    """Whether a process is there, and is no zombie that nobody has asked after."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def gone(pid, seconds=10):
    """Whether a killed process disappears: it dies when it next runs, which a busy machine puts off."""
    end = time.monotonic() + seconds
    while is_alive(pid) and time.monotonic() < end:
        time.sleep(0.01)
    return not is_alive(pid)


def test_a_clean_run_says_what_uses_the_file(server):
    server.send({"clean": True})
    found = json.loads(server.process.stdout.readline())
    uses = {name.removeprefix("test_f.py::"): (uses, failed) for name, _, uses, failed in found["tests"]}
    assert uses == {"test_first": ([], None), "test_file": ([["*", "*"]], None), "test_last": ([["*", "*"]], None)}
    assert found["cold"] is False


@pytest.mark.parametrize("warm", [False, True], ids=["collected in each child", "collected once"])
@pytest.mark.parametrize(
    ("text", "want"),
    [
        ("other", ("survived", "")),
        ("wrong", ("killed", "test_file")),
        ("neither", ("killed", "test_last")),
        ("crash", ("killed", "test_file")),
        ("other", ("survived", "")),
    ],
    ids=["passes", "fails", "fails in the first", "crashes", "passes again"],
)
def test_what_becomes_of_a_text(server, warm, text, want):
    assert server.run(text, warm) == want


@pytest.mark.parametrize("warm", [False, True])
def test_a_test_that_hangs_is_stopped_with_all_that_it_started(server, folder, warm):
    assert server.run("hang", warm, 0.3) == ("timeout", "test_file")
    assert gone(int((folder / "started").read_text()))
    assert server.run("spin", warm, 0.3) == ("timeout", "test_file")
    assert server.run("other", warm) == ("survived", "")


def test_it_ends_when_nobody_listens_any_more(folder, tmp_path):
    """Also in the middle of a run."""
    for name in ("test_f.py", "f.txt", "large.bin"):
        (tmp_path / name).symlink_to(folder / name)
    asker = Asker(tmp_path)
    asker.send({"text": "hang", "tests": [["test_f.py::test_file", 100.0]], "warm": True})
    end = time.monotonic() + 30
    while not (tmp_path / "started").exists() and time.monotonic() < end:
        time.sleep(0.02)
    asker.process.stdin.close()
    asker.process.wait(20)
    assert list((tmp_path / "tmp").iterdir()) == []
    assert not is_alive(int((tmp_path / "started").read_text()))
