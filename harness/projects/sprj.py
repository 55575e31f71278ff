"""Reads a SHADERed project (.sprj, version 2 or 1) into the plain data of project.py.

What does not show in the picture is left out: inactive passes, passes without items, objects that no drawn
pass is given, and, as SHADERed does, elements it does not know. What would show but is not supported is refused.
What SHADERed passes over in silence is a warning.
"""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import ProjectError
from . import sprj_v1
from .project import (
    Buffer,
    ComputePass,
    CubeMap,
    Image,
    KeyboardTexture,
    Pass,
    Project,
    RenderTexture,
    TextureObject,
)
from .sprj_items import read_place
from .sprj_objects import PassNames, names_of_render_textures, read_objects, warn_of_binds
from .sprj_passes import items_of, read_compute_pass, read_layout, read_pass
from .sprj_settings import read_cameras, read_settings
from .sprj_values import NAME_LIMIT, child_text, flag, integer, limited
from .traps import Traps
from .xml_lines import Element, parse

VERSIONS = (1, 2)
#: far beyond any project
MOST_ITEMS = 100_000
#: of an item, which ObjectProperty gives
PROPERTIES = ("Position", "Rotation", "Scale")


def read(path: str | os.PathLike, traps: Traps | None = None, data: bytes | None = None) -> Project:
    """The project in a file, or in ``data`` as if that were in the file. ``traps`` receives the warnings.

    ProjectError, with file and line, for what is wrong in it or not supported; with ``traps.keep_going`` only for
    what leaves nothing to draw.
    """
    traps = Traps() if traps is None else traps
    root = parse(path, traps, data)
    if root.name != "project":
        raise root.error(f"<{root.name}> is not a SHADERed project: the first element must be <project>")
    version = integer(root, root.get("version", "1"), "the version")
    if version not in VERSIONS:
        raise root.error(f"version {version} of the project format is not supported, only versions 1 and 2 are")
    v1 = version == 1
    if v1:
        sprj_v1.modernize(root)
    for plugin in root.nested("plugins", "entry"):
        traps.survive(plugin.error(f'the plugin "{plugin.get("name")}" is not supported'))
    elements = root.nested("pipeline", "pass")
    kept = _with_names_of_their_own(elements)
    objects = root.nested("objects", "object")
    drawn = {e: items for e, items in kept.items() if _draws(e, items)}
    passes = _read_passes(drawn, names_of_render_textures(objects))
    used = read_objects(
        objects,
        PassNames(
            {p.name for p in passes},
            {p.name for p in passes if isinstance(p, ComputePass)},
            {e.get("name") for e in kept},
        ),
        _names_of_objects(passes),
        v1=v1,
    )
    # With a render texture that cannot be, which was said, go the passes that draw to it.
    made = {None, *(o.name for o in used if isinstance(o, RenderTexture))}
    passes = [p for p in passes if isinstance(p, ComputePass) or made.issuperset(p.targets)]
    warn_of_binds(used, root)
    cameras = read_cameras(root.nested("cameras", "camera"))
    project = Project(
        file=Path(path),
        passes=tuple(passes),
        textures=tuple(o for o in used if isinstance(o, TextureObject | CubeMap | KeyboardTexture)),
        settings=read_settings(root.nested("settings", "entry"), v1=v1),
        render_textures=tuple(o for o in used if isinstance(o, RenderTexture)),
        images=tuple(o for o in used if isinstance(o, Image)),
        buffers=tuple(o for o in used if isinstance(o, Buffer)),
        places={
            i.get("name"): read_place(i) for items in kept.values() for i in items if i.get("type") != "renderstate"
        },
        cameras=cameras,
        model_layouts=_model_layouts(kept),
    )
    _warn_of_names(project, traps)
    return project


def _name(at: Element, what: str) -> str:
    name = limited(at, at.get("name"), NAME_LIMIT, f"the name of the {what}")
    if not name:
        raise at.error(f"a {what} without a name")
    return name


