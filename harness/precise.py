"""Forbids the driver to rewrite the arithmetic of preprocessed GLSL, every line staying where it is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import accumulate, count, takewhile

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


def make_precise(text: str, tree: str = "") -> str:
    """The text with everything that can be declared ``precise`` declared so; needs #version 400 or ARB_gpu_shader5.

    A driver follows ``precise`` through assignments to declared variables, and Mesa rearranges what is no assignment
    before it looks further: so all variables are declared precise, and returned values, conditions, indices and
    arguments go through a precise variable each.

    ``tree`` is glslang's dump of the same lines; it tells which overload is called where ``has_overloads``.
    """
    code = Text(text)
    structs = set(code.struct_names())
    statements = code.statements()
    parameters = _parameters(code, statements, structs)
    called = _called(code, statements, tree)
    zeros = _constants_with_zeros(code, statements)
    variables = _Variables(code, statements, structs)
    numbers = count()
    for statement in statements:
        if statement.body is None:
            words = (code[k] for k in code.solid(statement.first, statement.last))
            if _NOT_ARITHMETIC.isdisjoint(takewhile(lambda w: not _is_type(w, structs) and w != "struct", words)):
                _declare_precise(code, statement.first, statement.last, structs)
            continue
        parts = [
            *_conditions(code, statement),
            *_decisions(code, statement),
            *_arguments(code, statement, parameters, called),
            *variables.components(statement),
        ]
        for first, last, kind in sorted(parts, key=lambda part: part[1] - part[0]):  # the inner ones first
            name = f"hn_{next(numbers)}"
            code.tokens[statement.first].before += f"precise {kind} {name}; "
            code.tokens[first].before = f"({name} = {kind if kind == 'int' else ''}(" + code.tokens[first].before
            code.tokens[last].after += f"), {name})"
        for k in _at_run_time(code, statement):
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


@dataclass(frozen=True)
class _Overload:
    """A function: which of the text's it is, in order, and its parameters' types, None for out, inout and samplers."""

    number: int
    kinds: tuple[str | None, ...]


_Parameters = dict[tuple[str, int], list[_Overload]]
_CALLED = re.compile(r"^0:(\d+) +Function (Call|Definition): (\w+)\((\S*)", re.MULTILINE)


def has_overloads(text: str) -> bool:
    """Whether a text has overloads that only the compiler can tell apart, of as many parameters."""
    code = Text(text)
    return any(len(found) > 1 for found in _parameters(code, code.statements(), set(code.struct_names())).values())


def _parameters(code: Text, statements: Collection[Statement], structs: Collection[str]) -> _Parameters:
    """(name, number of parameters) -> the functions of that name and number."""
    found: _Parameters = {}
    for number, function in enumerate(s for s in statements if s.body is not None):
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
        found.setdefault((code[name], len(kinds)), []).append(_Overload(number, tuple(kinds)))
    return found


def _called(code: Text, statements: Collection[Statement], tree: str) -> dict[int, int]:
    """Token of a function's name where it is called -> which of the text's functions it is, in order.

    The dump has the calls by the line of their closing bracket, the outer before the inner.
    """
    entries = [(int(m[1]), m[2], m[3], m[4]) for m in _CALLED.finditer(tree)]
    numbers = {entry[2:]: n for n, entry in enumerate(e for e in entries if e[1] == "Definition")}
    dumped: dict[tuple[int, str], list[int | None]] = {}
    for line, what, name, mangled in entries:
        if what == "Call":
            dumped.setdefault((line, name), []).append(numbers.get((name, mangled)))
    names = {name for _, name in dumped}
    lines = list(accumulate((token.text.count("\n") for token in code.tokens), initial=1))
    written: dict[tuple[int, str], list[int]] = {}
    for function in statements:
        if function.body is not None:
            for k in code.solid(function.body, function.last):
                if code[k] in names and code[code.next(k)] == "(":
                    written.setdefault((lines[code.closing(code.next(k))], code[k]), []).append(k)
    return {
        k: number
        for place, tokens in written.items()
        if len(tokens) == len(dumped.get(place, ()))
        for k, number in zip(tokens, dumped[place], strict=True)
        if number is not None
    }


def _arguments(
    code: Text, function: Statement, parameters: _Parameters, called: dict[int, int]
) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of the arguments in calls of the text's own functions."""
    names = {name for name, _ in parameters}
    for k in _at_run_time(code, function):
        if code[k] in names and code[code.next(k)] == "(":
            arguments = code.listed(code.next(k))
            found = parameters.get((code[k], len(arguments)), [])
            found = [o for o in found if o.number == called.get(k)] or found
            for n, (first, last) in enumerate(arguments):
                kinds = {overload.kinds[n] for overload in found}
                if len(kinds) == 1 and (kind := kinds.pop()):
                    yield first, last, kind


