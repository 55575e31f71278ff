"""Rewrites preprocessed GLSL, token by token, every line staying where it is."""

from __future__ import annotations

from itertools import takewhile

from .tokens import CLOSING, PRECISION, Statement, Text

_INTERFACE = {"in", "out", "flat", "smooth", "noperspective", "centroid", "sample", "invariant", "precise"}


def struct_names(text: str) -> list[str]:
    """The structures that a preprocessed text declares globally, in order."""
    code = Text(text)
    return [name for s in code.statements() if s.body is None for name in code.struct_names(s.first, s.last)]


def result_names(text: str) -> list[str]:
    """The name of the type that each function of a preprocessed text returns, [] left out, in order."""
    code = Text(text)
    names = []
    for function in code.statements():
        if function.body is not None:
            before = code.solid(function.first, code.function_name(function) - 1)
            words = [code[k] for k in before if code.tokens[k].kind == "word"]
            names.append(words[-1] if words else "")
    return names


def isolate(text: str) -> str:
    """The text without main(), and with its inputs and outputs made plain global variables.

    What is left can be evaluated in a stage of ours, whose inputs and outputs are our own. The members of uniform
    blocks become uniforms, by the names that they have in the source: no program of another stage shares their memory.
    """
    code = Text(text)
    for statement in code.statements():
        if statement.body is not None:
            if code[code.function_name(statement)] == "main":
                code.blank(statement.first, statement.last)
            continue
        head = list(takewhile(lambda k: code[k] not in ("{", ";", "="), code.solid(statement.first, statement.last)))
        words = {code[k] for k in head}
        after = code.next(head[-1]) if head else None
        if "uniform" in words and "struct" not in words and after is not None and code[after] == "{":
            _open_block(code, statement, head)
            continue
        dropped, k = [], statement.first
        while code[k] in _INTERFACE or code[k] == "layout" or code[k] in PRECISION:
            end = code.closing(code.next(k)) if code[k] == "layout" else k
            dropped.append((k, end))
            k = code.next(end)
        qualifiers = {code[a] for a, _ in dropped}
        after = code[code.next(k)] if k < statement.last else ""
        if qualifiers and (code[k].startswith("gl_") or after.startswith("gl_")):
            code.blank(statement.first, statement.last)  # redeclares a variable of the stage
        elif "invariant" in qualifiers and after in (",", ";"):
            code.blank(statement.first, statement.last)  # of an output that is none any more
        if not qualifiers & {"in", "out"} or after == "{":
            continue
        for a, b in dropped:
            code.blank(a, b)
        if code[k] == ";":
            code.blank(k, k)
    return str(code)


def _open_block(code: Text, block: Statement, head: list[int]) -> None:
    """Makes uniforms of the members of a block; of one with a name a structure, and a uniform of that."""
    opening = code.next(head[-1])
    closing = code.closing(opening)
    instance = code.next(closing)
    for k in [k for k in code.solid(block.first, closing) if code[k] == "layout"]:
        code.blank(k, code.closing(code.next(k)))
    uniform = next(k for k in head if code[k] == "uniform")
    if code[instance] == ";":
        for k in (*head, opening, closing, instance):
            code.blank(k, k)
        k = code.next(opening)
        while k != closing:
            code.tokens[k].before = "uniform "
            k = code.next(next(j for j in code.solid(k) if code[j] == ";"))
    else:
        code.tokens[uniform].text = "struct"
        code.tokens[closing].after = f"; uniform {code[head[-1]]}"


def has_variables(text: str) -> bool:
    """Whether a preprocessed text declares global variables that can change: one call could find what another left."""
    code = Text(text)
    for statement in code.statements():
        if statement.body is not None:
            continue
        words = [code[k] for k in code.solid(statement.first, statement.last)]
        if not {"const", "uniform", "buffer", "precision"}.isdisjoint(words) or words == [";"]:
            continue
        if "struct" in words:
            closed = len(words) - words[::-1].index("}")
            if words[closed:] != [";"]:
                return True
        elif words[-2:] != [")", ";"] or "=" in words:  # else a prototype
            return True
    return False


def uniform_initialisers(text: str) -> tuple[str, list[str]]:
    """The text with its uniforms' initialisers removed, and the names of those uniforms."""
    code = Text(text)
    names = []
    for statement in code.statements():
        if statement.body is not None:
            continue
        solid = list(code.solid(statement.first, statement.last))
        if "uniform" not in (code[k] for k in solid):
            continue
        name, k = None, solid[0]
        while k is not None and k < statement.last:
            if code[k] == "=":
                end = k
                while code[code.next(end)] not in (",", ";"):
                    end = code.next(end)
                    end = code.closing(end) if code[end] in CLOSING else end
                names.append(name)
                code.blank(k, end)
                k = end
            elif code[k] in CLOSING:
                k = code.closing(k)
            elif code.tokens[k].kind == "word":
                name = code[k]
            k = code.next(k)
    return str(code), names
