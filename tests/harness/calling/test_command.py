"""The line for a shell that repeats one evaluation: run in a shell, it gives the same bits."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from harness import CallError, shader

TEXT = """#version 430
#include "more.glsl"
struct In { float a; ivec2 k; bool on; };
struct Out { In i[2]; mat2x3 m; };
uniform float gain;
uniform struct Light { vec3 color; float power; } light;
float f(float x, vec3 v) { return FACTOR * x * v.y + more(v.z); }
float f(vec2 x) { return x.x; }
vec3 lit(vec3 v, float x) { return v * light.color * pow(x, light.power) + gain; }
float of(Out o, float w[2]) { return o.i[1].a * o.m[1][2] + float(o.i[0].k.y) + (o.i[1].on ? w[1] : w[0]); }
"""
STRUCT = {
    "i": [
        {"a": 1, "k": [[1, 2], [3, -4]], "on": True},
        {"a": [[0.1], [0.7], [-0.9]], "k": [0, 0], "on": [True, False]},
    ],
    "m": [[1, 2], [3, 4], [5, 0.3]],
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Macros and folders with what a shell would take for its own."""
    folder = tmp_path_factory.mktemp("it's here")
    (folder / "in cluded").mkdir()
    (folder / "in cluded" / "more.glsl").write_text("float more(float x) { return EMPTY sin(x) / SCALE(3.0); }\n")
    (folder / "main file.glsl").write_text(TEXT)
    defines = {"FACTOR": "(1.5 * 3.0)", "SCALE(x)": "(x / 7.0)", "EMPTY": ""}
    return shader(folder / "main file.glsl", defines, [folder / "in cluded"])


def in_a_shell(command: str) -> np.ndarray:
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    return np.float32(eval(done.stdout, {"inf": np.inf, "nan": np.nan}))


@pytest.mark.parametrize(
    ("name", "arguments", "index", "mode"),
    [
        (
            "f",
            {"x": np.float32([0.1, 1e-42, 3]), "v": np.float32([[1, 2, 3], [-0.1, 1e20, 0.7], [4, 5, 6]])},
            1,
            "precise",
        ),
        (
            "lit",
            {"v": [0.1, 0.2, 0.3], "x": [[0.5], [0.6]], "gain": 0.7, "light.color": [1, 1 / 3, 2], "light.power": 2.2},
            (1, 0),
            "as-written",
        ),
        ("of", {"o": STRUCT, "w": [0.1, 0.2]}, (2, 0), "as-written"),
    ],
    ids=["an overload, macros, includes, a mode", "uniforms", "structures and arrays"],
)
def test_run_in_a_shell_it_gives_the_same_bits(made, name, arguments, index, mode):
    f = made[name].with_mode(mode)
    whole = f(**arguments)
    at = index if index is not None else ()
    assert in_a_shell(f.command(arguments, index)).tobytes() == np.float32(whole[at]).tobytes()


def test_it_is_one_line_of_plain_words(made):
    words = shlex.split(made.f.command({"x": np.float32([0.1, 0.25]), "v": [1, -2, 3]}, 1))
    assert words[:2] == ["harness", "call"]
    assert words[2].endswith("main file.glsl")
    assert words[3:6] == ["f(float, vec3)", "x=0.25", "v=1,-2,3"]
    assert words[6:12] == ["-D", "FACTOR=(1.5 * 3.0)", "-D", "SCALE(x)=(x / 7.0)", "-D", "EMPTY="]
    assert (words[12], Path(words[13]).name, len(words)) == ("-I", "in cluded", 14)


def test_a_function_alone_of_its_name_needs_no_signature(functions):
    made = functions("float f(float x) { return x; }")
    assert re.fullmatch(r"harness call \S+ f x=2", made.f.command({"x": 2}))
    assert made.f.with_mode("precise").command({"x": 2}).endswith(" f x=2 --mode precise")


def test_arguments_may_be_given_in_order(made):
    assert made.f.command([1, [1, 2, 3]]) == made.f.command({"v": [1, 2, 3], "x": 1})


def test_an_element_is_told_by_indices_or_by_its_number(made):
    x = np.arange(6).reshape(2, 3)
    arguments = {"x": x, "v": [1, 2, 3]}
    for number in range(6):
        place = np.unravel_index(number, x.shape)
        assert f" x={number} " in made.f.command(arguments, number)
        assert made.f.command(arguments, tuple(map(int, place))) == made.f.command(arguments, number)


@pytest.mark.parametrize(
    ("index", "message"),
    [
        (None, "f is given a batch (2, 3): say by an index which evaluation is meant"),
        (6, "no element 6 in a batch (2, 3)"),
        ((2, 0), "no element (2, 0) in a batch (2, 3)"),
        ((1,), "no element (1,) in a batch (2, 3)"),
        ((1, 1, 1), "no element (1, 1, 1) in a batch (2, 3)"),
    ],
)
def test_an_element_that_is_not_there_is_refused(made, index, message):
    with pytest.raises(CallError) as caught:
        made.f.command({"x": np.ones((2, 3)), "v": [1, 2, 3]}, index)
    assert caught.value.message == message
