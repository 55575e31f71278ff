"""Forbids the driver to rewrite the arithmetic of preprocessed GLSL, every line staying where it is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from itertools import count, takewhile

from . import callees
from .tokens import ASSIGNMENT, BEFORE_TYPE, CLOSING, PRECISION, Statement, Text, is_type
from .variables import Variables

_NOT_ARITHMETIC = {"uniform", "const", "buffer", "precision", "layout", "in", "out"}
_CONTROL = {"if", "while", "for", "switch"}
_LOGICAL = {"&&", "||", "^^"}
_BEFORE_EXPRESSION = {",", ";", ":", "return", "else", "do", *ASSIGNMENT}

#: prepended by make_precise: a zero that the driver does not know (GL makes it 0), for Mesa folds x * 0.0 and x + 0.0
#: even where they are precise
_ZERO = "uniform float hn_zero; "
_LITERAL_ZERO = re.compile(r"(?=.*[.eE])0*\.?0*([eE][+-]?\d+)?[fF]?$")


def make_precise(text: str, tree: str = "") -> str:
    """The text with everything that can be declared ``precise`` declared so; needs #version 400 or ARB_gpu_shader5.

    A driver follows ``precise`` through assignments to declared variables, and Mesa rearranges what is no assignment
    before it looks further: so all variables are declared precise, and returned values, conditions, indices and
    arguments go through a precise variable each.

    ``tree`` is glslang's dump of the same lines; it tells which overload is called where ``callees.has_overloads``.
    """
    code = Text(text)
    structs = set(code.struct_names())
    statements = code.statements()
    parameters = callees.parameters(code, statements, structs)
    called = callees.called(code, statements, tree)
    zeros = _constants_with_zeros(code, statements)
    variables = Variables(code, statements, structs)
    numbers = count()
    for statement in statements:
        if statement.body is None:
            words = (code[k] for k in code.solid(statement.first, statement.last))
            if _NOT_ARITHMETIC.isdisjoint(takewhile(lambda w: not is_type(w, structs) and w != "struct", words)):
                _declare_precise(code, statement.first, statement.last, structs)
            continue
        parts = [
            *_conditions(code, statement),
            *_decisions(code, statement),
            *callees.arguments(code, statement, parameters, called),
            *variables.components(statement),
        ]
        for first, last, kind in sorted(parts, key=lambda part: part[1] - part[0]):  # the inner ones first
            name = f"hn_{next(numbers)}"
            code.tokens[statement.first].before += f"precise {kind} {name}; "
            code.tokens[first].before = f"({name} = {kind if kind == 'int' else ''}(" + code.tokens[first].before
            code.tokens[last].after += f"), {name})"
        for k in code.at_run_time(statement):
            if code.tokens[k].kind == "number" and _LITERAL_ZERO.match(code[k]):
                code.tokens[k].text = "hn_zero"
            elif code[k] in zeros and code[k] not in variables.of(statement):
                code.tokens[k].text = zeros[code[k]]
        _return_precise(code, statement)
        _declare_precise(code, statement.first, statement.last, structs)
    first = next(code.solid(), None)
    if first is not None:
        code.tokens[first].before = _ZERO + code.tokens[first].before
    return str(code)


def _declare_precise(code: Text, first: int, last: int, structs: Collection[str]) -> None:
    """Puts ``precise`` before each declaration: a type, perhaps with [], and a name that no ``(`` follows."""
    solid = list(code.solid(first, last))
    members_end = -1
    for place, k in enumerate(solid):
        if k <= members_end:
            continue
        if code[k] == "struct":
            members_end = name = code.closing(next(j for j in solid[place:] if code[j] == "{"))
        elif is_type(code[k], structs):
            name = k
        else:
            continue
        name = code.next(name)
        while name is not None and code[name] == "[":
            name = code.next(code.closing(name))
        if name is None or code.tokens[name].kind != "word" or code[code.next(name)] == "(":
            continue
        start = place
        while start and code[solid[start - 1]] in BEFORE_TYPE:
            start -= 1
        if "precise" not in {code[j] for j in solid[start:place]}:
            code.tokens[solid[start]].before += "precise "


def _return_precise(code: Text, function: Statement) -> None:
    """``return E;`` becomes ``{ precise T hn_value = E; return hn_value; }``."""
    head = code.solid(function.first, code.function_name(function) - 1)
    kind = " ".join(code[k] for k in head if code[k] not in {"precise", *PRECISION})
    if kind == "void":
        return
    for k in list(code.solid(function.body, function.last)):
        if code[k] == "return":
            end = next(j for j in code.solid(k) if code[j] == ";")
            code.tokens[k].text = f"{{ precise {kind} hn_value ="
            code.tokens[end].text = "; return hn_value; }"


def _constants_with_zeros(code: Text, statements: Collection[Statement]) -> dict[str, str]:
    """Global constants of floats with a zero in them -> what to write in their place, the zero not known to the driver.

    They stay as they are declared, for where GLSL wants a constant. Arrays are left alone.
    """
    found: dict[str, str] = {}
    for statement in statements:
        solid = list(code.solid(statement.first, statement.last))
        if statement.body is not None or code[solid[0]] != "const":
            continue
        at = next((n for n, k in enumerate(solid) if re.match(r"(float|vec[234]|mat[234](x[234])?)$", code[k])), None)
        if at is None or code[solid[at + 1]] == "[":
            continue
        k = solid[at + 1]
        while k < statement.last:
            name = code[k]
            k = code.next(k)
            if code[k] != "=":
                break
            words = []
            k = code.next(k)
            while code[k] not in (",", ";") or words.count("(") > words.count(")"):
                words.append(found.get(code[k], "hn_zero" if _LITERAL_ZERO.match(code[k]) else code[k]))
                k = code.next(k)
            if any("hn_zero" in word for word in words):
                found[name] = f"({' '.join(words)})"
            k = code.next(k) or statement.last
    return found


def _conditions(code: Text, function: Statement) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of what if, while, for and switch ask. A declaration there is none of them."""
    for k in code.solid(function.body, function.last):
        if code[k] not in _CONTROL:
            continue
        opening = code.next(k)
        first, last = opening + 1, code.closing(opening) - 1
        if code[k] == "for":
            ends = [j for j in code.solid(first, last) if code[j] == ";"]
            first, last = ends[0] + 1, ends[1] - 1
        asked = list(code.solid(first, last))
        if asked and not (code.tokens[asked[0]].kind == "word" and code.tokens[code.next(asked[0])].kind == "word"):
            yield asked[0], asked[-1], "int" if code[k] == "switch" else "bool"


def _decisions(code: Text, function: Statement) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of operands of && || ^^, of what stands before a ?, and of computed indices."""
    outer = []
    start = last = None
    logical = False  # the operand began after && || ^^
    skipped = -1
    for k in code.at_run_time(function):
        word = code[k]
        if k <= skipped:
            continue
        if word == "[":
            skipped = code.closing(k)
            inside = list(code.solid(k + 1, skipped - 1))
            if any(code[j] == "(" for j in inside):
                yield inside[0], inside[-1], "int"
        elif word in CLOSING:
            outer.append((k if start is None else start, logical, last is not None and code[last] in _CONTROL))
            start, logical = None, False
        elif word in CLOSING.values() or word in _BEFORE_EXPRESSION or word in _LOGICAL or word == "?":
            if start is not None and (logical or word in _LOGICAL or word == "?"):
                yield start, last, "bool"
            start, logical = None, word in _LOGICAL
            if word in CLOSING.values():
                start, logical, control = outer.pop()
                if control or word == "}":
                    start, logical = None, False
        elif start is None and word not in _CONTROL:
            start = k
        last = skipped if k < skipped else k
