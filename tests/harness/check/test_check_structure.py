"""Faults of the .sprj by itself, one at a time in a copy of the project."""

from __future__ import annotations

import pytest

from harness.check import check

SPRJ = "project.sprj"
QUAD = '<item name="Screen" type="geometry"><type>ScreenQuadNDC</type><topology>TriangleList</topology></item>'


def with_object(text: str) -> list[tuple[str, str, str]]:
    return [(SPRJ, "<objects>", f"<objects>\n{text}")]


def test_the_project_has_no_findings(root):
    assert check(root / "project.sprj") == []


def test_the_copy_has_no_findings(scene):
    scene.breaks([])


@pytest.mark.parametrize(
    ("code", "edits", "snippet"),
    [
        ("HS001", [(SPRJ, "</pipeline>", "</pipelin>")], "</pipelin>"),
        ("HS001", [(SPRJ, 'version="2"', 'version="3"')], "<project"),
        ("HS001", [(SPRJ, 'version="2"', 'version="1"')], "<rendertexture />"),  # named "Window" in version 1
        ("HS001", [(SPRJ, '<?xml version="1.0"?>\n', '<!DOCTYPE project [<!ENTITY a "b">]>\n')], "<!DOCTYPE"),
        ("HS002", [(SPRJ, 'name="Painted teapot"', 'name="SCREEN"')], 'name="SCREEN"'),
        ("HS002", [(SPRJ, 'name="Painted teapot"', 'name="metals"')], 'name="metals"'),
        ("HS002", [(SPRJ, QUAD, f"{QUAD}\n{QUAD.replace('/type>', '/type><x>0</x>')}")], "<x>0</x>"),
        ("HS003", [(SPRJ, "<rendertexture />", '<rendertexture name="shadow" />')], 'name="shadow"'),
        ("HS004", [(SPRJ, "<roll>0</roll>", "")], 'type="camera"'),
        ("HS004", with_object('<object type="rendertexture" name="rt" />'), 'name="rt"'),
        ("HS004", [(SPRJ, 'name="Screen"', f'name="{"S" * 64}"')], "SSSS"),
        ("HS004", [(SPRJ, ">TONE_CLAMP<", f">{'(' * 256}TONE_CLAMP{')' * 256}<")], "((TONE_CLAMP"),
        ("HS005", [(SPRJ, 'value="Tangent"', 'value="Binormal"')], 'value="Binormal"'),
        (
            "HS006",
            with_object('<object type="texture" path="x.png"><bind slot="0" name="Nobody" /></object>'),
            "Nobody",
        ),
        ("HS006", [(SPRJ, QUAD, f'{QUAD}\n<item name="Two" type="geometry"><type>Cone</type></item>')], "Cone"),
        ("HS006", [(SPRJ, QUAD, f'{QUAD}\n<item name="Two" type="light" />')], 'type="light"'),
        ("HS008", [(SPRJ, "<objects>", '<plugins><entry name="Fog" /></plugins>\n<objects>')], "<plugins>"),
        (
            "HS009",
            [(SPRJ, 'path="textures/PaintedMetal_1K-PNG_C', 'path="../scene/textures/PaintedMetal_1K-PNG_C')],
            "..",
        ),
        (
            "HS010",
            [(SPRJ, QUAD, f'{QUAD}\n<item name="Off" type="renderstate"><depthmask>false</depthmask></item>')],
            "Off",
        ),
        ("HS006", [(SPRJ, "<path>shaders</path>", "<path>shaders</path>\n<path>shadows</path>")], "shadows"),
        ("HS009", [(SPRJ, "<path>shaders</path>", "<path>shaders</path>\n<path>../scene</path>")], "../scene"),
        ("HS009", [(SPRJ, "<path>shaders</path>", "<path>shaders</path>\n<path>/usr</path>")], "/usr"),
        ("HS011", [(SPRJ, "<distance>15<", "<distance>80<")], "<distance>80<"),
    ],
)
def test_a_fault_is_found_in_its_line(scene, code, edits, snippet):
    scene.breaks(edits, (code, SPRJ, snippet))


def test_a_project_without_a_camera_is_noted(scene):
    camera = (
        '<entry type="camera" fp="false"><distance>15</distance><pitch>16</pitch><yaw>180</yaw><roll>0</roll></entry>'
    )
    scene.breaks([(SPRJ, camera, "")], ("HS011", SPRJ, "<settings>"))


def test_depth_writes_that_are_restored_are_fine(scene):
    off = '<item name="Off" type="renderstate"><depthmask>false</depthmask></item>'
    scene.replace(SPRJ, QUAD, f'{off}\n{QUAD}\n<item name="On" type="renderstate"><cull>true</cull></item>')
    assert "HS010" not in [code for code, _, _ in scene.found()]


def test_all_faults_are_found_at_once(scene):
    scene.breaks(
        [
            (SPRJ, "<rendertexture />", '<rendertexture name="shadow" />'),
            (SPRJ, "<distance>15<", "<distance>80<"),
            ("shaders/backdrop.frag", "smoothstep", "smoothstop"),
            ("shaders/normal_map.glsl", "return normal;", "return normale;"),
        ],
        ("HS003", SPRJ, 'name="shadow"'),
        ("HS011", SPRJ, "<distance>80<"),
        ("HS103", "shaders/backdrop.frag", "smoothstop"),
        ("HS103", "shaders/normal_map.glsl", "normale;"),
    )


def test_the_findings_in_the_project_come_first(scene):
    scene.write("a/backdrop.frag", (scene.folder / "shaders/backdrop.frag").read_text())
    scene.breaks(
        [
            (SPRJ, "shaders/backdrop.frag", "a/backdrop.frag"),
            ("a/backdrop.frag", "smoothstep", "smoothstop"),
            (SPRJ, "<distance>15<", "<distance>80<"),
        ],
        ("HS011", SPRJ, "<distance>80<"),
        ("HS103", "a/backdrop.frag", "smoothstop"),
    )


def test_what_the_reader_warns_of_is_found_where_nothing_else_is(scene):
    pytest.importorskip("harness.projects.traps")
    scene.breaks([(SPRJ, 'wrap_s="Repeat"', 'wrap_s="Repeated"')], ("HS007", SPRJ, "PaintedMetal_1K-PNG_Color.png"))
