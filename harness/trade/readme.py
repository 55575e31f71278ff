"""The trade in a README: the answers and the table of the presets between two marks, and whether they are still so."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import HarnessError
from . import answers, markdown, tables, text

BEGIN = "<!-- the trade: written by `make trade-readme` from docs/trade.json -->"
END = "<!-- end of the trade -->"

INTRODUCTION = """\
What each preset of the shading model costs and how wrong it is, measured by `make trade`: it writes `build/trade/`, a \
page with plots, maps of the errors and pictures of the differences, the same for each rung of each term, and \
`trade.json`. \
`make trade-readme` writes this table and [`docs/trade.json`](docs/trade.json) anew."""


def block(data: Mapping[str, Any]) -> str:
    """What stands between the marks, the marks too."""
    named = [
        f"for {answer.use} **{answer.name}**" if answer.name else f"for {answer.use} no answer"
        for answer in answers.answers(data)
    ]
    parts = [
        BEGIN,
        text.wrapped(INTRODUCTION),
        text.wrapped(f"By its rules: {', '.join(named)}; it says why, and what one gives up."),
        markdown.table(tables.summary(data, data["presets"])),
        text.wrapped(markdown.legend(data)),
        text.wrapped(f"Measured on {markdown.machine(data)}; ns on {_clocks(data)}."),
        END,
    ]
    return "\n\n".join(parts)


def updated(old: str, data: Mapping[str, Any], path: Path) -> str:
    """The README's text with the block of this trade in place of the one that is there. HarnessError without marks."""
    start, end = place(old, path)
    return old[:start] + block(data) + old[end:]


def place(old: str, path: Path) -> tuple[int, int]:
    """Where the block begins and ends in the text of the README at ``path``. HarnessError without marks."""
    start, end = old.find(BEGIN), old.find(END)
    if start < 0 or end < start:
        raise HarnessError(f"has no place for the table; put these two lines where it shall be:\n{BEGIN}\n{END}", path)
    return start, end + len(END)


def _clocks(data: Mapping[str, Any]) -> str:
    devices = [f"{device} ({backend})" for backend, device in tables.timed_by(data["presets"])]
    return ", ".join(devices) or "nothing: no time was taken"
