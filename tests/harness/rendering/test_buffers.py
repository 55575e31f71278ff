"""What attributes read of the rows of buffers."""

from __future__ import annotations

import pytest

from harness.native import gl_enums
from harness.projects.project import Buffer
from harness.rendering import buffers


def rows(text: str, size: int = 0) -> Buffer:
    return Buffer(name="b", binds=(), line=1, size=size, format=text)


@pytest.mark.parametrize(
    "text, numbers",
    [
        ("vec3;vec2", [3, 2]),
        ("vec3;vec2;", [3, 2]),
        ("float; vec4", [1, 4]),
        ("mat3;float2x2", [9, 4]),
        ("vec4 ;nothing", [1, 1]),  # neither is a type: floats
    ],
)
def test_the_types_of_a_row(text, numbers):
    types = buffers.row_types(text)
    assert [t.numbers for t in types] == numbers
    assert {t.gl_type for t in types} == {gl_enums.GL_FLOAT}


def test_an_instance_row_counts_4_bytes_a_number_and_reads_a_matrix_s_first_column():
    found = buffers.instance_attributes(rows("bvec3;ivec2;mat4;float"), None)
    assert [(a.components, a.type, a.offset) for a in found] == [
        (3, gl_enums.GL_BYTE, 0),
        (2, gl_enums.GL_INT, 12),
        (4, gl_enums.GL_FLOAT, 20),
        (1, gl_enums.GL_FLOAT, 84),
    ]
    assert {(a.stride, a.divisor) for a in found} == {(88, 1)}


def test_a_vertex_row_counts_a_byte_a_truth_value():
    found, count = buffers.vertex_attributes(rows("bvec3;vec2", size=40), None)
    assert [(a.components, a.type, a.offset) for a in found] == [(3, gl_enums.GL_FLOAT, 0), (2, gl_enums.GL_FLOAT, 3)]
    assert {(a.stride, a.divisor) for a in found} == {(11, 0)} and count == 3
