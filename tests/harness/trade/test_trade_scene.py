"""Pictures of a project under macros, and how far pictures are apart. Expected: counted by hand on made-up pictures."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CompareError, HarnessError
from harness.trade import scene
from harness.viewing import view_macros

needs_flip = pytest.mark.skipif(scene.flip_unavailable() is not None, reason=str(scene.flip_unavailable()))


@pytest.fixture
def grey():
    picture = np.full((10, 20, 4), 100, np.uint8)
    picture[..., 3] = 255
    return picture


def test_a_picture_differs_from_itself_in_nothing(grey):
    assert scene.difference(grey, grey, flip=False) == scene.Difference(0, 0, None, 0)


def test_differences_are_counted_in_codes(grey):
    """One channel by 30 and one by -12, of 600; in 2 pixels of 200."""
    other = grey.copy()
    other[3, 4, 1] += 30
    other[5, 6, 2] -= 12
    found = scene.difference(other, grey, flip=False)
    assert found.max == 30 and found.mean == pytest.approx(42 / 600) and found.changed == pytest.approx(2 / 200)


def test_codes_do_not_wrap(grey):
    white = np.full_like(grey, 255)
    black = np.zeros_like(grey)
    assert scene.difference(black, white, flip=False).max == scene.difference(white, black, flip=False).max == 255


def test_alpha_is_not_seen(grey):
    other = grey.copy()
    other[..., 3] = 0
    assert scene.difference(other, grey, flip=False).changed == 0


def test_pictures_that_cannot_be_compared_are_refused(grey):
    with pytest.raises(CompareError, match="10, 20"):
        scene.difference(grey, grey[:5])
    with pytest.raises(CompareError, match="uint8"):
        scene.difference(grey / 255.0, grey)


@needs_flip
def test_flip_sees_no_difference_of_a_picture_and_itself(grey):
    assert scene.flip_mean(grey, grey) == 0


@needs_flip
def test_flip_sees_most_between_black_and_white_and_less_between_greys(grey):
    """Black against white is nearly all the difference that there can be, a single code of 255 nearly none."""
    white, black = np.full((64, 64, 3), 255, np.uint8), np.zeros((64, 64, 3), np.uint8)
    assert scene.flip_mean(black, white) > 0.9
    assert 0 < scene.flip_mean(grey + np.uint8(1), grey) < 0.05


@needs_flip
def test_flip_leaves_the_pictures_as_they_are(grey):
    before = grey.copy()
    scene.difference(grey, grey[::-1])
    assert np.array_equal(grey, before)


def test_without_the_package_flip_is_refused_and_the_rest_is_there(grey, monkeypatch):
    monkeypatch.setattr(scene, "flip_unavailable", lambda: "flip-evaluator is not installed")
    assert scene.difference(grey, grey).flip is None
    with pytest.raises(HarnessError, match="not installed"):
        scene.flip_mean(grey, grey)


def test_a_project_under_the_macros_that_it_has_is_the_project(root):
    """HAMMON changes it, and what it says itself does not."""
    from harness import render
    from harness.projects import sprj

    own = {
        ladder.name: view_macros.own_rung(project, ladder)
        for project in [sprj.read(root / "project.sprj")]
        for ladder in view_macros.find(project).ladders
        if ladder.name == "BRDF_V"
    }
    size = (96, 54)
    plain = render(root / "project.sprj", size)
    assert np.array_equal(scene.picture(root / "project.sprj", own, size), plain)
    assert not np.array_equal(scene.picture(root / "project.sprj", {"BRDF_V": "V_HAMMON"}, size), plain)


def test_a_macro_that_does_not_compile_is_told_with_its_file(root):
    with pytest.raises(HarnessError, match="glsl"):
        scene.picture(root / "project.sprj", {"BRDF_V": "1 1"}, (16, 9))
