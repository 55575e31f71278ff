"""Rewrites preprocessed GLSL, token by token, every line staying where it is.

``isolate`` makes a library of an entry point's file; ``make_precise`` forbids the driver to rewrite the arithmetic.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_TOKEN = re.compile(
    r"(?P<directive>^[ \t]*\#[^\n]*)|(?P<space>\s+)|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\w*)|(?P<mark>.)",
    re.MULTILINE,
)
_BUILT_IN_TYPE = re.compile(r"(float|double|u?int|bool|[dbiu]?vec[234]|d?mat[234](x[234])?)$")
_CLOSING = {"(": ")", "{": "}", "[": "]"}
_INTERFACE = {"in", "out", "flat", "smooth", "noperspective", "centroid", "sample"}
_PRECISION = {"highp", "mediump", "lowp"}
_BEFORE_TYPE = {"const", "in", "out", "inout", *_PRECISION}

#: prepended by make_precise: gives a condition the exactness of an argument
_EXACT = "bool hn_exact(precise bool c) { return c; } "


@dataclass
class _Token:
    text: str
    kind: str  # directive, space, word, number or mark


@dataclass
class _Statement:
    """A global declaration: the indices of its first and last token, and of the ``{`` of a function's body."""

    first: int
    last: int
    body: int | None


class _Text:
    """A text as tokens that can be changed in place; white space is a token too, so joined they are the text."""

    def __init__(self, text: str):
        self.tokens = [_Token(match[0], match.lastgroup) for match in _TOKEN.finditer(text)]

    def __str__(self):
        return "".join(token.text for token in self.tokens)

    def __getitem__(self, k: int) -> str:
        return self.tokens[k].text

    def solid(self, first: int = 0, last: int | None = None) -> Iterator[int]:
        """Indices of the tokens from ``first`` to ``last``, both included, that are neither space nor directive."""
        last = len(self.tokens) - 1 if last is None else last
        return (k for k in range(first, last + 1) if self.tokens[k].kind not in ("space", "directive"))

    def next(self, k: int) -> int | None:
        """The solid token after ``k``."""
        return next(self.solid(k + 1), None)

    def closing(self, opening: int) -> int:
        """The bracket that closes the one at ``opening``."""
        depth = 0
        for k in self.solid(opening):
            depth += (self[k] in _CLOSING) - (self[k] in _CLOSING.values())
            if depth == 0:
                return k
        return len(self.tokens) - 1

    def statements(self) -> list[_Statement]:
        """The global declarations, in order."""
        found = []
        first = before = None
        k = next(self.solid(), None)
        while k is not None:
            first = k if first is None else first
            last = k
            if self[k] in _CLOSING:
                last = self.closing(k)
                if self[k] == "{" and before is not None and self[before] == ")":
                    found.append(_Statement(first, last, k))
                    first = None
            elif self[k] == ";":
                found.append(_Statement(first, k, None))
                first = None
            before, k = last, self.next(last)
        return found

    def blank(self, first: int, last: int) -> None:
        """Removes tokens, keeping their line breaks."""
        for k in range(first, last + 1):
            self.tokens[k].text = "\n" * self[k].count("\n")

    def struct_names(self) -> list[str]:
        """The global structures."""
        return [self[self.next(s.first)] for s in self.statements() if self[s.first] == "struct"]


def struct_names(text: str) -> list[str]:
    """The structures that a preprocessed text declares globally, in order."""
    return _Text(text).struct_names()


def isolate(text: str) -> str:
    """The text without main(), and with its inputs and outputs made plain global variables.

    What is left can be evaluated in a stage of ours, whose inputs and outputs are our own.
    """
    code = _Text(text)
    for statement in code.statements():
        if statement.body is not None:
            name = code.next(statement.first)
            if code[name] == "main":
                code.blank(statement.first, statement.last)
            continue
        dropped, k = [], statement.first
        while code[k] in _INTERFACE or code[k] == "layout" or code[k] in _PRECISION:
            end = code.closing(code.next(k)) if code[k] == "layout" else k
            dropped.append((k, end))
            k = code.next(end)
        if not any(code[a] in ("in", "out") for a, _ in dropped) or code[code.next(k)] == "{":
            continue
        for a, b in dropped:
            code.blank(a, b)
        if code[k] == ";":
            code.blank(k, k)
    return str(code)


def make_precise(text: str) -> str:
    """The text with everything that can be declared ``precise`` declared so; needs #version 400 or ARB_gpu_shader5.

    A driver follows ``precise`` through assignments to declared variables, not into parameters, returned values and
    conditions: parameters are declared precise, a returned value goes through a precise variable, a condition through a
    precise parameter.
    """
    code = _Text(text)
    structs = set(code.struct_names())
    for statement in code.statements():
        leading = {code[k] for k in code.solid(statement.first, statement.last)}
        if statement.body is None:
            if not leading & {"uniform", "struct", "const", "buffer", "precision", "layout", "in", "out"}:
                _declare_precise(code, statement.first, statement.last, structs)
            continue
        _return_precise(code, statement)
        _condition_precise(code, statement)
        _declare_precise(code, statement.first, statement.last, structs)
    first = next(code.solid(), None)
    if first is not None:
        code.tokens[first].text = _EXACT + code[first]
    return str(code)


def _declare_precise(code: _Text, first: int, last: int, structs: set[str]) -> None:
    """Puts ``precise`` before each declaration: a type, perhaps with [], and a name that no ``(`` follows."""
    solid = list(code.solid(first, last))
    for place, k in enumerate(solid):
        if not (_BUILT_IN_TYPE.match(code[k]) or code[k] in structs):
            continue
        name = code.next(k)
        while name is not None and code[name] == "[":
            name = code.next(code.closing(name))
        if name is None or code.tokens[name].kind != "word" or code[code.next(name)] == "(":
            continue
        while place and code[solid[place - 1]] in _BEFORE_TYPE:
            place -= 1
        code.tokens[solid[place]].text = "precise " + code[solid[place]]


def _return_precise(code: _Text, function: _Statement) -> None:
    """``return E;`` becomes ``{ precise T hn_value = E; return hn_value; }``."""
    head = list(code.solid(function.first, function.body))
    name = next(k for k in head if code[code.next(k)] == "(")
    kind = "".join(code[k] + " " for k in head if k < name and code[k] not in _PRECISION)
    if kind == "void ":
        return
    for k in list(code.solid(function.body, function.last)):
        if code[k] == "return":
            end = next(j for j in code.solid(k) if code[j] == ";")
            code.tokens[k].text = f"{{ precise {kind}hn_value ="
            code.tokens[end].text = "; return hn_value; }"


def _condition_precise(code: _Text, function: _Statement) -> None:
    """The conditions of if, while and for become arguments of hn_exact()."""
    for k in list(code.solid(function.body, function.last)):
        if code[k] not in ("if", "while", "for"):
            continue
        opening = code.next(k)
        first, last = opening + 1, code.closing(opening) - 1
        if code[k] == "for":
            ends = [j for j in code.solid(first, last) if code[j] == ";"]
            first, last = ends[0] + 1, ends[1] - 1
        inside = list(code.solid(first, last))
        if inside:
            code.tokens[inside[0]].text = "hn_exact(" + code[inside[0]]
            code.tokens[inside[-1]].text += ")"
