"""Version 1 of the project format: turns its elements into those of version 2, in place, lines and all.

It has shader variables under each shader, paths and entries as elements, three kinds of render state, the window by
the name "Window", and colours of whole numbers; the last are read by whoever reads them.
"""

from __future__ import annotations

from .xml_lines import Element

#: tags of version 1's render states -> those of version 2
_BLEND = {
    "srcblend": "colorsrcfactor",
    "blendop": "colorfunc",
    "destblend": "colordstfactor",
    "srcblendalpha": "alphasrcfactor",
    "alphablendop": "alphafunc",
    "destblendalpha": "alphadstfactor",
    "alpha2cov": "alpha2coverage",
    "bf_red": "blendfactor_r",
    "bf_green": "blendfactor_g",
    "bf_blue": "blendfactor_b",
    "bf_alpha": "blendfactor_a",
}
_DEPTH_STENCIL = {
    "depthenable": "depthtest",
    "depthfunc": "depthfunc",
    "stencilenable": "stenciltest",
    "frontfunc": "stencilfrontfunc",
    "frontpass": "stencilfrontpass",
    "backfunc": "stencilbackfunc",
    "backpass": "stencilbackpass",
    "sref": "stencilref",
}
#: one tag for two
_FAILS = {"frontfail": ("stencilfrontfail", "depthfrontfail"), "backfail": ("stencilbackfail", "depthbackfail")}
_RASTERIZER = {"wireframe": "wireframe", "ccw": "ccw", "depthbias": "depthbias", "depthclip": "depthclamp"}
_STATES = {"blend": _BLEND, "depthstencil": _DEPTH_STENCIL, "rasterizer": _RASTERIZER}

#: what version 1 does not know, on passes and on variables
_LATER_PASS = ("type", "active", "patchverts")
_LATER_CHILDREN = ("variables", "inputlayout", "macros")


def modernize(root: Element) -> None:
    """Turns a version 1 project into one of version 2."""
    for element in root.nested("pipeline", "pass"):
        for attribute in _LATER_PASS:
            element.attributes.pop(attribute, None)
        element.children = [c for c in element.children if c.name not in _LATER_CHILDREN]
        _shaders(element)
        for target in element.all("rendertexture"):
            if target.get("name") == "Window":
                target.attributes["name"] = ""
            elif not target.get("name"):
                raise target.error('a target without a name: the window is called "Window" in version 1')
        items = element.child("items")
        for item in items.children if items else []:
            if item.get("type") in _STATES:
                _state(item, item.get("type"))
            else:
                later = ("instanced", "instancecount", "instancebuffer")
                item.children = [c for c in item.children if c.name not in later]


def _child(like: Element, name: str, text: str) -> Element:
    return Element(name, {}, like.file, like.line, text, traps=like.traps)


def _shaders(element: Element) -> None:
    variables = _child(element, "variables", "")
    for shader in element.all("shader"):
        if shader.get("type") in ("tcs", "tes"):
            shader.attributes["type"] = ""
        for name in ("path", "entry"):
            found = shader.child(name)
            shader.attributes[name] = found.text if found else ""
        for variable in shader.nested("variables", "variable"):
            variable.attributes.pop("invert", None)
            variable.attributes.pop("lastframe", None)
            variables.children.append(variable)
    element.children.append(variables)


def _state(item: Element, kind: str) -> None:
    renamed = []
    for tag in item.children:
        if tag.name in _STATES[kind]:
            tag.name = _STATES[kind][tag.name]
            renamed.append(tag)
        elif kind == "depthstencil" and tag.name in _FAILS:
            renamed += [_child(tag, name, tag.text) for name in _FAILS[tag.name]]
        elif kind == "rasterizer" and tag.name == "cull":
            renamed += _cull(tag)
    if kind == "blend":
        renamed.append(_child(item, "blend", "true"))
    if kind == "depthstencil":
        renamed.append(_child(item, "stencilmask", "255"))
    item.attributes["type"] = "renderstate"
    item.children = renamed


def _cull(tag: Element) -> list[Element]:
    """Version 1 names the faces that are culled; of any other name SHADERed makes Back."""
    if tag.text not in ("None", "Front", "Back"):
        tag.warn(f'cull is "{tag.text}", of which SHADERed makes Back; there are None, Front, Back')
    return [
        _child(tag, "cull", "false" if tag.text == "None" else "true"),
        _child(tag, "cullfront", "true" if tag.text == "Front" else "false"),
    ]
