"""``harness mutate`` in a project of its own: which mutants are noticed, by which tests, and what it leaves behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from harness import HarnessError
from harness.mutating.mutate import Mutation

SHADER = """\
// blend.glsl
#ifndef GAIN
#define GAIN 2.0
#endif

float gain(float x)
{
    return x * GAIN;
}

float limited(float x)
{
#if SOFT
    return x / 4.0;
#else
    return min(gain(x), 1.0);
#endif
}

float unnoticed(float x)
{
    return x - 3.0;
}

float square(float x)
{
    return x * x;
}
"""
TESTS = '''\
"""A project that is not ours."""

import numpy as np
import pytest

from harness import shader


@pytest.fixture(scope="session")
def blend():
    return shader("shaders/blend.glsl")


def test_gain(blend):
    assert blend.gain([1.0, 2.5]).tolist() == [2.0, 5.0]


@pytest.mark.parametrize("x", [0.25, 3.0])
def test_limited(blend, x):
    assert blend.limited(x) == min(2 * x, 1)


def test_soft():
    assert shader("shaders/blend.glsl", defines={"SOFT": 1}).limited([2.0, 3.0]).tolist() == [0.5, 0.75]


def test_unnoticed(blend):
    assert np.isfinite(blend.unnoticed(1.0))


def test_square(blend):
    assert blend.square(3.0) == 9


def test_of_something_else():
    assert True
'''


def command(folder, *arguments):
    return [sys.executable, "-m", "harness.cli", "mutate", *map(str, arguments)], {
        "cwd": folder,
        "env": os.environ | {"TMPDIR": str(folder / "tmp")},
    }


def mutate(folder, *arguments):
    words, options = command(folder, *arguments)
    return subprocess.run(words, capture_output=True, text=True, timeout=120, **options)


def left_over(folder):
    """What is in the temporary folder, a moment later: workers clear up when their input ends."""
    end = time.monotonic() + 20
    while time.monotonic() < end and any((folder / "tmp").iterdir()):
        time.sleep(0.05)
    return list((folder / "tmp").iterdir())


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Makes the project, with other texts where they are given."""

    def make(shader=SHADER, tests=TESTS):
        folder = tmp_path_factory.mktemp("project")
        for name, text in (
            ("shaders/blend.glsl", shader),
            ("tests/test_blend.py", tests),
            ("pytest.ini", "[pytest]\n"),
        ):
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_text(text)
        (folder / "tmp").mkdir()
        return folder

    return make


@pytest.fixture(scope="module")
def report(made):
    """(what the command did, its report, the folder)."""
    folder = made()
    done = mutate(folder, "shaders/blend.glsl", "--tests", "tests", "-o", "report.json", "--workers", "1")
    return done, json.loads((folder / "report.json").read_text()), folder


def by_status(report, status):
    return {m["id"].removeprefix("blend.glsl:") for m in report["mutants"] if m["status"] == status}


def test_survivors_are_those_that_no_test_can_tell(report):
    """test_unnoticed looks for a finite number only: everything in that function survives, and nothing elsewhere."""
    done, found, _ = report
    survivors = by_status(found, "survived")
    assert {name.partition("+")[0] for name in survivors} == {"unnoticed"}
    kinds = {m["kind"] for m in found["mutants"] if m["function"] == "unnoticed"}
    assert kinds == {"arithmetic", "term", "constant", "return"}
    assert len(survivors) == sum(m["function"] == "unnoticed" for m in found["mutants"])
    assert done.returncode == 1, done.stderr
    assert done.stderr == ""


def test_a_survivor_is_shown_as_a_difference(report):
    done, _, _ = report
    place = "shaders/blend.glsl:22: blend.glsl:unnoticed+2:14:arithmetic:+: reached by 1 test\n"
    assert place in done.stdout
    _, _, after = done.stdout.partition(place)
    lines = after.split("\n")[:6]
    assert lines[0] == "--- shaders/blend.glsl"
    assert lines[3:] == [" {", "-    return x - 3.0;", "+    return x + 3.0;"]


def test_the_table_adds_up(report):
    done, found, _ = report
    words = next(line for line in done.stdout.split("\n") if line.startswith("all")).split()
    statuses = ("killed", "timeout", "survived", "equivalent", "same", "invalid")
    assert list(map(int, words[1:])) == [len(found["mutants"]), *(len(by_status(found, s)) for s in statuses)]


