"""The list of mutants that need not be noticed."""

from __future__ import annotations

import pytest

from harness import HarnessError
from harness.mutating.mutants import mutants
from harness.mutating.mutate_equivalents import Equivalents, beside

TEXT = """float square(float x)
{
    return x * x; // not pow
}
"""
ENTRY = """[[equivalent]]
line = "return x * x;"
ids = ["f.glsl:square+2:14:term:left", "other.glsl:gone+1:1:term:left"]
reason = "..."
"""


@pytest.fixture
def written(tmp_path):
    def write(text):
        (tmp_path / "list.toml").write_text(text)
        return Equivalents.read(tmp_path / "list.toml")

    return write


def test_those_of_a_file(written):
    """Comments are no part of the line, and those of other files are not looked at."""
    assert written(ENTRY).of("f.glsl", TEXT, mutants(TEXT)) == {"square+2:14:term:left"}


@pytest.mark.parametrize(
    ("old", "new", "part"),
    [
        ("return x * x;", "return x / x;", "'return x \\* x;' now"),
        ("square+2", "square+3", "no such mutant any more"),
        ("f.glsl:square", "other.glsl:gone", None),
    ],
)
def test_a_stale_entry_is_an_error(written, old, new, part):
    listed = written(ENTRY.replace(old, new))
    if part is None:
        assert listed.of("f.glsl", TEXT, mutants(TEXT)) == set()
    else:
        with pytest.raises(HarnessError, match=part):
            listed.of("f.glsl", TEXT, mutants(TEXT))


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("[[equivalent", "list.toml"),
        (ENTRY.replace("reason", "because"), "entry 1 has no reason"),
        (ENTRY.replace('"..."', '""'), "entry 1 has no reason"),
        (ENTRY + ENTRY, "listed twice"),
    ],
)
def test_what_is_wrong_with_the_list_is_said(written, text, part):
    with pytest.raises(HarnessError, match=part):
        written(text)


def test_the_list_lies_beside_the_tests(tmp_path):
    (tmp_path / "tests" / "shaders").mkdir(parents=True)
    inner, outer = tmp_path / "tests" / "shaders", tmp_path / "tests"
    assert beside([inner / "test_f.py"], tmp_path) is None
    (outer / "mutation-equivalent.toml").touch()
    assert beside([inner / "test_f.py"], tmp_path) == outer / "mutation-equivalent.toml"
    (inner / "mutation-equivalent.toml").touch()
    assert beside([inner / "test_f.py"], tmp_path) == inner / "mutation-equivalent.toml"
