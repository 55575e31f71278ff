"""Writes a camera into a .sprj: its numbers alone change, or an entry is added; every other byte of the file stays."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from xml.parsers import expat

import numpy as np

from ..errors import ProjectError
from ..picture import write
from ..rendering.camera import Camera
from .project import ArcballCamera
from .sprj_settings import read_settings
from .xml_lines import parse

_V1_NAMES = {"yaw": "rotationX", "pitch": "rotationY", "roll": "rotationZ"}


def write_camera(path: str | os.PathLike, camera: Camera) -> None:
    """Writes the numbers that differ, in the shortest form that is the same single-precision number.

    The camera must be of the kind that the file's entry has; a file without one gets one, first in its settings, where
    SHADERed writes it. ProjectError where the kind is another, or the file is in an encoding that is not ASCII's.
    """
    root = parse(path)
    settings = root.child("settings")
    entries = [e for e in settings.all("entry") if e.get("type") == "camera"] if settings else []
    v1 = root.get("version", "1") == "1"
    # By name: the renaming must not turn a link into a file.
    real = Path(path).resolve()
    data = real.read_bytes()
    if b"\0" in data:
        raise ProjectError("the camera cannot be written to a file in UTF-16: save it as UTF-8", path)
    if not entries:
        _write(real, _with_entry(data, camera, v1))
        return
    there = read_settings(entries[-1:], v1=v1).camera
    if type(there) is not type(camera):
        raise entries[-1].error("the camera of the file is of another kind than the one that is shown")
    new = _numbers(camera, v1)
    changes = {name: value for name, value in _numbers(there, v1).items() if np.float32(value) != np.float32(new[name])}
    if not changes:
        return
    places = _places(data, settings.all("entry").index(entries[-1]))
    for name in sorted(changes, key=lambda n: places[n], reverse=True):
        start, end = places[name]
        data = data[:start] + _text(new[name]) + data[end:]
    _write(real, data)


def _write(path: Path, data: bytes) -> None:
    mode = stat.S_IMODE(path.stat().st_mode)
    write(path, lambda file: file.write(data))
    os.chmod(path, mode)


def _text(value: float) -> bytes:
    return np.format_float_positional(np.float32(value), trim="-").encode()


def _with_entry(data: bytes, camera: Camera, v1: bool) -> bytes:
    """The file with an entry for a camera: first in its settings, which are made where there are none."""
    (start, end), (close, _) = _tags(data)
    newline = b"\r\n" if b"\r\n" in data else b"\n"
    at = close if start is None else start
    line = data[data.rfind(b"\n", 0, at) + 1 : at]
    indent = line if not line.strip() else b""
    step = b"\t" if b"\n\t" in data else b"  "
    numbers = b"".join(b"<%b>%b</%b>" % (n.encode(), _text(v), n.encode()) for n, v in _numbers(camera, v1).items())
    first_person = b"false" if isinstance(camera, ArcballCamera) else b"true"
    entry = b'<entry type="camera" fp="%b">%b</entry>' % (first_person, numbers)
    if start is None:
        made = [b"<settings>", indent + step * 2 + entry, indent + step + b"</settings>", indent]
        return data[:close] + step + newline.join(made) + data[close:]
    if data[:end].endswith(b"/>"):
        made = [data[start : end - 2].rstrip() + b">", indent + step + entry, indent + b"</settings>"]
        return data[:start] + newline.join(made) + data[end:]
    return data[:end] + newline + indent + step + entry + data[end:]


def _tags(data: bytes) -> tuple[tuple[int | None, int], tuple[int, int]]:
    """Where the first <settings> of a file begins and ends, and where the end tag of its root does."""
    parser = expat.ParserCreate()
    depth = 0
    settings: list[int] = []
    closes = [0]

    def at_event(*_) -> None:
        if len(settings) == 1 and parser.CurrentByteIndex > settings[0]:
            settings.append(parser.CurrentByteIndex)

    def start_element(name: str, _) -> None:
        nonlocal depth
        at_event()
        if depth == 1 and name == "settings" and not settings:
            settings.append(parser.CurrentByteIndex)
        depth += 1

    def end_element(_) -> None:
        nonlocal depth
        at_event()
        depth -= 1
        closes[0] = parser.CurrentByteIndex

    parser.StartElementHandler, parser.EndElementHandler, parser.DefaultHandler = start_element, end_element, at_event
    parser.Parse(data, True)
    return (settings[0], settings[1]) if settings else (None, 0), (closes[0], len(data))


def _numbers(camera: Camera, v1: bool) -> dict[str, float]:
    """What the entry's elements hold."""
    if isinstance(camera, ArcballCamera):
        angles = {"pitch": camera.pitch, "yaw": camera.yaw, "roll": camera.roll}
        return {"distance": camera.distance, **{(_V1_NAMES[n] if v1 else n): v for n, v in angles.items()}}
    position = dict(zip(("positionX", "positionY", "positionZ"), camera.position, strict=True))
    return position | {"pitch": camera.pitch, "yaw": camera.yaw}


def _places(data: bytes, index: int) -> dict[str, tuple[int, int]]:
    """Name of each child of an entry, by its index among those of the settings -> where its number begins and ends
    among the bytes, white space left out."""
    parser = expat.ParserCreate()
    found: dict[str, tuple[int, int]] = {}
    path: list[str] = []
    seen = {"settings": -1, "entry": -1}
    begun: list[int] = []

    def end_run(*_) -> None:
        if begun and path[1:3] == ["settings", "entry"] and len(path) == 4 and seen == {"settings": 0, "entry": index}:
            start, end = begun[0], parser.CurrentByteIndex
            text = data[start:end]
            if text.strip():
                start += len(text) - len(text.lstrip())
                found.setdefault(path[3], (start, start + len(text.strip())))
        begun.clear()

    def start_element(name: str, _) -> None:
        end_run()
        path.append(name)
        if len(path) == 2 and name == "settings":
            seen["settings"] += 1
        elif path[1:] == ["settings", "entry"]:
            seen["entry"] += 1

    def end_element(_) -> None:
        end_run()
        path.pop()

    parser.StartElementHandler, parser.EndElementHandler = start_element, end_element
    parser.CharacterDataHandler = lambda _: begun or begun.append(parser.CurrentByteIndex)
    parser.CommentHandler = parser.StartCdataSectionHandler = parser.EndCdataSectionHandler = end_run
    parser.ProcessingInstructionHandler = end_run
    parser.Parse(data, True)
    return found
