"""From a project to its picture: what becomes of the framebuffer, and what can be asked for."""

from __future__ import annotations

import numpy as np
import pytest
from sprj_files import (
    SIZE,
    first_floats,
    item,
    line_of,
    shader_pass,
    texture,
    variables,
    write_project,
    write_quad,
    write_texture,
)

from harness import ProjectError, native
from harness.projects.traps import Warning
from harness.rendering import textures
from harness.rendering.render import Renderer, render, render_sequence


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


# ---- What can be asked for -----------------------------------------------------------------------------------


def two_passes(folder):
    write_quad(folder, "color = vec4(LEVEL);")
    off = item("{}", "<depthtest>false</depthtest>", kind="renderstate")
    quad = item("{}", "<type>ScreenQuadNDC</type>")
    macro = '<macros><define name="LEVEL">{}</define></macros>'
    passes = [
        shader_pass(n, items=off.format(f"{n}S") + quad.format(f"{n}I"), extra=macro.format(v))
        for n, v in (("First", 0.25), ("Second", 0.5))
    ]
    return write_project(folder, "".join(passes))


@pytest.mark.parametrize("name, level", [("First", 64), ("Second", 128)])
def test_until_a_pass(tmp_path, name, level):
    assert (render(two_passes(tmp_path), SIZE, until_pass=name)[..., 0] == level).all()


def test_until_a_pass_that_there_is_not(tmp_path):
    with pytest.raises(ProjectError, match='there is no pass "Third" that is drawn; there are: First, Second'):
        render(two_passes(tmp_path), SIZE, until_pass="Third")


def test_warnings_have_lines(tmp_path):
    path = write_quad(tmp_path, "", extra="\n" + variables('<variable type="float" name="v" system="Clock" />'))
    warnings: list[Warning] = []
    render(path, SIZE, warnings=warnings)
    (warning,) = warnings
    assert (warning.file, warning.line) == (str(path), line_of(path, "Clock"))
    assert str(warning).startswith(f"{path}:{warning.line}: warning: ")


def test_a_sequence_has_one_start(tmp_path, monkeypatch):
    write_texture(tmp_path, "t.png")
    extra = variables('<variable type="float" name="t" system="Time" />')
    declarations = "uniform sampler2D s;\nuniform float t;"
    path = write_quad(tmp_path, "color = texture(s, uv) * t;", declarations, extra=extra, objects=texture("t.png"))
    counts = {"programs": 0, "textures": 0}
    of_stages, read = native.Program.of_stages, textures.read

    def count(name, function):
        def counted(*arguments, **how):
            counts[name] += 1
            return function(*arguments, **how)

        return counted

    monkeypatch.setattr(native.Program, "of_stages", count("programs", of_stages))
    monkeypatch.setattr(textures, "read", count("textures", read))
    renderer = Renderer(path, SIZE)
    pictures = list(render_sequence(renderer, range(1, 5), fps=5))
    assert [p[0, 0, 0] for p in pictures] == [51, 102, 153, 204]  # 255 * 0.2, 0.4, 0.6, 0.8
    assert counts == {"programs": 1, "textures": 1}


def test_a_sequence_starts_when_it_is_told(tmp_path):
    extra = variables(
        '<variable type="float" name="t" system="Time" />', '<variable type="float" name="d" system="TimeDelta" />'
    )
    path = write_quad(tmp_path, "color = vec4(t, d, 0.0, 1.0);", "uniform float t, d;", extra=extra)
    renderer = Renderer(path, SIZE)
    for _ in render_sequence(renderer, range(3, 4), fps=4, start=10):
        np.testing.assert_array_equal(renderer.floats()[0, 0, :2], (10.75, 0.25))


def test_a_window_too_large(tmp_path):
    objects = '<object type="rendertexture" name="rt" rsize="20000,20000"><bind slot="0" name="Quad" /></object>'
    path = write_quad(tmp_path, "", objects="\n" + objects)
    with pytest.raises(ProjectError, match='the render texture "rt": 80000 x 60000 pixels') as caught:
        first_floats(path)
    assert caught.value.line == line_of(path, "<object ")
