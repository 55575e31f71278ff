"""The viewer, driven by events and drawing into a window that is none. Expected: pixels and titles by hand."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from sprj_files import shader_pass, variables, write_project, write_quad

from harness.errors import HarnessError
from harness.native.window import Event, Kind
from harness.viewing import watch
from harness.viewing.view import Viewer

SIZE = (6, 4)
LADDER = """
#define L_LOW 0
#define L_HIGH 1
#ifndef LEVEL
#define LEVEL L_LOW
#endif
"""
CAMERA = '<entry type="camera" fp="false"><distance>10</distance><pitch>0</pitch><yaw>180</yaw><roll>0</roll></entry>'
EYE = variables('<variable type="float3" name="eye" system="CameraPosition3" />')


class Pane:
    """A window's interface, that keeps what was shown."""

    def __init__(self):
        self.title, self.swaps, self.shown = "", 0, np.zeros((*SIZE[::-1], 4), np.uint8)

    def set_title(self, title):
        self.title = title

    def present(self, target):
        self.shown = target.read_bytes()[::-1]

    def present_bytes(self, pixels):
        self.shown = pixels

    def read(self):
        return self.shown

    def swap(self):
        self.swaps += 1


class Session:
    """A viewer of a project whose files are looked at in every step."""

    def __init__(self, path):
        self.path, self.pane = path, Pane()
        self.viewer = Viewer(path, self.pane, SIZE)
        self.viewer.step()

    def do(self, *events):
        for event in events:
            self.viewer.handle(event)
        return self.viewer.step()

    def press(self, key):
        return self.do(Event(Kind.KEY, key if isinstance(key, int) else ord(key), 1))

    @property
    def pixel(self):
        return self.pane.shown[0, 0, :3].tolist()


@pytest.fixture(autouse=True)
def at_once(monkeypatch, tmp_path):
    monkeypatch.setattr(watch, "SECONDS", 0.0)
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def session(tmp_path):
    """Red is the ladder's rung; green and blue are the camera's x and z, 10 units a full channel, from the middle."""
    body = "color = vec4(float(LEVEL) * 0.004, eye.x / 20.0 + 0.5, eye.z / 20.0 + 0.5, 1.0);"
    return Session(write_quad(tmp_path, body, LADDER + "uniform vec3 eye;", extra=EYE, settings=CAMERA))


def test_it_shows_the_project(session):
    # yaw 180: the camera is on +z
    assert session.pixel == [0, 128, 255] and session.pane.title == "project.sprj" and session.pane.swaps == 1


def test_dragging_turns_the_camera(session):
    session.do(Event(Kind.MOVE, x=50, y=50), Event(Kind.BUTTON, 0, 1, 50, 50), Event(Kind.MOVE, x=140, y=50))
    # yaw 90: the camera is on -x
    assert session.pixel == [0, 0, 128]
    session.do(Event(Kind.BUTTON, 0, 0, 140, 50), Event(Kind.MOVE, x=300, y=50))
    assert session.pixel == [0, 0, 128]


def test_the_wheel_nears(session):
    session.do(Event(Kind.WHEEL, y=5))
    assert session.pixel == [0, 128, 191]  # 5 of 20, and the half: 191.25


def test_reset_goes_back(session):
    session.do(Event(Kind.WHEEL, y=5))
    session.press("R")
    assert session.pixel == [0, 128, 255]


def test_a_number_steps_its_ladder(session):
    session.press("1")
    assert session.pixel[0] == 1 and session.pane.title == "project.sprj - LEVEL=L_HIGH"
    session.press("1")
    assert session.pixel[0] == 0 and session.pane.title == "project.sprj"


def test_a_rung_that_does_not_compile_is_told_and_not_taken(tmp_path):
    text = LADDER + "#if LEVEL == L_HIGH\nwrong\n#endif\n"
    session = Session(write_quad(tmp_path, "color.r = float(LEVEL) + 0.2;", text))
    session.press("1")
    assert session.pixel[0] == 51
    assert session.pane.title.startswith("project.sprj - ERROR quad.frag:9: ")
    session.press("E")  # with the rung that there was, which is the reference
    assert session.pixel == [0, 0, 0] and "ERROR" not in session.pane.title


def test_keys_of_ladders_and_features_that_are_not_there_do_nothing(session):
    assert not session.press("2") and not session.press(290)


def test_a_function_key_turns_a_feature_off_and_on(tmp_path):
    feature = '<macros><define name="HAS_RED">1</define></macros>'
    session = Session(write_quad(tmp_path, "color.r = float(HAS_RED);", extra=feature))
    session.press(290)
    assert session.pixel[0] == 0 and "HAS_RED" in session.pane.title
    session.press(290)
    assert session.pixel[0] == 255


def test_the_error_view_is_the_amplified_difference_to_the_reference(session):
    session.press("E")
    assert session.pixel == [0, 0, 0]
    session.press("1")
    # 0.004 * 64 = 0.256 of the scale: between blue at 0.2 and green at 0.4
    assert session.pixel == [0, round(255 * 0.28), round(255 * 0.72)] and "0.004" in session.pane.title
    session.press("E")
    assert session.pixel == [1, 128, 255]


def test_a_change_of_a_shader_shows(session, tmp_path):
    text = (tmp_path / "quad.frag").read_text()
    (tmp_path / "quad.frag").write_text(text.replace("* 0.004", "+ 1.0"))
    session.viewer.step()
    assert session.pixel[0] == 255


