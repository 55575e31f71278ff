"""Whether a trade is that of the shaders."""

from __future__ import annotations

import pytest
import trade_files
from sprj_files import shader_pass, write_project
from submission_files import replace

from harness import ladder
from harness.costing import isa
from harness.projects import sprj
from harness.trade import choices, cost, stale


@pytest.fixture
def project(tmp_path):
    """The ladder is looked for beside the shaders of its passes."""
    trade_files.write_model(tmp_path)
    return sprj.read(write_project(tmp_path, shader_pass()))


def differences(project, data):
    return stale.differences(data, choices.choices(project, ladder.of_project(project)))


def test_a_trade_of_these_shaders_is_not_stale(project):
    assert differences(project, trade_files.trade()) == []


def test_another_cost_is_told(project):
    replace(project.file.parent / "model.glsl", "c + c * c", "c * c")
    assert differences(project, trade_files.trade()) == ["1 costs 6 weighted operations, not 9 weighted operations"]


def test_a_rung_more_or_less_is_told(project):
    data = trade_files.trade()
    data["terms"][0]["rungs"][1] |= {"name": "2"}
    assert differences(project, data) == ["1 is not in it", "2 is no longer there"]


def test_what_could_not_be_counted_is_not_compared(project):
    data = trade_files.trade()
    data["presets"][0] |= {"cost": None}
    assert differences(project, data) == []


@pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))
def test_cycles_are_compared_where_the_same_driver_counted_them(project):
    data = trade_files.trade()
    chosen = choices.choices(project, ladder.of_project(project))
    functions = [choice.function("shade") for choice in chosen]
    for entry, found in zip(data["terms"][0]["rungs"] + data["presets"], cost.costs(functions), strict=True):
        entry["cost"] = found
    data["targets"] = list(cost.targets())
    data["machine"]["costs"] = cost.driver(functions[0])
    assert differences(project, data) == []
    data["presets"][0]["cost"]["navi21"] = data["presets"][0]["cost"]["navi21"] | {"cycles": 1}
    (said,) = differences(project, data)
    assert said.startswith("exact costs ") and "1 cycles on navi21" in said
    data["machine"]["costs"] = "Mesa 99"
    assert differences(project, data) == []
