"""Reads GLSL functions into trees of statements and expressions, every node with its place in the user's text.

The text is a file's own, not yet preprocessed: what is a macro's name is a name like any other. Nothing is known of
types.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from .tokens import CLOSING, Text

_COMMENT = re.compile(r"//(?:\\\n|[^\n])*|/\*.*?(?:\*/|\Z)", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.MULTILINE)
_MACRO = re.compile(r"[ \t]*#[ \t]*define[ \t]+(\w+)(?:\([\w, \t]*\))?[ \t]+")

_QUALIFIERS = {"const", "in", "out", "inout", "precise", "highp", "mediump", "lowp", "invariant"}
_STORAGE = {"layout", "uniform", "flat", "smooth", "noperspective", "centroid", "shared"}
_ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
_PREFIXES = {"+", "-", "!", "~", "++", "--"}
_JUMPS = {"break", "continue", "discard"}
#: binary operators, from the weakest binding
_LEVELS = [{"||"}, {"^^"}, {"&&"}, {"|"}, {"^"}, {"&"}, {"==", "!="}, {"<", ">", "<=", ">="}, {"<<", ">>"}]
_LEVELS += [{"+", "-"}, {"*", "/", "%"}]


@dataclass(frozen=True)
class Node:
    """A statement or an expression: its first and last character's offsets (the last exclusive), and its parts.

    ``kind`` of an expression: number, name, prefix, postfix, binary, ternary, assign, call, index, member, group, list.
    Of a statement: block, if, for, while, do, switch, case, return, declaration, expression, jump, empty. A
    declaration's parts are of kind variable, one for each that has an initial value, which is its part.
    ``at`` and ``word`` are the offset and the text of what makes it what it is: an operator, the name of a call, a
    member or a variable, a literal.
    """

    kind: str
    start: int
    end: int
    at: int
    word: str
    parts: tuple[Node, ...] = ()

    def walk(self) -> Iterator[Node]:
        """The node and all below it, outer before inner, in the order of the text."""
        yield self
        for part in self.parts:
            yield from part.walk()


@dataclass(frozen=True)
class Definition:
    """What a name stands for, and where its definition begins.

    ``body`` is the outermost block of a function, the initial value of a global variable, or what a macro stands for
    where that is an expression. ``result`` is the name of the type that a function returns, None for the others.
    """

    name: str
    start: int
    body: Node
    result: str | None = None


@dataclass(frozen=True)
class Unit:
    """What a file holds. ``skipped`` are the offsets of what could not be read: it is GLSL only after its macros."""

    definitions: tuple[Definition, ...]
    skipped: tuple[int, ...]


def without_comments(text: str) -> str:
    """The text with its comments made spaces: every character stays where it is."""
    return _COMMENT.sub(lambda match: _blank(match[0]), text)


def directives(text: str) -> list[tuple[int, int]]:
    """Start and end of the preprocessor's lines of a text without comments, continued lines included."""
    return [match.span() for match in _DIRECTIVE.finditer(text)]


def parse(text: str) -> Unit:
    """The functions, global variables with initial values, and macros of a text, in the order of the text."""
    bare = without_comments(text)
    found, skipped = [], []
    lines = directives(bare)
    for start, end in lines:
        macro = _MACRO.match(bare, start, end)
        if macro:
            body = " " * macro.end() + bare[macro.end() : end].replace("\\\n", " \n")
            try:
                found.append(Definition(macro[1], start, _Parser(Text(body)).whole()))
            except _NotUnderstoodError:
                pass  # a macro need be no expression
    for start, end in lines:
        bare = bare[:start] + _blank(bare[start:end]) + bare[end:]
    code = Text(bare)
    for statement in code.statements():
        parser = _Parser(code, statement.first, statement.last)
        start = parser.start()
        if statement.body is None:
            found += (Definition(v.word, start, v.parts[0]) for v in parser.global_variables())
        else:
            place = code.function_name(statement)
            words = [code[k] for k in code.solid(statement.first, place - 1) if code.tokens[k].kind == "word"]
            parser.go_to(statement.body)
            found.append(Definition(code[place], start, parser.statement(), words[-1] if words else ""))
        skipped += parser.skipped
    return Unit(tuple(sorted(found, key=lambda d: d.body.start)), tuple(skipped))


