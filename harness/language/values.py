"""GLSL values as text, as on a command line: ``1,2,3``, ``[0x1.8p-3, nan]``, ``true``. What is written is read back."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..errors import CallError

_TOKEN = re.compile(r"\s*([][(),]|[^][(),\s]+)")


def read(text: str) -> Any:
    """A number, true or false, or a list of such. CallError where it is none.

    Numbers are Python's, in decimal or hexadecimal, 0x1.8p-3 too; inf and nan are numbers.
    """
    tokens = _TOKEN.findall(text)
    try:
        values, rest = _values(tokens, "")
        if rest or not values:
            raise ValueError
    except (ValueError, IndexError, OverflowError):
        raise CallError(f"{text!r} is no number, vector such as 1,2,3, true or false") from None
    return values if "," in _outside(tokens) else values[0]


def written(value: Any) -> str:
    """The text of a value: an array of numbers or bool. Read back and rounded to float32 it has the same bits.

    Of NaN there is one only: neither sign nor payload are kept.
    """
    value = np.asarray(value)
    text = _written(value)
    return text[1:-1] if value.ndim == 1 and value.size > 1 else text  # brackets would have to be quoted


def _written(value: np.ndarray) -> str:
    if value.ndim:
        return f"[{','.join(map(_written, value))}]"
    if value.dtype.kind == "b":
        return str(bool(value)).lower()
    if value.dtype.kind in "iu":
        return str(int(value))
    return number(value)


def number(value: Any) -> str:
    """The shortest decimals that give a float32 back.

    In hexadecimal where those of numpy do not, because reading rounds them to float64 first: 7.038531e-26 is one.
    """
    with np.errstate(over="ignore"):
        single = np.float32(value)
        text = np.format_float_positional(single, trim="-") if 1e-4 <= abs(single) < 1e16 else str(single)
        back = np.float32(float(text))
    return text if back == single or np.isnan(single) else float(single).hex()


def _values(tokens: Sequence[str], end: str) -> tuple[list, Sequence[str]]:
    """The values of a list up to the bracket that ends it, and what follows."""
    values = []
    while tokens and tokens[0] != end:
        if tokens[0] in ("[", "("):
            inner, tokens = _values(tokens[1:], {"[": "]", "(": ")"}[tokens[0]])
            values.append(inner)
        else:
            values.append(_scalar(tokens[0]))
            tokens = tokens[1:]
        if tokens and tokens[0] == ",":
            tokens = tokens[1:]
        elif tokens and tokens[0] != end:
            raise ValueError
    return (values, tokens[1:]) if end and tokens[0] == end else (values, tokens)


def _outside(tokens: Sequence[str]) -> Iterator[str]:
    """The tokens outside all brackets."""
    depth = 0
    for token in tokens:
        depth += (token in "[(") - (token in "])")
        if not depth:
            yield token


def _scalar(text: str) -> bool | int | float:
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    if re.fullmatch(r"[-+]?(\d+|0[xX][\da-fA-F]+)", text):
        return int(text, 16 if "x" in text.lower() else 10)
    if re.match(r"[-+]?0[xX]", text):
        return float.fromhex(text)
    return float(text)
