"""Checks what the vertex shader reads against what models and shapes have: attributes, tangents, handedness."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path

import numpy as np

from .. import native
from ..errors import NativeError, did_you_mean
from ..native import Field, Mesh, Stage
from ..native.mesh_data import SLICES, MeshData, mesh_data
from ..projects.project import SHAPES
from ..projects.xml_lines import Element
from ..rendering import shapes
from . import declarations, flow, roles, samplers
from .state import PassState, State, child_text, path_of
from .structure import check_path, read_number

_FIELDS = {f.name.capitalize(): f for f in Field}
#: value of the input layout -> beginnings of an attribute's words that mean it
_NAMES = {
    "Position": ("position", "pos", "vertex"),
    "Normal": ("normal", "norm", "nrm"),
    "Texcoord": ("texcoord", "uv", "tex", "st"),
    "Tangent": ("tangent", "tan"),
    "Bitangent": ("bitangent", "binormal", "bitan"),
    "Color": ("color", "colour", "col"),
}
_FEW = 0.001  # a share of triangles that is no more than a seam
_SLIVER = 1e-5  # twice a triangle's area over the square of its longer side: rounding makes such of nothing


def load(path: Path) -> MeshData:
    """A model file's vertices. NativeError."""
    return _load(path.resolve(), path.stat().st_mtime_ns)


@lru_cache(maxsize=32)
def _load(path: Path, _changed: int) -> MeshData:
    native.open_context()
    return mesh_data(Mesh.load(path))


def readable(path: Path) -> MeshData | None:
    """The same; None where it cannot be read."""
    try:
        return load(path) if path.is_file() else None
    except NativeError:
        return None


def check(state: State) -> None:
    """Checks the items of all passes."""
    for shader_pass in state.passes:
        attributes = _attributes(state, shader_pass)
        first: dict[str, Element] = {}
        for item in shader_pass.items:
            if item.attributes.get("type") == "model":
                first.setdefault(child_text(item, "filepath"), item)
        for item in first.values():
            _check_model(state, shader_pass, item, attributes)
        if attributes is not None and _reads_normal_map(shader_pass):
            _check_tangents(state, shader_pass, attributes)
    _check_layouts(state)


def _attributes(state: State, shader_pass: PassState) -> dict[str, int] | None:
    """Value of the layout -> location, for those that the program reads; checks them by themselves."""
    if shader_pass.program is None or Stage.VERTEX not in shader_pass.preprocessed:
        return None
    source = shader_pass.sources[Stage.VERTEX]
    declared = declarations.attributes(shader_pass.preprocessed[Stage.VERTEX])
    drawn = _drawn(shader_pass)
    only_quads = all(child_text(i, "type") == "ScreenQuadNDC" for i in drawn)
    has_buffers = any(i.attributes.get("type") == "vertexbuffer" or child_text(i, "instancebuffer") for i in drawn)
    layout = ("Position", "Texcoord") if only_quads else shader_pass.layout
    read: dict[str, int] = {}
    for name, attribute in shader_pass.program.attributes.items():
        if attribute.location < 0 or name not in declared:
            continue
        _, is_explicit, line = declared[name]
        at = source.origin(line)
        if not is_explicit:
            state.add(
                "HS507",
                at,
                f'the attribute "{name}" of pass "{shader_pass.name}" has no explicit location; this driver takes '
                f"{attribute.location}",
                f"write layout(location = {attribute.location}) in ...",
            )
        if attribute.location >= len(layout):
            if has_buffers:  # whose fields follow the layout
                continue
            state.add(
                "HS504",
                at,
                f'the attribute "{name}" of pass "{shader_pass.name}" has location {attribute.location}, but the input '
                f"layout has {len(layout)} items: {', '.join(layout)}",
                "add what it is to the pass's <inputlayout>",
            )
            continue
        value = layout[attribute.location]
        read.setdefault(value, attribute.location)
        meant = _meaning(name)
        if meant is not None and meant != value and value in _NAMES:
            state.add(
                "HS505",
                at,
                f'the attribute "{name}" at location {attribute.location} of pass "{shader_pass.name}" reads {value}',
                f"put {meant} at place {attribute.location} of the input layout, or correct the location",
            )
    return read


