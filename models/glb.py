"""A triangle mesh as a glTF 2.0 binary file (Khronos Group, "glTF 2.0 Specification", 2021, section 4.4)."""

import json
import struct
from collections.abc import Mapping

import numpy as np

MAGIC = 0x46546C67
VERSION = 2
CHUNK_JSON = 0x4E4F534A
CHUNK_BIN = 0x004E4942
ARRAY_BUFFER = 34962
ELEMENT_ARRAY_BUFFER = 34963
UNSIGNED_SHORT = 5123
FLOAT = 5126
TRIANGLES = 4


def chunk(kind: int, data: bytes, filler: bytes) -> bytes:
    """A chunk of the container, filled up to the multiple of 4 bytes that the format asks for."""
    data += filler * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data


def pack(name: str, attributes: Mapping[str, np.ndarray], triangles: np.ndarray, extras: Mapping[str, str]) -> bytes:
    """The file's bytes: one mesh of one primitive, in one node without a transform.

    attributes: glTF's semantic ("POSITION", which must be there, "NORMAL", ...) to (vertices, k) float32;
    triangles: (triangles, 3) uint16; extras: free text about the asset, such as its source.
    """
    views, accessors, binary = [], [], b""
    arrays = {**attributes, "indices": triangles.reshape(-1)}
    for semantic, array in arrays.items():
        is_index = semantic == "indices"
        data = array.astype("<u2" if is_index else "<f4").tobytes()
        views.append(
            {
                "buffer": 0,
                "byteOffset": len(binary),
                "byteLength": len(data),
                "target": ELEMENT_ARRAY_BUFFER if is_index else ARRAY_BUFFER,
            }
        )
        accessor = {
            "bufferView": len(accessors),
            "componentType": UNSIGNED_SHORT if is_index else FLOAT,
            "count": len(array),
            "type": "SCALAR" if is_index else f"VEC{array.shape[1]}",
        }
        if semantic == "POSITION":  # the one attribute whose bounds glTF requires
            accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        accessors.append(accessor)
        binary += data + b"\0" * (-len(data) % 4)
    primitive = {
        "attributes": {semantic: k for k, semantic in enumerate(attributes)},
        "indices": len(attributes),
        "mode": TRIANGLES,
    }
    document = {
        "asset": {"version": "2.0", "generator": "models/make_models.py", "extras": dict(extras)},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": name, "mesh": 0}],
        "meshes": [{"name": name, "primitives": [primitive]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode("ascii")
    chunks = chunk(CHUNK_JSON, text, b" ") + chunk(CHUNK_BIN, binary, b"\0")
    return struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks
