"""Textures that are missing, turned or decoded wrongly, one at a time in a copy of the project."""

from __future__ import annotations

import pytest

SPRJ, MATERIAL, BRDF = "project.sprj", "shaders/material.glsl", "shaders/brdf.glsl"
SET = "textures/PaintedMetal_1K-PNG_"
ALBEDO = "srgb_to_linear(texture(ALBEDO_MAP, uv).rgb)"
ROUGHNESS = "texture(ROUGHNESS_MAP, uv).r"
NORMAL_BIND = '<bind slot="3" name="Painted metal" />'


@pytest.mark.parametrize(
    ("code", "edits", "file", "snippet"),
    [
        ("HS401", [(SPRJ, f'path="{SET}Color.png"', f'path="{SET}Colour.png"')], SPRJ, "Colour"),
        ("HS401", [(SPRJ, f'path="{SET}Color.png"', f'path=" {SET}Color.png"')], SPRJ, f'" {SET}'),
        ("HS402", [(SPRJ, f'path="{SET}Color.png"', 'path="shaders/brdf.glsl"')], SPRJ, "brdf.glsl"),
        ("HS403", [(SPRJ, f'path="{SET}Color.png" vflip="true"', f'path="{SET}Color.png"')], SPRJ, f"{SET}Color"),
        ("HS404", [(MATERIAL, ALBEDO, "texture(ALBEDO_MAP, uv).rgb")], MATERIAL, "texture(ALBEDO"),
        (
            "HS405",
            [(MATERIAL, ROUGHNESS, "srgb_to_linear(texture(ROUGHNESS_MAP, uv).rgb).r")],
            MATERIAL,
            "texture(ROUGH",
        ),
        ("HS405", [(MATERIAL, ROUGHNESS, f"pow({ROUGHNESS}, 2.2)")], MATERIAL, "texture(ROUGH"),
        ("HS406", [(MATERIAL, ALBEDO, f"pow({ALBEDO}, vec3(2.2))")], MATERIAL, "texture(ALBEDO"),
        ("HS406", [(MATERIAL, ALBEDO, f"srgb_to_linear({ALBEDO})")], MATERIAL, "texture(ALBEDO"),
        (
            "HS406",
            [(MATERIAL, f"m.albedo = {ALBEDO};", f"vec3 stored = {ALBEDO};\n    m.albedo = srgb_to_linear(stored);")],
            MATERIAL,
            "texture(ALBEDO",
        ),
        (
            "HS406",
            [
                (
                    MATERIAL,
                    "Material material_at",
                    "vec3 f(vec3 x) { return srgb_to_linear(x); }\nMaterial material_at",
                ),
                (MATERIAL, ALBEDO, f"f({ALBEDO})"),
            ],
            MATERIAL,
            "texture(ALBEDO",
        ),
        ("HS407", [(SPRJ, f"{SET}NormalGL", f"{SET}NormalDX")], SPRJ, NORMAL_BIND),
        (
            "HS407",
            [
                (
                    SPRJ,
                    '<define name="HAS_NORMAL_MAP"',
                    '<define name="NORMAL_MAP_DX">1</define>\n<define name="HAS_NORMAL_MAP"',
                )
            ],
            SPRJ,
            NORMAL_BIND,
        ),
    ],
)
def test_a_fault_is_found_in_its_line(scene, code, edits, file, snippet):
    scene.breaks(edits, (code, file, snippet))


@pytest.mark.parametrize(
    "edits",
    [
        [(MATERIAL, ALBEDO, "pow(texture(ALBEDO_MAP, uv).rgb, vec3(2.2))")],
        [
            (
                MATERIAL,
                f"m.albedo = {ALBEDO};",
                "vec3 c = texture(ALBEDO_MAP, uv).rgb;\n    m.albedo = srgb_to_linear(c);",
            )
        ],
        [
            (
                MATERIAL,
                "Material material_at",
                "#if HAS_ALBEDO_MAP\nvec3 read(vec2 at) { return texture(ALBEDO_MAP, at).rgb; }\n#endif\n"
                "Material material_at",
            ),
            (MATERIAL, ALBEDO, "srgb_to_linear(read(uv))"),
        ],
        [
            (
                MATERIAL,
                "Material material_at",
                "vec3 f(vec3 stored) { return srgb_to_linear(stored); }\nMaterial material_at",
            ),
            (MATERIAL, ALBEDO, "f(texture(ALBEDO_MAP, uv).rgb)"),
        ],
        [
            (MATERIAL, "Material material_at", "const float GAMMA = 2.2;\nMaterial material_at"),
            (MATERIAL, ALBEDO, "pow(texture(ALBEDO_MAP, uv).rgb, vec3(GAMMA))"),
        ],
        [(MATERIAL, ROUGHNESS, f"pow({ROUGHNESS}, 0.5)")],
        [
            (SPRJ, f"{SET}NormalGL", f"{SET}NormalDX"),
            (
                SPRJ,
                '<define name="HAS_NORMAL_MAP"',
                '<define name="NORMAL_MAP_DX">1</define>\n<define name="HAS_NORMAL_MAP"',
            ),
        ],
    ],
    ids=["pow", "variable", "function", "parameter", "constant", "other power", "DX"],
)
def test_what_is_done_in_another_way_is_fine(scene, edits):
    scene.breaks(edits)


