"""What the tests compile of a file: its text under each set of macros, and what a mutant comes to there."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .. import native
from ..errors import NativeError
from ..language.glsl_syntax import directives, without_comments
from ..language.tokens import Text
from ..native import Stage

_MARKER = "hn_line_"
_FOUND_MARKER = re.compile(rf"^\s*{_MARKER}(\d+)", re.MULTILINE)
_CONDITIONAL = re.compile(r"[ \t]*#[ \t]*(if|elif|else|endif|version|extension)")
_NUMBER = re.compile(r"[\d.]+(?:[eE][+-]?\d+)?")


@dataclass(frozen=True)
class Loaded:
    """A shader as the tests loaded it: ``text`` with includes pasted and macros defined.

    ``places`` are pairs (line of ``text``, line of the file), for the lines that are the file's.
    """

    text: str
    places: tuple[tuple[int, int], ...]


class Variant:
    """A file within a shader that the tests loaded. Lines count from 1."""

    def __init__(self, loaded: Loaded, file_text: str):
        own = file_text.split("\n")
        self._lines = loaded.text.split("\n")
        # an include is no line of the file any more: its text stands there
        self._places = [(n, m) for n, m in loaded.places if self._lines[n - 1] == own[m - 1]]
        self.active = self._active_lines()

    def _active_lines(self) -> frozenset[int]:
        """The file's lines that the preprocessor keeps: each is made a marker, and some of these are left."""
        bare = without_comments("\n".join(self._lines))
        within = set()
        conditional = set()
        for start, end in directives(bare):
            first = bare.count("\n", 0, start)
            lines = range(first, first + bare.count("\n", start, end) + 1)
            within.update(lines)
            if _CONDITIONAL.match(bare, start):
                conditional.update(lines)
        marked, continued = [], False
        for n, line in enumerate(bare.split("\n")):
            if n in within:
                if n not in conditional and not continued:
                    marked.append(f"{_MARKER}{n + 1}")
                marked.append(line)
                continued = line.endswith("\\")
            else:
                marked.append(f"{_MARKER}{n + 1}")
                continued = False
        left = native.glsl_preprocess(Stage.FRAGMENT, "\n".join(marked) + "\n")
        kept = {int(match[1]) for match in _FOUND_MARKER.finditer(left)}
        return frozenset(m for n, m in self._places if n in kept)

    @cached_property
    def key(self) -> tuple:
        """Equal for variants that come to the same: what the preprocessor leaves of the file, macros replaced."""
        left = _preprocessed(self.text).split("\n")
        return tuple((m, left[n - 1]) for n, m in self._places if n <= len(left) and left[n - 1].strip())

    @cached_property
    def text(self) -> str:
        return "\n".join(self._lines)

    @cached_property
    def _stage(self) -> Stage:
        try:
            native.glsl_tree(Stage.FRAGMENT, self.text)
            return Stage.FRAGMENT
        except NativeError:
            return Stage.VERTEX

    @cached_property
    def _tree(self) -> str:
        return native.glsl_tree(self._stage, self.text)

    @cached_property
    def calls(self) -> Mapping[str, frozenset[str]]:
        """The functions and, of each, all that it calls, by itself or through others, itself included."""
        code = Text(_preprocessed(self.text))
        direct: dict[str, set[str]] = {}
        for statement in code.statements():
            if statement.body is not None:
                name = code[code.function_name(statement)]
                words = {code[k] for k in code.solid(statement.body, statement.last) if code.tokens[k].kind == "word"}
                direct.setdefault(name, {name}).update(words)
        return {name: frozenset(_reached(name, direct)) for name in direct}

    def outcome(self, mutated: str) -> str:
        """What a mutated file's text is here: ``invalid`` (does not compile), ``same`` (the same code) or ``differs``.

        glslang prints constants to six digits, so code that looks the same is so where its literals are the same too.
        """
        own = mutated.split("\n")
        lines = list(self._lines)
        for n, m in self._places:
            lines[n - 1] = own[m - 1]
        text = "\n".join(lines)
        try:
            tree = native.glsl_tree(self._stage, text)
        except NativeError:
            return "invalid"
        return "same" if tree == self._tree and _numbers(_preprocessed(text)) == self._numbers else "differs"

    @cached_property
    def _numbers(self) -> list[float]:
        return _numbers(_preprocessed(self.text))


def _preprocessed(text: str) -> str:
    return native.glsl_preprocess(Stage.FRAGMENT, text)


def _numbers(text: str) -> list[float]:
    """The literals of a preprocessed text, rounded to float32."""
    words = (token.text for token in Text(text).tokens if token.kind == "number")
    with np.errstate(over="ignore"):
        return [float(np.float32(match[0])) for match in map(_NUMBER.match, words)]


def _reached(name: str, direct: Mapping[str, Collection[str]]) -> set[str]:
    reached, waiting = set(), [name]
    while waiting:
        at = waiting.pop()
        if at not in reached:
            reached.add(at)
            waiting += [other for other in direct[at] if other in direct]
    return reached


def different(found: Sequence[Variant]) -> list[int]:
    """For each variant the place of the one that stands for it: of those that come to the same, the shortest shader."""
    by_length = sorted(range(len(found)), key=lambda n: len(found[n].text))
    standing: dict[tuple, int] = {}
    for n in by_length:
        standing.setdefault(found[n].key, n)
    return [standing[variant.key] for variant in found]


def active_text(file_text: str, variant: Variant) -> str:
    """The file's text with the lines that the preprocessor drops made spaces."""
    lines = file_text.split("\n")
    return "\n".join(line if n in variant.active else " " * len(line) for n, line in enumerate(lines, 1))
