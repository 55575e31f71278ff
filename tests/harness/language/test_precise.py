"""``precise`` is arithmetic as written: numpy's float32, operation by operation, bit for bit, wherever it stands.

Expected values come from the same expression in numpy, whose float32 operations round once each, as IEEE 754 asks.
Drivers rewrite algebra where they may; the same tests, turned round, show that this one does so in these very places.
"""

from __future__ import annotations

import numpy as np
import pytest

from harness import native, shader

ONE, TWO = np.float32(1), np.float32(2)


def inputs():
    """a, b, c: magnitudes from 2^-20 to 2^20, so that sums round and no result is denormal; then the special ones."""
    random = np.random.default_rng(1)
    shape = 3, 4000
    numbers = random.choice([-1, 1], shape) * np.exp2(random.uniform(-20, 20, shape))
    special = np.array([[1, -1e-10, 3], [1, 1e-10, 3], [1e37, 1e37, -1e37], [1e20, 1e20, 1], [0.1, 0.2, 0.3]]).T
    return np.concatenate([special, numbers], axis=1).astype(np.float32)


A, B, C = inputs()
AB, ABC = "float a, float b", "float a, float b, float c"


@pytest.fixture
def on_llvmpipe():
    native.open_context()
    if "llvmpipe" not in native.context_info()["renderer"]:
        pytest.skip("measured on llvmpipe; another driver may do otherwise")


@pytest.fixture
def functions(tmp_path):
    def compile(text: str, mode: str = "precise", **options):
        path = tmp_path / "test.glsl"
        path.write_text(text)
        return shader(path, mode=mode, **options)

    return compile


PER_PROGRAM = 32  # functions evaluated at once, as 8 vec4: to compile a program takes longer than to run it


def together(folder, texts: dict[str, str], mode: str, *arguments, helpers: str = "") -> dict[str, tuple]:
    """Evaluates many functions ``float f@(float a, float b, float c)``: name -> (result, the arguments it got).

    A text has an @ after each global name of its own. Each function gets another a, some ulp away: a driver merges
    equal expressions, and one that is precise would hide another that is not.
    """
    parameters = ABC if len(arguments) == 3 else AB
    found = {}
    for first in range(0, len(texts), PER_PROGRAM):
        some = dict(list(texts.items())[first : first + PER_PROGRAM])
        rest = ", ".join("bc"[: len(arguments) - 1])
        calls = [f"f{k}(uintBitsToFloat(floatBitsToUint(a) + {k}u), {rest})" for k in range(len(some))]
        calls += ["0.0"] * (-len(calls) % 4)
        vectors = [f"vec4({', '.join(calls[k : k + 4])})" for k in range(0, len(calls), 4)]
        size = len(vectors)
        lines = ["#version 430", helpers, *(text.replace("@", str(k)) for k, text in enumerate(some.values()))]
        lines += [f"vec4[{size}] every({parameters}) {{ return vec4[{size}]({', '.join(vectors)}); }}", ""]
        path = folder / f"{mode}-{first}.glsl"
        path.write_text("\n".join(lines))
        results = shader(path, mode=mode).every(*arguments).reshape(len(arguments[0]), -1)
        for k, name in enumerate(some):
            a = (arguments[0].view(np.uint32) + np.uint32(k)).view(np.float32)
            found[name] = np.ascontiguousarray(results[:, k]), (a, *arguments[1:])
    return found


def same(got, want) -> bool:
    """Bit for bit, but any NaN is as good as any other."""
    got, want = np.asarray(got), np.asarray(want)
    nan = np.isnan(got) & np.isnan(want)
    return got.dtype == want.dtype == np.float32 and bool((nan | (got.view(np.uint32) == want.view(np.uint32))).all())


def numpy_result(compute, *arguments):
    with np.errstate(all="ignore"):
        return compute(*arguments)


def assert_as_numpy(got, compute, *arguments):
    want = numpy_result(compute, *arguments)
    assert same(got, want), f"{(got.view(np.uint32) != want.view(np.uint32)).sum()} of {got.size} differ"


def skip_unless_rewritten(got, compute, *arguments):
    if same(got, numpy_result(compute, *arguments)):
        pytest.skip("this driver computes it as written without being told")


# ---- The rewrites that are known -------------------------------------------------------------------------------------

