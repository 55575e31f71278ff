"""Reads a drawn ``<pass>`` of a .sprj: its shaders, input layout, items, variables and macros."""

from __future__ import annotations

from collections.abc import Collection

from .project import (
    LAYOUT_VALUES,
    SHAPES,
    SYSTEM_TYPES,
    VARIABLE_TYPES,
    Geometry,
    ItemValue,
    Macro,
    Model,
    Pass,
    RenderState,
    Shader,
    Variable,
)
from .sprj_values import (
    MACRO_NAME_LIMIT,
    MACRO_VALUE_LIMIT,
    NAME_LIMIT,
    child_real,
    flag,
    limited,
    relative_path,
    truth,
    values,
)
from .xml_lines import Element

#: the layout of a pass that gives none
DEFAULT_LAYOUT = ("Position", "Normal", "Texcoord")


def items_of(element: Element) -> list[Element]:
    """The item elements of a pass."""
    found = element.child("items")
    return found.children if found else []


def read_pass(element: Element, render_textures: Collection[str]) -> Pass:
    """The pass; ``render_textures`` are the names of those among the project's objects."""
    name = element.attributes["name"]
    _refuse_other_targets(element, name, render_textures)
    vertex, fragment = _shaders(element, name)
    variables = tuple(_variable(v, name) for v in element.nested("variables", "variable"))
    return Pass(
        name=name,
        vertex=vertex,
        fragment=fragment,
        layout=_layout(element, name),
        items=_items(element, name),
        variables=variables,
        item_values=_item_values(element, name, variables),
        macros=_macros(element, name),
        line=element.line,
    )


def _refuse_other_targets(element: Element, name: str, render_textures: Collection[str]) -> None:
    targets = element.all("rendertexture")
    for target in targets:
        texture = target.attributes.get("name", "")
        if texture and texture not in render_textures:
            raise target.error(f'pass "{name}" draws to the render texture "{texture}", which is not among the objects')
        if texture:
            raise target.error(f'pass "{name}" draws to the render texture "{texture}": that is not supported')
    if len(targets) > 1:
        raise targets[1].error(f'pass "{name}": more than one <rendertexture> is not supported')


def _shaders(element: Element, name: str) -> tuple[Shader, Shader]:
    found: dict[str, Shader] = {}
    for shader in element.all("shader"):
        stage = shader.attributes.get("type", "")
        if stage in ("gs", "tcs", "tes") and flag(shader, "used", False):
            raise shader.error(f'pass "{name}": shaders of type "{stage}" are not supported')
        if stage not in ("vs", "ps"):
            continue
        what = f'the {stage} shader of pass "{name}"'
        path = relative_path(shader, shader.attributes.get("path", ""), what)
        if path.rpartition(".")[2] in ("hlsl", "vk"):
            raise shader.error(f'{what}: "{path}" is not GLSL by its extension, and that is not supported')
        entry = shader.attributes.get("entry", "")
        if entry != "main":
            raise shader.error(f'{what}: the entry is "{entry}"; GLSL has no other than "main"')
        found[stage] = Shader(path, shader.line)
    for stage, long_name in (("vs", "vertex"), ("ps", "pixel")):
        if stage not in found:
            raise element.error(f'pass "{name}" has no {long_name} shader (<shader type="{stage}">)')
    return found["vs"], found["ps"]


def _layout(element: Element, name: str) -> tuple[str, ...]:
    layout = []
    for item in element.nested("inputlayout", "item"):
        value = item.attributes.get("value", "")
        if value not in LAYOUT_VALUES:
            raise item.error(
                f'pass "{name}": the input layout value "{value}" is not supported; there are '
                + ", ".join(LAYOUT_VALUES)
            )
        layout.append(value)
    return tuple(layout) or DEFAULT_LAYOUT


def _variable(element: Element, pass_name: str) -> Variable:
    name = limited(element, element.attributes.get("name", ""), NAME_LIMIT, "the name of the variable")
    what = f'variable "{name}" of pass "{pass_name}"'
    variable_type = VARIABLE_TYPES.get(element.attributes.get("type", ""), VARIABLE_TYPES["float"])
    system = element.attributes.get("system")
    if system is not None and system not in SYSTEM_TYPES:
        raise element.error(f'{what}: the system value "{system}" is not supported')
    if system is not None and SYSTEM_TYPES[system] != variable_type.name:
        system = None  # and so the constant is 0, as in SHADERed
    if system is None and "function" in element.attributes:
        raise element.error(f'{what}: functions ("{element.attributes["function"]}") are not supported')
    if system is not None and flag(element, "lastframe", False):
        raise element.error(f"{what}: values of the last frame are not supported")
    invert = flag(element, "invert", False) and variable_type.rows > 1
    if invert and system is None:
        # SHADERed inverts it again for each item: every second one gets the matrix itself.
        raise element.error(f"{what}: inverting a constant is not supported")
    value = values(element, variable_type, what) if system is None else ()
    return Variable(name, variable_type, value, system, invert, element.line)


