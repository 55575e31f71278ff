"""What the passes of a project can do without, and how its .sprj says so: maps that are constants, METALNESS, layouts.

What is not needed is found by the checks (``check.features``); a way to do without is known for shaders that keep to
the conventions: HAS_X_MAP switches a map on, without it there is a uniform ``x``, and METALNESS, defined as 0 or 1,
stands for map and uniform alike.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ..calling.call import shader
from ..check import compiled, flow
from ..check.features import ConstantMap, ConstantMetalness, NothingMirrored, UnreadTexture, takes_metalness, unneeded
from ..check.roles import METALNESS
from ..check.state import PassState
from ..ladder import Ladder
from ..native import Stage
from ..projects.project import VARIABLE_TYPES, Pass, Project, VertexBuffer
from ..projects.xml_lines import parse
from ..rendering.prepare import PreparedPass
from . import edit

_MAP = re.compile(r"HAS_(\w+)_MAP")
#: the macro of the term that decodes stored colours
_DECODE = "SRGB_DECODE"


@dataclass(frozen=True)
class Need:
    """Something that a pass can do without. ``text`` says what, and what is done about it by the ``edits``."""

    pass_name: str
    text: str
    edits: tuple[edit.Edit, ...]

    def apply(self, data: bytes) -> bytes:
        """The bytes of the project without it."""
        for change in self.edits:
            data = change(data)
        return data


def find(path: Path, data: bytes, ladder: Ladder | None, macros: Mapping[str, str]) -> list[Need]:
    """What the project in ``data``, which is at ``path``, can do without, but for its input layouts.

    ``macros`` are the rungs under which a stored colour is made a linear one.
    """
    state = compiled(path, parse(path, data=data))
    found = []
    for shader_pass, what in unneeded(state):
        name = shader_pass.name
        if isinstance(what, ConstantMap) and what.macro is not None:
            found.append(_constant_map(shader_pass, what, ladder, macros))
        elif isinstance(what, UnreadTexture):
            off = () if what.macro is None else (_off(shader_pass, what.macro.attributes["name"]),)
            if off or what.bound is shader_pass.bound[-1]:  # without a macro, those after it would go to other samplers
                text = f"{what.bound.name}: nothing reads it; not bound"
                found.append(Need(name, text, (*off, _unbind(shader_pass, what.bound))))
        elif isinstance(what, ConstantMetalness):
            variable = what.variable.attributes["name"]
            text = f"{variable} is {what.value} for all items: METALNESS = {what.value}"
            fixed = partial(edit.set_macro, pass_name=name, name="METALNESS", value=str(what.value))
            found.append(Need(name, text, (fixed, partial(edit.remove_variable, pass_name=name, name=variable))))
        elif isinstance(what, NothingMirrored):
            macro = what.macro.attributes["name"]
            found.append(Need(name, f"no texture is mirrored: no {macro}", (_off(shader_pass, macro),)))
    return [need for need in found if need is not None]


def _constant_map(
    shader_pass: PassState, what: ConstantMap, ladder: Ladder | None, macros: Mapping[str, str]
) -> Need | None:
    macro, name = what.macro.attributes["name"], shader_pass.name
    text = shader_pass.sources[Stage.FRAGMENT].text
    edits = [_off(shader_pass, macro), _unbind(shader_pass, what.bound)]
    if what.is_flat:
        return Need(name, f"{what.bound.name} is flat: no {macro}", tuple(edits))
    if what.metalness is not None and takes_metalness(text):
        edits.append(partial(edit.set_macro, pass_name=name, name="METALNESS", value=str(what.metalness)))
        said = f"{what.bound.name} is {what.metalness} everywhere: no {macro}, METALNESS = {what.metalness}"
        return Need(name, said, tuple(edits))
    uniform = _MAP.fullmatch(macro) and _MAP.fullmatch(macro)[1].lower()
    declared = re.search(rf"^ *uniform +(\w+) +{uniform} *;", text, re.MULTILINE) if uniform else None
    kind = {t.glsl: t for t in VARIABLE_TYPES.values() if t.base == "float" and t.rows == 1}.get(
        declared[1] if declared else ""
    )
    color = _linear(shader_pass, what, ladder, macros)
    if kind is None or color is None:
        return None  # of a normal map that is tilted, for one, no uniform takes the place
    values = [np.format_float_positional(v, trim="-") for v in color[: kind.size]]
    edits.append(partial(edit.set_variable, pass_name=name, name=uniform, kind=kind.name, values=values))
    said = f"{what.bound.name} is one colour: no {macro}, {uniform} = {' '.join(values)}"
    return Need(name, said, tuple(edits))


def _linear(
    shader_pass: PassState, what: ConstantMap, ladder: Ladder | None, macros: Mapping[str, str]
) -> np.ndarray | None:
    """What the shader makes of a map's colour: decoded where it decodes it, by the ladder's function."""
    color = np.array(what.value, np.float32) / np.float32(255)
    times = flow.decodes(shader_pass.preprocessed[Stage.FRAGMENT], what.sampler)
    if what.role == METALNESS or times == 0:
        return color
    term = next((t for t in ladder.terms if t.macro == _DECODE), None) if ladder else None
    if times != 1 or term is None:
        return None
    decode = shader(ladder.path.parent / term.file, defines=dict(macros), include_dirs=[ladder.path.parent])
    return np.array([*decode[term.function](color[:3]), color[3]], np.float32)


def _off(shader_pass: PassState, macro: str) -> edit.Edit:
    """Takes a macro away, or makes it 0 where it would be something else without the pass."""
    for source in shader_pass.sources.values():
        default = re.search(rf"^#ifndef +{macro}\b[^\n]*\n#define +{macro} +(\w+)", source.text, re.MULTILINE)
        if default and default[1] != "0":
            return partial(edit.set_macro, pass_name=shader_pass.name, name=macro, value="0")
    return partial(edit.remove_macro, pass_name=shader_pass.name, name=macro)


def _unbind(shader_pass: PassState, bound) -> edit.Edit:
    key = "path" if "path" in bound.element.attributes else "name"
    return partial(edit.unbind, pass_name=shader_pass.name, key=key, value=bound.element.attributes[key])


# ---- Input layouts ---------------------------------------------------------------------------------------------------


def find_layouts(project: Project, prepared: Sequence[PreparedPass], data: bytes) -> list[Need]:
    """Input layouts that end in what no vertex shader reads.

    A model has one layout in the whole project, so passes that share one keep what any of them reads.
    """
    drawn = [p for p in prepared if isinstance(p.shader_pass, Pass)]
    explicit = edit.layouts(data)
    read = {p.shader_pass.name: _locations(p) for p in drawn}
    while True:
        before = dict(read)
        for path in project.model_layouts:
            users = edit.users_of_model(data, path)
            longest = max((read.get(name, len(explicit.get(name, ()))) for name in users), default=0)
            alike = len({explicit.get(name) for name in users}) == 1
            for name in users:
                read[name] = longest if alike else len(explicit.get(name, ()))
        if before == read:
            break
    found = []
    for p in drawn:
        name, layout = p.shader_pass.name, explicit.get(p.shader_pass.name, ())
        if read[name] < len(layout) and not any(_counts_locations(i) for i in p.shader_pass.items):
            text = f"{', '.join(layout[read[name] :])} of the input layout: nothing reads it; taken out"
            found.append(Need(name, text, (partial(edit.trim_layout, pass_name=name, count=read[name]),)))
    return found


def _locations(prepared: PreparedPass) -> int:
    """How many attribute locations a pass reads, from the first to the last; one at least."""
    attributes = [a for a in prepared.program.attributes.values() if a.location >= 0]
    return max((a.location + 1 for a in attributes), default=1)


def _counts_locations(item) -> bool:
    """Whether the locations after the layout are those of a buffer."""
    return isinstance(item, VertexBuffer) or item.instance_buffer is not None
