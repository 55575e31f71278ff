"""A trade in a file, and back."""

from __future__ import annotations

import json
import math

import pytest
import trade_data

from harness import HarnessError
from harness.trade import file


def test_it_is_read_as_it_was_written(tmp_path):
    path = tmp_path / "trade.json"
    path.write_text(file.text(trade_data.trade()))
    assert file.read(path) == trade_data.trade()


def test_what_is_no_number_is_strict_json(tmp_path):
    """json.loads takes Python's own words; a reader in another language would not."""
    path = tmp_path / "trade.json"
    path.write_text(file.text({"schema": 1, "a": [math.inf, -math.inf], "b": math.nan, "Infinity": "NaN, Infinity"}))

    def refuse(word):
        raise AssertionError(word)

    assert json.loads(path.read_text(), parse_constant=refuse)
    assert file.read(path) == {"schema": 1, "a": [math.inf, -math.inf], "b": None, "Infinity": "NaN, Infinity"}


@pytest.mark.parametrize(
    ("text", "said"),
    [("{", "is no JSON"), ('{"schema": 2}', "has schema 2, not 1"), ("[]", "has schema None"), (None, "cannot read")],
)
def test_another_file_is_refused_with_what_to_do(tmp_path, text, said):
    path = tmp_path / "trade.json"
    if text is not None:
        path.write_text(text)
    with pytest.raises(HarnessError, match=f"trade.json: .*{said}.*`make trade`"):
        file.read(path)
