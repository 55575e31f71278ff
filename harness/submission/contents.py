"""The files of a project: all that its .sprj names, what these include or name in turn, and nothing else.

Read from the XML, not through ``harness.projects.sprj``, which leaves out what is not drawn: SHADERed opens that too.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from pathlib import Path

from ..errors import ProjectError
from ..language.glsl import shown_path
from ..language.glsl_syntax import without_comments
from ..projects import sprj_v1
from ..projects.sprj_objects import FACES
from ..projects.xml_lines import Element, parse

# Any form that either compiler may take; a name that is found nowhere is no file.
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include\b[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
_OF_A_MATERIAL_LIBRARY = re.compile(r"^\s*mtllib\s+(.+?)\s*$", re.MULTILINE)
_ABSOLUTE = re.compile(r"[/\\]|[A-Za-z]:")
# Where people's files lie on the systems that SHADERed runs on.
_OF_A_MACHINE = re.compile(rb"(?<![\w./-])(?:/(?:home|Users|root|tmp)/|[A-Za-z]:[\\/]Users[\\/])[^\s\"'<>]*")


def files(project: str | os.PathLike) -> dict[str, bytes]:
    """The content of each file, by its path from the project's folder with slashes, sorted.

    ProjectError, with file and line, for a path that is absolute or leads out of the folder, and for an absolute path
    of somebody's machine in what a file says.
    """
    return _Collection(Path(project)).read()


class _Collection:
    def __init__(self, project: Path):
        self._project, self._folder = project, project.parent
        self._found: dict[str, Path] = {}

    def read(self) -> dict[str, bytes]:
        root = parse(self._project)
        if root.get("version", "1") == "1":
            sprj_v1.modernize(root)
        self._add(self._project)
        entries = [e for e in root.nested("settings", "entry") if e.get("type") == "ipaths"]
        folders = [self._folder / self._relative(p, p.text) for e in entries[-1:] for p in e.all("path") if p.text]
        for element, text in _named(root):
            path = self._folder / self._relative(element, text)
            if path.is_file():
                self._add(path, element)
                if element.name == "shader":
                    self._add_includes(path, [*folders, self._folder])
                else:
                    self._add_parts(path)
        content = {name: self._found[name].read_bytes() for name in sorted(self._found)}
        for name, data in content.items():
            _check_content(self._found[name], name, data, self._folder)
        return content

    def _relative(self, at: Element, text: str) -> str:
        if _ABSOLUTE.match(text):
            raise at.error(
                f'"{text}" is an absolute path, which no other machine has: write it from the .sprj\'s folder'
            )
        return text.replace("\\", "/")

    def _add(self, path: Path, at: Element | None = None) -> bool:
        """Whether it is new."""
        name = os.path.relpath(path, self._folder).replace(os.sep, "/")
        real = os.path.relpath(os.path.realpath(path), os.path.realpath(self._folder))
        if name.startswith("../") or real.startswith(".." + os.sep):
            message = f'"{name}" lies outside the project\'s folder and cannot be handed in: move it there'
            raise at.error(message) if at else ProjectError(message, shown_path(path))
        is_new = name not in self._found
        self._found[name] = path
        return is_new

    def _add_includes(self, path: Path, folders: list[Path]) -> None:
        text = without_comments(path.read_bytes().decode("utf-8-sig", errors="replace").replace("\r\n", "\n"))
        for match in _INCLUDE.finditer(text):
            name = match[1] or match[2]
            target = next((f / name for f in [*folders, path.parent] if os.path.isfile(f / name)), None)
            if target and self._add(target):
                self._add_includes(target, folders)

    def _add_parts(self, path: Path) -> None:
        """The files that a model in a text format consists of."""
        try:
            if path.suffix.lower() == ".gltf":
                parts = json.loads(path.read_bytes())
                names = [p.get("uri", "data:") for kind in ("buffers", "images") for p in parts.get(kind, [])]
            elif path.suffix.lower() == ".obj":
                names = _OF_A_MATERIAL_LIBRARY.findall(path.read_bytes().decode("utf-8", errors="replace"))
            else:
                return
        except (ValueError, AttributeError, TypeError):
            return  # no glTF: Assimp says what it makes of it
        for name in names:
            if not name.startswith("data:") and os.path.isfile(path.parent / name):
                self._add(path.parent / name)


def _named(root: Element) -> Iterator[tuple[Element, str]]:
    """Each file that the .sprj names, with the element that does."""
    for shader_pass in root.nested("pipeline", "pass"):
        for shader in shader_pass.all("shader"):
            yield shader, shader.get("path")
        for item in shader_pass.nested("items", "item"):
            for path in item.all("filepath"):
                yield path, path.text
    for made in root.nested("objects", "object"):
        if made.get("type") == "buffer":
            yield made, f"buffers/{made.get('name')}.buf"
        for attribute in ("path", *FACES):
            if made.get(attribute):
                yield made, made.get(attribute)


def _check_content(path: Path, name: str, data: bytes, folder: Path) -> None:
    """Refuses a path of this machine, or of another, in a file."""
    match = _OF_A_MACHINE.search(data)
    place = match.start() if match else data.find(os.fsencode(os.path.realpath(folder)) + b"/")
    if place >= 0:
        line = data.count(b"\n", 0, place) + 1
        what = match[0].decode(errors="replace") if match else os.path.realpath(folder)
        raise ProjectError(f"{name} holds the absolute path {what}: take it out", shown_path(path), line)
