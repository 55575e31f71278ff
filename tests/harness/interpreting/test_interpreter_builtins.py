"""GLSL's operators and built-in functions, interpreted, against numpy and Python on the specification's formulas."""

from __future__ import annotations

import math
import struct

import numpy as np
import pytest

from harness import shader
from harness.interpreting.interpretation import Interpretation

RANDOM = np.random.default_rng(5)
X = RANDOM.uniform(-3, 3, 200).astype(np.float32)
Y = RANDOM.uniform(-3, 3, 200).astype(np.float32)
U = RANDOM.uniform(0.01, 1, 200).astype(np.float32)
V, W = RANDOM.standard_normal((2, 200, 3)).astype(np.float32)
I = RANDOM.integers(-(2**31), 2**31, 200)  # noqa: E741
J = RANDOM.integers(1, 1000, 200)
EDGES = np.array([0, 1, -1, 2**31 - 1, -(2**31), 12345, -777, 0x0F0F])
HEAD = "#version 450\n"


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


@pytest.fixture
def double(tmp_path):
    """Evaluates ``float f(arguments) { return expression; }`` in double."""

    def evaluate(signature: str, expression: str, *arguments, result: str = "float", before: str = ""):
        path = tmp_path / "test.glsl"
        path.write_text(f"{HEAD}{before}\n{result} f({signature}) {{ return {expression}; }}\n")
        return shader(path, mode="double").f(*arguments)

    return evaluate


D = np.float64
FORMULAS = {
    "x + y * x - x / y": lambda x, y: x + y * x - x / y,
    "mod(x, y)": lambda x, y: x - y * np.floor(x / y),
    "fract(x) + floor(y) + ceil(x) + trunc(y)": lambda x, y: x - np.floor(x) + np.floor(y) + np.ceil(x) + np.trunc(y),
    "abs(x) * sign(y)": lambda x, y: abs(x) * np.sign(y),
    "min(x, y) + 2.0 * max(x, y)": lambda x, y: np.minimum(x, y) + 2 * np.maximum(x, y),
    "clamp(x, -1.0, 0.5)": lambda x, y: np.clip(x, -1, 0.5),
    "mix(x, y, 0.25)": lambda x, y: 0.75 * x + 0.25 * y,
    "mix(x, y, x < y)": lambda x, y: np.where(x < y, y, x),
    "step(x, y)": lambda x, y: np.where(y < x, 0.0, 1.0),
    "smoothstep(-1.0, 2.0, x)": lambda x, y: (t := np.clip((x + 1) / 3, 0, 1)) ** 2 * (3 - 2 * t),
    "sin(x) + cos(y) + tan(0.1 * x)": lambda x, y: np.sin(x) + np.cos(y) + np.tan(0.1 * x),
    "asin(x / 4.0) + acos(y / 4.0) + atan(x)": lambda x, y: np.arcsin(x / 4) + np.arccos(y / 4) + np.arctan(x),
    "atan(x, y)": np.arctan2,
    "sinh(x) + cosh(y) + tanh(x)": lambda x, y: np.sinh(x) + np.cosh(y) + np.tanh(x),
    "asinh(x) + acosh(4.0 + y) + atanh(x / 4.0)": lambda x, y: np.arcsinh(x) + np.arccosh(4 + y) + np.arctanh(x / 4),
    "exp(x) + exp2(y)": lambda x, y: np.exp(x) + 2**y,
    "log(abs(x)) + log2(abs(y))": lambda x, y: np.log(abs(x)) + np.log2(abs(y)),
    "pow(abs(x), y)": lambda x, y: abs(x) ** y,
    "sqrt(abs(x)) + inversesqrt(abs(y))": lambda x, y: np.sqrt(abs(x)) + abs(y) ** -0.5,
    "radians(x) + degrees(y)": lambda x, y: x * np.pi / 180 + y * 180 / np.pi,
    "fma(x, y, 0.1)": lambda x, y: x * y + 0.1,
    "round(2.0 * x) + roundEven(y)": lambda x, y: np.round(2 * x) + np.round(y),
    "ldexp(x, 3) + float(int(y))": lambda x, y: 8 * x + np.trunc(y),
    "length(x) + distance(x, y)": lambda x, y: abs(x) + abs(x - y),
    "faceforward(x, y, x) + reflect(x, y)": lambda x, y: np.where(x * y < 0, x, -x) + x - 2 * y * x * y,
    "x > y ? x : (x == y ? 1.0 : y)": lambda x, y: np.where(x > y, x, y),
    "float(x < y) + 2.0 * float(x >= y) + 4.0 * float(x != y)": lambda x, y: (x < y) + 2.0 * (x >= y) + 4.0 * (x != y),
    "float(isnan(x / 0.0 * 0.0)) + float(isinf(y / 0.0))": lambda x, y: np.full_like(x, 2),
}


