"""Textures of passes: files, cube maps, volumes, the keyboard; what is missing, damaged or too much."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from PIL import Image
from sprj_files import SIZE, drawn, first_floats, line_of, texture, write_quad, write_texture

from harness import ProjectError
from harness.rendering.render import render


def test_a_texture_is_not_converted(tmp_path):
    write_texture(tmp_path, "t.png", (128, 1, 254, 77))
    path = write_quad(
        tmp_path,
        "color = texture(t, uv);",
        "uniform sampler2D t;",
        objects=texture("t.png"),
        settings='<entry type="usealpha" val="true" />',
    )
    assert (render(path, SIZE) == (128, 1, 254, 77)).all()


@pytest.mark.parametrize("vflip, at_the_bottom", [("false", 200), ("true", 100)])
def test_v_0_is_the_bottom_row_unless_flipped(tmp_path, vflip, at_the_bottom):
    Image.fromarray(np.array([[100], [200]], np.uint8)).save(tmp_path / "t.png")
    path = write_quad(
        tmp_path,
        "color = texture(t, vec2(0.5, 0.25));",
        "uniform sampler2D t;",
        objects=texture("t.png", more=f'vflip="{vflip}"'),
    )
    assert (render(path, SIZE)[..., 0] == at_the_bottom).all()


@pytest.mark.parametrize("wrap, expected", [("s", (0, 30)), ("t", (30, 0))])
def test_wraps_are_of_their_direction(tmp_path, wrap, expected):
    """Red counts columns and green rows from the bottom, by 10; (1.125, 1.125) is the first or the last of them."""
    counts = np.zeros((4, 4, 3), np.uint8)
    counts[..., 0], counts[..., 1] = 10 * np.arange(4), 10 * np.arange(4)[::-1, None]
    Image.fromarray(counts).save(tmp_path / "t.png")
    other = "t" if wrap == "s" else "s"
    path = write_quad(
        tmp_path,
        "color = texture(t, vec2(1.125));",
        "uniform sampler2D t;",
        objects=texture(
            "t.png", more=f'min_filter="Nearest" mag_filter="Nearest" wrap_{wrap}="Repeat" wrap_{other}="ClampToEdge"'
        ),
    )
    assert (render(path, SIZE)[0, 0, :2] == expected).all()


def test_a_missing_texture(tmp_path):
    path = write_quad(
        tmp_path, "color = texture(t, uv);", "uniform sampler2D t;", objects="\n" + texture("maps/gone.png")
    )
    with pytest.raises(ProjectError) as caught:
        render(path, SIZE)
    assert caught.value.message == '<object type="texture" path="maps/gone.png">: there is no such file'
    assert (caught.value.file, caught.value.line) == (str(path), line_of(path, "<object "))


def test_a_damaged_texture(tmp_path):
    (tmp_path / "t.png").write_bytes(b"\x89PNG\r\n\x1a\n damaged")
    path = write_quad(tmp_path, "color = texture(t, uv);", "uniform sampler2D t;", objects=texture("t.png"))
    with pytest.raises(ProjectError, match='"t.png">: the file is damaged') as caught:
        render(path, SIZE)
    assert caught.value.line == line_of(path, "<object ")


def test_textures_that_are_too_large_together(tmp_path, monkeypatch):
    monkeypatch.setattr("harness.rendering.textures.MOST_PIXELS", 1)
    for name in ("a.png", "b.png"):
        write_texture(tmp_path, name)
    path = write_quad(tmp_path, "", objects=texture("a.png") + texture("b.png", 1))
    with pytest.raises(ProjectError, match='"b.png">: more than 1 pixels of textures in all'):
        render(path, SIZE)


FACES = {"right": 10, "left": 20, "top": 30, "bottom": 40, "back": 50, "front": 60}


def cube(folder, **sizes: tuple[int, int]) -> str:
    for name, value in FACES.items():
        Image.new("RGB", sizes.get(name, (1, 1)), (value, 0, 0)).save(folder / f"{name}.png")
    attributes = " ".join(f'{name}="{name}.png"' for name in FACES)
    return f'<object type="texture" name="sky" cube="true" {attributes}><bind slot="0" name="Quad" /></object>'


@pytest.mark.parametrize(
    "direction, face",
    [("1, 0, 0", 10), ("-1, 0, 0", 20), ("0, 1, 0", 30), ("0, -1, 0", 40), ("0, 0, 1", 50), ("0, 0, -1", 60)],
)
def test_faces_of_a_cube_map(tmp_path, direction, face):
    path = write_quad(
        tmp_path, f"color = texture(sky, vec3({direction}));", "uniform samplerCube sky;", objects=cube(tmp_path)
    )
    assert (render(path, SIZE)[..., 0] == face).all()


def test_faces_are_not_turned_over(tmp_path):
    objects = cube(tmp_path)
    for name in FACES:
        Image.fromarray(np.array([[[1, 0, 0]] * 2, [[2, 0, 0]] * 2], np.uint8)).save(tmp_path / f"{name}.png")
    # Of the face +z t runs down, against y (OpenGL 4.5, table 8.19): the upper half is the top row.
    path = write_quad(tmp_path, "color = texture(sky, vec3(0.9, 0.9, 1));", "uniform samplerCube sky;", objects=objects)
    assert (render(path, SIZE)[..., 0] == 1).all()


def test_a_face_is_clamped_at_its_edge(tmp_path):
    objects = cube(tmp_path, **dict.fromkeys(FACES, (2, 2)))
    face = np.zeros((2, 2, 3), np.uint8)
    face[:, 0] = 200
    Image.fromarray(face).save(tmp_path / "right.png")
    body = "color = texture(t, vec3(1.0, 0.0, 0.999));"  # near the first column's outer edge
    path = write_quad(tmp_path, body, "uniform samplerCube t;", objects=objects)
    assert (render(path, SIZE)[..., 0] == 200).all()


@pytest.mark.parametrize("sizes", [{"top": (2, 2)}, dict.fromkeys(FACES, (2, 1))])
def test_faces_that_are_no_cube(tmp_path, sizes):
    path = write_quad(tmp_path, "", "uniform samplerCube sky;", objects=cube(tmp_path, **sizes))
    with pytest.raises(ProjectError, match='"sky".*squares of one size'):
        render(path, SIZE)


def test_a_missing_face(tmp_path):
    objects = cube(tmp_path)
    (tmp_path / "back.png").unlink()
    path = write_quad(tmp_path, "", "uniform samplerCube sky;", objects="\n" + objects)
    with pytest.raises(ProjectError, match="back.png.*there is no such file") as caught:
        render(path, SIZE)
    assert caught.value.line == line_of(path, "<object ")


def test_the_keyboard_is_at_rest(tmp_path):
    objects = '<object type="texture" name="keys" keyboard_texture="true"><bind slot="0" name="Quad" /></object>'
    read = "color = texelFetch(keys, ivec2(65, 0), 0) + vec4(textureSize(keys, 0), 0.0, 0.0);"
    path = write_quad(tmp_path, read, "uniform sampler2D keys;", objects=objects)
    np.testing.assert_array_equal(first_floats(path), (256, 3, 0, 1))


def dds(width: int, height: int, depth: int, pixels: bytes) -> bytes:
    """A surface of 32 bits a pixel: red in the lowest byte, alpha in the highest."""
    masks = (0xFF, 0xFF00, 0xFF0000, 0xFF000000)
    return (
        b"DDS "
        + struct.pack(
            "<7I44x8I5I", 124, 0x801007, height, width, 0, depth, 0, 32, 0x41, 0, 32, *masks, 0x1000, 0, 0, 0, 0
        )
        + pixels
    )


def test_a_volume(tmp_path):
    (tmp_path / "v.dds").write_bytes(dds(1, 1, 2, bytes((10, 0, 0, 255, 20, 0, 0, 255))))
    path = write_quad(
        tmp_path,
        "color = 255.0 * vec4(texture(v, vec3(0.5, 0.5, 0.25)).r, texture(v, vec3(0.5, 0.5, 0.75)).r, 0.0, 1.0);",
        "uniform sampler3D v;",
        objects=texture("v.dds", more='is_3d="true"'),
    )
    np.testing.assert_allclose(first_floats(path)[:2], (10, 20), rtol=1e-6)


def test_a_volume_is_a_surface(tmp_path):
    write_texture(tmp_path, "t.png")
    path = write_quad(tmp_path, "", "uniform sampler3D v;", objects=texture("t.png", more='is_3d="true"'))
    with pytest.raises(ProjectError, match="a 3D texture is a .dds file"):
        render(path, SIZE)


def test_images_are_too_large_together(tmp_path, monkeypatch):
    monkeypatch.setattr("harness.rendering.resources.MOST_BYTES", 16 * 4 * 4)
    objects = "".join(
        f'<object type="image" name="{n}" width="4" height="3"><bind slot="0" name="Quad" /></object>' for n in "ab"
    )
    with pytest.raises(ProjectError, match='"b": more than 0 MiB in all'):
        drawn(write_quad(tmp_path, "", objects=objects))
