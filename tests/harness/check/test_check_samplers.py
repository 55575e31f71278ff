"""SHADERed's search for samplers against what was meant, one fault at a time in a copy of the project."""

from __future__ import annotations

import pytest
from PIL import Image

SPRJ, MATERIAL, BACK, BACK_VERT = (
    "project.sprj",
    "shaders/material.glsl",
    "shaders/backdrop.frag",
    "shaders/backdrop.vert",
)
PASS = 'name="Painted metal" />'
THIRD = "uniform sampler2D map_3;"
SHADES_OF_GRAY = '<object type="texture" path="textures/gray.png" vflip="true">'


@pytest.fixture
def gray(scene):
    """A texture of no role."""
    gradient = Image.linear_gradient("L").resize((16, 16))
    gradient.save(scene.folder / "textures" / "gray.png")
    return scene


def bound(slot: int) -> tuple[str, str, str]:
    return SPRJ, "</objects>", f'{SHADES_OF_GRAY}<bind slot="{slot}" {PASS}</object></objects>'


@pytest.mark.parametrize(
    "text",
    [
        "// uniform sampler2D old;",
        "/* uniform sampler2D old; */",
        "#if 0\nuniform sampler2D old;\n#endif",
        "vec4 read(sampler2D old, vec2 at) { return texture(old, at); }",
    ],
)
def test_text_that_declares_nothing_takes_a_texture(gray, text):
    """A fifth texture fills the slot that the text takes: otherwise the last sampler would have none as well."""
    snippet = next(line for line in text.split("\n") if "old" in line)
    gray.breaks([(MATERIAL, THIRD, f"{text}\n{THIRD}"), bound(7)], ("HS301", MATERIAL, snippet))


def test_what_takes_a_texture_leaves_the_last_sampler_without(scene):
    scene.breaks(
        [(MATERIAL, THIRD, f"// uniform sampler2D old;\n{THIRD}")],
        ("HS301", MATERIAL, "old"),
        ("HS302", MATERIAL, "uniform sampler2D map_4;"),
    )


@pytest.mark.parametrize(
    "text",
    [
        "uniform sampler2D  map_3;",
        "uniform sampler2D map_3 ;",
        "uniform sampler2D\tmap_3;",
        "uniform sampler2D map_3; // one; two",
    ],
)
def test_a_declaration_that_the_search_misreads(scene, text):
    scene.breaks([(MATERIAL, THIRD, text)], ("HS304", MATERIAL, "map_3;" if "map_3;" in text else "map_3 ;"))


def test_a_sampler_without_a_texture(scene):
    scene.replace(SPRJ, f'<bind slot="3" {PASS}', "")
    assert scene.found() == [("HS302", MATERIAL, scene.line(MATERIAL, "uniform sampler2D map_4;"))]


def test_a_texture_without_a_sampler(gray):
    gray.breaks([bound(9)], ("HS303", SPRJ, 'slot="9"'))


def test_gaps_between_slots_close(scene):
    scene.breaks([(SPRJ, f'slot="3" {PASS}', f'slot="30" {PASS}')])


def test_a_sampler_of_the_vertex_shader_alone(scene):
    scene.breaks(
        [
            (BACK_VERT, "void main", "uniform sampler2D bumps;\nvoid main"),
            (BACK_VERT, "+ 0.5;", "+ textureLod(bumps, position, 0.0).r;"),
        ],
        ("HS305", BACK_VERT, "bumps;"),
    )


def test_textures_in_another_order_than_the_samplers(scene):
    scene.breaks(
        [
            (SPRJ, f'slot="0" {PASS}', f'slot="0.5" {PASS}'),
            (SPRJ, f'slot="1" {PASS}', f'slot="0" {PASS}'),
            (SPRJ, '"0.5"', '"1"'),
        ],
        ("HS306", SPRJ, f'slot="1" {PASS}'),
        ("HS306", SPRJ, f'slot="0" {PASS}'),
    )


def test_one_texture_bound_twice(scene):
    scene.breaks([(SPRJ, f'"3" {PASS}', f'"3" {PASS}\n<bind slot="5" {PASS}')], ("HS307", SPRJ, 'slot="5"'))


def test_two_objects_of_one_file(gray):
    gray.breaks(
        [bound(9), (SPRJ, "</objects>", f"\n{SHADES_OF_GRAY}</object></objects>")],
        ("HS303", SPRJ, 'slot="9"'),
        ("HS307", SPRJ, f"{SHADES_OF_GRAY}</object>"),
    )


def test_two_textures_in_one_slot(gray):
    gray.replace(*bound(2))
    assert [code for code, _, _ in gray.found()] == ["HS307"]


def test_a_cube_map_for_a_plain_sampler(scene):
    cube = '<object type="texture" name="sky" cube="true" '
    cube += " ".join(
        f'{f}="textures/PaintedMetal_1K-PNG_Color.png"' for f in ("left", "right", "top", "bottom", "front", "back")
    )
    scene.breaks(
        [
            (SPRJ, "</objects>", f'{cube}><bind slot="0" name="Backdrop" /></object></objects>'),
            (BACK, "in float height;", "in float height;\nuniform sampler2D sky;"),
            (BACK, "tone_map(", "tone_map(texture(sky, vec2(height)).rgb * "),
        ],
        ("HS308", SPRJ, 'name="sky"'),
    )
