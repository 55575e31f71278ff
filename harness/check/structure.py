"""Checks the .sprj by itself: names, targets, cameras, and what SHADERed crashes on or leaves out in silence."""

from __future__ import annotations

import os
import re

from ..errors import ProjectError
from ..projects.project import LAYOUT_VALUES, SHAPES
from ..projects.sprj_values import MACRO_NAME_LIMIT, MACRO_VALUE_LIMIT, NAME_LIMIT, PATH_LIMIT
from ..projects.xml_lines import Element
from . import renderer
from .state import DEFAULT_LAYOUT, DRAWN, Bound, PassState, State, child_text, flag, path_of

ENTRY_LIMIT = 31  # of an entry and of a semantic
_BUFFER_VALUES = {f"Buffer{base}{n}" for base in ("Float", "Int") for n in ("", 2, 3, 4)}
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?\s*", re.IGNORECASE)
_INTEGER = re.compile(r"\s*[+-]?\d+\s*")
_DRIVE = re.compile(r"[A-Za-z]:$")
_ARCBALL = ("distance", "pitch", "yaw", "roll")
_FIRST_PERSON = ("positionX", "positionY", "positionZ", "pitch", "yaw")
_NEAREST, _FARTHEST = 2.0, 50.0  # of an arcball camera
_FACES = ("left", "top", "front", "bottom", "right", "back")


def check_root(root: Element) -> ProjectError | None:
    """Why this is no project that SHADERed 1.5.6 reads, if so."""
    if root.name != "project":
        return root.error(f"<{root.name}> is not a SHADERed project: the first element must be <project>")
    version = root.attributes.get("version", "1")
    if version.strip() not in ("1", "2"):
        return root.error(f"version {version} of the project format is not supported, only versions 1 and 2 are")
    return None


def check(state: State) -> None:
    """Checks the elements, and fills ``state.passes`` with the passes that draw."""
    _check_names(state)
    pipeline = state.root.nested("pipeline", "pass")
    objects = {o.attributes.get("name", "") for o in state.objects}
    targets = {o.attributes.get("name") for o in state.objects if o.attributes.get("type") == "rendertexture"}
    bound = _read_objects(state, {e.attributes.get("name", "") for e in pipeline})
    for element in pipeline:
        name = element.attributes.get("name", "")
        items = _items(element)
        _check_layout(state, element, name)
        _check_limits(state, element)
        for target in element.all("rendertexture"):
            to = target.attributes.get("name", "")
            if to and to not in targets:
                what = "which is an object of another type" if to in objects else "which is not among the objects"
                state.add(
                    "HS003",
                    target,
                    f'pass "{name}" draws to the render texture "{to}", {what}',
                    f'add <object type="rendertexture" name="{to}" rsize="1,1" ... />, or correct the name',
                )
        if element.attributes.get("type", "shader") in ("audio", "plugin") or not flag(element, "active", True):
            continue
        if not items and element.attributes.get("type") != "compute":
            continue
        _check_items(state, element, name, items)
        values = tuple(i.attributes.get("value", "") for i in element.nested("inputlayout", "item"))
        state.passes.append(
            PassState(
                element,
                name,
                items,
                tuple(v if v in (*LAYOUT_VALUES, *_BUFFER_VALUES) else "" for v in values) or DEFAULT_LAYOUT,
                sorted(bound.get(name, ()), key=lambda b: b.slot),
            )
        )
    _check_camera(state)
    _check_include_paths(state)


def check_reader(state: State) -> None:
    """Adds what the reader of ``harness render`` says, where nothing was found in the line yet."""
    for is_warning, file, line, message in renderer.refusals(state.path):
        at = (os.path.relpath(file) if file and not os.path.relpath(file).startswith("..") else file, line)
        if state.has(at):
            continue
        if is_warning:
            state.add("HS007", at, message, "write what you mean, or remove it")
        elif not any(f.severity == "error" for f in state.findings):
            state.add("HS008", at, message, "leave it out if the project is to be rendered without SHADERed")


def _items(element: Element) -> list[Element]:
    found = element.child("items")
    return found.children if found else []