@pytest.mark.parametrize("expression", FORMULAS)
def test_a_function_of_floats_is_its_formula(double, expression):
    """In float64: terms are below 200, and rounded a few times by 1e-16 each."""
    want = FORMULAS[expression](X.astype(D), Y.astype(D))
    np.testing.assert_allclose(double("float x, float y", expression, X, Y), want, rtol=1e-13, atol=1e-13)


VECTOR_FORMULAS = {
    "dot(a, b)": lambda a, b: (a * b).sum(-1),
    "length(a) + distance(a, b)": lambda a, b: np.linalg.norm(a, axis=-1) + np.linalg.norm(a - b, axis=-1),
    "dot(cross(a, b), vec3(1, 2, 3))": lambda a, b: np.cross(a, b) @ [1, 2, 3],
    "dot(normalize(a), vec3(1, 2, 3))": lambda a, b: unit(a) @ [1, 2, 3],
    "dot(reflect(a, normalize(b)), vec3(1, 2, 3))": lambda a, b: (
        (a - 2 * (a * unit(b)).sum(-1, keepdims=True) * unit(b)) @ [1, 2, 3]
    ),
    "faceforward(a, b, a).y": lambda a, b: np.where((a * b).sum(-1) < 0, a[:, 1], -a[:, 1]),
    "a.zyx[1] + a.xxy.z * b.zx.y": lambda a, b: a[:, 1] + a[:, 1] * b[:, 0],
    "(outerProduct(a, b) * a).y": lambda a, b: (np.einsum("ni,nj->nij", a, b) @ a[..., None])[:, 1, 0],
    "(a * outerProduct(a, b)).z": lambda a, b: (a[:, None, :] @ np.einsum("ni,nj->nij", a, b))[:, 0, 2],
    "float(any(lessThan(a, b))) + 2.0 * float(all(greaterThan(a, b)))": lambda a, b: (
        (a < b).any(-1) + 2.0 * (a > b).all(-1)
    ),
    "float(a == b) + 2.0 * float(a == a)": lambda a, b: np.full(len(a), 2.0),
}


@pytest.mark.parametrize("expression", VECTOR_FORMULAS)
def test_a_function_of_vectors_is_its_formula(double, expression):
    want = VECTOR_FORMULAS[expression](V.astype(D), W.astype(D))
    np.testing.assert_allclose(double("vec3 a, vec3 b", expression, V, W), want, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("eta", [0.7, 1.5])
def test_refract_obeys_snell_and_is_zero_beyond_the_critical_angle(double, eta):
    incident, normal = unit(V.astype(D)), np.array([0.0, 0, 1])
    incident[:, 2] = -abs(incident[:, 2])
    given = incident.astype(np.float32)
    got = double("vec3 i, vec3 n, float eta", "refract(i, n, eta)", given, normal, eta, result="vec3")
    sine = eta * np.linalg.norm(given[:, :2].astype(D), axis=-1)
    total = sine > 1
    assert (eta > 1) == total.any()
    assert not got[total].any()
    # eta was rounded to float32, and the incident vectors are unit to float32
    np.testing.assert_allclose(np.linalg.norm(got[~total][:, :2], axis=-1), sine[~total], rtol=2e-7)
    np.testing.assert_allclose(np.linalg.norm(got[~total], axis=-1), 1, rtol=1e-6)


@pytest.mark.parametrize("size", [2, 3, 4])
def test_determinant_and_inverse_are_linear_algebras(double, size):
    matrices = RANDOM.standard_normal((50, size, size)).astype(np.float32)
    kind = f"mat{size}"
    determinant = double(f"{kind} m", "determinant(m)", matrices)
    np.testing.assert_allclose(determinant, np.linalg.det(matrices.astype(D)), rtol=1e-9)
    product = double(f"{kind} m", "inverse(m) * m", matrices, result=kind)
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(size), product.shape), atol=1e-9)


