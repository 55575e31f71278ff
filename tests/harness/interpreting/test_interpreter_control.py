"""Control flow of interpreted GLSL: every lane takes the way that it would take alone, as the same in Python does."""

from __future__ import annotations

import re

import numpy as np
import pytest

from harness import CallError, shader
from harness.interpreting import interpreter
from harness.interpreting.interpretation import LANES

TEXT = """
int branches(int x) { if (x > 5) { if (x > 8) return 1; x += 10; } else if (x == 3) x = 100; return x; }
int early(int x) { int r = 0; for (int i = 0; i < 10; ++i) { if (i == x) return r; r += i; } return -1; }
int breaks(int x) { int r = 0; for (int i = 0; i < 10; ++i) { if (i > x) break; r += i * i; } return r; }
int continues(int x) { int r = 0; for (int i = 0; i < x; ++i) { if (i % 3 == 1) continue; r += i; } return r; }
int nested(int x)
{
    int r = 0;
    for (int i = 0; i < x; ++i)
        for (int j = i; j < x; ++j) { if (j > 6) break; if ((i + j) % 2 == 0) continue; r += i * j + 1; }
    return r;
}
int until(int x) { int n = 0; do { x -= 3; ++n; if (x == 1) break; } while (x > 0); return n * 100 + x; }
int collatz(int x) { int n = 0; while (x > 1) { x = x % 2 == 0 ? x / 2 : 3 * x + 1; ++n; } return n; }
int falls(int x)
{
    int r = 0;
    switch (x)
    {
    case 0: r = 1; break;
    case 1: r += 10;
    case 2: case 3: r += 100;
    default: r += 1000; break;
    case 7: r = 7;
    }
    return r;
}
int default_first(int x)
{
    int r = 0;
    switch (x) { default: r += 1; case 4: r += 10; break; case 5: return 5; }
    return r;
}
int switch_in_loop(int x)
{
    int r = 0;
    for (int i = 0; i < 6; ++i)
    {
        switch ((i + x) % 4) { case 0: continue; case 1: r += 1; break; case 2: return r; }
        r += 10;
    }
    return r;
}
bool count(inout int n, bool answer) { ++n; return answer; }
int short_circuit(int x)
{
    int n = 0;
    bool a = count(n, x > 3) && count(n, x > 6);
    bool b = count(n, x < 2) || count(n, x == 5);
    return n + (a ? 100 : 0) + (b ? 1000 : 0);
}
int conditional(int x) { int n = 0; int r = x > 4 ? (count(n, true) ? 7 : 8) : x; return r * 10 + n; }
int helper(int x)
{
    if (x < 0) return 0;
    int r = 1;
    for (int i = 0; i < x; ++i) { r *= 2; if (r > 40) return r; }
    return r;
}
int calls(int x)
{
    int r = 0;
    if (x % 2 == 0) r = helper(x);
    for (int i = 0; i < x; ++i) if (i == 2) r += helper(i + x);
    return r;
}
void swap(inout int a, inout int b) { int t = a; a = b; b = t; }
int swaps(int x) { int y = 2 * x; if (x > 4) swap(x, y); return 10 * x + y; }
int global_state = 5;
void bump() { global_state += 1; }
int globals(int x) { for (int i = 0; i < x; ++i) bump(); return global_state; }
int empty_loop(int x) { for (int i = 0; i < x; ++i) {} for (;;) { if (x++ > 12) break; } return x; }
"""


def branches(x):
    if x > 5:
        if x > 8:
            return 1
        x += 10
    elif x == 3:
        x = 100
    return x


def early(x):
    return sum(range(x)) if 0 <= x < 10 else -1


def breaks(x):
    return sum(i * i for i in range(10) if i <= x)


def continues(x):
    return sum(i for i in range(x) if i % 3 != 1)


def nested(x):
    return sum(i * j + 1 for i in range(x) for j in range(i, min(x, 7)) if (i + j) % 2)


def until(x):
    n = 0
    while True:
        x -= 3
        n += 1
        if x == 1 or x <= 0:
            return n * 100 + x


def collatz(x):
    n = 0
    while x > 1:
        x = x // 2 if x % 2 == 0 else 3 * x + 1
        n += 1
    return n


def falls(x):
    return {0: 1, 1: 1110, 2: 1100, 3: 1100, 7: 7}.get(x, 1000)


def default_first(x):
    return {4: 10, 5: 5}.get(x, 11)


def switch_in_loop(x):
    r = 0
    for i in range(6):
        way = (i + x) % 4
        if way == 2:
            return r
        r += {0: 0, 1: 11, 3: 10}[way]
    return r


def short_circuit(x):
    n = 1 + (x > 3) + 1 + (not x < 2)
    return n + 100 * (x > 6) + 1000 * (x < 2 or x == 5)


def conditional(x):
    return 71 if x > 4 else 10 * x


def helper(x):
    return min(2**x, 64) if x >= 0 else 0


def calls(x):
    return (helper(x) if x % 2 == 0 else 0) + (helper(2 + x) if x > 2 else 0)


def swaps(x):
    return 21 * x if x > 4 else 12 * x


