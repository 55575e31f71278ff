"""The test fragment around a function: which numbers it moves, in which order, and what it cannot do."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, GlslError, HarnessError, native, shader
from harness.evaluation import leaves
from harness.signature import Array, Numeric, Struct

FLOAT, VEC3 = Numeric("float"), Numeric("float", 3)


# ---- Leaves ----------------------------------------------------------------------------------------------------------


def test_the_leaves_of_a_type_are_its_numbers_from_first_to_last():
    light = Struct((("direction", VEC3), ("on", Numeric("bool"))), "Light")
    scene = Struct((("lights", Array(light, 2)), ("m", Numeric("float", 3, 2)), ("w", Array(FLOAT, 2))), "Scene")
    assert [(leaf.path, str(leaf.type)) for leaf in leaves(scene)] == [
        (".lights[0].direction", "vec3"),
        (".lights[0].on", "bool"),
        (".lights[1].direction", "vec3"),
        (".lights[1].on", "bool"),
        (".m", "mat2x3"),
        (".w[0]", "float"),
        (".w[1]", "float"),
    ]


@pytest.mark.parametrize(
    ("rows", "columns", "components", "texels"),
    [(1, 1, 1, 1), (2, 1, 2, 1), (3, 1, 3, 1), (4, 1, 4, 1), (2, 2, 4, 1), (3, 3, 3, 3), (3, 2, 3, 2), (4, 4, 4, 4)],
)
def test_a_leaf_fills_its_texels_evenly(rows, columns, components, texels):
    (leaf,) = leaves(Numeric("float", rows, columns))
    assert (leaf.components, leaf.texels) == (components, texels)
    assert leaf.components * leaf.texels == leaf.size == rows * columns


# ---- Names -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    ["i", "result", "first", "width", "e", "t0", "value", "color", "in_x", "arg0", "out_0", "_x", "main_", "zero"],
)
def test_a_parameter_may_have_any_name(functions, mode, name):
    """Also one that the test fragment might use itself."""
    made = functions(f"float f(int {name}, out float y) {{ y = 2.0; return float({name}); }}", mode=mode)
    np.testing.assert_array_equal(made.f(**{name: [3, 4]}).result, [3, 4])


@pytest.mark.parametrize("name", ["i", "e", "t0", "first", "width", "result", "x", "f0", "numbers"])
def test_a_global_or_a_function_may_have_any_name(functions, mode, name):
    text = f"float {name} = 2.0; float f(vec4 a, mat3 m, int k) {{ return {name} + a.w + m[2][2] + float(k); }}"
    assert functions(text, mode=mode).f([1, 2, 3, 4], np.eye(3), 5) == 12
    text = f"float {name}(float x) {{ return x; }} float f(vec4 a) {{ return {name}(a.w); }}"
    assert functions(text, mode=mode).f([1, 2, 3, 4]) == 4


@pytest.mark.parametrize("name", ["min", "max", "clamp", "mix"])
def test_a_function_of_the_users_may_hide_one_of_glsl(functions, name):
    """In GLSL it hides all overloads of that name, of which the test fragment must use none."""
    made = functions(
        f"float {name}(float x, float y) {{ return x - y; }} float f(float x) {{ return {name}(x, 1.0); }}"
    )
    np.testing.assert_array_equal(made.f([1, 2, 3]), [0, 1, 2])


def test_an_out_parameter_may_be_called_result(functions):
    got = functions("float f(out float result) { result = 2.0; return 1.0; }").f()
    assert tuple(got) == (1, 2)


# ---- How much at once ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("limit", [1, 2, 3, 7, 16, 99, 100, 101])
def test_what_the_driver_cannot_take_at_once_is_done_in_turns(functions, monkeypatch, limit):
    """A matrix takes 4 texels, the scalar is given once: as in one go, whatever the most texels are."""
    made = functions("float f(mat4 m, vec2 v, float s) { return m[1][2] + v.y * 1000.0 + s; }")
    m = np.arange(100 * 16, dtype=np.float32).reshape(100, 4, 4)
    v = np.arange(200, dtype=np.float32).reshape(100, 2)
    want = m[:, 2, 1] + v[:, 1] * 1000 + 1
    np.testing.assert_array_equal(made.f(m, v, 1), want)
    monkeypatch.setattr(native, "evaluate_limit", lambda: 4 * limit)
    np.testing.assert_array_equal(made.f(m, v, 1), want)


def test_eight_vectors_come_back_at_once(functions):
    got = functions("vec4[8] f(float x) { vec4 v = vec4(x); return vec4[8](v, v, v, v, v, v, v, v + 1.0); }").f([1, 2])
    assert got.shape == (2, 8, 4)
    np.testing.assert_array_equal(got[:, 7], [[2] * 4, [3] * 4])


@pytest.mark.parametrize(
    "text",
    [
        "float[9] f() { float[9] x; return x; }",
        "void f(out mat4 a, out mat4 b, out float c) { a = b = mat4(0.0); c = 1.0; }",
    ],
)
def test_more_than_eight_vectors_are_refused(functions, text):
    with pytest.raises(CallError, match=r"test\.glsl:1: .* yields more than 8 vectors at once"):
        functions(text).f()


def test_more_inputs_than_the_driver_has_units_are_refused(functions):
    parameters = ", ".join(f"float a{n}" for n in range(200))
    with pytest.raises(HarnessError, match="inputs"):
        functions(f"float f({parameters}) {{ return {' + '.join(f'a{n}' for n in range(200))}; }}").f(*range(200))


def test_a_parameter_that_is_not_read_does_not_matter(functions, mode):
    made = functions("float f(float a, vec3 unread, float b) { return a - b; }", mode=mode)
    np.testing.assert_array_equal(made.f([5, 6], np.ones((2, 3)), 1), [4, 5])


def test_a_function_without_parameters_is_one_value(functions, mode):
    got = functions("vec3 f() { return vec3(1, 2, 3); }", mode=mode).f()
    np.testing.assert_array_equal(got, [1, 2, 3])


# ---- Versions --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", ["330", "330 core", "400", "410", "420", "430", "450", "450 core"])
def test_every_version_from_330_on_will_do(functions, mode, version):
    assert functions(f"#version {version}\nfloat f(float x) {{ return x + 1.0; }}", mode=mode).f(1) == 2


@pytest.mark.parametrize("version", ["120", "130", "150", "300 es", "310 es"])
def test_a_version_that_lacks_what_calls_need_is_refused(functions, version):
    precision = "precision highp float;\n" if "es" in version else ""
    made = functions(f"#version {version}\n{precision}float f(float x) {{ return x; }}")
    with pytest.raises(GlslError) as caught:
        made.f(1)
    assert caught.value.line == 1
    assert f"#version {version}: functions can be called from 330 on" in caught.value.message


@pytest.mark.parametrize("text", ["double f(double x) { return x; }", "dvec2 f(float x) { return dvec2(x); }"])
def test_doubles_are_refused(functions, text):
    with pytest.raises(CallError, match=r"test\.glsl:2: .*double|test\.glsl:2: .*dvec2"):
        functions(f"#version 430\n{text}").f(1)


# ---- The two stages --------------------------------------------------------------------------------------------------


@pytest.fixture
def without_compute(monkeypatch):
    """Evaluates by the fragment stage, as in a context before GL 4.3."""

    def use():
        monkeypatch.setattr(native, "compute_available", lambda: False)

    native.open_context()
    return use


@pytest.mark.parametrize("count", [1, 255, 256, 257, 100_003])
def test_the_fragment_stage_gives_the_same_bits(root, mode, without_compute, count):
    random = np.random.default_rng(count)
    vectors = random.standard_normal((3, count, 3))
    l, v, n = (vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)).astype(np.float32)  # noqa: E741
    material = {"albedo": random.random((count, 3)), "metalness": 0.5, "roughness": random.random(count)}
    by_compute = shader(root / "shaders" / "brdf.glsl", mode=mode).shade(l, v, n, material)
    without_compute()
    by_fragment = shader(root / "shaders" / "brdf.glsl", mode=mode).shade(l, v, n, material)
    np.testing.assert_array_equal(by_compute, by_fragment)


@pytest.mark.parametrize("kind", ["float", "vec3", "mat3", "ivec2", "bool", "uvec4"])
def test_the_fragment_stage_takes_and_gives_every_type(functions, without_compute, kind):
    without_compute()
    same = functions(f"{kind} same({kind} x) {{ return x; }}").same
    shape = {"float": (7,), "vec3": (7, 3), "mat3": (7, 3, 3), "ivec2": (7, 2), "bool": (7,), "uvec4": (7, 4)}[kind]
    values = np.arange(np.prod(shape)).reshape(shape) % (2 if kind == "bool" else 1000)
    values = values.astype(bool) if kind == "bool" else values
    np.testing.assert_array_equal(same(values), values)


@pytest.mark.parametrize("use", ["gl_FragCoord.x", "dFdx(x)"])
def test_what_only_a_fragment_has_is_evaluated_there(functions, use):
    """A compute stage does not compile with it."""
    got = functions(f"float f(float x) {{ return x + 0.0 * {use}; }}").f([1, 2, 3])
    np.testing.assert_array_equal(got, [1, 2, 3])


def test_a_compute_stage_is_used_where_there_is_one(functions, monkeypatch):
    native.open_context()
    if not native.compute_available():
        pytest.skip("this context has no compute stage")
    used = []
    compute = native.Program.compute
    monkeypatch.setattr(native.Program, "compute", lambda text: used.append(text) or compute(text))
    functions("float f(float x) { return x; }").f(1)
    assert len(used) == 1
