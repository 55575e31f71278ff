"""Reads a SHADERed project (.sprj, version 2) into the plain data of project.py.

What does not show in the picture is left out: inactive passes, passes without items, objects that no drawn
pass binds, and, as SHADERed does, elements it does not know. What would show but is not supported is refused.
"""

from __future__ import annotations

import os
from pathlib import Path

from .project import Project
from .sprj_objects import read_settings, read_textures
from .sprj_passes import DEFAULT_LAYOUT, items_of, read_pass
from .sprj_values import NAME_LIMIT, flag, integer, limited
from .xml_lines import Element, parse

VERSION = 2


def read(path: str | os.PathLike) -> Project:
    """The project in a file. ProjectError, with file and line, for what is wrong in it or not supported."""
    root = parse(path)
    if root.name != "project":
        raise root.error(f"<{root.name}> is not a SHADERed project: the first element must be <project>")
    version = integer(root, root.attributes.get("version", "1"), "the version")
    if version != VERSION:
        raise root.error(f"version {version} of the project format is not supported, only version {VERSION}")
    plugins = root.nested("plugins", "entry")
    if plugins:
        raise plugins[0].error(f'the plugin "{plugins[0].attributes.get("name", "")}" is not supported')
    _refuse_equal_names(root)
    _refuse_two_layouts(root)
    drawn = [element for element in root.nested("pipeline", "pass") if _draws(element)]
    objects = root.nested("objects", "object")
    targets = {o.attributes.get("name", "") for o in objects if o.attributes.get("type") == "rendertexture"}
    passes = tuple(read_pass(element, targets) for element in drawn)
    return Project(
        file=Path(path),
        passes=passes,
        textures=read_textures(objects, {p.name for p in passes}),
        settings=read_settings(root.nested("settings", "entry")),
    )


def _name(at: Element, what: str) -> str:
    name = limited(at, at.attributes.get("name", ""), NAME_LIMIT, f"the name of the {what}")
    if not name:
        raise at.error(f"a {what} without a name")
    return name


def _refuse_equal_names(root: Element) -> None:
    """Names of passes and items must differ in more than case: SHADERed drops the second of two."""
    seen: dict[str, tuple[str, int]] = {}
    for element in root.nested("pipeline", "pass"):
        for part, what in [(element, "pass"), *((item, "item") for item in items_of(element))]:
            name = _name(part, what)
            if name.lower() in seen:
                other, line = seen[name.lower()]
                raise part.error(f'the name "{name}" is taken: "{other}" of line {line}; case does not count')
            seen[name.lower()] = name, part.line


def _refuse_two_layouts(root: Element) -> None:
    """A model file has one input layout, also across passes: SHADERed gives it that of the last pass."""
    seen: dict[str, tuple[tuple[str, ...], Element]] = {}
    for element in root.nested("pipeline", "pass"):
        listed = tuple(i.attributes.get("value", "") for i in element.nested("inputlayout", "item"))
        layout = listed or DEFAULT_LAYOUT
        for item in items_of(element):
            path = item.child("filepath") if item.attributes.get("type") == "model" else None
            if path is None:
                continue
            other, first = seen.setdefault(path.text.replace("\\", "/"), (layout, element))
            if other != layout:
                raise path.error(
                    f'two input layouts for the model "{path.text}" are not supported: passes '
                    f'"{first.attributes["name"]}" (line {first.line}) and "{element.attributes["name"]}" '
                    "differ, and SHADERed would use that of the last for both"
                )


def _draws(element: Element) -> bool:
    kind = element.attributes.get("type", "shader")
    if kind in ("compute", "audio", "plugin"):
        raise element.error(f'pass "{element.attributes["name"]}": passes of type "{kind}" are not supported')
    return flag(element, "active", True) and bool(items_of(element))
