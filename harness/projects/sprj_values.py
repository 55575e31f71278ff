"""Numbers, truth values and texts of a .sprj, as SHADERed reads them: as C does.

SHADERed takes the longest beginning that is a number, and 0 where there is none ("0,5" is 0). So does this, with a
warning.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Collection

from ..errors import ProjectError
from .project import Number, VariableType
from .xml_lines import Element

# What strtod takes, and what pugixml takes for an integer.
_REAL = re.compile(
    r"[+-]?(?:0x(?:[0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(?:p[+-]?\d+)?|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|inf(?:inity)?|nan)",
    re.IGNORECASE | re.ASCII,
)
_INTEGER = re.compile(r"([+-]?)(0x[0-9a-f]*|\d+)", re.IGNORECASE | re.ASCII)
_WHITE_SPACE = " \t\n\r\v\f"

#: characters that SHADERed's buffers hold; it does not check, and longer texts overwrite its memory
NAME_LIMIT, PATH_LIMIT, MACRO_NAME_LIMIT, MACRO_VALUE_LIMIT = 63, 511, 31, 511
#: longer numbers say nothing more; conversions of very long ones take for ever
_LONGEST_NUMBER = 300


def _float32(value: float) -> float:
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")


def _beginning(text: str) -> tuple[float, bool]:
    """The number that a text begins with, and whether it is all of the text."""
    text = text.strip(_WHITE_SPACE)[:_LONGEST_NUMBER]
    match = _REAL.match(text)
    if not match:
        return 0.0, False
    number = match[0].lower()
    value = float.fromhex(number) if "0x" in number else float(number)
    return value, match.end() == len(text)


def real(at: Element, text: str, what: str) -> float:
    """A float: decimal or exponent, with "." whatever the locale; ``what`` names it in the warning."""
    value, complete = _beginning(text)
    rounded = _float32(value)
    if not complete or rounded - rounded != 0:
        at.warn(f'{what} is "{_shown(text)}", of which SHADERed makes {rounded:g}')
    return value if rounded - rounded == 0 else rounded


def strict_real(at: Element, text: str, what: str) -> float:
    """The same where SHADERed crashes on what does not begin with a number or is beyond a float's range."""
    value, complete = _beginning(text)
    stripped = text.strip(_WHITE_SPACE)
    rounded = _float32(value)
    if not _REAL.match(stripped) or (rounded - rounded != 0 and value - value == 0):
        raise at.error(f'{what} is "{_shown(text)}", not a number: SHADERed crashes')
    if not complete:
        at.warn(f'{what} is "{_shown(text)}", of which SHADERed makes {rounded:g}')
    return value


def integer(at: Element, text: str, what: str, *, unsigned: bool = False) -> int:
    """A 32-bit integer, decimal or, after 0x, hexadecimal."""
    stripped = text.strip(_WHITE_SPACE)
    match = _INTEGER.match(stripped)
    value = 0
    if match:
        digits = match[2].lower()
        is_hex = digits.startswith("0x")
        digits = (digits[2:] if is_hex else digits).lstrip("0")[:20]
        value = int(digits or "0", 16 if is_hex else 10) * (-1 if match[1] == "-" else 1)
    low, high = (0, 2**32 - 1) if unsigned else (-(2**31), 2**31 - 1)
    clamped = min(max(value, low), high)
    if not match or match.end() != len(stripped) or clamped != value:
        at.warn(f'{what} is "{_shown(text)}", of which SHADERed makes {clamped}')
    return clamped


def _shown(text: str) -> str:
    return text if len(text) <= 40 else text[:40] + "..."


def truth(text: str) -> bool:
    """A truth value: true when the first character is one of 1 t T y Y, and false otherwise."""
    return text[:1] in tuple("1tTyY")


def flag(at: Element, name: str, default: bool) -> bool:
    """The truth value of an attribute, ``default`` without it."""
    return truth(at.attributes[name]) if name in at.attributes else default


def choice(at: Element, value: str, choices: Collection[str], otherwise: str, what: str) -> str:
    """One of ``choices``; with a warning ``otherwise``, which is what SHADERed takes for anything else."""
    if value in choices:
        return value
    listed = ", ".join(c for c in choices if c)
    at.warn(f'{what} is "{_shown(value)}", of which SHADERed makes {otherwise}; there are {listed}')
    return otherwise


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


def child_text(at: Element, name: str) -> Element | None:
    """The last child of that name, which is the one that holds."""
    return next((child for child in reversed(at.children) if child.name == name), None)


def child_real(at: Element, name: str, what: str, default: float) -> float:
    """The float in the last child ``name``, ``default`` without one."""
    found = child_text(at, name)
    return default if found is None else real(found, found.text, f"<{name}> of {what}")


def child_integer(at: Element, name: str, what: str, default: int, *, unsigned: bool = False) -> int:
    """The integer in the last child ``name``, ``default`` without one."""
    found = child_text(at, name)
    return default if found is None else integer(found, found.text, f"<{name}> of {what}", unsigned=unsigned)


def child_flag(at: Element, name: str, default: bool) -> bool:
    """The truth value in the last child ``name``, ``default`` without one."""
    found = child_text(at, name)
    return default if found is None else truth(found.text)


def values(at: Element, variable_type: VariableType, what: str) -> tuple[Number, ...]:
    """The ``<row>``s of ``<value>``s of a variable, row after row; what is not given is 0.

    A row of a matrix is a column of the GLSL matrix. A row that is too long runs on into the next one; beyond the last
    it overwrites SHADERed's memory.
    """
    base = variable_type.base
    flat: list[Number] = [{"bool": False, "int": 0, "float": 0.0}[base]] * variable_type.size
    for r, row in enumerate(at.all("row")):
        for c, value in enumerate(row.all("value")):
            place = c + (r * variable_type.columns if base == "float" else 0)
            if place >= variable_type.size:
                raise _too_many(value, what, variable_type)
            if c >= variable_type.columns or r >= variable_type.rows:
                value.warn(f"{what}: more values than a {variable_type.name} has in a row, or more rows")
            if base == "bool":
                flat[place] = truth(value.text)
            else:
                flat[place] = {"int": integer, "float": real}[base](value, value.text, f"a value of {what}")
    if at.all("value"):
        at.all("value")[0].warn(f"{what}: a <value> outside a <row> is not read")
    return tuple(flat)


def _too_many(value: Element, what: str, variable_type: VariableType) -> ProjectError:
    return value.error(
        f"{what} has more values than a {variable_type.name} ({variable_type.rows} x {variable_type.columns}) holds"
    )
