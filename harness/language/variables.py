"""The types of a text's variables, and of what is assigned to their parts."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from .tokens import ASSIGNMENT, BEFORE_TYPE, CLOSING, Statement, Text, is_type


class Variables:
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
            if not is_type(kind, self._structs):
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
                if is_type(code[k], self._structs) or code[k] in BEFORE_TYPE:
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
            if kind == "float" and by_index and code[k] in ASSIGNMENT:
                first, end = code.next(k), k
                while code[code.next(end)] not in (",", ";", ")"):
                    end = code.next(end)
                    end = code.closing(end) if code[end] in CLOSING else end
                yield first, end, "float"

    def _member(self, kind: str, name: str) -> str | None:
        if kind in self._members:
            return self._members[kind].get(name)
        return (f"vec{len(name)}" if len(name) > 1 else "float") if kind.startswith("vec") else None
