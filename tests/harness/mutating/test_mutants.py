"""Mutants: one fault each, on the syntax, with names that last."""

from __future__ import annotations

import difflib

import pytest

from harness.mutating.mutants import KINDS, mutants


def made(code: str, kind: str) -> set[str]:
    """What the mutants of a kind make of a function's code."""
    text = f"float f(float a, vec3 v) {{ {code} }}"
    found = (m.apply(text) for m in mutants(text) if m.kind == kind)
    return {mutant.removeprefix("float f(float a, vec3 v) { ").removesuffix(" }") for mutant in found}


@pytest.mark.parametrize(
    ("kind", "code", "want"),
    [
        ("arithmetic", "a + b - c;", {"a - b - c;", "a + b + c;"}),
        ("arithmetic", "a * -b / c;", {"a / -b / c;", "a * -b * c;", "a * b / c;"}),
        ("arithmetic", "i++;", {"i--;"}),
        ("term", "x = a + b * c;", {"x = a;", "x = b * c;", "x = a + b;", "x = a + c;"}),
        ("term", "x = a - b - c;", {"x = a - b;", "x = (-c);", "x = a - c;", "x = (-b) - c;"}),
        ("term", "x = a / b;", {"x = a;"}),
        ("term", "x = a && b;", {"x = a;", "x = b;"}),
        ("constant", "x = 2.5;", {f"x = {n};" for n in ("0.0", "1.0", "5.0", "(-2.5)", "2.6")}),
        ("constant", "x = 1.0;", {f"x = {n};" for n in ("0.0", "2.0", "(-1.0)", "1.1")}),
        ("constant", "x = 0.0;", {"x = 1.0;", "x = 0.1;"}),
        ("constant", "x = 1.9e-5f;", {f"x = {n};" for n in ("0.0f", "1.0f", "3.8e-05f", "(-1.9e-05f)", "1.8e-05f")}),
        ("constant", "x = 7;", {f"x = {n};" for n in ("0", "1", "14", "8", "6")}),
        ("constant", "x = 0u;", {"x = 1u;"}),
        ("constant", "x = 0x10;", {f"x = {n};" for n in ("0", "1", "32", "17", "15")}),
        ("component", "v.x = v.xy.y + w.rgb.r;", {"v.y = v.xy.y + w.rgb.r;", "v.x = v.yx.y + w.rgb.r;"}
         | {"v.x = v.xy.x + w.rgb.r;", "v.x = v.xy.y + w.bgr.r;", "v.x = v.xy.y + w.rgb.g;"}),
        ("component", "v.xxx + m.albedo;", {"v.yyy + m.albedo;"}),
        ("arguments", "mix(a, b, c) + max(a, b);", {"mix(b, a, c) + max(a, b);", "mix(a, c, b) + max(a, b);"}),
        ("arguments", "g(a, a);", set()),
        ("guard", "x = max(a + b, c) * d;", {"x = (a + b) * d;", "x = c * d;"}),
        ("guard", "clamp(a, b, c);", {"a;", "min(a, c);", "max(a, b);"}),
        ("guard", "if (a) b = c;", {"if (true) b = c;", "if (false) b = c;"}),
        ("guard", "x = a ? b + c : d;", {"x = (b + c);", "x = d;"}),
        ("min-max", "max(a, min(b, c));", {"min(a, min(b, c));", "max(a, max(b, c));"}),
        ("comparison", "x = a < b;", {"x = a <= b;", "x = a > b;"}),
        ("comparison", "x = a >= b;", {"x = a > b;", "x = a <= b;"}),
        ("comparison", "x = a == b;", {"x = a != b;"}),
        ("comparison", "lessThanEqual(a, b);", {"lessThan(a, b);"}),
        ("logic", "x = a && !b;", {"x = a || !b;", "x = a && b;"}),
        ("logic", "if (a < b) c = d;", {"if (!(a < b)) c = d;"}),
        ("function", "sqrt(a + b) * c;", {"(a + b) * c;"}),
        ("function", "dot(a, b);", {"dot(a, a);", "dot(b, b);"}),
        ("function", "mix(a, b, c);", {"a;", "b;"}),
        ("function", "inversesqrt(g(a));", {"sqrt(g(a));", "inversesqrt(a);"}),
        ("function", "vec3(a);", set()),
        ("statement", "a = b; discard; float c = d;", {"; discard; float c = d;", "a = b; ; float c = d;"}),
        ("assignment", "a = b; a *= c;", {"a += b; a *= c;", "a = b; a /= c;", "a = b; a = c;"}),
        ("return", "return a + b;", {"return float(0);"}),
    ],
)  # fmt: skip
def test_what_is_made(kind, code, want):
    assert made(code, kind) == want


