"""Attributes and tangents that models do not have as the shader reads them, one at a time in a copy of the project."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from harness import native
from harness.check import models
from harness.native.mesh_data import mesh_data

SPRJ, VERT, BACK_VERT = "project.sprj", "shaders/pbr.vert", "shaders/backdrop.vert"
TEAPOT, PLAIN = "models/teapot.glb", "models/teapot_plain.glb"
TANGENT = '<item value="Tangent" semantic="TANGENT" />'
TEXCOORD = '<item value="Texcoord" semantic="TEXCOORD0" />'


@pytest.fixture(scope="session")
def pack(root):
    """The project's own writer of glTF files."""
    spec = importlib.util.spec_from_file_location("glb_writer", root / "models" / "glb.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.pack


@pytest.fixture
def square(scene, pack):
    """Puts a square into the place of the painted teapot: u toward +x, and ``tangent`` but for ``without`` corners."""

    def put(tangent: tuple[float, float, float, float], *, u: int = 1, without: int = 0) -> None:
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        attributes = {
            "POSITION": corners,
            "NORMAL": np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
            "TANGENT": np.tile(np.array(tangent, np.float32), (4, 1)),
            "TEXCOORD_0": corners[:, :2] * np.array([u, -1], np.float32) / 2 + np.float32(0.5),
        }
        attributes["TANGENT"][:without] = 0
        triangles = np.array([[0, 1, 2], [0, 2, 3]], np.uint16)
        scene.write("square/square.glb", pack("square", attributes, triangles, {}))
        scene.replace(SPRJ, TEAPOT, "square/square.glb")

    return put


@pytest.mark.parametrize(
    ("code", "edits", "file", "snippet"),
    [
        ("HS501", [(SPRJ, TEAPOT, "models/teepot.glb")], SPRJ, "teepot"),
        ("HS501", [(SPRJ, TEAPOT, "shaders/brdf.glsl")], SPRJ, "brdf.glsl"),
        ("HS504", [(SPRJ, TANGENT, "")], VERT, "in vec3 tangent;"),
        ("HS507", [(BACK_VERT, "layout(location = 0) in", "in")], BACK_VERT, "in vec2 position"),
    ],
)
def test_a_fault_is_found_in_its_line(scene, code, edits, file, snippet):
    scene.breaks(edits, (code, file, snippet))


def test_a_model_without_what_the_shader_reads(scene):
    scene.write("bare.glb", (scene.folder / PLAIN).read_bytes())
    scene.breaks([(SPRJ, TEAPOT, "bare.glb")], ("HS502", SPRJ, "bare.glb"))


def test_one_model_with_two_layouts(scene):
    scene.replace(SPRJ, PLAIN, TEAPOT)
    second = [n for n, text in enumerate(scene.project.read_text().split("\n"), 1) if TEAPOT in text][1]
    assert scene.found() == [("HS506", SPRJ, second)]


def test_a_layout_in_another_order_than_the_attributes(scene):
    scene.breaks(
        [(SPRJ, TEXCOORD, "<!-- -->"), (SPRJ, TANGENT, TANGENT + TEXCOORD)],
        ("HS505", VERT, "in vec2 texcoord"),
        ("HS505", VERT, "in vec3 tangent"),
    )


def test_a_square_with_its_tangent_along_u_is_fine(scene, square):
    square((1, 0, 0, 1))
    scene.breaks([])


def test_a_tangent_against_u(scene, square):
    square((-1, 0, 0, -1))
    scene.breaks([], ("HS503", SPRJ, "square.glb"))


def test_a_mirrored_texture_whose_handedness_is_not_read(scene, square):
    square((-1, 0, 0, -1), u=-1)
    scene.breaks([], ("HS508", SPRJ, "square.glb"))


def test_a_tangent_of_zero(scene, square):
    square((0, 0, 0, 1))
    scene.breaks([], ("HS502", SPRJ, "square.glb"))


def test_a_tangent_of_zero_at_one_corner(scene, square):
    square((1, 0, 0, 1), without=1)
    scene.breaks([], ("HS502", SPRJ, "square.glb"))


def test_a_built_in_sphere_under_a_normal_map(scene):
    text = scene.project.read_text()
    start = text.index('<item name="Painted teapot" type="model">')
    item = text[start : text.index("</item>", start)]
    scene.replace(SPRJ, item, '<item name="Ball" type="geometry"><type>Sphere</type><width>1</width>')
    scene.breaks([(SPRJ, 'vflip="true"', 'vflip="false"', -1)], ("HS503", SPRJ, '"Ball"'))


@pytest.mark.parametrize(
    ("shape", "against"),
    [("Cube", 0.5), ("Sphere", 1), ("Plane", 1), ("Circle", 1), ("Triangle", 1), ("ScreenQuad", 1)],
)
def test_tangents_of_built_in_shapes_against_u(shape, against):
    """Half the cube's faces are mirrored, and all of the others: as seen in SHADERed."""
    from harness.projects.xml_lines import Element

    item = Element("item", {}, "", 1, children=[Element("type", {}, "", 1, shape)])
    agreement = models.tangent_agreement(models._shape(item))
    assert agreement.size and (agreement < 0).mean() == against
    np.testing.assert_allclose(np.abs(agreement), 1, atol=0.02)  # a sphere's facets are flat: cos of half a facet


def test_mesh_data_are_the_file_s(pack, tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0]], np.float32)
    (tmp_path / "one.glb").write_bytes(pack("one", {"POSITION": corners}, np.array([[2, 0, 1]], np.uint16), {}))
    native.open_context()
    data = mesh_data(native.Mesh.load(tmp_path / "one.glb"))
    assert data.fields == {native.Field.POSITION}
    np.testing.assert_array_equal(data.vertices[data.triangles[0], :3], corners[[2, 0, 1]])
    np.testing.assert_array_equal(data.vertices[:, 14:], 1)
