"""Buffer objects: their content, and what attributes read of their rows."""

from __future__ import annotations

import os
from dataclasses import dataclass

from ..errors import ProjectError
from ..native import Attribute, gl_enums
from ..native import Buffer as NativeBuffer
from ..projects.project import Buffer, Project
from ..projects.traps import Traps


@dataclass(frozen=True)
class RowType:
    """A type in a buffer's format: how many components a vertex attribute has of it, and how many numbers it is."""

    components: int
    numbers: int
    gl_type: int = gl_enums.GL_FLOAT

    @property
    def bytes(self) -> int:
        """Its length, at 4 bytes a number."""
        return 4 * self.numbers

    @property
    def packed_bytes(self) -> int:
        """Its length where truth values take one byte each."""
        return self.numbers if self.gl_type == gl_enums.GL_BYTE else self.bytes


def _types() -> dict[str, RowType]:
    kinds = {
        gl_enums.GL_BYTE: ("bool byte", "bvec bool byte"),
        gl_enums.GL_INT: ("int", "ivec int"),
        gl_enums.GL_FLOAT: ("float", "vec float"),
    }
    types = {}
    for gl_type, (scalars, vectors) in kinds.items():
        types |= {name: RowType(1, 1, gl_type) for name in scalars.split()}
        types |= {f"{name}{n}": RowType(n, n, gl_type) for name in vectors.split() for n in (2, 3, 4)}
    for n in (2, 3, 4):
        types[f"mat{n}"] = types[f"float{n}x{n}"] = RowType(n, n * n)
    return types


TYPES = _types()


def row_types(text: str) -> list[RowType]:
    """The types of a format such as ``vec3;vec2``. What is none, also with a space after it, is a float."""
    parts = text.split(";")
    if not parts[-1]:
        parts.pop()
    return [TYPES.get(part.lstrip(), TYPES["float"]) for part in parts]


def instance_attributes(buffer: Buffer, made: NativeBuffer) -> list[Attribute]:
    """What attributes read of an instance buffer: one row an instance; of a matrix the first column alone."""
    types = row_types(buffer.format)
    stride, offset, attributes = sum(t.bytes for t in types), 0, []
    for t in types:
        attributes.append(Attribute(t.components, t.gl_type, stride, offset, made, divisor=1))
        offset += t.bytes
    return attributes


def vertex_attributes(buffer: Buffer, made: NativeBuffer) -> tuple[list[Attribute], int]:
    """What attributes read of a vertex buffer, and how many rows it has. Integers are read as if they were floats."""
    types = row_types(buffer.format)
    stride, offset, attributes = sum(t.packed_bytes for t in types), 0, []
    for t in types:
        attributes.append(Attribute(t.numbers, gl_enums.GL_FLOAT, stride, offset, made))
        offset += t.packed_bytes
    return attributes, buffer.size // stride if stride else 0


def content(project: Project, buffer: Buffer, traps: Traps) -> bytes:
    """The buffer's bytes: those of its file, as many as it has, and zeros."""
    path = project.path(buffer.path)
    data = b""
    if os.path.isfile(path):
        try:
            with open(path, "rb") as file:
                data = file.read(buffer.size)
        except OSError as error:
            message = f'<object type="buffer"> "{buffer.name}": cannot read "{buffer.path}": {error.strerror}'
            raise ProjectError(message, project.file, buffer.line) from None
    if len(data) < buffer.size:
        traps.warn(
            f'the buffer "{buffer.name}": "{buffer.path}" has {len(data)} of its {buffer.size} bytes; SHADERed shows '
            "whatever is in memory beyond them, here they are 0",
            str(project.file),
            buffer.line,
        )
    return data.ljust(buffer.size, b"\0")
