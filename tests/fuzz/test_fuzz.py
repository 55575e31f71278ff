"""A few cases of the fuzz, always the same, and that it would notice what it looks for. All of it: make fuzz."""

from __future__ import annotations

import os
import random
import signal
import time
import xml.etree.ElementTree as ET

import campaign
import cases
import mutations
import pytest

from harness import HarnessError, ProjectError

SEED, CASES = "of the tests", 60


@pytest.fixture(scope="module")
def projects(root):
    return cases.corpus(root, [])


def test_spoilt_projects_are_read_or_refused(projects):
    """Each is a result or an error that names a file. Without what takes longest: the scene, and drawing."""
    for number in range(CASES):
        project = projects[1 + number % (len(projects) - 1)]
        if cases.describe(project, SEED, number)[0] in ("read", "expand"):
            assert cases.run(project, SEED, number).split(": ")[1] in ("done", "refused")


def test_a_case_is_the_same_every_time(projects):
    for number in range(20):
        data = projects[1].read_bytes()
        first, second = (mutations.spoil(data, "xml", random.Random(number)) for _ in range(2))
        assert first == second


def test_most_spoilt_projects_are_xml_still(projects):
    """Else nothing behind the parser would be tried."""

    def is_xml(data):
        try:
            return ET.fromstring(data) is not None
        except (ET.ParseError, LookupError, ValueError):
            return False

    spoilt = [mutations.spoil(projects[1].read_bytes(), "xml", random.Random(n)) for n in range(100)]
    assert sum(map(is_xml, spoilt)) > 40
    assert len(set(spoilt)) > 90


def test_a_file_that_is_written_is_noticed(projects, monkeypatch):
    monkeypatch.setitem(cases._TARGETS, "read", lambda project, spoilt: open("new", "w").close())
    number = next(n for n in range(100) if cases.describe(projects[1], SEED, n)[0] == "read")
    with pytest.raises(cases.WrongError, match="a file was written"):
        cases.run(projects[1], SEED, number)


@pytest.mark.parametrize("error", [HarnessError("of no file"), ProjectError("", "p.sprj"), ProjectError("x", "p", 0)])
def test_an_error_that_lacks_something_is_noticed(monkeypatch, tmp_path, error):
    def refuse(project, spoilt):
        raise error

    monkeypatch.setitem(cases._TARGETS, "read", refuse)
    with pytest.raises(cases.WrongError):
        cases._try("read", tmp_path, [])


def _crash(project, seed, number):
    os.kill(os.getpid(), signal.SIGKILL)


def _raise(project, seed, number):
    raise KeyError("unexpected")


def _hang(project, seed, number):
    time.sleep(1000)


@pytest.mark.parametrize(
    ("what", "said"), [(_crash, "crashed: SIGKILL"), (_raise, "KeyError: 'unexpected'"), (_hang, "took more than")]
)
def test_crashes_exceptions_and_hangs_are_noticed(projects, monkeypatch, what, said):
    """In a process forked here, where nothing has touched GL: the functions under test are this module's."""
    monkeypatch.setattr(campaign, "run", what)
    monkeypatch.setattr(campaign, "Process", _Forked)
    monkeypatch.setattr(campaign, "CASE_SECONDS", 1.0)
    monkeypatch.setattr(campaign, "describe", lambda *_: ("read", [], None))
    ((number, right, told),) = campaign.fuzz(projects[:1], SEED, None, 1, 1)
    assert (number, right) == (0, False)
    assert said in told


class _Forked:
    """A Process that is forked."""

    def __init__(self, serve, *arguments, memory_bytes):
        import multiprocessing

        context = multiprocessing.get_context("fork")
        self.connection, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs, *arguments), daemon=True)
        self._process.start()
        theirs.close()

    def end(self, patience=0.0):
        self._process.join(patience)
        self._process.kill()
        self._process.join()
        return signal.Signals(-self._process.exitcode).name
