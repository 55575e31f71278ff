"""Writing the camera back. Expected: the numbers, and every other byte, as a text editor would change them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from harness import ProjectError
from harness.projects import sprj
from harness.projects.camera_entry import write_camera
from harness.projects.project import ArcballCamera, FirstPersonCamera

CAMERA = (
    '<entry type="camera" fp="false"><distance> 15 </distance><!-- up --><pitch>16</pitch>'
    "<yaw>1.8e2</yaw>\r\n\t<roll>0</roll></entry>"
)
TEXT = """<?xml version="1.0"?>\r
<project  version='2'>\r
  <pipeline></pipeline> <!-- ä 15 16 -->\r
  <settings><entry type="clearcolor" r="0.1" /><entry type="ipaths"><path>15</path></entry>{}</settings>\r
  <settings><entry type="camera"><distance>15</distance></entry></settings>\r
</project>"""


def write(folder: Path, camera: str = CAMERA, text: str = TEXT) -> Path:
    path = folder / "p.sprj"
    path.write_bytes(text.format(camera).encode())
    return path


def test_only_the_numbers_change(tmp_path):
    path = write(tmp_path)
    write_camera(path, ArcballCamera(distance=12.5, pitch=-7.25, yaw=180.0, roll=0.0))
    camera = CAMERA.replace(" 15 ", " 12.5 ").replace(">16<", ">-7.25<")  # yaw is the number that it was
    assert path.read_bytes() == TEXT.format(camera).encode()


def test_what_is_written_is_read_again_to_the_last_bit(tmp_path):
    path = write(tmp_path)
    camera = ArcballCamera(distance=7.123456954956055, pitch=1e-7, yaw=359.9999694824219, roll=0.10000000149011612)
    write_camera(path, camera)
    there = sprj.read(path).settings.camera
    for name in ("distance", "pitch", "yaw", "roll"):
        assert np.float32(getattr(there, name)) == np.float32(getattr(camera, name))


def test_the_first_person_camera(tmp_path):
    tags = "<positionX>1</positionX><positionY>2</positionY><positionZ>3</positionZ><yaw>4</yaw><pitch>5</pitch>"
    entry = f'<entry type="camera" fp="true">{tags}</entry>'
    path = write(tmp_path, entry)
    write_camera(path, FirstPersonCamera((1.0, 2.5, 3.0), pitch=5.0, yaw=-4.0, line=1))
    changed = entry.replace(">2<", ">2.5<").replace(">4<", ">-4<")
    assert path.read_bytes() == TEXT.format(changed).encode()


def test_of_two_entries_the_last_is_written_as_it_is_read(tmp_path):
    path = write(tmp_path, CAMERA + CAMERA)
    write_camera(path, ArcballCamera(15.0, 16.0, 90.0, 0.0))
    assert path.read_bytes() == TEXT.format(CAMERA + CAMERA.replace("1.8e2", "90")).encode()


def test_version_1_has_names_of_its_own(tmp_path):
    entry = (
        '<entry type="camera" fp="false"><distance>5</distance><rotationX>1</rotationX><rotationY>2</rotationY>'
        "<rotationZ>3</rotationZ></entry>"
    )
    text = TEXT.replace("version='2'", "version='1'")
    path = write(tmp_path, entry, text)
    write_camera(path, ArcballCamera(distance=5.0, pitch=20.0, yaw=1.0, roll=3.0))
    assert path.read_bytes() == text.format(entry.replace(">2<", ">20<")).encode()


ENTRY = '<entry type="camera" fp="false"><distance>3</distance><pitch>1.5</pitch><yaw>20</yaw><roll>0</roll></entry>'


@pytest.mark.parametrize(
    ("settings", "written"),
    [
        ("\n  <settings>\n    <entry/>\n  </settings>\n", "\n  <settings>\n    {}\n    <entry/>\n  </settings>\n"),
        ("\r\n\t<settings a='>' />\r\n", "\r\n\t<settings a='>'>\r\n\t\t{}\r\n\t</settings>\r\n"),
        ("\n  <settings></settings>\n", "\n  <settings>\n    {}</settings>\n"),
        ("\n", "\n  <settings>\n    {}\n  </settings>\n"),
        ("<pipeline/><settings><!-- x --></settings>", "<pipeline/><settings>\n  {}<!-- x --></settings>"),
    ],
)
def test_a_file_without_a_camera_gets_one_and_keeps_the_rest(tmp_path, settings, written):
    path = tmp_path / "p.sprj"
    path.write_bytes(f'<project version="2">{settings}</project>\n'.encode())
    camera = ArcballCamera(distance=3.0, pitch=1.5, yaw=20.0, roll=0.0)
    write_camera(path, camera)
    assert path.read_bytes().decode() == f'<project version="2">{written.format(ENTRY)}</project>\n'
    there = sprj.read(path).settings.camera
    assert (there.distance, there.pitch, there.yaw, there.roll) == (3.0, 1.5, 20.0, 0.0)


def test_a_first_person_camera_is_added_too(tmp_path):
    path = tmp_path / "p.sprj"
    path.write_text('<project version="2"><settings/></project>')
    write_camera(path, FirstPersonCamera((1.0, -2.5, 3.0), pitch=5.0, yaw=-4.0, line=1))
    there = sprj.read(path).settings.camera
    assert (there.position, there.pitch, there.yaw) == ((1.0, -2.5, 3.0), 5.0, -4.0)


def test_a_file_in_utf_16_is_left_alone(tmp_path):
    path = tmp_path / "p.sprj"
    text = f'<?xml version="1.0" encoding="utf-16"?><project version="2"><settings>{ENTRY}</settings></project>'
    path.write_bytes(before := text.encode("utf-16"))
    with pytest.raises(ProjectError, match="UTF-16: save it as UTF-8"):
        write_camera(path, ArcballCamera(5.0, 1.0, 2.0, 3.0))
    assert path.read_bytes() == before


def test_a_file_that_is_the_same_is_not_touched(tmp_path):
    path = write(tmp_path)
    before = path.stat()
    write_camera(path, ArcballCamera(15.0, 16.0, 180.0, 0.0))
    assert path.stat().st_mtime_ns == before.st_mtime_ns and path.stat().st_ino == before.st_ino


def test_links_and_modes_stay(tmp_path):
    path = write(tmp_path)
    path.chmod(0o600)
    link = tmp_path / "link.sprj"
    link.symlink_to(path)
    write_camera(link, ArcballCamera(20.0, 16.0, 180.0, 0.0))
    assert link.is_symlink() and b"> 20 <" in path.read_bytes()
    assert path.stat().st_mode & 0o777 == 0o600
    assert sorted(p.name for p in tmp_path.iterdir()) == ["link.sprj", "p.sprj"]


def test_the_kind_of_the_camera_does_not_change(tmp_path):
    path = write(tmp_path)
    with pytest.raises(ProjectError, match=r"p\.sprj:4: .*of another kind"):
        write_camera(path, FirstPersonCamera((0.0, 0.0, 0.0), 0.0, 0.0, 1))
