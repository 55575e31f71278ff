"""The test fragment around a function: which numbers it moves, in which order, and what it cannot do."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, GlslError, native, shader
from harness.calling import stages

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


@pytest.mark.parametrize("count", [1, 2, 8, 9, 20])
def test_any_number_of_vectors_comes_back(functions, mode, count):
    """A fragment stage has 8 outputs, a compute stage 8 blocks."""
    made = functions(
        f"vec4[{count}] f(float x) {{ vec4 v[{count}]; for (int k = 0; k < {count}; ++k) v[k] = x * vec4(k, 1, 2, 3);"
        " return v; }",
        mode=mode,
    )
    x = np.float32([1, 2, 5])
    want = x[:, None, None] * [[[k, 1, 2, 3] for k in range(count)]]
    np.testing.assert_array_equal(made.f(x), want)


def test_many_outputs_of_all_kinds(functions):
    text = "void f(float x, out mat4 a, out mat3x2 b, out int c, out bool d[3], out uvec2 e) {" + (
        " a = mat4(x); b = mat3x2(x); c = int(x) - 3; d = bool[3](x > 1.0, false, true); e = uvec2(x, 4000000000u); }"
    )
    got = functions(text).f([1, 2])
    np.testing.assert_array_equal(got.a, [np.eye(4), 2 * np.eye(4)])
    np.testing.assert_array_equal(got.b, [np.eye(2, 3), 2 * np.eye(2, 3)])
    np.testing.assert_array_equal(got.c, np.int32([-2, -1]))
    np.testing.assert_array_equal(got.d, [[False, False, True], [True, False, True]])
    np.testing.assert_array_equal(got.e, np.uint32([[1, 4000000000], [2, 4000000000]]))
    assert (got.c.dtype, got.d.dtype, got.e.dtype) == (np.int32, np.bool_, np.uint32)


@pytest.mark.parametrize("count", [16, 17, 40, 200])
def test_any_number_of_inputs_goes_in(functions, mode, count):
    """A stage has 16 texture units at least; those of one element are then packed together."""
    parameters = ", ".join(f"float a{n}" for n in range(count))
    made = functions(
        f"vec2 f({parameters}) {{ return vec2({' - '.join(f'a{n}' for n in range(count))}, a3); }}", mode=mode
    )
    arguments = [np.float32([n, 2 * n]) if n % 3 else np.float32(n) for n in range(count)]
    want = arguments[0] - sum(arguments[1:])
    np.testing.assert_array_equal(made.f(*arguments), np.stack([want, [3, 3]], axis=1))


def test_packed_inputs_keep_their_types_and_bits(functions):
    """Denormals and the payload of a NaN go through as they are; arrays of a struct and matrices have their order."""
    text = """struct S { mat3x2 m; int i; uint u; bool b; vec3 v; };
    S same(S s[4]) { return s[2]; }"""
    values = [
        {"m": np.arange(6).reshape(2, 3) + k, "i": -k, "u": 2**32 - 1 - k, "b": k == 2, "v": [k, 1e-40, -0.0]}
        for k in range(4)
    ]
    got = functions(text).same(values)
    np.testing.assert_array_equal(got.m, [[2, 3, 4], [5, 6, 7]])
    assert (got.i, got.u, got.b) == (-2, 2**32 - 3, True)
    np.testing.assert_array_equal(got.v.view(np.uint32), np.float32([2, 1e-40, -0.0]).view(np.uint32))
    text = "float same(" + ", ".join(f"float a{n}" for n in range(20)) + ") { return a19; }"
    nan = np.uint32([0x7FC12345]).view(np.float32)
    assert functions(text).same(*range(19), nan).view(np.uint32) == 0x7FC12345


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


@pytest.mark.parametrize("version", ["300 es", "310 es", "320 es"])
def test_versions_of_glsl_es_will_do(functions, mode, version):
    """Also one that states no precision, which a fragment stage of GLSL ES would have to."""
    made = functions(
        f"#version {version}\nstruct S {{ float x; }}; float f(S s, vec2 v) {{ return s.x + v.y; }}", mode=mode
    )
    assert made.f({"x": 2**-20}, [5, 1]) == 1 + 2**-20


@pytest.mark.parametrize("stated", ["precision highp float;", "precision highp float; precision highp int;"])
def test_glsl_es_states_its_own_precision(functions, mode, stated):
    made = functions(f"#version 310 es\n{stated}\nfloat f(float x) {{\nreturn x + 1.0; }}", mode=mode)
    assert made.f(2**-20) == 1 + 2**-20


def test_an_error_in_glsl_es_is_in_its_line(functions, mode):
    with pytest.raises(GlslError, match="undeclared") as caught:
        functions("#version 310 es\nfloat f(float x) {\nreturn y; }", mode=mode)
    assert caught.value.line == 3


@pytest.mark.parametrize("version", ["120", "130", "150"])
def test_a_version_that_lacks_what_calls_need_is_refused(functions, version):
    made = functions(f"#version {version}\nfloat f(float x) {{ return x; }}")
    with pytest.raises(GlslError) as caught:
        made.f(1)
    assert caught.value.line == 1
    assert f"#version {version}: functions can be called from 330 on, or 300 es" in caught.value.message


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


@pytest.mark.parametrize("count", [1, 255, 256, 257, stages.COUNT_OF_WIDE - 1, 100_003])
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


# ---- Several elements in one invocation ------------------------------------------------------------------------------


@pytest.fixture
def programs(monkeypatch):
    """The texts of the compute programs that are made."""
    native.open_context()
    if not native.compute_available():
        pytest.skip("this context has no compute stage")
    made = []
    compute = native.Program.compute
    monkeypatch.setattr(native.Program, "compute", lambda text: made.append(text) or compute(text))
    return made


MANY = stages.COUNT_OF_WIDE


@pytest.mark.parametrize("count", [MANY, MANY + 1, MANY + 2, MANY + 3])
def test_many_elements_are_evaluated_in_groups_and_a_rest(functions, mode, programs, count):
    """Every type, single values too; and what lies behind the results is not touched."""
    text = """
    void f(float a, vec2 b, vec3 c, mat2 m, ivec3 i, bool k, float s, vec3 t,
           out vec3 x, out float y, out ivec2 z, out bool w) {
        x = c * s + t; y = a + b.y + m[1][0] + m[0][1] * 10.0; z = i.zx; w = !k; }"""
    random = np.random.default_rng(count)
    a, b, c = (random.integers(0, 100, shape).astype(np.float32) for shape in (count, (count, 2), (count, 3)))
    m, i = random.integers(0, 100, (count, 2, 2)).astype(np.float32), random.integers(-9, 9, (count, 3), np.int32)
    k = random.integers(0, 2, count).astype(bool)
    got = functions(text, mode=mode).f(a, b, c, m, i, k, 2.0, [1, 2, 3])
    assert len(programs) == 2
    np.testing.assert_array_equal(got.x, c * 2 + [1, 2, 3])
    np.testing.assert_array_equal(got.y, a + b[:, 1] + m[:, 0, 1] + m[:, 1, 0] * 10)
    np.testing.assert_array_equal(got.z, i[:, [2, 0]])
    np.testing.assert_array_equal(got.w, ~k)


def test_a_uniform_reaches_every_program(functions, programs):
    made = functions("uniform float u; uniform vec2 w[2]; float f(float x) { return x * u + w[1].y; }")
    for u in (2, 3):
        assert made.f(1, u=u, w=[[0, 0], [0, 10]]) == u + 10
        assert (made.f(np.ones(MANY + 1), u=u, w=[[0, 0], [0, 10]]) == u + 10).all()
    assert len(programs) == 2


@pytest.mark.parametrize(
    "text",
    [
        "float g = 0.0; float f(float x) { g += x; return g; }",
        "float a = 1.0, g[2] = float[2](0.0, 1.0); float f(float x) { g[1] += x; return g[1]; }",
        "struct S { float x; } s = S(0.0); float f(float x) { s.x += x; return s.x; }",
        "struct S { float x; }; S s = S(0.0); float f(float x) { s.x += x; return s.x; }",
    ],
)
def test_no_element_finds_what_another_left_in_a_global(functions, text):
    """It starts anew for each."""
    got = functions(f"#version 430\n{text}").f(np.ones(MANY))
    np.testing.assert_array_equal(got, got[0])


@pytest.mark.parametrize("limit", [4, 20, MANY, MANY + 4])
def test_groups_in_turns(functions, monkeypatch, limit):
    made = functions("vec3 f(vec3 v, float s) { return v * s; }")
    v = np.random.default_rng(1).random((2 * MANY + 7, 3)).astype(np.float32)[: 3 * limit if limit < MANY else None]
    want = made.f(v, 3)
    np.testing.assert_array_equal(want, v * np.float32(3))
    monkeypatch.setattr(native, "compute_limit", lambda components: limit)
    np.testing.assert_array_equal(made.f(v, 3), want)


# ---- Uniforms with an initialiser ------------------------------------------------------------------------------------


@pytest.mark.parametrize("every_mode", ["as-written", "precise", "mediump", "double"])
@pytest.mark.parametrize(
    ("declared", "read", "initial", "other"),
    [
        ("float u = 0.5;", "u", 0.5, 3),
        ("float a = 9.0, u = 1.0 + 0.5, b;", "u", 1.5, 3),
        ("vec2 u = vec2(1.0, 2.0);", "u.y", 2, [3, 4]),
        ("mat2x3 u = mat2x3(1, 2, 3, 4, 5, 6);", "u[1].z", 6, [[1, 2], [3, 4], [5, 60]]),
        ("int u = -7;", "float(u)", -7, 3),
        ("uint u = 4000000000u;", "float(u >> 24)", 4000000000 >> 24, 3),
        ("bool u = true;", "(u ? 1.0 : 2.0)", 1, False),
        ("struct S { float a; vec2 b; } s = S(1.0, vec2(2.0, 4.0)); uniform float u = 3.0;", "(s.b.y + u)", 7, 4),
        ("float u[3] = float[](1.0, 2.0, 4.0);", "(u[0] + u[1] * u[2])", 9, [1, 1, 1]),
        ("ivec2 u[2] = ivec2[2](ivec2(1, 2), ivec2(3, 4));", "float(u[0].y + u[1].x)", 5, [[5, 6], [7, 8]]),
    ],
)
def test_a_uniform_with_an_initialiser_need_not_be_given(functions, every_mode, declared, read, initial, other):
    """It has its initial value again in every call that does not give it."""
    made = functions(
        f"uniform {declared}\nuniform float gain;\nfloat f(float x) {{ return x + {read} * gain; }}", mode=every_mode
    )
    assert made.f(1, gain=1) == 1 + initial
    assert made.f(1, gain=1, u=other) != 1 + initial
    assert made.f(1, gain=1) == 1 + initial
    np.testing.assert_array_equal(made.f(np.ones(40_000), gain=1), 1 + initial)


def test_one_without_has_to_be_given_still(functions):
    with pytest.raises(CallError, match="reads the uniform float v"):
        functions("uniform float u = 1.0, v;\nfloat f(float x) { return x + u + v; }").f(1)


# ---- Nothing folds ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("every_mode", ["as-written", "precise", "mediump", "double"])
def test_a_single_value_gives_the_bits_that_an_array_gives(root, functions, every_mode):
    """Every argument by turns is one for the whole batch, or stands there for each element."""
    x = np.random.default_rng(2).random((3, 12, 3)).astype(np.float32) + np.float32(0.1)
    text = """
    float distribution(float N, float a) { float d = 1.0 + N * N * (a * a - 1.0); return a * a / (3.14159265 * d * d); }
    float sums(float a, float b, float c) { return (a + b) - a + c * 0.0 + pow(a, b) * exp2(c); }
    vec3 turned(vec3 a, vec3 b, float c) { return normalize(cross(a, b)) * c + mix(a, b, c); }
    float many(float a, float b) { float s = a; for (int i = 0; i < 7; ++i) s = s * b + a * sin(s); return s; }
    """
    made = functions(text, mode=every_mode)
    for name, sizes in {"distribution": (0, 0), "sums": (0, 0, 0), "turned": (3, 3, 0), "many": (0, 0)}.items():
        for k in range(len(x[0])):
            values = [x[n, k, :size] if size else x[n, k, 0] for n, size in enumerate(sizes)]
            arrays = [np.stack([value] * 5) for value in values]
            want = made[name](*arrays)
            for single in range(1, 1 << len(sizes)):
                given = [v if single >> n & 1 else a for n, (v, a) in enumerate(zip(values, arrays, strict=True))]
                got = np.broadcast_to(made[name](*given), want.shape)
                assert got.tobytes() == want.tobytes(), (name, single, values)
