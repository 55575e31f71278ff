"""The tables of a trade: the same rows for the terminal, Markdown, the README and the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from . import figures, text
from .figures import HALF, SINGLE, Entry

MODES = ("as-written", "precise", "mediump", "double")


@dataclass(frozen=True)
class Table:
    """The first column names what the others are figures of."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def summary(data: Mapping[str, Any], entries: Sequence[Entry]) -> Table:
    """All of each entry in one row: how wrong, how sound, how dear. A device that timed it has a column of its own."""
    devices = timed_by(entries)
    columns = [
        "",
        "differs by",
        "rounding",
        "in half",
        "breaks",
        "half breaks",
        *data["targets"],
        "SPIR-V",
        *(f"ns, {text.short(device)}" for _, device in devices),
        "scene /255",
        "ꟻLIP",
    ]
    rows = []
    for entry in entries:
        scene = entry["scene"] or {}
        rows.append(
            (
                entry["name"],
                text.number(figures.p99(entry["model"])),
                text.number(figures.rounding(entry)),
                text.number(figures.rounding(entry, HALF)),
                text.count(figures.broken(entry, SINGLE)),
                text.count(figures.broken(entry, HALF)),
                *(text.plain(figures.cycles(entry, target), 4) for target in data["targets"]),
                text.plain(figures.operations(entry)),
                *(text.plain(clock and clock["ns"]) for clock in (timed(entry, device) for device in devices)),
                text.NONE if scene.get("max") is None else f"{scene['max']:g}",
                text.number(scene.get("flip")),
            )
        )
    return Table(tuple(columns), tuple(rows))


def sources(entries: Sequence[Entry]) -> Table:
    """What each entry is, who says so, where it is meant to hold and what it suits."""
    rows = []
    for entry in entries:
        macros = ", ".join(entry["macros"].values())
        suits = ", ".join(entry.get("suits") or ()) or text.NONE
        rows.append((entry["name"], entry["title"], entry["source"], entry.get("domain") or text.NONE, suits, macros))
    return Table(("", "title", "source", "meant for", "suits", "macros"), tuple(rows))


def errors(entries: Sequence[Entry]) -> Table:
    """How far from the exact one, and from itself in double: median, 99th percentile and largest of each."""
    columns = ["", *(f"{kind}, {part}" for kind in ("formula", *MODES[:3]) for part in ("median", "p99", "max"))]
    rows = []
    for entry in entries:
        measured = [entry["model"], *((entry["roundoff"] or {}).get(mode) for mode in MODES[:3])]
        cells = (text.number((found or {}).get(part)) for found in measured for part in ("median", "p99", "max"))
        rows.append((entry["name"], *cells, where(entry["model"])))
    return Table((*columns, "formula is worst at"), tuple(rows))


def extremes(entries: Sequence[Entry]) -> Table:
    """At how many extreme inputs a value is not finite, and at how many negative, in each mode."""
    columns = ("", "inputs", *(f"{mode}, {kind}" for mode in MODES for kind in ("not finite", "negative")))
    rows = []
    for entry in entries:
        measured = entry["extremes"] or {}
        counts = (
            text.count((measured.get(mode) or {}).get(kind)) for mode in MODES for kind in ("non_finite", "negative")
        )
        rows.append((entry["name"], text.count(measured.get("inputs")), *counts))
    return Table(columns, tuple(rows))


def energy(entries: Sequence[Entry]) -> Table:
    """What a white furnace gets back, at most and at least, and how far the model is from reciprocal."""
    rows = []
    for entry in entries:
        measured = entry["energy"] or {}
        furnace = (text.plain(measured.get(f"furnace_{end}"), 5) for end in ("max", "min"))
        rows.append((entry["name"], *furnace, text.number(measured.get("reciprocity"))))
    return Table(("", "furnace, at most", "furnace, at least", "reciprocity defect"), tuple(rows))


def costs(data: Mapping[str, Any], entries: Sequence[Entry]) -> Table:
    """Instructions, registers, latency and cycles on each target."""
    parts = ("instructions", "vgprs", "latency", "cycles")
    columns = (
        "",
        *(f"{target}, {part}" for target in data["targets"] for part in parts),
        "SPIR-V operations, weighted",
    )
    rows = []
    for entry in entries:
        cost = entry["cost"] or {}
        cells = (text.plain((cost.get(target) or {}).get(part), 4) for target in data["targets"] for part in parts)
        rows.append((entry["name"], *cells, text.plain(cost.get("spirv"), 4)))
    return Table(columns, tuple(rows))


def times(entries: Sequence[Entry], device: tuple[str, str]) -> Table:
    """Nanoseconds an evaluation on one device, and the ratio to the reference there."""
    rows = [(entry["name"], timed(entry, device)) for entry in entries]
    return Table(
        ("", "ns an evaluation", "of the reference's"),
        tuple((name, text.time(found), f"{text.plain(found['ratio'])} ×") for name, found in rows if found),
    )


def missing(entries: Sequence[Entry]) -> list[tuple[str, str, list[str]]]:
    """What was not measured: part, reason, and the entries of which that is so."""
    found: dict[tuple[str, str], list[str]] = {}
    for entry in entries:
        for part, reason in (entry.get("missing") or {}).items():
            found.setdefault((part, reason), []).append(entry["name"])
    return [(part, reason, names) for (part, reason), names in found.items()]


def every(data: Mapping[str, Any]) -> list[Entry]:
    """The presets, then the rungs of each term."""
    return [*data["presets"], *(rung for term in data["terms"] for rung in term["rungs"])]


def timed_by(entries: Sequence[Entry]) -> list[tuple[str, str]]:
    """Backend and device of all that took the time, in order."""
    return list(dict.fromkeys((t["backend"], t["device"]) for entry in entries for t in entry["time"] or ()))


def timed(entry: Entry, device: tuple[str, str]) -> Mapping[str, Any] | None:
    """The time of an entry on a device."""
    return next((t for t in entry["time"] or () if (t["backend"], t["device"]) == device), None)


def where(spread: Mapping[str, Any] | None) -> str:
    """The inputs at which an error is largest: NoL 0.25, alpha 0.01; nowhere where there is none."""
    if not spread or not spread["max"]:
        return text.NONE
    return ", ".join(f"{name} {_value(value)}" for name, value in spread["at"].items())


def _value(value: Any) -> str:
    if isinstance(value, list | tuple):
        return f"({', '.join(_value(part) for part in value)})"
    return text.number(value)