def _check_names(state: State) -> None:
    seen: dict[str, tuple[str, str, int]] = {}
    for element in state.root.nested("pipeline", "pass"):
        for part, what in [(element, "pass"), *((item, "item") for item in _items(element))]:
            name = part.attributes.get("name", "")
            if not name:
                state.add("HS006", part, f"a {what} without a name", "give it a name of its own")
                continue
            kind, other, line = seen.setdefault(name.lower(), (what, name, part.line))
            if line != part.line:
                state.add(
                    "HS002",
                    part,
                    f'the name "{name}" of this {what} is taken: by the {kind} "{other}" of line {line}; '
                    f"SHADERed drops this {what}",
                    "give it another name",
                )


def _check_limits(state: State, element: Element) -> None:
    """Texts that do not fit into SHADERed's buffers, which it does not check."""
    texts = [(element, element.attributes.get("name", ""), NAME_LIMIT, "the name of a pass")]
    for item in _items(element):
        texts.append((item, item.attributes.get("name", ""), NAME_LIMIT, "the name of an item"))
        texts.append((item, child_text(item, "filepath"), PATH_LIMIT, "a path"))
    for shader in element.all("shader"):
        texts.append((shader, shader.attributes.get("path", ""), PATH_LIMIT, "a path"))
        texts.append((shader, shader.attributes.get("entry", ""), ENTRY_LIMIT, "an entry"))
    for value in element.nested("inputlayout", "item"):
        texts.append((value, value.attributes.get("semantic", ""), ENTRY_LIMIT, "a semantic"))
    for variable in element.nested("variables", "variable"):
        texts.append((variable, variable.attributes.get("name", ""), NAME_LIMIT, "the name of a variable"))
    for define in element.nested("macros", "define"):
        texts.append((define, define.attributes.get("name", ""), MACRO_NAME_LIMIT, "the name of a macro"))
        texts.append((define, define.text, MACRO_VALUE_LIMIT, "the value of a macro"))
    for at, text, limit, what in texts:
        if len(text.encode()) > limit:
            state.add(
                "HS004",
                at,
                f'{what}, "{text[:40]}...", is longer than {limit} characters: it overwrites SHADERed\'s memory',
                f"keep it within {limit} characters",
            )


def _check_layout(state: State, element: Element, name: str) -> None:
    for item in element.nested("inputlayout", "item"):
        value = item.attributes.get("value", "")
        if value not in LAYOUT_VALUES and value not in _BUFFER_VALUES:
            hint = "Bitangent" if value == "Binormal" else ", ".join(LAYOUT_VALUES[:6])
            state.add(
                "HS005",
                item,
                f'pass "{name}": the input layout has no value "{value}"; SHADERed takes Position for it',
                f"write {hint}",
            )


def _check_items(state: State, element: Element, name: str, items: list[Element]) -> None:
    depth_write = True
    for item in items:
        kind = item.attributes.get("type", "")
        if kind == "renderstate":
            depth_write = child_text(item, "depthmask", "true").startswith(tuple("1tTyY"))
        elif kind == "geometry" and child_text(item, "type") not in SHAPES:
            state.add(
                "HS006",
                item,
                f'item "{item.attributes.get("name")}": there is no shape "{child_text(item, "type")}"',
                f"write one of {', '.join(SHAPES)}",
            )
        elif kind not in DRAWN:
            state.add(
                "HS006",
                item,
                f'item "{item.attributes.get("name")}": there is no type of item "{kind}"',
                "write geometry, model, vertexbuffer or renderstate",
            )
    if not depth_write:
        state.add(
            "HS010",
            [i for i in items if i.attributes.get("type") == "renderstate"][-1],
            f'pass "{name}" ends with <depthmask>false</depthmask>',
            "end the pass with another render state whose depthmask is true",
        )