def test_products_of_matrices_that_are_not_square(double):
    a, b = RANDOM.standard_normal((20, 3, 2)).astype(np.float32), RANDOM.standard_normal((20, 2, 4)).astype(np.float32)
    got = double("mat2x3 a, mat4x2 b", "a * b", a, b, result="mat4x3")
    np.testing.assert_allclose(got, a.astype(D) @ b.astype(D), rtol=1e-13, atol=1e-14)
    turned = double("mat2x3 a", "transpose(a)", a, result="mat3x2")
    np.testing.assert_array_equal(turned, a.swapaxes(-1, -2))


def wrapped(x):
    return (np.asarray(x, object) + 2**31) % 2**32 - 2**31


INTEGER = {
    "i + j * i - j": lambda i, j: wrapped(i + j * i - j),
    "i / j": lambda i, j: int(math.copysign(abs(i) // j, i)) if i else 0,
    "(i & j) | (i ^ 77) | ~j": lambda i, j: (i & j) | (i ^ 77) | ~j,
    "(i << 3) + (i >> 5)": lambda i, j: wrapped(wrapped(i << 3) + (i >> 5)),
    "abs(j - 500) + sign(i) + min(i, j) / 2": lambda i, j: wrapped(
        abs(j - 500) + (i > 0) - (i < 0) + int(math.copysign(abs(min(i, j)) // 2, min(i, j)))
    ),
    "clamp(i, -j, j)": lambda i, j: max(-j, min(i, j)),
    "bitCount(i) * 1000 + findLSB(j)": lambda i, j: (
        (i & 0xFFFFFFFF).bit_count() * 1000 + ((j & -j).bit_length() - 1 if j else -1)
    ),
    "findMSB(i)": lambda i, j: (i if i >= 0 else ~i).bit_length() - 1,
    "bitfieldReverse(i)": lambda i, j: wrapped(int(f"{i & 0xFFFFFFFF:032b}"[::-1], 2)),
    "bitfieldExtract(i, 5, 9)": lambda i, j: ((i >> 5 & 511) ^ 256) - 256,
    "bitfieldInsert(i, j, 4, 6)": lambda i, j: wrapped(i & ~(63 << 4) | (j & 63) << 4),
    "int(uint(i) / uint(j)) + int(uint(i) % 7u)": lambda i, j: wrapped((i % 2**32) // j + i % 2**32 % 7),
    "int(uint(i) >> 3u)": lambda i, j: (i % 2**32) >> 3,
    "int(uint(i) < uint(j)) + 2 * int(i < j)": lambda i, j: (i % 2**32 < j) + 2 * (i < j),
    "int(bitfieldExtract(uint(i), 28, 4))": lambda i, j: i % 2**32 >> 28,
}


@pytest.mark.parametrize("expression", INTEGER)
def test_integers_are_pythons_modulo_2_to_the_32(double, expression):
    i, j = np.concatenate([I, EDGES]), np.concatenate([J, np.arange(1, len(EDGES) + 1)])
    want = [int(INTEGER[expression](a, b)) for a, b in zip(i.tolist(), j.tolist(), strict=True)]
    assert double("int i, int j", expression, i, j, result="int").tolist() == want


def test_the_words_of_a_long_product(double):
    before = "ivec2 signed_(int a, int b) { int h, l; imulExtended(a, b, h, l); return ivec2(h, l); }"
    before += "uvec2 unsigned_(uint a, uint b) { uint h, l; umulExtended(a, b, h, l); return uvec2(h, l); }"
    got = double("int a, int b", "signed_(a, b)", I, I[::-1].copy(), result="ivec2", before=before)
    want = [divmod(a * b, 2**32) for a, b in zip(I.tolist(), I[::-1].tolist(), strict=True)]
    assert got.tolist() == [[h, int(wrapped(low))] for h, low in want]
    unsigned = I % 2**32
    got = double("uint a, uint b", "unsigned_(a, b)", unsigned, unsigned[::-1].copy(), result="uvec2", before=before)
    assert got.tolist() == [
        list(divmod(a * b, 2**32)) for a, b in zip(unsigned.tolist(), unsigned[::-1].tolist(), strict=True)
    ]


def test_carry_and_borrow(double):
    before = "uvec4 both(uint a, uint b) { uint c, d; uint s = uaddCarry(a, b, c); uint t = usubBorrow(a, b, d);"
    before += " return uvec4(s, c, t, d); }"
    a, b = I % 2**32, I[::-1] % 2**32
    got = double("uint a, uint b", "both(a, b)", a, b, result="uvec4", before=before)
    want = [[(p + q) % 2**32, (p + q) >> 32, (p - q) % 2**32, int(p < q)] for p, q in zip(a.tolist(), b.tolist())]  # noqa: B905
    assert got.tolist() == want


@pytest.mark.parametrize(
    ("x", "signed", "unsigned"),
    [
        (np.nan, 0, 0),
        (np.inf, 2**31 - 1, 2**32 - 1),
        (-np.inf, -(2**31), 0),
        (3e9, 2**31 - 1, 3000000000),
        (-1.75, -1, 0),
        (2.75, 2, 2),
    ],
)
def test_a_float_beyond_an_integer_type_is_its_nearest_value(double, x, signed, unsigned):
    assert double("float x", "int(x)", x, result="int") == signed
    assert double("float x", "uint(x)", x, result="uint") == unsigned


def test_frexp_and_modf_take_a_float_apart(double):
    before = "vec2 apart(float x) { int e; float m = frexp(x, e); return vec2(m, float(e)); }"
    before += "vec2 split(float x) { float whole; float part = modf(x, whole); return vec2(part, whole); }"
    x = np.concatenate([X, [0, -0.0, 8, np.inf]]).astype(np.float32)
    got = double("float x", "apart(x)", x[:-1], result="vec2", before=before)
    np.testing.assert_array_equal(got, [math.frexp(float(a)) for a in x[:-1]])
    got = double("float x", "split(x)", x, result="vec2", before=before)
    np.testing.assert_array_equal(got, [math.modf(float(a)) for a in x])


PACKED = {
    "packUnorm4x8(v)": lambda v: struct.pack("4B", *(round(min(max(c, 0), 1) * 255) for c in v)),
    "packSnorm4x8(v)": lambda v: struct.pack("4b", *(round(min(max(c, -1), 1) * 127) for c in v)),
    "packUnorm2x16(v.xy)": lambda v: struct.pack("2H", *(round(min(max(c, 0), 1) * 65535) for c in v[:2])),
    "packSnorm2x16(v.xy)": lambda v: struct.pack("2h", *(round(min(max(c, -1), 1) * 32767) for c in v[:2])),
    "packHalf2x16(v.xy)": lambda v: struct.pack("2e", *v[:2]),
}


@pytest.mark.parametrize("expression", PACKED)
def test_packing_is_pythons(double, expression):
    vectors = RANDOM.uniform(-1.2, 1.2, (100, 4)).astype(np.float32)
    want = [int.from_bytes(PACKED[expression](list(map(float, v))), "little") for v in vectors]
    assert double("vec4 v", expression, vectors, result="uint").tolist() == want


UNPACKED = {
    "unpackUnorm4x8(w)": ("4B", 255),
    "unpackSnorm4x8(w)": ("4b", 127),
    "vec4(unpackUnorm2x16(w), 0, 0)": ("2H", 65535),
    "vec4(unpackSnorm2x16(w), 0, 0)": ("2h", 32767),
    "vec4(unpackHalf2x16(w), 0, 0)": ("2e", 1),
}


@pytest.mark.parametrize("expression", UNPACKED)
def test_unpacking_is_pythons(double, expression):
    words = [0, 0x80808080, 0x7FFF8001, 0x3C00C000, 0x12345678]
    form, scale = UNPACKED[expression]
    values = [[c / scale for c in struct.unpack(form, word.to_bytes(4, "little"))] for word in words]
    want = [[max(c, -1) if scale > 1 else c for c in v] + [0] * (4 - len(v)) for v in values]
    np.testing.assert_allclose(double("uint w", expression, words, result="vec4"), want, rtol=1e-15)


@pytest.mark.parametrize(
    ("expression", "want"),
    [
        ("max(x, 0.5)", 0.5),
        ("max(0.5, x)", 0.5),
        ("min(x, 0.5)", 0.5),
        ("clamp(x, 0.25, 1.0)", 0.25),
        ("step(0.5, x)", 1),
        ("float(x < 1.0) + float(x == x)", 0),
        ("float(x != x)", 1),
    ],
)
def test_what_becomes_of_nan_where_it_is_lost(double, expression, want):
    assert double("float x", expression, np.nan) == want


@pytest.mark.parametrize(
    "expression", ["sign(x)", "fract(x)", "mix(0.0, 1.0, x)", "sqrt(-1.0 - abs(0.0 * x))", "x - x"]
)
def test_where_nan_stays(double, expression):
    assert np.isnan(double("float x", expression, np.nan))


@pytest.mark.parametrize(
    ("x", "y", "want"), [(-2, 2, np.nan), (0, 0, 1), (0, 2, 0), (0, -1, np.inf), (np.inf, 1, np.inf)]
)
def test_pow_at_its_edges(double, x, y, want):
    np.testing.assert_equal(double("float x, float y", "pow(x, y)", x, y), want)


# ---- float32 and float16 ---------------------------------------------------------------------------------------------


def interpreted(tmp_path, text, precision):
    path = tmp_path / "test.glsl"
    path.write_text(HEAD + text)
    f = shader(path).f
    f._library.compiled[f.signatures[0], f.mode] = Interpretation(f._library.source, f.signatures[0], precision)
    return f


@pytest.mark.parametrize("kind", [np.float32, np.float16])
@pytest.mark.parametrize(
    ("expression", "numpy"),
    [
        ("x + y", np.add),
        ("x - y", np.subtract),
        ("x * y", np.multiply),
        ("x / y", np.divide),
        ("sqrt(x)", lambda x, y: np.sqrt(x)),
        ("x * 0.1", lambda x, y: x * x.dtype.type(0.1)),
        ("x * y + x", lambda x, y: x * y + x),
        ("(x + y) - x", lambda x, y: (x + y) - x),
    ],
)
def test_every_operation_is_rounded_to_its_type(tmp_path, kind, expression, numpy):
    """numpy's operations of float32 and float16 are IEEE's; denormals, infinities and signed zeros are among them."""
    pairs = np.concatenate([X, [0, -0.0, 6e-8, 1e-5, 65504, np.inf, 1e-45, 1e-39, 3e38]]).astype(np.float32)
    x, y = np.meshgrid(pairs, pairs)
    with np.errstate(all="ignore"):
        want = numpy(x.astype(kind), y.astype(kind))
        got = interpreted(tmp_path, f"float f(float x, float y) {{ return {expression}; }}", np.dtype(kind).name)(x, y)
    assert got.dtype == kind
    np.testing.assert_array_equal(got, want)
    zero = want == 0
    np.testing.assert_array_equal(np.signbit(got[zero]), np.signbit(want[zero]))


@pytest.mark.parametrize("name", ["sin", "cos", "exp", "exp2", "log", "log2", "atan", "tanh", "asin"])
def test_a_transcendental_function_of_float32_is_the_nearest_float32(tmp_path, name):
    """mpmath at 50 digits, rounded by way of 53 bits."""
    import mpmath as mp

    functions = {"exp2": lambda x: mp.mpf(2) ** x, "log2": lambda x: mp.log(x, 2)}
    want = [float(functions.get(name, getattr(mp, name, None))(mp.mpf(float(x)))) for x in U]
    got = interpreted(tmp_path, f"float f(float x) {{ return {name}(x); }}", "float32")(U)
    np.testing.assert_array_equal(got, np.array(want).astype(np.float32))


def test_bits_of_a_float_are_those_of_float32(tmp_path):
    f = interpreted(tmp_path, "float f(float x) { return intBitsToFloat(floatBitsToInt(x) + 1); }", "float32")
    np.testing.assert_array_equal(f(U), np.nextafter(U, np.float32(2)))
