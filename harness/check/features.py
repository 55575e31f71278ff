"""Checks for what a pass compiles or samples although nothing needs it: constant maps, unread textures, macros."""

from __future__ import annotations

import re

import numpy as np

from ..native import Stage
from ..xml_lines import Element
from . import models, roles, samplers, textures
from .state import Bound, PassState, State, child_text, path_of

_FLAT = 1  # bytes that a map may differ by and still be called the same everywhere
_METALNESS = "METALNESS"


def check(state: State) -> None:
    """Checks the passes that compile."""
    for shader_pass in state.passes:
        if shader_pass.program is None or Stage.FRAGMENT not in shader_pass.preprocessed:
            continue
        for bound, sampler in samplers.given(shader_pass):
            _check_texture(state, shader_pass, bound, sampler)
        _check_metalness(state, shader_pass)
        _check_mirrored(state, shader_pass)


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


def _check_texture(state: State, shader_pass: PassState, bound: Bound, sampler: str) -> None:
    role = (roles.of_file(bound.path) if bound.path else None) or samplers.wanted_role(shader_pass, sampler)
    if sampler not in shader_pass.program.uniforms:
        state.add(
            "HS603",
            bound.bind,
            f'"{bound.name}" goes to the sampler "{sampler}" of pass "{shader_pass.name}", which the shader '
            "does not use",
            "remove the bind, or the macro that compiles the sampler",
        )
        return
    image = textures.readable(state, bound)
    if image is None or not is_constant(image):
        return
    value = image[0, 0]
    macro = _macro(shader_pass, role)
    at = macro if macro is not None else bound.bind
    how = f"remove the macro {macro.attributes['name']}" if macro is not None else "use a uniform instead"
    if role == roles.METALNESS and (value[0] <= _FLAT or value[0] >= 255 - _FLAT):
        metal = int(value[0] > _FLAT)
        state.add(
            "HS602",
            at,
            f'the metalness map "{bound.path}" of pass "{shader_pass.name}" is {metal} everywhere',
            f"{how}, and fix METALNESS to {metal}",
        )
    else:
        what = "flat" if role == roles.NORMAL else f"{'/'.join(map(str, value[:3]))} of 255 everywhere"
        state.add(
            "HS601", at, f'the {role or "texture"} map "{bound.path}" of pass "{shader_pass.name}" is {what}', how
        )


def _check_metalness(state: State, shader_pass: PassState) -> None:
    """A metalness uniform that is constantly 0 or 1, where the shader has a macro to fix it."""
    source = shader_pass.sources[Stage.FRAGMENT]
    if not re.search(rf"^\s*#.*\bdefined\s*\(?\s*{_METALNESS}\b|^\s*#\s*ifn?def\s+{_METALNESS}\b", source.text, re.M):
        return
    if any(d.attributes.get("name") == _METALNESS for d in shader_pass.macros):
        return
    of_items = {v.attributes.get("variable") for v in shader_pass.element.nested("itemvalues", "value")}
    for variable in shader_pass.variables:
        name = variable.attributes.get("name", "")
        values = [v.text.strip() for row in variable.all("row") for v in row.all("value")]
        if roles.of_name(name) != roles.METALNESS or name not in shader_pass.program.uniforms or name in of_items:
            continue
        if "system" in variable.attributes or "function" in variable.attributes or len(values) != 1:
            continue
        if re.fullmatch(r"[01](\.0*)?", values[0]):
            state.add(
                "HS602",
                variable,
                f'variable "{name}" of pass "{shader_pass.name}" is {values[0]} for all items',
                f"define METALNESS as {values[0][0]} and remove the variable",
            )


def _check_mirrored(state: State, shader_pass: PassState) -> None:
    """A macro for mirrored texture coordinates where no model has any."""
    macro = next((d for d in shader_pass.macros if "MIRROR" in d.attributes.get("name", "") and _is_on(d)), None)
    if macro is None or shader_pass.kinds() != {"model"}:
        return
    for item in shader_pass.items:
        if item.attributes.get("type") != "model":
            continue
        data = models.readable(state.file(path_of(child_text(item, "filepath"))))
        if data is None or (models.handedness(data) < 0).any():
            return
    state.add(
        "HS603",
        macro,
        f'no model of pass "{shader_pass.name}" has mirrored texture coordinates, for which '
        f"{macro.attributes['name']} is",
        "remove the macro, and Bitangent from the input layout",
    )
