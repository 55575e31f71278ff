"""The comment above a function: found where the author put it, nothing else taken for it."""

from __future__ import annotations

import pytest

#: what it is about -> a text with a function f, and the comment that belongs to it
COMMENTS = {
    "one line": ("// Luma.\nfloat f(float x) { return x; }\n", "Luma."),
    "lines": (
        "// One,\n//   indented,\n//\n// three.\nfloat f(float x) { return x; }\n",
        "One,\n  indented,\n\nthree.",
    ),
    "three slashes": ("/// One\n/// two\nfloat f(float x) { return x; }\n", "One\ntwo"),
    "no space": ("//One\n//two\nfloat f(float x) { return x; }\n", "One\ntwo"),
    "a block": ("/* One */\nfloat f(float x) { return x; }\n", "One"),
    "a block with stars": (
        "/**\n * One\n *   two\n *\n * three\n */\nfloat f(float x) { return x; }\n",
        "One\n  two\n\nthree",
    ),
    "a block without stars": ("/* One\n     two\n   three */\nfloat f(float x) { return x; }\n", "One\n  two\nthree"),
    "a blank line between": ("// Not this.\n\nfloat f(float x) { return x; }\n", ""),
    "a blank line within": ("// Not this.\n\n// This.\nfloat f(float x) { return x; }\n", "This."),
    "none": ("float f(float x) { return x; }\n", ""),
    "of the line above": ("float g; // Not this.\nfloat f(float x) { return x; }\n", ""),
    "of the function above": ("// Not this.\nvoid g() {}\nfloat f(float x) { return x; }\n", ""),
    "above a prototype": ("// Not this.\nfloat f(float x);\n// This.\nfloat f(float x) { return x; }\n", "This."),
    "above a block": ("// Not this.\n/* This. */\nfloat f(float x) { return x; }\n", "This."),
    "below a block": ("/* Not this. */\n// This.\nfloat f(float x) { return x; }\n", "This."),
    "a macro below a prototype": (
        "// Not this.\nfloat f(float x);\n#define MAKE(n) float n(float x) { return x; }\n// This.\nMAKE(f)\n",
        "This.",
    ),
    "below a directive": ("#define A\n// This.\nfloat f(float x) { return x; }\n", "This."),
    "above a directive": ("// Not this.\n#define A\nfloat f(float x) { return x; }\n", ""),
    "over several lines": (
        "// This.\nhighp vec3\nf(vec3 a,\n  // the second\n  float b)\n{ return a * b; }\n",
        "This.",
    ),
    "array returned": ("#version 430\n// This.\nfloat[2] f(float x) { return float[2](x, x); }\n", "This."),
    "calls itself by name": ("// This.\nfloat f(vec2 x) { return x.x; }\nfloat g(vec2 x) { return f(x); }\n", "This."),
    "behind a macro": ("#define MAKE(n) float n(float x) { return x; }\n// This.\nMAKE(f)\n", "This."),
    "windows": ("// One\r\n// two\r\nfloat f(float x) { return x; }\r\n", "One\ntwo"),
    "code in a comment": (
        "// float f(float x) is this.\nfloat f(float x) { return x; }\n",
        "float f(float x) is this.",
    ),
    "not ASCII": ("// Glättung, 0…1\nfloat f(float x) { return x; }\n", "Glättung, 0…1"),
}


@pytest.mark.parametrize("case", COMMENTS)
def test_the_comment_directly_above_is_the_functions(functions, case):
    text, comment = COMMENTS[case]
    assert functions(text).f.comment == comment


def test_overloads_have_a_comment_each(functions):
    made = functions(
        "// One.\nfloat f(float x) { return x; }\n// Two.\nfloat f(vec2 x) { return x.x; }\n"
        "float f(vec3 x) { return f(x.x); }"
    )
    assert [made[f"f({kind})"].comment for kind in ("float", "vec2", "vec3")] == ["One.", "Two.", ""]


def test_comments_are_those_of_the_file_that_the_function_is_in(functions, tmp_path):
    (tmp_path / "inner.glsl").write_text("\n// Inner.\nfloat inner(float x) { return x; }\n")
    made = functions('#include "inner.glsl"\n// Outer.\nfloat outer(float x) { return x; }\n', defines={"A": 1})
    assert (made.inner.comment, made.outer.comment) == ("Inner.", "Outer.")


def test_a_function_of_a_macro_given_from_outside_has_none(functions):
    made = functions(
        "// Not this.\nfloat g(float x) { return x; }\nMADE\n", defines={"MADE": "float f() { return 1.0; }"}
    )
    assert made.f.comment == ""
