"""Loops that the software renderer might stop: how long they can be, and counters that tell.

llvmpipe stops loops after 65 535 passes without a word. It counts for each group of elements that it evaluates together
(8, with 256-bit vectors), over all loops that one of them is in, the last look at each condition as a pass too. So
where a bound cannot be seen in the text, the passes are counted while it runs:

- first for each element by itself (``hn_passes``): if all stay below ``SURE``, no group can have reached the cap;
- else for each group, as the driver does, in memory that its elements share (``hn_group``): slow, but exact;
- where a group reached the cap, with each element alone in a group, to know which elements are at fault.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

import numpy as np

from ..language.tokens import PRECISION, Statement, Text

CAP = 65535
LANES_MAX = 16  # elements of a group: vectors of 512 bits
SURE = CAP // LANES_MAX - 1
SIMULATED = 4096  # passes of a loop that are counted by running through it; what takes more is counted in the shader

#: declared before the library's text; what a loop calls, with its line
COUNT_EACH = "highp int hn_passes = 0; void hn_pass(highp int hn_line) { ++hn_passes; }"
#: the same for whole groups; {0} is how many elements one has. The line is that of the loop that reached the cap
COUNT_GROUPS = (
    "shared highp int hn_group[256 / {0}]; highp int hn_passes = 0; "
    "void hn_pass(highp int hn_line) {{ highp int hn_g = int(gl_LocalInvocationIndex) / {0}; "
    f"highp int hn_n = hn_group[hn_g] + 1; hn_group[hn_g] = hn_n; if (hn_n == {CAP}) hn_passes = hn_line; }}}}"
)
#: at the beginning of main() with COUNT_GROUPS
START_GROUP = "hn_group[int(gl_LocalInvocationIndex) / {0}] = 0;"

_NUMBER = re.compile(r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?[uUfF]?$")
_COMPARE = {"<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal, "!=": np.not_equal}
_CHANGES = {"++", "--", "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}


@dataclass
class _Loop:
    """A loop: its first and last token, those of its body, and the loops directly in it."""

    first: int
    last: int
    body: tuple[int, int]
    inner: list[_Loop] = field(default_factory=list)


def _end(code: Text, k: int) -> int:
    """The last token of the statement that begins at ``k``."""
    word = code[k]
    if word == "{":
        return code.closing(k)
    if word in ("if", "for", "while", "switch"):
        end = _end(code, code.next(code.closing(code.next(k))))
        after = code.next(end)
        if word == "if" and after is not None and code[after] == "else":
            return _end(code, code.next(after))
        return end
    if word == "do":
        asked = code.next(_end(code, code.next(k)))  # while
        return code.next(code.closing(code.next(asked)))  # ;
    while code[k] != ";":
        k = code.closing(k) if code[k] in ("(", "{", "[") else k
        k = code.next(k)
    return k


def _loops(code: Text, first: int, last: int) -> list[_Loop]:
    """The outermost loops between two tokens, those within them inside them."""
    found = []
    k = next(code.solid(first, last), None)
    while k is not None and k <= last:
        if code[k] in ("for", "while", "do"):
            begin = code.next(k) if code[k] == "do" else code.next(code.closing(code.next(k)))
            loop = _Loop(k, _end(code, k), (begin, _end(code, begin)))
            loop.inner = _loops(code, *loop.body)
            found.append(loop)
            k = loop.last
        k = code.next(k)
    return found


def _constants(code: Text, statements: list[Statement]) -> dict[str, str]:
    """``const int N = 8;`` and the like, declared globally: name -> number."""
    found = {}
    for statement in statements:
        words = [code[k] for k in code.solid(statement.first, statement.last)]
        match words:
            case ["const", *_, "int" | "uint" | "float", name, "=", number, ";"] if _NUMBER.match(number):
                found[name] = number
    return found


def _value(word: str, constants: dict[str, str]) -> np.float32 | int | None:
    word = constants.get(word, word)
    if not _NUMBER.match(word):
        return None
    word = word.rstrip("uUfF")
    return int(word) if word.isdigit() else np.float32(word)


def _signed(words: list[str], constants: dict[str, str]) -> np.float32 | int | None:
    negative = words[:1] == ["-"]
    value = _value(words[-1], constants) if len(words) == 1 + negative else None
    return -value if negative and value is not None else value


def _passes(code: Text, loop: _Loop, constants: dict[str, str], changing: set[str]) -> float:
    """How often the body runs at most, where the text shows it: ``for (int i = 0; i < 8; ++i)``. Infinite elsewhere."""
    if code[loop.first] != "for":
        return math.inf
    opening = code.next(loop.first)
    parts: list[list[str]] = [[]]
    for k in code.solid(opening + 1, code.closing(opening) - 1):
        if code[k] == ";":
            parts.append([])
        else:
            parts[-1].append(code[k])
    if len(parts) != 3:
        return math.inf
    declared, tested, step = parts
    while declared and declared[0] in PRECISION:
        declared = declared[1:]
    match declared, tested:
        case ["int" | "uint" | "float", name, "=", *start], [asked, compare, *bound] if (
            asked == name and compare in _COMPARE
        ):
            pass
        case _:
            return math.inf
    match step:
        case ["++", changed] | [changed, "++"]:
            sign, by = 1, 1
        case ["--", changed] | [changed, "--"]:
            sign, by = -1, 1
        case [changed, "+=" | "-=" as operator, number]:
            sign, by = (1 if operator == "+=" else -1), _value(number, constants)
        case _:
            return math.inf
    value, limit = _signed(start, constants), _signed(bound, constants)
    if changed != name or None in (value, limit, by) or _changed(code, loop.body, name, changing):
        return math.inf
    for n in range(SIMULATED):
        if not _COMPARE[compare](value, limit):
            return n
        value = value + sign * by
    return math.inf


def _changed(code: Text, body: tuple[int, int], name: str, changing: set[str]) -> bool:
    """Whether a loop's variable may get another value in its body; as an argument of a function with out parameters."""
    calls: list[int] = []
    before = ""
    for k in code.solid(*body):
        while calls and k > calls[-1]:
            calls.pop()
        word = code[k]
        after = code[code.next(k)] if k < body[1] else ""
        if word in changing and after == "(":
            calls.append(code.closing(code.next(k)))
        if word == name and (before in ("++", "--") or after in _CHANGES or calls):
            return True
        before = word
    return False


