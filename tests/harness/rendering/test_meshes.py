"""What attribute locations read of shapes and models."""

from __future__ import annotations

from sprj_files import item, shader_pass, write_project, write_quad

from harness.projects import sprj
from harness.rendering.meshes import layout_attributes
from harness.rendering.prepare import prepare

POSITION, NORMAL, TEXCOORD = 0, 12, 24


def layout(*values: str) -> str:
    return "<inputlayout>" + "".join(f'<item value="{v}" semantic="X" />' for v in values) + "</inputlayout>"


def test_locations_read_the_fields_of_the_layout():
    found = layout_attributes(["Texcoord", "Position", "Color"])
    assert [(a.components, a.offset) for a in found] == [(2, TEXCOORD), (3, POSITION), (4, 56)]


def test_values_for_buffers_read_the_mesh_at_the_count_of_numbers_before():
    found = layout_attributes(["Position", "BufferFloat2", "BufferFloat"])
    assert [(a.components, a.offset) for a in found] == [(3, 0), (2, 3), (1, 5)]


def test_a_model_has_the_layout_of_its_last_item(tmp_path):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    write_quad(tmp_path, "")
    model = "<filepath>m.obj</filepath>"
    passes = shader_pass("A", items=item("One", model, kind="model"), extra=layout("Position", "Normal"))
    passes += shader_pass("B", items=item("Two", model, kind="model"), extra=layout("Position", "Texcoord"))
    for prepared in prepare(sprj.read(write_project(tmp_path, passes))):
        (drawn,) = prepared.items
        assert [a.offset for a in drawn.attributes] == [POSITION, TEXCOORD]
