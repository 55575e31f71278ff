"""The comment that stands directly above a function in the user's file, as the author meant it to be read."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from .signature import Signature

_TOKEN = re.compile(
    r"(?P<line>//(?:\\\n|[^\n])*)|(?P<block>/\*.*?\*/)|(?P<directive>^[ \t]*\#(?:\\\n|[^\n])*)|(?P<space>\s+)"
    r"|(?P<word>\w+)|(?P<mark>.)",
    re.MULTILINE | re.DOTALL,
)


def above(signatures: Iterable[Signature]) -> dict[Signature, str]:
    """The comment directly above each function, "" where there is none.

    ``//`` lines that follow one another, or one ``/* */``; a blank line between it and the function makes it a comment
    on something else.
    """
    read = cache(_tokens)
    return {signature: _above(read(signature.origin[0]), signature) for signature in signatures}


def _tokens(file: str) -> list[tuple[str, str, int]]:
    """(kind, text, line) of each token of a file; [] for what is none, such as the macros of a call."""
    try:
        text = Path(file).read_bytes().decode("utf-8-sig", errors="replace").replace("\r\n", "\n")
    except OSError:
        return []
    tokens, line = [], 1
    for match in _TOKEN.finditer(text):
        tokens.append((match.lastgroup, match[0], line))
        line += match[0].count("\n")
    return tokens


def _above(tokens: list[tuple[str, str, int]], signature: Signature) -> str:
    k = _start(tokens, signature)
    found: list[str] = []
    while k >= 2 and tokens[k - 1][0] == "space" and tokens[k - 1][1].count("\n") == 1:
        kind, text, _ = tokens[k - 2]
        if kind not in ("line", "block") or (found and kind == "block") or not _begins_line(tokens, k - 2):
            break
        found.insert(0, text)
        k -= 2
        if kind == "block":
            break
    return _unmarked(found)


def _start(tokens: list[tuple[str, str, int]], signature: Signature) -> int:
    """The first token of the definition. The compiler's line is that of the last parameter, or of a macro's use."""
    solid = [k for k, (kind, _, _) in enumerate(tokens) if kind in ("word", "mark")]
    place = None
    for n, k in enumerate(solid[:-1]):
        if tokens[k][2] > signature.origin[1]:
            break
        if tokens[k][1] == signature.name and tokens[solid[n + 1]][1] == "(":
            place = n
    if place is None or _ends_before(tokens, solid, place, signature.origin[1]):
        return next((k for k in solid if tokens[k][2] == signature.origin[1]), 0)
    while place and re.fullmatch(r"\w+|[\[\]]", tokens[solid[place - 1]][1]):
        place -= 1
    return solid[place]


def _ends_before(tokens: list[tuple[str, str, int]], solid: list[int], place: int, line: int) -> bool:
    """Whether the brackets after a name close above a line: it is another function's, or a call."""
    depth = 0
    for k in solid[place + 1 :]:
        depth += {"(": 1, ")": -1}.get(tokens[k][1], 0)
        if depth == 0:
            return tokens[k][2] < line
    return True


def _begins_line(tokens: list[tuple[str, str, int]], k: int) -> bool:
    """Whether nothing but space stands before a token in its line: what ends a line of code is about that code."""
    if k == 0 or tokens[k - 1][1].endswith("\n"):
        return True
    kind, text, _ = tokens[k - 1]
    return kind == "space" and ("\n" in text or k == 1)


def _unmarked(comments: list[str]) -> str:
    """The text of comments without the marks that make them such, nor the * before each line of a block."""
    if comments and comments[0].startswith("/*"):
        lines = re.sub(r"^/\*[*!]?|\*+/$", "", comments[0]).split("\n")
        rest = [re.sub(r"^\s*\* ?", "", line) for line in lines[1:]]
        if any(not re.match(r"\s*(\*|$)", line) for line in lines[1:]):
            rest = lines[1:]
        return "\n".join([lines[0].strip(), *textwrap.dedent("\n".join(rest)).split("\n")]).strip()
    lines = [re.sub(r"^//[/!]?", "", comment) for comment in comments]
    return textwrap.dedent("\n".join(lines)).strip()