#: what is written -> the same in numpy. These llvmpipe rewrites, given the chance.
REWRITTEN = {
    "(a + b) - a": lambda a, b, c: (a + b) - a,
    "a * b + a * c": lambda a, b, c: a * b + a * c,
    "1.0 + a * a * (b - 1.0)": lambda a, b, c: ONE + a * a * (b - ONE),
    "a * 0.0": lambda a, b, c: a * np.float32(0),
    "(a + 1.0) + 2.0": lambda a, b, c: (a + ONE) + TWO,
    "(a * 0.1) * 0.3": lambda a, b, c: (a * np.float32(0.1)) * np.float32(0.3),
}
#: These it leaves alone, or leaves alone for these numbers; another driver may not.
KEPT = {
    "a - (a + b)": lambda a, b, c: a - (a + b),
    "a * (1.0 - b) + c * b": lambda a, b, c: a * (ONE - b) + c * b,
    "a + b * (c - a)": lambda a, b, c: a + b * (c - a),
    "a - a": lambda a, b, c: a - a,
    "a + 0.0": lambda a, b, c: a + np.float32(0),
    "a / b": lambda a, b, c: a / b,
    "1.0 / b": lambda a, b, c: ONE / b,
    "a / b / c": lambda a, b, c: a / b / c,
    "1.0 / sqrt(abs(a))": lambda a, b, c: ONE / np.sqrt(np.abs(a)),
    "a / sqrt(abs(b))": lambda a, b, c: a / np.sqrt(np.abs(b)),
    "1.0 / (1.0 / a)": lambda a, b, c: ONE / (ONE / a),
    "sqrt(abs(a)) * sqrt(abs(a))": lambda a, b, c: np.sqrt(np.abs(a)) * np.sqrt(np.abs(a)),
    "a * b * c": lambda a, b, c: a * b * c,
    "a * (b * c)": lambda a, b, c: a * (b * c),
    "a * b + c": lambda a, b, c: a * b + c,
    "a * b - c": lambda a, b, c: a * b - c,
    "a + b + c": lambda a, b, c: a + b + c,
    "a + (b + c)": lambda a, b, c: a + (b + c),
    "-(a - b)": lambda a, b, c: -(a - b),
    "a - (-b)": lambda a, b, c: a - (-b),
    "-a * -b": lambda a, b, c: -a * -b,
    "a / 3.0": lambda a, b, c: a / np.float32(3),
    "a * a - b * b": lambda a, b, c: a * a - b * b,
    "(a - b) * (a + b)": lambda a, b, c: (a - b) * (a + b),
    "a * 2.0 * 0.5": lambda a, b, c: a * TWO * np.float32(0.5),
    "a * (1.0 / b)": lambda a, b, c: a * (ONE / b),
    "a / b * b": lambda a, b, c: a / b * b,
}


@pytest.fixture(scope="module")
def written_out(tmp_path_factory):
    """Results of all expressions, by mode."""
    texts = {e: f"float f@({ABC}) {{ return {e}; }}" for e in REWRITTEN | KEPT}
    folder = tmp_path_factory.mktemp("expressions")
    return {m: together(folder, texts, m, A, B, C) for m in ("as-written", "precise")}


@pytest.mark.parametrize("written", [*REWRITTEN, *KEPT])
def test_arithmetic_is_what_is_written(written_out, written):
    got, arguments = written_out["precise"][written]
    assert_as_numpy(got, (REWRITTEN | KEPT)[written], *arguments)


@pytest.mark.parametrize("written", REWRITTEN)
def test_the_driver_would_rewrite_it(written_out, written):
    got, arguments = written_out["as-written"][written]
    skip_unless_rewritten(got, REWRITTEN[written], *arguments)


def test_llvmpipe_rewrites(on_llvmpipe, written_out):
    """What the other tests skip where a driver does not: as written and precise differ for one expression at least."""
    got, arguments = written_out["as-written"]["(a + b) - a"]
    assert not same(got, numpy_result(REWRITTEN["(a + b) - a"], *arguments))


def test_a_lerp_made_of_the_distribution_is_more_accurate_than_what_is_written(functions):
    """1 + N^2 (a2 - 1) with N near 1: as written it loses its digits, rewritten it keeps some. Reference: float64."""
    N = 1 - np.exp2(np.linspace(-23, -2, 500)).astype(np.float32)
    a2 = np.float32(1e-6)
    want = 1 + N.astype(float) ** 2 * (float(a2) - 1)
    text = "float f(float N, float a2) { return 1.0 + N * N * (a2 - 1.0); }"
    written = functions(text).f(N, a2)
    rewritten = functions(text, "as-written").f(N, a2)
    skip_unless_rewritten(rewritten, lambda N, a2: ONE + N * N * (a2 - ONE), N, a2)
    assert np.abs(rewritten / want - 1).max() < 0.5 * np.abs(written / want - 1).max()


def test_what_could_be_folded_away_keeps_its_special_values(functions):
    """x * 0 is -0 for negative and NaN for infinite x; x - x is NaN for infinite x; x + 0 turns -0 into 0."""
    x = np.float32([0.0, -0.0, 1.0, -1.0, 3e38, np.inf, -np.inf, np.nan])
    got = functions("vec4 f(float x) { return vec4(x * 0.0, x - x, x + 0.0, x / x); }").f(x)
    zero = np.float32(0)
    assert_as_numpy(got, lambda x: np.stack([x * zero, x - x, x + zero, x / x], axis=1), x)


@pytest.mark.parametrize("zero", ["0.0", "0.", ".0", "0e0", "00.0f", "0.0F", "0.E-3", "0e+5"])
def test_every_spelling_of_zero_is_zero(functions, zero):
    got = functions(f"float f(float x) {{ return x + {zero}; }}").f(np.float32([-0.0]))
    assert_as_numpy(got, lambda x: x + np.float32(0), np.float32([-0.0]))


# ---- Wherever a value is computed ------------------------------------------------------------------------------------

