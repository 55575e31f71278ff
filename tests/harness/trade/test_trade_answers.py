"""Which preset is answered: each rule, by a trade in which one figure decides."""

from __future__ import annotations

import math

import pytest
import trade_data

from harness.trade import answers


@pytest.fixture
def data():
    return trade_data.trade()


def preset(data, name):
    return next(p for p in data["presets"] if p["name"] == name)


def named(data):
    return [answer.name for answer in answers.answers(data)]


def test_three_uses_are_answered(data):
    assert [answer.use for answer in answers.answers(data)] == ["a phone", "a desktop", "ground truth"]
    assert named(data) == ["mobile", "desktop", "offline"]


def test_a_phone_gets_nothing_that_breaks_in_half_precision(data):
    for name in ("mobile", "exact"):
        preset(data, name)["extremes"]["mediump"]["negative"] = 1
    preset(data, "offline")["extremes"]["mediump"]["non_finite"] = 0
    assert named(data)[0] == "offline"


def test_where_all_break_in_half_precision_a_phone_gets_what_breaks_least_and_is_told(data):
    preset(data, "mobile")["extremes"]["mediump"]["non_finite"] = 11
    phone = answers.answers(data)[0]
    assert phone.name == "exact"
    assert "10 of 1\xa0048\xa0576" in phone.why
    assert "10 of 1\xa0048\xa0576 extreme inputs break in half precision" in phone.gives_up


def test_of_what_is_sound_a_phone_gets_the_cheapest(data):
    preset(data, "offline")["extremes"]["mediump"]["non_finite"] = 0
    preset(data, "offline")["cost"]["spirv"] = preset(data, "mobile")["cost"]["spirv"] - 1
    assert named(data)[0] == "offline"


def test_a_desktop_gets_nothing_that_breaks_in_single_precision(data):
    preset(data, "desktop")["extremes"]["precise"]["non_finite"] = 1
    assert named(data)[1] == "exact"


def test_a_desktop_gets_a_picture_that_is_the_references_within_a_code(data):
    preset(data, "desktop")["scene"]["max"] = 2.0
    assert named(data)[1] == "exact"
    preset(data, "desktop")["scene"]["max"] = 1.0
    assert named(data)[1] == "desktop"


def test_the_reference_draws_its_own_picture(data):
    for entry in data["presets"]:
        entry["scene"] = None
    assert named(data)[1] == "exact"


def test_ground_truth_makes_no_light(data):
    """However accurate the others are."""
    preset(data, "exact")["roundoff"] = preset(data, "exact")["roundoff"] | dict.fromkeys(
        ("as-written", "precise"), trade_data.spread(1e-9)
    )
    assert named(data)[2] == "offline"


def test_where_all_make_light_ground_truth_is_the_most_accurate_and_says_so(data):
    for returned in (1.9, math.nan, None):
        preset(data, "offline")["energy"]["furnace_max"] = returned
        truth = answers.answers(data)[2]
        assert truth.name == "exact" and "all of them make light" in truth.why


def test_of_what_makes_no_light_ground_truth_rounds_least(data):
    preset(data, "mobile")["energy"]["furnace_max"] = 1.0
    assert named(data)[2] == "offline"
    for mode in ("as-written", "precise"):
        preset(data, "mobile")["roundoff"][mode]["p99"] = 1e-7
    assert named(data)[2] == "mobile"


def test_what_one_gives_up_is_in_figures(data):
    phone, desktop, truth = answers.answers(data)
    assert "up to 23/255 of the scene's picture (ꟻLIP 0.06, 46 % of the pixels change)" in phone.gives_up
    assert not any("more cycles" in phrase for phrase in phone.gives_up)
    # 250 + 107 + 107 cycles for 210 + 88 + 88
    assert any(phrase.startswith("20 % more cycles than mobile") for phrase in desktop.gives_up)
    # 480 + 190 + 190
    assert any(phrase.startswith("123 % more cycles than mobile") for phrase in truth.gives_up)


def test_times_are_compared_on_one_device_only(data):
    preset(data, "mobile")["time"].pop()
    (speed,) = (phrase for phrase in answers.answers(data)[2].gives_up if "cycles" in phrase)
    assert "2.1 ns for 0.6 on llvmpipe" in speed and "GPU" not in speed


@pytest.mark.parametrize("part", ["extremes", "cost", "energy"])
def test_what_was_not_measured_is_not_answered_but_said(data, part):
    said = answers.answers(trade_data.without(data, part, "no driver"))
    unanswered = {"extremes": [0, 1, 2], "cost": [0, 1], "energy": [2]}[part]
    assert [n for n, answer in enumerate(said) if answer.name is None] == unanswered
    assert all("no preset has" in said[n].why for n in unanswered)


def test_without_a_driver_the_weighted_count_decides(data):
    for entry in data["presets"]:
        entry["cost"] = {"spirv": entry["cost"]["spirv"]} | dict.fromkeys(data["targets"])
    assert named(data) == ["mobile", "desktop", "offline"]
    assert "97 weighted SPIR-V operations" in answers.answers(data)[1].why


def test_where_nothing_cheaper_draws_the_same_the_reference_is_said_to_be_it(data):
    preset(data, "desktop")["scene"]["max"] = 2.0
    assert "no cheaper one that is finite" in answers.answers(data)[1].why
