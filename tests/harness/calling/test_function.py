"""A function as Python sees it: its documentation, its signature, its modes; streams, out= and what they need."""

from __future__ import annotations

import inspect
import os
import pydoc
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from glsl_values import assert_same_bits

from harness import CallError
from harness.calling.call import Shader
from harness.calling.engine import engine

TEXT = """
// Scales v.
// Twice.
vec3 f(vec3 v, inout float s, out int n) { n = 1; return v * s; }
float g(float x) { return x; }
// Of vectors.
float g(vec4 x) { return x.x; }
float lambda_(float lambda) { return lambda; }
uniform float gain;
float gained(float x, float y) { return gain * x + y; }
"""


@pytest.fixture
def made(functions):
    return functions(TEXT)


# ---- What is shown of it ---------------------------------------------------------------------------------------------


def test_its_documentation_is_signature_place_and_comment(made):
    file = made.f.origin[0]
    assert made.f.__doc__ == f"vec3 f(vec3 v, inout float s, out int n)    [{file}:4]\n\nScales v.\nTwice."


def test_the_documentation_of_overloads_is_that_of_each(made):
    file = made.g.origin[0]
    assert made.g.__doc__ == f"float g(float x)    [{file}:5]\nfloat g(vec4 x)    [{file}:7]\n\nOf vectors."


def test_help_shows_the_documentation(made):
    shown = pydoc.render_doc(made.f, renderer=pydoc.plaintext)
    assert all(line in shown for line in made.f.__doc__.split("\n"))


def test_the_class_has_documentation_of_its_own(made):
    assert "overloads" in type(made.f).__doc__


def test_its_python_signature_has_the_names_of_its_inputs(made):
    signature = inspect.signature(made.f)
    assert str(signature) == "(v: 'vec3', s: 'float', *, out=None, **uniforms) -> '(vec3, float, int)'"
    signature.bind([1, 2, 3], s=1)
    with pytest.raises(TypeError):
        signature.bind([1, 2, 3])


def test_the_python_signature_of_overloads_is_open(made):
    assert str(inspect.signature(made.g)) == "(*args, out=None, **uniforms)"


def test_the_python_signature_spells_what_python_keeps_for_itself(made):
    assert list(inspect.signature(made.lambda_).parameters)[0] == "lambda_"


def test_origin_is_file_and_line(made):
    assert made.f.origin == made.f.signatures[0].origin
    assert made.f.origin[0].endswith("test.glsl")
    assert made.f.origin[1] == 4


def test_modes_are_those_of_the_shader_and_of_with_mode(made):
    assert (made.f.mode, made.with_mode("precise").f.mode) == ("as-written", "precise")
    other = made.g.with_mode("precise")
    assert (other.mode, other.signatures, other(2)) == ("precise", made.g.signatures, 2)
    assert made.g.mode == "as-written"


def test_what_is_compiled_once_is_compiled_for_all_that_share_a_file(made):
    compiled = []
    watched = replace(made._library, engine=lambda *given: compiled.append(given[1:]) or engine(*given))
    made = Shader(watched, "as-written")
    for f in (made.g, made.g.with_mode("as-written"), made["g(float)"], made.with_mode("as-written").g):
        assert f(2) == 2
    made.g.with_mode("precise")(2)
    assert [mode for _, mode in compiled] == ["as-written", "precise"]


# ---- stream ----------------------------------------------------------------------------------------------------------


def test_a_stream_gives_the_result_of_each_chunk(made):
    x = np.arange(10, dtype=np.float32)
    got = list(made.gained.stream(({"x": x[k : k + 4]} for k in range(0, 10, 4)), y=1, gain=3))
    assert [len(part) for part in got] == [4, 4, 2]
    np.testing.assert_array_equal(np.concatenate(got), 3 * x + 1)


def test_a_stream_takes_a_chunk_only_when_its_result_is_asked_for(made):
    taken = []

    def chunks():
        for k in range(3):
            taken.append(k)
            yield {"x": k}

    stream = made.g.stream(chunks())
    assert taken == []
    assert next(stream) == 0
    assert taken == [0]


@pytest.mark.parametrize(
    ("chunk", "message"),
    [
        ([1, 2], "g.stream: a chunk is a dict of arguments by name, got list"),
        ({"x": "1"}, "no overload fits"),
    ],
)
def test_a_chunk_that_is_none_is_refused(made, chunk, message):
    with pytest.raises(CallError, match=message):
        list(made.g.stream([chunk]))


# ---- out -------------------------------------------------------------------------------------------------------------

SHAPES = [(), (0,), (7,), (2, 3), (3 * 2**18 + 5,), (3, 2**18 + 7), (2**10, 2**9, 1)]


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_out_is_written_and_returned(made, shape):
    """Batches of one block and of several, cut along the first dimension and the second."""
    x = (np.arange(np.prod(shape)) % 65536).reshape(shape)
    out = np.full(shape, -1, np.float32)
    assert made.g(x, out=out) is out
    assert_same_bits(out, x.astype(np.float32))


@pytest.mark.parametrize("count", [5, 2**18 + 3])
def test_out_of_several_results_is_a_tuple(made, count):
    v = np.arange(3 * count).reshape(count, 3) % 1000
    out = np.empty((count, 3), np.float32), np.empty(count, np.float64), np.empty((count, 2), np.int64)[:, 0]
    assert made.f(v, 2, out=out) is out
    np.testing.assert_array_equal(out[0], 2 * v)
    np.testing.assert_array_equal(out[1], np.full(count, 2))
    np.testing.assert_array_equal(out[2], np.ones(count))


