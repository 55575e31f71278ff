"""Which of the functions of one name is meant: chosen by the arguments of a call, or by the text of a signature."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ..errors import CallError
from ..language.signature import Signature
from . import arguments

_QUALIFIERS = {"const", "in", "out", "inout", "highp", "mediump", "lowp", "precise"}


class Chosen(NamedTuple):
    """A function, the leaves of its arguments by parameter, and the keywords that name no parameter."""

    signature: Signature
    numbers: dict[str, list[np.ndarray]]
    rest: dict[str, Any]


def choose(overloads: Sequence[Signature], args: Sequence, kwargs: Mapping[str, Any], path: str) -> Chosen:
    """The overload that the arguments fit best: with the fewest uniforms, then with the fewest numbers to convert.

    CallError when none fits, or several fit equally well: it lists them, with what each lacks.
    """
    fitting, errors = [], []
    for signature in overloads:
        try:
            given, rest = arguments.bind(signature, args, kwargs)
            numbers = {p.name: arguments.numbers(p, given[p.name]) for p in signature.inputs}
            fitting.append(Chosen(signature, numbers, rest))
        except CallError as error:
            errors.append((signature, error.message))
    if len(fitting) > 1:
        misfits = [(len(fit.rest), arguments.conversions(fit.signature, fit.numbers)) for fit in fitting]
        fitting = [fit for fit, misfit in zip(fitting, misfits, strict=True) if misfit == min(misfits)]
    if len(fitting) == 1:
        return fitting[0]
    if len(overloads) == 1:
        signature, message = errors[0]
        raise CallError(f"{message}; it is {signature}", *signature.origin)
    name = overloads[0].name
    if fitting:
        listed = "".join(f"\n    {fit.signature}" for fit in fitting)
        example = key(fitting[0].signature)
        message = f'more than one overload fits these arguments; choose one by shader["{example}"]; there are:{listed}'
    else:
        listed = "".join(f"\n    {signature}: {message}" for signature, message in errors)
        message = f"no overload fits these arguments; there are:{listed}"
    raise CallError(f"{name}: {message}", path)


def key(signature: Signature) -> str:
    """What tells an overload from the others, and selects it: ``name(vec3, float)``."""
    return f"{signature.name}({', '.join(str(p.type) for p in signature.parameters)})"


def named(text: str) -> str:
    """The name in a text that may be a signature, such as ``vec3 name(vec3 v)``."""
    words = re.findall(r"\w+", text.partition("(")[0])
    return words[-1] if words else text


def select(overloads: Sequence[Signature], text: str, path: str) -> Signature:
    """The overload with the parameters of ``name(vec3, float)``. CallError lists those that there are.

    White space, qualifiers, names of parameters and the returned type do not matter.
    """
    wanted = _parameters(text)
    for signature in overloads:
        if [str(p.type) for p in signature.parameters] == wanted:
            return signature
    listed = "".join(f"\n    {signature}" for signature in overloads)
    raise CallError(f"no overload {text.strip()}; there are:{listed}", path)


def _parameters(text: str) -> list[str] | None:
    """The types in the brackets of a signature, arrays as in ``float[3]``; None where there are no brackets."""
    inside = re.search(r"\((.*)\)\s*$", text)
    types = []
    for parameter in inside[1].split(",") if inside else ():
        words = [word for word in re.findall(r"\w+|\[\s*\w*\s*\]", parameter) if word not in _QUALIFIERS]
        after_type = next((k for k, word in enumerate(words[1:], 1) if word[0] != "["), len(words))
        lengths = words[after_type + 1 :] + words[1:after_type]  # of `float[2] x[3]` the outer is 3
        types.append("".join([*words[:1], *("".join(length.split()) for length in lengths)]))
    return None if not inside else [] if types in ([""], ["void"]) else types
