"""The table: a row for each thing measured, as text, Markdown and plain data."""

from __future__ import annotations

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

HEADINGS = "measured", "of", "unit", "median", "min", "max", "n", "x harness", "aim", "met", "note"
_NUMBERS = slice(3, 8)  # columns set flush right


@dataclass(frozen=True)
class Row:
    """One thing measured: ``samples`` in ``unit``, none where ``note`` says why there are none.

    ``ratio`` is its median to the harness's. ``aim`` is a limit for the median, ``aim_is`` "at most" or "above".
    ``absent``: not measured for lack of something that this machine need not have.
    """

    measured: str
    of: str
    unit: str = ""
    samples: tuple[float, ...] = ()
    ratio: float | None = None
    aim: float | None = None
    aim_is: str = "at most"
    note: str = ""
    absent: bool = False

    @property
    def median(self) -> float | None:
        """The median of the samples."""
        return statistics.median(self.samples) if self.samples else None

    @property
    def met(self) -> bool | None:
        """Whether the aim was met; None where there is none, or nothing was measured."""
        if self.aim is None or not self.samples:
            return None
        return self.median <= self.aim if self.aim_is == "at most" else self.median > self.aim

    def cells(self) -> tuple[str, ...]:
        """The row's texts, one for each heading."""
        spread = (self.median, min(self.samples), max(self.samples)) if self.samples else (None,) * 3
        return (
            self.measured,
            self.of,
            self.unit,
            *map(number, spread),
            str(len(self.samples) or ""),
            number(self.ratio),
            "" if self.aim is None else f"{self.aim_is} {number(self.aim)}",
            {None: "", True: "yes", False: "NO"}[self.met],
            self.note,
        )

    def data(self) -> dict:
        """The row for JSON."""
        return {
            "measured": self.measured,
            "of": self.of,
            "unit": self.unit,
            "median": self.median,
            "samples": list(self.samples),
            "ratio": self.ratio,
            "aim": None if self.aim is None else f"{self.aim_is} {self.aim:g}",
            "met": self.met,
            "note": self.note,
            "absent": self.absent,
        }


def number(value: float | None) -> str:
    """Three digits, or all of a larger number's whole ones; nothing for None."""
    if value is None:
        return ""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:#.3g}"


def _widths(lines: Sequence[Sequence[str]]) -> list[int]:
    return [max(map(len, column)) for column in zip(*lines, strict=True)]


def _padded(cells: Sequence[str], widths: Sequence[int]) -> list[str]:
    right = range(*_NUMBERS.indices(len(HEADINGS)))
    return [
        cell.rjust(width) if k in right else cell.ljust(width)
        for k, (cell, width) in enumerate(zip(cells, widths, strict=True))
    ]


def text(rows: Sequence[Row]) -> str:
    """Aligned columns, a blank line between the things measured."""
    lines = [HEADINGS, *(row.cells() for row in rows)]
    widths = _widths(lines)
    shown = ["  ".join(_padded(line, widths)).rstrip() for line in lines]
    shown.insert(1, "-" * max(map(len, shown)))
    for k in range(len(rows) - 1, 0, -1):
        if rows[k].measured != rows[k - 1].measured:
            shown.insert(k + 2, "")
    return "\n".join(shown) + "\n"


def markdown(rows: Sequence[Row]) -> str:
    """A Markdown table."""
    lines = [HEADINGS, *(row.cells() for row in rows)]
    lines = [[cell.replace("|", r"\|") for cell in line] for line in lines]
    widths = [max(width, 3) for width in _widths(lines)]
    right = range(*_NUMBERS.indices(len(HEADINGS)))
    rule = ["-" * (width - 1) + (":" if k in right else "-") for k, width in enumerate(widths)]
    shown = [_padded(lines[0], widths), rule, *(_padded(line, widths) for line in lines[1:])]
    return "".join(f"| {' | '.join(line)} |\n" for line in shown)
