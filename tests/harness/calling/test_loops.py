"""Loops that the software renderer would stop without a word: each is computed right, or refused at its line."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, native
from harness.calling import loops, stages


@pytest.fixture(autouse=True)
def on_llvmpipe():
    native.open_context()
    if stages.lanes() is None:
        pytest.skip("only llvmpipe stops loops")


# ---- Whether the text shows how long they are ------------------------------------------------------------------------


def most(body: str, rest: str = "") -> float:
    return loops.most_passes(f"#version 330\n{rest}\nfloat f(int n, float x) {{ {body} return x; }}", "f")


@pytest.mark.parametrize(
    ("body", "passes"),
    [
        ("", 0),
        ("for (int i = 0; i < 8; ++i) x++;", 8),
        ("for (int i = 0; i <= 8; i++) { x++; }", 9),
        ("for (int i = 8; i > 0; --i) x++;", 8),
        ("for (int i = 8; i >= 0; i -= 2) x++;", 5),
        ("for (int i = -4; i != 4; i++) x++;", 8),
        ("for (uint i = 0u; i < 8u; ++i) x++;", 8),
        ("for (highp int i = 0; i < 8; ++i) x++;", 8),
        ("for (float t = 0.0; t < 1.0; t += 0.25) x += t;", 4),
        ("for (int i = 0; i < N; ++i) x++;", 16),
        ("for (int i = 0; i < 8; ++i) { if (x > 2.0) break; if (x > 1.0) continue; x += float(i); }", 8),
        ("if (n > 0) for (int i = 0; i < 8; ++i) x++; else for (int i = 0; i < 9; ++i) x++;", 17),
        ("x = g(x) + g(x);", 8),
    ],
)
def test_what_can_be_seen(body, passes):
    """``passes`` of bodies, and one more for each loop that is entered."""
    entered = {"": 0}.get(body, 1) + body.count("else") + (body.count("g(x)") == 2)
    rest = "const int N = 16; float g(float x) { for (int i = 0; i < 4; ++i) x++; return x; }"
    assert most(body, rest) == passes + entered


def test_nested_loops_multiply():
    """The inner is entered with each pass of the outer: 1 + 8 (1 + 1 + 4)."""
    assert most("for (int i = 0; i < 8; ++i) for (int j = 0; j < 4; ++j) x++;") == 1 + 8 * (1 + 1 + 4)
    rest = "float g(float x) { for (int i = 0; i < 4; ++i) x++; return x; }"
    assert most("for (int i = 0; i < 8; ++i) { x = g(x); }", rest) == 1 + 8 * (1 + 1 + 4)
    assert most("for (int i = 0; i < 8; ++i, x = 1.0) { x = g(x); }", rest) == np.inf


@pytest.mark.parametrize(
    "body",
    [
        "for (int i = 0; i < n; ++i) x++;",
        "for (int i = n; i < 8; ++i) x++;",
        "for (int i = 0; i < 8; i += n) x++;",
        "for (int i = 0; i < 8; --i) x++;",
        "for (int i = 0; i < 100000; ++i) x++;",
        "for (int i = 0; i < 8; ++i) i = 0;",
        "for (int i = 0; i < 8; ++i) { x++; i -= 1; }",
        "for (int i = 0; i < 8; ++i) --i;",
        "for (int i = 0; i < 8; ++i) set(i);",
        "for (int i = 0; x < 8.0; ++i) x++;",
        "for (int i = 0, j = 0; i < 8; ++j) x++;",
        "for (float t = 1e8; t < 2e8; t += 1.0) x++;",
        "for (;;) x++;",
        "while (x < 8.0) x++;",
        "do x++; while (x < 8.0);",
        "for (int i = 0; i < 8; ++i) while (x < 8.0) x++;",
        "const int N = 3; for (int i = 0; i < N; ++i) x++;",
        "x = long(x);",
    ],
)
def test_what_cannot_be_seen(body):
    rest = "const int N = 16; void set(out int i) { i = 0; } float long(float x) { while (x < 2.0) x++; return x; }"
    assert most(body, rest) == np.inf


def test_a_function_that_is_not_called_does_not_count():
    assert most("", "float g(float x) { while (x < 2.0) x++; return x; }") == 0


# ---- Where it is counted ---------------------------------------------------------------------------------------------

#: a loop of n passes, in every form -> lines that it may be reported at
FORMS = {
    "for": "for (int i = 0; i < n; ++i) s += 1.0;",
    "for with braces": "for (int i = 0; i < n; ++i) { s += 1.0; }",
    "while": "int i = 0; while (i < n) { ++i; s += 1.0; }",
    "while without braces": "int i = 0; while (i++ < n) s += 1.0;",
    "do": "int i = 0; if (n > 0) do { s += 1.0; } while (++i < n);",
    "do without braces": "int i = 0; if (n > 0) do s += 1.0; while (++i < n);",
    "break": "int i = 0; while (true) { if (i++ == n) break; s += 1.0; }",
    "continue": "for (int i = 0; i < n; ++i) { s += 1.0; if (s > 3.0) continue; s += 0.0; }",
    "body of if": "if (n > 0) for (int i = 0; i < n; ++i) s += 1.0; else s = 0.0;",
    "body of else": "if (n < 0) s = 1.0; else for (int i = 0; i < n; ++i) s += 1.0;",
    "in a switch": "switch (int(n > 0)) { case 1: for (int i = 0; i < n; ++i) s += 1.0; break; default: s = 0.0; }",
    "return": "for (int i = 0; ; ++i) { if (i == n) return s; s += 1.0; }",
    "called": "s = counted(n);",
    "if in for without braces": "for (int i = 0; i < n; ++i) if (s >= 0.0) s += 1.0; else s = 0.0;",
    "loop in a loop": "for (int i = 0; i < n; i += 10) for (int j = i; j < i + 10 && j < n; ++j) s += 1.0;",
}
CALLED = "float counted(int n) { float s = 0.0; for (int i = 0; i < n; ++i) s += 1.0; return s; }"


@pytest.mark.parametrize("form", FORMS)
def test_a_loop_is_computed_right_or_refused(functions, form):
    made = functions(f"{CALLED}\nfloat f(int n) {{\n  float s = 0.0;\n\n  {FORMS[form]}\n  return s; }}")
    n = np.arange(0, 300, 7)
    np.testing.assert_array_equal(made.f(n), n)
    for length in (5_000, 50_000):  # beyond what is sure from counting each element by itself
        np.testing.assert_array_equal(made.f([3, length, 0]), [3, length, 0])
    for length in (65_536, 10**6, 2**31 - 11):
        with pytest.raises(CallError) as caught:
            made.f([3, length, 0])
        assert caught.value.line == (1 if form == "called" else 5)
        assert "ran 65535 passes" in caught.value.message


def test_an_endless_loop_is_an_error_within_a_moment(functions, mode):
    """Nothing is timed, but a batch of this size would take minutes, tile after tile."""
    made = functions("float f(float x) {\n  while (x != -1.0) x = x * 0.5 + 1.0;\n  return x; }", mode=mode)
    with pytest.raises(CallError, match=r"test\.glsl:2: the loops of float f\(float x\) ran 65535 passes"):
        made.f(np.ones(4_000_000, np.float32))
    assert made.f(-1) == -1  # the next call works


def test_endless_in_half_precision(functions):
    """2048 + 1 is 2048, and never gets to the next half, 2050."""
    made = functions("float f(float n) { float s = 0.0; while (s < n) s += 1.0; return s; }", mode="mediump")
    assert made.f(2000) == 2000
    with pytest.raises(CallError, match="ran 65535 passes"):
        made.f(2050)


def test_loops_of_an_included_file_are_named_there(functions, tmp_path):
    (tmp_path / "inner.glsl").write_text("\nfloat inner(float x) {\n while (x > 0.0) x += 1.0;\n return x; }\n")
    with pytest.raises(CallError) as caught:
        functions('#include "inner.glsl"\nfloat f(float x) { return inner(x); }').f(1)
    assert caught.value.file.endswith("inner.glsl")
    assert caught.value.line == 3


def test_the_passes_of_all_loops_add_up(functions):
    """The driver counts over all loops of an evaluation."""
    made = functions(
        "float f(int n) { float s = 0.0;\n for (int i = 0; i < n; ++i) s += 1.0;\n"
        "for (int i = 0; i < n; ++i) s += 1.0; return s; }"
    )
    assert made.f(30_000) == 60_000
    with pytest.raises(CallError) as caught:
        made.f(40_000)
    assert caught.value.line == 3


def test_elements_that_part_ways_do_not_stop_each_other(functions):
    """Evaluated together, each would be stopped by the passes of the others: 8 x 20 000."""
    text = "float f(int n, int k) { float s = 0.0;\n" + "\n".join(
        f"if (k == {k}) for (int i = 0; i < n; ++i) s += {k + 1}.0;" for k in range(8)
    )
    made = functions(text + " return s; }")
    n, k = 20_000 + np.arange(64), np.arange(64) % 8
    np.testing.assert_array_equal(made.f(n, k), n * (k + 1))


def test_a_loop_that_is_evaluated_in_a_fragment_stage_is_refused_early(functions, monkeypatch):
    made = functions(
        "float f(int n) { float s = 0.0; for (int i = 0; i < n; ++i) s += 1.0; return s + dFdx(s) * 0.0; }"
    )
    np.testing.assert_array_equal(made.f([1000, 1000]), [1000, 1000])
    for n in (5_000, 10**6):
        with pytest.raises(CallError, match="ran more than 4094 passes for one element"):
            made.f([n, n])


def test_counting_changes_no_bits(functions):
    """A loop of the same passes, once with a bound that the text shows; as written the driver may merge its passes."""
    body = "float s = x; for (int i = 0; i < {0}; ++i) {{ s = s * 1.7 + sin(s) * x; s = s - floor(s); }} return s;"
    made = functions(
        f"float f(float x) {{ {body.format(20)} }} float g(float x, int n) {{ {body.format('n')} }}", mode="precise"
    )
    x = np.linspace(0, 3, 1000, dtype=np.float32)
    np.testing.assert_array_equal(made.f(x), made.g(x, 20))


def test_batches_beyond_the_first_tile_are_counted_too(functions):
    made = functions("float f(int n) { float s = 0.0; while (s < float(n)) s += 1.0; return s; }")
    n = np.arange(100_000) % 50
    np.testing.assert_array_equal(made.f(n), n)
    n[-1] = 10**7
    with pytest.raises(CallError, match="65535"):
        made.f(n)
