"""What is measured of a ladder, and what a ladder lacks for it."""

from __future__ import annotations

import pickle

import pytest

from harness import sprj
from harness.errors import LadderError
from harness.trade.choices import choices, defaults


def read(small, **how):
    path, ladder = small(**how)
    return sprj.read(path), ladder


def test_every_rung_and_preset_is_a_choice(small):
    project, ladder = read(small)
    one, more, exact = choices(project, ladder)
    assert [c.name for c in (one, more, exact)] == ["GAIN_ONE", "GAIN_MORE", "exact"]
    assert (more.own, more.whole, exact.own) == ("gain", "shade", "shade")
    assert more.macros == more.scene == {"GAIN": "GAIN_MORE"} and more.exact == more.reference == {"GAIN": "GAIN_ONE"}
    assert more.function("gain")(2.0) == 2.5 and more.function("gain", more.exact)(2.0) == 2


def test_one_by_its_name(small):
    project, ladder = read(small)
    assert [c.name for c in choices(project, ladder, "GAIN_MORE")] == ["GAIN_MORE"]
    with pytest.raises(LadderError, match="did you mean GAIN_MORE"):
        choices(project, ladder, "GAIN_MROE")


def test_a_picture_differs_by_the_rung_alone(root):
    """Where the defaults are not the reference preset, as with the decoding of sRGB, the picture takes the preset's."""
    from harness import ladder

    project = sprj.read(root / "project.sprj")
    (root_ladder,) = [ladder.of_project(project)]
    exact = root_ladder.preset("exact").macros
    try:
        found = choices(project, root_ladder, "V_HAMMON")
    except LadderError as error:
        pytest.skip(f"the shaders are not there yet: {error}")
    assert found[0].scene == {**exact, "BRDF_V": "V_HAMMON"} and found[0].macros == {"BRDF_V": "V_HAMMON"}


def test_the_defaults_are_those_of_the_shaders(small):
    assert defaults(*read(small)) == {"GAIN": "GAIN_ONE"}


def test_it_can_be_sent_to_another_process_after_it_was_compiled(small):
    (choice,) = choices(*read(small), "GAIN_MORE")
    choice.function("gain")
    assert pickle.loads(pickle.dumps(choice)).function("gain")(2.0) == 2.5


def test_a_function_that_is_not_there_is_told_with_the_term(small):
    with pytest.raises(LadderError, match='ladder.toml: term "gain": brdf.glsl has no function gain'):
        choices(*read(small, model="float gian(float x) { return x; }"))


def test_presets_need_the_whole_model(small):
    with pytest.raises(LadderError, match="no.* function shade"):
        choices(*read(small, model="float gain(float x) { return x; }"))
