"""``harness trade``: what it writes, what it prints, and that it writes all or nothing. What is measured is made up."""

from __future__ import annotations

import argparse

import pytest
import trade_data
from command_line import main

from harness import HarnessError, ladder
from harness.commands import trade
from harness.trade import choices, file, illustrate, markdown, measure, readme


@pytest.fixture
def measured(root, monkeypatch):
    """The project, and what ``measure`` was asked for; nothing is measured."""
    asked = []

    def made_up(project_path, rungs, only=None, progress=None):
        asked.append(only)
        progress(1, 2, "errors")
        return trade_data.trade()

    monkeypatch.setattr(measure, "measure", made_up)
    monkeypatch.setattr(choices, "choices", lambda project, rungs: ())
    monkeypatch.setattr(illustrate, "pictures", lambda *_: trade_data.pictures())
    monkeypatch.setattr(illustrate, "maps", lambda *_: trade_data.maps())
    return root / "project.sprj", asked


def run(*arguments):
    parser = argparse.ArgumentParser()
    trade.add_arguments(parser)
    trade.run(parser.parse_args([str(a) for a in arguments]))


def test_it_writes_the_data_the_document_and_the_page(measured, tmp_path, capsys):
    run(measured[0], "-o", tmp_path / "deep" / "trade")
    assert sorted(p.name for p in (tmp_path / "deep" / "trade").iterdir()) == ["index.html", "trade.json", "trade.md"]
    assert file.read(tmp_path / "deep" / "trade" / "trade.json") == trade_data.trade()
    written = capsys.readouterr()
    assert (
        written.out == (tmp_path / "deep" / "trade" / "trade.md").read_text() == markdown.document(trade_data.trade())
    )
    assert written.err == ""  # no bar in a pipe


def test_one_rung_is_measured_alone_and_nothing_written(measured, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run(measured[0], "--rung", "V_HAMMON")
    assert measured[1] == ["V_HAMMON"]
    assert capsys.readouterr().out == markdown.row(trade_data.trade(), "V_HAMMON")
    assert list(tmp_path.iterdir()) == []


def test_the_readme_is_given_the_table_and_the_data_stand_beside_it(measured, tmp_path):
    (tmp_path / "docs").mkdir()
    path = tmp_path / "README.md"
    path.write_text(f"# Ours\n{readme.BEGIN}\n{readme.END}\nend\n")
    run(measured[0], "-o", tmp_path / "out", "--readme", path)
    assert path.read_text() == f"# Ours\n{readme.block(trade_data.trade())}\nend\n"
    assert file.read(tmp_path / "docs" / "trade.json") == trade_data.trade()


def test_a_readme_without_a_place_is_refused_before_anything_is_measured(measured, tmp_path):
    path = tmp_path / "README.md"
    path.write_text("# Ours\n")
    with pytest.raises(HarnessError, match="no place for the table"):
        run(measured[0], "-o", tmp_path / "out", "--readme", path)
    assert measured[1] == [] and not (tmp_path / "out").exists()


def test_what_is_there_stays_when_the_page_cannot_be_made(measured, tmp_path, monkeypatch):
    from harness.trade import page

    def fail(*_):
        raise HarnessError("no jinja2")

    (tmp_path / "trade.json").write_text("before")
    monkeypatch.setattr(page, "page", fail)
    with pytest.raises(HarnessError):
        run(measured[0], "-o", tmp_path)
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("trade.json", "before")]


def test_a_folder_that_cannot_be_made_is_one_line(measured, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["trade", str(measured[0]), "-o", str(tmp_path / "file" / "trade")]) == 1
    assert capsys.readouterr().err.endswith("cannot make the folder: Not a directory\n")


def test_a_project_without_a_ladder_is_told_so(tmp_path, capsys):
    (tmp_path / "p.sprj").write_text('<?xml version="1.0"?><project version="2"><pipeline /></project>')
    assert main(["trade", str(tmp_path / "p.sprj")]) == 1
    assert f"there is no {ladder.FILE}" in capsys.readouterr().err


def test_the_help_says_what_is_measured(capsys):
    with pytest.raises(SystemExit):
        main(["trade", "--help"])
    said = capsys.readouterr().out
    assert all(word in said for word in ("harness trade --rung", "trade.json", "extremes", "ladder.toml"))
