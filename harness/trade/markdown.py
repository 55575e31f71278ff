"""A trade as Markdown: the answers, a table of the presets and one of each term."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import answers, figures, pareto, tables, text
from .figures import HALF
from .tables import Table

LEGEND = """\
`differs by` is the 99th percentile of the relative difference from the exact one, in double: what the formula leaves
out. `rounding` is that of float32 against double of the same formula, as written or `precise`, whichever is worse;
`in half` that of `mediump`. `breaks` counts the values at {inputs} extreme inputs that are not finite, and those that
are negative; `half breaks` those of `mediump`. {targets} are cycles of the whole `shade` for a wave of 64, or of the
function itself where `shade` does not call it, by Mesa's own model of chips that need not be there; `SPIR-V` is a
weighted count of operations. `scene /255` is the largest difference from the picture by `{reference}`, ꟻLIP the mean
of what an eye sees of it."""


def document(data: Mapping[str, Any]) -> str:
    """All of it, with what was not measured and why."""
    parts = [f"# The trade of {data['scene']['project']}", _answers(data), table(tables.summary(data, data["presets"]))]
    parts.append(text.wrapped(legend(data)))
    for term in data["terms"]:
        head = f"## {term['title']} ({term['macro']})"
        ends = f"Exact: `{term['exact']}`. Default: `{term['default']}`."
        parts += [head, ends, table(tables.summary(data, term["rungs"]))]
        beaten = dominated(data, term["rungs"])
        if beaten:
            parts.append("Dominated: " + "; ".join(beaten) + ".")
    gaps = [f"- {part}: {reason} ({', '.join(names)})" for part, reason, names in tables.missing(tables.every(data))]
    if gaps:
        parts += ["## Not measured", "\n".join(gaps)]
    parts.append(f"Measured on {machine(data)}.")
    return "\n\n".join(parts) + "\n"


def row(data: Mapping[str, Any], name: str) -> str:
    """The table of one entry alone, and what of it was not measured."""
    chosen = [entry for entry in tables.every(data) if entry["name"] == name]
    gaps = [f"{part}: {reason}" for part, reason, _ in tables.missing(chosen)]
    return "\n".join([table(tables.summary(data, chosen)), *gaps]) + "\n"


def table(made: Table) -> str:
    """With columns as wide as what is in them: it is read in a terminal too."""
    widths = [max(len(cell) for cell in column) for column in zip(made.columns, *made.rows, strict=True)]
    rule = ["-" * widths[0], *("-" * (max(width, 2) - 1) + ":" for width in widths[1:])]

    def line(cells: Sequence[str]) -> str:
        aligned = [cells[0].ljust(widths[0]), *(c.rjust(max(w, 2)) for c, w in zip(cells[1:], widths[1:], strict=True))]
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in aligned) + " |"

    return "\n".join([line(made.columns), line(rule), *(line(cells) for cells in made.rows)])


def legend(data: Mapping[str, Any]) -> str:
    """What the columns of a summary are, in a line."""
    counts = {entry["extremes"]["inputs"] for entry in tables.every(data) if entry["extremes"]}
    inputs = " or ".join(text.count(n) for n in sorted(counts)) or "no"
    targets = ", ".join(f"`{target}`" for target in data["targets"]) or "Targets"
    return " ".join(LEGEND.split()).format(inputs=inputs, targets=targets, reference=data["reference"])


def machine(data: Mapping[str, Any]) -> str:
    """What measured, in a line."""
    words = {"cpu": "", "driver": "", "glslang": "glslang ", "harness": "harness ", "costs": "costs by "}
    return ", ".join(f"{words.get(name, '')}{value}" for name, value in data["machine"].items() if value)


def dominated(data: Mapping[str, Any], entries: Sequence[Mapping[str, Any]]) -> list[str]:
    """Who is beaten in cycles and error at once, by whom, on which targets where not on all, and if not in half."""
    found: dict[tuple[str, str], list[str]] = {}
    for target in data["targets"]:
        for name, by in pareto.dominated(figures.points(entries, target)).items():
            found.setdefault((name, by), []).append(target)
    said = []
    for (name, by), on in found.items():
        places = "" if len(on) == len(data["targets"]) else f" on {', '.join(on)}"
        half = [figures.points(entries, target, HALF) for target in on]
        spared = all(name in {p.name for p in pareto.front(points)} for points in half)
        said.append(f"{name} by {by}{places}" + (" (but not in half precision)" if spared else ""))
    return said


def _answers(data: Mapping[str, Any]) -> str:
    said = []
    for answer in answers.answers(data):
        name = f"**{answer.name}**" if answer.name else "no answer"
        price = f" One gives up: {'; '.join(answer.gives_up)}." if answer.gives_up else ""
        said.append(f"- For {answer.use}: {name}, {answer.why}.{price}")
    return "\n".join(said)
