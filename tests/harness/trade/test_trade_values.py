"""Evaluation for the trade: what is rounded when, and how an input is told."""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError
from harness.trade.values import rounded, shown, values

FINE = 1 + 2.0**-40  # which float32 does not have


def test_double_takes_inputs_in_double(functions):
    f = functions("float f(float x) { return x - 1.0; }").f
    assert values(f.with_mode("double"), {"x": np.array([FINE])}) == 2.0**-40
    assert values(f, {"x": np.array([FINE])}) == 0


def test_structs_vectors_and_numbers_keep_their_places(functions):
    f = functions("struct S { vec2 a; float b; }; vec3 f(S s, float x) { return vec3(s.a, s.b) * x; }").f
    flat = {"s.a": np.array([[1.0, 2], [3, 4]]), "s.b": np.array([5.0, 6]), "x": np.array([10.0, 100])}
    for mode in ("as-written", "double"):
        assert values(f.with_mode(mode), flat).tolist() == [[10, 20, 50], [300, 400, 600]]


def test_whole_numbers_stay_whole(functions):
    f = functions("int f(int k) { return k / 2; }").f
    for mode in ("as-written", "double"):
        assert values(f.with_mode(mode), {"k": np.array([7, -2], np.int32)}).tolist() == [[3], [-1]]


def test_overloads_are_refused(functions):
    f = functions("float f(float x) { return x; } vec2 f(vec2 x) { return x; }").f
    with pytest.raises(CallError, match="overloaded"):
        values(f, {"x": np.ones(1)})


def test_an_input_is_told_in_decimal_and_hexadecimal():
    flat = {"x": np.array([0.5, 0.1]), "v": np.array([[0.0, 0, 1], [0, 1, 0.25]])}
    told = shown(rounded(flat), 1)
    assert told["at"] == {"x": float(np.float32(0.1)), "v": [0, 1, 0.25]}
    assert told["hex"] == {"x": "0x1.99999ap-4", "v": ["0x0.0p+0", "0x1p+0", "0x1p-2"]}
