"""Edits of a .sprj among its bytes: what is set, added or removed changes, and every other byte stays.

Each function takes the bytes of a project of version 2 and gives them back edited. What is added stands where its like
stand, with their indentation, line ends and quotes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from xml.parsers import expat
from xml.sax.saxutils import escape

from ..errors import ProjectError

_SPACE = re.compile(rb"[ \t\r\n]*\Z")
_TAG = re.compile(rb"<(?:[^>\"']|\"[^\"]*\"|'[^']*')*>")
_TRUE = tuple("1tTyY")  # what a truth value begins with


@dataclass(eq=False)
class _Element:
    """An element among the bytes: all of it is [start, end), what is in it [inside, closing)."""

    name: str
    attributes: dict[str, str]
    start: int
    inside: int
    closing: int = 0
    end: int = 0
    children: list[_Element] = field(default_factory=list)

    def all(self, name: str) -> list[_Element]:
        return [child for child in self.children if child.name == name]

    def nested(self, outer: str, name: str) -> list[_Element]:
        found = self.all(outer)
        return found[0].all(name) if found else []


def _parse(data: bytes) -> _Element:
    if b"\0" in data[:4]:
        raise ProjectError("a project in UTF-16 is not written: save it as UTF-8")
    parser = expat.ParserCreate()
    top = _Element("", {}, 0, 0)
    path = [top]

    def start(name: str, attributes: dict[str, str]) -> None:
        at = parser.CurrentByteIndex
        element = _Element(name, attributes, at, _TAG.match(data, at).end())
        path[-1].children.append(element)
        path.append(element)

    def end(_: str) -> None:
        element = path.pop()
        if data[element.inside - 2 : element.inside] == b"/>":
            element.closing = element.end = element.inside
        else:
            element.closing = parser.CurrentByteIndex
            element.end = data.index(b">", element.closing) + 1

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.Parse(data, True)
    return top.children[0]


def _pass(root: _Element, name: str) -> _Element:
    return next(p for p in root.nested("pipeline", "pass") if p.attributes.get("name") == name)


def _replaced(data: bytes, start: int, end: int, text: bytes) -> bytes:
    return data[:start] + text + data[end:]


def _space_before(data: bytes, at: int) -> bytes:
    """The white space that ends at a place: a line's end and an indentation, mostly."""
    return _SPACE.search(data, 0, at)[0] if at else b""


def _without(data: bytes, elements: Sequence[_Element]) -> bytes:
    """The bytes without these elements and the white space before each."""
    for element in sorted(elements, key=lambda e: -e.start):
        data = _replaced(data, element.start - len(_space_before(data, element.start)), element.end, b"")
    return data


def _quoted(data: bytes, like: _Element, text: str) -> bytes:
    """An element's text with the quotes of another's tag."""
    tag = data[like.start : like.inside]
    return (text.replace('"', "'") if b"'" in tag and b'"' not in tag else text).encode("ascii", "xmlcharrefreplace")


def _added(data: bytes, parent: _Element, list_name: str, name: str, text: str) -> bytes:
    """The bytes with an element ``name``, which ``text`` is, last among its like in the first ``list_name`` of a
    parent; the list is made where there is none."""
    lists = parent.all(list_name)
    if lists and (like := lists[0].all(name)):
        return _replaced(
            data, like[-1].end, like[-1].end, _space_before(data, like[-1].start) + _quoted(data, like[-1], text)
        )
    neighbour = lists[0] if lists else parent.children[-1]
    outer = _space_before(data, neighbour.start)
    step = outer[len(_space_before(data, parent.start)) :].lstrip(b"\r\n")
    inner = outer + step if b"\n" in outer else b""
    made = b"<" + list_name.encode() + b">" + inner + _quoted(data, neighbour, text) + outer
    made += b"</" + list_name.encode() + b">"
    if lists:
        return _replaced(data, neighbour.start, neighbour.end, made)
    return _replaced(data, neighbour.end, neighbour.end, outer + made)


# ---- Macros ----------------------------------------------------------------------------------------------------------


