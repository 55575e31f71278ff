"""Normal maps: decoding, the tangent frame, and what happens where there is none."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import reference

U = 2.0**-24
#: components made from ones off by U: decoding (3 roundings), the frame (8), the product (5), normalize (4), n (4)
VECTOR_ATOL = 24 * U
FLAT = np.float32([128, 128, 255]) / np.float32(255)


def texel(*bytes_):
    return np.float32(bytes_) / np.float32(255)


def perturbed(n, t, handedness, bytes_):
    """The definition at 50 digits: (byte - 128)/127 in the frame of t, perpendicular to n, of cross(n, t), and n."""
    n, t = reference.unit(reference.vector(*n)), reference.vector(*t)
    t = reference.unit(tuple(a - b * reference.dot(n, t) for a, b in zip(t, n, strict=True)))
    b = tuple(handedness * a for a in reference.cross(n, t))
    x, y, z = ((mp.mpf(c) - 128) / 127 for c in bytes_)
    return reference.unit(tuple(x * p + y * q + z * r for p, q, r in zip(t, b, n, strict=True)))


FRAMES = [
    ((0, 0, 1), (1, 0, 0)),
    ((0, 1, 0), (0, 0, -2)),  # a tangent as a scaled model has it
    ((0.6, 0, 0.8), (1, 0.5, 0.25)),  # not perpendicular
    ((-0.48, 0.6, 0.64), (0.01, 0.02, -0.03)),
]
TEXELS = [(128, 128, 255), (255, 128, 128 + 60), (10, 200, 200), (128, 1, 200), (200, 90, 240)]
#: any, with blue on the outside: at least 160, a slope of 76 degrees
ANY = np.random.default_rng(22).integers((30, 30, 160), 256, (20, 3)).tolist()


@pytest.mark.parametrize("handedness", [1.0, -1.0])
@pytest.mark.parametrize("frame", FRAMES)
def test_a_texel_bends_the_normal_in_the_tangent_frame(library, mode, frame, handedness):
    n, t = (np.float32(a) for a in frame)
    n /= np.linalg.norm(n)
    texels = TEXELS + ANY
    normal_map = library("normal_map.glsl", mode)
    want = np.array([perturbed(map(float, n), map(float, t), handedness, b) for b in texels], float)
    texels = [texel(*b) for b in texels]
    got = normal_map.perturb_normal_mirrored(n, t, handedness, texels)
    np.testing.assert_allclose(got, want, rtol=0, atol=VECTOR_ATOL)
    if handedness == 1:
        np.testing.assert_allclose(normal_map.perturb_normal(n, t, texels), want, rtol=0, atol=VECTOR_ATOL)


def test_a_tangent_may_have_any_length(library, mode):
    """From 1e-15, whose square is just above what guards against a zero tangent, to 1e18, whose square is a float."""
    n, t, bytes_ = np.float32([0.6, 0, 0.8]), np.float32([0.8, 0, -0.6]), (200, 90, 240)
    lengths = np.float32([1.01e-15, 1e-10, 1e-3, 1, 1e3, 1e18])
    got = library("normal_map.glsl", mode).perturb_normal(n, lengths[:, None] * t, texel(*bytes_))
    want = perturbed(map(float, n), map(float, t), 1, bytes_)
    np.testing.assert_allclose(got, np.tile(np.array(want, float), (len(lengths), 1)), rtol=0, atol=VECTOR_ATOL)


def test_the_outside_begins_at_the_smallest_step_of_a_byte(library, mode):
    """Blue at and below 128, which stands for 0 and for the inside, counts as 129 does: 1/127."""
    blue = np.arange(0, 130)
    got = library("normal_map.glsl", mode).decode_normal(texel(*np.stack(np.broadcast_arrays(9, 250, blue)).tolist()).T)
    # 129 itself is 1 after a product and a difference off by the rounding of the product, half an ulp of 129
    np.testing.assert_allclose(got[:, 2], 1 / 127, rtol=129 * 3 * U, atol=0)


def test_byte_128_is_exactly_zero(library, mode):
    decoded = library("normal_map.glsl", mode).decode_normal(FLAT)
    np.testing.assert_array_equal(decoded, np.float32([0, 0, 1]))


def test_a_flat_map_changes_nothing(library, mode):
    """Exactly: with x = y = 0 only n is left, and it is unit here."""
    for n, t in [((0, 0, 1), (1, 0, 0)), ((0, 1, 0), (1, 0, 0)), ((-1, 0, 0), (0, 1, 0))]:
        got = library("normal_map.glsl", mode).perturb_normal(n, t, FLAT)
        np.testing.assert_allclose(got, np.float32(n), rtol=0, atol=3 * U)  # normalize: 2.5 ulp on llvmpipe


def test_green_is_up_in_gl_and_down_in_dx(library, mode):
    """The bitangent of n = +z, t = +x is +y; the green of a DX map is the other way round."""
    up, down = texel(128, 228, 210), texel(128, 28, 210)
    gl = library("normal_map.glsl", mode)
    dx = library("normal_map.glsl", mode, NORMAL_MAP_DX=1)
    assert gl.perturb_normal([0, 0, 1], [1, 0, 0], up)[1] > 0.5
    np.testing.assert_array_equal(
        gl.perturb_normal([0, 0, 1], [1, 0, 0], up), dx.perturb_normal([0, 0, 1], [1, 0, 0], down)
    )


def test_red_is_along_the_tangent(library, mode):
    got = library("normal_map.glsl", mode).perturb_normal([0, 0, 1], [0, 1, 0], texel(228, 128, 210))
    assert got[1] > 0.5
    assert abs(got[0]) < VECTOR_ATOL


@pytest.mark.parametrize("bytes_", TEXELS)
def test_a_zero_tangent_gives_the_geometric_normal(library, mode, bytes_):
    n = np.float32([0.6, 0, 0.8])
    got = library("normal_map.glsl", mode).perturb_normal(n, [0, 0, 0], texel(*bytes_))
    np.testing.assert_allclose(got, n, rtol=0, atol=4 * U)


def test_a_tangent_along_the_normal_gives_a_unit_vector(library, mode):
    got = library("normal_map.glsl", mode).perturb_normal([0, 0, 1], [0, 0, 1], texel(200, 30, 200))
    assert abs(np.linalg.norm(got.astype(float)) - 1) < 4 * U


def test_every_texel_gives_a_unit_vector_on_the_outside(library, mode):
    """The bytes of the three channels in steps; also blue below 128, which no map should hold."""
    levels = np.arange(0, 256, 15)
    texels = np.stack(np.meshgrid(levels, levels, levels), -1).reshape(-1, 3).astype(np.float32) / 255
    for t in ([1, 0, 0], [0, 0, 0]):
        got = library("normal_map.glsl", mode).perturb_normal([0, 0, 1], t, texels).astype(float)
        assert np.abs(np.linalg.norm(got, axis=1) - 1).max() < 5 * U
        assert (got[:, 2] > 0).all()


def test_a_mirrored_map_on_mirrored_uv_is_the_same_surface(library, mode):
    """Mirror the image left to right: red turns over, u runs the other way, so does t, and the handedness is -1."""
    n, t = np.float32([0.6, 0, 0.8]), np.float32([0.8, 0, -0.6])
    normal_map = library("normal_map.glsl", mode)
    for r, g, b in TEXELS[:1] + [(255, 128, 188), (28, 200, 200), (128, 28, 200)]:
        plain = normal_map.perturb_normal_mirrored(n, t, 1.0, texel(r, g, b))
        mirrored = normal_map.perturb_normal_mirrored(n, -t, -1.0, texel(256 - r if r != 255 else 1, g, b))
        np.testing.assert_allclose(mirrored, plain, rtol=0, atol=4 * U)
