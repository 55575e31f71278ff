"""The items of passes, ready to draw: meshes and buffers, and what each attribute location reads of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from .. import native
from ..errors import NativeError, ProjectError
from ..native import Attribute, Field
from ..projects.project import Buffer, Geometry, Item, Model, Pass, Project, VertexBuffer
from ..projects.traps import Traps
from . import buffers, shapes, states


@dataclass(frozen=True)
class PreparedItem:
    """An item ready to draw; attribute location k reads ``attributes[k]``. ``topology`` is GL's, None where SHADERed
    hands GL one that is none. ``n_vertices`` is of items without a mesh."""

    item: Item
    mesh: native.Mesh | None
    attributes: tuple[Attribute, ...]
    state: native.State
    topology: int | None
    n_vertices: int = 0


def layout_attributes(layout: Sequence[str]) -> list[Attribute]:
    """What attribute locations read of a mesh. Those meant for buffers read the mesh too, in SHADERed, at an offset
    in bytes that counts the numbers before."""
    attributes, offset = [], 0
    for value in layout:
        if value.startswith("Buffer"):
            attribute = Attribute(int(value[-1]) if value[-1].isdigit() else 1, offset=offset)
        else:
            attribute = Field[value.upper()].attribute
        attributes.append(attribute)
        offset += attribute.components
    return attributes


class Meshes:
    """The meshes of a project, each file and shape once."""

    def __init__(self, project: Project, made: Mapping[str, native.Buffer], traps: Traps):
        self._project = project
        self._traps = traps
        self._buffers: dict[str, tuple[Buffer, native.Buffer]] = {
            b.name: (b, made[b.name]) for b in project.buffers if b.name in made
        }
        self._made: dict[object, native.Mesh] = {}

    def items(self, shader_pass: Pass) -> tuple[PreparedItem, ...]:
        """The pass's items; with ``keep_going`` without those that cannot be drawn."""
        prepared = []
        for item in shader_pass.items:
            try:
                prepared.append(self._item(shader_pass, item))
            except ProjectError as error:
                self._traps.survive(error)
        return tuple(prepared)

    def _error(self, shader_pass: Pass, item: Item, message: str) -> ProjectError:
        kind = {Model: "model", VertexBuffer: "vertexbuffer"}.get(type(item), "geometry")
        what = f'<item type="{kind}"> "{item.name}" of pass "{shader_pass.name}"'
        return ProjectError(f"{what}: {message}", self._project.file, item.line)

    def _buffer(self, shader_pass: Pass, item: Item, name: str) -> tuple[Buffer, native.Buffer]:
        if name not in self._buffers:
            raise self._error(shader_pass, item, f'there is no buffer "{name}" with content: SHADERed crashes')
        return self._buffers[name]

    def _item(self, shader_pass: Pass, item: Item) -> PreparedItem:
        state = states.gl_state(item.state)
        if isinstance(item, VertexBuffer):
            attributes, count = (
                buffers.vertex_attributes(*self._buffer(shader_pass, item, item.buffer)) if item.buffer else ([], 0)
            )
            if any(a.components > 4 for a in attributes):
                raise self._error(shader_pass, item, "matrices in a vertex buffer are not supported, by GL neither")
            attributes += self._of_instances(shader_pass, item, item.instance_buffer)
            return PreparedItem(item, None, tuple(attributes), state, states.TOPOLOGIES[item.topology], count)
        layout, instance_buffer = shader_pass.layout, item.instance_buffer
        if isinstance(item, Model):
            layout, instance_buffer = self._project.model_layouts.get(item.path, (layout, instance_buffer))
        attributes = layout_attributes(layout)
        if isinstance(item, Geometry) and item.shape == "ScreenQuadNDC":
            attributes = layout_attributes(("Position", "Texcoord"))  # whatever the pass's input layout
            if instance_buffer:
                raise self._error(shader_pass, item, "an instance buffer of a ScreenQuadNDC is not supported")
        attributes += self._of_instances(shader_pass, item, instance_buffer)
        topology = item.topology if isinstance(item, Geometry) else "TriangleList"
        mesh = self._mesh(shader_pass, item)
        return PreparedItem(item, mesh, tuple(attributes), state, states.TOPOLOGIES[topology])

    def _of_instances(self, shader_pass: Pass, item: Item, name: str | None) -> list[Attribute]:
        return buffers.instance_attributes(*self._buffer(shader_pass, item, name)) if name else []

    def _mesh(self, shader_pass: Pass, item: Item) -> native.Mesh:
        if isinstance(item, Geometry):
            return self._once(
                (item.shape, item.size), lambda: native.Mesh.create(shapes.vertices(item.shape, item.size))
            )
        path = self._project.path(item.path)
        if not os.path.isfile(path):
            raise self._error(shader_pass, item, f'there is no file "{item.path}"')
        try:
            mesh = self._once(item.path, lambda: native.Mesh.load(path))
        except NativeError as error:
            raise self._error(shader_pass, item, f'cannot read the model "{item.path}": {error.message}') from None
        if mesh.stray_faces:
            self._traps.warn(
                f'the model "{item.path}" has {mesh.stray_faces} points or lines, which SHADERed draws as triangles',
                str(self._project.file),
                item.line,
            )
        return mesh

    def _once(self, key: object, make: Callable[[], native.Mesh]) -> native.Mesh:
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]
