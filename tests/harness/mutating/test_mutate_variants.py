"""What a file comes to under each set of macros, and whether a mutant changes it."""

from __future__ import annotations

import pytest

from harness.mutating.mutate_variants import Loaded, Variant, active_text, different

FILE = """#ifndef LEVEL
#define LEVEL 2.0
#endif
#define TWICE(x) ((x) + \\
    (x))
float unused(float x) { return x; }
#if defined(FAST)
float f(float x) { return x * 0.4166667; }
#else
/* #if
#endif */
float f(float x) { return unused(x) + TWICE(LEVEL) + 1.2e-38; }
#endif
float g(float x) { return f(x); }
"""
LINES = FILE.count("\n")


def variant(*defines: str, before: str = "", after: str = "") -> Variant:
    """The file within a shader that begins with macros and other text."""
    head = "#version 430\n" + "".join(f"#define {define}\n" for define in defines) + before
    offset = head.count("\n")
    return Variant(Loaded(head + FILE + after, tuple((offset + m, m) for m in range(1, LINES + 1))), FILE)


def test_the_lines_that_the_preprocessor_keeps():
    assert variant().active >= {2, 4, 6, 12, 14}
    assert not variant().active & {8}
    assert variant("FAST", "LEVEL 3.0").active >= {4, 6, 8, 14}
    assert not variant("FAST", "LEVEL 3.0").active & {2, 12}


def test_a_comment_that_looks_like_a_directive_is_none():
    assert 12 in variant().active


def test_active_text_keeps_every_character_in_its_place():
    text = active_text(FILE, variant("FAST"))
    assert len(text) == len(FILE)
    assert text.split("\n")[7] == FILE.split("\n")[7]
    assert text.split("\n")[11].strip() == ""


def test_variants_that_come_to_the_same_have_one_to_stand_for_them():
    plain, other, fast = variant(), variant("LEVEL 3.0"), variant("FAST")
    longer = variant("UNRELATED 1", before="float h() { return 1.0; }\n")
    assert different([longer, plain, other, fast]) == [1, 1, 2, 3]


@pytest.mark.parametrize(
    ("old", "new", "want"),
    [
        ("return f(x)", "return f(x) + x", "differs"),
        ("return f(x)", "return h(x)", "invalid"),
        ("return f(x)", "return (f(x))", "same"),
        ("x * 0.4166667", "x * 0.4", "same"),  # not active here
        ("1.2e-38", "1.21e-38", "differs"),
        ("#define LEVEL 2.0", "#define LEVEL 2.1", "differs"),
    ],
)
def test_what_a_mutant_comes_to(old, new, want):
    assert variant().outcome(FILE.replace(old, new, 1)) == want


def test_constants_that_print_alike_are_not_the_same():
    """0.4166667 and 0.4166668 are different floats with the same six digits; 0.41666670001 is the same float."""
    assert variant("FAST").outcome(FILE.replace("0.4166667", "0.4166668")) == "differs"
    assert variant("FAST").outcome(FILE.replace("0.4166667", "0.41666670001")) == "same"


def test_which_functions_a_function_reaches():
    assert variant().calls["g"] == {"g", "f", "unused"}
    assert variant("FAST").calls["g"] == {"g", "f"}
    assert variant(after="float h() { return g(1.0); }\n").calls["h"] == {"h", "g", "f", "unused"}


def test_a_vertex_shader_is_compiled_as_one():
    vertex = variant(after="void main() { gl_Position = vec4(g(float(gl_VertexID))); }\n")
    assert vertex.outcome(FILE) == "same"
    assert vertex.outcome(FILE.replace("return f(x)", "return h(x)")) == "invalid"
