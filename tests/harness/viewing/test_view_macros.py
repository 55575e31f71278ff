"""The macros that a viewer changes. Expected: the project's own ladders and features, and small ones by hand."""

from __future__ import annotations

import pytest
from sprj_files import read, shader_pass, texture, write_project, write_quad, write_texture

from harness.projects import sprj
from harness.rendering.render import Renderer
from harness.viewing import view_macros
from harness.viewing.view_macros import Changes, Ladder

LADDERS = {
    "BRDF_D": (("D_EXERCISE", "D_CROSS", "D_ONE_MINUS", "D_PROJECT", "D_HALF"), "D_PROJECT"),
    "BRDF_V": (("V_EXACT", "V_HAMMON", "V_SCHLICK", "V_KARIS", "V_SEPARABLE", "V_KELEMEN"), "V_EXACT"),
    "BRDF_F": (("F_POW", "F_MULTIPLY", "F_GAUSSIAN", "F_DIELECTRIC", "F_F82"), "F_MULTIPLY"),
    "BRDF_DIFFUSE": (
        (
            "DIFFUSE_FRESNEL",
            "DIFFUSE_LAMBERT",
            "DIFFUSE_F0",
            "DIFFUSE_SHIRLEY",
            "DIFFUSE_BURLEY",
            "DIFFUSE_EON",
            "DIFFUSE_ENERGY",
        ),
        "DIFFUSE_FRESNEL",
    ),
    "BRDF_MULTI": (("MULTI_NONE", "MULTI_FITTED"), "MULTI_NONE"),
    "SRGB_DECODE": (("SRGB_POWER", "SRGB_PIECEWISE", "SRGB_CUBIC", "SRGB_SQUARE"), "SRGB_POWER"),
    "TONE_CURVE": (("TONE_CLAMP", "TONE_REINHARD"), "TONE_CLAMP"),
}
MAPS = ("HAS_ALBEDO_MAP", "HAS_ROUGHNESS_MAP", "HAS_METALNESS_MAP", "HAS_NORMAL_MAP")

LADDER = """
#define L_LOW 0 // a remark
#define L_MIDDLE 1
#define L_HIGH 2
#ifndef LEVEL
#define LEVEL L_LOW
#endif
"""
THREE = Ladder("LEVEL", ("L_LOW", "L_MIDDLE", "L_HIGH"), "L_LOW")


@pytest.fixture(scope="module")
def scene(root):
    return sprj.read(root / "project.sprj")


def macros(**values: str) -> str:
    return "<macros>" + "".join(f'<define name="{n}">{v}</define>' for n, v in values.items()) + "</macros>"


def test_the_ladders_of_the_project_are_found(scene):
    found = view_macros.find(scene)
    assert {ladder.name: (ladder.choices, ladder.default) for ladder in found.ladders} == LADDERS
    assert found.features == MAPS


def test_numbers_that_are_no_ladder_are_none(tmp_path):
    text = "#define A 0\n#define B 1\n#ifndef SIZE\n#define SIZE 4\n#endif\n"
    assert view_macros.find(read(write_quad(tmp_path, "", text))).ladders == ()


def test_two_ladders_do_not_mix(tmp_path):
    other = LADDER.replace("L_", "M_").replace("LEVEL", "MODE")
    plain = "#define N_MOST 7\n"
    (one, two) = view_macros.find(read(write_quad(tmp_path, "", LADDER + plain + other))).ladders
    assert one == THREE and two.choices == ("M_LOW", "M_MIDDLE", "M_HIGH")


def test_steps_go_round():
    changes, seen = Changes(), []
    for _ in range(3):
        changes = changes.step(THREE, "L_LOW")
        seen.append(changes.rungs.get("LEVEL"))
    assert seen == ["L_MIDDLE", "L_HIGH", None]  # None: as in the project


def test_where_passes_differ_the_project_s_own_comes_back_too():
    changes, seen = Changes(), []
    for _ in range(4):
        changes = changes.step(THREE, None)
        seen.append(changes.rungs.get("LEVEL"))
    assert seen == ["L_LOW", "L_MIDDLE", "L_HIGH", None]


def test_the_project_s_own_rung(tmp_path):
    write_quad(tmp_path, "", LADDER)
    one, two = (shader_pass(n, extra=macros(LEVEL=v)) for n, v in (("One", "L_HIGH"), ("Two", "L_LOW")))
    assert view_macros.own_rung(read(write_project(tmp_path, one)), THREE) == "L_HIGH"
    assert view_macros.own_rung(read(write_project(tmp_path, one + two)), THREE) is None
    assert view_macros.own_rung(read(write_project(tmp_path, shader_pass())), THREE) == "L_LOW"


def test_the_reference_has_all_defaults_and_the_same_features(scene):
    there = view_macros.find(scene)
    changes = Changes(frozenset({"HAS_NORMAL_MAP"}), {"BRDF_V": "V_HAMMON"})
    reference = view_macros.reference(changes, there)
    assert reference.rungs == {name: default for name, (_, default) in LADDERS.items()}
    assert reference.flipped == {"HAS_NORMAL_MAP"}


@pytest.mark.parametrize(("rung", "shade"), [("L_LOW", 0), ("L_MIDDLE", 100), ("L_HIGH", 200)])
def test_a_rung_is_what_is_drawn(tmp_path, rung, shade):
    path = write_quad(tmp_path, "color.r = float(LEVEL) * 100.0 / 255.0;", LADDER, extra=macros(LEVEL="L_MIDDLE"))
    renderer = Renderer(path, (1, 1), change=lambda p: view_macros.changed(p, Changes(rungs={"LEVEL": rung})))
    renderer.draw()
    assert renderer.picture()[0, 0, 0] == shade


MAPPED = """
#ifndef HAS_ONE_MAP
#define HAS_ONE_MAP 0
#endif
#ifndef HAS_TWO_MAP
#define HAS_TWO_MAP 0
#endif
#if HAS_ONE_MAP + HAS_TWO_MAP > 0
uniform sampler2D map_1;
#endif
#if HAS_ONE_MAP + HAS_TWO_MAP > 1
uniform sampler2D map_2;
#define SECOND map_2
#else
#define SECOND map_1
#endif
#if !HAS_ONE_MAP
uniform vec3 one;
#endif
"""
BODY = """
#if HAS_ONE_MAP
color.rgb = texture(map_1, uv).rgb;
#else
color.rgb = one;
#endif
#if HAS_TWO_MAP
color.b = texture(SECOND, uv).b;
#endif
"""


@pytest.mark.parametrize(
    ("flipped", "color"),
    [
        ((), [255, 0, 10]),
        (("HAS_ONE_MAP",), [128, 128, 10]),  # a half, and the other map keeps its texture
        (("HAS_TWO_MAP",), [255, 0, 0]),
        (("HAS_ONE_MAP", "HAS_TWO_MAP"), [128, 128, 128]),
    ],
)
def test_a_map_that_is_taken_away_leaves_the_others_their_textures(tmp_path, flipped, color):
    write_texture(tmp_path, "one.png", (255, 0, 0))
    write_texture(tmp_path, "two.png", (0, 255, 10))
    path = write_quad(
        tmp_path,
        BODY,
        MAPPED,
        extra=macros(HAS_ONE_MAP="1", HAS_TWO_MAP="1"),
        objects=texture("one.png", 0) + texture("two.png", 1),
    )
    renderer = Renderer(path, (1, 1), change=lambda p: view_macros.changed(p, Changes(frozenset(flipped))))
    renderer.draw()
    assert renderer.picture()[0, 0, :3].tolist() == color
