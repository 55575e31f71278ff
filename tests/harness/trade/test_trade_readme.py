"""The README's table: between its marks, and the trade's that it was made from."""

from __future__ import annotations

from pathlib import Path

import pytest
import trade_data

from harness import HarnessError
from harness.trade import readme, text

README = Path("README.md")


@pytest.fixture
def data():
    return trade_data.trade()


def test_all_but_the_block_stays_as_it_is(data):
    before, after = "# Title\r\n\nText | with\n\n", "\n\nmore\n"
    made = readme.updated(f"{before}{readme.BEGIN}\nold\n{readme.END}{after}", data, README)
    assert made == before + readme.block(data) + after


def test_written_again_it_is_the_same(data):
    once = readme.updated(f"{readme.BEGIN}{readme.END}", data, README)
    assert readme.updated(once, data, README) == once


@pytest.mark.parametrize("old", ["", readme.BEGIN, readme.END, readme.END + readme.BEGIN])
def test_without_marks_it_is_refused_with_what_to_put(data, old):
    with pytest.raises(HarnessError, match="README.md: has no place for the table") as caught:
        readme.updated(old, data, README)
    assert readme.BEGIN in str(caught.value) and readme.END in str(caught.value)


def test_it_has_each_preset_the_answers_and_the_machine(data):
    block = readme.block(data)
    for preset in data["presets"]:
        assert f"\n| {preset['name']} " in block
    assert "for a phone **mobile**, for a desktop **desktop**, for ground truth **offline**" in " ".join(block.split())
    assert "Some CPU" in block and "llvmpipe (LLVM 15.0.6, 256 bits)" in " ".join(block.split())


def test_no_code_is_broken_over_two_lines(data):
    assert all(line.count("`") % 2 == 0 for line in readme.block(data).splitlines() if not line.startswith("<!--"))


def test_its_lines_are_not_too_long(data):
    lines = [line for line in readme.block(data).splitlines() if not line.startswith("|")]
    assert max(map(len, lines)) <= text.WIDTH
