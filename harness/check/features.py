"""Checks for what a pass compiles or samples although nothing needs it: constant maps, unread textures, macros.

``unneeded`` says what there is, as data; ``check`` makes findings of it, and ``harness tune`` takes it away.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..native import Stage
from ..projects.xml_lines import Element
from . import models, roles, samplers, textures
from .state import DRAWN, Bound, PassState, State, child_text, path_of

_FLAT = 1  # bytes that a map may differ by and still be called the same everywhere
_METALNESS = "METALNESS"
#: the byte that stands for 0 in a normal map
_NORMAL_ZERO = 128


@dataclass(frozen=True)
class ConstantMap:
    """A texture that is the same everywhere. ``value`` is its colour, 0...255; ``macro`` is what switches the map on,
    where there is such a macro; ``sampler`` is the uniform that reads it."""

    bound: Bound
    sampler: str
    role: str | None
    value: tuple[int, ...]
    macro: Element | None

    @property
    def metalness(self) -> int | None:
        """0 or 1, where it is a metalness map that says one of these."""
        if self.role != roles.METALNESS or _FLAT < self.value[0] < 255 - _FLAT:
            return None
        return int(self.value[0] > _FLAT)

    @property
    def is_flat(self) -> bool:
        """Whether it is a normal map that bends nothing."""
        return self.role == roles.NORMAL and all(abs(v - _NORMAL_ZERO) <= _FLAT for v in self.value[:2])


@dataclass(frozen=True)
class UnreadTexture:
    """A texture whose sampler the shader does not use; ``macro`` is what switches the map on, if anything does."""

    bound: Bound
    sampler: str
    macro: Element | None


@dataclass(frozen=True)
class ConstantMetalness:
    """A metalness variable that is ``value``, 0 or 1, for all items, in a pass that could have METALNESS fixed."""

    variable: Element
    value: int


@dataclass(frozen=True)
class NothingMirrored:
    """A macro for mirrored texture coordinates where no model has any."""

    macro: Element


Unneeded = ConstantMap | UnreadTexture | ConstantMetalness | NothingMirrored


def unneeded(state: State) -> Iterator[tuple[PassState, Unneeded]]:
    """What the passes that compile do not need."""
    for shader_pass in state.passes:
        if shader_pass.program is None or Stage.FRAGMENT not in shader_pass.preprocessed:
            continue
        for bound, sampler in samplers.given(shader_pass):
            found = _of_texture(state, shader_pass, bound, sampler)
            if found is not None:
                yield shader_pass, found
        yield from ((shader_pass, found) for found in _of_metalness(shader_pass))
        yield from ((shader_pass, found) for found in _of_mirrored(state, shader_pass))


def check(state: State) -> None:
    """Checks the passes that compile."""
    for shader_pass, found in unneeded(state):
        _REPORTS[type(found)](state, shader_pass, found)


# ---- What is not needed ----------------------------------------------------------------------------------------------


def _is_on(define: Element) -> bool:
    return define.text.strip() not in ("", "0", "false")


def _macro(shader_pass: PassState, role: str | None) -> Element | None:
    """The pass's macro that switches the map of a role on, as HAS_NORMAL_MAP does."""
    return next(
        (
            d
            for d in shader_pass.macros
            if _is_on(d)
            and re.search(r"MAP|TEX", d.attributes.get("name", ""))
            and role is not None
            and roles.of_name(d.attributes["name"].lower()) == role
        ),
        None,
    )


def is_constant(image: np.ndarray) -> bool:
    """Whether all pixels (h, w, channels) are the same but for the last bit."""
    for step in (16, 1):  # most pictures are told by a few pixels
        some = image[::step, ::step]
        if (some.max(axis=(0, 1)).astype(int) - some.min(axis=(0, 1)) > _FLAT).any():
            return False
    return True


def takes_metalness(text: str) -> bool:
    """Whether METALNESS can be fixed in a shader's text."""
    asked = rf"^\s*#.*\bdefined\s*\(?\s*{_METALNESS}\b|^\s*#\s*ifn?def\s+{_METALNESS}\b"
    return re.search(asked, text, re.MULTILINE) is not None


