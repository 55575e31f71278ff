"""One call in several modes: the results by mode, and a table of how far they lie apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from harness import CallError, GlslError
from harness.calling import mode_comparison
from harness.calling.call import Shader
from harness.calling.engine import engine
from harness.calling.mode_comparison import ModeComparison
from harness.language import dialect

TEXT = (
    "float f(float x) { return x; }\nstruct S { vec2 v; int k; };\nvoid g(float x, out S s, out bool b) { s.k = 1; }\n"
)


@pytest.fixture
def made(functions):
    return functions(TEXT)


def compared(f, arguments: dict, **results) -> ModeComparison:
    """As if the modes had given these results."""
    by_mode = {mode.replace("_", "-"): result for mode, result in results.items()}
    return ModeComparison(f._overload((), arguments), by_mode, {})


def test_there_is_a_result_for_each_mode_asked_for(made):
    got = made.f.compare([1, 2], modes=("precise", "as-written"))
    assert list(got) == ["precise", "as-written"]
    np.testing.assert_array_equal(got["precise"], [1, 2])
    np.testing.assert_array_equal(got["as-written"], [1, 2])


def test_without_modes_there_are_all(made):
    assert set(made.f.compare(x=1)) == set(dialect.MODES)


def test_every_mode_has_a_place_among_the_accurate():
    assert set(dialect.MODES) <= set(mode_comparison.ACCURACY)


def test_the_most_accurate_is_what_the_others_are_measured_against(made):
    x = np.ones(1, np.float32)
    modes = dict.fromkeys(["mediump", "as_written", "precise", "double"], x)
    for reference in ("double", "precise", "as-written", "mediump"):
        assert compared(made.f, {"x": x}, **modes).reference == reference
        del modes[reference.replace("-", "_")]


def test_the_worst_is_told_with_its_place_and_inputs(made):
    """Three ulps at 4, of 2^-21 each, are more ulps than the one at 1024, of 2^-13, which is more in itself."""
    x = np.float32([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    precise = np.float32([[1, 1, 1], [1024, 4, 1]])
    as_written = precise + np.float32([[0, 0, 0], [2.0**-13, -3 * 2.0**-21, 0]])
    worst = compared(made.f, {"x": x}, precise=precise, as_written=as_written).worst
    assert worst == {"as-written": (3.0, 2.0**-13, (1, 1), "x=0.5")}


@pytest.mark.parametrize(
    ("got", "want", "apart"),
    [
        (np.nan, np.nan, 0),
        (np.inf, np.inf, 0),
        (-0.0, 0.0, 0),
        (np.nan, 1, np.inf),
        (1, np.nan, np.inf),
        (np.inf, 1, np.inf),
        (np.inf, -np.inf, np.inf),
    ],
)
@pytest.mark.filterwarnings("error")
def test_what_is_not_finite_differs_from_everything_else(made, got, want, apart):
    worst = compared(made.f, {"x": 1}, precise=np.float32(want), mediump=np.float32(got)).worst["mediump"]
    assert (worst.ulp, worst.absolute, worst.index) == (apart, apart, ())


@pytest.mark.parametrize(
    ("change", "ulp", "absolute", "index"),
    [
        (lambda s, b: s.v.__setitem__((2, 1), 1.5), 2**22, 0.5, (2,)),
        (lambda s, b: s.k.__setitem__(1, 12), 11, 11, (1,)),
        (lambda s, b: b.__setitem__(0, True), 1, 1, (0,)),
    ],
)
def test_all_outputs_count(made, change, ulp, absolute, index):
    """A float, 1.5 for 1 (2^23 floats from 1 to 2); an int, 12 for 1; a bool."""
    x = np.ones(3)
    by_mode = {mode: made.g(x)._replace(b=np.zeros(3, bool)) for mode in ("precise", "as_written")}
    for got in by_mode.values():
        got.s.v[:] = 1
    change(*by_mode["as_written"])
    worst = compared(made.g, {"x": x}, **by_mode).worst["as-written"]
    assert worst[:3] == (ulp, absolute, index)


def test_it_prints_as_a_table(made):
    one = np.float32([1, 1])
    table = compared(made.f, {"x": [0.1, 0.25]}, precise=one, as_written=one + np.float32([0, 2**-20]), mediump=one)
    assert repr(table) == str(table)
    heading, *rows = str(table).split("\n")
    assert heading.startswith("float f(float x)    [")
    assert heading.endswith("test.glsl:1], 2 evaluations")
    assert rows == [
        "mode        ulp  absolute  largest at",
        "precise                    what the others are compared with",
        "as-written    8  9.54e-07  [1] x=0.25",
        "mediump       0         0",
    ]


def test_no_evaluations_do_not_differ(made):
    table = made.f.compare(np.empty(0))
    assert table.worst["as-written"][:2] == (0, 0)
    assert ", 0 evaluations" in str(table)


def test_a_mode_that_the_function_does_not_have_is_told_with_the_reason(made):
    def without_precise(source, signature, mode):
        if mode == "precise":
            raise GlslError("has no such version\nat all")
        return engine(source, signature, mode)

    made = Shader(replace(made._library, engine=without_precise), "as-written")
    table = made.f.compare(1)
    assert "precise" not in table
    assert str(table).split("\n")[-1].split(maxsplit=3) == ["precise", "-", "-", "has no such version"]
    with pytest.raises(GlslError, match="no such version"):
        made.f.compare(1, modes=("as-written", "precise"))


def test_arguments_that_do_not_fit_are_refused_as_in_a_call(made):
    with pytest.raises(CallError, match="f lacks x"):
        made.f.compare()
    with pytest.raises(CallError, match="no mode 'exact'"):
        made.f.compare(1, modes=("exact",))
