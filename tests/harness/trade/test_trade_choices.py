"""What is measured of a ladder, and what a ladder lacks for it."""

from __future__ import annotations

import pickle

import pytest

from harness.errors import LadderError
from harness.projects import sprj
from harness.trade.choices import choices, defaults


def read(small, **how):
    path, ladder = small(**how)
    return sprj.read(path), ladder


def test_every_rung_and_preset_is_a_choice(small):
    project, ladder = read(small)
    found = {c.name: c for c in choices(project, ladder)}
    assert list(found) == ["GAIN_ONE", "GAIN_MORE", "TONE_PLAIN", "TONE_TWICE", "exact"]
    more, plain, exact = found["GAIN_MORE"], found["TONE_PLAIN"], found["exact"]
    assert (more.own, more.whole, exact.own) == ("gain", "shade", "shade")
    assert (plain.own, plain.whole) == ("tone", "tone"), "its file has no shade()"
    assert more.macros == {"GAIN": "GAIN_MORE"} and more.exact == {"GAIN": "GAIN_ONE"}
    assert more.function("gain")(2.0) == 2.5 and more.function("gain", more.exact)(2.0) == 2


def test_a_picture_differs_from_the_references_by_the_rung_alone(small):
    """Though the default of another term is not the reference's."""
    (more,) = choices(*read(small), "GAIN_MORE")
    assert more.reference == {"GAIN": "GAIN_ONE", "TONE": "TONE_TWICE"}
    assert more.scene == {"GAIN": "GAIN_MORE", "TONE": "TONE_TWICE"}


def test_one_by_its_name(small):
    project, ladder = read(small)
    assert [c.name for c in choices(project, ladder, "GAIN_MORE")] == ["GAIN_MORE"]
    with pytest.raises(LadderError, match="did you mean GAIN_MORE"):
        choices(project, ladder, "GAIN_MROE")


def test_the_defaults_are_those_of_the_shaders(small):
    assert defaults(*read(small)) == {"GAIN": "GAIN_ONE", "TONE": "TONE_PLAIN"}


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
