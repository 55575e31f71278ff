"""``harness view`` with a real window: a display in memory, a mouse and keys by xdotool. Expected: what a user gets."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from PIL import Image
from sprj_files import variables, write_quad

VIEW = [sys.executable, "-m", "harness.cli", "view", "project.sprj"]
CAMERA = '<entry type="camera" fp="false"><distance>10</distance><pitch>0</pitch><yaw>180</yaw><roll>0</roll></entry>'
EYE = variables('<variable type="float3" name="eye" system="CameraPosition3" />')
#: the camera's x and z: 10 units are half of a channel
BODY = "color = vec4(uv.x, eye.x / 20.0 + 0.5, eye.z / 20.0 + 0.5, 1.0);"
SECONDS = 20.0  # a machine may be slow; nothing takes that long


@pytest.fixture(scope="module")
def display():
    if not shutil.which("Xvfb"):
        pytest.skip("no Xvfb to make a display")
    command = ["Xvfb", "-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as server:
        yield f":{server.stdout.readline().strip()}"
        server.terminate()


@pytest.fixture(scope="module")
def session(display, tmp_path_factory):
    """A project viewed, dragged, written, broken, mended and closed: what was seen on the way."""
    if not shutil.which("xdotool"):
        pytest.skip("no xdotool to type with")
    folder = tmp_path_factory.mktemp("viewed")
    path = write_quad(folder, BODY, "uniform vec3 eye;", extra=EYE, settings=CAMERA)
    environment = os.environ | {"DISPLAY": display}
    environment.pop("HARNESS_BACKEND", None)

    def xdotool(*words: object) -> str:
        done = subprocess.run(["xdotool", *map(str, words)], env=environment, capture_output=True, text=True)
        return done.stdout.strip()

    def wait(reached, what: str) -> None:
        end = time.monotonic() + SECONDS
        while not reached():
            assert viewer.poll() is None and time.monotonic() < end, f"{what}: {log.read_text()}"
            time.sleep(0.02)

    log = folder / "log"
    seen = SimpleNamespace(folder=folder, before=path.read_text())
    with log.open("w") as stderr:
        viewer = subprocess.Popen(
            [*VIEW, "--size", "64x48"], cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=stderr, text=True
        )
    try:
        wait(lambda: xdotool("search", "--name", "^project.sprj"), "a window")
        window = xdotool("search", "--name", "^project.sprj").split()[0]
        seen.geometry = xdotool("getwindowgeometry", window)
        xdotool("windowfocus", "--sync", window)
        xdotool("key", "h", "s")
        wait((folder / "project-1.png").exists, "a picture")
        xdotool(
            "mousemove", 10, 20, "mousedown", 1, "mousemove", 50, 30, "mouseup", 1, "click", 4, "click", 4, "key", "w"
        )
        wait(lambda: path.read_text() != seen.before, "a camera")
        wait(lambda: "read again" in log.read_text(), "the file read again")
        seen.written = path.read_text()
        good = (folder / "quad.frag").read_text()
        (folder / "quad.frag").write_text(good.replace("eye.x", "eye.nothing"))
        wait(lambda: "ERROR" in xdotool("getwindowname", window), "an error in the title")
        seen.title = xdotool("getwindowname", window)
        (folder / "quad.frag").write_text(good)
        wait(lambda: xdotool("getwindowname", window) == "project.sprj", "the error gone")
        xdotool("key", "Escape")
        seen.printed, _ = viewer.communicate(timeout=SECONDS)
    finally:
        viewer.kill()
    seen.code, seen.log = viewer.returncode, log.read_text()
    return seen


def test_the_window_has_the_size_asked_for(session):
    assert "Geometry: 64x48" in session.geometry


def test_the_window_shows_the_picture(session):
    with Image.open(session.folder / "project-1.png") as image:
        assert image.size == (64, 48)
        # uv.x is (x + 1/2)/64, the camera on +z
        assert [image.getpixel((x, 5)) for x in (0, 63)] == [(2, 128, 255, 255), (253, 128, 255, 255)]


def test_dragging_and_the_wheel_move_the_camera_that_is_written(session):
    expected = session.before
    for old, new in ((">10<", ">8<"), (">0</pitch>", ">10</pitch>"), (">180<", ">140<")):
        expected = expected.replace(old, new)
    assert session.written == expected


def test_an_error_is_in_the_title_and_on_stderr(session):
    assert re.match(r"project\.sprj - ERROR quad\.frag:\d+: .*nothing", session.title)
    assert re.search(r"^quad\.frag:\d+: .*nothing", session.log, re.MULTILINE)


def test_the_keys_are_printed(session):
    assert "save a picture" in session.printed and "Esc" in session.printed


def test_escape_closes_without_a_word(session):
    assert session.code == 0 and "Traceback" not in session.log


def test_it_closes_after_so_many_frames(display, tmp_path):
    write_quad(tmp_path, "")
    environment = os.environ | {"DISPLAY": display}
    environment.pop("HARNESS_BACKEND", None)
    command = [*VIEW, "--size", "8x8", "--frames", "3"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def without_display(folder) -> subprocess.CompletedProcess:
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    return subprocess.run(VIEW, cwd=folder, env=environment, capture_output=True, text=True, timeout=60)


def test_without_a_display_it_says_so(tmp_path):
    write_quad(tmp_path, "")
    done = without_display(tmp_path)
    assert done.returncode == 1 and "GLFW finds no display" in done.stderr and done.stderr.count("\n") == 1


def test_a_missing_project_is_told_first(tmp_path):
    done = without_display(tmp_path)
    assert done.returncode == 1 and "project.sprj: cannot read the project" in done.stderr


def test_other_backends_have_no_window():
    code = "from harness.native import open_context, window; open_context(); window.Window('', (1, 1))"
    environment = os.environ | {"HARNESS_BACKEND": "osmesa"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert "only the backend glfw has a window" in done.stderr


@pytest.mark.parametrize("options", [("--frames", "0"), ("--size", "0x4")])
def test_wrong_usage(tmp_path, options):
    done = subprocess.run([*VIEW, *options], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and options[0] in done.stderr