def _item_values(element: Element, name: str, variables: tuple[Variable, ...]) -> tuple[ItemValue, ...]:
    """The values of single items. SHADERed leaves out those for what is not in the pass; for a system value
    one does nothing."""
    items = {item.attributes["name"] for item in items_of(element)}
    found = []
    for value in element.nested("itemvalues", "value"):
        of, item = value.attributes.get("variable", ""), value.attributes.get("for", "")
        variable = next((v for v in variables if v.name == of), None)
        if variable is None or item not in items or variable.system is not None:
            continue
        what = f'variable "{of}" for item "{item}" of pass "{name}"'
        found.append(ItemValue(variable, item, values(value, variable.type, what), value.line))
    return tuple(found)


def _macros(element: Element, name: str) -> tuple[Macro, ...]:
    macros: dict[str, Macro] = {}
    for define in element.nested("macros", "define"):
        if not flag(define, "active", True):
            continue
        what = f'macro of pass "{name}"'
        macro = Macro(
            name=limited(define, define.attributes.get("name", ""), MACRO_NAME_LIMIT, f"the name of a {what}"),
            value=limited(define, define.text, MACRO_VALUE_LIMIT, f"the value of a {what}"),
            line=define.line,
        )
        if not macro.name.strip():
            raise define.error(f"a {what} has no name")
        other = macros.setdefault(macro.name, macro)
        if other.value != macro.value:
            raise define.error(f'pass "{name}" defines the macro "{macro.name}" twice, first in line {other.line}')
    return tuple(macros.values())


#: tags of a render state that are supported with one value alone, SHADERed's default
_FIXED_STATES = {
    "wireframe": "false",
    "blend": "false",
    "alpha2coverage": "false",
    "depthtest": "true",
    "depthmask": "true",
    "stenciltest": "false",
}


def _items(element: Element, pass_name: str) -> tuple[Geometry | Model, ...]:
    """The items that are drawn; a render state among them holds for those after it."""
    state, found = RenderState(), []
    for item in items_of(element):
        if item.attributes.get("type") == "renderstate":
            state = _render_state(item, pass_name)
        else:
            found.append(_item(item, pass_name, state))
    return tuple(found)


def _render_state(element: Element, pass_name: str) -> RenderState:
    """A render state; tags that it leaves out take SHADERed's defaults, depth clamp among them, not the last state."""
    what = f'render state "{element.attributes["name"]}" of pass "{pass_name}"'
    for tag in element.children:
        if tag.name in _FIXED_STATES and truth(tag.text) != truth(_FIXED_STATES[tag.name]):
            raise tag.error(f"{what}: <{tag.name}>{tag.text}</{tag.name}> is not supported")
        if tag.name == "depthfunc" and tag.text != "Less":
            raise tag.error(f"{what}: <depthfunc>{tag.text}</depthfunc> is not supported")

    def choice(tag: str, default: bool) -> bool:
        found = element.all(tag)
        return truth(found[-1].text) if found else default

    return RenderState(
        choice("cull", True), choice("cullfront", False), choice("ccw", True), choice("depthclamp", True)
    )


def _item(element: Element, pass_name: str, state: RenderState) -> Geometry | Model:
    name, kind = element.attributes["name"], element.attributes.get("type", "")
    what = f'item "{name}" of pass "{pass_name}"'
    if kind not in ("geometry", "model"):
        raise element.error(f'{what}: items of type "{kind}" are not supported')
    if any(truth(instanced.text) for instanced in element.all("instanced")[-1:]):
        raise element.error(f"{what}: <instanced> is not supported")
    if element.child("instancebuffer"):
        raise element.error(f"{what}: <instancebuffer> is not supported")

    def vector(names: str, default: float) -> tuple[float, float, float]:
        x, y, z = (child_real(element, tag, what, default) for tag in names.split())
        return x, y, z

    common = {
        "name": name,
        "state": state,
        "position": vector("x y z", 0.0),
        "rotation": vector("pitch yaw roll", 0.0),
        "scale": vector("scaleX scaleY scaleZ", 1.0),
        "line": element.line,
    }
    if kind == "model":
        path = (element.all("filepath") or [element])[-1]
        return Model(**common, path=relative_path(path, path.text if path is not element else "", what))
    for topology in element.all("topology"):
        if topology.text != "TriangleList":
            raise topology.error(f'{what}: the topology "{topology.text}" is not supported, only TriangleList')
    shape = (element.all("type") or [None])[-1]
    if shape is not None and shape.text not in SHAPES:
        raise shape.error(f'{what}: there is no shape "{shape.text}"')
    return Geometry(**common, shape=shape.text if shape else "Cube", size=vector("width height depth", 1.0))