#: place -> GLSL whose f@() computes EXPR there and returns it; ABC declares a, b and c
VALUES = {
    "return": "float f@(ABC) { return EXPR; }",
    "return in parentheses": "float f@(ABC) { return (EXPR); }",
    "local variable": "float f@(ABC) { float x = EXPR; return x; }",
    "assignment": "float f@(ABC) { float x; x = EXPR; return x; }",
    "comma declaration": "float f@(ABC) { float y = 1.0, x = EXPR, z; return x; }",
    "declaration with precision": "float f@(ABC) { highp float x = EXPR; return x; }",
    "const local": "float f@(ABC) { const float x = EXPR; return x; }",
    "for initialiser": "float f@(ABC) { for (float x = EXPR; true; ) return x; return 0.0; }",
    "for step": """float f@(ABC) {
        float x = 0.0;
        for (int i = 0; i < 1; ++i, x = EXPR) { }
        return x;
    }""",
    "for body": """float f@(ABC) {
        float x = 0.0;
        for (int i = 0; i < 3; ++i) x = EXPR;
        return x;
    }""",
    "while body": "float f@(ABC) { int i = 0; float x; while (i++ < 1) x = EXPR; return x; }",
    "do body": "float f@(ABC) { float x; do x = EXPR; while (false); return x; }",
    "parameter": "float f@(ABC) { b = EXPR; return b; }",
    "vector component": "float f@(ABC) { vec3 v; v.y = EXPR; return v.y; }",
    "swizzle": "float f@(ABC) { vec4 v; v.wx = vec2(EXPR, a); return v[3]; }",
    "vector": "float f@(ABC) { vec2 v = vec2(a, EXPR); return v.y; }",
    "matrix": "float f@(ABC) { mat2 m = mat2(a, b, EXPR, c); return m[1][0]; }",
    "array element": "float f@(ABC) { float x[3]; x[1] = EXPR; return x[1]; }",
    "array": "float f@(ABC) { float[2] x = float[2](b, EXPR); return x[1]; }",
    "array at run time": "float f@(ABC) { float x[3]; int k = int(c > 0.0); x[k] = EXPR; return x[k]; }",
    "struct member": """struct S@ { float x; vec2 y; };
    float f@(ABC) { S@ s; s.y.x = EXPR; return s.y.x; }""",
    "struct": """struct S@ { float x; vec2 y; };
    float f@(ABC) { S@ s = S@(a, vec2(b, EXPR)); return s.y.y; }""",
    "struct in an array": """struct S@ { float x; };
    float f@(ABC) { S@ s[2]; s[1] = S@(EXPR); return s[1].x; }""",
    "local struct": "float f@(ABC) { struct S@ { float x; }; S@ s = S@(EXPR); return s.x; }",
    "variable of a local struct": "float f@(ABC) { struct S@ { float x; } s = S@(EXPR); return s.x; }",
    "global": "float g@; float f@(ABC) { g@ = EXPR; return g@; }",
    "global array": "float g@[2]; float f@(ABC) { g@[1] = EXPR; return g@[1]; }",
    "global struct": "struct S@ { float x; } g@; float f@(ABC) { g@.x = EXPR; return g@.x; }",
    "global of a struct": "struct S@ { float x; }; S@ g@; float f@(ABC) { g@.x = EXPR; return g@.x; }",
    "global for an overload": """float g@; float h@(float x) { return x; } vec2 h@(vec2 x) { return x; }
    float f@(ABC) { g@ = EXPR; return h@(g@); }""",
    "local for an overload": """float h@(float x) { return x; } vec2 h@(vec2 x) { return x; }
    float f@(ABC) { float x = EXPR; return h@(x); }""",
    "entry point's output": "out vec4 o@; float f@(ABC) { o@.z = EXPR; return o@.z; }",
    "argument": "float id@(float x) { return x; } float f@(ABC) { return id@(EXPR); }",
    "argument in an argument": """float id@(float x) { return x; }
    float f@(ABC) { return id@(id@(id@(EXPR))); }""",
    "const argument": "float id@(const in float x) { return x; } float f@(ABC) { return id@(EXPR); }",
    "argument of a prototype": """float id@(float x);
    float f@(ABC) { return id@(EXPR); }
    float id@(float x) { return x; }""",
    "argument without a name in its prototype": """float id@(float);
    float f@(ABC) { return id@(EXPR); }
    float id@(float x) { return x; }""",
    "vector argument": "float y@(vec2 v) { return v.y; } float f@(ABC) { return y@(vec2(a, EXPR)); }",
    "struct argument": """struct S@ { float x; };
    float of@(S@ s) { return s.x; }
    float f@(ABC) { return of@(S@(EXPR)); }""",
    "array argument": """float of@(float x[2]) { return x[1]; }
    float f@(ABC) { return of@(float[2](a, EXPR)); }""",
    "within a called function": """float g@(ABC) { return EXPR; }
    float f@(ABC) { return g@(a, b, c); }""",
    "within two called functions": """float h@(ABC) { float x = EXPR; return x; }
    float g@(ABC) { return h@(a, b, c); }
    float f@(ABC) { return g@(a, b, c); }""",
    "half here, half in a called function": """float g@(float x) { return x; }
    float f@(ABC) { return EXPR_OF_CALLS; }""",
    "out": "void g@(ABC, out float x) { x = EXPR; } float f@(ABC) { float x; g@(a, b, c, x); return x; }",
    "inout": "void g@(inout ABC) { a = EXPR; } float f@(ABC) { g@(a, b, c); return a; }",
    "out into a component": "void g@(ABC, out float x) { x = EXPR; } "
    "float f@(ABC) { vec3 v; g@(a, b, c, v.z); return v.z; }",
    "out into an element": "void g@(ABC, out float x) { x = EXPR; } "
    "float f@(ABC) { float x[2]; g@(a, b, c, x[1]); return x[1]; }",
    "struct result": """struct S@ { float x; };
    S@ g@(ABC) { return S@(EXPR); }
    float f@(ABC) { return g@(a, b, c).x; }""",
    "array result": """float[2] g@(ABC) { return float[2](b, EXPR); }
    float f@(ABC) { return g@(a, b, c)[1]; }""",
    "result with precision": """mediump float g@(ABC) { return EXPR; }
    float f@(ABC) { return g@(a, b, c); }""",
    "if without braces": "float f@(ABC) { if (c == c) return EXPR; return 0.0; }",
    "else without braces": "float f@(ABC) { if (c != c) return 0.0; else return EXPR; }",
    "else if": """float f@(ABC) {
        if (c != c) return 0.0; else if (c == c) return EXPR; else return 1.0;
    }""",
    "return in a loop": "float f@(ABC) { for (;;) { if (c == c) return EXPR; } return 0.0; }",
    "return in a do loop": "float f@(ABC) { do return EXPR; while (true); return 0.0; }",
    "switch": """float f@(ABC) {
        switch (int(c != c)) { case 1: return 0.0; case 0: return EXPR; default: break; }
        return 1.0;
    }""",
    "both branches": "float f@(ABC) { float x; if (c > 0.0) x = EXPR; else x = EXPR; return x; }",
    "chosen by ?": "float f@(ABC) { return c == c ? EXPR : 0.0; }",
    "other side of ?": "float f@(ABC) { return c != c ? 0.0 : EXPR; }",
    "comma operator": "float f@(ABC) { float x; return (x = c, EXPR); }",
    "assigned within an expression": "float f@(ABC) { float x; return (x = EXPR); }",
    "block of its own": "float f@(ABC) { float x; { float y = EXPR; x = y; } return x; }",
    "shadowed name": "float x@; float f@(ABC) { float x@ = EXPR; return x@; }",
    "macro that returns": """#define RET@(x) return x
    float f@(ABC) { RET@(EXPR); }""",
    "macro that returns, with its semicolon": """#define RET@(x) return x;
    float f@(ABC) { if (c == c) RET@(EXPR) return 0.0; }""",
    "macro that declares": """#define LET@(name, x) float name = x
    float f@(ABC) { LET@(y, EXPR); return y; }""",
    "macro for a type": """#define REAL@ float
    REAL@ f@(REAL@ a, REAL@ b, REAL@ c) { REAL@ x = EXPR; return x; }""",
    "macro for the function": """#define MAKE@(name) float name(ABC) { float x = EXPR; return x; }
    MAKE@(f@)""",
    "user's own precise": "float f@(ABC) { precise float x = EXPR; return x; }",
    "user's own precise parameter": "float f@(precise ABC) { a = EXPR; return a; }",
}
#: what is computed -> the same with a call of g@() around every operation
PLACED = {
    "(a + b) - a": "g@(g@(a + b) - a)",
    "a * b + a * c": "g@(g@(a * b) + g@(a * c))",
    "1.0 + a * a * (b - 1.0)": "g@(1.0 + g@(a * a) * g@(b - 1.0))",
    "(a + 1.0) + 2.0": "g@(g@(a + 1.0) + 2.0)",  # Mesa does this one early, before it inlines functions
}


