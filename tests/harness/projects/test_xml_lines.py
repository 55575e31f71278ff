"""XML with lines: what is text, what is refused, and where it says so."""

from __future__ import annotations

import pytest
from sprj_files import item, read, refusal, shader_pass, write_project

from harness.projects import xml_lines


def test_another_xml_file(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text("<svg />")
    assert "<svg> is not a SHADERed project" in refusal(path).message


def test_a_mismatched_tag_names_both_lines(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text('<project version="2">\n<items>\n<item />\n</item>\n</project>')
    error = refusal(path)
    assert error.line == 4 and "<items> of line 2" in error.message


@pytest.mark.parametrize("data", [b"", b"not xml", b"<project>", b"<a/><b/>", b"\xff\xfe\x00", b"<a>&x;</a>"])
def test_malformed_xml(tmp_path, data):
    path = tmp_path / "project.sprj"
    path.write_bytes(data)
    assert refusal(path).message.startswith("malformed XML: ")


def test_a_document_type_is_refused_before_its_entities(tmp_path):
    entities = ['<!ENTITY a0 "x">'] + [f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 12)]
    path = tmp_path / "project.sprj"
    path.write_text("<!DOCTYPE p [" + "".join(entities) + ']>\n<project version="2">&a11;</project>')
    error = refusal(path)
    assert error.line == 1 and "<!DOCTYPE ... [...]>" in error.message


def test_a_project_that_is_not_there(tmp_path):
    assert "cannot read the project" in refusal(tmp_path / "gone.sprj").message


def test_a_comment_ends_a_text(tmp_path):
    items = '<item name="M" type="model"><filepath>a.glb<!-- old -->b.glb</filepath></item>'
    assert read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0].path == "a.glb"


def test_white_space_belongs_to_a_path(tmp_path):
    items = '<item name="M" type="model"><filepath> a.glb </filepath></item>'
    assert read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0].path == " a.glb "


def test_a_section_of_characters_ends_a_text(tmp_path):
    items = item("M", "<filepath><![CDATA[a]]>b.glb</filepath>", kind="model")
    assert read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0].path == "a"


def test_a_document_type_without_declarations_is_passed_over(tmp_path):
    path = write_project(tmp_path, shader_pass())
    path.write_text(path.read_text().replace("<project ", '<!DOCTYPE project SYSTEM "project.dtd">\n<project '))
    assert len(read(path).passes) == 1


def test_elements_too_deep(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text("<project>\n" + "<a>" * 100_000)
    error = refusal(path)
    assert "more than 64 deep" in error.message and error.line == 2


def test_a_file_too_large(tmp_path, monkeypatch):
    monkeypatch.setattr(xml_lines, "MOST_BYTES", 1 << 20)
    path = tmp_path / "project.sprj"
    path.write_text("<project>" + " " * (1 << 20))
    assert "more than 1 MiB" in refusal(path).message


@pytest.mark.parametrize("encoding", ["no-such-thing", "hex", "utf-7", "undefined"])
def test_an_encoding_that_is_none_is_refused(tmp_path, encoding):
    path = tmp_path / "p.sprj"
    path.write_text(f'<?xml version="1.0" encoding="{encoding}"?><project version="2"/>')
    assert "malformed XML" in refusal(path).message
