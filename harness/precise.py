"""Forbids the driver to rewrite the arithmetic of preprocessed GLSL, every line staying where it is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from itertools import count, takewhile

from .rewrite import PRECISION
from .tokens import CLOSING, Statement, Text

_BUILT_IN_TYPE = re.compile(r"(float|double|u?int|bool|[dbiu]?vec[234]|d?mat[234](x[234])?)$")
_BEFORE_TYPE = {"const", "in", "out", "inout", "precise", *PRECISION}
_NOT_ARITHMETIC = {"uniform", "const", "buffer", "precision", "layout", "in", "out"}
_CONTROL = {"if", "while", "for", "switch"}
_LOGICAL = {"&&", "||", "^^"}
_ASSIGNMENT = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
_BEFORE_EXPRESSION = {",", ";", ":", "return", "else", "do", *_ASSIGNMENT}

#: prepended by make_precise: a zero that the driver does not know (GL makes it 0), for Mesa folds x * 0.0 and x + 0.0
#: even where they are precise
_ZERO = "uniform float hn_zero; "
_LITERAL_ZERO = re.compile(r"(?=.*[.eE])0*\.?0*([eE][+-]?\d+)?[fF]?$")


def make_precise(text: str) -> str:
    """The text with everything that can be declared ``precise`` declared so; needs #version 400 or ARB_gpu_shader5.

    A driver follows ``precise`` through assignments to declared variables, and Mesa rearranges what is no assignment
    before it looks further: so all variables are declared precise, and returned values, conditions, indices and
    arguments go through a precise variable each.

    Two places are left to the driver, for their type is not known here: an argument where overloads of as many
    parameters take different types, and what is assigned to a component of a vector by an index known at run time only.
    """
    code = Text(text)
    structs = set(code.struct_names())
    statements = code.statements()
    parameters = _parameters(code, statements, structs)
    numbers = count()
    for statement in statements:
        if statement.body is None:
            words = (code[k] for k in code.solid(statement.first, statement.last))
            if _NOT_ARITHMETIC.isdisjoint(takewhile(lambda w: not _is_type(w, structs) and w != "struct", words)):
                _declare_precise(code, statement.first, statement.last, structs)
            continue
        parts = [*_conditions(code, statement), *_decisions(code, statement), *_arguments(code, statement, parameters)]
        for first, last, kind in sorted(parts, key=lambda part: part[1] - part[0]):  # the inner ones first
            name = f"hn_{next(numbers)}"
            code.tokens[statement.first].before += f"precise {kind} {name}; "
            code.tokens[first].before = f"({name} = {kind if kind == 'int' else ''}(" + code.tokens[first].before
            code.tokens[last].after += f"), {name})"
        for k in _at_run_time(code, statement):
            if code.tokens[k].kind == "number" and _LITERAL_ZERO.match(code[k]):
                code.tokens[k].text = "hn_zero"
        _return_precise(code, statement)
        _declare_precise(code, statement.first, statement.last, structs)
    first = next(code.solid(), None)
    if first is not None:
        code.tokens[first].before = _ZERO + code.tokens[first].before
    return str(code)


def _is_type(word: str, structs: Collection[str]) -> bool:
    return bool(_BUILT_IN_TYPE.match(word)) or word in structs


def _declare_precise(code: Text, first: int, last: int, structs: Collection[str]) -> None:
    """Puts ``precise`` before each declaration: a type, perhaps with [], and a name that no ``(`` follows."""
    solid = list(code.solid(first, last))
    members_end = -1
    for place, k in enumerate(solid):
        if k <= members_end:
            continue
        if code[k] == "struct":
            members_end = name = code.closing(next(j for j in solid[place:] if code[j] == "{"))
        elif _is_type(code[k], structs):
            name = k
        else:
            continue
        name = code.next(name)
        while name is not None and code[name] == "[":
            name = code.next(code.closing(name))
        if name is None or code.tokens[name].kind != "word" or code[code.next(name)] == "(":
            continue
        start = place
        while start and code[solid[start - 1]] in _BEFORE_TYPE:
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


def _parameters(
    code: Text, statements: Collection[Statement], structs: Collection[str]
) -> dict[tuple[str, int], list[str | None]]:
    """(name, number of parameters) of the functions -> types; None for out, inout, samplers, and where two differ."""
    found = {}
    for function in statements:
        if function.body is None:
            continue
        name = code.function_name(function)
        kinds = []
        for first, last in code.listed(code.next(name)):
            words = [code[k] for k in code.solid(first, last)]
            place = next((n for n, word in enumerate(words) if _is_type(word, structs)), None)
            if place is None or not {"out", "inout"}.isdisjoint(words[:place]):
                kinds.append(None)
                continue
            of_name = next((n for n in range(place + 1, len(words)) if words[n] not in "[]" and words[n - 1] != "["), 0)
            kinds.append(" ".join([words[place], *words[of_name + 1 :], *words[place + 1 : of_name]]))
        known = found.setdefault((code[name], len(kinds)), kinds)
        known[:] = [a if a == b else None for a, b in zip(known, kinds, strict=True)]
    return found


def _arguments(
    code: Text, function: Statement, parameters: dict[tuple[str, int], list[str | None]]
) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of the arguments in calls of the text's own functions."""
    names = {name for name, _ in parameters}
    for k in _at_run_time(code, function):
        if code[k] in names and code[code.next(k)] == "(":
            arguments = code.listed(code.next(k))
            for (first, last), kind in zip(arguments, parameters.get((code[k], len(arguments)), ()), strict=False):
                if kind:
                    yield first, last, kind


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


def _at_run_time(code: Text, function: Statement) -> Iterator[int]:
    """The solid tokens of a function's body, without what has to be constant: after ``const`` and ``case``."""
    skipped = -1
    for k in code.solid(function.body, function.last):
        if code[k] in ("const", "case"):
            skipped = next(j for j in code.solid(k) if code[j] == (";" if code[k] == "const" else ":"))
        if k > skipped:
            yield k


def _decisions(code: Text, function: Statement) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of operands of && || ^^, of what stands before a ?, and of computed indices."""
    outer = []
    start = last = None
    logical = False  # the operand began after && || ^^
    skipped = -1
    for k in _at_run_time(code, function):
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
