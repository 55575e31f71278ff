"""The uniforms and attributes that a preprocessed shader declares, with their lines."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

from .loops import closing

_UNIFORM = re.compile(r"(?:\blayout\s*\([^)]*\)\s*)?\buniform\b\s*([^;{}]*)(;|\{)")
_ATTRIBUTE = re.compile(
    r"(?:\blayout\s*\(([^)]*)\)\s*)?(?<!\w)(?:in|attribute)\s+(?:(?:highp|mediump|lowp)\s+)?(\w+)\s+(\w+)\s*(?:\[[^\]]*\])?\s*;"
)


@dataclass(frozen=True)
class Declared:
    """A declared uniform. ``initialiser`` is its text after =, "" without one; ``line`` that of the text."""

    type: str
    name: str
    is_array: bool
    initialiser: str
    line: int


@lru_cache(maxsize=128)
def uniforms(text: str) -> Mapping[str, Declared]:
    """Name -> the uniform of that name; blocks are left out."""
    found = {}
    for match in _UNIFORM.finditer(text):
        if match[2] == "{":
            continue
        line = text.count("\n", 0, match.end(2)) + 1
        kind, declarators = _split(match[1])
        for name, is_array, initialiser in declarators:
            found[name] = Declared(kind, name, is_array, initialiser, line)
    return found


def blocks(text: str) -> list[tuple[int, str]]:
    """(line, body) of each uniform block."""
    return [
        (text.count("\n", 0, m.end(2)) + 1, text[m.end(2) : closing(text, m.start(2))])
        for m in _UNIFORM.finditer(text)
        if m[2] == "{"
    ]


def _split(text: str) -> tuple[str, list[tuple[str, bool, str]]]:
    words = re.match(r"\s*((?:\w+\s+)*?)(\w+)\s+(?=\w+\s*(?:[\[=,]|$))(.*)", text, re.DOTALL)
    if not words:
        return "", []
    declarators = []
    for part in _at_commas(words[3]):
        match = re.match(r"\s*(\w+)\s*(\[[^\]]*\])?\s*(?:=\s*(.*))?$", part, re.DOTALL)
        if match:
            declarators.append((match[1], bool(match[2]), (match[3] or "").strip()))
    return words[2], declarators


def _at_commas(text: str) -> Iterator[str]:
    """The parts of a text between commas that no brackets enclose."""
    depth, start = 0, 0
    for k, character in enumerate(text):
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            yield text[start:k]
            start = k + 1
    yield text[start:]


def attributes(text: str) -> dict[str, tuple[str, bool, int]]:
    """Name -> (type, whether its location is stated, line) of each input of a vertex shader."""
    found = {}
    for match in _ATTRIBUTE.finditer(_without_bodies(text)):
        found[match[3]] = match[2], "location" in (match[1] or ""), text.count("\n", 0, match.end()) + 1
    return found


def _without_bodies(text: str) -> str:
    """The text with what stands in braces and parameter lists blanked: parameters are ``in`` too."""
    characters = list(text)
    for match in re.finditer(r"\{|(?<!layout)(?<!layout )\(", text):
        end = closing(text, match.start())
        for k in range(match.start(), end + 1 if end else len(text)):
            if characters[k] != "\n":
                characters[k] = " "
    return "".join(characters)
