"""Textures as arguments: which texel lies where, what lies between them, and what cannot be one.

Expected values come from the formulas of the OpenGL specification (8.14) in float64: texel [row, column] of an image h
rows high has its middle at u = (column + 1/2) / w, v = 1 - (row + 1/2) / h.
"""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from harness import CallError, Texture

LOOKUP = "vec4 f(sampler2D map, vec2 uv) { return texture(map, uv); }"


@pytest.fixture(scope="module")
def image():
    return np.random.default_rng(1).random((3, 5, 4)).astype(np.float32)


def middles(height, width):
    """Coordinates of all texels' middles, (height, width, 2), row 0 the top row."""
    u, v = (np.arange(width) + 0.5) / width, 1 - (np.arange(height) + 0.5) / height
    return np.stack(np.broadcast_arrays(u[None, :], v[:, None]), axis=-1)


def wrapped(k, size, wrap):
    """The index of a texel beyond the edge."""
    if wrap == "repeat":
        return k % size
    if wrap == "clamp":
        return np.clip(k, 0, size - 1)
    k = k % (2 * size)
    return np.where(k < size, k, 2 * size - 1 - k)


def bilinear(image, uv, wrap):
    """Level 0 between the four nearest texels, in float64."""
    height, width = image.shape[:2]
    x, y = uv[..., 0] * width - 0.5, (1 - uv[..., 1]) * height - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = (x - i)[..., None], (y - j)[..., None]

    def texel(row, column):
        return image[wrapped(row, height, wrap), wrapped(column, width, wrap)].astype(float)

    top = texel(j, i) * (1 - a) + texel(j, i + 1) * a
    bottom = texel(j + 1, i) * (1 - a) + texel(j + 1, i + 1) * a
    return top * (1 - b) + bottom * b


@pytest.mark.parametrize("every_mode", ["as-written", "precise", "mediump"])
@pytest.mark.parametrize("kind", ["linear", "nearest", "mipmap"])
def test_the_middle_of_a_texel_is_the_texel(functions, image, every_mode, kind):
    """In half precision a texel may be cut to a half (2^-10), and a coordinate is off by 2^-12 of 5 texels."""
    got = functions(LOOKUP, mode=every_mode).f(Texture(image, filter=kind), middles(3, 5))
    if every_mode == "mediump":
        np.testing.assert_allclose(got, image, rtol=2**-10, atol=0 if kind == "nearest" else 2 * (5 * 2**-12 + 2 / 256))
    else:
        np.testing.assert_allclose(got, image, rtol=0, atol=0 if kind == "nearest" else 2e-7)


def test_the_lower_left_corner_is_the_origin(functions):
    """As the renderer has it: row 0 of an image is its top."""
    corners = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]
    image = np.float32([[1, 2], [3, 4]])
    got = functions(LOOKUP).f(Texture(image, filter="nearest"), corners)
    np.testing.assert_array_equal(got[:, 0], [3, 4, 1, 2])


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
def test_nearest_is_the_texel_that_the_coordinate_lies_in(functions, image, wrap):
    uv = np.random.default_rng(2).uniform(-2, 3, (5000, 2)).astype(np.float32)
    x, y = uv[:, 0].astype(float) * 5, (1 - uv[:, 1].astype(float)) * 3
    inside = (np.abs(x - np.round(x)) > 1e-4) & (np.abs(y - np.round(y)) > 1e-4)  # not on an edge, where either will do
    want = image[wrapped(np.floor(y).astype(int), 3, wrap), wrapped(np.floor(x).astype(int), 5, wrap)]
    got = functions(LOOKUP).f(Texture(image, wrap=wrap, filter="nearest"), uv)
    np.testing.assert_array_equal(got[inside], want[inside])


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror"])
def test_linear_is_the_sum_of_four_texels(functions, image, wrap):
    """Weights have 8 bits: each of the two may be off by 1/256, times the difference of texels, which is at most 1."""
    uv = np.random.default_rng(3).uniform(-2, 3, (5000, 2)).astype(np.float32)
    got = functions(LOOKUP).f(Texture(image, wrap=wrap), uv)
    np.testing.assert_allclose(got, bilinear(image, uv.astype(float), wrap), rtol=0, atol=2 / 256)
    assert np.abs(got - bilinear(image, uv.astype(float) + 0.02, wrap)).max() > 3 / 256  # the bound tells something


