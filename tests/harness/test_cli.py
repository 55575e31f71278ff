"""The command line as a user meets it: what it prints, what it writes, its exit codes."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from harness import HarnessError, cli
from harness.language.dialect import MODES


def harness(*arguments, cwd=None):
    command = [sys.executable, "-m", "harness.cli", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=60)


def assert_one_clear_message(done, *parts):
    """Exit code 1, nothing on stdout, no traceback, and all the parts in what stderr says."""
    assert done.returncode == 1, done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for part in parts:
        assert part in done.stderr


@pytest.fixture
def scene(root, tmp_path):
    """A copy of the project that a test may break."""
    for name in ("shaders", "models", "textures"):
        shutil.copytree(root / name, tmp_path / name, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    shutil.copy(root / "project.sprj", tmp_path)
    return tmp_path


def replace_in(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    return text[: text.index(old)].count("\n") + 1


def render(folder, *more):
    return harness("render", "project.sprj", "-o", "out.png", "--size", "64x36", *more, cwd=folder)


# ---- call ------------------------------------------------------------------------------------------------------------


def test_call_prints_a_number_with_all_its_digits(root):
    done = harness("call", root / "shaders" / "brdf.glsl", "D_GGX", "NoH=1", "alpha=0.25")
    assert done.returncode == 0
    assert np.float32(done.stdout) == np.float32(1 / (np.pi * 0.25**2))


def test_call_prints_vectors_and_batches(root):
    done = harness("call", root / "shaders" / "brdf.glsl", "F_Schlick", "F0=0.04,0.04,0.04", "LoH=[0,1]")
    assert done.stdout == "[[1.0, 1.0, 1.0], [0.04, 0.04, 0.04]]\n"


def test_call_takes_structs_by_their_members(root):
    arguments = ["l=0,0,1", "v=0,0,1", "n=0,0,1", "m.albedo=0,0,0", "m.metalness=0", "m.roughness=1"]
    done = harness("call", root / "shaders" / "brdf.glsl", "shade", *arguments)
    assert eval(done.stdout) == pytest.approx([0.04 / (4 * np.pi)] * 3)


def test_call_takes_macros_and_modes(root):
    arguments = ["srgb_to_linear", "c=0.5,0.5,0.5", "-D", "SRGB_DECODE=SRGB_CUBIC", "--mode", "precise"]
    done = harness("call", root / "shaders" / "color.glsl", *arguments)
    assert eval(done.stdout)[0] == pytest.approx(
        0.5 * (0.5 * (0.5 * 0.305306011 + 0.682171111) + 0.012522878), rel=1e-6
    )


def test_a_macro_without_a_value_is_1(tmp_path):
    (tmp_path / "f.glsl").write_text("float f() { return float(LEVEL) + 0.5; }\n")
    assert harness("call", "f.glsl", "f", "-D", "LEVEL", cwd=tmp_path).stdout == "1.5\n"


def test_call_prints_out_parameters_by_name(tmp_path):
    (tmp_path / "f.glsl").write_text("bool f(float x, out ivec2 y) { y = ivec2(int(x), 7); return x > 1.0; }\n")
    done = harness("call", "f.glsl", "f", "x=2.5", cwd=tmp_path)
    assert done.stdout == "result = True\ny = [2, 7]\n"


def test_an_unknown_function_lists_what_there_is(root):
    done = harness("call", "shaders/brdf.glsl", "D_GGXX", "NoH=1", cwd=root)
    assert_one_clear_message(done, "shaders/brdf.glsl", "D_GGXX", "D_GGX,", "V_SmithGGXCorrelated")


def test_a_wrong_shape_says_what_is_wanted(root):
    done = harness("call", "shaders/brdf.glsl", "F_Schlick", "F0=0.04,0.04", "LoH=1", cwd=root)
    assert_one_clear_message(done, "F0", "(..., 3)", "(2,)", "vec3 F_Schlick(vec3 F0, float LoH)")


@pytest.mark.parametrize("argument", ["NoH", "NoH=one", "NoH=[1,", "=1"])
def test_a_value_that_is_none_is_named(root, argument):
    done = harness("call", "shaders/brdf.glsl", "D_GGX", argument, "alpha=1", cwd=root)
    assert_one_clear_message(done, argument)


def test_an_unknown_mode_lists_the_modes(root):
    done = harness("call", "shaders/brdf.glsl", "D_GGX", "NoH=1", "alpha=1", "--mode", "fast", cwd=root)
    assert_one_clear_message(done, "fast", "as-written", "precise")


def test_call_takes_hexadecimal_numbers_and_those_that_are_none(tmp_path):
    (tmp_path / "f.glsl").write_text("vec4 f(vec4 v) { return v; }\n")
    done = harness("call", "f.glsl", "f", "v=0x1.8p-3,-0.0,nan,-inf", cwd=tmp_path)
    assert done.stdout == "[0.1875, -0.0, nan, -inf]\n"


def here(*arguments) -> None:
    """The command in this process, where what it refuses is an exception."""
    options = cli._parser().parse_args(list(map(str, arguments)))
    options.run(options)


def test_call_takes_an_overload_and_the_members_of_arrays_and_uniforms(tmp_path, capsys):
    text = "struct L { float a; vec2 b; };\nuniform L light;\nfloat f(float x) { return x; }\n"
    text += "float f(L l[2], float x) { return l[1].b.y + light.b.x * x + light.a; }\n"
    (tmp_path / "f.glsl").write_text(text)
    arguments = ["l[1].b=3,4", "l[1].a=0", "l[0].a=0", "l[0].b=0,0", "x=2", "light.b=0.5,0", "light.a=0"]
    here("call", tmp_path / "f.glsl", "f(L[2], float)", *arguments)
    assert capsys.readouterr().out == "5.0\n"


def test_call_compares_all_modes(root, capsys):
    here("call", root / "shaders/brdf.glsl", "D_GGX", "NoH=1,0.5", "alpha=0.25", "--mode", "all")
    heading, columns, *rows = capsys.readouterr().out.rstrip("\n").split("\n")
    assert re.fullmatch(
        r"float D_GGX\(float NoH, float alpha\)    \[\S*shaders/brdf.glsl:\d+\], 2 evaluations", heading
    )
    assert columns.split() == ["mode", "ulp", "absolute", "largest", "at"]
    assert [row.split()[0] for row in rows] == list(MODES)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["missing", "x=1"], "f.glsl: no function missing; there are: f, g"),
        (["ff", "x=1"], "f.glsl: no function ff; did you mean f? There are: f, g"),
        (["f(vec2)", "x=1"], "f.glsl: no overload f(vec2); there are:\n    float f(float x)"),
        (["f"], "f.glsl:1: f lacks x; it is float f(float x)"),
        (["f", "x=1", "y=2"], "f.glsl:1: float f(float x) has no parameter y and reads no such uniform"),
        (["f", "x=1", "x=2"], "x is given twice"),
        (["f", "x=1", "x.a=2"], "x is given both as a value and by its members"),
        (["f", "x=1..5"], "x=1..5: '1..5' is no number, vector such as 1,2,3, true or false"),
        (["f", "x"], "'x' is not an argument of the form NAME=VALUE"),
        (["g", "k=nan"], "f.glsl:2: k is an int, got numbers of type float64 (nan among them); it is int g(int k)"),
        (
            ["f", "x=1", "--mode", "presice"],
            "no mode 'presice'; did you mean precise? There are: as-written, precise, mediump, double",
        ),
    ],
)
def test_what_is_wrong_in_a_call_is_told_in_full(tmp_path, monkeypatch, arguments, message):
    (tmp_path / "f.glsl").write_text("float f(float x) { return x; }\nint g(int k) { return k; }\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(HarnessError) as caught:
        here("call", "f.glsl", *arguments)
    assert str(caught.value) == message


def test_a_syntax_error_in_an_include_names_that_file_and_line(tmp_path):
    (tmp_path / "inner.glsl").write_text("float one() { return 1.0; }\nfloat two() { return 1.0 +; }\n")
    (tmp_path / "outer.glsl").write_text(
        '// a comment\n#include "inner.glsl"\nfloat three() { return one() + two(); }\n'
    )
    done = harness("call", "outer.glsl", "three", cwd=tmp_path)
    assert_one_clear_message(done, "inner.glsl:2:", "float two() { return 1.0 +; }")


def test_a_syntax_error_within_a_macro_names_the_line_that_uses_it(tmp_path):
    (tmp_path / "f.glsl").write_text("#define BAD missing\n\nfloat f() { return BAD; }\n")
    done = harness("call", "f.glsl", "f", cwd=tmp_path)
    assert_one_clear_message(done, "f.glsl:3: 'missing' : undeclared identifier\n    float f() { return BAD; }\n")


# ---- functions -------------------------------------------------------------------------------------------------------


def test_functions_are_listed_with_their_comments(tmp_path, monkeypatch, capsys):
    (tmp_path / "inner.glsl").write_text("// Inner,\n//   indented.\nfloat g(float x) { return x; }\n")
    (tmp_path / "f.glsl").write_text('#include "inner.glsl"\nfloat f(vec2 v, out int k) { k = 1; return K; }\n')
    monkeypatch.chdir(tmp_path)
    here("functions", "f.glsl", "-D", "K=1.0")
    assert capsys.readouterr().out == (
        "float g(float x)    [inner.glsl:3]\n    Inner,\n      indented.\nfloat f(vec2 v, out int k)    [f.glsl:2]\n"
    )


def test_the_functions_of_a_file_that_does_not_compile_are_not_listed(tmp_path):
    (tmp_path / "f.glsl").write_text("float f(vec2 v) { return K; }\n")
    assert_one_clear_message(harness("functions", "f.glsl", cwd=tmp_path), "f.glsl:1: 'K' : undeclared")


# ---- render ----------------------------------------------------------------------------------------------------------


def test_render_writes_the_picture(scene):
    done = render(scene)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert Image.open(scene / "out.png").size == (64, 36)


def test_supersampling_averages(scene):
    """A picture at four times the size, averaged by other code, is the same to the rounding of a byte."""
    assert render(scene, "--supersample", "4").returncode == 0
    averaged = np.asarray(Image.open(scene / "out.png").convert("RGB"), int)
    assert harness("render", "project.sprj", "-o", "large.png", "--size", "256x144", cwd=scene).returncode == 0
    large = Image.open(scene / "large.png").convert("RGB").reduce(4)
    assert np.abs(averaged - np.asarray(large, int)).max() <= 1


@pytest.mark.parametrize(
    ("element", "old", "new"),
    [
        ('<object type="texture"', "textures/GlazedTiles_1K-PNG_Color.png", "textures/Nowhere.png"),
        ('<item type="model"> "Metal1" of pass "Metals"', "models/teapot_plain.glb", "models/Nowhere.glb"),
        ('<shader type="ps"> of pass "Metals"', "shaders/pbr.frag", "shaders/Nowhere.frag"),
    ],
    ids=["texture", "model", "shader"],
)
def test_a_missing_file_is_named_with_its_element_and_line(scene, element, old, new):
    line = replace_in(scene / "project.sprj", old, new)
    done = render(scene)
    assert_one_clear_message(done, element, new)
    # a model's item begins on the line before its file
    assert any(f"project.sprj:{n}:" in done.stderr for n in (line, line - 1))
    assert list(scene.glob("*out.png*")) == []


def test_a_missing_include_is_named_where_it_is_asked_for(scene):
    line = replace_in(scene / "shaders" / "pbr.frag", '#include "normal_map.glsl"', '#include "nowhere.glsl"')
    assert_one_clear_message(render(scene), f"pbr.frag:{line}:", "nowhere.glsl")


def test_a_syntax_error_in_a_projects_include_names_that_file_and_line(scene):
    line = replace_in(scene / "shaders" / "brdf.glsl", "vec3 H = 0.5 * (l + v);", "vec3 H = 0.5 * (l + w);")
    assert_one_clear_message(render(scene), f"brdf.glsl:{line}:", "'w'", "vec3 H = 0.5 * (l + w);", "Metals")


def test_malformed_xml_gives_the_line(scene):
    line = replace_in(scene / "project.sprj", "</inputlayout>", "</inputlayou>")
    assert_one_clear_message(render(scene), f"project.sprj:{line}:")


def test_a_failure_leaves_the_old_picture(scene):
    (scene / "out.png").write_bytes(b"old")
    replace_in(scene / "project.sprj", "shaders/pbr.frag", "shaders/Nowhere.frag")
    assert render(scene).returncode == 1
    assert (scene / "out.png").read_bytes() == b"old"


def test_a_folder_that_is_not_there(scene):
    done = harness("render", "project.sprj", "-o", "nowhere/out.png", "--size", "16x9", cwd=scene)
    assert_one_clear_message(done, "nowhere/out.png")


def test_a_picture_too_large_for_the_driver(scene):
    done = harness("render", "project.sprj", "-o", "out.png", "--size", "99999x99999", cwd=scene)
    assert_one_clear_message(done, "99999")
    assert not (scene / "out.png").exists()


# ---- usage -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["paint"],
        ["render"],
        ["render", "p.sprj"],
        ["render", "p.sprj", "-o", "o.png", "--size", "12"],
        ["call", "f"],
    ],
    ids=" ".join,
)
def test_wrong_usage_is_exit_code_2(arguments):
    done = harness(*arguments)
    assert done.returncode == 2
    assert "usage:" in done.stderr


@pytest.mark.parametrize("arguments", [["--help"], ["render", "--help"], ["call", "--help"]], ids=" ".join)
def test_help_shows_examples(arguments):
    done = harness(*arguments)
    assert done.returncode == 0
    assert ("harness " + (arguments[0] if len(arguments) > 1 else "")) in done.stdout
