"""``harness tune`` as a user meets it."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
import tune_scenes
from command_line import main
from sprj_files import line_of

from harness.costing import isa


def harness_tune(path, *more):
    command = [sys.executable, "-m", "harness.cli", "tune", path.name, "--views", "2", "--size", "32x18", *more]
    return subprocess.run(command, capture_output=True, text=True, cwd=path.parent, timeout=120)


@pytest.fixture
def without_ladder(tmp_path):
    """What passes do not need is all that there is to find, which is quick."""
    path = tune_scenes.rough_dielectric(tmp_path)
    (tmp_path / "shaders" / "ladder.toml").unlink()
    return path


def test_tables_say_what_is_chosen_and_what_it_saves(without_ladder):
    there = without_ladder.read_bytes()
    done = harness_tune(without_ladder)
    assert (done.returncode, done.stderr) == (0, "")
    assert "METALNESS = 0" in done.stdout and "Texcoord of the input layout" in done.stdout
    assert "2 views of 32 x 18" in done.stdout and "yaw/pitch 200/20 20/40" in done.stdout
    assert "1/255 in every channel" in done.stdout and "--write" in done.stdout
    assert without_ladder.read_bytes() == there


def test_json_has_all_of_it(without_ladder):
    done = harness_tune(without_ladder, "--format", "json", "--budget", "0.02")
    found = json.loads(done.stdout)
    assert found["budget"] == {"max": pytest.approx(5.1), "flip": None} and found["reference"] is None
    assert [c["macro"] for c in found["choices"]] == [None, None]
    (cost,) = found["costs"]
    assert cost["name"] == "Balls" and cost["chosen"] < cost["reference"] == cost["written"]
    assert sum(c["saves"] for c in found["choices"]) == cost["reference"] - cost["chosen"]
    assert len(found["views"]) == 2 and found["changes"] and found["pictures"] > 4


def test_write_keeps_the_mode_and_a_link(without_ladder):
    real = without_ladder.rename(without_ladder.with_name("real.sprj"))
    real.chmod(0o640)
    without_ladder.symlink_to(real.name)
    done = harness_tune(without_ladder, "--write")
    assert done.returncode == 0 and "written to" in done.stdout, done.stderr
    assert without_ladder.is_symlink() and real.stat().st_mode & 0o777 == 0o640
    assert '"METALNESS" active="true">0<' in real.read_text()
    again = harness_tune(without_ladder, "--write")
    assert "Nothing to gain" in again.stdout and "says so already" in again.stdout
    assert sorted(p.name for p in real.parent.iterdir()) == ["real.sprj", "scene.sprj", "shaders"]


def test_spirv_is_counted_where_no_driver_is(without_ladder, monkeypatch):
    monkeypatch.setenv(isa.PROGRAM_VARIABLE, "/nowhere/harness_isa")
    done = harness_tune(without_ladder)
    assert done.returncode == 0
    assert "SPIR-V operations" in done.stdout and "/nowhere/harness_isa" in done.stdout


def test_an_unknown_preset(tmp_path):
    done = harness_tune(tune_scenes.rough_dielectric(tmp_path), "--reference", "exakt")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and "exakt" in done.stderr and "exact" in done.stderr


@pytest.mark.parametrize(
    "wrong",
    [
        ("--budget", "x"),
        ("--budget", "1/0"),
        ("--budget", "-1/255"),
        ("--flip", "2"),
        ("--flip", "nan"),
        ("--views", "0"),
        ("--target", "voodoo2"),
    ],
)
def test_wrong_usage(wrong, capsys):
    with pytest.raises(SystemExit) as caught:
        main(["tune", "scene.sprj", *wrong])
    assert caught.value.code == 2 and wrong[0] in capsys.readouterr().err


def broken_shader(path):
    frag = path.parent / "shaders" / "pbr.frag"
    frag.write_text(frag.read_text().replace("vec3 v = normalize", "vec3 v = normalise"))
    return "shaders/pbr.frag", line_of(frag, "normalise"), "normalise"


def missing_shader(path):
    path.write_text(path.read_text().replace("shaders/pbr.vert", "shaders/lost.vert"))
    return path.name, line_of(path, "lost.vert"), "lost.vert"


def bad_ladder(path):
    (path.parent / "shaders" / "ladder.toml").write_text("[[term]]\nname = 3\n")
    return "shaders/ladder.toml", None, "name"


def version_1(path):
    path.write_text('<project version="1"><pipeline></pipeline></project>')
    return path.name, None, "version 1"


def no_project(path):
    path.unlink()
    return path.name, None, "cannot read"


@pytest.mark.parametrize("damage", [broken_shader, missing_shader, bad_ladder, version_1, no_project])
def test_what_is_wrong_is_said_with_its_place(tmp_path, damage):
    path = tune_scenes.rough_dielectric(tmp_path)
    file, line, what = damage(path)
    done = harness_tune(path, "--write")
    assert done.returncode == 1 and done.stdout == "" and "Traceback" not in done.stderr
    assert done.stderr.startswith(f"{file}:{line or ''}") and what in done.stderr


def test_what_earlier_frames_leave_is_refused(tmp_path):
    """A compute pass that counts frames shows in the picture."""
    (tmp_path / "count.glsl").write_text(
        "#version 430\nlayout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer N { float n[4]; };\n"
        "void main() { n[0] += 0.25; }\n"
    )
    path = tmp_path / "scene.sprj"
    path.write_text(
        """<project version="2"><pipeline>
<pass name="Count" type="compute" active="true"><shader type="cs" path="count.glsl" entry="main" /></pass>
<pass name="Show" type="shader" active="true"><shader type="vs" path="quad.vert" entry="main" />
<shader type="ps" path="show.frag" entry="main" /><rendertexture />
<items><item name="Quad" type="geometry"><type>ScreenQuadNDC</type></item></items></pass>
</pipeline><objects><object type="buffer" name="n" size="16" format="float"><bind slot="0" name="Count" />
<bind slot="0" name="Show" /></object></objects><settings>
<entry type="camera" fp="false"><distance>5</distance><pitch>0</pitch><yaw>0</yaw><roll>0</roll></entry>
</settings></project>"""
    )
    (tmp_path / "quad.vert").write_text(
        "#version 430\nlayout(location = 0) in vec2 p;\nvoid main() { gl_Position = vec4(p, 0.0, 1.0); }\n"
    )
    (tmp_path / "show.frag").write_text(
        "#version 430\nlayout(std430, binding = 0) buffer N { float n[4]; };\nout vec4 color;\n"
        "void main() { color = vec4(fract(n[0]), 0.0, 0.0, 1.0); }\n"
    )
    done = harness_tune(path)
    assert done.returncode == 1 and "gives two pictures" in done.stderr
