"""Takes the float literals out of a preprocessed GLSL text, so that they reach an interpreter with all their digits.

The compiler folds constant expressions and rounds what remains to float32: 3.14159265358979 becomes 3.1415927, and
1.0 / 2.4 a single number. Each literal is therefore made a uniform of its own, whose value is the literal's text;
constant expressions of floats are then computed like all others, in the arithmetic of whoever evaluates them.
"""

from __future__ import annotations

import re

from .tokens import Text

PREFIX = "hn_literal_"

_LOWEST = 330  # the first version of which SPIR-V can be made
_DESKTOP = "#version 450"  # instead of ES, where a global variable cannot begin as a uniform's value
_FLOAT = re.compile(r"(?!0[xX])(?=.*[.eE]|.*[fF]$)(?P<value>[\d.]+(?:[eE][+-]?\d+)?)[fF]?$")
_STAYS_CONST = re.compile(r"(u?int|bool|[uib]vec[234])$")
_QUALIFIERS = {"in", "highp", "mediump", "lowp", "precise"}


def lift(text: str) -> tuple[str, list[str]]:
    """The text with its k-th float literal made the uniform ``hn_literal_k``, every line staying where it is.

    Returns the text and the literals' texts. ``const`` goes from all that is no integer or bool, since its value is
    no constant of the language any more. Literals inside [] and in what is const stay: the length of an array must be
    constant.
    """
    code = Text(text)
    literals: list[str] = []
    depth = 0
    const = False
    for k in code.solid():
        word = code[k]
        depth += (word == "[") - (word == "]")
        if word == "const":
            const = bool(_STAYS_CONST.match(code[_declared(code, k)]))
            code.tokens[k].text = word if const else ""
        elif word in (";", "{"):  # of a declaration, or after a parameter's
            const = False
        elif not depth and not const and code.tokens[k].kind == "number" and (match := _FLOAT.match(word)):
            code.tokens[k].text = f"{PREFIX}{len(literals)}"
            literals.append(match["value"])
    first = next(code.solid(), None)
    if literals and first is not None:
        names = ", ".join(f"{PREFIX}{k}" for k in range(len(literals)))
        code.tokens[first].before = f"uniform float {names}; "
    return for_spirv(str(code)), literals


def _declared(code: Text, const: int) -> int:
    """The type's place in the declaration that a ``const`` belongs to."""
    k = code.next(const)
    while code[k] in _QUALIFIERS:
        k = code.next(k)
    return k


def for_spirv(text: str) -> str:
    """The text as desktop GL of a version and with a layout of its uniform blocks that SPIR-V can be made of."""
    stated, newline, rest = text.partition("\n")
    if stated.split()[-1] == "es":
        stated = _DESKTOP
    elif int(stated.split()[1]) < _LOWEST:
        stated = f"#version {_LOWEST}"
    return stated + newline + rest.replace("layout(packed)", "layout(std140)")
