"""Float literals taken out of a text: which are, which stay, and that a double keeps all digits of what was written."""

from __future__ import annotations

import numpy as np
import pytest

from harness.language.literals import lift


@pytest.mark.parametrize(
    ("text", "want"),
    [
        ("1.0", "1.0"),
        (".5", ".5"),
        ("2.", "2."),
        ("1e5", "1e5"),
        ("1.5e-3", "1.5e-3"),
        ("2.5E+3f", "2.5E+3"),
        ("3.0F", "3.0"),
    ],
)
def test_a_float_literal_is_taken_out(text, want):
    lifted, found = lift(f"#version 330\nfloat f() {{ return {text}; }}\n")
    assert found == [want]
    assert "return hn_literal_0;" in lifted


@pytest.mark.parametrize("text", ["1", "0x1F", "0x1e5", "017", "3u", "2.5lf", "2.5LF"])
def test_what_is_no_float_stays(text):
    lifted, found = lift(f"#version 400\ndouble f() {{ return {text}; }}\n")
    assert found == []
    assert f"return {text};" in lifted


@pytest.mark.parametrize(
    "text",
    ["float a[int(2.5)];", "const int n = int(2.5);", "const uvec2 n = uvec2(2.5);", "const bool b = 1.0 > 2.0;"],
)
def test_what_must_be_constant_stays_so(text):
    lifted, found = lift(f"#version 330\n{text}\nfloat f() {{ return 0.1; }}\n")
    assert text in lifted
    assert found == ["0.1"]


def test_every_line_stays_where_it_is():
    text = "#version 330\n#extension GL_ARB_gpu_shader5 : enable\n\nconst\nfloat a = 1.0;\n\nfloat f()\n{ return a; }\n"
    lifted, _ = lift(text)
    assert lifted.count("\n") == text.count("\n")
    assert lifted.splitlines()[1] == text.splitlines()[1]
    assert lifted.splitlines()[7] == text.splitlines()[7]


CONSTANTS = """
const float PI = 3.14159265358979;
const float TWO_PI = PI * 2.0;
const float WEIGHTS[2] = float[](0.1, 1.0 / 3.0);
struct Pair { float a; vec2 b; };
const Pair PAIR = Pair(0.7, vec2(0.2, 1e-3));
const int LENGTH = int(2.5);
#define SCALE(x) ((x) * 12.92)
float written(float x) { return x * 0.0031308; }
float pi(float x) { return x * PI; }
float two_pi(float x) { const float local = TWO_PI; return x * local; }
float folded(float x) { return x * (1.0 / 2.4); }
float of_function(float x) { return x * sqrt(2.0); }
float of_array(float x) { return x * WEIGHTS[1]; }
float of_struct(float x) { return x * PAIR.b.y; }
float of_macro(float x) { return SCALE(x); }
float of_integer(float x) { return x * 16777217; }
float beside_a_constant(float x) { float a[LENGTH]; a[1] = 0.1; return x * a[1]; }
float with_suffix(float x) { return x * 0.3f; }
"""


@pytest.mark.parametrize(
    ("name", "want"),
    [
        ("written", 0.0031308),
        ("pi", 3.14159265358979),
        ("two_pi", 6.28318530717958),
        ("folded", 1 / 2.4),
        ("of_function", np.sqrt(2.0)),
        ("of_array", 1 / 3),
        ("of_struct", 1e-3),
        ("of_macro", 12.92),
        ("of_integer", 16777216),  # the compiler makes it a float, which has no 16777217
        ("beside_a_constant", 0.1),
        ("with_suffix", 0.3),
    ],
)
def test_in_double_a_constant_has_the_digits_that_were_written(functions, name, want):
    assert functions(CONSTANTS, mode="double")[name](1) == want


def test_where_a_literal_must_be_constant_it_is_the_shortest_decimal_of_its_float(functions):
    """There the compiler has rounded it to float32."""
    text = "const float A = 2.5; const int N = int(A); float f(float x) { float a[N]; a[1] = 0.1; return a[1] * x; }"
    assert functions(text, mode="double").f(1) == 0.1


def test_thousands_of_literals_are_no_fewer(functions):
    total = " + ".join(f"{k}.5" for k in range(1000))
    assert functions(f"float f(float x) {{ return x + {total}; }}", mode="double").f(0) == 1000 * 1000 / 2


@pytest.mark.parametrize("version", ["120", "150", "310 es", "330", "450"])
def test_a_text_of_any_version_keeps_its_digits(functions, version):
    precision = "precision highp float;" if "es" in version else ""
    text = f"#version {version}\n{precision}\nconst float A = 0.1;\nfloat f(float x) {{ return x * A; }}"
    assert functions(text, mode="double").f(1) == 0.1