@pytest.fixture(scope="module")
def placed(tmp_path_factory):
    """Results of all places, by mode and by what is computed there."""
    found = {}
    for mode, written in [("precise", written) for written in PLACED] + [("as-written", "(a + b) - a")]:
        texts = {
            place: text.replace("EXPR_OF_CALLS", PLACED[written]).replace("EXPR", written).replace("ABC", ABC)
            for place, text in VALUES.items()
        }
        folder = tmp_path_factory.mktemp("places")
        found[mode, written] = together(folder, texts, mode, A, B, C)
    return found


@pytest.mark.parametrize("written", PLACED)
@pytest.mark.parametrize("place", VALUES)
def test_a_value_is_precise_wherever_it_is_computed(placed, place, written):
    got, arguments = placed["precise", written][place]
    assert_as_numpy(got, REWRITTEN[written], *arguments)


@pytest.mark.parametrize("place", [place for place in VALUES if "own precise" not in place])
def test_the_driver_would_rewrite_it_there(placed, place):
    got, arguments = placed["as-written", "(a + b) - a"][place]
    skip_unless_rewritten(got, REWRITTEN["(a + b) - a"], *arguments)


@pytest.mark.parametrize("declaration", ["out float x) { x =", "inout float c) { c ="])
def test_what_a_function_gives_out_is_precise(functions, declaration):
    made = functions(f"void f(float a, float b, {declaration} (a + b) - a; }}")
    got = made.f(A, B) if declaration.startswith("out") else made.f(A, B, C)
    assert_as_numpy(got, lambda a, b: (a + b) - a, A, B)


