"""The renderer: what reaches the framebuffer, how it becomes a picture, and what is refused on the way."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from sprj_files import QUAD_ITEM, QUAD_VERT, line_of, shader_pass, write_project, write_quad

from harness import GlslError, HarnessError, ProjectError, native, sprj, textures
from harness.native import gl_enums
from harness.picture import write_png
from harness.prepare import declared_samplers, prepare
from harness.project import SYSTEM_TYPES, Geometry
from harness.render import draw, render, render_floats

SIZE = (4, 3)
IDENTITY = np.eye(4, dtype=np.float32)


def variables(*elements: str) -> str:
    return "<variables>" + "".join(elements) + "</variables>"


def constant(name: str, glsl_type: str, *values: object) -> str:
    row = "".join(f"<value>{v}</value>" for v in values)
    return f'<variable type="{glsl_type}" name="{name}"><row>{row}</row></variable>'


def first_floats(path, size=SIZE) -> np.ndarray:
    """The floats of one pixel."""
    return render_floats(path, size)[0, 0]


def write_texture(folder, name: str, color: tuple[int, ...] = (255, 0, 0)) -> None:
    Image.new("RGBA" if len(color) == 4 else "RGB", (1, 1), color).save(folder / name)


def texture(path: str, slot: int = 0, name: str = "Quad", more: str = "") -> str:
    return f'<object type="texture" path="{path}" {more}><bind slot="{slot}" name="{name}" /></object>\n'


# ---- From the framebuffer to the picture -----------------------------------------------------------------


@pytest.mark.parametrize(
    "value, byte", [("0.5", 128), ("0.25", 64), ("1.5", 255), ("-1.0", 0), ("1.0 / zero", 255), ("zero / zero", 0)]
)
def test_bytes_are_clamped_and_rounded(tmp_path, value, byte):
    # 0.5 * 255 = 127.5 and 0.25 * 255 = 63.75; the last two are infinity and NaN.
    path = write_quad(tmp_path, f"color = vec4({value});", "uniform float zero;")
    assert (render(path, SIZE)[..., :3] == byte).all()


@pytest.mark.parametrize(
    "value, expected", [("7.5", 7.5), ("-2.0", -2), ("1.0 / zero", np.inf), ("zero / zero", np.nan)]
)
def test_floats_are_as_drawn(tmp_path, value, expected):
    path = write_quad(tmp_path, f"color = vec4({value});", "uniform float zero;")
    np.testing.assert_array_equal(first_floats(path)[:3], [expected] * 3)


def test_the_top_row_comes_first(tmp_path):
    picture = render(write_quad(tmp_path, "color = vec4(uv.y);"), (2, 2))
    assert picture[0, 0, 0] == 191 and picture[1, 0, 0] == 64


@pytest.mark.parametrize("shape", [(1280, 720), (1, 1), (3, 5)])
def test_shape_and_type(tmp_path, shape):
    picture = render(write_quad(tmp_path, ""), shape)
    assert picture.shape == (shape[1], shape[0], 4) and picture.dtype == np.uint8


def test_alpha_is_opaque_by_default(tmp_path):
    assert (render(write_quad(tmp_path, "color = vec4(0.2);"), SIZE)[..., 3] == 255).all()


def test_alpha_of_the_shader_with_usealpha(tmp_path):
    path = write_quad(tmp_path, "color = vec4(0.2);", settings='<entry type="usealpha" val="true" />')
    assert (render(path, SIZE)[..., 3] == 51).all()


def test_clear_colour_where_nothing_is_drawn(tmp_path):
    settings = '<entry type="clearcolor" r="0.2" g="0.4" b="0.6" a="0.8" /><entry type="usealpha" val="true" />'
    path = write_quad(tmp_path, "discard;", settings=settings)
    assert (render(path, SIZE) == (51, 102, 153, 204)).all()


def test_without_a_pass_the_picture_is_black_whatever_the_clear_colour(tmp_path):
    path = write_project(tmp_path, "", settings='<entry type="clearcolor" r="1" g="1" b="1" a="1" />')
    assert (render(path, SIZE) == (0, 0, 0, 255)).all()


def test_supersampling_takes_the_rounded_mean_of_bytes(tmp_path):
    path = write_quad(tmp_path, "color = vec4(fract(uv * 7.3), uv.x * uv.y * 4.0, 1.0);")
    fine = render(path, (12, 9)).astype(float).reshape(3, 3, 4, 3, 4).mean(axis=(1, 3))
    np.testing.assert_array_equal(render(path, SIZE, supersample=3), np.floor(fine + 0.5))


def test_supersampling_by_1_changes_nothing(tmp_path):
    path = write_quad(tmp_path, "")
    np.testing.assert_array_equal(render(path, SIZE, supersample=1), render(path, SIZE))


@pytest.mark.parametrize("size, supersample", [((0, 3), 1), ((4, -1), 1), ((4, 3), 0)])
def test_sizes_that_are_none(tmp_path, size, supersample):
    with pytest.raises(ValueError, match="pixels"):
        render(write_quad(tmp_path, ""), size, supersample)


def test_rendering_twice_gives_the_same_picture(root):
    project = root / "tests" / "conformance" / "44-pbr-model" / "project.sprj"
    np.testing.assert_array_equal(render(project, (64, 48)), render(project, (64, 48)))


# ---- Uniforms --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "system, glsl, read, expected",
    [
        ("Time", "float", "vec4(v)", (0, 0, 0, 0)),
        ("TimeDelta", "float", "vec4(v)", [1 / 60] * 4),
        ("FrameIndex", "int", "vec4(float(v))", (0, 0, 0, 0)),
        ("ViewportSize", "vec2", "v.xyxy", (4, 3, 4, 3)),
        ("MousePosition", "vec2", "v.xyxy", (0, 0, 0, 0)),
        ("Mouse", "vec4", "v", (0, 0, 0, 0)),
        ("MouseButton", "vec4", "v", (0, 0, 0, 0)),
        ("IsPicked", "bool", "vec4(float(v))", (0, 0, 0, 0)),
        ("IsSavingToFile", "bool", "vec4(float(v))", (1, 1, 1, 1)),
        ("CameraPosition", "vec4", "v", (0, 0, -6, 1)),
        ("CameraPosition3", "vec3", "v.xyzz", (0, 0, -6, -6)),
        ("CameraDirection3", "vec3", "v.xyzz", (0, 0, 6, 6)),
        ("KeysWASD", "ivec4", "vec4(v)", (0, 0, 0, 0)),
        ("PickPosition", "vec3", "v.xyzz", (0, 0, 0, 0)),
        # The camera is 6 away on -z: it sees (0, 0, 0) at depth 6, and x turned round.
        ("View", "mat4", "v * vec4(1.0, 2.0, 0.0, 1.0)", (-1, 2, -6, 1)),
        # m11 = 1 / tan 22.5 degrees = 2.41421, m00 = m11 / (4/3)
        ("Projection", "mat4", "vec4(v[0][0], v[1][1], v[2][3], v[3][3])", (1.81066, 2.41421, -1, 0)),
        ("ViewProjection", "mat4", "v * vec4(1.0, 1.0, 0.0, 1.0)", (-1.81066, 2.41421, 5.8012, 6)),
        ("Orthographic", "mat4", "v * vec4(4.0, 3.0, -0.1, 1.0)", (1, -1, -1, 1)),
        ("ViewOrthographic", "mat4", "vec4(v[0][0], v[1][1], v[2][2], v[3][3])", (-0.5, -2 / 3, 0.0020002, 1)),
        ("GeometryTransform", "mat4", "v * vec4(1.0)", (3, 1, 1, 1)),
    ],
)
def test_system_values(tmp_path, system, glsl, read, expected):
    settings = """<entry type="usealpha" val="true" /><entry type="camera" fp="false"><distance>6</distance>
