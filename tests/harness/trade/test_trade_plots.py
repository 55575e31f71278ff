"""The plots: marks where the figures are, and labels that can be read."""

from __future__ import annotations

import math
from itertools import combinations

import pytest
import trade_data
from hypothesis import given, settings
from hypothesis import strategies as st

from harness.trade import plots
from harness.trade.plots import RADIUS, Box

FRAME = Box(0, 0, plots.WIDTH - plots.LEFT - plots.RIGHT, plots.HEIGHT - plots.TOP - plots.BOTTOM)


@pytest.fixture
def data():
    return trade_data.trade()


def panels(data, target="navi21"):
    return {panel.title: panel for panel in plots.plot(data, target).panels}


def mark(panel, label):
    return next(m for m in panel.marks if m.label == label)


def test_there_is_a_panel_for_the_presets_and_one_for_each_term(data):
    assert list(panels(data)) == ["Presets", *(term["title"] for term in data["terms"])]


def test_every_entry_is_a_mark(data):
    assert [m.label for m in panels(data)["Visibility"].marks] == [
        "EXACT", "HAMMON", "SCHLICK", "KARIS", "SEPARABLE", "KELEMEN"
    ]  # fmt: skip


def test_costs_lie_as_their_ticks_say(data):
    panel = panels(data)["Visibility"]
    (one, first), *_, (other, last) = [(x, float(label)) for x, label in panel.x_ticks]
    assert mark(panel, "EXACT").x == pytest.approx(one + (114 - first) / (last - first) * (other - one))


def test_errors_lie_as_their_ticks_say_on_a_logarithmic_axis(data):
    panel = panels(data)["Visibility"]
    (one, first), *_, (other, last) = [(y, math.log10(float(label))) for y, label in panel.y_ticks]
    # the error of the formula and that of rounding
    wanted = math.log10(0.27 + 2e-7)
    assert mark(panel, "HAMMON").y == pytest.approx(one + (wanted - first) / (last - first) * (other - one))


def test_all_panels_have_the_same_errors_at_the_same_height(data):
    ticks = [[(y - panel.frame.top, label) for y, label in panel.y_ticks] for panel in panels(data).values()]
    assert all([label for _, label in t] == [label for _, label in ticks[0]] for t in ticks)
    assert all([y for y, _ in t] == pytest.approx([y for y, _ in ticks[0]]) for t in ticks)


def test_the_dominated_are_marked_with_by_whom(data):
    panel = panels(data)["Visibility"]
    assert {m.label: m.by for m in panel.marks if m.by} == {
        "SCHLICK": "V_HAMMON",
        "KARIS": "V_HAMMON",
        "SEPARABLE": "V_HAMMON",
    }
    assert "dominated by V_HAMMON" in mark(panel, "KARIS").tip


def test_the_default_is_marked(data):
    assert [m.label for m in panels(data)["Distribution"].marks if m.default] == ["CROSS"]


def test_an_error_that_is_infinite_or_0_is_within_the_frame(data):
    data["terms"][1]["rungs"][1]["model"]["p99"] = math.inf
    data["terms"][1]["rungs"][2]["model"]["p99"] = 0.0
    for mode in ("as-written", "precise"):
        data["terms"][1]["rungs"][2]["roundoff"][mode]["p99"] = 0.0
    panel = panels(data)["Visibility"]
    for label in ("HAMMON", "SCHLICK"):
        assert panel.frame.top <= mark(panel, label).y <= panel.frame.bottom


def test_a_target_that_nothing_was_measured_on_has_no_plot(data):
    assert plots.plot(data, "polaris10") is None


def inside(box, frame):
    return box.left >= frame.left and box.top >= frame.top and box.right <= frame.right and box.bottom <= frame.bottom


def test_panels_do_not_overlap(data):
    made = plots.plot(data, "vega10")
    for one, other in combinations(made.panels, 2):
        assert one.frame.overlap(other.frame) == 0
    assert all(inside(p.frame, Box(0, 0, made.width, made.height)) for p in made.panels)


@pytest.mark.parametrize("target", trade_data.TARGETS)
def test_no_label_covers_another_or_a_mark(data, target):
    for panel in plots.plot(data, target).panels:
        for one, other in combinations(panel.marks, 2):
            assert one.box.overlap(other.box) == 0, (one.label, other.label)
        for m in panel.marks:
            assert inside(m.box, panel.frame)
            assert all(m.box.overlap(Box(o.x - 4, o.y - 4, o.x + 4, o.y + 4)) == 0 for o in panel.marks)


@settings(max_examples=50)
@given(
    st.lists(st.tuples(st.floats(20, FRAME.right - 20), st.floats(10, FRAME.bottom - 10)), min_size=1, max_size=7),
    st.booleans(),
)
def test_labels_find_room_wherever_their_marks_are(places, together):
    """Seven rungs, as many as any term has, be they all in one place."""
    places = [places[0]] * 7 if together else places
    labels = [f"RUNG_{n}" for n in range(len(places))]
    boxes = plots.place(places, labels, FRAME)
    for one, other in combinations(boxes, 2):
        assert one.overlap(other) == 0
    for box in boxes:
        assert inside(box, FRAME)
        for x, y in places:
            assert box.overlap(Box(x - RADIUS, y - RADIUS, x + RADIUS, y + RADIUS)) == 0


def test_a_label_that_has_room_is_right_of_its_mark():
    (box,) = plots.place([(50.0, 50.0)], ["A"], FRAME)
    assert box.left == 50 + RADIUS + 1 and box.top < 50 < box.bottom