def test_levels_are_averages(functions):
    """Level k of a square of 4 x 4 texels: the means of squares of 2^k x 2^k."""
    image = np.random.default_rng(4).random((4, 4, 1)).astype(np.float32)
    text = "float f(sampler2D map, vec2 uv, float level) { return textureLod(map, uv, level).x; }"
    got = functions(text).f(Texture(image, filter="mipmap"), middles(2, 2), 1.0)
    np.testing.assert_allclose(got, image.reshape(2, 2, 2, 2).mean(axis=(1, 3)), atol=1e-6)
    np.testing.assert_allclose(
        functions(text).f(Texture(image, filter="mipmap"), [0.1, 0.9], 2.0), image.mean(), atol=1e-6
    )


def test_texture_reads_level_0(functions, image):
    """There is no neighbour to tell that the samples of a batch lie far apart."""
    uv = middles(3, 5).reshape(-1, 2)[::-1]
    got = functions(LOOKUP).f(Texture(image, filter="mipmap"), uv)
    np.testing.assert_allclose(got, image.reshape(-1, 4)[::-1], atol=2e-7)


@pytest.mark.parametrize("channels", [None, 1, 2, 3, 4])
def test_channels_that_are_not_given_are_0_and_alpha_1(functions, channels):
    image = np.random.default_rng(5).random((2, 2) if channels is None else (2, 2, channels)).astype(np.float32)
    got = functions(LOOKUP).f(Texture(image, filter="nearest"), middles(2, 2))
    want = np.broadcast_to(np.float32([0, 0, 0, 1]), (2, 2, 4)).copy()
    want[..., : channels or 1] = image.reshape(2, 2, -1)
    np.testing.assert_array_equal(got, want)


def test_bytes_are_shares_of_255(functions):
    image = np.arange(256, dtype=np.uint8).reshape(16, 16)
    got = functions(LOOKUP).f(Texture(image, filter="nearest"), middles(16, 16))
    np.testing.assert_allclose(got[..., 0], image / 255, rtol=2**-23)
    np.testing.assert_array_equal(got[..., 3], 1)


def test_srgb_is_decoded_but_for_alpha(functions):
    """IEC 61966-2-1, rounded to float32 once."""
    codes = np.arange(256, dtype=np.uint8).reshape(16, 16)
    image = np.stack([codes] * 4, axis=-1)
    got = functions(LOOKUP).f(Texture(image, filter="nearest", srgb=True), middles(16, 16))
    c = codes / 255
    want = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(got[..., 1], want, rtol=2**-23)
    np.testing.assert_allclose(got[..., 3], c, rtol=2**-23)


@pytest.mark.parametrize("dtype", [np.int32, np.uint32])
def test_integers_are_read_as_they_are(functions, dtype):
    info = np.iinfo(dtype)
    image = np.array([[info.min, info.max], [7, 2**24 + 1]], dtype)
    prefix = "u" if dtype == np.uint32 else "i"
    text = f"{prefix}vec4 f({prefix}sampler2D map, ivec2 p) {{ return texelFetch(map, p, 0); }}"
    got = functions(text).f(Texture(image, filter="nearest"), [[0, 1], [1, 1], [0, 0], [1, 0]])
    np.testing.assert_array_equal(got[:, 0], image.ravel())
    assert got.dtype == dtype


def test_a_picture_is_read_from_its_file(functions, tmp_path):
    pixels = np.random.default_rng(6).integers(0, 256, (4, 3, 3)).astype(np.uint8)
    Image.fromarray(pixels).save(tmp_path / "picture.png")
    for path in (tmp_path / "picture.png", str(tmp_path / "picture.png")):
        got = functions(LOOKUP).f(Texture(path, filter="nearest"), middles(4, 3))
        np.testing.assert_allclose(got[..., :3], pixels / 255, rtol=2**-23)


# ---- Calls -----------------------------------------------------------------------------------------------------------


