"""Mutants of a GLSL file: copies with one small fault each, made on the syntax, that good tests should notice."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from ..language.glsl_syntax import Definition, Node, parse
from ..language.tokens import is_type

#: kinds of mutants, in the order of the report
KINDS = {
    "arithmetic": "+ for -, * for /, a sign dropped",
    "term": "a + b becomes a, a * b becomes b, a && b becomes a",
    "constant": "0, 1, doubled, other sign, off by one, other last digit",
    "component": "another component, another order",
    "arguments": "two arguments swapped",
    "guard": "max, min, clamp, ?: or if without what it guards against",
    "min-max": "max for min",
    "comparison": "<= or > for <, != for ==",
    "logic": "&& for ||, a condition negated",
    "function": "sqrt(x) becomes x, dot(a, b) becomes dot(a, a)",
    "statement": "a statement dropped",
    "assignment": "+= for =",
    "return": "0 returned",
}

_OPERATORS = {
    **{a: ("arithmetic", (b,)) for a, b in ("+-", "-+", "*/", "/*", "%*")},
    **{a: ("arithmetic", (b,)) for a, b in (("<<", ">>"), (">>", "<<"), ("&", "|"), ("|", "&"), ("^", "&"))},
    "<": ("comparison", ("<=", ">")),
    "<=": ("comparison", ("<", ">=")),
    ">": ("comparison", (">=", "<")),
    ">=": ("comparison", (">", "<=")),
    "==": ("comparison", ("!=",)),
    "!=": ("comparison", ("==",)),
    "&&": ("logic", ("||",)),
    "||": ("logic", ("&&",)),
    "^^": ("logic", ("&&",)),
}
_ASSIGNMENTS = {
    "=": ("+=",),
    "+=": ("-=", "="),
    "-=": ("+=", "="),
    "*=": ("/=", "="),
    "/=": ("*=", "="),
}
#: a binary operator -> which of its operands may stand alone
_ALONE = {"+": "ab", "-": "ab", "*": "ab", "/": "a", "%": "a", "&&": "ab", "||": "ab"}
_OTHER_FUNCTION = {
    "max": ("min-max", "min"),
    "min": ("min-max", "max"),
    "lessThan": ("comparison", "lessThanEqual"),
    "lessThanEqual": ("comparison", "lessThan"),
    "greaterThan": ("comparison", "greaterThanEqual"),
    "greaterThanEqual": ("comparison", "greaterThan"),
    "equal": ("comparison", "notEqual"),
    "notEqual": ("comparison", "equal"),
    "any": ("logic", "all"),
    "all": ("logic", "any"),
    "sin": ("function", "cos"),
    "cos": ("function", "sin"),
    "floor": ("function", "ceil"),
    "ceil": ("function", "floor"),
    "inversesqrt": ("function", "sqrt"),
    "exp": ("function", "exp2"),
    "log": ("function", "log2"),
}
#: functions that an argument, by its place, can stand for
_DROPPED = {
    **dict.fromkeys(("max", "min", "mix"), (0, 1)),
    **dict.fromkeys(("sqrt", "abs", "normalize", "floor", "ceil", "fract", "round", "trunc", "sign", "not"), (0,)),
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan", "exp", "exp2", "log", "log2", "pow", "mod"), (0,)),
    **dict.fromkeys(("radians", "degrees", "reflect", "refract", "faceforward", "transpose", "inverse"), (0,)),
    **dict.fromkeys(("step", "smoothstep"), (1,)),
}
_GUARDS = {"max", "min", "clamp"}
#: swapping the arguments of these changes nothing, or is another mutant's business
_NOT_SWAPPED = {"max", "min", "clamp", "dot", "distance", "equal", "notEqual"}
_COMPONENTS = ("xyzw", "rgba", "stpq")
_FLOAT = re.compile(r"(?P<digits>\d+\.?\d*|\.\d+)(?P<exponent>[eE][+-]?\d+)?(?P<suffix>[fF]?)$")
_INTEGER = re.compile(r"(?P<digits>0[xX][\da-fA-F]+|\d+)(?P<suffix>[uU]?)$")


@dataclass(frozen=True)
class Mutant:
    """One fault: ``edits`` are (start, end, new text) of the file's text. ``line`` and ``column`` count from 1.

    ``id`` names it by the function, variable or macro that it is in, the lines from where that begins, the column, the
    kind and the change: what happens elsewhere in the file leaves the name alone.
    """

    id: str
    line: int
    column: int
    kind: str
    function: str | None  # None outside functions
    edits: tuple[tuple[int, int, str], ...]

    def apply(self, text: str) -> str:
        """The file's text with the fault, of as many lines."""
        for start, end, new in sorted(self.edits, reverse=True):
            lost = text.count("\n", start, end) - new.count("\n")
            text = text[:start] + new + "\n" * lost + text[end:]
        return text