def _blank(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


class _NotUnderstoodError(Exception):
    """What stands there is no GLSL, or becomes it by macros."""


class _Parser:
    """Recursive descent over the solid tokens of a text, from ``first`` to ``last``."""

    def __init__(self, code: Text, first: int = 0, last: int | None = None):
        self.code = code
        self.solid = list(code.solid(first, last))
        self.offsets = [0]
        for token in code.tokens:
            self.offsets.append(self.offsets[-1] + len(token.text))
        self.place = 0  # in solid
        self.skipped: list[int] = []

    def go_to(self, token: int) -> None:
        self.place = self.solid.index(token)

    def whole(self) -> Node:
        """All of the text as one expression."""
        node = self.expression()
        if self.place < len(self.solid):
            raise _NotUnderstoodError
        return node

    def global_variables(self) -> list[Node]:
        """The variables with initial values of a global declaration."""
        words = {self.code[k] for k in self.solid}
        if "=" not in words or "struct" in words:
            return []
        try:
            while self.word() in _STORAGE:
                if self.take() == "layout":
                    closing = self.code.closing(self.solid[self.place])
                    while self.solid[self.place] != closing:
                        self.take()
                    self.take()
            return list(self.declaration().parts)
        except _NotUnderstoodError:
            self.skipped.append(self.start(0))
            return []

    # ---- Tokens

    def word(self, ahead: int = 0) -> str:
        place = self.place + ahead
        return self.code[self.solid[place]] if place < len(self.solid) else ""

    def kind(self, ahead: int = 0) -> str:
        place = self.place + ahead
        return self.code.tokens[self.solid[place]].kind if place < len(self.solid) else ""

    def start(self, place: int | None = None) -> int:
        place = self.place if place is None else place
        if place >= len(self.solid):
            raise _NotUnderstoodError
        return self.offsets[self.solid[place]]

    def end(self) -> int:
        """The end of the token before."""
        return self.offsets[self.solid[self.place - 1] + 1]

    def take(self, wanted: str | None = None) -> str:
        word = self.word()
        if not word or (wanted is not None and word != wanted):
            raise _NotUnderstoodError
        self.place += 1
        return word

    def made(self, kind: str, start: int, at: int, word: str, *parts: Node) -> Node:
        return Node(kind, start, self.end(), at, word, parts)

    # ---- Statements

    def statement(self) -> Node:
        start, place = self.start(), self.place
        try:
            return self._statement(start, self.word())
        except _NotUnderstoodError:
            self.place = place
            self.skipped.append(start)
            self._skip()
            return self.made("empty", start, start, "")

    def _skip(self) -> None:
        """Past the next ; or {...}, or up to a } that closes what is around."""
        while self.word() not in ("", "}"):
            opening = self.take()
            if opening == ";":
                return
            if opening in CLOSING:
                closing = self.code.closing(self.solid[self.place - 1])
                while self.place < len(self.solid) and self.solid[self.place] <= closing:
                    self.place += 1
                if opening == "{":
                    return

    def _statement(self, start: int, word: str) -> Node:
        if word == "{":
            return self.block()
        if word == ";":
            self.take()
            return self.made("empty", start, start, "")
        if word in ("if", "while", "switch"):
            self.take()
            self.take("(")
            condition = self.condition()
            self.take(")")
            bodies = [self.statement()]
            if word == "if" and self.word() == "else":
                self.take()
                bodies.append(self.statement())
            return self.made(word, start, start, word, condition, *bodies)
        if word == "for":
            return self.for_loop(start)
        if word == "do":
            self.take()
            body = self.statement()
            self.take("while")
            self.take("(")
            condition = self.expression()
            self.take(")")
            self.take(";")
            return self.made(word, start, start, word, body, condition)
        if word in ("case", "default"):
            while self.take() != ":":
                pass
            return self.made("case", start, start, word)
        if word in _JUMPS:
            self.take()
            self.take(";")
            return self.made("jump", start, start, word)
        if word == "return":
            self.take()
            value = () if self.word() == ";" else (self.expression(),)
            self.take(";")
            return self.made(word, start, start, word, *value)
        if self.is_declaration():
            return self.declaration()
        value = self.expression()
        self.take(";")
        return self.made("expression", start, start, "", value)

    def block(self) -> Node:
        start = self.start()
        self.take("{")
        statements = []
        while self.word() != "}":
            statements.append(self.statement())
        self.take("}")
        return self.made("block", start, start, "{", *statements)

    def for_loop(self, start: int) -> Node:
        self.take("for")
        self.take("(")
        parts = [self.statement()]
        if self.word() != ";":
            parts.append(self.condition())
        self.take(";")
        if self.word() != ")":
            parts.append(self.expression())
        self.take(")")
        parts.append(self.statement())
        return self.made("for", start, start, "for", *parts)

    def condition(self) -> Node:
        """A condition may declare a variable; then its initial value is what there is."""
        if not self.is_declaration():
            return self.expression()
        self.take()
        self.take()
        self.take("=")
        return self.assignment()

    def is_declaration(self) -> bool:
        if self.word() in _QUALIFIERS:
            return True
        if self.kind() != "word":
            return False
        ahead = 1
        while self.word(ahead) == "[":
            closing = self.code.closing(self.solid[self.place + ahead])
            while self.solid[self.place + ahead] != closing:
                ahead += 1
            ahead += 1
        return self.kind(ahead) == "word"

    def declaration(self) -> Node:
        start = self.start()
        while self.word() in _QUALIFIERS:
            self.take()
        self.typed()
        values = []
        while True:
            at, name = self.start(), self.word()
            self.typed()
            if self.word() == "=":
                self.take()
                value = self.initializer()
                values.append(self.made("variable", at, at, name, value))
            if self.word() != ",":
                break
            self.take()
        self.take(";")
        return self.made("declaration", start, start, "", *values)

    def typed(self) -> None:
        """A type or a variable's name, perhaps with array sizes."""
        if self.kind() != "word":
            raise _NotUnderstoodError
        self.take()
        while self.word() == "[":
            self.take()
            if self.word() != "]":
                self.expression()
            self.take("]")

    def initializer(self) -> Node:
        if self.word() != "{":
            return self.assignment()
        start = self.start()
        self.take("{")
        parts = []
        while self.word() != "}":
            parts.append(self.initializer())
            if self.word() != "}":
                self.take(",")
        self.take("}")
        return self.made("list", start, start, "{", *parts)

    # ---- Expressions

    def expression(self) -> Node:
        start = self.start()
        node = self.assignment()
        while self.word() == ",":
            at = self.start()
            self.take()
            other = self.assignment()
            node = self.made("binary", start, at, ",", node, other)
        return node

    def assignment(self) -> Node:
        start = self.start()
        node = self.ternary()
        if self.word() in _ASSIGNMENTS:
            at = self.start()
            word = self.take()
            value = self.assignment()
            node = self.made("assign", start, at, word, node, value)
        return node

    def ternary(self) -> Node:
        start = self.start()
        node = self.binary(0)
        if self.word() == "?":
            at = self.start()
            self.take()
            yes = self.expression()
            self.take(":")
            no = self.assignment()
            node = self.made("ternary", start, at, "?", node, yes, no)
        return node

    def binary(self, level: int) -> Node:
        if level == len(_LEVELS):
            return self.unary()
        start = self.start()
        node = self.binary(level + 1)
        while self.word() in _LEVELS[level]:
            at = self.start()
            word = self.take()
            other = self.binary(level + 1)
            node = self.made("binary", start, at, word, node, other)
        return node

    def unary(self) -> Node:
        start = self.start()
        if self.word() in _PREFIXES:
            word = self.take()
            operand = self.unary()
            return self.made("prefix", start, start, word, operand)
        return self.postfix()

    def postfix(self) -> Node:
        start = self.start()
        kind = self.kind()
        word = self.take()
        if word == "(":
            inner = self.expression()
            self.take(")")
            node = self.made("group", start, start, "(", inner)
        elif kind in ("number", "word"):
            node = self.made("name" if kind == "word" else kind, start, start, word)
        else:
            raise _NotUnderstoodError
        while (word := self.word()) in ("(", "[", ".", "++", "--"):
            at = self.start()
            self.take()
            if word == "(":
                node = self.call(node, start)
            elif word == "[":
                inside = () if self.word() == "]" else (self.expression(),)
                self.take("]")
                node = self.made("index", start, at, word, node, *inside)
            elif word == ".":
                if self.kind() != "word":
                    raise _NotUnderstoodError
                name = self.take()
                node = self.made("member", start, at, name, node)
            else:
                node = self.made("postfix", start, at, word, node)
        return node

    def call(self, callee: Node, start: int) -> Node:
        arguments = []
        if self.word() == "void" and self.word(1) == ")":
            self.take()
        while self.word() != ")":
            arguments.append(self.assignment())
            if self.word() != ")":
                self.take(",")
        self.take(")")
        return self.made("call", start, callee.at, callee.word if callee.kind == "name" else "", *arguments)
