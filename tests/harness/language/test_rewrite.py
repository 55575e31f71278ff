"""The rewriting of GLSL, token by token: what it may change, and that compilers still take the result."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from harness import native
from harness.language import glsl, precise, rewrite
from harness.native import Stage

ROOT = Path(__file__).resolve().parents[3]
#: what is not GLSL by itself: brdf.glsl includes it in its middle
PARTS = {"half.glsl", "rungs.glsl"}
FILES = sorted(
    path
    for folder in ("shaders", "tests/conformance", "tests/harness/glsl")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in (".glsl", ".frag", ".vert") and path.name not in PARTS
)
INCLUDE_DIRS = [ROOT / "tests/conformance/22-include-paths/library" / name for name in ("one", "two")]
MAIN = "void main() {}\n"


def preprocessed(path: Path) -> str:
    """A file of the corpus as ``shader`` hands it on."""
    source = glsl.load(path, {}, [*INCLUDE_DIRS, path.parent, path.parent.parent], version=glsl.VERSION)
    return native.glsl_preprocess(Stage.FRAGMENT, source.text)


def words(text: str) -> list[str]:
    """Names, numbers and signs, one by one."""
    return re.findall(r"[A-Za-z_]\w*|[\d.]+\w*|\S", text)


def at_400(text: str) -> str:
    return re.sub(r"^#version \d+", "#version 400", text)


@pytest.fixture(params=FILES, ids=lambda path: str(path.relative_to(ROOT)))
def text(request) -> str:
    return preprocessed(request.param)


def test_the_corpus_is_there():
    assert len(FILES) > 20


def test_no_line_moves(text):
    assert rewrite.isolate(text).count("\n") == text.count("\n")
    assert precise.make_precise(text).count("\n") == text.count("\n")


def test_isolate_only_takes_away(text):
    """Word by word, on every line, what is left was there, in this order."""
    for before, after in zip(text.split("\n"), rewrite.isolate(text).split("\n"), strict=True):
        rest = iter(words(before))
        assert all(word in rest for word in words(after)), (before, after)


def test_isolate_leaves_functions_alone(text):
    isolated = rewrite.isolate(text)
    assert rewrite.result_names(isolated) == [
        name for name, function in zip(rewrite.result_names(text), functions(text), strict=True) if function != "main"
    ]


def functions(text: str) -> list[str]:
    """Names of the functions defined, by the layout that glslang gives its output: a line ends in ``name(...){``."""
    return re.findall(r"^[\w\[\] ]*?(\w+)\([^;{}]*\)\s*\{", text, re.MULTILINE)


def test_isolate_done_twice_is_done_once(text):
    once = rewrite.isolate(text)
    assert rewrite.isolate(once) == once


def with_zeros_alike(text: str) -> list[str]:
    return ["0.0" if re.fullmatch(r"0*\.0+|0+\.|hn_zero", word) else word for word in words(text)]


def test_make_precise_only_adds(text):
    """All words of a line are there in their order; but `return E` has its `return` after E, and zeros get a name."""
    for before, after in zip(text.split("\n"), precise.make_precise(text).split("\n"), strict=True):
        rest = iter(with_zeros_alike(after))
        assert all(word in rest for word in with_zeros_alike(before) if word != "return"), (before, after)


def test_glslang_accepts_the_result(text):
    isolated = rewrite.isolate(text)
    native.glsl_tree(Stage.FRAGMENT, isolated)
    native.glsl_tree(Stage.FRAGMENT, at_400(precise.make_precise(isolated)))


def test_the_driver_accepts_the_result(text):
    isolated = rewrite.isolate(text)
    native.open_context()
    native.Program(native.evaluate_vertex(), isolated + MAIN)
    native.Program(native.evaluate_vertex(), at_400(precise.make_precise(isolated) + MAIN))


# ---- isolate ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("in vec3 n;", "vec3 n;"),
        ("out vec4 c;", "vec4 c;"),
        ("layout(location = 0) out vec4 c;", "vec4 c;"),
        ("layout(location = 0) in highp vec3 n;", "vec3 n;"),
        ("flat in int id;", "int id;"),
        ("smooth in vec3 n; noperspective in vec2 uv;", "vec3 n; vec2 uv;"),
        ("centroid in vec3 n, m;", "vec3 n, m;"),
        ("invariant out vec4 c;", "vec4 c;"),
        ("precise out vec4 c;", "vec4 c;"),
        ("out vec4 c[2];", "vec4 c[2];"),
        ("in vec4 gl_FragCoord;", ""),
        ("layout(origin_upper_left) in vec4 gl_FragCoord;", ""),
        ("invariant gl_Position;", ""),
        ("out vec4 c; invariant c;", "vec4 c;"),
        ("layout(early_fragment_tests) in;", ""),
        ("void main() { c = vec4(1.0); }", ""),
        ("void main(void) { { } }", ""),
        ("highp float f() { return 1.0; }", None),
        ("float f(in float x, out float y) { y = x; return x; }", None),
        ("uniform vec3 u;", None),
        ("uniform Block { vec3 u; float a, b[2]; };", "uniform vec3 u; uniform float a, b[2];"),
        ("layout(std140) uniform Block { vec3 u; } block;", "struct Block { vec3 u; }; uniform Block block;"),
        ("uniform Block { vec3 u; } block[2];", "struct Block { vec3 u; }; uniform Block block[2];"),
        ("layout(std140, row_major) uniform Block { layout(offset = 16) mat3 m; };", "uniform mat3 m;"),
        ("layout(std140) uniform;", None),
        ("layout(location = 1) uniform vec3 u;", None),
        ("in Block { vec3 n; } block;", None),
        ("const vec3 K = vec3(1.0);", None),
        ("struct S { float x; }; S s;", None),
        ("precise float g;", None),
        ("precision highp float;", None),
        ("float f() { return 1.0; };", None),
        ("void mainly() { }", None),
        ("void f() { int main = 1; }", None),
        ("", None),
    ],
)
def test_isolate_makes_plain_globals_of_inputs_and_outputs(text, expected):
    assert words(rewrite.isolate(text)) == words(text if expected is None else expected)


@pytest.mark.parametrize(
    "end",
    [
        *("", "float", "layout(", "in", "void main(", "void main() {", "}", ")", "[", "#", "struct"),
        "uniform B",
        "uniform B {",
    ],
)
def test_a_text_cut_short_is_no_accident(end):
    """What a compiler refuses later must get there: nothing is raised here."""
    text = "#version 330\nfloat f() { return 1.0; }\n" + end
    assert rewrite.isolate(text).startswith("#version 330\nfloat f() { return 1.0; }\n")
    rewrite.struct_names(text)
    rewrite.result_names(text)


# ---- Names -----------------------------------------------------------------------------------------------------------


def test_structures_are_found_in_their_order():
    text = """struct A { float x; };
    uniform struct B { A a; } b;
    struct { float y; } nameless;
    const struct C { float x; } c = C(1.0);
    void f() { struct Inner { float x; } i; }
    struct D { float x; } d[2];"""
    assert rewrite.struct_names(text) == ["A", "B", "C", "D"]


def test_the_types_that_functions_return():
    text = """float a(); float a() { return 1.0; }
    highp vec3 b(vec2 x) { return vec3(x, 1.0); }
    S[2] c() { S s; return S[2](s, s); }
    float g = a();
    void d(out float x) { x = 1.0; }"""
    assert rewrite.result_names(text) == ["float", "vec3", "S", "void"]


# ---- make_precise ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "declaration",
    [
        "uniform vec3 u;",
        "const float K = 1.0;",
        "precision highp float;",
        "layout(std140) uniform Block { vec3 u; };",
        "struct S { float x; };",
        "uniform struct S { float x; } s;",
        "uniform sampler2D map;",
        "in vec3 n;",
    ],
)
def test_what_computes_nothing_is_not_declared_precise(declaration):
    assert "precise" not in precise.make_precise(declaration)


@pytest.mark.parametrize(
    ("declaration", "expected"),
    [
        ("float g;", "precise float g;"),
        ("float g = 1.0, h;", "precise float g = 1.0, h;"),
        ("highp vec3 g;", "precise highp vec3 g;"),
        ("vec3[2] g;", "precise vec3[2] g;"),
        ("mat3x2 g[2];", "precise mat3x2 g[2];"),
        ("precise float g;", "precise float g;"),
        ("struct S { float x; }; S g;", "struct S { float x; }; precise S g;"),
        ("struct S { float x; } g;", "precise struct S { float x; } g;"),
        ("float f(float x);", "float f(precise float x);"),
        ("float f(const in float x, out vec2 y);", "float f(precise const in float x, precise out vec2 y);"),
    ],
)
def test_what_holds_numbers_is_declared_precise(declaration, expected):
    assert words(expected) == words(precise.make_precise(declaration))[3 + 1 :]  # after: uniform float hn_zero ;


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("float f() { float x; return x; }", False),
        ("const float x = 1.0; uniform vec2 y; uniform float z = 1.0; precision highp float;", False),
        ("struct S { float x; }; uniform struct T { float y; } t;", False),
        ("float f(float x); vec2 g(in vec2, S s);", False),
        ("layout(std140) uniform B { float x; } b;", False),
        ("#define x float y;", False),
        ("float x;", True),
        ("float f(); float x = 1.0;", True),
        ("struct S { float x; } s;", True),
        ("struct S { float x; }; S s[2];", True),
        ("vec2 x = vec2(1.0);", True),
        ("shared float x;", True),
    ],
)
def test_variables_that_can_change_are_found(text, found):
    assert rewrite.has_variables(f"#version 330\n{text}\n") is found


@pytest.mark.parametrize(
    ("text", "without", "names"),
    [
        ("uniform float x = 1.0;", "uniform float x ;", ["x"]),
        ("uniform float x, y = 1.0, z;", "uniform float x, y , z;", ["y"]),
        ("uniform vec2 x = vec2(1.0, 2.0), y = x;", "uniform vec2 x , y ;", ["x", "y"]),
        ("uniform float x[2] = float[2](1.0, 2.0);", "uniform float x[2] ;", ["x"]),
        ("uniform float[2] x = float[](1.0, 2.0);", "uniform float[2] x ;", ["x"]),
        ("uniform float x\n = 1.0\n;", "uniform float x\n\n;", ["x"]),
        ("uniform struct S { float a; } s = S(1.0);", "uniform struct S { float a; } s ;", ["s"]),
        ("uniform B { float x; }; float y = 1.0;", "uniform B { float x; }; float y = 1.0;", []),
        ("float f() { float x = 1.0; return x; }", "float f() { float x = 1.0; return x; }", []),
    ],
)
def test_initialisers_of_uniforms_are_taken_out(text, without, names):
    got, found = rewrite.uniform_initialisers(text)
    assert words(got) == words(without)
    assert found == names
    assert got.count("\n") == text.count("\n")
