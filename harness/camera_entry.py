"""Writes a camera into a .sprj: its numbers alone change, and every other byte of the file stays."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from xml.parsers import expat

import numpy as np

from .camera import Camera
from .errors import ProjectError
from .picture import write
from .project import ArcballCamera
from .sprj_settings import read_settings
from .xml_lines import parse

_V1_NAMES = {"yaw": "rotationX", "pitch": "rotationY", "roll": "rotationZ"}


def write_camera(path: str | os.PathLike, camera: Camera) -> None:
    """Writes the numbers that differ, in the shortest form that is the same single-precision number.

    The camera must be of the kind that the file's entry has. ProjectError where it is not, or there is no entry.
    """
    root = parse(path)
    settings = root.child("settings")
    entries = [e for e in settings.all("entry") if e.get("type") == "camera"] if settings else []
    if not entries:
        raise ProjectError('there is no <entry type="camera"> to write the camera to; save the project once', path)
    v1 = root.get("version", "1") == "1"
    there = read_settings(entries[-1:], v1=v1).camera
    if type(there) is not type(camera):
        raise entries[-1].error("the camera of the file is of another kind than the one that is shown")
    new = _numbers(camera, v1)
    changes = {name: value for name, value in _numbers(there, v1).items() if np.float32(value) != np.float32(new[name])}
    if not changes:
        return
    # By name: the renaming must not turn a link into a file.
    real = Path(path).resolve()
    data = real.read_bytes()
    places = _places(data, settings.all("entry").index(entries[-1]))
    for name in sorted(changes, key=lambda n: places[n], reverse=True):
        start, end = places[name]
        text = np.format_float_positional(np.float32(new[name]), trim="-")
        data = data[:start] + text.encode() + data[end:]
    mode = stat.S_IMODE(real.stat().st_mode)
    write(real, lambda file: file.write(data))
    os.chmod(real, mode)


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
