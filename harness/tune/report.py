"""What tuning came to, as tables to read and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

from ..trade.scene import Difference
from . import views
from .tuning import Tuning

#: of the steps that are over the budget, as many are shown
_NEAREST = 3


def text(tuning: Tuning, *, written_to: str | None = None) -> str:
    """Tables: the choices pass by pass, what the passes cost, how far the pictures are from the reference.
    ``written_to`` is the file that the choices were written to."""
    width, height = tuning.size
    against = f"the preset {tuning.reference}" if tuning.reference else "itself: there is no ladder.toml by its shaders"
    lines = [
        f"{tuning.project} against {against}, {len(tuning.views)} views of {width} x {height}",
        f"views: {views.described(tuning.views)}; {tuning.pictures} pictures drawn",
        f"budget: {tuning.budget}",
        "",
    ]
    if tuning.reason:
        lines[-1:-1] = [f"no GPU's instructions: {tuning.reason}"]
    lines += _choices(tuning) + _costs(tuning) + _pictures(tuning)
    if tuning.refused:
        nearest = sorted(tuning.refused, key=lambda r: (r.more_than.max, -r.saves))[:_NEAREST]
        lines += ["", f"Each of the {len(tuning.refused)} single steps further down is beyond the budget:"]
        lines += _table(
            [[r.pass_name, f"{r.macro} = {r.rung}", f"{r.saves:g}", _over(r.more_than)] for r in nearest],
            ["pass", "nearest", "saves", "changes at least"],
        )
    else:
        lines += ["", "There is no single step further down."]
    if written_to:
        lines += ["", f"written to {written_to}" if tuning.changes else f"{written_to} says so already"]
    elif tuning.changes:
        lines += ["", "--write puts it into the project"]
    return "\n".join(lines) + "\n"


def _choices(tuning: Tuning) -> list[str]:
    if not tuning.choices:
        return [
            "Nothing to gain: every pass needs what it has by the reference."
            if tuning.reference
            else "Nothing to gain."
        ]
    rows = [[c.pass_name, c.text, f"{c.saves:g}", *_seen(c.alone)] for c in tuning.choices]
    return _table(rows, ["pass", "choice", "saves", "alone changes", "of the pixels"])


def _costs(tuning: Tuning) -> list[str]:
    rows = [[c.name, *(f"{n:g}" for n in (c.written, c.reference, c.chosen))] for c in tuning.costs]
    total = [sum(getattr(c, kind) for c in tuning.costs) for kind in ("written", "reference", "chosen")]
    rows.append(["all", *(f"{n:g}" for n in total)])
    driver = f" ({tuning.driver})" if tuning.driver else ""
    named = tuning.reference or "reference"
    return ["", *_table(rows, [f"{tuning.unit}{driver}", "as written", named, "chosen"])]


def _pictures(tuning: Tuning) -> list[str]:
    rows = [["as written", *_seen(tuning.written)], ["chosen", *_seen(tuning.chosen)]]
    if tuning.budget.flip is not None:
        for row, difference in zip(rows, (tuning.written, tuning.chosen), strict=True):
            row.append(f"{difference.flip:.4f}")
    heads = ["picture", "largest change", "of the pixels", *(["FLIP"] if tuning.budget.flip is not None else [])]
    return ["", *_table(rows, heads)]


def _seen(difference: Difference) -> list[str]:
    share = 100 * difference.changed
    return [f"{difference.max:g}/255", f"{share:.2g} %" if share else "0"]


def _over(difference: Difference) -> str:
    flip = f", FLIP {difference.flip:.4f}" if difference.flip is not None else ""
    return f"{difference.max:g}/255{flip}"


def _table(rows: Sequence[Sequence[str]], heads: Sequence[str]) -> list[str]:
    """Columns as wide as what is in them; numbers to the right."""
    widths = [max(map(len, column)) for column in zip(heads, *rows, strict=True)]
    right = [all(row[k][:1].isdigit() or row[k][:1] == "-" for row in rows) for k in range(len(heads))]

    def line(cells: Iterable[str]) -> str:
        padded = (c.rjust(w) if r else c.ljust(w) for c, w, r in zip(cells, widths, right, strict=True))
        return "  ".join(padded).rstrip()

    return [line(heads), *map(line, rows)]


def as_json(tuning: Tuning) -> str:
    """All of it but the project's bytes."""
    found: dict[str, Any] = {k: v for k, v in vars(tuning).items() if k not in ("data", "views")}
    found["views"] = [{k: v for k, v in vars(view).items() if k != "line"} for view in tuning.views]
    for name in ("budget", "written", "chosen"):
        found[name] = asdict(found[name])
    for name in ("costs", "choices", "refused"):
        found[name] = [asdict(entry) for entry in found[name]]
    return json.dumps(found, indent=2) + "\n"