@pytest.mark.parametrize("operator", ["+=", "-=", "*=", "/="])
def test_compound_assignment_is_one_operation(functions, operator):
    got = functions(f"float f(float a, float b, float c) {{ float x = b * c; x {operator} a * c; return x; }}").f(
        A, B, C
    )
    compute = {
        "+=": lambda a, b, c: b * c + a * c,
        "-=": lambda a, b, c: b * c - a * c,
        "*=": lambda a, b, c: b * c * (a * c),
        "/=": lambda a, b, c: b * c / (a * c),
    }
    assert_as_numpy(got, compute[operator], A, B, C)


def test_a_loop_adds_in_its_order(functions):
    """A sum of ten terms, each rounded before the next is added: expected from the same loop in numpy."""

    def compute(a, b, c):
        total = np.zeros_like(a)
        for k in range(10):
            total = total + a * (b + np.float32(k)) - a * b
        return total

    text = """float f(float a, float b, float c) {
        float total = 0.0;
        for (int k = 0; k < 10; ++k)
            total = total + a * (b + float(k)) - a * b;
        return total;
    }"""
    assert_as_numpy(functions(text).f(A, B, C), compute, A, B, C)


def test_increments_count_by_one(functions):
    text = "float f(float a, float b, float c) { float x = a; x++; ++x; return x - a; }"
    assert_as_numpy(functions(text).f(A, B, C), lambda a, b, c: ((a + ONE) + ONE) - a, A, B, C)


def test_a_global_with_an_initialiser(functions):
    text = "float third = 1.0 / 3.0; float f(float a, float b, float c) { return (a + third) - a; }"
    assert_as_numpy(functions(text).f(A, B, C), lambda a, b, c: (a + ONE / np.float32(3)) - a, A, B, C)


def test_a_uniform_takes_part_like_any_number(functions):
    text = "uniform float u; float f(float a, float b, float c) { return (a + u) - a; }"
    assert_as_numpy(functions(text).f(A, B, C, u=0.1), lambda a, b, c: (a + np.float32(0.1)) - a, A, B, C)


def test_constants_are_folded_by_rounding_each_operation(functions):
    """Compilers compute constants themselves: in float32 they get 0x1.99999ap-4 * 3 = 0x1.333334p-2, not 0.3."""
    text = "const float k = 0.1 * 3.0; float f(float a) { const float l = 0.1 * 3.0; return k + (a - a) + (l - k); }"
    assert functions(text).f(1.0) == np.float32(0.1) * np.float32(3)


def test_functions_of_an_included_file_are_precise(tmp_path):
    (tmp_path / "inner.glsl").write_text("float inner(float a, float b) { float x = a + b; return x - a; }\n")
    (tmp_path / "outer.glsl").write_text(
        '#include "inner.glsl"\nfloat f(float a, float b, float c) { return inner(a, b); }\n'
    )
    assert_as_numpy(shader(tmp_path / "outer.glsl", mode="precise").f(A, B, C), lambda a, b, c: (a + b) - a, A, B, C)


def test_every_function_of_a_file_is_precise_whoever_is_called(functions):
    made = functions(
        "float f(float a, float b) { return (a + b) - a; }\nvec2 g(vec2 a, vec2 b) { return (a + b) - a; }\n"
        "float f(float a, float b, float c) { return a * b + a * c; }"
    )
    pairs = np.stack([A, C], axis=1), np.stack([B, A], axis=1)
    assert_as_numpy(made.f(A, B), lambda a, b: (a + b) - a, A, B)
    assert_as_numpy(made.f(A, B, C), lambda a, b, c: a * b + a * c, A, B, C)
    assert_as_numpy(made.g(*pairs), lambda a, b: (a + b) - a, *pairs)


def test_a_struct_that_is_returned_is_precise(functions):
    got = functions(
        "struct S { float x; vec2 y; }; S f(float a, float b) { return S((a + b) - a, vec2(a * b + a)); }"
    ).f(A, B)
    assert_as_numpy(got.x, lambda a, b: (a + b) - a, A, B)
    assert_as_numpy(got.y[:, 1], lambda a, b: a * b + a, A, B)


def test_an_array_that_is_returned_is_precise(functions):
    got = functions("float[2] f(float a, float b) { return float[2]((a + b) - a, (b + a) - b); }").f(A, B)
    assert_as_numpy(got, lambda a, b: np.stack([(a + b) - a, (b + a) - b], axis=1), A, B)


# ---- Wherever something is decided -----------------------------------------------------------------------------------