def mutants(text: str, active: str | None = None) -> list[Mutant]:
    """All mutants of a file's text, in the order of the text.

    ``active`` is the text with what the preprocessor leaves out made spaces; nothing there is touched.
    """
    found: dict[tuple, Mutant] = {}
    for definition in parse(active or text).definitions:
        for at, kind, change, *edits in _Maker(text, definition).mutants():
            line = text.count("\n", 0, at) + 1
            column = at - text.rfind("\n", 0, at)
            below = text.count("\n", definition.start, at)
            mutant = Mutant(
                f"{definition.name}+{below}:{column}:{kind}:{change}",
                line,
                column,
                kind,
                None if definition.result is None else definition.name,
                tuple(edits),
            )
            found.setdefault(mutant.edits, mutant)
    return sorted(found.values(), key=lambda m: (m.line, m.column, list(KINDS).index(m.kind)))


#: offset, kind, change, and the edits
_Change = tuple


class _Maker:
    """Makes the mutants of one definition."""

    def __init__(self, text: str, definition: Definition):
        self.text, self.definition = text, definition

    def mutants(self) -> Iterator[_Change]:
        for node in self.definition.body.walk():
            if make := getattr(self, f"_{node.kind}", None):
                yield from make(node)

    def _code(self, node: Node) -> str:
        return self.text[node.start : node.end]

    def _operand(self, node: Node) -> str:
        """The node's text such as it can stand for a function's call."""
        whole = node.kind in ("number", "name", "call", "index", "member", "group", "postfix")
        return self._code(node) if whole else f"({self._code(node)})"

    def _number(self, node: Node) -> Iterator[_Change]:
        for change, word in _other_numbers(node.word):
            yield node.at, "constant", change, (node.start, node.end, word)

    def _prefix(self, node: Node) -> Iterator[_Change]:
        (operand,) = node.parts
        if node.word in ("-", "!"):
            kind = "arithmetic" if node.word == "-" else "logic"
            yield node.at, kind, "dropped", (node.start, operand.start, "")
        yield from self._step(node)

    def _step(self, node: Node) -> Iterator[_Change]:
        if node.word in ("++", "--"):
            other = {"++": "--", "--": "++"}[node.word]
            yield node.at, "arithmetic", other, (node.at, node.at + 2, other)

    _postfix = _step

    def _binary(self, node: Node) -> Iterator[_Change]:
        left, right = node.parts
        kind, others = _OPERATORS.get(node.word, ("", ()))
        for other in others:
            yield node.at, kind, other, (node.at, node.at + len(node.word), other)
        alone = _ALONE.get(node.word, "")
        if "a" in alone:
            yield node.at, "term", "left", (node.start, node.end, self._code(left))
        if "b" in alone:
            # of a - b there is left -b
            code = f"(-{self._operand(right)})" if node.word == "-" else self._code(right)
            yield node.at, "term", "right", (node.start, node.end, code)

    def _assign(self, node: Node) -> Iterator[_Change]:
        for other in _ASSIGNMENTS.get(node.word, ()):
            yield node.at, "assignment", other, (node.at, node.at + len(node.word), other)

    def _ternary(self, node: Node) -> Iterator[_Change]:
        condition, yes, no = node.parts
        yield node.at, "guard", "always", (node.start, node.end, self._operand(yes))
        yield node.at, "guard", "never", (node.start, node.end, self._operand(no))
        yield node.at, "logic", "negated", (condition.start, condition.end, f"!({self._code(condition)})")

    def _if(self, node: Node) -> Iterator[_Change]:
        condition = node.parts[0]
        for change, word in (("always", "true"), ("never", "false")):
            yield node.at, "guard", change, (condition.start, condition.end, word)
        yield node.at, "logic", "negated", (condition.start, condition.end, f"!({self._code(condition)})")

    def _while(self, node: Node) -> Iterator[_Change]:
        condition = node.parts[0]
        yield node.at, "guard", "never", (condition.start, condition.end, "false")

    def _expression(self, node: Node) -> Iterator[_Change]:
        yield node.at, "statement", "dropped", (node.start, node.end, ";")

    _jump = _expression

    def _return(self, node: Node) -> Iterator[_Change]:
        result = self.definition.result or ""
        if not node.parts:
            yield from self._expression(node)
        elif result == "bool":
            (value,) = node.parts
            yield node.at, "return", "negated", (value.start, value.end, f"!({self._code(value)})")
        elif is_type(result, ()):
            (value,) = node.parts
            yield node.at, "return", "zero", (value.start, value.end, f"{result}(0)")

    def _member(self, node: Node) -> Iterator[_Change]:
        of = next((letters for letters in _COMPONENTS if set(node.word) <= set(letters)), None)
        if of is None or len(node.word) > 4:
            return
        other = node.word[::-1]
        if other == node.word:
            other = "".join(of[1] if c == of[0] else of[0] for c in node.word)
        yield node.at, "component", other, (node.end - len(node.word), node.end, other)

    def _call(self, node: Node) -> Iterator[_Change]:
        name, arguments = node.word, node.parts
        after = node.at + len(name)
        if name in _OTHER_FUNCTION and arguments:
            kind, other = _OTHER_FUNCTION[name]
            yield node.at, kind, other, (node.at, after, other)
        own = len(arguments) == 1 and name not in _OTHER_FUNCTION and not is_type(name, ())
        for place in _DROPPED.get(name, (0,) if own else ()):
            if place < len(arguments):
                kind = "guard" if name in _GUARDS else "function"
                yield node.at, kind, f"argument-{place + 1}", (node.start, node.end, self._operand(arguments[place]))
        if name == "clamp" and len(arguments) == 3:
            x, low, high = map(self._code, arguments)
            yield node.at, "guard", "argument-1", (node.start, node.end, self._operand(arguments[0]))
            yield node.at, "guard", "below", (node.start, node.end, f"min({x}, {high})")
            yield node.at, "guard", "above", (node.start, node.end, f"max({x}, {low})")
        if name == "dot" and len(arguments) == 2 and self._code(arguments[0]) != self._code(arguments[1]):
            a, b = arguments
            yield node.at, "function", "first-twice", (b.start, b.end, self._code(a))
            yield node.at, "function", "second-twice", (a.start, a.end, self._code(b))
        if name not in _NOT_SWAPPED:
            for k, (a, b) in enumerate(zip(arguments, arguments[1:], strict=False), 1):
                if self._code(a) != self._code(b):
                    edits = (a.start, a.end, self._code(b)), (b.start, b.end, self._code(a))
                    yield node.at, "arguments", f"{k}-{k + 1}", *edits


