"""Dominance: an order without cycles, whose undominated choices are the front."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from harness.trade import pareto
from harness.trade.pareto import Point, dominates

# Few values, so that ties are met often; and infinity, the error of what breaks.
NUMBERS = st.sampled_from([0.0, 1.0, 2.0, 3.0, float("inf")])
POINTS = st.lists(st.tuples(NUMBERS, NUMBERS), max_size=8).map(
    lambda pairs: [Point(f"p{n}", *pair) for n, pair in enumerate(pairs)]
)


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [
        ((1, 1), (2, 2), True),
        ((1, 1), (1, 2), True),
        ((1, 1), (2, 1), True),
        ((1, 1), (1, 1), False),
        ((1, 2), (2, 1), False),
        ((2, 1), (1, 2), False),
        ((2, 2), (1, 1), False),
    ],
)
def test_dominance_is_no_worse_in_both_and_better_in_one(one, other, expected):
    assert dominates(Point("one", *one), Point("other", *other)) is expected


@given(POINTS)
def test_dominance_is_a_strict_order(points):
    for a, b in product(points, points):
        assert not (dominates(a, b) and dominates(b, a))
    for a, b, c in product(points, points, points):
        if dominates(a, b) and dominates(b, c):
            assert dominates(a, c)


@given(POINTS)
def test_every_choice_is_on_the_front_or_dominated_by_one_that_is(points):
    front = {point.name for point in pareto.front(points)}
    dominated = pareto.dominated(points)
    assert front | set(dominated) == {point.name for point in points}
    assert not front & set(dominated)
    assert set(dominated.values()) <= front
    by_name = {point.name: point for point in points}
    for name, by in dominated.items():
        assert dominates(by_name[by], by_name[name])


@given(POINTS)
def test_along_the_front_what_costs_more_errs_less(points):
    front = pareto.front(points)
    for before, after in zip(front, front[1:], strict=False):
        assert (before.cost < after.cost and before.error > after.error) or (
            (before.cost, before.error) == (after.cost, after.error)
        )


@given(POINTS, st.randoms())
def test_the_order_of_the_choices_does_not_matter_to_who_is_dominated(points, random):
    mixed = list(points)
    random.shuffle(mixed)
    assert set(pareto.dominated(mixed)) == set(pareto.dominated(points))


def test_the_most_accurate_of_those_that_dominate_is_named():
    points = [Point("cheap", 1, 3), Point("accurate", 2, 1), Point("beaten", 3, 4)]
    assert pareto.dominated(points) == {"beaten": "accurate"}


def test_equal_choices_stay_both():
    points = [Point("one", 1, 1), Point("same", 1, 1)]
    assert pareto.dominated(points) == {}
