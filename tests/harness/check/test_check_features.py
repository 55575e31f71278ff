"""What a pass compiles although nothing needs it, one thing at a time in a copy of the project."""

from __future__ import annotations

import re

import pytest

SPRJ = "project.sprj"
SET = "textures/PaintedMetal_1K-PNG_"
FIRST = '<define name="HAS_ALBEDO_MAP"'
TANGENT = '<item value="Tangent" semantic="TANGENT" />'


@pytest.mark.parametrize(
    ("code", "image", "color", "macro"),
    [
        ("HS601", "Color", (12, 200, 90), "HAS_ALBEDO_MAP"),
        ("HS601", "Roughness", (128, 128, 128), "HAS_ROUGHNESS_MAP"),
        ("HS601", "NormalGL", (128, 128, 255), "HAS_NORMAL_MAP"),
        ("HS601", "Metalness", (99, 99, 99), "HAS_METALNESS_MAP"),
        ("HS602", "Metalness", (255, 255, 255), "HAS_METALNESS_MAP"),
        ("HS602", "Metalness", (0, 0, 0), "HAS_METALNESS_MAP"),
    ],
)
def test_a_map_that_is_the_same_everywhere(scene, code, image, color, macro):
    scene.image(f"{SET}{image}.png", color)
    scene.breaks([], (code, SPRJ, macro))


def test_a_map_with_a_single_pixel_that_differs_is_needed(scene):
    from PIL import Image

    image = Image.new("RGB", (64, 64))
    image.putpixel((33, 17), (255, 255, 255))
    image.save(scene.folder / f"{SET}Metalness.png")
    scene.breaks([])


def test_a_metalness_that_could_be_fixed(scene):
    roughness = '<variable type="float" name="roughness">'
    scene.breaks(
        [
            (SPRJ, '<define name="METALNESS" active="true">1</define>', ""),
            (
                SPRJ,
                roughness,
                f'<variable type="float" name="metalness"><row><value>1</value></row></variable>\n{roughness}',
            ),
        ],
        ("HS602", SPRJ, '"metalness"'),
    )


METALNESS = '<variable type="float" name="metalness"><row><value>1</value></row></variable>'
OF_ITEM = '<value variable="metalness" for="{}"><row><value>{}</value></row></value>\n'


@pytest.mark.parametrize(("values", "fixed"), [((0, 0), True), ((0, 1), False), ((0.5, 0.5), False), ((0,), False)])
def test_a_metalness_is_constant_when_it_is_so_for_all_items(scene, values, fixed):
    """Two items, the second of which has the variable's own value, 1, where it has none of its own."""
    text = scene.project.read_text()
    (item,) = re.findall(r'        <item name="Metal1" type="model">.*?</item>\n', text, re.DOTALL)
    own = "".join(OF_ITEM.format(name, v) for name, v in zip(("Metal1", "Copy"), values, strict=False))
    found = [("HS602", SPRJ, 'name="metalness"')] if fixed else []
    scene.breaks(
        [
            (SPRJ, item, item + item.replace('"Metal1"', '"Copy"')),
            (SPRJ, '<define name="METALNESS" active="true">1</define>', ""),
            (SPRJ, '<variable type="float" name="roughness">', METALNESS + '<variable type="float" name="roughness">'),
            (SPRJ, "<itemvalues>\n", f"<itemvalues>\n{own}"),
        ],
        *found,
    )


def test_a_normal_map_that_is_tilted_everywhere_is_not_flat(scene):
    from harness.check import check

    scene.image(f"{SET}NormalGL.png", (200, 128, 220))
    (finding,) = check(scene.project)
    assert finding.code == "HS601" and "200/128/220 of 255 everywhere" in finding.message


def test_a_map_that_nothing_reads(scene):
    scene.breaks(
        [(SPRJ, FIRST, f'<define name="METALNESS" active="true">1</define>\n        {FIRST}')],
        ("HS603", SPRJ, '<bind slot="2" name="Painted metal" />'),
    )


def test_handedness_that_no_model_needs(scene):
    scene.breaks(
        [
            (SPRJ, FIRST, f'<define name="HAS_MIRRORED_UV" active="true">1</define>\n{FIRST}'),
            (SPRJ, TANGENT, f'{TANGENT}<item value="Bitangent" semantic="BITANGENT" />'),
        ],
        ("HS603", SPRJ, "HAS_MIRRORED_UV"),
    )
