"""Shaders that one of the two compilers refuses, that do not link, or whose includes are not found, one at a time."""

from __future__ import annotations

import pytest

SPRJ, FRAG, VERT = "project.sprj", "shaders/pbr.frag", "shaders/pbr.vert"
BACK, BACK_VERT = "shaders/backdrop.frag", "shaders/backdrop.vert"
INCLUDE = '#include "color.glsl"'
COLOR = "    color = vec4("


@pytest.mark.parametrize(
    ("code", "edits", "file", "snippet"),
    [
        ("HS101", [(SPRJ, "shaders/backdrop.frag", "shaders/backdrip.frag")], SPRJ, "backdrip"),
        ("HS101", [(SPRJ, '<shader type="ps" path="shaders/backdrop.frag" entry="main" />', "")], SPRJ, '"Backdrop"'),
        ("HS102", [(BACK, "#version 330\n", "// A gradient.\n#version 330\n")], BACK, "#version"),
        ("HS102", [(BACK, "#version 330\n", "\n#version 330\n")], BACK, "#version"),
        ("HS102", [(BACK, "#version 330\n", "\ufeff#version 330\n")], BACK, "#version"),
        ("HS102", [(BACK, "#version 330\n", "")], BACK, "// backdrop"),
        ("HS102", [(BACK, "#version 330\n", "#version 150\n")], BACK, "#version"),
        ("HS102", [(BACK, "#version 330\n", "#version 460\n")], BACK, "#version"),
        ("HS103", [(BACK, "smoothstep", "smoothstop")], BACK, "smoothstop"),
        ("HS103", [("shaders/brdf.glsl", "float W = x * y", "float W = x * yy")], "shaders/brdf.glsl", "yy"),
        (
            "HS103",
            [(SPRJ, '"TONE_CURVE" active="true">', '"TONE_CURVE" active="true">1 + (')],
            "shaders/color.glsl",
            "#if TONE",
        ),
        (
            "HS104",
            [(BACK_VERT, "layout", "#extension GL_GOOGLE_include_directive : require\nlayout")],
            BACK_VERT,
            "require",
        ),
        ("HS106", [(BACK_VERT, "float height", "float hight"), (BACK_VERT, " height =", " hight =")], BACK, "height)"),
        ("HS111", [(SPRJ, 'backdrop.frag" entry="main"', 'backdrop.frag" entry="mine"')], SPRJ, 'entry="mine"'),
    ],
)
def test_a_fault_is_found_in_its_line(scene, code, edits, file, snippet):
    scene.breaks(edits, (code, file, snippet))


def test_stages_that_do_not_link(scene):
    scene.breaks(
        [
            (FRAG, "in vec3 world_tangent", "in vec4 world_tangent"),
            (FRAG, " world_tangent,", " world_tangent.xyz,", -1),
        ],
        ("HS105", FRAG, "in vec4 world_tangent"),
    )


def test_blank_lines_above_the_version_are_a_warning(scene):
    from harness.check import check

    scene.replace(BACK, "#version 330\n", "\n#version 330\n")
    assert [f.severity for f in check(scene.project)] == ["warning"]
    scene.replace(BACK, "\n#version 330\n", "// A gradient.\n#version 330\n")
    assert [f.severity for f in check(scene.project)] == ["error"]


def test_a_shader_in_another_language_is_left_out(scene):
    scene.write("shaders/backdrop.hlsl", "float4 main() : SV_Target { return 1; }\n")
    scene.breaks([(SPRJ, "backdrop.frag", "backdrop.hlsl")], ("HS112", SPRJ, "backdrop.hlsl"))


def test_a_cascade_of_errors_in_a_line_is_one_finding(scene):
    scene.breaks([(BACK, "vec4(linear_to_srgb(", "vec4(linear_to_rgb(")], ("HS103", BACK, "linear_to_rgb"))


