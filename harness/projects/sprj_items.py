"""Reads the ``<items>`` of a pass: shapes, models and vertex buffers, in the render states between them."""

from __future__ import annotations

from ..rendering import states
from .project import SHAPES, Blend, Geometry, Item, Model, RenderState, Stencil, StencilSide, Vector3, VertexBuffer
from .sprj_values import (
    child_flag,
    child_integer,
    child_real,
    child_text,
    choice,
    relative_path,
    truth,
)
from .xml_lines import Element

#: what SHADERed makes of a name that it does not know
_OTHERWISE = {"factor": "Blend Factor", "function": "Add", "compare": "Always", "stencil": "Keep"}
#: one draw of more could keep a machine busy for hours
MOST_INSTANCES = 10_000_000

KINDS = ("geometry", "model", "vertexbuffer", "renderstate")


def read_items(elements: list[Element], pass_name: str) -> tuple[tuple[Item, ...], RenderState]:
    """The items that are drawn, each with its state, and the state after the last. A state holds for those after it."""
    state, found = RenderState(), []
    for element in elements:
        what = f'item "{element.get("name")}" of pass "{pass_name}"'
        kind = element.get("type")
        if kind == "renderstate":
            state = _render_state(element, pass_name)
        elif kind not in KINDS:
            element.traps.survive(element.error(f'{what}: items of type "{kind}" are not supported'))
        else:
            found.append(_item(element, kind, what, state))
    return tuple(found), state


def read_place(element: Element) -> tuple[Vector3, Vector3, Vector3]:
    """Position, rotation and scale of an item."""
    what = f'item "{element.get("name")}"'

    def vector(names: str, default: float) -> Vector3:
        x, y, z = (child_real(element, tag, what, default) for tag in names.split())
        return x, y, z

    return vector("x y z", 0.0), vector("pitch yaw roll", 0.0), vector("scaleX scaleY scaleZ", 1.0)


def _item(element: Element, kind: str, what: str, state: RenderState) -> Item:
    position, rotation, scale = read_place(element)
    instances = child_integer(element, "instancecount", what, 0) if child_flag(element, "instanced", False) else None
    if instances is not None and instances > MOST_INSTANCES:
        raise element.error(f"{what}: {instances} instances; at most {MOST_INSTANCES} are drawn here")
    if instances is not None and instances < 1:
        element.warn(f"{what}: {instances} instances: nothing is drawn")
    buffer = child_text(element, "instancebuffer")
    common = {
        "name": element.get("name"),
        "state": state,
        "position": position,
        "rotation": rotation,
        "scale": scale,
        "line": element.line,
        "instances": instances,
        "instance_buffer": buffer.text if buffer else None,
    }
    if kind == "model":
        path = child_text(element, "filepath")
        if child_flag(element, "grouponly", False):
            child_text(element, "grouponly").warn(f"{what}: grouponly does nothing: all of the model is drawn")
        return Model(**common, path=relative_path(path or element, path.text if path else "", what))
    topology = child_text(element, "topology")
    common["topology"] = (
        "TriangleList"
        if topology is None
        else choice(topology, topology.text, tuple(states.TOPOLOGIES), "TriangleList", f"the topology of {what}")
    )
    if common["topology"] == "Undefined":
        topology.warn(f'{what}: nothing is drawn with the topology "Undefined"')
    if kind == "vertexbuffer":
        buffer = child_text(element, "buffer")
        if buffer is None:
            element.warn(f"{what} names no <buffer>: nothing is drawn")
        return VertexBuffer(**common, buffer=buffer.text if buffer else "")
    shape = child_text(element, "type")
    width, height, depth = (child_real(element, tag, what, 1.0) for tag in ("width", "height", "depth"))
    return Geometry(
        **common,
        shape="Cube" if shape is None else choice(shape, shape.text, SHAPES, "Cube", f"the shape of {what}"),
        size=(width, height, depth),
    )


# ---- Render states -----------------------------------------------------------------------------------------


def _render_state(element: Element, pass_name: str) -> RenderState:
    """A render state; tags that it leaves out take SHADERed's defaults, depth clamp among them, not the last state."""
    what = f'render state "{element.get("name")}" of pass "{pass_name}"'

    def named(tag: str, kind: str, default: str) -> str:
        found = child_text(element, tag)
        if found is None:
            return default
        names = getattr(states, f"{kind.upper()}S")
        value = choice(found, found.text, tuple(names), _OTHERWISE[kind], f"<{tag}> of {what}")
        if names[value] is None:
            raise found.error(f'<{tag}> of {what} is "{value}", which SHADERed does not pass on to GL')
        return value

    for tag in ("depthbias", "alpha2coverage"):
        found = child_text(element, tag)
        if found is not None and (truth(found.text) if tag == "alpha2coverage" else found.text.strip("0. +-")):
            found.warn(f"{what}: <{tag}> does nothing in SHADERed")
    return RenderState(
        cull=child_flag(element, "cull", True),
        cull_front=child_flag(element, "cullfront", False),
        ccw=child_flag(element, "ccw", True),
        depth_clamp=child_flag(element, "depthclamp", True),
        wireframe=child_flag(element, "wireframe", False),
        depth_test=child_flag(element, "depthtest", True),
        depth_write=child_flag(element, "depthmask", True),
        depth_function=named("depthfunc", "compare", "Less"),
        blend=_blend(element, what, named) if child_flag(element, "blend", False) else None,
        stencil=_stencil(element, what, named) if child_flag(element, "stenciltest", False) else None,
    )


def _blend(element: Element, what: str, named) -> Blend:
    # Whole numbers, read without a sign; blue takes the value of alpha.
    red, green, blue, alpha = (
        float(child_integer(element, f"blendfactor_{c}", what, 1, unsigned=True)) for c in "rgba"
    )
    if blue != alpha:
        at = child_text(element, "blendfactor_b") or element
        at.warn(f"{what}: SHADERed takes the blue of the blend factor from <blendfactor_a>")
    return Blend(
        named("colorsrcfactor", "factor", "Source Alpha"),
        named("colordstfactor", "factor", "Inverse Source Alpha"),
        named("colorfunc", "function", "Add"),
        named("alphasrcfactor", "factor", "Source Alpha"),
        named("alphadstfactor", "factor", "Inverse Source Alpha"),
        named("alphafunc", "function", "Add"),
        (red, green, alpha, alpha),
    )


def _stencil(element: Element, what: str, named) -> Stencil:
    if child_text(element, "stencilref") is not None:
        child_text(element, "stencilref").warn(
            f"{what}: <stencilref> is the mask of the comparison in SHADERed; the reference is always 1"
        )
    front, back = (
        StencilSide(
            named(f"stencil{side}func", "compare", "Equal"),
            named(f"stencil{side}fail", "stencil", "Keep"),
            named(f"depth{side}fail", "stencil", "Keep"),
            named(f"stencil{side}pass", "stencil", "Keep"),
        )
        for side in ("front", "back")
    )
    return Stencil(
        child_integer(element, "stencilref", what, 0xFF, unsigned=True),
        child_integer(element, "stencilmask", what, 0, unsigned=True),
        front,
        back,
    )