def most_passes(text: str, name: str) -> float:
    """The most passes of a group through all loops of one call of the function ``name``; infinite if none can be seen.

    Each entry of a loop counts as a pass too, for the last look at its condition.
    """
    code = Text(text)
    statements = code.statements()
    functions: dict[str, list[Statement]] = {}
    for s in statements:
        if s.body is not None:
            functions.setdefault(code[code.function_name(s)], []).append(s)
    constants = _constants(code, [s for s in statements if s.body is None])
    changing = {
        f
        for f, found in functions.items()
        for s in found
        for k in code.solid(s.first, s.body)
        if code[k] in ("out", "inout")
    }
    # a name that is declared again within a function may be another there
    declared = [
        code[code.next(k)]
        for s in statements
        if s.body
        for k in code.solid(s.first, s.last)
        if code[k] in ("int", "uint", "float")
    ]
    constants = {n: value for n, value in constants.items() if n not in declared}
    known: dict[str, float] = {}

    def between(first: int, last: int) -> float:
        total = 0.0
        inside = _loops(code, first, last)
        for loop in inside:
            head = between_calls(loop.first, loop.body[0] - 1) + between_calls(loop.body[1] + 1, loop.last)
            body = between(*loop.body)
            passes = _passes(code, loop, constants, changing)
            # a loop of unknown length is infinite whatever it holds
            total += math.inf if passes == math.inf else 1 + passes * (1 + body) + (passes + 1) * head
        spans = [(loop.first, loop.last) for loop in inside]
        return total + between_calls(first, last, spans)

    def between_calls(first: int, last: int, without: list[tuple[int, int]] = ()) -> float:
        return sum(
            most(code[k])
            for k in code.solid(first, last)
            if code[k] in functions
            and not any(a <= k <= b for a, b in without)
            and code.next(k) is not None
            and code[code.next(k)] == "("
        )

    def most(function: str) -> float:
        if function not in known:
            known[function] = math.inf  # of one that calls itself, which GLSL forbids
            known[function] = max(between(s.body, s.last) for s in functions[function])
        return known[function]

    return most(name) if name in functions else 0


def counted(text: str) -> str:
    """The text, its lines unmoved, with ``hn_pass(line)`` called at each pass and each entry of every loop."""
    code = Text(text)
    lines = np.cumsum([0, *(token.text.count("\n") for token in code.tokens)]) + 1
    every = []

    def collect(loops: list[_Loop]) -> None:
        for loop in loops:
            every.append(loop)
            collect(loop.inner)

    for statement in code.statements():
        if statement.body is not None:
            collect(_loops(code, statement.body, statement.last))
    for loop in reversed(every):  # the inner ones first
        count = f"hn_pass({lines[loop.first]});"
        for first, last in (loop.body, (loop.first, loop.last)):
            code.tokens[first].before = f"{{ {count} {code.tokens[first].before}"
            code.tokens[last].after += " }"
    return str(code)