<pitch>0</pitch><yaw>0</yaw><roll>0</roll></entry>"""
    extra = variables(f'<variable type="{SYSTEM_TYPES[system]}" name="v" system="{system}" />')
    path = write_quad(tmp_path, f"color = {read};", f"uniform {glsl} v;", extra=extra, settings=settings)
    path.write_text(path.read_text().replace("<type>ScreenQuadNDC</type>", "<type>ScreenQuadNDC</type><x>2</x>"))
    np.testing.assert_allclose(first_floats(path), expected, atol=1e-4)


def test_invert_gives_the_inverse_of_the_item_s_matrix(tmp_path):
    extra = variables(
        '<variable type="float4x4" name="m" system="GeometryTransform" />',
        '<variable type="float4x4" name="i" system="GeometryTransform" invert="true" />',
    )
    read = "mat4 p = m * i; color = vec4(p[0][0], p[1][2], p[3][1], i[3][0]);"
    path = write_quad(tmp_path, read, "uniform mat4 m, i;", extra=extra)
    turned = "<type>ScreenQuadNDC</type><x>2</x><scaleX>4</scaleX>"
    path.write_text(path.read_text().replace("<type>ScreenQuadNDC</type>", turned))
    np.testing.assert_allclose(first_floats(path)[:3], (1, 0, 0), atol=1e-6)


def test_of_two_variables_of_one_name_the_later_holds(tmp_path):
    extra = variables(constant("v", "float", 1), constant("v", "float", 2))
    assert first_floats(write_quad(tmp_path, "color = vec4(v);", "uniform float v;", extra=extra))[0] == 2


def test_of_an_array_the_first_element_is_set(tmp_path):
    extra = variables(constant("v[0]", "float", 5))
    read = "color = vec4(v[0], v[1], v[int(uv.x)], 1.0);"
    path = write_quad(tmp_path, read, "uniform float v[3];", extra=extra)
    np.testing.assert_array_equal(first_floats(path)[:3], (5, 0, 5))


def test_a_variable_that_no_shader_has_is_harmless(tmp_path):
    path = write_quad(tmp_path, "", extra=variables(constant("nothing", "float3", 1, 2, 3)))
    assert render(path, SIZE).any()


def test_an_initialiser_holds_without_a_variable(tmp_path):
    assert first_floats(write_quad(tmp_path, "color = vec4(v);", "uniform float v = 0.5;"))[0] == 0.5


def test_an_item_s_value_holds_for_that_item_only(tmp_path):
    # Three thirds of the picture, one item each, drawn in order; the second has a value of its own.
    vert = QUAD_VERT.replace("uniform", "").replace("void main", "uniform mat4 model;\nvoid main")
    vert = vert.replace("vec4(position, 0.0, 1.0)", "model * vec4(position, 0.0, 1.0)")
    items = "".join(
        f'<item name="I{n}" type="geometry"><type>ScreenQuadNDC</type><scaleX>0.3</scaleX><x>{x}</x></item>'
        for n, x in enumerate((-0.66, 0, 0.66))
    )
    extra = variables('<variable type="float4x4" name="model" system="GeometryTransform" />', constant("v", "float", 1))
    extra += '<itemvalues><value variable="v" for="I1"><row><value>2</value></row></value></itemvalues>'
    write_quad(tmp_path, "color = vec4(v);", "uniform float v;")
    (tmp_path / "quad.vert").write_text(vert)
    path = write_project(tmp_path, shader_pass(items=items, extra=extra))
    np.testing.assert_array_equal(render_floats(path, (3, 1))[0, :, 0], (1, 2, 1))


@pytest.mark.parametrize(
    "project_type, glsl_type",
    [("float", "vec3"), ("int", "float"), ("float", "int"), ("int", "uint"), ("bool", "int"), ("float3x3", "mat4")],
)
def test_a_type_that_is_not_the_shader_s_is_refused(tmp_path, project_type, glsl_type):
    zero = f"{glsl_type}(0)"
    path = write_quad(
        tmp_path,
        f"color = vec4(v == {zero});",
        f"uniform {glsl_type} v;",
        extra="\n" + variables(f'<variable type="{project_type}" name="v" />'),
    )
    with pytest.raises(ProjectError) as caught:
        render(path, SIZE)
    message = caught.value.message
    assert message.startswith(f'pass "Quad": variable "v" has type {project_type}, ')
    assert message.endswith(f"but the shader's uniform is {glsl_type}")
    assert caught.value.line == line_of(path, 'name="v"')


def test_macros_reach_both_stages(tmp_path):
    write_quad(tmp_path, "color = vec4(LEVEL, from_vertex, float(SHADERED_VERSION), 1.0);", "in float from_vertex;")
    vert = QUAD_VERT.replace("out vec2 uv;", "out vec2 uv;\nout float from_vertex;")
    (tmp_path / "quad.vert").write_text(vert.replace("uv = texcoord;", "uv = texcoord;\nfrom_vertex = 2.0 * LEVEL;"))
    extra = '<macros><define name="LEVEL">3.0</define></macros>'
    path = write_project(tmp_path, shader_pass(extra=extra))
    np.testing.assert_array_equal(first_floats(path)[:3], (3, 6, 1005005))


# ---- Textures --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, names",
    [
        ("uniform sampler2D a;\nuniform sampler2D b;", ["a", "b"]),
        ("// uniform sampler2D a;\nuniform sampler2D b;", ["a", "b"]),
        ("#if 0\nuniform sampler2D a;\n#endif", ["a"]),
        ("uniform isampler2D a;\nuniform samplerCube b;", ["a", "b"]),
        ("uniform sampler2D a; // a trailing comment", ["a"]),
        ("uniform sampler2D a;\r\nuniform sampler2D b;\r\n", ["a", "b"]),
        ("vec4 f(sampler2D s)\n{\n", []),
        # These break a slot: the name is none, but the place is taken.
        ("vec4 f(sampler2D s, vec2 uv);\nuniform sampler2D a;", ["s, vec2 uv)", "a"]),
        ("uniform sampler2D a, b;", ["a, b"]),
        ("uniform sampler2D a[2];", ["a[2]"]),
        ("uniform sampler2D a; uniform sampler2D b;", ["a; uniform sampler2D b"]),
        ("uniform sampler2D a; // why;", ["a; // why"]),
        ("uniform sampler2D  a;", [" a"]),
        ("uniform sampler2D a ;", ["a "]),
    ],
)
def test_samplers_are_found_as_shadered_finds_them(text, names):
    assert declared_samplers(text) == names


def test_textures_go_to_samplers_by_slot_without_gaps(tmp_path):
    colors = {"a.png": (255, 0, 0), "b.png": (0, 255, 0), "c.png": (0, 0, 255)}
    for name, color in colors.items():
        write_texture(tmp_path, name, color)
    declarations = "uniform sampler2D x;\nuniform sampler2D y;\nuniform sampler2D z;"
    path = write_quad(
        tmp_path,
        "color = vec4(texture(z, uv).b, texture(x, uv).r, texture(y, uv).g, 1.0);",
        declarations,
        objects=texture("c.png", 7) + texture("a.png", 1) + texture("b.png", 4),
    )
    np.testing.assert_array_equal(first_floats(path)[:3], (1, 1, 1))


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


def test_a_sampler_without_a_texture_is_refused(tmp_path):
    path = write_quad(tmp_path, "color = texture(t, uv);", "uniform sampler2D t;")
    with pytest.raises(ProjectError, match='pass "Quad": no texture goes to the sampler "t"'):
        render(path, SIZE)


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
    monkeypatch.setattr("harness.textures.MOST_PIXELS", 1)
    for name in ("a.png", "b.png"):
        write_texture(tmp_path, name)
    path = write_quad(tmp_path, "", objects=texture("a.png") + texture("b.png", 1))
    with pytest.raises(ProjectError, match='"b.png">: more than 1 pixels of textures in all'):
        render(path, SIZE)


# ---- Shaders and models ----------------------------------------------------------------------------------


def test_a_missing_shader(tmp_path):
    path = write_quad(tmp_path, "")
    (tmp_path / "quad.frag").unlink()
    with pytest.raises(ProjectError) as caught:
        render(path, SIZE)
    assert caught.value.message == '<shader type="ps"> of pass "Quad": there is no file "quad.frag"'
    assert caught.value.line == line_of(path, 'type="ps"')


def test_a_syntax_error_names_the_shader_s_line_and_the_pass(tmp_path):
    path = write_quad(tmp_path, "color = vec4(0.5;")
    with pytest.raises(GlslError) as caught:
        render(path, SIZE)
    assert caught.value.file.endswith("quad.frag")
    assert caught.value.line == line_of(tmp_path / "quad.frag", "vec4(0.5;")
    assert '(in pass "Quad")' in caught.value.message


def test_a_link_error_names_the_varying_and_the_pass(tmp_path):
    path = write_quad(tmp_path, "")
    frag = tmp_path / "quad.frag"
    frag.write_text(frag.read_text().replace("in vec2 uv;", "in vec3 uv;").replace("vec4(uv, 0.0", "vec4(uv"))
    with pytest.raises(GlslError) as caught:
        render(path, SIZE)
    assert "`uv'" in caught.value.message and '(in pass "Quad")' in caught.value.message


def model_project(folder, filepath: str):
    write_quad(folder, "")
    items = f'<item name="Pot" type="model"><filepath>{filepath}</filepath></item>'
    return write_project(folder, shader_pass(items=items))


def test_a_missing_model(tmp_path):
    path = model_project(tmp_path, "models\\gone.glb")
    with pytest.raises(ProjectError) as caught:
        render(path, SIZE)
    assert caught.value.message == ('<item type="model"> "Pot" of pass "Quad": there is no file "models/gone.glb"')
    assert caught.value.line == line_of(path, '"Pot"')


def test_a_model_that_is_none_says_nothing_of_its_content(tmp_path):
    (tmp_path / "secret.txt").write_text("the secret")
    path = model_project(tmp_path, "secret.txt")
    with pytest.raises(ProjectError, match='"Pot" of pass "Quad": cannot read the model "secret.txt"') as caught:
        render(path, SIZE)
    assert "the secret" not in str(caught.value)


# ---- What tests of projects look at ----------------------------------------------------------------------


def test_a_prepared_pass_shows_what_is_active(tmp_path):
    write_texture(tmp_path, "t.png")
    path = write_quad(
        tmp_path,
        "color = texture(t, uv) * level;",
        "uniform sampler2D t;\nuniform float level;\nuniform float unused;",
        extra=variables(constant("level", "float", 1), constant("unused", "float", 1)),
        objects=texture("t.png"),
    )
    (prepared,) = prepare(sprj.read(path))
    assert set(prepared.program.uniforms) == {"t", "level"}
    assert set(prepared.program.attributes) == {"position", "texcoord"}
    assert [v.name for v in prepared.uniforms.variables] == ["level"]
    assert [(b.unit, b.sampler, b.object.path) for b in prepared.textures] == [(0, "t", "t.png")]
    assert "uniform sampler2D t;" in prepared.fragment.text


def test_a_texture_beyond_the_declared_samplers_shows(tmp_path):
    for name in ("a.png", "b.png"):
        write_texture(tmp_path, name)
    path = write_quad(
        tmp_path,
        "color = texture(t, uv);",
        "uniform sampler2D t;",
        objects=texture("a.png") + texture("b.png", 1),
    )
    (prepared,) = prepare(sprj.read(path))
    assert [b.sampler for b in prepared.textures] == ["t", None]


def test_files_are_loaded_once(root, monkeypatch):
    loaded = []
    load, read = native.Mesh.load, textures.read
    monkeypatch.setattr(native.Mesh, "load", lambda path: loaded.append(path.name) or load(path))
    monkeypatch.setattr(textures, "read", lambda path, **how: loaded.append(path.name) or read(path, **how))
    prepare(sprj.read(root / "project.sprj"))
    assert loaded and sorted(loaded) == sorted(set(loaded))


def test_prepared_passes_draw_at_any_size(tmp_path):
    path = write_quad(tmp_path, "")
    project = sprj.read(path)
    passes = prepare(project)
    for size in (SIZE, (8, 2)):
        np.testing.assert_array_equal(draw(project, passes, *size).read_bytes()[::-1], render(path, size))


def test_a_quad_ignores_the_input_layout(tmp_path):
    extra = '<inputlayout><item value="Normal" /><item value="Color" /></inputlayout>'
    path = write_quad(tmp_path, "color = vec4(uv, 0.0, 1.0);", extra=extra)
    np.testing.assert_array_equal(render(path, (1, 1)), [[[128, 128, 0, 255]]])


def test_two_items_of_a_shape_share_its_mesh(tmp_path):
    write_quad(tmp_path, "")
    items = QUAD_ITEM.format(name="A") + QUAD_ITEM.format(name="B")
    (prepared,) = prepare(sprj.read(write_project(tmp_path, shader_pass(items=items))))
    assert prepared.items[0].mesh is prepared.items[1].mesh


def test_the_passes_of_the_project_use_all_that_they_are_given(root):
    for prepared in prepare(sprj.read(root / "project.sprj")):
        samplers = {name for name, v in prepared.program.uniforms.items() if v.type == gl_enums.GL_SAMPLER_2D}
        assert {b.sampler for b in prepared.textures} == samplers
        used = {v.location for v in prepared.program.attributes.values() if v.location >= 0}
        for item in prepared.items:
            full_screen = isinstance(item.item, Geometry) and item.item.shape == "ScreenQuadNDC"
            assert full_screen or used == set(range(len(item.fields)))
        assert {v.name for v in prepared.uniforms.variables} == {v.name for v in prepared.shader_pass.variables}
        assert {v.name for v in prepared.shader_pass.variables} == set(prepared.program.uniforms) - samplers


# ---- Pictures on disk ------------------------------------------------------------------------------------


def test_a_png_holds_the_pixels(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 4), np.uint8)
    write_png(tmp_path / "p.png", pixels)
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "p.png")), pixels)


def test_nothing_but_the_picture_is_left(tmp_path):
    write_png(tmp_path / "p.png", np.zeros((2, 2, 4), np.uint8))
    assert [p.name for p in tmp_path.iterdir()] == ["p.png"]


def test_a_picture_that_fails_leaves_the_old_one(tmp_path):
    (tmp_path / "p.png").write_bytes(b"old")
    with pytest.raises(TypeError):
        write_png(tmp_path / "p.png", np.zeros((2, 2, 7), np.uint8))
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("p.png", b"old")]


def test_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(HarnessError, match="cannot write the file"):
        write_png(tmp_path / "gone" / "p.png", np.zeros((2, 2, 4), np.uint8))
