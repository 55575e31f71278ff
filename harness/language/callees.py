"""Which of a text's own functions a call means, and what it wants for arguments."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import accumulate

from .tokens import Statement, Text, is_type


@dataclass(frozen=True)
class _Overload:
    """A function: which of the text's it is, in order, and its parameters' types, None for out, inout and samplers."""

    number: int
    kinds: tuple[str | None, ...]


Parameters = dict[tuple[str, int], list[_Overload]]
_CALLED = re.compile(r"^0:(\d+) +Function (Call|Definition): (\w+)\((\S*)", re.MULTILINE)


def has_overloads(text: str) -> bool:
    """Whether a text has overloads that only the compiler can tell apart, of as many parameters."""
    code = Text(text)
    return any(len(found) > 1 for found in parameters(code, code.statements(), set(code.struct_names())).values())


def parameters(code: Text, statements: Collection[Statement], structs: Collection[str]) -> Parameters:
    """(name, number of parameters) -> the functions of that name and number."""
    found: Parameters = {}
    for number, function in enumerate(s for s in statements if s.body is not None):
        name = code.function_name(function)
        kinds = []
        for first, last in code.listed(code.next(name)):
            words = [code[k] for k in code.solid(first, last)]
            place = next((n for n, word in enumerate(words) if is_type(word, structs)), None)
            if place is None or not {"out", "inout"}.isdisjoint(words[:place]):
                kinds.append(None)
                continue
            of_name = next((n for n in range(place + 1, len(words)) if words[n] not in "[]" and words[n - 1] != "["), 0)
            kinds.append(" ".join([words[place], *words[of_name + 1 :], *words[place + 1 : of_name]]))
        found.setdefault((code[name], len(kinds)), []).append(_Overload(number, tuple(kinds)))
    return found


def called(code: Text, statements: Collection[Statement], tree: str) -> dict[int, int]:
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


def arguments(code: Text, function: Statement, of: Parameters, meant: dict[int, int]) -> Iterator[tuple[int, int, str]]:
    """First and last token, and type, of the arguments in calls of the text's own functions."""
    names = {name for name, _ in of}
    for k in code.at_run_time(function):
        if code[k] in names and code[code.next(k)] == "(":
            given = code.listed(code.next(k))
            found = of.get((code[k], len(given)), [])
            found = [o for o in found if o.number == meant.get(k)] or found
            for n, (first, last) in enumerate(given):
                kinds = {overload.kinds[n] for overload in found}
                if len(kinds) == 1 and (kind := kinds.pop()):
                    yield first, last, kind