def _read_objects(state: State, passes: set[str]) -> dict[str, list[Bound]]:
    """Pass -> what is bound to its samplers; checks the objects by themselves."""
    bound: dict[str, list[Bound]] = {}
    seen: dict[str, int] = {}
    for element in state.objects:
        kind = element.attributes.get("type", "")
        is_file = kind == "texture" and not flag(element, "cube") and not flag(element, "keyboard_texture")
        path = path_of(element.attributes.get("path", "")) if is_file else None
        name = path if path is not None else element.attributes.get("name", "")
        if kind in ("texture", "rendertexture", "image", "image3d", "buffer") and name in seen:
            state.add(
                "HS307",
                element,
                f'"{name}" has an object already, in line {seen[name]}',
                "give that object all the binds and remove this one",
            )
        seen.setdefault(name, element.line)
        if kind == "rendertexture" and not (element.attributes.get("rsize") or element.attributes.get("fsize")):
            state.add(
                "HS004",
                element,
                f'the render texture "{name}" has neither rsize nor fsize',
                'add rsize="1,1" for the size of the window',
            )
        if len((path or "").encode()) > PATH_LIMIT:
            state.add(
                "HS004", element, f'the path "{path[:40]}..." is longer than {PATH_LIMIT} characters', "shorten it"
            )
        for bind in element.all("bind"):
            to = bind.attributes.get("name", "")
            if to not in passes:
                state.add("HS006", bind, f'"{name}" is bound to pass "{to}", which there is not', "correct the name")
            elif kind in ("texture", "rendertexture") or (kind in ("image", "image3d") and not flag(bind, "uav", True)):
                _bind(state, bound.setdefault(to, []), Bound(element, bind, _slot(bind), name, path))
    return bound


def _slot(bind: Element) -> int:
    text = bind.attributes.get("slot", "0")
    return int(text) if _INTEGER.fullmatch(text) else 0


def _bind(state: State, there: list[Bound], new: Bound) -> None:
    to = new.bind.attributes["name"]
    for other in there:
        if other.slot == new.slot:
            state.add(
                "HS307",
                new.bind,
                f'slot {new.slot} of pass "{to}" has "{other.name}" already, which SHADERed then leaves out',
                "give each texture of a pass a slot of its own",
            )
            there.remove(other)
            break
        if other.name == new.name:
            state.add("HS307", new.bind, f'"{new.name}" is bound to pass "{to}" twice', "bind it once")
            return
    there.append(new)


def faces(element: Element) -> list[str]:
    """The paths of a cube map's files."""
    return [path_of(element.attributes.get(face, "")) for face in _FACES]


def _check_camera(state: State) -> None:
    entries = [e for e in state.root.nested("settings", "entry") if e.attributes.get("type") == "camera"]
    for entry in entries:
        needed = _FIRST_PERSON if flag(entry, "fp") else _ARCBALL
        missing = [tag for tag in needed if entry.child(tag) is None]
        if missing:
            state.add(
                "HS004", entry, f"the camera has no <{'>, <'.join(missing)}>", "give the camera all of its elements"
            )
            continue
        distance = child_text(entry, "distance", "4")
        if not flag(entry, "fp") and _NUMBER.fullmatch(distance) and not _NEAREST <= float(distance) <= _FARTHEST:
            state.add(
                "HS011",
                entry,
                f"the camera's distance is {distance.strip()}, which SHADERed brings into {_NEAREST:g} to "
                f"{_FARTHEST:g}",
                f"write a distance from {_NEAREST:g} to {_FARTHEST:g}, and scale the scene",
            )
    if not entries:
        at = state.root.child("settings") or state.root
        state.add(
            "HS011",
            at,
            "the project has no camera: SHADERed keeps the one of its start-up project",
            'add <entry type="camera" fp="false"> with distance, pitch, yaw and roll to the settings',
            "note",
        )


def _check_include_paths(state: State) -> None:
    for entry in state.root.nested("settings", "entry"):
        for path in entry.all("path") if entry.attributes.get("type") == "ipaths" else ():
            if path.text.startswith("/"):
                state.add(
                    "HS009", path, f'the include path "{path.text}" is absolute', "write it from the project's folder"
                )
            elif not (state.folder / path.text).is_dir():
                state.add("HS006", path, f'there is no folder "{path.text}" to include from', "correct or remove it")
            else:
                check_path(state, path, path.text)


def check_path(state: State, at: Element, text: str) -> None:
    """Warns of a path that leads out of the project's folder. One leading slash does not, in SHADERed."""
    depth = 0
    for part in path_of(text).split("/"):
        depth += {"..": -1, ".": 0, "": 0}.get(part, 1)
        if depth < 0 or _DRIVE.match(part):
            state.add(
                "HS009", at, f'the path "{text}" leads out of the project\'s folder', "copy the file into the project"
            )
            return


def read_number(text: str) -> float | None:
    """A number as the .sprj means it, None where SHADERed does not read all of the text."""
    return float(text) if _NUMBER.fullmatch(text) else None
