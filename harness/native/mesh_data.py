"""What a mesh on the GL side consists of, copied back for those who look at models: hn_mesh_read and its like."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import numpy as np

from . import Field, Mesh, _done, _library

_PROTOTYPES = {
    "hn_mesh_fields": (ctypes.c_uint32, [ctypes.c_void_p]),
    "hn_mesh_vertex_count": (ctypes.c_size_t, [ctypes.c_void_p]),
    "hn_mesh_index_count": (ctypes.c_size_t, [ctypes.c_void_p]),
    "hn_mesh_read": (ctypes.c_int, [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]),
}
for _name, (_result, _arguments) in _PROTOTYPES.items():
    _function = getattr(_library, _name)
    _function.restype, _function.argtypes = _result, _arguments


#: where each field lies among the floats of a vertex
SLICES = {
    Field.POSITION: slice(0, 3),
    Field.NORMAL: slice(3, 6),
    Field.TEXCOORD: slice(6, 8),
    Field.TANGENT: slice(8, 11),
    Field.BITANGENT: slice(11, 14),
    Field.COLOR: slice(14, 18),
}


class MeshData(NamedTuple):
    """``fields``: those that every part of the file came with. ``vertices`` (n, 18) float32, fields at SLICES,
    ``triangles`` (m, 3) uint32 indices into them."""

    fields: frozenset[Field]
    vertices: np.ndarray
    triangles: np.ndarray


def mesh_data(mesh: Mesh) -> MeshData:
    """Copies a mesh. NativeError when its context is gone."""
    handle = mesh._handle
    bits = _library.hn_mesh_fields(handle)
    vertices = np.empty((_library.hn_mesh_vertex_count(handle), SLICES[Field.COLOR].stop), np.float32)
    indices = np.empty(_library.hn_mesh_index_count(handle), np.uint32)
    _done(_library.hn_mesh_read(handle, vertices.ctypes.data, indices.ctypes.data))
    return MeshData(frozenset(f for f in Field if bits >> f & 1), vertices, indices.reshape(-1, 3))
