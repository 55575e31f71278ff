"""The hunt: it finds what lies hidden in few inputs, the same with any number of workers, and writes a test of it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import main

from harness import DomainError
from harness.searching.domain import Domain
from harness.searching.goals import Goal, Trial
from harness.searching.hunt import ISLAND, hunt

TEXT = """
// not finite within some 2000 of the 2^30 floats of 0 ... 1
float spike(float x) { return abs(x - 0.3371) < 6e-5 && x > 0.33715 ? 1.0 / 0.0 * x : 1.0 / (abs(x - 0.33716) + 1e-3); }
float inverse(float x, float y) { return 1.0 / (x * y); }
float below(float x) { return x * (x - 0.001); }
float wave(float x, float y) { return y + (x > 0.5 && x < 0.50001 ? x - 0.01 : x); }
float product(vec3 a, vec3 b) { return dot(a, b) + a.x; }
float fine(float x, float y) { return x + y; }
"""


@pytest.fixture
def f(functions):
    return functions(TEXT)


def one(f, domain, goal, **options):
    return hunt(f, domain, [goal], samples=1, workers=1, **options)[0]


def test_it_climbs_to_what_chance_would_not_find(f):
    """The values grow toward a spike that one in 500 000 of the floats is in."""
    found = one(f.spike, {"x": "[0,1]"}, "nonfinite")
    assert found.bad
    assert not np.isfinite(f.spike(found.inputs.flat["x"]))


def test_edges_meet_first(f):
    found = one(f.inverse, {"x": "[0,1]", "y": "[-1,1]"}, "nonfinite")
    assert found.bad
    assert not np.isfinite(f.inverse(**found.inputs.arguments()))
    assert found.inputs.flat["x"] == 0  # the simplest


def test_the_most_negative_value(f):
    """x^2 - x/1000 is at least -2.5e-7, at 5e-4."""
    found = one(f.below, {"x": "[0,1]"}, "negative")
    assert found.bad
    assert one(f.below, {"x": "[0.001,1]"}, "negative").bad is False


def test_a_step_back(f):
    found = one(f.wave, {"x": "[0,1]", "y": "[0,1]"}, "monotone:x")
    assert found.bad
    lower, upper = found.trial.steps("x")
    first, second, *_ = found.trial.path("x")
    assert lower < upper
    assert first > second
    assert not one(f.fine, {"x": "[0,1]", "y": "[0,1]"}, "monotone:x", max_ulp=0).bad


def test_asymmetry(f):
    found = one(f.product, {"a": "unit", "b": "unit"}, "symmetric:a,b")
    assert found.bad
    assert not one(f.fine, {"x": "float", "y": "float"}, "symmetric:x,y", max_ulp=0).bad


def test_the_error_against_double(f):
    """A double that differs in one part of the domain: the worst lies there."""

    class Modes(type(f.fine)):
        def with_mode(self, mode):
            return lambda x, y: np.where((x > 0.25) & (x < 0.3), 2.0, 1.0) * (x.astype(float) + y)

    made = Modes(f.fine._library, f.fine.signatures, "as-written")
    where = Domain.of(made, {"x": "[0,1]", "y": [1.0]})
    flat = where.draw(2000, np.random.default_rng(0))
    scores = Goal.read("ulp", 4).score(Trial(made, where, flat))
    x = flat["x"][:, 0]
    inside = (x > 0.25) & (x < 0.3)
    assert inside.any()
    assert (scores[inside] > 1e6).all()
    assert (scores[~inside] <= 0.5).all()


def test_any_number_of_workers_finds_the_same(f):
    found = [
        hunt(f.product, {"a": "unit", "b": "unit"}, ["symmetric:a,b"], samples=3 * ISLAND, seed=4, workers=workers)[0]
        for workers in (1, 2)
    ]
    assert found[0].score == found[1].score
    for name in "ab":
        np.testing.assert_array_equal(found[0].inputs.flat[name], found[1].inputs.flat[name])
    assert found[0].samples == 3 * ISLAND


def test_what_a_time_allows_is_found_again_by_the_number_of_samples(f):
    timed = hunt(f.below, {"x": "[0,1]"}, ["negative"], seconds=0.01, workers=2)[0]
    again = hunt(f.below, {"x": "[0,1]"}, ["negative"], samples=timed.samples, workers=1)[0]
    assert timed.score == again.score
    assert timed.inputs.flat["x"] == again.inputs.flat["x"]


@pytest.mark.parametrize(
    ("find", "message"),
    [
        ("nan", "nothing is known of finding 'nan'; there are nonfinite, negative, ulp, monotone:X, symmetric:A,B"),
        ("monotone", "nothing is known of"),
        ("monotone:z", "z is no number that moves in an interval"),
        ("symmetric:x,z", "x and z are not two inputs of the same type"),
    ],
)
def test_what_cannot_be_looked_for_is_said(f, find, message):
    with pytest.raises(DomainError, match=message):
        one(f.fine, {"x": "[0,1]", "y": "[0,1]"}, find)


# ---- The command -----------------------------------------------------------------------------------------------------


@pytest.fixture
def glsl(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shaders").mkdir()
    path = tmp_path / "shaders" / "it.glsl"
    path.write_text(TEXT + "float scaled(vec4 v, float x) { return dot(v, v) * FACTOR * x * (1.0 - x) - 0.5; }\n")
    return Path("shaders/it.glsl")


DEFINE = ["-D", "FACTOR=1.0"]
SMALL = ["--samples", "1000", "--workers", "1"]


def test_nothing_found_is_exit_code_0(glsl, capfd):
    domain = ["--domain", "x=[0,1]", "--domain", "y=[0,1]"]
    assert main(["hunt", str(glsl), "fine", *DEFINE, *domain, *SMALL]) == 0
    out, err = capfd.readouterr()
    assert out.startswith("nonfinite: nothing found of float fine(float x, float y) in 131072 samples")
    assert err == ""  # no bar: stderr is no terminal


def test_a_finding_is_exit_code_1_and_shown_in_decimal_and_hexadecimal(glsl, capfd):
    domain = ["--domain", "x=[0,1]", "--domain", "y=1"]
    assert main(["hunt", str(glsl), "inverse", *DEFINE, *domain, *SMALL]) == 1
    out, _ = capfd.readouterr()
    assert out.startswith(
        "nonfinite: found of float inverse(float x, float y) in 131072 samples\n    x = 0.0 (0x0.0p+0)\n"
    )
    assert "def test_inverse_is_finite():" in out
    assert not list(glsl.parent.parent.glob("*.py"))


def test_wrong_words_are_one_line_and_exit_code_1(glsl, capfd):
    assert main(["hunt", str(glsl), "fine", *DEFINE, "--domain", "x=[0,1]"]) == 1
    assert "needs a domain for y" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("function", "options"),
    [
        ("product", ["--domain", "a=unit", "--domain", "b=unit", "--find", "symmetric:a,b", "-I", "shaders"]),
        (
            "scaled",
            ["--domain", "v=[-1,1]", "--domain", "x=[0,1]", "--find", "negative,monotone:x", "--mode", "precise"],
        ),
    ],
)
def test_the_written_test_is_formatted_fails_and_passes_when_mended(glsl, capfd, function, options):
    written = Path("tests/test_found.py")
    written.parent.mkdir()
    command = ["hunt", str(glsl), function, *DEFINE, *options, *SMALL, "-o", str(written)]
    assert main(command) == 1
    checks = [["format", "--check", "--line-length", width] for width in ("88", "120")]
    for check in [*checks, ["check", "--select", "E,F,W,I,B,UP", "--line-length", "120"]]:
        ruff = [sys.executable, "-m", "ruff", *check, "--isolated", str(written)]
        done = subprocess.run(ruff, capture_output=True, text=True)
        assert done.returncode == 0, f"{done.stdout}\n{written.read_text()}"
    assert _run(written) == 1
    mended = {"product": "dot(a, b)", "scaled": "0.25"}[function]
    lines = glsl.read_text().splitlines()
    lines = [line[: line.index("{")] + f"{{ return {mended}; }}" if f" {function}(" in line else line for line in lines]
    glsl.write_text("\n".join(lines))
    assert _run(written) == 0


def _run(written):
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(written)]
    return subprocess.run(command, capture_output=True, text=True).returncode
