"""Numbers, truth values and texts of a .sprj, as SHADERed reads them. What it would read wrongly is an error.

SHADERed takes the longest beginning that is a number, and 0 where there is none ("0,5" is 0): here all of it
must be one.
"""

from __future__ import annotations

import re

from .project import Number, VariableType
from .xml_lines import Element

_REAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_INTEGER = re.compile(r"[+-]?\d+")
_LARGEST_FLOAT = 3.4028235677973366e38  # where a double rounds to a float's infinity
_WHITE_SPACE = " \t\n\r\v\f"

#: characters that SHADERed's buffers hold; it does not check, and longer texts overwrite its memory
NAME_LIMIT, PATH_LIMIT, MACRO_NAME_LIMIT, MACRO_VALUE_LIMIT = 63, 511, 31, 511


def real(at: Element, text: str, what: str) -> float:
    """A float: decimal or exponent, with "." whatever the locale; ``what`` names it in the error."""
    match = _REAL.fullmatch(text.strip(_WHITE_SPACE))
    if not match:
        raise at.error(f'{what} is "{text}", not a number')
    value = float(match[0])
    if abs(value) >= _LARGEST_FLOAT:
        raise at.error(f"{what} is {match[0]}, beyond the range of a float")
    return value


def integer(at: Element, text: str, what: str) -> int:
    """A 32-bit integer."""
    match = _INTEGER.fullmatch(text.strip(_WHITE_SPACE))
    if not match:
        raise at.error(f'{what} is "{text}", not an integer')
    value = int(match[0]) if len(match[0]) < 20 else 2**63
    if not -(2**31) <= value < 2**31:
        raise at.error(f"{what} is {match[0]}, beyond the range of an int")
    return value


def truth(text: str) -> bool:
    """A truth value: true when the first character is one of 1 t T y Y, and false otherwise."""
    return text[:1] in tuple("1tTyY")


def flag(at: Element, name: str, default: bool) -> bool:
    """The truth value of an attribute, ``default`` without it."""
    return truth(at.attributes[name]) if name in at.attributes else default


def limited(at: Element, text: str, limit: int, what: str) -> str:
    """``text``, refused when it does not fit into SHADERed's buffer of ``limit`` characters."""
    if len(text.encode()) > limit:
        raise at.error(f'{what} "{text[:40]}..." is longer than {limit} characters, more than SHADERed can hold')
    return text


def relative_path(at: Element, text: str, what: str) -> str:
    """A path of the project's, backslashes turned; white space belongs to it."""
    if not text:
        raise at.error(f"{what} names no file")
    return limited(at, text.replace("\\", "/"), PATH_LIMIT, f"the path of {what}")


def child_real(at: Element, name: str, what: str, default: float) -> float:
    """The float in the last child ``name``, ``default`` without one."""
    found = at.all(name)
    return real(found[-1], found[-1].text, f"<{name}> of {what}") if found else default


def values(at: Element, variable_type: VariableType, what: str) -> tuple[Number, ...]:
    """The ``<row>``s of ``<value>``s of a variable, row after row; what is not given is 0.

    A row of a matrix is a column of the GLSL matrix.
    """
    parse = {"bool": lambda _, text, __: truth(text), "int": integer, "float": real}[
        re.match("[a-z]+", variable_type.name)[0]
    ]
    rows, columns = variable_type.rows, variable_type.columns
    flat: list[Number] = [parse(at, "0", what)] * (rows * columns)
    for r, row in enumerate(at.all("row")):
        for c, value in enumerate(row.all("value")):
            if r >= rows or c >= columns:
                raise value.error(f"{what} has more values than a {variable_type.name} ({rows} x {columns})")
            flat[r * columns + c] = parse(value, value.text, f"a value of {what}")
    return tuple(flat)
