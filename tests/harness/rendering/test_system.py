"""The values that SHADERed gives to variables, frame by frame."""

from __future__ import annotations

import numpy as np
import pytest
from sprj_files import item, read, shader_pass, write_project

from harness.rendering.system import Moment, System

PLACED = "<type>ScreenQuad</type><x>0.25</x><y>-0.5</y><scaleX>0.5</scaleX><scaleY>2</scaleY>"
MOVED = "<type>Cube</type><x>3</x><y>4</y><z>5</z>"


@pytest.fixture
def project(tmp_path):
    return read(write_project(tmp_path, shader_pass(items=item("S", PLACED) + item("C", MOVED))))


@pytest.fixture
def system(project):
    system = System(project, (40, 20))
    system.begin(Moment(0, 1.5, 0.25))
    return system


def test_a_screen_quad_is_placed_in_shares_of_the_target_from_its_middle(project, system):
    quad = project.passes[0].items[0]
    system.set_item(quad)
    expected = [[0.5 * 40, 0, 0, 0.75 * 40], [0, 2 * 20, 0, 0], [0, 0, 1, -1000], [0, 0, 0, 1]]
    np.testing.assert_array_equal(system.value("GeometryTransform", quad), expected)


def test_sizes_are_the_targets_and_of_the_last_frame_those_of_its_last_pass(system):
    seen = []
    for frame in range(2):
        system.begin(Moment(frame))
        for size in ((8, 4), (40, 20), (2, 2)):
            system.set_size(size)
            seen.append((*system.value("ViewportSize", None), *system.value("ViewportSize", None, last=True)))
    assert seen[3:] == [(8, 4, 2, 2), (40, 20, 2, 2), (2, 2, 2, 2)]


def test_times_and_frames_of_the_last_frame(system):
    system.begin(Moment(7, 2.0, 0.5))
    assert system.value("TimeDelta", None) == 0.5 and system.value("TimeDelta", None, last=True) == 0.25
    assert system.value("FrameIndex", None) == 7 and system.value("FrameIndex", None, last=True) == 0
    assert system.value("Time", None) == system.value("Time", None, last=True) == 2


def test_matrices_of_the_last_frame(project, system):
    cube = project.passes[0].items[1]
    system.set_item(cube)
    assert (system.value("GeometryTransform", cube, last=True) == 0).all()
    system.begin(Moment(1))
    assert system.value("GeometryTransform", cube, last=True)[:3, 3].tolist() == [3, 4, 5]


def test_nobody_moves_mouse_and_keys(system):
    for name in ("MousePosition", "Mouse", "MouseButton", "KeysWASD", "PickPosition", "IsPicked"):
        assert not system.value(name, None).any()
    assert system.value("IsSavingToFile", None)