#: a + b < a is b < 0 in real numbers, and false in floats where b is lost in a: here, 1 and -1e-10
LOST = (np.float32([1, 1]), np.float32([-1e-10, -1e-10]))
#: the same for the sum of constants: a is lost in 1e10, but not in the 0 that both make together
EARLY = "(a + 1e10) + -1e10 > 0.0"
HELPERS = """
bool yes(inout float n) { n += 1.0; return true; }
float one() { return 1.0; }
float zero() { return 0.0; }
void set(out float x, float to) { x = to; }
"""
#: place -> a function that returns 0 where the decision falls as written, and 1 otherwise
DECISIONS = {
    "if": "if (a + b < a) return 1.0; return 0.0;",
    "else if": "if (a < 0.0) return 3.0; else if (a + b < a) return 1.0; else return 0.0;",
    "if not": "if (!(a + b >= a)) return 1.0; return 0.0;",
    "if equal": "if (a + b == a) return 0.0; return 1.0;",
    "if and": "if (b != 2.0 && a + b < a) return 1.0; return 0.0;",
    "if and a call": "float n = 0.0; if (a + b < a && yes(n)) return 1.0; return n;",
    "if a call and": "float n = 0.0; if (yes(n) && a + b < a) return 1.0; return 0.0;",
    "if or a call": "float n = 0.0; if (a + b >= a || yes(n)) return n; return 2.0;",
    "if xor": "if ((a + b < a) ^^ false) return 1.0; return 0.0;",
    "if any": "if (any(lessThan(vec2(a + b), vec2(a)))) return 1.0; return 0.0;",
    "if comma": "float x; if (x = 1.0, a + b < a) return 1.0; return 0.0;",
    "if assigned": "bool x; if (x = a + b < a) return 1.0; return 0.0;",
    "if a variable": "bool x = a + b < a; if (x) return 1.0; return 0.0;",
    "while": "float n = 0.0; while (a + b < a) { n += 1.0; if (n > 0.0) break; } return n;",
    "while and": "float n = 0.0; while (n < 1.0 && a + b < a) n += 1.0; return n;",
    "do while": "float n = 0.0; do n += 1.0; while (a + b < a && n < 2.0); return n - 1.0;",
    "for": "float n = 0.0; for (; a + b < a && n < 1.0; ) n += 1.0; return n;",
    "for with all three": "float n = 0.0; for (int i = 0; a + b < a && i < 1; ++i) n += 1.0; return n;",
    "switch": "switch (int(a + b < a)) { case 0: return 0.0; case 1: return 1.0; } return 2.0;",
    "switch on a uint": "switch (uint(a + b < a)) { case 0u: return 0.0; default: return 1.0; }",
    "? returned": "return a + b < a ? 1.0 : 0.0;",
    "? assigned": "float x = a + b < a ? 1.0 : 0.0; return x;",
    "? of calls": "return a + b < a ? one() : zero();",
    "? with consequences": "float x = 0.0, y = 0.0; a + b < a ? x++ : y++; return x;",
    "? with consequences, after if": "float x = 0.0, y = 0.0; if (b != 2.0) a + b < a ? x++ : y++; return x;",
    "? after an index": "vec2 v; int k = 1; v[k] = 0.0; float y; a + b < a ? v[k]++ : y++; return v[1];",
    "? of ?": "return a < 0.0 ? 2.0 : a + b < a ? one() : zero();",
    "? after and": "float n = 0.0; return yes(n) && a + b < a ? one() : zero();",
    "? of one sum": "return (a + b < a ? one() : zero()) * (a + b < a ? 1.0 : 2.0);",
    "and": "float n = 0.0; bool x = a + b < a && yes(n); return n;",
    "or": "float n = 0.0; bool x = a + b >= a || yes(n); return n;",
    "and statement": "float n = 0.0; a + b < a && yes(n); return n;",
    "argument": "float x; set(x, float(a + b < a)); return x;",
    "bool": "return float(a + b < a);",
    "mix": "return mix(0.0, 1.0, a + b < a);",
    "step": "return 1.0 - step(a, a + b);",
    "sign": "return -sign((a + b) - a);",
    "max": "return max(a - (a + b), -((a + b) - a)) == 0.0 ? 0.0 : 1.0;",
    "floor": "return -floor((a + b) - a);",
    "index read": "float x[2] = float[2](0.0, 1.0); return x[int(a + b < a)];",
    "index written": "float x[2] = float[2](0.0, 0.0); x[int(a + b < a)] = 1.0; return x[1];",
    "index of a vector": "vec2 x = vec2(0.0); x[int(a + b < a)] = 1.0; return x.y;",
    "index of a matrix": "mat2 m = mat2(0.0); m[int(a + b < a)][1] = 1.0; return m[1][1];",
    "index incremented": "vec2 x = vec2(0.0); x[int(a + b < a)]++; return x.y;",
    "index of an out": "vec2 x = vec2(0.0); set(x[int(a + b < a)], 1.0); return x.y;",
    "modf": "float whole; float x = modf(float(a + b < a), whole); return whole;",
}


