"""The README's table is that of docs/trade.json, and that is of the shaders, as far as it is measured again in seconds.

Where one of these fails: `make trade-readme`.
"""

from __future__ import annotations

import pytest

from harness import ladder
from harness.projects import sprj
from harness.trade import choices, extremes, file, model, readme, sampling, stale


@pytest.fixture(scope="module")
def data(root):
    return file.read(root / "docs" / "trade.json")


@pytest.fixture(scope="module")
def chosen(root):
    project = sprj.read(root / "project.sprj")
    return choices.choices(project, ladder.of_project(project))


def test_the_readmes_table_is_that_of_the_data(root, data):
    text = (root / "README.md").read_text()
    start, end = readme.place(text, root / "README.md")
    assert text[start:end] == readme.block(data)


def test_rungs_presets_and_their_costs_are_those_of_the_shaders(data, chosen):
    assert stale.differences(data, chosen) == []


def presets(data, chosen):
    told = {preset["name"]: preset for preset in data["presets"]}
    return [(choice, told[choice.name]) for choice in chosen if choice.term is None]


def test_the_models_errors_are_those_of_the_presets(data, chosen):
    """In double, by our own interpreter: another processor's numpy may differ by some ulp in a power, hence 1e-6."""
    for choice, told in presets(data, chosen):
        function = choice.function(choice.own)
        flat = sampling.inputs(function, choice.domain, sampling.COUNT)
        found = model.model(function, choice.function(choice.own, choice.exact), flat)
        for part in ("median", "p99", "max"):
            assert found[part] == pytest.approx(told["model"][part], rel=1e-6, abs=1e-12), (choice.name, part)


def test_the_extremes_are_those_of_the_presets(data, chosen):
    """In single precision, every operation as it is written, which is the same on every driver that keeps to IEEE."""
    flat = extremes.inputs(extremes.COUNT)
    for choice, told in presets(data, chosen):
        found = extremes.count_broken(choice.function(choice.whole).with_mode("precise"), flat)
        assert found == told["extremes"]["precise"], choice.name