# ---- Includes --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("code", "edits", "file", "snippet"),
    [
        ("HS107", [(FRAG, '"normal_map.glsl"', '"normal_mop.glsl"')], FRAG, "normal_mop"),
        ("HS107", [(BACK, INCLUDE, f'{INCLUDE}\n#include ""')], BACK, '#include ""'),
        ("HS107", [(BACK, INCLUDE, f"{INCLUDE}\n#include <>")], BACK, "#include <>"),
        ("HS109", [(BACK, INCLUDE, f"  {INCLUDE}")], BACK, INCLUDE),
        ("HS109", [(BACK, INCLUDE, '# include "color.glsl"')], BACK, "# include"),
        ("HS109", [(BACK, "#extension GL_GOOGLE_include_directive : enable", "")], BACK, INCLUDE),
        ("HS109", [(BACK, "directive : enable", "directive : require")], BACK, INCLUDE),
        (
            "HS109",
            [(BACK, "#extension GL_GOOGLE_include_directive", "#extension GL_ARB_shading_language_include")],
            BACK,
            INCLUDE,
        ),
        ("HS109", [(BACK, INCLUDE, f"#if 0\n{INCLUDE}\n#else\n{INCLUDE} // in\n#endif")], BACK, "// in"),
        ("HS109", [("shaders/color.glsl", "// color.glsl", "\ufeff// color.glsl")], "shaders/color.glsl", "color.glsl"),
        ("HS110", [(BACK, "#ifdef GL_GOOGLE_include_directive\n", "#if 1\n")], BACK, "#extension"),
    ],
)
def test_an_include_that_a_compiler_does_not_take(scene, code, edits, file, snippet):
    if file == "shaders/color.glsl":  # which another pass includes through material.glsl; its BOM is one fault
        edits = [
            *edits,
            (SPRJ, '<pass name="Metals" type="shader" active="true">', '<pass name="Metals" active="false">'),
        ]
        edits += [
            (
                SPRJ,
                '<pass name="Painted metal" type="shader" active="true">',
                '<pass name="Painted metal" active="false">',
            )
        ]
    scene.breaks(edits, (code, file, snippet))


def test_an_include_without_an_end_of_line(scene):
    scene.write("shaders/extra.glsl", INCLUDE)
    scene.replace("shaders/extra.glsl", INCLUDE, INCLUDE)
    scene.breaks([(BACK, INCLUDE, '#include "extra.glsl"')], ("HS109", "shaders/extra.glsl", INCLUDE))


def test_an_include_that_lies_beside_the_shader_alone(scene):
    scene.write("lib/tone.glsl", '#include "gone.glsl"\n')
    scene.write("lib/backdrop.frag", (scene.folder / BACK).read_text())
    scene.breaks(
        [(SPRJ, BACK, "lib/backdrop.frag"), ("lib/backdrop.frag", INCLUDE, f'{INCLUDE}\n#include "tone.glsl"')],
        ("HS108", "lib/backdrop.frag", "tone.glsl"),
        ("HS107", "lib/tone.glsl", "gone.glsl"),
    )


def test_an_include_that_is_two_files(scene):
    scene.write("color.glsl", (scene.folder / "shaders/color.glsl").read_text())
    assert {code for code, _, _ in scene.found()} == {"HS108"}


def test_includes_that_are_not_reached_may_take_any_form(scene):
    scene.breaks([(BACK, INCLUDE, f'{INCLUDE}\n#if 0\n  #include "gone.glsl"\n#endif\n// #include "gone.glsl"')])


# ---- Loops -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "loop",
    [
        "float k = 0.0;\n    while (k < 1.0) { // here\n        k += 0.0;\n    }",
        "for (int k = 0; k < 2; ) { // here\n    }",
        "float k = 4.0;\n    while (k > 1.0) { // here\n        k -= 0.0;\n    }",
        "while (true) { // here\n    }",
        "float k = 0.0;\n    do {\n    } while (k < 1.0); // here",
    ],
)
def test_a_loop_that_never_ends(scene, loop):
    scene.breaks([(BACK, COLOR, f"    {loop}\n{COLOR}")], ("HS113", BACK, "// here"))


@pytest.mark.parametrize(
    "loop",
    [
        "for (int k = 0; k < 4; k++) {\n    }",
        "float k = 0.0;\n    while (k < 1.0) {\n        k += 0.5;\n    }",
        "while (true) {\n        break;\n    }",
        "int k = 3;\n    do {\n        --k;\n    } while (k > 0);",
        "float k = 1.0;\n    for (; k < 4.0; ) k *= 2.0;",
    ],
)
def test_a_loop_that_ends(scene, loop):
    scene.breaks([(BACK, COLOR, f"    {loop}\n{COLOR}")])