@pytest.fixture(scope="module")
def decided(tmp_path_factory):
    """Results of all decisions, by mode; "early" is precise with a condition that Mesa rewrites before it inlines."""
    texts = {place: f"float f@(float a, float b) {{ {body} }}" for place, body in DECISIONS.items()}
    early = {p: t.replace("a + b < a", EARLY).replace("a + b >= a", f"!({EARLY})") for p, t in texts.items()}
    wanted = {"as-written": ("as-written", texts), "precise": ("precise", texts), "early": ("precise", early)}
    return {
        name: together(tmp_path_factory.mktemp(name), given, mode, *LOST, helpers=HELPERS)
        for name, (mode, given) in wanted.items()
    }


@pytest.mark.parametrize("kind", ["precise", "early"])
@pytest.mark.parametrize("place", DECISIONS)
def test_a_decision_hinges_on_the_rounded_value(decided, place, kind):
    got, _ = decided[kind][place]
    np.testing.assert_array_equal(got, [0, 0])


@pytest.mark.parametrize("place", DECISIONS)
def test_the_driver_would_decide_otherwise(decided, place):
    got, _ = decided["as-written"][place]
    if (got == 0).all():
        pytest.skip("this driver decides as written without being told")
    np.testing.assert_array_equal(got, [1, 1])


#: place of an expression whose type only the compiler knows, or only a declaration -> text
TYPED = {
    "argument of an overload": "float id(float x) { return x; } vec2 id(vec2 x) { return x; } "
    "float f(float a, float c) { return id(EXPR); }",
    "of the other overload": "float y(float x) { return x; } float y(vec2 x) { return x.y; } "
    "float f(float a, float c) { return y(vec2(c, EXPR)); }",
    "one overload within another": "float id(float x) { return x; } vec2 id(vec2 x) { return x; } "
    "float f(float a, float c) { return id(id(vec2(id(EXPR), c)).x); }",
    "over several lines": "float id(float x) { return x; } vec2 id(vec2 x) { return x; } "
    "float f(float a, float c) {\n return id(\n EXPR\n ) + 0.0 * id(id(vec2(c)).x); }",
    "component by an index": "float f(float a, float c) { vec2 v; int k = int(c > 0.0); v[k] = EXPR; return v[k]; }",
    "component of a parameter": "float g(vec3 v, int k, float a, float c) { v[k] = EXPR; return v[k]; } "
    "float f(float a, float c) { return g(vec3(c), int(c > 0.0), a, c); }",
    "component of a vector in an array": "float f(float a, float c) { vec2 v[3]; int k = int(c > 0.0); "
    "v[k + 1][k] = EXPR; return v[k + 1][k]; }",
    "component of a matrix": "float f(float a, float c) { mat3x2 m; int k = int(c > 0.0); m[k + 1][k] = EXPR; "
    "return m[k + 1][k]; }",
    "component of a member": "struct S { float x; vec4 v[2]; }; float f(float a, float c) { S s; int k = int(c > 0.0); "
    "s.v[1][k] = EXPR; return s.v[1][k]; }",
    "component of a global": "vec4 v; float f(float a, float c) { int k = int(c > 0.0); v[k] = EXPR; return v[k]; }",
    "component without braces": "float f(float a, float c) { vec2 u = vec2(c), v; int k = int(c > 0.0); "
    "if (k == 0) v[k] = EXPR; else v[k] = EXPR; return v[k]; }",
}


@pytest.mark.parametrize("place", TYPED)
def test_a_value_whose_type_has_to_be_found_out(on_llvmpipe, functions, place):
    text = TYPED[place].replace("EXPR", "(a + 1.0) + 2.0")
    assert_as_numpy(functions(text).f(A, C), lambda a, c: (a + ONE) + TWO, A, C)


@pytest.mark.parametrize(
    ("declared", "zero"),
    [
        ("const float Z = 0.0;", "Z"),
        ("const float A = 1.0, Z = 0.0;", "Z"),
        ("const highp float Z = 0.0;", "Z"),
        ("const vec3 Z = vec3(1.0, 0.0, 2.0);", "Z.y"),
        ("const vec2 Z = vec2(0.0);", "Z[1]"),
        ("const float Y = 0.0; const vec2 Z = vec2(1.0, Y);", "Z.y"),
    ],
)
def test_a_constant_zero_is_multiplied_with(functions, declared, zero):
    x = np.float32([-1, 2, np.inf, np.nan])
    got = functions(f"{declared} float f(float x) {{ return x * {zero}; }}").f(x)
    assert_as_numpy(got, lambda x: x * np.float32(0), x)


def test_a_parameter_may_have_the_name_of_a_constant(functions):
    text = "const float Z = 0.0; float f(float Z) { return Z + 1.0; } float g(float x) { float Z = x; return Z; }"
    assert functions(text).f(2) == 3
    assert functions(text).g(2) == 2


def test_an_argument_that_all_overloads_take_alike(functions):
    text = """float sum(float x, float y) { return x + y; }
    float sum(float x, vec2 y) { return x + y.x; }
    float sum(float x, out vec2 y, float z) { y = vec2(x); return x; }
    float f(float a) { vec2 v; return sum(sum((a + 1.0) + 2.0, vec2(0.0)), v, 1.0); }"""
    assert_as_numpy(functions(text).f(A), lambda a: (a + ONE) + TWO, A)


