"""The stages that are timed evaluate what they are said to, as often. Expected: the same inputs made by numpy."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from harness import CallError
from harness.trade import timing

LOOPS = 5
STRUCT = "struct M { vec3 color; float k; };"
TEXT = f"{STRUCT} vec3 f(vec3 n, M m, float x) {{ return n * m.k + m.color * x; }}"
DOMAIN = {"n": "unit", "m.color": "color", "m.k": "[2,6]", "x": "[0,1]"}


def hashed(x):
    with np.errstate(over="ignore"):
        x = x * np.uint32(747796405) + np.uint32(2891336453)
        x = ((x >> ((x >> np.uint32(28)) + np.uint32(4))) ^ x) * np.uint32(277803737)
        return (x >> np.uint32(22)) ^ x


def numbers(count: int):
    """(loops, invocations, count) float32: the Weyl sequences."""
    place = np.arange(timing.INVOCATIONS, dtype=np.uint32)[:, None] * np.uint32(count) + np.arange(
        count, dtype=np.uint32
    )
    values = (hashed(place) >> np.uint32(8)).astype(np.float32) * np.float32(2.0**-24)
    made = []
    for _ in range(LOOPS):
        values = values + np.array(timing.steps(count), np.float32)
        values = values - np.floor(values)
        made.append(values)
    return np.array(made)


@pytest.fixture
def job(functions):
    return timing.job(functions(TEXT).f, DOMAIN, 0)


def test_every_evaluation_is_in_the_sum(job):
    s = numbers(8).astype(np.float64)
    n = np.stack([s[..., 0] * 2 - 1, s[..., 1] * 2 - 1, s[..., 2] + 0.05], axis=-1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    expected = n * (2 + 4 * s[..., 6:7]) + s[..., 3:6] * s[..., 7:8]
    got = timing._Stage(job.text).sums(LOOPS)
    np.testing.assert_allclose(got, expected.sum(axis=(0, 2)), rtol=0, atol=2e-5)


def test_the_null_stage_makes_the_same_inputs(job):
    s = numbers(8).astype(np.float64)
    n = np.stack([s[..., 0] * 2 - 1, s[..., 1] * 2 - 1, s[..., 2] + 0.05], axis=-1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    expected = n.sum(axis=-1) + s[..., 3:6].sum(axis=-1) + 2 + 4 * s[..., 6] + s[..., 7]
    got = timing._Stage(job.null).sums(LOOPS)
    np.testing.assert_allclose(got, expected.sum(axis=0), rtol=0, atol=2e-5)


def test_macros_that_change_nothing_change_nothing(functions):
    """So that what is the same machine code has the same time."""
    plain, other = (timing.job(functions(TEXT, defines=d).f, DOMAIN, 0) for d in ({}, {"UNUSED": "1"}))
    assert plain == other


def test_inputs_are_spread_evenly():
    """So that no rung is timed at other inputs than surfaces have: 8 numbers in 10 parts of 0 ... 1."""
    made = numbers(8).reshape(-1, 8)
    shares = np.array([np.histogram(column, 10, (0, 1))[0] / len(made) for column in made.T])
    assert np.abs(shares - 0.1).max() < 0.005


class _Pretended:
    """A stage that takes as long as is said."""

    def __init__(self, seconds):
        self.run = seconds


def test_a_time_that_does_not_grow_is_found_out():
    """Even where a busy machine makes five of six runs three times as long, or at first all."""
    busy = itertools.chain([1, 3] * 7, itertools.cycle([3, 3, 3, 3, 3, 3, 3, 1, 1, 3, 3, 3]))
    assert timing._grows(_Pretended(lambda loops: loops * 1e-3 * next(busy)), 64)
    assert not timing._grows(_Pretended(lambda loops: 1e-3 * next(busy)), 64)


def test_the_loop_is_made_long_enough_and_no_longer_than_llvmpipe_bears():
    assert timing._enough(_Pretended(lambda loops: loops * timing.SECONDS / 30)) == 32
    assert timing._enough(_Pretended(lambda loops: 0.0)) == timing.LOOPS[1] <= 65535


def test_times_are_told_beside_the_references(functions, monkeypatch):
    monkeypatch.setattr(timing, "SECONDS", 1e-4)
    compiled = functions("float f(float x) { return x; } float g(float x) { return exp(sin(x)) + pow(x, 0.3); }")
    jobs = [timing.job(compiled[name], {"x": "[0,1]"}, 1) for name in "fg"]
    rounds = []
    cheap, dear = timing.times(jobs, lambda k, total: rounds.append((k, total)))
    assert rounds == [(k, timing.ROUNDS) for k in range(timing.ROUNDS)]
    assert dear.ratio == 1 and cheap.ratio == cheap.ns / dear.ns
    assert all(t.low <= t.ns <= t.high for t in (cheap, dear))


def test_the_null_stage_takes_nothing(functions, monkeypatch):
    """Each sample less the median of the null stage's, by the count of evaluations, in nanoseconds."""
    seconds = {"dear": 3e-3, "null": 1e-3}
    monkeypatch.setattr(timing, "_Stage", lambda text: _Pretended(lambda loops: seconds[text] * loops / 4096))
    (time,) = timing.times([timing.Job("dear", "null", 0)])
    assert time.ns == time.low == time.high == pytest.approx(2e-3 * 1e9 / (timing.INVOCATIONS * 4096))


def test_what_cannot_be_made_in_a_shader_is_refused(functions):
    with pytest.raises(CallError, match="k of float f"):
        timing.job(functions("float f(float x, int k) { return x; }").f, {"x": "[0,1]", "k": "[1,2]"}, 0)


def test_what_computes_is_named():
    backend, device = timing.device()
    assert backend in ("osmesa", "egl", "glfw") and device