def test_several_textures_parameters_and_uniforms(functions, mode):
    text = """uniform sampler2D base; uniform float gain;
    vec4 read(sampler2D t, vec2 uv) { return texture(t, uv); }
    float f(vec2 uv, sampler2D a, float k, sampler2D b) {
        return read(a, uv).x + 10.0 * read(b, uv).x * k + 100.0 * texture(base, uv).x * gain; }"""
    a, b, base = (Texture(np.full((1, 1), x, np.float32)) for x in (1, 2, 3))
    made = functions(text, mode=mode)
    assert made.f([0.5, 0.5], a, 1, b, base=base, gain=1) == 321
    assert made.f(uv=[0.5, 0.5], b=a, a=b, k=1, gain=2, base=a) == 212
    np.testing.assert_array_equal(made.f(np.zeros((70_000, 2)), a, 1, b, base=base, gain=1), 321)


def test_a_texture_beside_many_inputs(functions):
    parameters = ", ".join(f"float a{n}" for n in range(40))
    made = functions(f"float f({parameters}, sampler2D t) {{ return a39 + texture(t, vec2(a0)).x; }}")
    assert made.f(*range(40), Texture(np.float32([[5]]))) == 44


def test_overloads_are_told_apart_by_textures_too(functions):
    made = functions(
        "float f(sampler2D t, vec2 uv) { return texture(t, uv).x; } float f(float t, vec2 uv) { return t; }"
    )
    assert made.f(3.0, [0, 0]) == 3
    text = "float g(sampler2D t) { return texture(t, vec2(0)).x; } float g(float t) { return t; }"
    made = functions(text)
    assert made.g(Texture(np.float32([[7]]))) == 7
    assert made.g(2) == 2


def test_a_function_that_needs_a_fragment_takes_textures(functions, image):
    made = functions("vec4 f(sampler2D map, vec2 uv) { return texture(map, uv) + dFdx(uv.x) * 0.0; }")
    np.testing.assert_array_equal(made.f(Texture(image, filter="nearest"), middles(3, 5)[0]), image[0])


@pytest.mark.parametrize(
    ("text", "make", "message"),
    [
        (LOOKUP, lambda: 1, "map is a sampler2D: a harness.Texture, got int"),
        (LOOKUP, lambda: np.zeros((2, 2)), "map is a sampler2D: a harness.Texture, got ndarray"),
        (LOOKUP, lambda: Texture(np.zeros((2, 2), np.int32), filter="nearest"), "is one for a isampler2D"),
        (LOOKUP.replace("sampler2D", "samplerCube").replace("uv)", "uv.xyx)", 2).replace("vec2 uv.xyx)", "vec2 uv)"),
         lambda: Texture(np.zeros((2, 2))), "map is a samplerCube"),
        ("vec4 f(sampler2DArray map, vec2 uv) { return texture(map, uv.xyx); }",
         lambda: Texture(np.zeros((2, 2))), "map is a sampler2DArray"),
        ("vec4 f(sampler2D map[2], vec2 uv) { return texture(map[0], uv); }",
         lambda: [Texture(np.zeros((2, 2)))] * 2, "sampler2D"),
    ],
)  # fmt: skip
def test_what_is_no_texture_for_it_is_refused(functions, text, make, message):
    with pytest.raises(CallError, match=r"test\.glsl:1: ") as caught:
        functions(text).f(make(), [0, 0])
    assert message in caught.value.message


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Texture(np.zeros((2, 2)), wrap="tile"), "no wrap 'tile'; there are: repeat, clamp, mirror"),
        (lambda: Texture(np.zeros((2, 2)), filter="cubic"), "no filter 'cubic'; there are: nearest, linear, mipmap"),
        (lambda: Texture(np.zeros((2, 2, 5))), r"an array \(h, w\) or \(h, w, 1 ... 4\), got \(2, 2, 5\)"),
        (lambda: Texture(np.zeros((0, 2))), r"got \(0, 2\)"),
        (lambda: Texture(np.zeros(4)), r"got \(4,\)"),
        (lambda: Texture(np.zeros((2, 2), bool)), "got numbers of type bool"),
        (lambda: Texture(np.zeros((2, 2)), srgb=True), "only a texture of 8-bit numbers can be sRGB"),
        (lambda: Texture(np.zeros((2, 2), np.int32)), "cannot be filtered: give it filter='nearest'"),
        (lambda: Texture("nowhere.png"), r"nowhere\.png: there is no such file"),
    ],
)
def test_what_cannot_be_a_texture_is_refused(make, message):
    with pytest.raises(CallError, match=message):
        make()