def _with_names_of_their_own(elements: list[Element]) -> dict[Element, list[Element]]:
    """The passes and their items that SHADERed keeps: of two with names that differ at most in case it drops the
    second. The items of a pass that is dropped go to the one of exactly that name."""
    seen: dict[str, tuple[str, int]] = {}
    kept: dict[Element, list[Element]] = {}

    def is_new(element: Element, what: str) -> bool:
        name = _name(element, what)
        other, line = seen.setdefault(name.lower(), (name, element.line))
        if line == element.line and other == name:
            return True
        element.warn(
            f'the name "{name}" is taken: "{other}" of line {line}; case does not count, and SHADERed drops this {what}'
        )
        return False

    count = 0
    for element in elements:
        if is_new(element, "pass"):
            kept[element] = []
        owner = next((e for e in kept if e.get("name") == element.get("name")), None)
        for item in items_of(element):
            count += 1
            if count > MOST_ITEMS:
                raise item.error(f"more than {MOST_ITEMS} items")
            if is_new(item, "item") and owner is not None:
                kept[owner].append(item)
    return kept


def _draws(element: Element, items: list[Element]) -> bool:
    kind = element.get("type", "shader")
    if kind in ("audio", "plugin"):
        element.traps.survive(element.error(f'pass "{element.get("name")}": passes of type "{kind}" are not supported'))
        return False
    if kind not in ("shader", "compute"):
        element.warn(
            f'pass "{element.get("name")}": there is no type "{kind}", and SHADERed takes it for a shader pass'
        )
    return flag(element, "active", True) and (bool(items) or kind == "compute")


def _read_passes(drawn: dict[Element, list[Element]], targets: set[str]) -> list[Pass | ComputePass]:
    passes: list[Pass | ComputePass] = []
    for element, items in drawn.items():
        try:
            is_compute = element.get("type") == "compute"
            passes.append(read_compute_pass(element) if is_compute else read_pass(element, targets, items))
        except ProjectError as error:
            element.traps.survive(error)
    return passes


def _names_of_objects(passes: list[Pass | ComputePass]) -> set[str]:
    """Objects that passes use without a bind: targets, and the buffers of items."""
    names: set[str] = set()
    for p in passes:
        if isinstance(p, Pass):
            names |= {t for t in p.targets if t}
            for item in p.items:
                names |= {n for n in (item.instance_buffer, getattr(item, "buffer", None)) if n}
    return names


def _model_layouts(kept: dict[Element, list[Element]]) -> dict[str, tuple[tuple[str, ...], str | None]]:
    """The input layout and the instance buffer of each model file: SHADERed gives a file those of the last item."""
    layouts: dict[str, tuple[tuple[str, ...], str | None]] = {}
    first: dict[str, tuple[tuple[str, ...], str, int]] = {}
    for element, items in kept.items():
        for item in items:
            path = child_text(item, "filepath") if item.get("type") == "model" else None
            if path is None:
                continue
            name = path.text.replace("\\", "/")
            layout = read_layout(element, element.get("name"))
            buffer = child_text(item, "instancebuffer")
            other, owner, line = first.setdefault(name, (layout, element.get("name"), element.line))
            if other != layout:
                path.warn(
                    f'the model "{name}" has one input layout in SHADERed, that of the last pass: those of '
                    f'"{owner}" (line {line}) and "{element.get("name")}" (line {element.line}) differ'
                )
            layouts[name] = layout, buffer.text if buffer is not None else None
    return layouts


def _warn_of_names(project: Project, traps: Traps) -> None:
    """Functions that take names, and names that there are not."""
    earlier: set[str] = set()
    for p in project.passes:
        earlier |= {v.name for v in p.variables}
        for variable in p.variables:
            missing = None
            if variable.function == "Pointer" and variable.arguments[0] not in earlier:
                missing = f'no variable "{variable.arguments[0]}" before the end of its pass, and it stays 0'
            elif variable.function == "CameraSnapshot" and variable.arguments[0] not in project.cameras:
                missing = f'no camera "{variable.arguments[0]}", and SHADERed takes the identity'
            elif variable.function == "ObjectProperty" and variable.arguments[0] not in project.places:
                missing = f'no item "{variable.arguments[0]}", and it stays 0'
            elif variable.function == "ObjectProperty" and variable.arguments[1] not in PROPERTIES:
                missing = f'no property "{variable.arguments[1]}" of an item, and it is 0'
            if missing:
                what = f'variable "{variable.name}" of pass "{p.name}"'
                traps.warn(f"{what}: there is {missing}", str(project.file), variable.line)
