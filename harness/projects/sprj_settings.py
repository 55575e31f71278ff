"""Reads the ``<settings>`` and the camera snapshots of a .sprj."""

from __future__ import annotations

from .project import ArcballCamera, FirstPersonCamera, Settings
from .sprj_values import flag, integer, real, strict_real
from .xml_lines import Element

#: the camera of SHADERed's start-up project, left in place by a project without a camera entry
DEFAULT_CAMERA = ArcballCamera(distance=4.0, pitch=28.0, yaw=317.0, roll=0.0)

#: entries that keep the editor's windows as they were
_OF_THE_EDITOR = ("property", "file", "pinned", "watch_expr", "vecwatch_expr", "bkpt")


def read_settings(entries: list[Element], *, v1: bool = False) -> Settings:
    """The settings; of several entries of a kind the last holds, as in SHADERed."""
    camera, color, use_alpha, include_paths = DEFAULT_CAMERA, {}, False, ()
    for entry in entries:
        kind = entry.get("type")
        if kind == "camera":
            camera = _camera(entry, v1)
        elif kind == "clearcolor":
            color |= {c: _component(entry, c, v1) for c in "rgba" if c in entry.attributes}
        elif kind == "usealpha" and not v1:
            use_alpha = flag(entry, "val", False)
        elif kind == "ipaths" and not v1:
            include_paths = tuple(path.text for path in entry.all("path"))
            for path in entry.all("path"):
                if "\\" in path.text:
                    path.warn(f'the include path "{path.text}": backslashes do not work here')
        elif kind not in _OF_THE_EDITOR:
            entry.warn(f'the setting "{kind}" is none; SHADERed leaves it out')
    clear_color = tuple(color.get(c, 0.0) for c in "rgba")
    return Settings(camera, clear_color, use_alpha, include_paths)


def _component(entry: Element, name: str, v1: bool) -> float:
    what = f"{name} of the clear colour"
    if v1:
        return integer(entry, entry.attributes[name], what, unsigned=True) / 255
    return real(entry, entry.attributes[name], what)


def _camera(entry: Element, v1: bool) -> ArcballCamera | FirstPersonCamera:
    def number(name: str) -> float:
        found = entry.child(name)
        if found is None:
            raise entry.error(f"the camera has no <{name}>, without which SHADERed crashes")
        return strict_real(found, found.text, f"<{name}> of the camera")

    if flag(entry, "fp", False):
        position = number("positionX"), number("positionY"), number("positionZ")
        return FirstPersonCamera(position, number("pitch"), number("yaw"), entry.line)
    yaw, pitch, roll = ("rotationX", "rotationY", "rotationZ") if v1 else ("yaw", "pitch", "roll")
    return ArcballCamera(number("distance"), number(pitch), number(yaw), number(roll), entry.line)


def read_cameras(elements: list[Element]) -> dict[str, tuple[float, ...]]:
    """The camera snapshots: name -> matrix, column by column. Here the rows of the file are rows of the matrix."""
    cameras: dict[str, tuple[float, ...]] = {}
    for element in elements:
        name = element.get("name")
        matrix = [float(i % 5 == 0) for i in range(16)]
        for r, row in enumerate(element.all("row")):
            for k, value in enumerate(row.all("value")):
                if r > 3:
                    raise value.error(f'the camera "{name}" has more than 4 rows')
                matrix[(k % 4) * 4 + r] = real(value, value.text, f'a value of the camera "{name}"')
        if name in cameras:
            element.warn(f'there is a camera "{name}" already, and SHADERed takes the first')
        cameras.setdefault(name, tuple(matrix))
    return cameras