def test_an_error_is_told_and_the_last_picture_stays(session, tmp_path, capsys):
    text = (tmp_path / "quad.frag").read_text()
    (tmp_path / "quad.frag").write_text(text.replace("* 0.004", "* wrong"))
    session.viewer.step()
    assert session.pixel == [0, 128, 255]
    assert "ERROR quad.frag:" in session.pane.title and "wrong" in session.pane.title
    assert "wrong" in capsys.readouterr().err
    session.do(Event(Kind.WHEEL, y=5))  # and it is still alive
    assert session.pixel == [0, 128, 191] and "ERROR" in session.pane.title
    (tmp_path / "quad.frag").write_text(text)
    session.viewer.step()
    assert session.pane.title == "project.sprj"


def test_a_broken_project_is_told_and_mended(session):
    text = session.path.read_text()
    session.path.write_text(text[:100])
    session.viewer.step()
    assert "ERROR" in session.pane.title and session.pixel == [0, 128, 255]
    session.path.write_text(text)
    session.viewer.step()
    assert session.pane.title == "project.sprj"


def test_a_camera_that_the_file_moves_is_taken_else_the_user_s_stays(session, tmp_path):
    session.do(Event(Kind.WHEEL, y=5))
    (tmp_path / "quad.vert").write_text((tmp_path / "quad.vert").read_text() + "\n")
    session.viewer.step()
    assert session.pixel == [0, 128, 191]
    session.path.write_text(session.path.read_text().replace(">180<", ">90<"))
    session.viewer.step()
    assert session.pixel == [0, 0, 128]


def test_the_camera_is_written(session):
    before = session.path.read_text()
    session.do(Event(Kind.WHEEL, y=5))
    session.press("W")
    assert session.path.read_text() == before.replace("<distance>10<", "<distance>5<")
    session.do(Event(Kind.WHEEL, y=2))
    session.press("R")  # which is the project's now
    assert session.pixel == [0, 128, 191]


def test_a_picture_is_saved_of_what_is_shown_under_a_new_name(session, tmp_path):
    session.press("S")
    assert session.pane.title == "project.sprj - saved project-1.png"
    session.do(Event(Kind.WHEEL, y=5), Event(Kind.KEY, ord("S"), 1))
    with Image.open(tmp_path / "project-1.png") as one, Image.open(tmp_path / "project-2.png") as two:
        assert (one.size, one.getpixel((0, 0))) == (SIZE, (0, 128, 255, 255))
        assert two.getpixel((0, 0)) == (0, 128, 191, 255)


def test_a_new_size_is_drawn(session):
    session.do(Event(Kind.SIZE, x=9, y=5))
    assert session.pane.shown.shape == (5, 9, 4)
    session.do(Event(Kind.SIZE, x=0, y=0))  # hidden by the desktop
    assert session.pane.shown.shape == (5, 9, 4)


def test_the_keys_are_printed(session, capsys):
    session.press("H")
    shown = capsys.readouterr().out
    assert "LEVEL" in shown and "Esc" in shown and all(f"  {key} " in shown for key in "SREWH1")


@pytest.mark.parametrize("event", [Event(Kind.CLOSE), Event(Kind.KEY, 256, 1)])
def test_it_closes(session, event):
    session.viewer.handle(event)
    assert session.viewer.closed


def test_nothing_is_drawn_while_nothing_changes(session):
    assert session.viewer.is_still()
    assert not session.viewer.step() and session.pane.swaps == 1
    assert session.do(Event(Kind.WHEEL, y=1)) and not session.viewer.step()


@pytest.mark.parametrize("system", ["float|Time", "int|FrameIndex", "float|TimeDelta"])
def test_what_moves_is_drawn_all_the_time(tmp_path, system):
    kind, name = system.split("|")
    write_quad(tmp_path, "color.r = float(moving);", f"uniform {kind} moving;")
    extra = variables(f'<variable type="{kind}" name="moving" system="{name}" />')
    session = Session(write_project(tmp_path, shader_pass(extra=extra)))
    assert session.viewer.step() and session.viewer.step()


def test_the_pointer_is_in_shares_of_the_window_from_its_lower_left(tmp_path):
    write_quad(tmp_path, "color.rgb = vec3(mouse.xy, mouse.z);", "uniform vec4 mouse;")
    extra = variables('<variable type="float4" name="mouse" system="Mouse" />')
    session = Session(write_project(tmp_path, shader_pass(extra=extra)))
    session.do(Event(Kind.MOVE, x=3, y=1), Event(Kind.BUTTON, 0, 1, 3, 1), Event(Kind.MOVE, x=3, y=1))
    assert session.pixel == [128, 191, 255]


def test_arrows_walk_the_first_person(tmp_path):
    tags = "<positionX>0</positionX><positionY>0</positionY><positionZ>0</positionZ><yaw>0</yaw><pitch>0</pitch>"
    settings = f'<entry type="camera" fp="true">{tags}</entry>'
    session = Session(write_quad(tmp_path, "", settings=settings))
    session.press(265)
    for _ in range(3):
        session.viewer.step()
    x, y, z = session.viewer.camera.position
    assert (x, y) == (0, 0) and z < 0
    session.do(Event(Kind.KEY, 265, 0))
    stopped = session.viewer.camera
    session.viewer.step()
    assert session.viewer.camera == stopped


def test_what_cannot_be_drawn_to_begin_with_is_an_error(tmp_path):
    path = write_quad(tmp_path, "color = wrong;")
    with pytest.raises(HarnessError, match="wrong"):
        Viewer(path, Pane(), SIZE)
