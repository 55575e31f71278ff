"""Domains of inputs: what the words mean, that edges are among what is drawn, and what does not fit."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from harness import CallError, DomainError, samples
from harness.searching.domain import Domain
from harness.searching.spaces import from_ordered, ordered

SMALLEST, SMALLEST_NORMAL = np.float32(2.0**-149), np.float32(2.0**-126)
BELOW_1 = np.float32(1 - 2.0**-24)
ABOVE_1 = np.float32(1 + 2.0**-23)
TEXT = """
struct Inner { float k; bool on; };
struct Material { vec3 albedo; float roughness; Inner inner; };
uniform float scale;
float f(float x) { return x * scale; }
float two(float x, float y) { return x + y; }
vec3 unit(vec3 v) { return v; }
vec3 three(vec3 l, vec3 v, vec3 n) { return l + v + n; }
float whole(int i, uint u, bool b) { return b ? float(i) : float(u); }
float member(Material m) { return m.albedo.x + m.roughness + m.inner.k + (m.inner.on ? 1.0 : 0.0); }
float array(float w[3]) { return w[0] + w[2]; }
float over(float x) { return x; }
float over(vec2 x) { return x.x; }
float over(vec2 x, float y) { return x.x + y; }
"""


@pytest.fixture
def f(functions):
    return functions(TEXT)


def bits(values):
    """Floats told apart by their bits: -0 is not 0."""
    return set(np.float32(values).view(np.uint32).tolist())


def test_the_order_of_floats_has_neighbours_one_apart():
    values = np.float32([-1, -SMALLEST, 0, SMALLEST, SMALLEST_NORMAL, BELOW_1, 1, ABOVE_1, 3e38])
    up = np.nextafter(values, np.float32(np.inf))
    np.testing.assert_array_equal(ordered(up) - ordered(values), 1)
    np.testing.assert_array_equal(from_ordered(ordered(values)), values)


def test_the_edges_of_an_interval_are_among_its_samples(f):
    x = samples(f.two, {"x": "[0,1]", "y": [0.5]}, n=300)["x"]
    assert bits([0, -0.0, 1, 0.5, SMALLEST, SMALLEST_NORMAL, BELOW_1]) <= bits(x)
    assert ((x >= 0) & (x <= 1)).all()


def test_edges_meet_each_other(f):
    """Every pair of these is there: a bug that takes two edges at once is not left to chance."""
    edges = np.float32([0, 1, SMALLEST, SMALLEST_NORMAL, BELOW_1])
    drawn = samples(f.two, {"x": "[0,1]", "y": "[0,1]"}, n=2000)
    pairs = set(zip(drawn["x"].tolist(), drawn["y"].tolist(), strict=True))
    assert set(itertools.product(edges.tolist(), edges.tolist())) <= pairs


def test_float_is_all_finite_floats(f):
    x = samples(f.two, {"x": "float", "y": [0]}, n=20_000)["x"]
    largest = np.finfo(np.float32).max
    assert np.isfinite(x).all()
    assert bits([0, -0.0, 1, -1, largest, -largest, SMALLEST, -SMALLEST, ABOVE_1]) <= bits(x)
    # every power of ten from 1e-37 to 1e37, of either sign, has some
    assert len(set(np.floor(np.log10(np.abs(x[np.abs(x) > 1e-37]))).astype(int))) >= 74


@pytest.mark.parametrize(
    ("text", "low", "high"), [("[0,1)", 0, BELOW_1), ("(0,1]", SMALLEST, 1), ("[ -1e3 , 1e3 ]", -1000, 1000)]
)
def test_a_round_bracket_leaves_out_the_end(f, text, low, high):
    x = samples(f.two, {"x": text, "y": [0]}, n=5000)["x"]
    assert x.min() == np.float32(low)
    assert x.max() == np.float32(high)


def test_unit_vectors_are_unit_to_the_rounding_of_float32(f):
    """Each component is off by half an ulp, at most 2^-25: the length by sqrt(3) 2^-25."""
    v = samples(f.unit, {"v": "unit"}, n=20_000)["v"].astype(float)
    assert v.shape == (20_000, 3)
    assert np.abs(np.linalg.norm(v, axis=1) - 1).max() <= np.sqrt(3) * 2.0**-25
    assert {(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)} <= set(map(tuple, v.tolist()))


def test_unit_vectors_meet_in_special_positions(f):
    drawn = samples(f.three, {"l": "unit", "v": "unit", "n": "unit"}, n=100_000)
    l, v, n = (drawn[name].astype(float) for name in "lvn")  # noqa: E741
    cosine = (l * v).sum(axis=1)
    mirrored = 2 * n * (n * l).sum(axis=1, keepdims=True) - l
    assert (l == v).all(axis=1).sum() > 100
    assert (l == -v).all(axis=1).sum() > 100
    assert ((cosine < -0.9999) & (l != -v).any(axis=1)).sum() > 100
    assert (np.abs(cosine) < 1e-6).sum() > 100
    assert ((np.abs(mirrored - v) < 1e-6).all(axis=1) & (np.abs((n * l).sum(axis=1)) < 0.99)).sum() > 100


def test_members_have_domains_by_dotted_names_and_as_a_whole(f):
    words = {"m": "[0,1]", "m.albedo": "color", "m.inner.k": "[2,3]"}
    m = samples(f.member, words, n=1000)["m"]
    assert m["albedo"].shape == (1000, 3)
    assert m["roughness"].max() == 1
    assert m["inner"]["k"].min() == 2
    assert set(m["inner"]["on"].tolist()) == {False, True}  # needs no word


def test_whole_numbers(f):
    drawn = samples(f.whole, {"i": "[-3,5]", "u": "int"}, n=3000)
    assert drawn["i"].dtype == np.int32
    assert set(drawn["i"].tolist()) == set(range(-3, 6))
    assert drawn["u"].dtype == np.uint32
    assert {0, 1, 2**32 - 1} <= set(drawn["u"].tolist())


def test_given_values_stay_together_row_by_row(f):
    x, y = np.arange(10.0), np.arange(10.0) * 2
    drawn = samples(f.two, {"x": x, "y": y})
    np.testing.assert_array_equal(drawn["x"], x)
    np.testing.assert_array_equal(drawn["y"], y)
    l = np.eye(3)  # noqa: E741
    mixed = samples(f.three, {"l": l, "v": 2 * l, "n": "unit"}, n=500)
    np.testing.assert_array_equal(mixed["v"], 2 * mixed["l"])
    assert len({tuple(row) for row in mixed["l"].tolist()}) == 3


def test_a_constant_and_a_uniform(f):
    drawn = samples(f.f, {"x": 0.25, "scale": 3.0})
    assert drawn["scale"] == 3.0
    np.testing.assert_array_equal(f.f(**drawn), [0.75])


def test_an_array_parameter(f):
    w = samples(f.array, {"w": "[0,1]", "w[1]": "[5,6]"}, n=200)["w"]
    assert w.shape == (200, 3)
    assert (w[:, 1] >= 5).all()
    assert (w[:, [0, 2]] <= 1).all()


def test_the_names_tell_overloads_apart(f):
    assert samples(f.over, {"x": "[0,1]", "y": "[0,1]"}, n=10)["x"].shape == (10, 2)
    with pytest.raises(DomainError, match="more than one overload has the inputs x; there are"):
        samples(f.over, {"x": "[0,1]"})


def test_the_seed_tells_all(f):
    words = {"l": "unit", "v": "unit", "n": "unit"}
    one, again, other = (samples(f.three, words, n=5000, seed=seed)["l"] for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, again)
    assert (one != other).any()


@pytest.mark.parametrize(
    ("name", "words", "message"),
    [
        ("two", {"x": "[0,1]"}, r"needs a domain for y"),
        ("two", {"x": "[0,1]", "y": "[0;1]"}, r"y: '\[0;1\]' is no domain; there are \"unit\""),
        ("two", {"x": "[1,0]", "y": "float"}, r"x: '\[1,0\]' is empty"),
        ("two", {"x": "[0,nan]", "y": "float"}, r"an end that is not finite"),
        ("two", {"x": "[0,1e39]", "y": "float"}, r"an end beyond"),
        ("two", {"x": "unit", "y": "float"}, r'x is a float: "unit" is for vectors'),
        ("two", {"x": "int", "y": "float"}, r'x is a float: "int" is for int and uint'),
        ("two", {"x": [1, 2], "y": [1, 2, 3]}, r"do not go together, row by row: 2 of x, 3 of y"),
        ("two", {"x": [], "y": "float"}, r"do not go together"),
        ("two", {"x": "float", "y": "float", "z": "float"}, r"has no input z; there are: x, y"),
        ("member", {"m": "[0,1]", "m.albdo": "color"}, r"has no input m.albdo; there are: m.albedo"),
    ],
)
def test_what_does_not_fit_is_said(f, name, words, message):
    with pytest.raises(DomainError, match=message):
        samples(f[name], words)


def test_given_values_of_the_wrong_shape_are_said_as_in_a_call(f):
    with pytest.raises(CallError, match="v is a vec3"):
        samples(f.unit, {"v": [1.0, 2.0]})


def test_no_samples_are_none(f):
    with pytest.raises(DomainError, match="n has to be 1 or more"):
        samples(f.unit, {"v": "unit"}, n=0)


def test_what_a_search_moved_outside_is_brought_back(f):
    where = Domain.of(f.three, {"l": "unit", "v": "unit", "n": "unit"})
    moved = where.spaces["l"].clip(np.float32([[3, 4, 0], [0, 0, 0], [np.nan, 1, 0], [1e30, 1e30, 0]]))
    np.testing.assert_allclose(np.linalg.norm(moved.astype(float), axis=1), 1, atol=1e-7)
    np.testing.assert_array_equal(moved[0], np.float32([0.6, 0.8, 0]))
