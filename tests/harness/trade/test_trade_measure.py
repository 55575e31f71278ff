"""The whole of the trade on a small project, whose figures are known by hand."""

from __future__ import annotations

import json
import math

import pytest

from harness import GlslError
from harness.costing import isa
from harness.errors import LadderError
from harness.projects import sprj
from harness.trade import energy, extremes, sampling, scene, tasks, timing
from harness.trade.choices import choices
from harness.trade.measure import PARTS, measure

LAMBERT = 0.318309886 * math.pi  # as the shader writes 1/pi


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Fewer inputs: what is counted of them is tested where it is made."""
    monkeypatch.setattr(extremes, "COUNT", 4096)
    monkeypatch.setattr(sampling, "COUNT", 4096)
    monkeypatch.setattr(timing, "SECONDS", 1e-4)
    monkeypatch.setattr(timing, "ROUNDS", 3)
    monkeypatch.setattr(timing, "_grows", lambda stage, loops: True)  # in so short a time nothing is told by the clock
    monkeypatch.setattr(scene, "SIZE", (32, 18))
    monkeypatch.setattr(energy, "ROUGHNESS", (0.3,))
    monkeypatch.setattr(energy, "COSINES", (0.1, 1.0))
    monkeypatch.setattr(timing, "times_on_gpu", lambda jobs: None)
    monkeypatch.setattr(isa, "unavailable", lambda: "no driver")
    tasks._extremes.cache_clear()
    tasks._picture.cache_clear()
    yield
    tasks._extremes.cache_clear()


@pytest.fixture
def rung(small):
    def find(name: str, **how) -> dict:
        data = measure(*small(**how), only=name)
        (term,) = data["terms"]
        (entry,) = term["rungs"]
        return entry

    return find


def test_a_rung_that_is_a_quarter_too_bright(rung):
    found = rung("GAIN_MORE")
    assert found["model"]["median"] == pytest.approx(0.25, rel=1e-12)
    assert found["model"]["max"] == pytest.approx(0.25, rel=1e-12)
    # 1.25 x is x + x/4: a product that float32 rounds by half a unit at most
    assert 0 < found["roundoff"]["precise"]["max"] <= 2.0**-24 < found["roundoff"]["mediump"]["max"] <= 2.0**-10
    # the quad shows twice 0.2, and twice 0.25 with it: 102 and 128 (127.5 rounds up)
    assert found["scene"] | {"flip": None} == {"max": 26, "mean": 26, "flip": None, "changed": 1}
    assert found["extremes"] == dict.fromkeys(tasks.MODES, {"non_finite": 0, "negative": 0}) | {"inputs": 4096}
    assert found["energy"]["furnace_max"] == pytest.approx(1.25 * LAMBERT, abs=1e-8)
    assert found["energy"]["furnace_min"] == pytest.approx(1.25 * LAMBERT, abs=1e-8)
    assert found["cost"]["spirv"] > 0
    assert found["time"][0]["low"] <= found["time"][0]["ns"] <= found["time"][0]["high"]


def test_a_rung_that_breaks_is_counted(rung):
    """x / 0 times 0 is NaN, at every input."""
    found = rung("GAIN_BROKEN", rungs=("GAIN_ONE", "GAIN_BROKEN"))
    assert found["extremes"]["double"] == {"non_finite": 4096, "negative": 0}
    assert found["model"]["max"] == math.inf and math.isnan(found["energy"]["furnace_max"])


def test_an_entry_has_all_parts_and_what_is_missing(rung, monkeypatch):
    monkeypatch.setattr(scene, "flip_unavailable", lambda: "no package")
    found = rung("GAIN_ONE")
    assert set(found) >= {"name", "title", "source", "domain", "suits", "macros", *PARTS, "missing"}
    assert found["scene"]["flip"] is None and set(found["cost"]) == {"spirv"}
    assert found["missing"] == {"scene.flip": "no package", "cost.targets": "no driver"}


def test_what_no_driver_computes_in_a_mode_is_missing_with_its_reason(rung, functions):
    """dFdx has no meaning in a compute stage, and none in double: no part of it is measured there, and all are told."""
    model = """
        struct Material { vec3 albedo; float metalness; float roughness; };
        #define GAIN_ONE 0
        #define GAIN_MORE 1
        #ifndef GAIN
        #define GAIN GAIN_ONE
        #endif
        float gain(float x) { return x + dFdx(x); }
        vec3 shade(vec3 l, vec3 v, vec3 n, Material m) { return m.albedo * gain(dot(n, l)); }
    """
    found = rung("GAIN_ONE", model=model)
    assert found["model"] is None and "double" in found["missing"]["model"]
    assert found["roundoff"]["precise"] is None and found["missing"]["roundoff.precise"]
    assert found["energy"] is None and found["time"] is None
    assert all("\n" not in reason for reason in found["missing"].values())


def test_all_of_it_is_data(small):
    told = []
    data = measure(*small(), only="exact", progress=lambda *step: told.append(step))
    assert json.loads(json.dumps(data)) == data
    assert (data["schema"], data["reference"], data["terms"]) == (1, "exact", [])
    assert data["scene"] == {"project": "project.sprj", "size": [32, 18]}
    (exact,) = data["presets"]
    assert exact["model"]["max"] == exact["scene"]["max"] == 0
    assert exact["time"][0]["ratio"] in (1, None)  # None: what takes nothing beyond the null loop has no ratio
    assert [done for done, _, _ in told] == list(range(1, len(told) + 1)) and told[-1][0] == told[-1][1]


def test_all_are_measured_by_other_processes_as_here(small):
    path, ladder = small()

    work = [tasks.Errors(choice) for choice in choices(sprj.read(path), ladder)[:2]]
    there = dict(tasks.done(work, spread=True))
    assert there[1].parts["model"]["median"] == pytest.approx(0.25, rel=1e-12) and there[0].parts["model"]["max"] == 0


def test_what_compiles_to_the_same_text_is_measured_once(small):
    """The exact rungs and the exact preset are the same shade(), and the same picture."""
    path, ladder = small()

    work = tasks.tasks(str(path), choices(sprj.read(path), ladder))
    kinds = [type(task).__name__ for task, _ in work]
    assert (kinds.count("Soundness"), kinds.count("Errors"), kinds.count("Picture")) == (4, 5, 3)
    assert sorted(k for task, places in work for k in places if isinstance(task, tasks.Soundness)) == [0, 1, 2, 3, 4]


def test_a_rung_that_does_not_compile_is_told_with_its_line(small):
    broken = "float gain(float x) {\n#if GAIN == 1\n return y;\n#else\n return x;\n#endif\n}\n"
    model = f"#define GAIN_ONE 0\n#define GAIN_MORE 1\n{broken}vec3 shade(vec3 l) {{ return l; }}"
    with pytest.raises(GlslError, match=r"brdf.glsl:5:.*'y'"):
        measure(*small(model=model), only="GAIN_MORE")


def test_an_unknown_name_is_told_before_anything_is_measured(small):
    with pytest.raises(LadderError, match="GAIN_LESS"):
        measure(*small(), only="GAIN_LESS")