def test_a_picture_that_is_shown_as_it_is_needs_no_decoding(scene):
    """The included color.glsl could encode, but nothing calls it."""
    back = "shaders/backdrop.frag"
    scene.write("textures/Sky_Color.png", (scene.folder / f"{SET}Color.png").read_bytes())
    text = (scene.folder / back).read_text()
    shown = "    color = texture(sky, vec2(height)) + 0.1 * vec4(top_radiance + bottom_radiance, 0.0);\n}\n"
    scene.write(back, text[: text.index("    color =")] + shown)
    sky = '<object type="texture" path="textures/Sky_Color.png"><bind slot="0" name="Backdrop" /></object>'
    scene.breaks(
        [
            (back, "in float height;", "in float height;\nuniform sampler2D sky;"),
            (SPRJ, "</objects>", f"{sky}\n</objects>"),
        ]
    )
    scene.replace(
        back, "color = texture(sky, vec2(height))", "color.rgb = linear_to_srgb(texture(sky, vec2(height)).rgb)"
    )
    scene.replace(
        back, " + 0.1 * vec4(top_radiance + bottom_radiance, 0.0)", " + 0.1 * (top_radiance + bottom_radiance)"
    )
    assert [code for code, _, _ in scene.found()] == ["HS404"]


def test_a_truncated_file(scene):
    path = scene.folder / f"{SET}Color.png"
    scene.write(f"{SET}Color.png", path.read_bytes()[:300])
    assert scene.found() == [("HS402", SPRJ, scene.line(SPRJ, f"{SET}Color.png"))]


def test_a_texture_that_is_upside_down_alike_may_have_either_vflip(scene):
    from PIL import Image

    half = Image.open(scene.folder / f"{SET}Color.png").crop((0, 0, 16, 8))
    whole = Image.new("RGB", (16, 16))
    whole.paste(half, (0, 0))
    whole.paste(half.transpose(Image.Transpose.FLIP_TOP_BOTTOM), (0, 8))
    whole.save(scene.folder / f"{SET}Color.png")
    scene.breaks([(SPRJ, f'path="{SET}Color.png" vflip="true"', f'path="{SET}Color.png"')])


@pytest.mark.parametrize(
    ("path", "role"),
    [
        ("textures/PaintedMetal_1K-PNG_Color.png", "colour"),
        ("textures/PaintedMetal_1K-PNG_NormalGL.png", "normal"),
        ("textures/rusty_metal_diff_2k.jpg", "colour"),
        ("textures/rusty_metal_nor_gl_2k.png", "normal"),
        ("textures/rusty_metal_rough_2k.png", "roughness"),
        ("wood_BaseColor.tga", "colour"),
        ("copper-metallic.png", "metalness"),
        ("albedo.png", "colour"),
        ("normal.png", "normal"),
        ("noise.png", None),
        ("a.png", None),
    ],
)
def test_roles_by_names(path, role):
    from harness.check import roles

    assert roles.of_file(path) == role


def test_the_roles_of_the_project_s_samplers(root):
    from harness.check import flow, renderer
    from harness.language import glsl
    from harness.native import Stage

    defines = {f"HAS_{m}_MAP": "1" for m in ("ALBEDO", "ROUGHNESS", "METALNESS", "NORMAL")}
    source = glsl.load(root / "shaders/pbr.frag", defines, [root / "shaders"])
    text = renderer.preprocess(Stage.FRAGMENT, source.text)
    assert [flow.role(text, f"map_{k}") for k in (1, 2, 3, 4)] == ["colour", "roughness", "metalness", "normal"]
    assert [flow.decodes(text, f"map_{k}") for k in (1, 2, 3, 4)] == [1, 0, 0, 0]


def test_long_ways_of_a_colour_are_followed_in_time():
    """Each line reads the variable of the line before twice: ways grow as powers of two, places do not."""
    from harness.check import flow

    lines = "".join(f"vec3 c{k + 1} = c{k} + c{k} * 0.5;\n" for k in range(60))
    text = f"void main() {{\nvec3 c0 = texture(map, uv).rgb;\n{lines}vec3 d = srgb_to_linear(c60);\n}}\n"
    text = "vec3 srgb_to_linear(vec3 c) { return c * c; }\n" + text
    assert flow.decodes(text, "map") == 1
    assert flow.decodes(text, "other") is None
