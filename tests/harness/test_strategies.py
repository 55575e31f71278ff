"""Strategies for Hypothesis: batches of many inputs, which shrink to one simple input."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import Phase, find, given, settings
from hypothesis.errors import NoSuchExample

from harness import HarnessError, strategies
from harness.searching.domain import Domain

TEXT = """
float wrong(float x, float y) { return x > 0.7 && x < 0.8 ? -1.0 : x; }
vec3 three(vec3 l, vec3 v, float x) { return l + v + x; }
"""
#: no example is kept from one run for the next, and the same are tried
SETTINGS = settings(max_examples=60, database=None, deadline=None, derandomize=True)


@pytest.fixture
def f(functions):
    return functions(TEXT)


def test_one_example_is_a_whole_batch(f):
    sizes = []

    @settings(SETTINGS, max_examples=20, phases=[Phase.generate])
    @given(strategies.batches(f.wrong, {"x": "[0,1]", "y": "float"}, size=5000))
    def run(inputs):
        sizes.append(len(inputs["x"]))
        assert inputs["x"].shape == inputs["y"].shape
        assert ((inputs["x"] >= 0) & (inputs["x"] <= 1)).all()

    run()
    assert max(sizes) == 5000


def test_a_failure_shrinks_to_one_simple_input(f):
    """Of thousands of inputs, one is left: x of few binary digits in 0.7 ... 0.8, and y, which does not matter, 0."""
    batches = strategies.batches(f.wrong, {"x": "[0,1]", "y": "float"})
    found = find(batches, lambda inputs: (f.wrong(**inputs) < 0).any(), settings=settings(SETTINGS, max_examples=500))
    assert found["x"].tolist() == [0.75]
    assert found["y"].tolist() == [0]


def test_vectors_shrink_to_axes(f):
    """Opposite vectors: the simplest are +z and -z, or other axes."""
    batches = strategies.batches(f.three, {"l": "unit", "v": "unit", "x": "[0,1]"}, size=300)
    found = find(
        batches,
        lambda i: ((i["l"].astype(float) * i["v"]).sum(axis=1) < -0.9).any(),
        settings=settings(SETTINGS, max_examples=500),
    )
    assert found["l"].shape == (1, 3)
    assert found["x"] == 0
    assert np.count_nonzero(found["l"]) == 1


def test_special_positions_are_among_a_few_batches(f):
    batches = strategies.batches(f.three, {"l": "unit", "v": "unit", "x": "[0,1]"})
    find(batches, lambda i: ((i["l"] == -i["v"]).all(axis=1) & (i["x"] == 0)).any(), settings=SETTINGS)


def test_single_values(f):
    find(strategies.floats(), lambda x: x == np.finfo(np.float32).max, settings=settings(SETTINGS, max_examples=3000))
    find(strategies.unit_interval(), lambda x: 0 < x < 2.0**-126, settings=settings(SETTINGS, max_examples=3000))
    with pytest.raises(NoSuchExample):
        find(strategies.floats(2, 3), lambda x: not 2 <= x <= 3 or x.dtype != np.float32, settings=SETTINGS)


def test_unit_vectors_and_pairs():
    @settings(SETTINGS, max_examples=20)
    @given(strategies.unit_vectors(), strategies.unit_vectors(2), strategies.unit_pairs())
    def run(v, w, pair):
        assert v.shape == (3,) and w.shape == (2,) and v.dtype == np.float32
        for vector in (v, w, *pair):  # each component is rounded by 2^-25 at most
            assert abs(np.linalg.norm(vector.astype(float)) - 1) <= np.sqrt(3) * 2.0**-25

    run()
    find(strategies.unit_pairs(), lambda p: (p[0] == -p[1]).all(), settings=settings(SETTINGS, max_examples=1000))


def test_the_same_numbers_are_the_same_batch(f):
    where = Domain.of(f.wrong, {"x": "[0,1]", "y": "float"})
    one, two = (where.draw(100, np.random.default_rng(5)) for _ in range(2))
    np.testing.assert_array_equal(one["x"], two["x"])


def test_without_hypothesis_the_message_says_what_to_install(f, monkeypatch):
    monkeypatch.setitem(sys.modules, "hypothesis.strategies", None)
    with pytest.raises(HarnessError, match="pip install 'hypothesis>=6.100,<7'"):
        strategies.floats()