def _meaning(name: str) -> str | None:
    """The layout value that an attribute's name asks for, by its last telling word."""
    for part in reversed(roles.words(name)):
        for value, beginnings in _NAMES.items():
            if any(part == b or (len(b) > 3 and part.startswith(b)) for b in beginnings):
                return value
    return None


def _drawn(shader_pass: PassState) -> list[Element]:
    return [i for i in shader_pass.items if i.attributes.get("type") in ("geometry", "model", "vertexbuffer")]


def _check_model(state: State, shader_pass: PassState, item: Element, attributes: dict[str, int] | None) -> None:
    relative = path_of(child_text(item, "filepath"))
    path, name = state.file(relative), item.attributes.get("name", "")
    at = item.child("filepath") or item
    what = f'item "{name}" of pass "{shader_pass.name}"'
    check_path(state, at, relative)
    if not os.path.isfile(path):
        folder = path.parent
        hint = did_you_mean(path.name, os.listdir(folder) if folder.is_dir() else ())
        message = f'{what}: there is no model file "{relative}"{hint}'
        state.add("HS501", at, message, "correct the path: it is relative to the .sprj, and white space in it counts")
        return
    try:
        data = load(path)
    except NativeError as error:
        reason = error.message.rpartition(f"{path.resolve()}: ")[2].partition(" of file ")[0]
        state.add(
            "HS501", at, f'{what}: cannot read the model "{relative}": {reason}', "write it again, as glTF or OBJ"
        )
        return
    values = [v for v in attributes or () if v in _FIELDS and v not in ("Position", "Color")]
    lacking = [f"no {v.lower()}s {lack}" for v in values if (lack := _lack(data, _FIELDS[v]))]
    if lacking:
        state.add(
            "HS502",
            at,
            f'"{relative}" has {" and ".join(lacking)}, which the vertex shader of pass "{shader_pass.name}" '
            "reads: they are 0",
            "export the model with them, or do without them in the shader",
        )


def _lack(data: MeshData, field: Field) -> str | None:
    """At how many vertices a mesh lacks a field; None where at none."""
    values = data.vertices[:, SLICES[field]]
    if field == Field.TEXCOORD:
        zero = 0 if field in data.fields else len(values)
    else:
        zero = int((np.abs(values).max(axis=1) == 0).sum() if len(values) else 0)
    if zero == 0:
        return None
    return "at all" if zero == len(values) else f"at {zero} of {len(values)} vertices"


# ---- Tangents ------------------------------------------------------------------------------------------------


def _reads_normal_map(shader_pass: PassState) -> bool:
    """Whether a texture that is a normal map by its name or its use goes to a sampler that is sampled."""
    text = shader_pass.preprocessed.get(Stage.FRAGMENT, "")
    for bound, sampler in samplers.given(shader_pass):
        is_normal = roles.NORMAL in (roles.of_file(bound.path or ""), samplers.wanted_role(shader_pass, sampler))
        if is_normal and flow.decodes(text, sampler) is not None:
            return True
    return False


def tangent_agreement(data: MeshData) -> np.ndarray:
    """For each triangle the cosine between its corners' mean tangent and the direction of growing u: (n,) float64.
    Triangles without area, of the surface or of the texture, are left out."""
    corners = data.vertices[data.triangles].astype(float)
    position, uv = corners[..., SLICES[Field.POSITION]], corners[..., SLICES[Field.TEXCOORD]]
    p1, p2 = position[:, 1] - position[:, 0], position[:, 2] - position[:, 0]
    (u1, v1), (u2, v2) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
    determinant = u1 * v2 - u2 * v1
    along_u = (p1 * v2[:, None] - p2 * v1[:, None]) * np.sign(determinant)[:, None]
    tangent = corners[..., SLICES[Field.TANGENT]].mean(axis=1)
    length = np.linalg.norm(along_u, axis=1) * np.linalg.norm(tangent, axis=1)
    area = np.linalg.norm(np.cross(p1, p2), axis=1)
    is_sliver = area <= _SLIVER * np.maximum((p1**2).sum(axis=1), (p2**2).sum(axis=1))
    kept = np.isfinite(length) & (length > 0) & (determinant != 0) & ~is_sliver
    return (along_u * tangent).sum(axis=1)[kept] / length[kept]


