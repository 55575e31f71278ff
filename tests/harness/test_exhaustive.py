"""Exhaustive runs: every float of an interval once, whatever the pieces; what is wrong at one of them is found."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import main

from harness import CompareError, DomainError
from harness import exhaustive as subject
from harness.exhaustive import exhaustive, exhaustive_goals
from harness.searching.spaces import ordered

TEXT = """
float id(float x) { return x; }
vec3 each(vec3 c) { return c; }
float dip(float x) { return floatBitsToInt(x) == 0x3f800001 ? x - 0.25 : x; }
float hole(float x) { return floatBitsToInt(x) == 0x3f800003 ? 0.0 / (x - x) : x; }
float below(float x) { return floatBitsToInt(x) == 0x3f800002 ? -x : x; }
float two(float x, float y) { return x + y; }
float steps(float x) { return floor(x * 4.0); }
"""
ONE = np.float32(1)


@pytest.fixture
def f(functions):
    return functions(TEXT)


@pytest.fixture
def small(monkeypatch):
    """Pieces and chunks of a few values, all in this process."""
    monkeypatch.setattr(subject, "_CHUNK", 7)
    monkeypatch.setattr(subject, "_SLICE", 20)
    monkeypatch.setattr(subject.jobs, "run", lambda work, items, **_: reversed(list(enumerate(map(work, items)))))


def after(n):
    """The n-th float after 1."""
    return float(ONE + np.float32(n * 2.0**-23))


@pytest.mark.parametrize("name", ["id", "each"])
def test_every_float_is_there_once(f, small, name):
    """101 floats from 1 on; the error at each tells that it was compared with its own reference."""
    found = exhaustive(f[name], 1.0, after(100), np.positive)
    assert found.count == 101
    assert (found.ulp.size, found.absolute.size, found.backward, found.non_finite) == (0, 0, 0, 0)


def test_both_zeros_and_both_signs_are_tried(f):
    """From -3 to 3 of the smallest: 7 places, and -0."""
    assert exhaustive(f.id, -3 * 2.0**-149, 3 * 2.0**-149).count == 8


def test_a_stride_takes_every_nth(f):
    total = int(ordered(np.float32([2]))[0] - ordered(np.float32([1]))[0])
    assert exhaustive(f.id, 1.0, 2.0, stride=4099).count == total // 4099 + 1


def test_the_one_wrong_value_is_found(f, small):
    found = exhaustive(f.dip, 1.0, after(50), np.positive)
    assert found.ulp.at == found.absolute.at == after(1)
    assert found.absolute.size == 0.25
    assert found.ulp.size == 2**21
    assert found.backward == 1
    assert found.back.at == after(1)


@pytest.mark.parametrize("wrong_at", [6, 7, 8, 19, 20, 21])
def test_a_step_back_between_chunks_and_pieces_is_seen(f, functions, small, wrong_at):
    text = f"float dip(float x) {{ return floatBitsToInt(x) == {0x3F800000 + wrong_at} ? x - 0.25 : x; }}"
    found = exhaustive(functions(text).dip, 1.0, after(50))
    assert (found.backward, found.back.at) == (1, after(wrong_at))


def test_what_is_not_finite_and_what_is_negative_is_counted(f, small):
    found = exhaustive(f.hole, 1.0, after(50), np.positive)
    assert (found.non_finite, found.first_non_finite) == (1, after(3))
    assert found.ulp.size == np.inf
    assert found.ulp.at == after(3)
    found = exhaustive(f.below, 1.0, after(50))
    assert (found.negative, found.first_negative) == (1, after(2))


def test_ulps_are_those_of_ulp_difference(f):
    """Below a power of two, among denormals and at them: the fast way and the plain one agree."""
    from harness import ulp_difference

    want = np.array(
        [2 - 2.0**-26, 1.0, 1 - 2.0**-30, 2.0**-126 - 2.0**-151, 2.0**-130, 0.0, 3e38, 0.1, -0.7, -(2 - 2.0**-26)]
    )
    got = np.float32(want) * np.float32(1 + 2.0**-20) + np.float32(2.0**-149)
    off = np.abs(got - want)
    np.testing.assert_array_equal(off / subject._spacing(want), ulp_difference(got, want))


def test_a_flushed_denormal_is_right_unless_forbidden(f):
    """x as it is keeps its denormals; the reference here wants them where the function gives 0."""
    found = exhaustive(f.steps, 0.0, 2.0**-140, np.positive)
    assert found.ulp.size == 0
    assert exhaustive(f.steps, 0.0, 2.0**-140, np.positive, flush_denormals=False).ulp.size == 2**9


def test_any_number_of_processes_finds_the_same(f):
    """Two pieces, in processes."""
    found = [exhaustive(f.id, 1.0, 4.0, np.square, workers=n) for n in (1, 2)]
    assert found[0] == found[1]
    assert found[0].count == 2**24 + 1
    assert found[0].absolute.size == 12


@pytest.mark.parametrize(("low", "high", "stride"), [(1, 0, 1), (0, np.inf, 1), (np.nan, 1, 1), (0, 1, 0)])
def test_no_floats_are_refused(f, low, high, stride):
    with pytest.raises(DomainError, match="there are none"):
        exhaustive(f.id, low, high, stride=stride)


def test_what_takes_more_than_one_float_is_refused(f):
    with pytest.raises(DomainError, match="two.float x, float y. is no function of one float"):
        exhaustive(f.two, 0, 1)


def test_a_reference_of_another_shape_is_refused(f):
    with pytest.raises(CompareError, match="the reference made the shape"):
        exhaustive(f.id, 1.0, 1.5, np.sum, stride=4099)


def test_a_reference_that_no_process_can_find_is_refused(f):
    with pytest.raises(CompareError, match="has to be a function of a module"):
        exhaustive(f.id, 1.0, 1.5, lambda x: x)


def test_goals_of_a_hunt_are_answered(f, small):
    end = after(50)
    for name, goal, bad in [("hole", "nonfinite", True), ("id", "nonfinite", False), ("below", "negative", True)]:
        assert exhaustive_goals(f[name], {"x": f"[1,{end!r}]"}, [goal], max_ulp=4)[1] is bad
    assert exhaustive_goals(f.dip, {"x": f"[1,{end!r}]"}, ["monotone:x"], max_ulp=4)[1]
    assert not exhaustive_goals(f.dip, {"x": f"[1,{end!r}]"}, ["monotone:x"], max_ulp=1e9)[1]
    with pytest.raises(DomainError, match="needs one interval, for x"):
        exhaustive_goals(f.dip, {"x": 1.0}, ["nonfinite"], max_ulp=4)
    with pytest.raises(DomainError, match="has no meaning"):
        exhaustive_goals(f.dip, {"x": "[0,1]"}, ["symmetric:x,y"], max_ulp=4)


def test_the_command_tries_every_float(tmp_path, capfd):
    (tmp_path / "it.glsl").write_text(TEXT)
    words = ["hunt", str(tmp_path / "it.glsl"), "hole", "--exhaustive", "--domain", "x=[1,1.00001]"]
    assert main(words) == 1
    assert "not finite: 1, first at 1.0000003576278687" in capfd.readouterr().out
    words[2] = "id"
    assert main(words) == 0


def just_above_the_smallest_normal(x):
    return np.full(x.shape, 2.0**-126 * (1 + 2.0**-20))


def test_a_result_may_be_flushed_that_is_a_little_below_what_is_right(f):
    """A pow() that is a few ulps low gives a denormal, so 0, where the right value is still normal."""
    assert exhaustive(f.steps, 0.0, 2.0**-140, just_above_the_smallest_normal).ulp.size == 0