def test_a_returned_bool_is_negated():
    text = "bool f(float a) { return a > 0.0; }"
    assert [m.apply(text) for m in mutants(text) if m.kind == "return"] == ["bool f(float a) { return !(a > 0.0); }"]


LIBRARY = """// noise.glsl
#ifndef SCALE
#define SCALE 2.5 // of the lattice
#endif
const float HALF = 0.5;

/* a * b */ float value(float x, float y)
{
    float t = x * SCALE; // x + SCALE
#if SMOOTH
    t = t * t;
#else
    t = abs(t);
#endif
    return mix(x,
               y,
               t + HALF);
}
"""


def test_a_mutant_leaves_all_other_lines_as_they_are():
    for mutant in mutants(LIBRARY):
        before, after = LIBRARY.split("\n"), mutant.apply(LIBRARY).split("\n")
        assert len(before) == len(after), mutant.id
        changed = [n for n, (a, b) in enumerate(zip(before, after, strict=True), 1) if a != b]
        assert changed, mutant.id
        within = range(15, 18) if mutant.line in range(15, 18) else [mutant.line]
        assert set(changed) <= set(within), mutant.id


def test_comments_are_not_mutated():
    for mutant in mutants(LIBRARY):
        for comment in ("// noise.glsl", "// of the lattice", "/* a * b */", "// x + SCALE"):
            assert comment in mutant.apply(LIBRARY), mutant.id


def test_what_is_not_active_is_not_mutated():
    lines = LIBRARY.split("\n")
    active = "\n".join(" " * len(line) if n == 11 else line for n, line in enumerate(lines, 1))
    assert {m.line for m in mutants(LIBRARY)} - {m.line for m in mutants(LIBRARY, active)} == {11}


def test_macros_and_global_constants_are_mutated_by_name():
    found = {mutant.id.partition("+")[0] for mutant in mutants(LIBRARY)}
    assert found == {"SCALE", "HALF", "value"}


def test_names_are_unique_and_in_the_order_of_the_text():
    found = mutants(LIBRARY)
    assert len({m.id for m in found}) == len(found)
    assert [(m.line, m.column) for m in found] == sorted((m.line, m.column) for m in found)
    assert found == mutants(LIBRARY)


def test_names_last_when_the_file_changes_elsewhere():
    changed = LIBRARY.replace("// noise.glsl", "// noise.glsl\n\nfloat other() { return 1.0; }\n")
    assert {m.id for m in mutants(LIBRARY)} < {m.id for m in mutants(changed)}


def test_every_kind_says_what_it_is():
    text = "bool f(vec3 v, float a) { if (max(a, 1.0) < g(a, v.x) && sqrt(a) > 2.0) v.y = a + 1.0; return true; }"
    assert {m.kind for m in mutants(text)} == set(KINDS)


def test_a_mutant_is_small():
    """One edit: what is kept of the line is most of it or the change is one expression."""
    for mutant in mutants(LIBRARY):
        matcher = difflib.SequenceMatcher(None, LIBRARY, mutant.apply(LIBRARY), autojunk=False)
        assert matcher.ratio() > 0.9, mutant.id
