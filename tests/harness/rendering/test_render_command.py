"""``harness render`` as a user meets its options."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from PIL import Image
from sprj_files import item, shader_pass, variables, write_project, write_quad

SYSTEM = variables(
    '<variable type="float" name="time" system="Time" />', '<variable type="int" name="frame" system="FrameIndex" />'
)


def harness_render(folder, *more):
    command = [sys.executable, "-m", "harness.cli", "render", "project.sprj", "-o", "out.png", "--size", "4x2", *more]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=60)


def first_pixel(path) -> list[int]:
    with Image.open(path) as image:
        return list(image.getpixel((0, 0)))


@pytest.fixture
def clock(tmp_path):
    """Red is the time in tenths of seconds, green the frame, both in units of a picture."""
    write_quad(
        tmp_path,
        "color = vec4(time * 10.0, float(frame), 0.0, 255.0) / 255.0;",
        "uniform float time; uniform int frame;",
    )
    write_project(tmp_path, shader_pass(extra=SYSTEM))
    return tmp_path


def test_frame_and_time(clock):
    done = harness_render(clock, "--frame", "7", "--time", "2.5")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert first_pixel(clock / "out.png")[:2] == [25, 7]


def test_frames_are_numbered_with_as_many_digits_as_the_last(clock):
    done = harness_render(clock, "--frames", "8:11", "--fps", "10", "--time", "1")
    assert done.returncode == 0, done.stderr
    assert sorted(p.name for p in clock.glob("*.png")) == ["out08.png", "out09.png", "out10.png"]
    assert [first_pixel(clock / f"out{n}.png")[:2] for n in ("08", "09", "10")] == [[18, 8], [19, 9], [20, 10]]


@pytest.mark.parametrize(
    "options",
    [("--frames", "3:3"), ("--frames", "5:3"), ("--frames", "3"), ("--fps", "0"), ("--fps", "inf"), ("--frame", "x")],
)
def test_wrong_usage(tmp_path, options):
    done = harness_render(tmp_path, *options)
    assert done.returncode == 2 and options[0] in done.stderr and "Traceback" not in done.stderr


def test_targets_are_dumped_and_later_passes_left_out(tmp_path):
    write_quad(tmp_path, "color = vec4(2.0, 0.2, 0.0, 1.0);")
    (tmp_path / "bad.frag").write_text("#version 330\nout vec4 c; void main() { c = vec4(0.0); }\n")
    first = shader_pass("First", extra='<rendertexture name="rt" />')
    write_project(
        tmp_path,
        first + shader_pass("Second", fragment="bad.frag"),
        objects='<object type="rendertexture" name="rt" fsize="3,1" format="R32G32B32A32_FLOAT" />',
    )
    done = harness_render(tmp_path, "--pass", "First", "--dump-targets", "targets")
    assert done.returncode == 0, done.stderr
    texels = np.load(tmp_path / "targets" / "rt.npy")
    np.testing.assert_array_equal(texels, np.broadcast_to(np.array([2, 0.2, 0, 1], np.float32), (1, 3, 4)))
    assert first_pixel(tmp_path / "targets" / "rt.png")[:3] == [255, 51, 0]


def test_warnings_are_said_and_the_picture_is_written(tmp_path):
    write_quad(tmp_path, "color = vec4(1.0);")
    write_project(tmp_path, shader_pass("Quad", items=item("quad", "<type>ScreenQuadNDC</type>")))
    done = harness_render(tmp_path)
    assert done.returncode == 0 and (tmp_path / "out.png").exists()
    assert done.stderr.startswith("project.sprj:8: warning: ") and "taken" in done.stderr


def test_what_is_wrong_stops_or_with_keep_going_is_left_out(tmp_path):
    write_quad(tmp_path, "color = vec4(1.0);")
    (tmp_path / "bad.frag").write_text("#version 330\nout vec4 c;\nvoid main() { c = wrong; }\n")
    write_project(tmp_path, shader_pass("Bad", fragment="bad.frag") + shader_pass("Good"))
    done = harness_render(tmp_path)
    assert done.returncode == 1 and "bad.frag:3" in done.stderr and not (tmp_path / "out.png").exists()
    done = harness_render(tmp_path, "--keep-going")
    assert done.returncode == 1 and "bad.frag:3" in done.stderr and first_pixel(tmp_path / "out.png")[0] == 255


def test_an_unknown_pass_is_named(clock):
    done = harness_render(clock, "--pass", "Blur")
    assert done.returncode == 1 and "Blur" in done.stderr and "Quad" in done.stderr


@pytest.mark.parametrize("options", [("--time", "nan"), ("--frame", "99999999999999"), ("--frame", "-1")])
def test_odd_times_do_not_crash(clock, options):
    done = harness_render(clock, *options)
    assert "Traceback" not in done.stderr


def test_watching_renders_again_after_each_change_and_each_error(clock):
    command = [
        sys.executable,
        "-m",
        "harness.cli",
        "render",
        "project.sprj",
        "-o",
        "out.png",
        "--size",
        "4x2",
        "--watch",
    ]
    shader, picture = clock / "quad.frag", clock / "out.png"
    good = shader.read_text()

    def wait(reached):
        end = time.monotonic() + 30
        while not reached():
            assert watching.poll() is None and time.monotonic() < end
            time.sleep(0.02)

    with (clock / "log").open("w") as log:
        watching = subprocess.Popen(command, cwd=clock, stderr=log)
        try:
            wait(picture.exists)
            shader.write_text(good.replace("time * 10.0", "wrong"))
            wait(lambda: "wrong" in (clock / "log").read_text())
            shader.write_text(good.replace("time * 10.0", "42.0"))
            wait(lambda: first_pixel(picture)[0] == 42)
        finally:
            watching.send_signal(signal.SIGINT)
            assert watching.wait(10) == 130


def test_an_endless_loop_ends_at_the_time_limit(tmp_path):
    body = "float x = 0.0; while (x < 2.0) x += rise * sin(x + uv.x); color = vec4(x);"
    write_quad(tmp_path, body, "uniform float rise;")
    write_project(tmp_path, shader_pass())
    done = harness_render(tmp_path, "--size", "1920x1080", "--time-limit", "2")
    assert done.returncode == 1 and "ran out of time after 2 s" in done.stderr