def set_macro(data: bytes, pass_name: str, name: str, value: str) -> bytes:
    """Defines a macro of a pass: its value alone changes where it is defined."""
    root = _parse(data)
    there = _pass(root, pass_name)
    text = f'<define name="{escape(name)}" active="true">{escape(value)}</define>'
    defines = [d for d in there.nested("macros", "define") if d.attributes.get("name") == name]
    if not defines:
        return _added(data, there, "macros", "define", text)
    active = [d for d in defines if d.attributes.get("active", "true").startswith(_TRUE)]
    if active and active[-1].closing != active[-1].end:
        return _replaced(data, active[-1].inside, active[-1].closing, escape(value).encode())
    last = (active or defines)[-1]
    return _replaced(data, last.start, last.end, _quoted(data, last, text))


def remove_macro(data: bytes, pass_name: str, name: str) -> bytes:
    """Takes a macro from a pass."""
    defines = _pass(_parse(data), pass_name).nested("macros", "define")
    return _without(data, [d for d in defines if d.attributes.get("name") == name])


# ---- Variables -------------------------------------------------------------------------------------------------------


def set_variable(data: bytes, pass_name: str, name: str, kind: str, values: Sequence[str]) -> bytes:
    """Makes a variable of a pass a constant, the same for all items."""
    numbers = "".join(f"<value>{value}</value>" for value in values)
    text = f'<variable type="{kind}" name="{escape(name)}"><row>{numbers}</row></variable>'
    data = _without(data, _item_values(_pass(_parse(data), pass_name), name))
    there = _pass(_parse(data), pass_name)
    old = [v for v in there.nested("variables", "variable") if v.attributes.get("name") == name]
    if old:
        return _replaced(data, old[-1].start, old[-1].end, _quoted(data, old[-1], text))
    return _added(data, there, "variables", "variable", text)


def remove_variable(data: bytes, pass_name: str, name: str) -> bytes:
    """Takes a variable from a pass, with the values that items have of it."""
    there = _pass(_parse(data), pass_name)
    own = [v for v in there.nested("variables", "variable") if v.attributes.get("name") == name]
    return _without(data, own + _item_values(there, name))


def _item_values(there: _Element, name: str) -> list[_Element]:
    return [v for v in there.nested("itemvalues", "value") if v.attributes.get("variable") == name]


# ---- Textures and the input layout -----------------------------------------------------------------------------------


def unbind(data: bytes, pass_name: str, key: str, value: str) -> bytes:
    """Takes the texture whose attribute ``key`` is ``value`` from a pass; from the project where it was in no other."""
    for element in _parse(data).nested("objects", "object"):
        binds = element.all("bind")
        own = [b for b in binds if b.attributes.get("name") == pass_name]
        if element.attributes.get(key) == value and own:
            is_last = len(own) == len(binds) and element.attributes.get("type") == "texture"
            return _without(data, [element] if is_last else own)
    return data


def trim_layout(data: bytes, pass_name: str, count: int) -> bytes:
    """Leaves a pass the first ``count`` items of its input layout."""
    return _without(data, _pass(_parse(data), pass_name).nested("inputlayout", "item")[count:])


def layouts(data: bytes) -> dict[str, tuple[str, ...]]:
    """The input layouts that passes have written out, by the passes' names."""
    found = {}
    for element in _parse(data).nested("pipeline", "pass"):
        values = tuple(i.attributes.get("value", "") for i in element.nested("inputlayout", "item"))
        if values:
            found.setdefault(element.attributes.get("name", ""), values)
    return found


def users_of_model(data: bytes, path: str) -> list[str]:
    """The names of the passes with an item of a model file, those too that do not draw."""
    found = []
    for element in _parse(data).nested("pipeline", "pass"):
        paths = (
            data[f.inside : f.closing].decode(errors="replace").replace("\\", "/")
            for item in element.nested("items", "item")
            for f in item.all("filepath")
        )
        if path in paths:
            found.append(element.attributes.get("name", ""))
    return found


#: one of the functions above, but for the bytes
Edit = Callable[[bytes], bytes]