def _other_numbers(word: str) -> Iterator[tuple[str, str]]:
    """(change, literal) of each number that a literal could be instead; no number twice."""
    if match := _INTEGER.match(word):
        base = 16 if "x" in word.lower() else 8 if word.startswith("0") else 10
        value, suffix = int(match["digits"], base), match["suffix"]
        others = {"zero": 0, "one": 1, "doubled": 2 * value, "one-more": value + 1, "one-less": value - 1}
        literals = {change: f"{other}{suffix}" for change, other in others.items() if other >= 0 or not suffix}
        seen = {f"{value}{suffix}"}
    elif match := _FLOAT.match(word):
        digits, exponent, suffix = match["digits"], match["exponent"] or "", match["suffix"]
        value = float(digits + exponent)
        last = next(k for k in reversed(range(len(digits))) if digits[k].isdigit())
        digit = "8" if digits[last] == "9" else str(int(digits[last]) + 1)
        others = {"zero": 0.0, "one": 1.0, "doubled": 2 * value, "sign": -value}
        others["digit"] = float(digits[:last] + digit + digits[last + 1 :] + exponent)
        literals = {change: f"{other!r}{suffix}" for change, other in others.items() if abs(other) < float("inf")}
        seen = {f"{value!r}{suffix}", f"-0.0{suffix}"}
    else:
        return
    for change, literal in literals.items():
        if literal not in seen:
            seen.add(literal)
            yield change, f"({literal})" if literal.startswith("-") else literal
