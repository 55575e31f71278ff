"""``harness cost``: its table, and what it says where there is no driver."""

from __future__ import annotations

import argparse

import pytest

from harness import CallError
from harness.commands import cost
from harness.costing import isa


@pytest.fixture
def run(capsys):
    """Runs the command; what it wrote to stdout and stderr."""

    def command(*arguments):
        parser = argparse.ArgumentParser()
        cost.add_arguments(parser)
        cost.run(parser.parse_args([str(a) for a in arguments]))
        return capsys.readouterr()

    return command


@pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))
def test_a_line_a_chip(run, root):
    written = run(root / "shaders" / "brdf.glsl", "D_GGX", "--target", "navi21,vega10")
    head, *lines = written.out.splitlines()
    assert head.split()[2:] == ["instructions", "VGPRs", "latency", "cycles"]
    assert [line.split()[0] for line in lines] == ["navi21", "vega10", "SPIR-V"]
    assert all(int(number) > 0 for line in lines for number in line.split()[1:])
    assert written.err == ""


@pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))
def test_branches_are_told(run, tmp_path):
    path = tmp_path / "f.glsl"
    chain = "float r = exp2(x); for (int k = 0; k < 24; ++k) r = r * x + y; return r;"
    path.write_text(f"float f(float x, float y) {{ if (x > y) {{ {chain} }} return x; }}\n")
    assert "flattered" in run(path, "f", "--target", "vega10").out


def test_macros_count(run, root):
    path = root / "shaders" / "brdf.glsl"
    exact, hammon = (
        float(run(path, "shade", "--target", "vega10", *more).out.split()[-1])
        for more in ((), ("-D", "BRDF_V=V_HAMMON"))
    )
    assert hammon < exact


def test_without_a_driver_there_is_the_count_alone_and_the_reason(run, root, monkeypatch):
    monkeypatch.setattr(isa, "unavailable", lambda: "no driver; on Debian: make cost")
    written = run(root / "shaders" / "brdf.glsl", "D_GGX")
    assert written.out.split() == ["SPIR-V", "14"]
    assert "make cost" in written.err


def test_an_unknown_function_lists_what_there_is(run, root):
    with pytest.raises(CallError, match="D_GGXX.*D_GGX,"):
        run(root / "shaders" / "brdf.glsl", "D_GGXX")