def test_arguments_of_every_type_arrive(functions):
    """1 + 2 + ... + 10; each is another type of parameter."""
    text = """struct S { float x; };
    float of(int i, uint u, bool b, vec2 v, mat2 m, float x[2], vec2[2] y, S s, const in S t[1], inout float o) {
        return float(i) + float(u) + (b ? 3.0 : 0.0) + v.y + m[1][0] + x[1] + y[1].y + s.x + t[0].x + o;
    }
    float f(int i) {
        float o = 10.0;
        return of(i, 2u, true, vec2(0, 4), mat2(0, 0, 5, 0), float[2](0.0, 6.0), vec2[2](vec2(0), vec2(7)), S(8.0),
                  S[1](S(9.0)), o);
    }"""
    assert functions(text).f(1) == 55


def test_arguments_with_commas_of_their_own(functions):
    text = """float pair(float x, float y) { return x * 10.0 + y; }
    float f(float a) { float t; return pair((t = a, t + 1.0), pair(a, vec2(3, 4)[1])); }"""
    assert functions(text).f(1.0) == 34


def test_conditions_that_declare_stay_as_they_are(functions):
    text = "float f(float a) { while (bool more = a > 1.0) a = a - 1.0; return a; }"
    np.testing.assert_array_equal(functions(text).f([3.5, 0.5]), [0.5, 0.5])


def test_constant_decisions_stay_constant(functions):
    """GLSL wants a constant in these places, and a call of a function is none."""
    text = """const int N = 2 > 1 && true ? 2 : 3;
    float f(float a) {
        const int M = 2 > 1 || false ? 1 : 3;
        const bool both = M == 1 && N == 2;
        float x[M < 2 ? N : 1];
        x[1] = both ? a : 0.0;
        switch (M) { case true && true ? 1 : 2: return x[1]; }
        return 9.0;
    }"""
    assert functions(text).f(5.0) == 5.0


def test_void_functions_may_return_early(functions):
    text = "void f(float a, float b, out float x) { x = 0.0; if (a + b < a) return; x = (a + b) - a; }"
    a, b = np.float32([1, 1]), np.float32([-1e-10, -0.25])
    np.testing.assert_array_equal(functions(text).f(a, b), [0, 0])
    np.testing.assert_array_equal(functions(text).f(a, np.float32(0.1)), [(ONE + np.float32(0.1)) - ONE] * 2)


# ---- GLSL's own functions --------------------------------------------------------------------------------------------
# Their arithmetic is the driver's own: GLSL states no order of operations. What holds here was measured; it is the same
# in both modes except for mix(), so a reference in float32 can use it.


def vectors(seed, *shape):
    return np.random.default_rng(seed).standard_normal(shape).astype(np.float32)


def sum_from_the_last(terms):
    """x0 + (x1 + (x2 + ...)) over the last axis."""
    total = terms[..., -1]
    for k in range(terms.shape[-1] - 2, -1, -1):
        total = terms[..., k] + total
    return total


@pytest.mark.parametrize("size", [2, 3, 4])
def test_dot_adds_its_products_from_the_last_component(functions, on_llvmpipe, mode, size):
    a, b = vectors(1, 2000, size), vectors(2, 2000, size)
    got = functions(f"float f(vec{size} a, vec{size} b) {{ return dot(a, b); }}", mode).f(a, b)
    assert same(got, sum_from_the_last(a * b))


def test_length_is_the_root_of_that_sum(functions, on_llvmpipe, mode):
    a = vectors(3, 2000, 3)
    got = functions("float f(vec3 a) { return length(a); }", mode).f(a)
    assert same(got, np.sqrt(sum_from_the_last(a * a)))


def test_normalize_multiplies_by_the_reciprocal_root(functions, on_llvmpipe, mode):
    """Three roundings (sum, root, product) and inversesqrt's own error of 1.5 ulp."""
    a = vectors(4, 2000, 3)
    made = functions("vec3 f(vec3 a) { return normalize(a); } float r(float x) { return inversesqrt(x); }", mode)
    assert same(made.f(a), a * made.r(sum_from_the_last(a * a))[:, None])


def test_mix_is_the_specified_sum_when_precise(functions, on_llvmpipe):
    """x (1 - t) + y t [GLSL 4.60, 8.3]; the driver would rather compute x + t (y - x)."""
    a, b, t = vectors(5, 3, 2000)
    got = functions("float f(float a, float b, float t) { return mix(a, b, t); }").f(a, b, t)
    assert same(got, a * (ONE - t) + b * t)


def test_cross_is_its_formula(functions, on_llvmpipe, mode):
    a, b = vectors(6, 2000, 3), vectors(7, 2000, 3)
    got = functions("vec3 f(vec3 a, vec3 b) { return cross(a, b); }", mode).f(a, b)
    assert same(got, a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]])


def test_a_matrix_adds_its_columns_from_the_first(functions, on_llvmpipe, mode):
    m, v = vectors(8, 2000, 3, 3), vectors(9, 2000, 3)
    got = functions("vec3 f(mat3 m, vec3 v) { return m * v; }", mode).f(m, v)
    terms = m * v[:, None, :]
    assert same(got, (terms[..., 0] + terms[..., 1]) + terms[..., 2])
