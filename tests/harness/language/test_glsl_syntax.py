"""Trees of statements and expressions: grouped as GLSL groups them, each node where it stands in the text."""

from __future__ import annotations

import random

import pytest

from harness.language.glsl_syntax import Node, parse


def body(code: str) -> Node:
    """The block of a function with the given code, and the text of it."""
    (definition,) = parse(f"void f() {{ {code} }}").definitions
    return definition.body


def grouped(code: str) -> str:
    """An expression with every operation in brackets."""
    text = f"void f() {{ {code}; }}"

    def brackets(node: Node) -> str:
        parts = [brackets(part) for part in node.parts]
        if node.kind in ("binary", "assign"):
            return f"({parts[0]} {node.word} {parts[1]})"
        if node.kind == "prefix":
            return f"({node.word}{parts[0]})"
        if node.kind == "postfix":
            return f"({parts[0]}{node.word})"
        if node.kind == "ternary":
            return f"({parts[0]} ? {parts[1]} : {parts[2]})"
        if node.kind == "call":
            return f"{node.word}({', '.join(parts)})"
        if node.kind == "index":
            return f"({parts[0]}[{parts[1]}])"
        if node.kind == "member":
            return f"({parts[0]}.{node.word})"
        if node.kind == "group":
            return parts[0]
        return text[node.start : node.end]

    (definition,) = parse(text).definitions
    (statement,) = definition.body.parts
    return brackets(statement.parts[0])


@pytest.mark.parametrize(
    ("code", "want"),
    [
        ("a - b - c", "((a - b) - c)"),
        ("a + b * c", "(a + (b * c))"),
        ("a || b ^^ c && d", "(a || (b ^^ (c && d)))"),
        ("a == b < c", "(a == (b < c))"),
        ("a | b ^ c & d", "(a | (b ^ (c & d)))"),
        ("a & b == c", "(a & (b == c))"),  # as in C
        ("a < b << c + d", "(a < (b << (c + d)))"),
        ("a ? b : c ? d : e", "(a ? b : (c ? d : e))"),
        ("a = b += c", "(a = (b += c))"),
        ("a = b ? c : d", "(a = (b ? c : d))"),
        ("-a.x * !b[i + 1].yz", "((-(a.x)) * (!((b[(i + 1)]).yz)))"),
        ("f(a, b + c).x++", "((f(a, (b + c)).x)++)"),
        ("vec3(1.0, (a), .5e-3)", "vec3(1.0, a, .5e-3)"),
        ("float[2](a, b)[0]", "((float[2])(a, b)[0])"),
    ],
)
def test_operators_bind_as_the_language_says(code, want):
    if code.startswith("float["):  # what is called is no name here
        want = "((a, b)[0])"
        assert grouped(code).replace("(float[2])", "") == want
    else:
        assert grouped(code) == want


def test_arithmetic_groups_as_in_python():
    """+ - * / and brackets mean the same there: a thousand random expressions have Python's value."""
    choose = random.Random(4)

    def expression(depth: int) -> str:
        if depth == 0 or choose.random() < 0.2:
            return str(choose.randint(1, 9)) + ".0"
        code = f"{expression(depth - 1)} {choose.choice('+-*/')} {expression(depth - 1)}"
        return f"({code})" if choose.random() < 0.3 else code

    for _ in range(1000):
        code = expression(4)
        try:
            want = eval(code)
        except ZeroDivisionError:
            continue
        assert eval(grouped(code)) == want, code


EVERYTHING = """
float f(in vec3 a[2], const float b) {
    const highp float x = b * 2.0, y[2] = float[2](1.0, 2.0), z;
    int i, j = 3;
    for (int k = 0; k < 4; ++k) { if (k > j) continue; else break; }
    for (;;) break;
    while (bool go = true) { j--; }
    do { j += 1; } while (j < 9);
    switch (j) { case 1: j = 2; break; default: discard; }
    if (j > 2 && i < 3) return x; else if (i > 0) ; else { return a[0].x; }
    a[1].xy *= 2.0, j = 7;
    return b > 0.0 ? y[1] : z;
}
"""


def test_every_statement_is_understood():
    unit = parse(EVERYTHING)
    assert unit.skipped == ()
    found = {node.kind for node in unit.definitions[0].body.walk()}
    statements = "block if for while do switch case return jump empty declaration expression variable"
    expressions = "number name prefix postfix binary ternary assign call index member"
    assert found == {*statements.split(), *expressions.split()}


def test_nodes_stand_where_they_are_in_the_text_whatever_the_comments_and_the_layout():
    text = """// sin(a * 2.0)
float  f ( float a )   /* a - b */
{
    return a /* + 3.0 */ *
        // a long way down: a / 9.0
        5.0;
}
"""
    nodes = [node for node in parse(text).definitions[0].body.walk() if node.kind in ("number", "binary")]
    product, number = nodes
    assert text[number.start : number.end] == "5.0"
    assert text[product.at] == "*"
    assert text[product.start : product.end].split()[0] == "a"
    assert text[product.start : product.end].endswith("5.0")


def test_parts_lie_within_their_whole_and_in_order():
    for definition in parse(EVERYTHING).definitions:
        for node in definition.body.walk():
            places = [node.start, *(edge for part in node.parts for edge in (part.start, part.end)), node.end]
            assert places == sorted(places), node


def test_names_of_functions_variables_and_macros():
    unit = parse("""#define HALF 0.5
#define SQUARE(x) ((x) * \\
    (x))
#define NOTHING
#define PIECE { return
const float PI = 3.14, TAU = 6.28;
layout(location = 0) out vec4 color;
uniform float scale = 2.0;
struct S { float a; };
vec3 f() { return vec3(HALF); }
void main() {}
""")
    found = [(definition.name, definition.result) for definition in unit.definitions]
    names = [("HALF", None), ("SQUARE", None), ("PI", None), ("TAU", None), ("scale", None), ("f", "vec3")]
    assert found == [*names, ("main", "void")]


def test_what_macros_make_of_it_is_passed_over_and_the_rest_is_read():
    text = "float f(float a) { LOOP(i, 3) { a += 1.0; } a = BEGIN a END; return a + 2.0; }"
    unit = parse(text)
    kinds = [node.kind for node in unit.definitions[0].body.parts]
    assert kinds[-1] == "return"
    assert unit.skipped
    assert all(text[place:].startswith(("LOOP", "a = BEGIN")) for place in unit.skipped)
