"""SHADERed's built-in shapes: each test is a property of the vertex tables or of the rule for tangents."""

from __future__ import annotations

import math

import numpy as np
import pytest

from harness.rendering import shapes

SIZE = (1.5, 0.7, 2.0)
SHAPES_3D = ("Cube", "Sphere", "Plane", "Circle", "Triangle")


def split(flat):
    """Triangles' (positions, normals, texture coordinates, tangents, bitangents, colours), each (n, 3, k)."""
    corners = flat.astype(float).reshape(-1, 3, 18)
    return np.split(corners, [3, 6, 8, 11, 14], axis=-1)


def derivatives(position, texcoord):
    """dP/du and dP/dv of triangles, (n, 3) each, in double precision; NaN for triangles without area."""
    edges = position[:, 1:] - position[:, :1]
    coordinates = texcoord[:, 1:] - texcoord[:, :1]
    area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=-1)
    along = np.linalg.solve(coordinates, edges)
    along[area < 1e-6] = np.nan
    return along[:, 0], along[:, 1]


@pytest.mark.parametrize(
    "shape, count",
    [
        ("Cube", 36),
        ("Sphere", 2400),
        ("Plane", 6),
        ("ScreenQuad", 6),
        ("Circle", 96),
        ("Triangle", 3),
        ("ScreenQuadNDC", 6),
    ],
)
def test_vertex_count(shape, count):
    flat = shapes.vertices(shape, SIZE)
    assert flat.shape == (count, 18) and flat.dtype == np.float32


@pytest.mark.parametrize("shape", SHAPES_3D)
def test_the_front_is_where_the_normal_points(shape):
    # The plane and the circle say so of themselves too: their normal is -z, and they are culled from +z.
    position, normal, *_ = split(shapes.vertices(shape, SIZE))
    winding = np.cross(position[:, 1] - position[:, 0], position[:, 2] - position[:, 0])
    facing = (winding[:, None] * normal).sum(-1)
    has_area = np.linalg.norm(winding, axis=-1) > 1e-6
    assert (facing[has_area] > 0).all()


@pytest.mark.parametrize("shape", SHAPES_3D)
def test_colour_is_white(shape):
    assert (split(shapes.vertices(shape, SIZE))[5] == 1).all()


