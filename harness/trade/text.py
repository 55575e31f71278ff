"""The figures of a trade as words: how a number, a count or a share is written in its report."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Mapping
from typing import Any

#: of a line of Markdown
WIDTH = 120
#: stands for what was not measured
NONE = "–"


def number(value: float | None) -> str:
    """Two digits: 0.27, 35, 1.6e-4, ∞."""
    if value is None:
        return NONE
    if not math.isfinite(value):
        return "NaN" if math.isnan(value) else "∞"
    text = f"{value:.2g}" if value == 0 or 1e-2 <= abs(value) < 99.5 else f"{value:.1e}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def plain(value: float | None, digits: int = 3) -> str:
    """A number near 1 in so many digits: 1.86, 0.85."""
    return NONE if value is None else f"{value:.{digits}g}"


def count(value: float | None) -> str:
    """A whole number with its thousands apart, by spaces that no line is broken at: 1 048 576."""
    return NONE if value is None else f"{value:,.0f}".replace(",", "\N{NO-BREAK SPACE}")


def percent(share: float | None) -> str:
    """A share of 0...1: 46 %, 0.3 %."""
    return NONE if share is None else f"{100 * share:.2g} %" if share < 0.995 else f"{100 * share:.0f} %"


def time(measured: Mapping[str, Any]) -> str:
    """Nanoseconds with their spread: 0.85 (0.77–1.02)."""
    return f"{plain(measured['ns'])} ({plain(measured['low'])}–{plain(measured['high'])})"


def share_broken(broken: int | None, inputs: int) -> str:
    """How many of the extreme inputs: 10, or 21 012 (2.0 %) where it is more than one in a thousand."""
    if broken is None:
        return NONE
    return f"{count(broken)} ({percent(broken / inputs)})" if broken > inputs / 1000 else count(broken)


def short(device: str) -> str:
    """A device's name without what is in brackets after it."""
    return device.partition(" (")[0]


def wrapped(paragraph: str) -> str:
    """Filled lines of at most WIDTH, none broken within `code`."""
    held = re.sub(r"`[^`]*`", lambda code: code[0].replace(" ", "\0"), re.sub("[ \\n]+", " ", paragraph.strip()))
    return textwrap.fill(held, WIDTH, break_long_words=False, break_on_hyphens=False).replace("\0", " ")
