"""What was measured of a project's shading model, in the report of what is handed in."""

from __future__ import annotations

import re
import zipfile

import pytest
import trade_files
from submission_files import replace, write_small

from harness import HarnessError, submission
from harness.projects import sprj
from harness.submission import evidence
from harness.trade import file


@pytest.fixture
def small(tmp_path):
    project = write_small(tmp_path / "small")
    trade_files.write_model(project.parent / "shaders")
    return project


def put(project, text):
    path = project.parent / evidence.TRADE
    path.parent.mkdir(parents=True)
    path.write_text(text)


def page(project):
    output = project.parent / "build" / "submission.zip"
    submission.make(project, output, size=(64, 36), supersample=1, tests=False)
    with zipfile.ZipFile(output) as archive:
        return archive.read("report.html").decode()


def test_the_report_has_the_table_of_the_presets(small):
    put(small, file.text(trade_files.trade()))
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", page(small)))
    assert "What accuracy costs" in text and "Measured on Some CPU" in text
    assert "exact 0 0.13 1 50 851 21 012 3 1.5 0.015 9 0.012" in text


def test_without_a_trade_there_is_no_table(small):
    assert evidence.trade(sprj.read(small)) is None


def test_a_broken_trade_is_refused_with_what_to_do(small):
    put(small, "{")
    with pytest.raises(HarnessError, match="trade.json: is no JSON .*`make trade`"):
        evidence.trade(sprj.read(small))


def test_a_trade_of_other_shaders_is_left_out_and_that_is_told(small):
    put(small, file.text(trade_files.trade()))
    replace(small.parent / "shaders" / "model.glsl", "c + c * c", "c * c")
    told = []
    assert evidence.trade(sprj.read(small), told.append) is None
    (said,) = told
    assert re.search(r"leaving out build/trade/trade.json.*1 costs 6 .* not 9 .*`make trade`", said)
