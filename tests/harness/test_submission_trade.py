"""What was measured of a project's shading model, in the report of what is handed in."""

from __future__ import annotations

import re
import zipfile

import pytest
import trade_data
from submission_files import write_small

from harness import HarnessError, submission
from harness.submission import evidence
from harness.trade import file


@pytest.fixture
def small(tmp_path):
    return write_small(tmp_path / "small")


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
    put(small, file.text(trade_data.trade()))
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", page(small)))
    assert "What accuracy costs" in text and "Measured on cpu Some CPU" in text
    assert "mobile 0.99 2e-4 0.02 0 0 210 88 88 78 0.6 0.006 23 0.06" in text


def test_without_a_trade_there_is_no_table(small):
    assert evidence.trade(small.parent) is None
    assert "What accuracy costs" not in page(small)


def test_a_broken_trade_is_refused_with_what_to_do(small):
    put(small, "{")
    with pytest.raises(HarnessError, match="trade.json: is no JSON .*`make trade`"):
        page(small)