def handedness(data: MeshData) -> np.ndarray:
    """Sign of dot(cross(normal, tangent), bitangent) at each vertex: (n,), -1 where the texture is mirrored."""
    normal, tangent, bitangent = (
        data.vertices[:, SLICES[f]].astype(float) for f in (Field.NORMAL, Field.TANGENT, Field.BITANGENT)
    )
    return np.sign((np.cross(normal, tangent) * bitangent).sum(axis=1))


def _check_tangents(state: State, shader_pass: PassState, attributes: dict[str, int]) -> None:
    if "Tangent" not in attributes:
        return
    seen: set[str] = set()
    for item in _drawn(shader_pass):
        at, name = item, item.attributes.get("name", "")
        kind, file = item.attributes.get("type"), child_text(item, "filepath")
        if kind == "model" and file in seen:
            continue
        seen.add(file)
        if kind == "geometry":
            data = _shape(item)
            what = f'the built-in {child_text(item, "type")} "{name}"'
        elif kind == "model":
            data = readable(state.file(path_of(file)))
            what, at = f'the model of item "{name}"', item.child("filepath") or item
        else:
            data = None
        if data is None:
            continue
        agreement = tangent_agreement(data)
        against = (agreement < 0).mean() if agreement.size else 0.0
        if against > _FEW:
            state.add(
                "HS503",
                at,
                f'the tangents of {what} in pass "{shader_pass.name}" point against growing u on '
                f"{_share(against)} of its "
                "triangles, and the pass reads a normal map",
                "use a model with tangents of its own, or turn the tangent in the shader"
                if kind == "geometry"
                else "export the model's tangents again, from the same texture coordinates",
            )
        elif kind == "model" and "Bitangent" not in attributes:
            mirrored = (handedness(data) < 0).mean()
            if mirrored > _FEW:
                state.add(
                    "HS508",
                    at,
                    f"{what} has mirrored texture coordinates at {_share(mirrored)} of its vertices, and pass "
                    f'"{shader_pass.name}" does not read Bitangent',
                    "read Bitangent, and turn cross(n, t) by the sign of dot(cross(n, t), bitangent)",
                )


def _share(share: float) -> str:
    return "all" if share > 1 - _FEW else f"{100 * share:.3g} %"


def _shape(item: Element) -> MeshData | None:
    shape = child_text(item, "type")
    if shape not in SHAPES or shape == "ScreenQuadNDC":
        return None
    size = tuple(read_number(child_text(item, tag, "1")) or 1.0 for tag in ("width", "height", "depth"))
    vertices = np.asarray(shapes.vertices(shape, size), np.float32)
    triangles = np.arange(len(vertices) // 3 * 3, dtype=np.uint32).reshape(-1, 3)
    return MeshData(frozenset(Field), vertices, triangles)


def _check_layouts(state: State) -> None:
    """A model file with different layouts in different passes."""
    seen: dict[str, PassState] = {}
    for shader_pass in state.passes:
        for item in shader_pass.items:
            if item.attributes.get("type") != "model":
                continue
            path = path_of(child_text(item, "filepath"))
            other = seen.setdefault(path, shader_pass)
            if other.layout != shader_pass.layout:
                state.add(
                    "HS506",
                    item.child("filepath") or item,
                    f'"{path}" has the layout {", ".join(other.layout)} in pass "{other.name}" (line '
                    f"{other.element.line}) "
                    f'and {", ".join(shader_pass.layout)} in pass "{shader_pass.name}"',
                    "give both passes the same <inputlayout>, or the file another name",
                )
