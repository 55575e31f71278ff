"""Variables that do not fit their uniforms, one at a time in a copy of the project."""

from __future__ import annotations

import pytest

SPRJ, BACK, MATERIAL = "project.sprj", "shaders/backdrop.frag", "shaders/material.glsl"
TOP = '<variable type="float3" name="top_radiance">'
GAIN = '<variable type="float" name="gain" />'
EYE = 'name="camera_position" system="CameraPosition3"'
ITEMS_OF_METALS = "</item>\n      </items>\n      <itemvalues>"


def declared(text: str, use: str = "") -> list[tuple[str, str, str]]:
    """Edits that declare something in backdrop.frag, and use it."""
    place = "layout(location = 0) out vec4 color;"
    return [(BACK, place, f"{place}\n{text}")] + ([(BACK, "tone_map(", f"tone_map({use} * ")] if use else [])


def variable(text: str) -> tuple[str, str, str]:
    return SPRJ, TOP, f"{text}\n{TOP}"


@pytest.mark.parametrize(
    ("code", "edits", "file", "snippet"),
    [
        ("HS201", [(SPRJ, TOP, TOP.replace("float3", "float4"))], SPRJ, "top_radiance"),
        (
            "HS201",
            [*declared("uniform uint gain;", "float(gain)"), variable(GAIN.replace("float", "int"))],
            SPRJ,
            '"gain"',
        ),
        ("HS202", declared("uniform float gain;", "gain"), BACK, " gain;"),
        ("HS203", [variable(GAIN)], SPRJ, '"gain"'),
        ("HS204", [*declared("uniform float gain;"), variable(GAIN)], SPRJ, '"gain"'),
        ("HS205", [(SPRJ, EYE, EYE.replace("CameraPosition3", "Time"))], SPRJ, '"Time"'),
        ("HS205", [(SPRJ, EYE, EYE.replace("CameraPosition3", "Eye"))], SPRJ, '"Eye"'),
        ("HS205", [(SPRJ, TOP, TOP.replace(">", ' function="Rainbow">'))], SPRJ, "Rainbow"),
        ("HS205", [(SPRJ, TOP, TOP.replace(">", ' function="ScalarSin">'))], SPRJ, "ScalarSin"),
        (
            "HS206",
            [(BACK, "uniform vec3 top_radiance;", "uniform vec3 top_radiance = vec3(1.0);")],
            BACK,
            "= vec3(1.0);",
        ),
        ("HS207", [variable('<variable type="float3" name="bottom_radiance" />')], SPRJ, '"bottom_radiance"><row>'),
        (
            "HS208",
            [*declared("uniform float gains[3];", "(gains[0] + gains[2])"), variable(GAIN.replace("gain", "gains[0]"))],
            BACK,
            "gains[3];",
        ),
        (
            "HS209",
            [
                (BACK, "#version 330", "#version 420"),
                *declared("layout(std140, binding = 0) uniform B {\n    float gain;\n};", "gain"),
            ],
            BACK,
            "std140",
        ),
        ("HS210", [(SPRJ, 'variable="roughness" for="Metal1"', 'variable="roughness" for="Metal9"')], SPRJ, "Metal9"),
        ("HS210", [(SPRJ, 'variable="roughness" for="Metal1"', 'variable="gloss" for="Metal1"')], SPRJ, '"gloss"'),
        ("HS210", [(SPRJ, 'variable="roughness" for="Metal1"', 'variable="model" for="Metal1"')], SPRJ, '"model" for'),
        ("HS211", [(SPRJ, "<value>0.085</value>", "<value>0,085</value>")], SPRJ, "0,085"),
        ("HS211", [(SPRJ, f"{TOP}<row>", f"{TOP}<value>1</value><row>")], SPRJ, "top_radiance"),
        ("HS211", [(SPRJ, "<value>0.085</value>", "<value>0.085</value><value>1</value>")], SPRJ, "top_radiance"),
        (
            "HS604",
            [(SPRJ, '<define name="METALNESS"', '<define name="METTLE">1</define>\n<define name="METALNESS"')],
            SPRJ,
            "METTLE",
        ),
    ],
)
def test_a_fault_is_found_in_its_line(scene, code, edits, file, snippet):
    scene.breaks(edits, (code, file, snippet))


def test_a_misspelt_variable_is_two_findings_that_name_each_other(scene):
    scene.breaks(
        [(SPRJ, '"top_radiance"', '"top_radience"')],
        ("HS203", SPRJ, "top_radience"),
        ("HS202", BACK, "vec3 top_radiance"),
    )
    from harness.check import check

    by_code = {f.code: f.message for f in check(scene.project)}
    assert "did you mean top_radiance" in by_code["HS203"]
    assert "did you mean top_radience" in by_code["HS202"]


def test_a_constant_matrix_that_is_inverted_for_several_items(scene):
    item = '<item name="Two" type="model"><filepath>models/teapot_plain.glb</filepath></item>'
    scene.breaks(
        [
            (SPRJ, ITEMS_OF_METALS, ITEMS_OF_METALS.replace("</items>", f"{item}\n</items>")),
            (SPRJ, '"model_inverse" system="GeometryTransform"', '"model_inverse"'),
        ],
        ("HS212", SPRJ, '"model_inverse" invert'),
    )


def test_a_value_of_an_item_for_a_function_crashes_shadered(scene):
    scene.breaks(
        [
            (
                SPRJ,
                '<variable type="float" name="roughness"><row><value>0.5</value></row></variable>',
                '<variable type="float" name="roughness" function="ScalarSin"><row><value>30</value></row></variable>',
            )
        ],
        ("HS004", SPRJ, 'variable="roughness" for="Metal1"'),
    )


def test_any_number_sets_a_bool(scene):
    scene.breaks([*declared("uniform bool gain;", "float(gain)"), variable(GAIN)])


@pytest.mark.parametrize("name", ["gains", "gains[1]"])
def test_of_an_array_the_first_element_alone_is_set(scene, name):
    scene.breaks(
        [
            *declared("uniform float gains[1];", "gains[0]"),
            variable(GAIN.replace("gain", "gains[0]")),
            variable(GAIN.replace("gain", name)),
        ],
        ("HS203", SPRJ, f'"{name}"'),
    )
    from harness.check import check

    assert "gains[0]" in check(scene.project)[0].message


def test_members_of_structs_in_arrays_are_set(scene):
    scene.breaks(
        [
            *declared("struct S { float k; };\nuniform S gains[2];", "gains[0].k * gains[1].k"),
            variable(GAIN.replace("gain", "gains[0].k")),
            variable(GAIN.replace("gain", "gains[1].k")),
        ]
    )