def globals_(x):
    return 5 + max(x, 0)


def empty_loop(x):
    return max(x, 13) + 1


PYTHON = [
    branches,
    early,
    breaks,
    continues,
    nested,
    until,
    collatz,
    falls,
    default_first,
    switch_in_loop,
    short_circuit,
]
PYTHON += [conditional, calls, swaps, globals_, empty_loop]


@pytest.fixture
def few_rounds(monkeypatch):
    monkeypatch.setattr(interpreter, "LOOP_LIMIT", 500)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    path = tmp_path_factory.mktemp("control") / "control.glsl"
    path.write_text(TEXT)
    return shader(path, mode="double")


@pytest.mark.parametrize("python", PYTHON, ids=lambda f: f.__name__)
def test_each_lane_takes_its_own_way(compiled, python):
    numbers = np.arange(0, 13)
    got = compiled[python.__name__.rstrip("_")](numbers)
    assert got.tolist() == [python(x) for x in numbers.tolist()]


@pytest.mark.parametrize("python", PYTHON, ids=lambda f: f.__name__)
def test_a_lane_alone_does_the_same(compiled, python):
    assert [compiled[python.__name__.rstrip("_")](x) for x in (0, 3, 7, 12)] == [python(x) for x in (0, 3, 7, 12)]


def test_a_batch_of_several_chunks_is_in_order(compiled):
    numbers = np.random.default_rng(0).integers(0, 13, 2 * LANES + 5)
    table = np.array([nested(x) for x in range(13)])
    np.testing.assert_array_equal(compiled.nested(numbers), table[numbers])


def test_an_empty_batch_gives_an_empty_result(compiled):
    assert compiled.nested(np.zeros(0, int)).shape == (0,)


def test_a_global_variable_begins_anew_in_each_chunk_and_call(compiled):
    assert compiled.globals(np.full(LANES + 1, 2)).tolist() == [7] * (LANES + 1)
    assert compiled.globals(1) == 6


def test_a_global_variable_that_was_never_assigned_is_nan_and_remembers_no_other_call(functions):
    called = functions("float g; float f(float x) { if (x > 0.0) g = x; return g; }", mode="double")
    np.testing.assert_array_equal(called.f([1, -1]), [1, np.nan])
    assert np.isnan(called.f(-1))
    assert np.isnan(called.f(np.append(np.ones(LANES), -1))[-1])


@pytest.mark.parametrize(
    "loop",
    ["while (true) x += 1.0;  // HERE", "for (;;) x = -x;  // HERE", "do { x *= 0.5; } while (x >= 0.0);  // HERE"],
)
@pytest.mark.parametrize("batch", [1.0, np.ones(3)], ids=["scalar", "array"])
def test_an_endless_loop_is_refused_with_its_line(functions, tmp_path, few_rounds, loop, batch):
    text = f"float f(float x)\n{{\n    if (x < 0.0) return x;\n    {loop}\n    return x;\n}}\n"
    message = f"{re.escape(str(tmp_path / 'test.glsl'))}:4: a loop does not end"
    with pytest.raises(CallError, match=message):
        functions(text, mode="double").f(batch)


def test_a_loop_that_only_some_lanes_never_leave_is_refused(functions, few_rounds):
    text = "float f(float x) { while (x != 3.0) { if (x > 3.0) x -= 1.0; } return x; }"
    called = functions(text, mode="double")
    assert called.f([5, 3]).tolist() == [3, 3]
    with pytest.raises(CallError, match="a loop does not end"):
        called.f([5, 3, 1])


def test_after_a_refusal_the_next_call_works(functions, few_rounds):
    called = functions("float f(float x) { while (x < 1.0) x *= 1.0; return x; }", mode="double")
    with pytest.raises(CallError):
        called.f(0.5)
    assert called.f(1.5) == 1.5


def test_what_is_discarded_is_nan_and_the_rest_goes_on(functions):
    text = """
    float inner(float x) { if (x > 2.0) discard; return 2.0 * x; }
    float f(float x, out int n)
    {
        float r = 0.0;
        n = 0;
        for (int i = 0; i < 3; ++i) { r += inner(x + float(i)); ++n; }
        return r;
    }
    """
    result = functions(text, mode="double").f([-1, 0, 1, 5])
    np.testing.assert_array_equal(result.result, [0, 6, np.nan, np.nan])
    assert result.n.tolist() == [3, 3, 0, 0]


def test_a_loop_of_as_many_rounds_as_the_driver_can_do_is_no_endless_one(functions):
    text = "int f(int n) { int k = 0; while (k < n) ++k; return k; }"
    assert functions(text, mode="double").f(65536) == 65536


@pytest.mark.parametrize("where", ["f", "inner"])
def test_all_discarded_at_once_ends_the_loop_too(functions, where):
    inner, outer = ("true", "false") if where == "inner" else ("false", "true")
    text = f"""
    vec2 inner(float x) {{ if ({inner}) discard; return vec2(x); }}
    float f(float x) {{ while (true) {{ x += inner(x).y; if ({outer}) discard; }} return x; }}
    """
    assert np.isnan(functions(text, mode="double").f([1, 2])).all()
