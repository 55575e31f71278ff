"""Follows what a shader samples through its text: which functions it goes through, and what it ends up as.

Not a compiler: it reads the preprocessed text statement by statement, through variables, parameters and return values
of the file's own functions, as far as names tell.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from . import roles
from .loops import closing

_FUNCTION = re.compile(r"\b\w+\s+(\w+)\s*\(([^()]*)\)\s*\{")
_SAMPLE = r"\btexture\w*\s*\(\s*{}\s*,"
#: exponents that decode and that encode: literals, or constants so called
_DECODING = re.compile(r"(?:vec[34]\s*\(\s*)?(?:2\.[1-5]\d*|\w*gamma\w*)\s*\)?", re.I)
_ENCODING = re.compile(r"(?:vec[34]\s*\(\s*)?(?:1\.?0*\s*/\s*(?:2\.[1-5]\d*|\w*gamma\w*)|0?\.4[0-9]\d*)\s*\)?", re.I)
_DECODER_NAME = re.compile(r"srgb_?to|from_?srgb|to_?linear|linearize|degamma|decode_?(srgb|gamma|color|colour)", re.I)
_ENCODER_NAME = re.compile(r"(to|encode)_?(srgb|gamma|display)|linear_?to_?srgb|gamma_?(correct|encode)", re.I)
_LAST_WORD = re.compile(r"(\w+)\s*$")
_LONGEST = 256  # characters of a name
_ENOUGH = 3  # times that a colour is decoded: more say nothing more


@dataclass(frozen=True)
class Function:
    """A function of the text: names of its parameters, where its body begins and ends."""

    name: str
    parameters: tuple[str, ...]
    start: int
    end: int


@lru_cache(maxsize=64)
def functions(text: str) -> tuple[Function, ...]:
    """The functions of a preprocessed text, in order."""
    found = []
    for match in _FUNCTION.finditer(text):
        end = closing(text, match.end() - 1)
        if end is not None:
            names = tuple(re.findall(r"(\w+)\s*(?:\[[^\]]*\])?\s*(?:,|$)", match[2]))
            found.append(Function(match[1], names, match.end(), end))
    return tuple(found)


def _powers(text: str, start: int, end: int, exponent: re.Pattern) -> list[str]:
    """The bases of the pow() between two places with such an exponent."""
    return [
        base
        for match in re.finditer(r"\bpow\s*\(", text[start:end])
        if (base := _base(text, start + match.end() - 1, exponent)) is not None
    ]


def _base(text: str, bracket: int, exponent: re.Pattern) -> str | None:
    """The base of a pow() whose bracket opens there, None where the exponent is another."""
    arguments = text[bracket + 1 : closing(text, bracket)]
    depth = 0
    for k in range(len(arguments) - 1, -1, -1):
        depth += {")": 1, "(": -1}.get(arguments[k], 0)
        if arguments[k] == "," and depth == 0:
            return arguments[:k] if exponent.fullmatch(arguments[k + 1 :].strip()) else None
    return None


def _is_decoder(text: str, function: Function) -> bool:
    if _ENCODER_NAME.search(function.name):
        return False
    bases = _powers(text, function.start, function.end, _DECODING)
    return bool(_DECODER_NAME.search(function.name)) or any(
        re.search(rf"\b{name}\b", base) for base in bases for name in function.parameters
    )


@lru_cache(maxsize=64)
def _decoders(text: str) -> frozenset[str]:
    """The functions of the text that turn stored colours into linear ones."""
    return frozenset(f.name for f in functions(text) if _is_decoder(text, f))


@lru_cache(maxsize=64)
def reached(text: str) -> frozenset[str]:
    """The functions that main calls, directly or not."""
    by_name: dict[str, list[Function]] = {}
    for f in functions(text):
        by_name.setdefault(f.name, []).append(f)
    names, todo = {"main"}, ["main"]
    while todo:
        for f in by_name.get(todo.pop(), ()):
            for called in set(re.findall(r"\b(\w+)\s*\(", text[f.start : f.end])) & set(by_name) - names:
                names.add(called)
                todo.append(called)
    return frozenset(names)


def encodes(text: str) -> bool:
    """Whether the shader turns linear colours into stored ones somewhere that main reaches."""
    return any(
        _ENCODER_NAME.search(f.name) or _powers(text, f.start, f.end, _ENCODING)
        for f in functions(text)
        if f.name in reached(text)
    )


def lights(text: str) -> bool:
    """Whether main reaches what looks like light on a surface."""
    return any(re.search(r"\bdot\s*\(", text[f.start : f.end]) for f in functions(text) if f.name in reached(text))


@lru_cache(maxsize=64)
def decodes(text: str, sampler: str) -> int | None:
    """How many times the colours of a sampler are decoded, on the way where most; None where it is not sampled."""
    todo = [(position, 0) for position in _samples(text, sampler)]
    seen, most = set(todo), 0
    if not todo:
        return None
    while todo:
        count, reached_next = _follow(text, *todo.pop())
        most = max(most, count)
        new = {(position, n) for position, n in reached_next if n <= _ENOUGH} - seen
        seen |= new
        todo += new
    return most


def role(text: str, sampler: str) -> str | None:
    """The role of a sampler by the first variable or function that its texels go to and that has a telling name."""
    for position in _samples(text, sampler):
        calls, target = [name for name, _ in _calls(text, position)], _target(text, position)
        for name in (*calls, target):
            if name and name not in _decoders(text) and (found := roles.of_name(name)):
                return found
    return None


def _samples(text: str, sampler: str) -> list[int]:
    alive = reached(text)
    return [
        m.start()
        for m in re.finditer(_SAMPLE.format(re.escape(sampler)), text)
        if any(f.start <= m.start() < f.end and f.name in alive for f in functions(text))
    ]


def _calls(text: str, position: int) -> list[tuple[str, int]]:
    """The functions whose arguments a position is in, innermost first, with where their brackets open."""
    found, depth, k = [], 0, position - 1
    while k >= 0 and not (depth == 0 and text[k] in ";{}"):
        if text[k] in ")]":
            depth += 1
        elif text[k] in "([":
            if depth == 0 and text[k] == "(" and (name := _LAST_WORD.search(text[max(k - _LONGEST, 0) : k])):
                found.append((name[1], k))
            depth = max(depth - 1, 0)
        k -= 1
    return found


def _target(text: str, position: int) -> str:
    """What the statement at a position assigns to, "return" for what a function returns, or ""."""
    before = text[max(text.rfind(mark, 0, position) for mark in ";{}") + 1 : position]
    if re.match(r"\s*return\b", before):
        return "return"
    target = re.match(r"\s*(?:const\s+)?(?:\w+\s+)?([\w.]+(?:\[[^\]]*\])?)\s*[-+*/]?=(?!=)", before)
    return target[1] if target else ""


def _argument(text: str, start: int, position: int) -> int:
    """Which argument of the call whose bracket opens at ``start`` a position is in."""
    depth, count = 0, 0
    for character in text[start + 1 : position]:
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(character, 0)
        count += character == "," and depth == 0
    return count


def _follow(text: str, position: int, count: int) -> tuple[int, list[tuple[int, int]]]:
    """How many times the value at a position is decoded when its statement ends, having been so ``count`` times, and
    where it goes from there: (position, times)."""
    onward: list[tuple[int, int]] = []
    own = {f.name: f for f in functions(text)}
    for name, bracket in _calls(text, position):
        if name in _decoders(text) or (name == "pow" and _base(text, bracket, _DECODING) is not None):
            count += 1
        elif name in own:
            k = _argument(text, bracket, position)
            if k < len(own[name].parameters):
                onward += [(at, count) for at in _uses(text, own[name], own[name].parameters[k], own[name].start)]
    inside = next((f for f in functions(text) if f.start <= position < f.end), None)
    if inside is None:
        return count, onward
    target = _target(text, position)
    if target == "return":
        for match in re.finditer(rf"\b{inside.name}\s*\(", text):
            if any(f.start <= match.start() < f.end for f in functions(text) if f is not inside):
                onward.append((match.start(), count))
    elif target and "." not in target.replace(".rgb", "").replace(".xyz", ""):
        name = re.match(r"\w+", target)[0]
        onward += [(at, count) for at in _uses(text, inside, name, text.find(";", position))]
    return count, onward


def _uses(text: str, function: Function, name: str, start: int) -> list[int]:
    """Where a function reads one of its variables, from ``start`` on."""
    pattern = rf"(?<![\w.]){name}\b(?!\s*(?:\.\w+\s*)?=(?!=))"
    return [start + match.start() for match in re.finditer(pattern, text[start : function.end])]
