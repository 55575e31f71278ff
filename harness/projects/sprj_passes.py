"""Reads a drawn ``<pass>`` of a .sprj: its shaders, targets and input layout, and what the other readers read."""

from __future__ import annotations

from collections.abc import Collection

from .project import LAYOUT_VALUES, ComputePass, Pass, Shader
from .sprj_items import read_items
from .sprj_values import choice, flag, integer, relative_path
from .sprj_variables import read_item_values, read_macros, read_variables
from .xml_lines import Element

#: the layout of a pass that gives none
DEFAULT_LAYOUT = ("Position", "Normal", "Texcoord")
MOST_TARGETS = 16
MOST_PATCH_VERTICES = 32
#: the most work groups that GL promises in each direction
MOST_GROUPS = 65535

#: stage in the .sprj -> name in messages, name of the field in Pass
STAGES = {
    "vs": ("vertex", "vertex"),
    "ps": ("pixel", "fragment"),
    "gs": ("geometry", "geometry"),
    "tcs": ("tessellation control", "tess_control"),
    "tes": ("tessellation evaluation", "tess_evaluation"),
}


def items_of(element: Element) -> list[Element]:
    """The item elements of a pass."""
    found = element.child("items")
    return found.children if found else []


def read_pass(element: Element, render_textures: Collection[str], items: list[Element]) -> Pass:
    """The pass with those of its items that have a name of their own; ``render_textures`` are the names of those among
    the project's objects."""
    name = element.attributes["name"]
    variables = read_variables(element.nested("variables", "variable"), name)
    drawn, end_state = read_items(items, name)
    if not end_state.depth_write:
        items[-1].warn(
            f'pass "{name}" ends with depthmask false: SHADERed\'s next clears leave the depth as it is, '
            "in the editor from the second frame on"
        )
    tessellated = _is_used(element, ("tcs", "tes"))
    return Pass(
        name=name,
        **_shaders(element, name, tessellated),
        layout=read_layout(element, name),
        items=drawn,
        variables=variables,
        item_values=read_item_values(
            element.nested("itemvalues", "value"), name, variables, [item.name for item in drawn]
        ),
        macros=read_macros(element.nested("macros", "define"), name),
        line=element.line,
        patch_vertices=_patch_vertices(element, name) if tessellated else 0,
        targets=_targets(element, name, render_textures),
        end_state=end_state,
    )


def read_compute_pass(element: Element) -> ComputePass:
    """A compute pass."""
    name = element.attributes["name"]
    shaders = element.all("shader")
    if not shaders:
        raise element.error(f'pass "{name}" has no compute shader (<shader type="cs">)')
    groups = element.child("groupsize")
    counts = []
    for axis in "xyz":
        count = 1
        if groups is not None and axis in groups.attributes:
            count = integer(groups, groups.attributes[axis], f'{axis} of <groupsize> of pass "{name}"', unsigned=True)
        if count > MOST_GROUPS:
            raise groups.error(f'pass "{name}": {count} work groups along {axis}; at most {MOST_GROUPS} work')
        counts.append(count)
    if 0 in counts:
        groups.warn(f'pass "{name}": 0 work groups: it does nothing')
    return ComputePass(
        name=name,
        compute=_shader(shaders[-1], f'the compute shader of pass "{name}"'),
        groups=(counts[0], counts[1], counts[2]),
        variables=read_variables(element.nested("variables", "variable"), name),
        macros=read_macros(element.nested("macros", "define"), name),
        line=element.line,
    )


def _targets(element: Element, name: str, render_textures: Collection[str]) -> tuple[str | None, ...]:
    targets = []
    for target in element.all("rendertexture"):
        texture = target.get("name")
        if texture and texture not in render_textures:
            raise target.error(f'pass "{name}" draws to the render texture "{texture}", which is not among the objects')
        targets.append(texture or None)
    if len(targets) > MOST_TARGETS:
        raise element.error(f'pass "{name}" has {len(targets)} targets; SHADERed can hold {MOST_TARGETS}')
    return tuple(targets) or (None,)


# ---- Shaders -----------------------------------------------------------------------------------------------


def _is_used(element: Element, stages: tuple[str, ...]) -> bool:
    """Whether the last shader of one of those stages says so."""
    used = [flag(s, "used", False) for s in element.all("shader") if s.get("type") in stages]
    return used[-1] if used else False


def _shaders(element: Element, name: str, tessellated: bool) -> dict[str, Shader]:
    used = {"vs", "ps"} | ({"gs"} if _is_used(element, ("gs",)) else set()) | ({"tcs", "tes"} if tessellated else set())
    found: dict[str, Shader] = {}
    for shader in element.all("shader"):
        stage = shader.get("type")
        if stage in used:
            found[STAGES[stage][1]] = _shader(shader, f'the {stage} shader of pass "{name}"')
        elif stage in ("gs", "tcs", "tes") and "used" not in shader.attributes and shader.get("path"):
            shader.warn(f'pass "{name}": the {STAGES[stage][0]} shader is left out: it lacks used="true"')
    # A missing control stage is allowed by GL, but SHADERed attaches a shader that is none and links nothing.
    for stage in sorted(used, reverse=True):
        long_name, attribute = STAGES[stage]
        if attribute not in found:
            raise element.error(f'pass "{name}" has no {long_name} shader (<shader type="{stage}">)')
    return found


def _shader(shader: Element, what: str) -> Shader:
    path = relative_path(shader, shader.get("path"), what)
    if path.rpartition(".")[2] in ("hlsl", "vk"):
        raise shader.error(f'{what}: "{path}" is not GLSL by its extension, and that is not supported')
    entry = shader.get("entry")
    if entry != "main":
        raise shader.error(f'{what}: the entry is "{entry}"; GLSL has no other than "main"')
    return Shader(path, shader.line)


def _patch_vertices(element: Element, name: str) -> int:
    count = integer(element, element.get("patchverts", "1"), f'patchverts of pass "{name}"')
    clamped = min(max(count, 1), MOST_PATCH_VERTICES)
    if clamped != count:
        element.warn(f'pass "{name}": patchverts is {count}, of which SHADERed makes {clamped}')
    return clamped


def read_layout(element: Element, name: str) -> tuple[str, ...]:
    """The input layout of a pass."""
    layout = tuple(
        choice(item, item.get("value"), LAYOUT_VALUES, "Position", f'the input layout value of pass "{name}"')
        for item in element.nested("inputlayout", "item")
    )
    return layout or DEFAULT_LAYOUT