class _Variables:
    """The types of a text's variables, as far as its declarations tell: a base type and its dimensions.

    A name that is declared with several types, in one function or globally, has none.
    """

    def __init__(self, code: Text, statements: Collection[Statement], structs: Collection[str]):
        self._code, self._structs = code, structs
        self._members: dict[str, dict[str, str | None]] = {}
        for k in code.solid():
            if code[k] == "struct" and code[code.next(k)] in structs:
                opening = code.next(code.next(k))
                self._members[code[code.next(k)]] = self._declared(opening, code.closing(opening))
        self._globals: dict[str, str | None] = {}
        for statement in statements:
            if statement.body is None:
                self._globals |= self._declared(statement.first, statement.last)
        self._locals: dict[int, dict[str, str | None]] = {}

    def of(self, function: Statement) -> dict[str, str | None]:
        """Name -> type of a function's parameters and variables; None where it has several."""
        if function.first not in self._locals:
            start = self._code.next(self._code.function_name(function))
            self._locals[function.first] = self._declared(start, function.last)
        return self._locals[function.first]

    def _declared(self, first: int, last: int) -> dict[str, str | None]:
        """Declarations between two tokens. A dimension is written [], before and after the name alike."""
        code = self._code
        found: dict[str, str | None] = {}
        k = next(code.solid(first, last), None)
        while k is not None and k < last:
            kind = code[k]
            after = code.next(k)
            if not _is_type(kind, self._structs):
                k = after
                continue
            k = after
            while code[k] == "[":
                kind += "[]"
                k = code.next(code.closing(k))
            while k < last and code.tokens[k].kind == "word" and code[code.next(k)] != "(":
                name, whole = code[k], kind
                k = code.next(k)
                while code[k] == "[":
                    whole += "[]"
                    k = code.next(code.closing(k))
                found[name] = whole if found.get(name, whole) == whole else None
                while k < last and code[k] not in (",", ";", ")"):  # an initialiser
                    k = code.next(code.closing(k) if code[k] in CLOSING else k)
                if code[k] != ",":
                    break
                k = code.next(k)
                if _is_type(code[k], self._structs) or code[k] in _BEFORE_TYPE:
                    break  # the next parameter
        return found

    def components(self, function: Statement) -> Iterator[tuple[int, int, str]]:
        """First and last token, and type, of what is assigned to a component of a vector by an index at run time."""
        code = self._code
        known = self._globals | self.of(function)
        before = ""
        for k in code.solid(function.body, function.last):
            kind = known.get(code[k]) if before != "." else None
            before = code[k]
            by_index = False
            k = code.next(k)
            while kind and k is not None and code[k] in ("[", "."):
                end = code.closing(k) if code[k] == "[" else code.next(k)
                by_index = False
                if code[k] == ".":
                    kind = self._member(kind, code[end])
                elif kind.endswith("[]"):
                    kind = kind[:-2]
                elif kind.startswith("mat"):
                    kind = f"vec{kind[-1]}"
                elif kind.startswith("vec"):
                    by_index = code.next(k) != end and not (
                        code.tokens[code.next(k)].kind == "number" and code.next(code.next(k)) == end
                    )
                    kind = "float"
                else:
                    kind = None
                k = code.next(end)
            if kind == "float" and by_index and code[k] in _ASSIGNMENT:
                first, end = code.next(k), k
                while code[code.next(end)] not in (",", ";", ")"):
                    end = code.next(end)
                    end = code.closing(end) if code[end] in CLOSING else end
                yield first, end, "float"

    def _member(self, kind: str, name: str) -> str | None:
        if kind in self._members:
            return self._members[kind].get(name)
        return (f"vec{len(name)}" if len(name) > 1 else "float") if kind.startswith("vec") else None


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