def _of_texture(state: State, shader_pass: PassState, bound: Bound, sampler: str) -> Unneeded | None:
    role = (roles.of_file(bound.path) if bound.path else None) or samplers.wanted_role(shader_pass, sampler)
    if sampler not in shader_pass.program.uniforms:
        return UnreadTexture(bound, sampler, _macro(shader_pass, role))
    image = textures.readable(state, bound)
    if image is None or not is_constant(image):
        return None
    value = np.median(image.reshape(-1, image.shape[-1]), axis=0)
    return ConstantMap(bound, sampler, role, tuple(int(v) for v in value), _macro(shader_pass, role))


def _of_metalness(shader_pass: PassState) -> Iterator[ConstantMetalness]:
    if not takes_metalness(shader_pass.sources[Stage.FRAGMENT].text):
        return
    if any(d.attributes.get("name") == _METALNESS for d in shader_pass.macros):
        return
    for variable in shader_pass.variables:
        name = variable.attributes.get("name", "")
        if roles.of_name(name) != roles.METALNESS or name not in shader_pass.program.uniforms:
            continue
        if "system" in variable.attributes or "function" in variable.attributes:
            continue
        values = _values_of_items(shader_pass, variable)
        if values and all(len(v) == 1 and re.fullmatch(r"[01](\.0*)?", v[0]) for v in values):
            if len({v[0][0] for v in values}) == 1:
                yield ConstantMetalness(variable, int(values[0][0][0]))


def _values_of_items(shader_pass: PassState, variable: Element) -> list[list[str]]:
    """What a variable is for each of the items that are drawn."""
    name = variable.attributes.get("name", "")
    own = {
        v.attributes.get("for"): v
        for v in shader_pass.element.nested("itemvalues", "value")
        if v.attributes.get("variable") == name
    }
    drawn = (item for item in shader_pass.items if item.attributes.get("type") in DRAWN)
    holders = [own.get(item.attributes.get("name"), variable) for item in drawn]
    return [[v.text.strip() for row in holder.all("row") for v in row.all("value")] for holder in holders]


def _of_mirrored(state: State, shader_pass: PassState) -> Iterator[NothingMirrored]:
    macro = next((d for d in shader_pass.macros if "MIRROR" in d.attributes.get("name", "") and _is_on(d)), None)
    if macro is None or shader_pass.kinds() != {"model"}:
        return
    for item in shader_pass.items:
        if item.attributes.get("type") != "model":
            continue
        data = models.readable(state.file(path_of(child_text(item, "filepath"))))
        if data is None or (models.handedness(data) < 0).any():
            return
    yield NothingMirrored(macro)


# ---- Findings about it -----------------------------------------------------------------------------------------------


def _report_constant(state: State, shader_pass: PassState, found: ConstantMap) -> None:
    macro, value = found.macro, found.value
    at = macro if macro is not None else found.bound.bind
    how = f"remove the macro {macro.attributes['name']}" if macro is not None else "use a uniform instead"
    if found.metalness is not None:
        state.add(
            "HS602",
            at,
            f'the metalness map "{found.bound.path}" of pass "{shader_pass.name}" is {found.metalness} everywhere',
            f"{how}, and fix METALNESS to {found.metalness}",
        )
    else:
        what = "flat" if found.is_flat else f"{'/'.join(map(str, value[:3]))} of 255 everywhere"
        of_what = f'the {found.role or "texture"} map "{found.bound.path}" of pass "{shader_pass.name}"'
        state.add("HS601", at, f"{of_what} is {what}", how)


def _report_unread(state: State, shader_pass: PassState, found: UnreadTexture) -> None:
    state.add(
        "HS603",
        found.bound.bind,
        f'"{found.bound.name}" goes to the sampler "{found.sampler}" of pass "{shader_pass.name}", which the shader '
        "does not use",
        "remove the bind, or the macro that compiles the sampler",
    )


def _report_metalness(state: State, shader_pass: PassState, found: ConstantMetalness) -> None:
    name = found.variable.attributes["name"]
    state.add(
        "HS602",
        found.variable,
        f'variable "{name}" of pass "{shader_pass.name}" is {found.value} for all items',
        f"define METALNESS as {found.value} and remove the variable",
    )


def _report_mirrored(state: State, shader_pass: PassState, found: NothingMirrored) -> None:
    name = found.macro.attributes["name"]
    state.add(
        "HS603",
        found.macro,
        f'no model of pass "{shader_pass.name}" has mirrored texture coordinates, for which {name} is',
        "remove the macro, and Bitangent from the input layout",
    )


_REPORTS = {
    ConstantMap: _report_constant,
    UnreadTexture: _report_unread,
    ConstantMetalness: _report_metalness,
    NothingMirrored: _report_mirrored,
}