@pytest.mark.parametrize("shape", SHAPES_3D)
def test_bitangent_is_the_derivative_by_v_as_it_comes(shape):
    position, _, texcoord, _, bitangent, _ = split(shapes.vertices(shape, SIZE))
    _, along_v = derivatives(position, texcoord)
    has_area = np.isfinite(along_v).all(-1)
    expected = np.repeat(along_v[has_area, None], 3, axis=1)
    np.testing.assert_allclose(bitangent[has_area], expected, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("shape", SHAPES_3D)
def test_tangents_are_unit_and_perpendicular_to_the_normal(shape):
    position, normal, texcoord, tangent, _, _ = split(shapes.vertices(shape, SIZE))
    has_area = np.isfinite(derivatives(position, texcoord)[0]).all(-1)
    np.testing.assert_allclose(np.linalg.norm(tangent[has_area], axis=-1), 1, atol=1e-6)
    np.testing.assert_allclose((tangent * normal).sum(-1)[has_area], 0, atol=1e-5)


@pytest.mark.parametrize("shape", SHAPES_3D)
def test_normal_tangent_and_bitangent_are_right_handed(shape):
    position, normal, texcoord, tangent, bitangent, _ = split(shapes.vertices(shape, SIZE))
    has_area = np.isfinite(derivatives(position, texcoord)[0]).all(-1)
    assert ((np.cross(normal, tangent) * bitangent).sum(-1)[has_area] > 0).all()


def test_only_the_triangles_at_the_sphere_s_first_pole_have_no_tangent():
    # At the other pole sin(float32 pi) is not quite 0: those triangles have a little area, and a tangent.
    tangent = split(shapes.vertices("Sphere", SIZE))[3]
    missing = np.isnan(tangent).any((1, 2)).reshape(20, 20, 2)
    assert missing[0, :, 0].all() and missing.sum() == 20


@pytest.mark.parametrize(
    "normal, along_u, along_v, tangent",
    [
        ((0, 0, 1), (1, 0, 0), (0, 1, 0), (1, 0, 0)),
        ((0, 0, -1), (1, 0, 0), (0, 1, 0), (-1, 0, 0)),
        ((1, 0, 0), (0, 0, -1), (0, 1, 0), (0, 0, -1)),
        ((-1, 0, 0), (0, 0, -1), (0, 1, 0), (0, 0, 1)),
        ((0, 1, 0), (1, 0, 0), (0, 0, -1), (1, 0, 0)),
        ((0, -1, 0), (1, 0, 0), (0, 0, -1), (-1, 0, 0)),
    ],
)
def test_texture_on_the_cube_s_faces(normal, along_u, along_v, tangent):
    position, normals, texcoord, tangents, _, _ = split(shapes.vertices("Cube", SIZE))
    face = (normals == normal).all((1, 2))
    u, v = derivatives(position[face], texcoord[face])
    assert face.sum() == 2
    np.testing.assert_allclose(u, np.tile(np.multiply(along_u, SIZE), (2, 1)), atol=1e-6)
    np.testing.assert_allclose(v, np.tile(np.multiply(along_v, SIZE), (2, 1)), atol=1e-6)
    np.testing.assert_allclose(tangents[face], np.broadcast_to(tangent, (2, 3, 3)), atol=1e-6)


def test_the_cube_s_first_face_in_order():
    x, y, z = np.divide(SIZE, 2)
    expected = [(-x, -y, z), (x, -y, z), (x, y, z), (-x, -y, z), (x, y, z), (-x, y, z)]
    np.testing.assert_allclose(shapes.vertices("Cube", SIZE)[:6, :3], expected, rtol=1e-6)


def test_the_plane_in_order():
    x, y = 0.75, 0.35
    expected = [(x, y, 1, 1), (x, -y, 1, 0), (-x, -y, 0, 0), (-x, y, 0, 1), (x, y, 1, 1), (-x, -y, 0, 0)]
    np.testing.assert_allclose(shapes.vertices("Plane", SIZE)[:, [0, 1, 6, 7]], expected, rtol=1e-6)


def test_the_screen_quad_is_a_plane_of_size_1():
    np.testing.assert_array_equal(shapes.vertices("ScreenQuad", SIZE), shapes.vertices("Plane", (1, 1, 1)))


def test_the_circle_goes_from_y_toward_x():
    flat = shapes.vertices("Circle", SIZE)
    t = 2 * math.pi / 32
    expected = [
        (0, 0, 0.5, 0.5),
        (0, 0.7, 0.5, 1),
        (1.5 * math.sin(t), 0.7 * math.cos(t), 0.5 + 0.5 * math.sin(t), 0.5 + 0.5 * math.cos(t)),
    ]
    np.testing.assert_allclose(flat[:3, [0, 1, 6, 7]], expected, atol=1e-6)


def test_the_triangle_in_order():
    right = 1.5 / math.tan(math.radians(30))
    expected = [(-right, -1.5, 1, 0), (right, -1.5, 0, 0), (0, 1.5, 0.5, 1)]
    np.testing.assert_allclose(shapes.vertices("Triangle", SIZE)[:, [0, 1, 6, 7]], expected, rtol=1e-6)


def test_width_is_the_sphere_s_radius():
    position, normal, *_ = split(shapes.vertices("Sphere", SIZE))
    np.testing.assert_allclose(np.linalg.norm(position, axis=-1), 1.5, rtol=1e-6)
    np.testing.assert_allclose(normal, position / 1.5, atol=1e-6)


def test_the_sphere_s_texture_runs_from_x_toward_y_and_down_from_z():
    position, _, texcoord, *_ = split(shapes.vertices("Sphere", (1, 1, 1)))
    theta, phi = 2 * math.pi * texcoord[..., 0], math.pi * texcoord[..., 1]
    expected = np.stack([np.sin(phi) * np.cos(theta), np.sin(phi) * np.sin(theta), np.cos(phi)], axis=-1)
    np.testing.assert_allclose(position, expected, atol=1e-6)


def test_the_sphere_s_faces_are_cba_bcd():
    # In units of slices and stacks, with A = (slice, stack): face 23 is stack 1, slice 3.
    texcoord = split(shapes.vertices("Sphere", SIZE))[2].reshape(400, 6, 2)[23] * 20
    a, b, c, d = (3, 1), (4, 1), (3, 2), (4, 2)
    np.testing.assert_allclose(texcoord, [c, b, a, b, c, d], atol=1e-5)


def test_the_ndc_quad_in_order():
    expected = [(-1, -1, 0, 0), (1, -1, 1, 0), (1, 1, 1, 1), (-1, -1, 0, 0), (1, 1, 1, 1), (-1, 1, 0, 1)]
    np.testing.assert_array_equal(shapes.vertices("ScreenQuadNDC")[:, [0, 1, 6, 7]], expected)


def test_there_is_no_teapot():
    with pytest.raises(ValueError, match="Teapot"):
        shapes.vertices("Teapot")
