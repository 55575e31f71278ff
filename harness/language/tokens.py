"""GLSL as tokens that can be changed in place, and the statements that they make."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass

_TOKEN = re.compile(
    r"(?P<directive>^[ \t]*\#[^\n]*)|(?P<space>\s+)|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\w*)"
    r"|(?P<mark><<=|>>=|<<|>>|&&|\|\||\^\^|\+\+|--|[-+*/%&|^<>=!]=|.)",
    re.MULTILINE,
)
_BUILT_IN_TYPE = re.compile(r"(float|double|u?int|bool|[dbiu]?vec[234]|d?mat[234](x[234])?)$")
PRECISION = {"highp", "mediump", "lowp"}
BEFORE_TYPE = {"const", "in", "out", "inout", "precise", *PRECISION}
ASSIGNMENT = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
CLOSING = {"(": ")", "{": "}", "[": "]"}


@dataclass
class Token:
    """A piece of the text; ``kind`` is directive, space, word, number or mark."""

    text: str
    kind: str
    before: str = ""  # what is put around it
    after: str = ""


@dataclass
class Statement:
    """A global declaration: the indices of its first and last token, and of the ``{`` of a function's body."""

    first: int
    last: int
    body: int | None


class Text:
    """A text as tokens that can be changed in place; white space is a token too, so joined they are the text."""

    def __init__(self, text: str):
        self.tokens = [Token(match[0], match.lastgroup) for match in _TOKEN.finditer(text)]

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
            depth += (self[k] in CLOSING) - (self[k] in CLOSING.values())
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
            if self[k] in CLOSING:
                skipped = self.closing(k)
                inside.append(skipped)
        return parts

    def statements(self) -> list[Statement]:
        """The global declarations, in order."""
        found = []
        first = before = None
        k = next(self.solid(), None)
        while k is not None:
            first = k if first is None else first
            last = k
            if self[k] in CLOSING:
                last = self.closing(k)
                if self[k] == "{" and before is not None and self[before] == ")":
                    found.append(Statement(first, last, k))
                    first = None
            elif self[k] == ";":
                found.append(Statement(first, k, None))
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

    def function_name(self, function: Statement) -> int:
        """Where the name of a function stands."""
        named = (k for k in self.solid(function.first, function.body) if self[self.next(k)] == "(")
        return next(named, function.first)

    def at_run_time(self, function: Statement) -> Iterator[int]:
        """The solid tokens of a function's body, without what has to be constant: after ``const`` and ``case``."""
        skipped = -1
        for k in self.solid(function.body, function.last):
            if self[k] in ("const", "case"):
                skipped = next(j for j in self.solid(k) if self[j] == (";" if self[k] == "const" else ":"))
            if k > skipped:
                yield k


def is_type(word: str, structs: Collection[str]) -> bool:
    """Whether a word names a numeric type, or one of the structures."""
    return bool(_BUILT_IN_TYPE.match(word)) or word in structs