def test_a_mutant_is_killed_by_a_test_that_reaches_it(report):
    _, found, _ = report
    for mutant in found["mutants"]:
        if mutant["status"] == "killed":
            name = mutant["by"].removeprefix("tests/test_blend.py::").partition("[")[0]
            reaching = {"gain": {"test_gain", "test_limited"}, "limited": {"test_limited"}, "square": {"test_square"}}
            if mutant["line"] == 14:
                assert name == "test_soft"
            elif mutant["function"]:
                assert name in reaching[mutant["function"]], mutant


def test_both_branches_of_an_if_are_mutated_and_noticed(report):
    _, found, _ = report
    assert {m["line"] for m in found["mutants"] if m["status"] == "killed"} >= {3, 8, 14, 16, 27}


def test_only_what_does_not_compile_or_is_the_same_code_is_not_run(report):
    _, found, _ = report
    for mutant in found["mutants"]:
        assert (mutant["tests"] > 0) == (mutant["status"] in ("killed", "survived")), mutant


def test_the_project_is_left_alone(report):
    _, _, folder = report
    assert (folder / "shaders" / "blend.glsl").read_text() == SHADER
    assert sorted(p.name for p in folder.iterdir()) == ["pytest.ini", "report.json", "shaders", "tests", "tmp"]
    assert left_over(folder) == []


def test_listed_mutants_need_not_be_noticed(report):
    _, found, folder = report
    ids = json.dumps([m["id"] for m in found["mutants"] if m["status"] == "survived"])
    path = folder / "tests" / "mutation-equivalent.toml"
    path.write_text(f'[[equivalent]]\nline = "return x - 3.0;"\nids = {ids}\nreason = "nobody looks"\n')
    arguments = ("shaders/blend.glsl", "--tests", "tests", "--only", "unnoticed")
    try:
        done = mutate(folder, *arguments)
        assert done.returncode == 0, done.stdout + done.stderr
        path.write_text(path.read_text().replace("x - 3.0", "x - 4.0"))
        stale = mutate(folder, *arguments)
        assert stale.returncode == 1
        assert "blend.glsl:unnoticed" in stale.stderr
        assert "'return x - 3.0;'" in stale.stderr
    finally:
        path.unlink()


def test_list_shows_the_mutants_and_runs_none(made):
    done = mutate(made(), "shaders/blend.glsl", "--list", "--only", "square")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert "shaders/blend.glsl:27:14: square+2:14:arithmetic:/: return x / x;" in lines
    assert len(lines) == 3  # "/", one of two equal factors, 0


def test_a_shader_loaded_when_tests_are_collected_is_mutated_too(made):
    tests = """from harness import shader
BLEND = shader("shaders/blend.glsl")
def test_square():
    assert BLEND.square(3.0) == 9
"""
    done = mutate(made(tests=tests), "shaders/blend.glsl", "--tests", "tests", "--only", "square")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "3 of 3 noticed" in done.stdout


def test_ctrl_c_leaves_nothing_behind(made):
    folder = made(
        tests=TESTS + "\n\ndef test_slow(blend):\n    import time; time.sleep(0.5)\n    blend.unnoticed(1.0)\n"
    )
    words, options = command(folder, "shaders/blend.glsl", "--only", "unnoticed", "--workers", "1")
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20)
    assert process.returncode == 130
    assert out == ""
    assert left_over(folder) == []


@pytest.mark.parametrize(
    ("tests", "parts"),
    [
        ("def test_a():\n    assert True\n", ["blend.glsl", "no test uses it", "1 tests"]),
        (TESTS.replace("== 9", "== 10"), ["blend.glsl", "fails on the unchanged file", "test_square", "== 10"]),
        ("import nowhere\n", ["blend.glsl", "not collected", "test_blend.py", "No module named 'nowhere'"]),
    ],
    ids=["unused", "failing", "not collected"],
)
def test_tests_that_cannot_tell_anything(made, tests, parts):
    folder = made(tests=tests)
    with pytest.raises(HarnessError) as error:
        Mutation(folder / "shaders" / "blend.glsl", [folder / "tests"])
    for part in parts:
        assert part in str(error.value)


@pytest.mark.parametrize(
    ("arguments", "parts"),
    [
        (["shaders/blends.glsl"], ["shaders/blends.glsl: no such file"]),
        (["shaders/blend.glsl", "--equivalent", "none.toml"], ["none.toml: cannot read", "No such file"]),
        (["shaders/blend.glsl", "--only", "nothing", "--tests", "tests"], ["blend.glsl", "no mutants", "nothing"]),
    ],
    ids=["no file", "no list", "no function"],
)
def test_one_clear_message(report, arguments, parts):
    done = mutate(report[2], *arguments)
    assert done.returncode == 1
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    for part in parts:
        assert part in done.stderr
