"""Passes ready to draw: what is active, which texture went where, what is loaded how often."""

from __future__ import annotations

import numpy as np
import pytest
from sprj_files import (
    QUAD_ITEM,
    SIZE,
    constant,
    drawn,
    first_floats,
    line_of,
    shader_pass,
    texture,
    variables,
    write_project,
    write_quad,
    write_texture,
)

from harness import GlslError, ProjectError, native
from harness.native import gl_enums
from harness.projects import sprj
from harness.projects.project import Geometry
from harness.rendering import textures
from harness.rendering.prepare import declared_samplers, prepare
from harness.rendering.render import Renderer, draw, render


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


def test_a_sampler_without_a_texture_shows_unit_0(tmp_path):
    write_texture(tmp_path, "t.png", (51, 102, 153))
    declarations = "uniform sampler2D s;\nuniform sampler2D t;"
    path = write_quad(tmp_path, "color = texture(t, uv);", declarations, objects=texture("t.png"))
    pixels, (warning,) = drawn(path)
    np.testing.assert_allclose(pixels[0, 0, :3], (0.2, 0.4, 0.6), atol=1e-6)
    assert warning.startswith('pass "Quad": no texture goes to the sampler "t", and it shows what is in unit 0')


def test_without_any_texture_a_sampler_is_black(tmp_path):
    write_texture(tmp_path, "t.png")
    declaration = "uniform sampler2D t;"
    render(write_quad(tmp_path, "color = texture(t, uv);", declaration, objects=texture("t.png")), SIZE)
    # What another picture left in the unit does not show.
    pixels, _ = drawn(write_quad(tmp_path, "color = texture(t, uv);", declaration))
    assert (pixels[..., :3] == 0).all()


def test_a_sampler_of_another_kind_is_a_warning(tmp_path):
    write_texture(tmp_path, "t.png")
    path = write_quad(
        tmp_path, "color = texture(t, vec3(uv, 1.0));", "uniform samplerCube t;", objects=texture("t.png")
    )
    _, warnings = drawn(path)
    assert warnings == ['pass "Quad": the sampler "t" is a samplerCube, but "t.png" goes to it, which is none']


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
            assert full_screen or used == set(range(len(item.attributes)))
        assert {v.name for v in prepared.uniforms.variables} == {v.name for v in prepared.shader_pass.variables}
        assert {v.name for v in prepared.shader_pass.variables} == set(prepared.program.uniforms) - samplers


def test_points_and_lines_of_a_model_are_a_warning(tmp_path):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")
    _, warnings = drawn(model_project(tmp_path, "m.obj"))
    assert warnings == ['the model "m.obj" has 1 points or lines, which SHADERed draws as triangles']


def test_a_blank_line_above_the_version(tmp_path):
    path = write_quad(tmp_path, "color = vec4(SHADERED_VERSION);")
    frag = tmp_path / "quad.frag"
    frag.write_text("\n" + frag.read_text())
    assert first_floats(path)[0] == 1005005


# ---- What is left out to keep going ------------------------------------------------------------------------------


def test_keep_going_leaves_out_a_pass_that_does_not_compile(tmp_path):
    write_quad(tmp_path, "color = vec4(0.5);")
    (tmp_path / "bad.frag").write_text("#version 330\nvoid main() { x = 1; }\n")
    path = write_project(tmp_path, shader_pass("Bad", fragment="bad.frag") + shader_pass("Good"))
    renderer = Renderer(path, SIZE, keep_going=True)
    renderer.draw()
    assert renderer.floats()[0, 0, 0] == 0.5
    (error,) = renderer.errors
    assert isinstance(error, GlslError) and '(in pass "Bad")' in error.message


def test_keep_going_shifts_textures_as_shadered_does(tmp_path):
    write_texture(tmp_path, "b.png", (0, 255, 0))
    path = write_quad(
        tmp_path, "color = texture(t, uv);", "uniform sampler2D t;", objects=texture("gone.png") + texture("b.png", 1)
    )
    renderer = Renderer(path, SIZE, keep_going=True)
    renderer.draw()
    assert renderer.floats()[0, 0, 1] == 1 and '"gone.png"' in renderer.errors[0].message


def test_keep_going_leaves_out_an_item(tmp_path):
    write_quad(tmp_path, "color = vec4(0.5);")
    items = '<item name="Pot" type="model"><filepath>gone.obj</filepath></item>' + QUAD_ITEM.format(name="Q")
    renderer = Renderer(write_project(tmp_path, shader_pass(items=items)), SIZE, keep_going=True)
    renderer.draw()
    assert renderer.floats()[0, 0, 0] == 0.5 and '"gone.obj"' in renderer.errors[0].message
