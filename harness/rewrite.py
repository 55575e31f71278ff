"""Rewrites preprocessed GLSL, token by token, every line staying where it is.

``isolate`` makes a library of an entry point's file; ``make_precise`` forbids the driver to rewrite the arithmetic.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import count, takewhile

_TOKEN = re.compile(
    r"(?P<directive>^[ \t]*\#[^\n]*)|(?P<space>\s+)|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\w*)"
    r"|(?P<mark><<=|>>=|<<|>>|&&|\|\||\^\^|\+\+|--|[-+*/%&|^<>=!]=|.)",
    re.MULTILINE,
)
_BUILT_IN_TYPE = re.compile(r"(float|double|u?int|bool|[dbiu]?vec[234]|d?mat[234](x[234])?)$")
_CLOSING = {"(": ")", "{": "}", "[": "]"}
_INTERFACE = {"in", "out", "flat", "smooth", "noperspective", "centroid", "sample", "invariant", "precise"}
_PRECISION = {"highp", "mediump", "lowp"}
_BEFORE_TYPE = {"const", "in", "out", "inout", "precise", *_PRECISION}
_NOT_ARITHMETIC = {"uniform", "const", "buffer", "precision", "layout", "in", "out"}
_CONTROL = {"if", "while", "for", "switch"}
_LOGICAL = {"&&", "||", "^^"}
_ASSIGNMENT = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
_BEFORE_EXPRESSION = {",", ";", ":", "return", "else", "do", *_ASSIGNMENT}

#: prepended by make_precise: a zero that the driver does not know (GL makes it 0), for Mesa folds x * 0.0 and x + 0.0
#: even where they are precise
_ZERO = "uniform float hn_zero; "
_LITERAL_ZERO = re.compile(r"(?=.*[.eE])0*\.?0*([eE][+-]?\d+)?[fF]?$")


@dataclass
class _Token:
    text: str
    kind: str  # directive, space, word, number or mark
    before: str = ""  # what is put around it
    after: str = ""


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
        return "".join(token.before + token.text + token.after for token in self.tokens)

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

    def listed(self, opening: int) -> list[tuple[int, int]]:
        """First and last token of what stands between the commas of a list in brackets."""
        end = self.closing(opening)
        parts, inside, skipped = [], [], opening
        for k in self.solid(opening + 1, end):
            if k <= skipped:
                continue
            if self[k] in (",", self[end]):
                if inside:
                    parts.append((inside[0], inside[-1]))
                inside = []
                continue
            inside.append(k)
            if self[k] in _CLOSING:
                skipped = self.closing(k)
                inside.append(skipped)
        return parts

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

    def struct_names(self, first: int = 0, last: int | None = None) -> list[str]:
        """The structures declared between two tokens, those without a name left out."""
        names = (self.next(k) for k in self.solid(first, last) if self[k] == "struct")
        return [self[k] for k in names if k is not None and self.tokens[k].kind == "word"]

    def function_name(self, function: _Statement) -> int:
        """Where the name of a function stands."""
        named = (k for k in self.solid(function.first, function.body) if self[self.next(k)] == "(")
        return next(named, function.first)


def struct_names(text: str) -> list[str]:
    """The structures that a preprocessed text declares globally, in order."""
    code = _Text(text)
    return [name for s in code.statements() if s.body is None for name in code.struct_names(s.first, s.last)]


def result_names(text: str) -> list[str]:
    """The name of the type that each function of a preprocessed text returns, [] left out, in order."""
    code = _Text(text)
    names = []
    for function in code.statements():
        if function.body is not None:
            before = code.solid(function.first, code.function_name(function) - 1)
            words = [code[k] for k in before if code.tokens[k].kind == "word"]
            names.append(words[-1] if words else "")
    return names


def isolate(text: str) -> str:
    """The text without main(), and with its inputs and outputs made plain global variables.

    What is left can be evaluated in a stage of ours, whose inputs and outputs are our own. Uniform blocks get packed,
    for a driver takes all members of others for active, read or not.
    """
    code = _Text(text)
    for statement in code.statements():
        if statement.body is not None:
            if code[code.function_name(statement)] == "main":
                code.blank(statement.first, statement.last)
            continue
        head = list(takewhile(lambda k: code[k] not in ("{", ";", "="), code.solid(statement.first, statement.last)))
        words = {code[k] for k in head}
        if "uniform" in words and "struct" not in words and code[code.next(head[-1])] == "{":
            for k in (k for k in head if code[k] == "layout"):
                code.blank(k, code.closing(code.next(k)))
            code.tokens[statement.first].before = "layout(packed) "
        dropped, k = [], statement.first
        while code[k] in _INTERFACE or code[k] == "layout" or code[k] in _PRECISION:
            end = code.closing(code.next(k)) if code[k] == "layout" else k
            dropped.append((k, end))
            k = code.next(end)
        qualifiers = {code[a] for a, _ in dropped}
        after = code[code.next(k)] if k < statement.last else ""
        if qualifiers and (code[k].startswith("gl_") or after.startswith("gl_")):
            code.blank(statement.first, statement.last)  # redeclares a variable of the stage
        elif "invariant" in qualifiers and after in (",", ";"):
            code.blank(statement.first, statement.last)  # of an output that is none any more
        if not qualifiers & {"in", "out"} or after == "{":
            continue
        for a, b in dropped:
            code.blank(a, b)
        if code[k] == ";":
            code.blank(k, k)
    return str(code)


def make_precise(text: str) -> str:
    """The text with everything that can be declared ``precise`` declared so; needs #version 400 or ARB_gpu_shader5.

    A driver follows ``precise`` through assignments to declared variables, and Mesa rearranges what is no assignment
    before it looks further: so all variables are declared precise, and returned values, conditions, indices and
    arguments go through a precise variable each.

    Two places are left to the driver, for their type is not known here: an argument where overloads of as many
    parameters take different types, and what is assigned to a component of a vector by an index known at run time only.
    """
    code = _Text(text)
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


def _declare_precise(code: _Text, first: int, last: int, structs: Collection[str]) -> None:
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


def _return_precise(code: _Text, function: _Statement) -> None:
    """``return E;`` becomes ``{ precise T hn_value = E; return hn_value; }``."""
    head = code.solid(function.first, code.function_name(function) - 1)
    kind = " ".join(code[k] for k in head if code[k] not in {"precise", *_PRECISION})
    if kind == "void":
        return
    for k in list(code.solid(function.body, function.last)):
        if code[k] == "return":
            end = next(j for j in code.solid(k) if code[j] == ";")
            code.tokens[k].text = f"{{ precise {kind} hn_value ="
            code.tokens[end].text = "; return hn_value; }"


def _parameters(
    code: _Text, statements: Collection[_Statement], structs: Collection[str]
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
    code: _Text, function: _Statement, parameters: dict[tuple[str, int], list[str | None]]
) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of the arguments in calls of the text's own functions."""
    names = {name for name, _ in parameters}
    for k in _at_run_time(code, function):
        if code[k] in names and code[code.next(k)] == "(":
            arguments = code.listed(code.next(k))
            for (first, last), kind in zip(arguments, parameters.get((code[k], len(arguments)), ()), strict=False):
                if kind:
                    yield first, last, kind


def _conditions(code: _Text, function: _Statement) -> Iterator[tuple[int, int, str]]:
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


def _at_run_time(code: _Text, function: _Statement) -> Iterator[int]:
    """The solid tokens of a function's body, without what has to be constant: after ``const`` and ``case``."""
    skipped = -1
    for k in code.solid(function.body, function.last):
        if code[k] in ("const", "case"):
            skipped = next(j for j in code.solid(k) if code[j] == (";" if code[k] == "const" else ":"))
        if k > skipped:
            yield k


def _decisions(code: _Text, function: _Statement) -> Iterator[tuple[int, int, str]]:
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
        elif word in _CLOSING:
            outer.append((k if start is None else start, logical, last is not None and code[last] in _CONTROL))
            start, logical = None, False
        elif word in _CLOSING.values() or word in _BEFORE_EXPRESSION or word in _LOGICAL or word == "?":
            if start is not None and (logical or word in _LOGICAL or word == "?"):
                yield start, last, "bool"
            start, logical = None, word in _LOGICAL
            if word in _CLOSING.values():
                start, logical, control = outer.pop()
                if control or word == "}":
                    start, logical = None, False
        elif start is None and word not in _CONTROL:
            start = k
        last = skipped if k < skipped else k
