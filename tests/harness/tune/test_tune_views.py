"""Views round a scene: by where the cameras are and what they look at."""

from __future__ import annotations

import numpy as np
import pytest
import tune_scenes

from harness.projects import sprj
from harness.rendering import camera
from harness.tune import views

ARCBALL = '<entry type="camera" fp="false"><distance>5</distance><pitch>20</pitch><yaw>200</yaw><roll>0</roll></entry>'


def project(folder, entry: str = ARCBALL):
    text = tune_scenes.text({"albedo": (1, 1, 1), "roughness": (1,), "metalness": (0,)})
    assert text.count(ARCBALL) == 1
    return sprj.read(tune_scenes.write(folder, text.replace(ARCBALL, entry)))


def first_person(x: float, y: float, z: float, pitch: float = 5, yaw: float = -4) -> str:
    place = f"<positionX>{x}</positionX><positionY>{y}</positionY><positionZ>{z}</positionZ>"
    return f'<entry type="camera" fp="true">{place}<yaw>{yaw}</yaw><pitch>{pitch}</pitch></entry>'


def forward(view) -> np.ndarray:
    """The direction of the middle of the picture: the third row of the view matrix, turned round."""
    return -camera.view(view)[2, :3]


def test_an_arcball_camera_goes_round_at_its_distance(tmp_path):
    shown = project(tmp_path)
    found = views.orbit(shown, 8)
    assert found[0] == shown.settings.camera and len(found) == 8
    places = np.array([camera.position(v) for v in found])
    np.testing.assert_allclose(np.linalg.norm(places, axis=1), 5, rtol=1e-6)
    np.testing.assert_allclose([np.degrees(np.arcsin(p[1] / 5)) for p in places], [20, 40, 20, 0] * 2, atol=1e-3)
    turned = np.degrees(np.arctan2(places[:, 0], places[:, 2]))
    np.testing.assert_allclose(np.diff(np.unwrap(turned, period=360)), 45, atol=1e-3)


def test_no_view_is_from_beyond_the_poles(tmp_path):
    steep = project(tmp_path, ARCBALL.replace("<pitch>20<", "<pitch>80<"))
    assert [v.pitch for v in views.orbit(steep, 4)] == [80, 85, 80, 60]


@pytest.mark.parametrize("place", [(0, 0, 6), (3, 1.5, -2), (-4, 0, 0)])
def test_a_first_person_camera_goes_round_the_items(tmp_path, place):
    """The items of the scene are at -1.1 and 1.1 on the x axis: their middle is the origin."""
    shown = project(tmp_path, first_person(*place))
    found = views.orbit(shown, 6)
    assert found[0] == shown.settings.camera
    for view in found[1:]:
        away = camera.position(view)
        np.testing.assert_allclose(np.linalg.norm(away), np.linalg.norm(place), rtol=1e-5)
        np.testing.assert_allclose(forward(view), -away / np.linalg.norm(away), atol=1e-5)
    # The third view is a third of the way round, at the height of the first.
    start, third = np.array(place, float), camera.position(found[2])
    np.testing.assert_allclose(third[1], start[1], atol=1e-5)
    turn = np.degrees(np.arctan2(*third[[0, 2]]) - np.arctan2(*start[[0, 2]])) % 360
    assert turn == pytest.approx(120, abs=1e-3)


def test_a_first_person_camera_in_the_middle_turns_where_it_is(tmp_path):
    found = views.orbit(project(tmp_path, first_person(0, 0, 0)), 4)
    assert {v.position for v in found} == {(0, 0, 0)} and len({v.yaw for v in found}) == 4


def test_all_views_are_in_the_description(tmp_path):
    described = views.described(views.orbit(project(tmp_path), 4))
    assert described == "distance 5, yaw/pitch 200/20 290/40 20/20 110/0"