@pytest.mark.parametrize("count", [6, 2**19])
def test_out_may_be_an_argument(made, count):
    x = np.arange(count, dtype=np.float32)
    assert made.g(x, out=x) is x
    np.testing.assert_array_equal(x, np.arange(count))


@pytest.mark.parametrize("count", [6, 2**19])
def test_out_may_overlap_an_argument(made, count):
    """As in numpy: the same as if it did not, wherever the arguments lie."""
    memory = np.arange(count + 1, dtype=np.float32)
    made.g(memory[:-1], out=memory[1:])
    np.testing.assert_array_equal(memory, [0, *range(count)])
    memory = np.arange(count, dtype=np.float32)
    made.g(memory[::-1], out=memory)
    np.testing.assert_array_equal(memory, np.arange(count)[::-1])


@pytest.mark.parametrize(
    ("out", "message"),
    [
        (np.empty(3, np.float32), "out is an array of shape (2,) of float32, got (3,) of float32"),
        (np.empty((1, 2), np.float32), "out is an array of shape (2,) of float32, got (1, 2) of float32"),
        (np.empty(2, np.int32), "out is an array of shape (2,) of float32, got (2,) of int32"),
        ([0, 0], "out is an array of shape (2,), got list"),
        ((np.empty(2, np.float32),) * 2, "out: float g(float x) yields 1 array, got 2"),
        (np.broadcast_to(np.float32(0), 2), "out is read-only"),
    ],
)
def test_an_out_that_does_not_fit_is_refused(made, out, message):
    with pytest.raises(CallError) as caught:
        made.g([1, 2], out=out)
    assert caught.value.message == message
    assert caught.value.line == 5


# ---- Memory ----------------------------------------------------------------------------------------------------------

#: Fails where an evaluation needs more memory of its own than LIMIT beyond what there is after smaller ones.
#: Files that are mapped into memory do not count: they are given back when others need the place.
MEMORY = """
import resource
import numpy as np
from harness import shader

COUNT, LIMIT = 2**22, 12 << 20
made = shader("f.glsl")
f, pair = made.gained, made.pair

def mapped(name, dtype, *shape):
    np.memmap(name, dtype, "w+", shape=shape)
    return np.memmap(name, dtype, "r" if name == "read-only" else "r+", shape=shape)

wide, own, out = mapped("wide", np.float64, COUNT), mapped("read-only", np.float32, COUNT), mapped("y", "f4", COUNT)
halves, vectors, on = mapped("halves", "f2", COUNT, 3), mapped("vectors", "f4", COUNT, 3), mapped("on", bool, COUNT)
side = np.arange(1024)
ways = {
    "converted": lambda n: f(wide[:n], 1.5, gain=2, out=out[:n]),
    "in place": lambda n: f(own[:n], own[:n], gain=2, out=out[:n]),
    "a row and a column": lambda n: f(side, np.arange(n >> 10)[:, None], gain=2, out=out[:n].reshape(n >> 10, 1024)),
    "vectors and bool": lambda n: pair(halves[:n], out=(vectors[:n], on[:n])),
    "bool": lambda n: made.positive(own[:n]),
    "a stream": lambda n: [None for _ in f.stream(({"x": np.ones(2**17)} for _ in range(n >> 17)), y=1, gain=2)],
}
for way in ways.values():
    way(2**19)
used = next(int(line.split()[1]) << 10 for line in open("/proc/self/status") if line.startswith("VmData"))
resource.setrlimit(resource.RLIMIT_DATA, (used + LIMIT, -1))
for name, way in ways.items():
    way(COUNT)
    print(name)
"""


@pytest.mark.skipif(not os.path.exists("/proc/self/status"), reason="asks Linux how much memory there is")
def test_memory_does_not_grow_with_the_batch(tmp_path):
    """4.2 million elements take 16 MiB and more as float32; 12 MiB are allowed."""
    text = "uniform float gain;\nfloat gained(float x, float y) { return gain * x + y; }\n"
    text += "bool positive(float x) { return x > 0.0; }\n"
    (tmp_path / "f.glsl").write_text(text + "vec3 pair(vec3 v, out bool on) { on = v.x > 0.0; return v; }\n")
    done = subprocess.run([sys.executable, "-c", MEMORY], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    ways = ["converted", "in place", "a row and a column", "vectors and bool", "bool", "a stream"]
    assert (done.stdout.split("\n")[:-1], done.returncode) == (ways, 0), done.stderr


def test_a_batch_of_several_blocks_is_that_of_one(made):
    """A converted one, and one of dimensions that do not go into blocks evenly, against numpy."""
    x, y = np.arange(700) % 251, np.arange(1200)[:, None] % 13
    np.testing.assert_array_equal(made.gained(x, y, gain=2), np.float32(2 * x + y))
    v = (np.arange(3 * 600_001) % 1000).reshape(-1, 3)
    got = made.f(v, 2)
    np.testing.assert_array_equal(got.result, 2 * v)
    assert re.fullmatch(r"f\(result=\[\[0\.0, .*\]\] \(600001, 3\), s=\[2\.0, .*\] \(600001,\), n=.*\)", repr(got))
