"""Settings and camera snapshots, as the reader gives them."""

from __future__ import annotations

import pytest
from sprj_files import line_of, read, refusal, row, shader_pass, warned, write_project

from harness.projects.project import ArcballCamera, FirstPersonCamera


def test_default_settings(tmp_path):
    settings = read(write_project(tmp_path, shader_pass())).settings
    assert (settings.camera, settings.clear_color, settings.use_alpha) == (
        ArcballCamera(4, 28, 317, 0),
        (0, 0, 0, 0),
        False,
    )


def test_include_dirs_end_with_the_project_folder(tmp_path):
    settings = '<entry type="ipaths"><path>a</path><path>../b/</path></entry>'
    project = read(write_project(tmp_path, shader_pass(), settings=settings))
    assert project.include_dirs == [tmp_path / "a", tmp_path / "../b", tmp_path]


def test_first_person_camera(tmp_path):
    settings = """<entry type="camera" fp="true"><positionX>1</positionX>
<positionY>2</positionY><positionZ>3</positionZ><yaw>40</yaw><pitch>5</pitch></entry>"""
    path = write_project(tmp_path, shader_pass(), settings=settings)
    assert read(path).settings.camera == FirstPersonCamera((1, 2, 3), 5, 40, line_of(path, '"camera"'))


def test_a_camera_entry_must_be_complete(tmp_path):
    settings = '<entry type="camera" fp="false"><distance>6</distance><pitch>0</pitch><yaw>0</yaw></entry>'
    path = write_project(tmp_path, shader_pass(), settings=settings)
    error = refusal(path)
    assert "no <roll>" in error.message and error.line == line_of(path, '"camera"')


def test_of_two_entries_the_last_holds(tmp_path):
    settings = '<entry type="clearcolor" r="1" g="1" /><entry type="clearcolor" g="0.5" a="2" />'
    assert read(write_project(tmp_path, shader_pass(), settings=settings)).settings.clear_color == (1, 0.5, 0, 2)


def test_entries_of_the_editor_are_passed_over(tmp_path):
    kinds = ("property", "file", "pinned", "watch_expr", "vecwatch_expr", "bkpt")
    settings = "".join(f'<entry type="{kind}" name="x" />' for kind in kinds)
    assert len(read(write_project(tmp_path, shader_pass(), settings=settings)).passes) == 1


def test_an_entry_that_is_none(tmp_path):
    _, warning = warned(write_project(tmp_path, shader_pass(), settings='<entry type="gamma" />'))
    assert 'the setting "gamma" is none' in warning.message


def test_backslashes_in_include_paths(tmp_path):
    settings = r'<entry type="ipaths"><path>a\b</path></entry>'
    _, warning = warned(write_project(tmp_path, shader_pass(), settings=settings))
    assert "backslashes do not work" in warning.message


@pytest.mark.parametrize("text, words", [("far", "not a number: SHADERed crashes"), ("1e99", "SHADERed crashes")])
def test_numbers_of_the_camera_that_crash_shadered(tmp_path, text, words):
    settings = f"""<entry type="camera"><distance>{text}</distance>
<pitch>0</pitch><yaw>0</yaw><roll>0</roll></entry>"""
    assert words in refusal(write_project(tmp_path, shader_pass(), settings=settings)).message


def test_the_rows_of_a_snapshot_are_those_of_its_matrix(tmp_path):
    camera = '<camera name="c">' + "".join(row(*(10 * r + c for c in range(4))) for r in range(4)) + "</camera>"
    project = read(write_project(tmp_path, shader_pass(), rest=f"<cameras>{camera}</cameras>"))
    # Column by column, as GLSL has it.
    assert project.cameras == {"c": tuple(10 * r + c for c in range(4) for r in range(4))}


def test_what_a_snapshot_does_not_say_is_the_identity(tmp_path):
    project = read(write_project(tmp_path, shader_pass(), rest='<cameras><camera name="c" /></cameras>'))
    assert project.cameras["c"] == (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)


def test_of_two_snapshots_the_first_holds(tmp_path):
    cameras = f'<cameras><camera name="c">{row(5)}</camera>\n<camera name="c">{row(6)}</camera></cameras>'
    project, warning = warned(write_project(tmp_path, shader_pass(), rest=cameras))
    assert project.cameras["c"][0] == 5 and 'there is a camera "c" already' in warning.message


def test_a_snapshot_of_five_rows(tmp_path):
    cameras = f'<cameras><camera name="c">{row(1) * 5}</camera></cameras>'
    assert "more than 4 rows" in refusal(write_project(tmp_path, shader_pass(), rest=cameras)).message
