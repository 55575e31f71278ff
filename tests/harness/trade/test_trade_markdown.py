"""The tables, as Markdown."""

from __future__ import annotations

import re

import pytest
import trade_data

from harness.trade import markdown, tables


@pytest.fixture
def data():
    return trade_data.trade()


def rows(text):
    """Of each table row of Markdown the cells, the rule's left out."""
    lines = [line for line in text.splitlines() if line.startswith("|") and not re.match(r"\| -", line)]
    return [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


def test_a_row_has_an_entrys_figures(data):
    head, *body = rows(markdown.table(tables.summary(data, data["presets"])))
    exercise = dict(zip(head, body[0], strict=True))
    assert exercise == {
        "": "exercise",
        "differs by": "0",
        "rounding": "0.13",  # the worse of 0.11 as written and 0.13 precise
        "in half": "1",
        "breaks": "50\xa0851",  # 50\xa0848 that are not finite and 3 that are negative, in precise
        "half breaks": "21\xa0012",
        "vega10": "360",
        "navi21": "138",
        "gfx1100": "138",
        "SPIR-V": "128",
        "ns, llvmpipe": "1.5",
        "ns, Some GPU <& more>": "0.015",
        "scene /255": "9",
        "ꟻLIP": "0.012",
    }


def test_every_entry_has_a_row_in_the_document(data):
    names = [row[0] for row in rows(markdown.document(data))]
    for entry in trade_data.every_entry(data):
        assert names.count(entry["name"]) == 1


def test_each_device_has_a_column_of_its_own(data):
    data["presets"][1]["time"].pop()
    head, _, exact, *_ = rows(markdown.table(tables.summary(data, data["presets"])))
    assert exact[head.index("ns, llvmpipe")] == "0.85"
    assert exact[head.index("ns, Some GPU <& more>")] == "–"


@pytest.mark.parametrize("part", ["roundoff", "model", "scene", "extremes", "energy", "cost", "time"])
def test_what_is_missing_is_a_dash_and_its_reason_is_said(data, part):
    text = markdown.document(trade_data.without(data, part, "there was no such thing"))
    assert f"- {part}: there was no such thing (exercise, exact, " in text
    # The energy has no column here, and a device has one where it timed something.
    assert part in ("energy", "time") or "–" in {cell for row in rows(text) for cell in row}


def test_the_dominated_are_named_with_by_whom(data):
    assert markdown.dominated(data, data["terms"][1]["rungs"]) == [
        "V_SCHLICK by V_HAMMON",
        "V_KARIS by V_HAMMON",
        "V_SEPARABLE by V_HAMMON",
    ]


def test_dominance_on_some_targets_says_on_which(data):
    schlick = next(r for r in data["terms"][1]["rungs"] if r["name"] == "V_SCHLICK")
    schlick["cost"]["vega10"]["cycles"] = 240
    assert "V_SCHLICK by V_HAMMON on navi21, gfx1100" in markdown.dominated(data, data["terms"][1]["rungs"])


def test_what_is_only_good_in_half_precision_is_said_to_be(data):
    assert "D_HALF by D_CROSS (but not in half precision)" in markdown.dominated(data, data["terms"][0]["rungs"])


def test_one_row_alone(data):
    data["terms"][1]["rungs"][1]["missing"]["time"] = "no clock"
    text = markdown.row(data, "V_HAMMON")
    assert [row[0] for row in rows(text)] == ["", "V_HAMMON"]
    assert "time: no clock" in text


def test_the_columns_of_a_table_are_aligned(data):
    widths = {len(line) for line in markdown.table(tables.summary(data, data["presets"])).splitlines()}
    assert len(widths) == 1


def test_a_bar_in_a_cell_ends_no_cell():
    assert rows(markdown.table(tables.Table(("", "x"), (("a|b", "1"),))))[1] == ["a\\|b", "1"]
