"""Checks for loops that never end: nothing in their bodies changes what their conditions look at."""

from __future__ import annotations

import re

from ..language import glsl
from .state import PassState, State

_LOOP = re.compile(r"\b(while|for)\s*\(")
_WORD = re.compile(r"\b[A-Za-z_]\w*\b(?!\s*\()")
_CALL = re.compile(r"\b(?!while\b|for\b|if\b)[A-Za-z_]\w*\s*\(")
_LEAVES = re.compile(r"\b(break|return|discard)\b")
_STEP = r"\b{}\s*(?:\.\w+\s*)?(?:\[[^\]]*\]\s*)?([-+*/%&|^]?|<<|>>)=(?!=)\s*([^;]*)"
_GIVEN = re.compile(r"\b\w+\s*\(([^;]*)\)")  # what functions are called with
_TYPE_NAMES = {"int", "uint", "float", "bool", "true", "false", "const"}


def check(state: State, shader_pass: PassState, source: glsl.Source, text: str) -> None:
    """Adds a finding for each loop of a preprocessed text that nothing ends."""
    still = _unchanging(shader_pass)
    may_write = re.search(r"\b(inout|out)\b[^;{}]*\)", text)
    for match in _LOOP.finditer(text):
        end = closing(text, match.end() - 1)
        if end is None:
            continue
        head = text[match.end() : end]
        body, step = _body(text, match, end), ""
        if match[1] == "for":
            _, _, rest = head.partition(";")
            head, _, step = rest.partition(";")
        if re.match(r"\s*;", text[end + 1 :]) and _is_do(text, match.start()):
            body = _do_body(text, match.start())
        if body is None or _LEAVES.search(body) or _CALL.search(head):
            continue
        names = set(_WORD.findall(head)) - _TYPE_NAMES
        if may_write and any(re.search(rf"\b{name}\b", given) for name in names for given in _GIVEN.findall(body)):
            continue
        if head.strip() == "false" or any(_changes(name, body + ";" + step + ";", still) for name in names):
            continue
        line = text.count("\n", 0, match.start()) + 1
        file, number = source.origin(line)
        what = f"nothing in it changes {', '.join(sorted(names))}" if names else "it has no way out"
        state.add(
            "HS113",
            (file, number),
            f'this loop of pass "{shader_pass.name}" never ends, and drawing it runs out of time: {what}',
            "count up to a constant number of rounds",
        )


def closing(text: str, start: int) -> int | None:
    """Where the bracket that opens at ``start`` closes."""
    pairs = {"(": ")", "{": "}", "[": "]"}
    opening, close, depth = text[start], pairs[text[start]], 0
    for k in range(start, len(text)):
        depth += (text[k] == opening) - (text[k] == close)
        if depth == 0:
            return k
    return None


def _body(text: str, match: re.Match, end: int) -> str | None:
    rest = re.compile(r"\s*").match(text, end + 1).end()
    if rest < len(text) and text[rest] == "{":
        close = closing(text, rest)
        return None if close is None else text[rest : close + 1]
    stop = text.find(";", rest)
    return text[rest : stop + 1]


def _is_do(text: str, start: int) -> bool:
    return text[:start].rstrip().endswith("}") and _do_body(text, start) is not None


def _do_body(text: str, start: int) -> str | None:
    """The body of the do that a while at ``start`` ends."""
    depth, end = 0, len(text[:start].rstrip()) - 1
    for k in range(end, -1, -1):
        depth += (text[k] == "}") - (text[k] == "{")
        if depth == 0:
            return text[k : end + 1] if re.search(r"\bdo\s*$", text[:k]) else None
    return None


def _unchanging(shader_pass: PassState) -> set[str]:
    """The uniforms that are the constant 0 in this pass, for every item."""
    own = {v.attributes.get("variable") for v in shader_pass.element.nested("itemvalues", "value")}
    zero = set()
    for variable in shader_pass.variables:
        name = variable.attributes.get("name", "")
        values = [value.text.strip() for row in variable.all("row") for value in row.all("value")]
        is_constant = "system" not in variable.attributes and "function" not in variable.attributes
        if is_constant and name not in own and all(re.fullmatch(r"[-+]?0*\.?0*", v) for v in values):
            zero.add(name)
    return zero


def _changes(name: str, text: str, zero: set[str]) -> bool:
    """Whether a text may change a variable: all but adding or subtracting what is 0."""
    if re.search(rf"(\+\+|--)\s*{name}\b|\b{name}\s*(?:\.\w+\s*)?(\+\+|--)", text):
        return True
    for operator, value in re.findall(_STEP.format(name), text):
        if not (operator in ("+", "-") and (value.strip() in zero or re.fullmatch(r"0*\.?0*", value.strip()))):
            return True
    return False
