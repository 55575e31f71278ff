"""A trade as one HTML page that needs nothing but itself: answers, plots, maps, pictures, tables; no scripts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import HarnessError
from ..picture import data_address
from . import answers, illustrate, images, markdown, plots, tables
from .tables import Table

_TEMPLATES = Path(__file__).with_name("templates")
_SCALE = [f"1e{exponent}" if exponent else "1" for exponent in range(-7, 1)]


@dataclass(frozen=True)
class Compared:
    """The picture by a preset, and its difference from the reference's, ``factor`` times as bright as it is."""

    name: str
    picture: str
    difference: str
    factor: int
    scene: Mapping[str, Any] | None


@dataclass(frozen=True)
class Group:
    """The presets, or the rungs of a term, with the tables of them."""

    title: str
    macro: str
    ends: str  # which is exact and which the default
    sources: Table
    errors: Table
    extremes: Table
    energy: Table
    costs: Table
    maps: Sequence[tuple[str, Sequence[tuple[str, str]]]]  # what of, then of which entry
    beaten: Sequence[str]


def page(
    data: Mapping[str, Any],
    pictures: Mapping[str, np.ndarray],
    maps: Mapping[str, Mapping[str, np.ndarray]],
) -> str:
    """The page. HarnessError without jinja2.

    ``pictures``: preset -> the scene, (h, w, 4) uint8, the reference's among them. ``maps``: preset or rung -> what of
    (illustrate.FORMULA, ROUNDING) -> relative errors over the directions of the light, (n, n), NaN outside the disk.
    """
    try:
        import jinja2
    except ImportError:
        raise HarnessError("the page needs jinja2: pip install 'shader-harness[trade]'") from None
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    groups = [_group(data, "Presets", "", "", data["presets"], maps)]
    for term in data["terms"]:
        ends = f"Exact: {term['exact']}. Default: {term['default']}."
        groups.append(_group(data, term["title"], term["macro"], ends, term["rungs"], maps))
    everything = tables.every(data)
    return environment.get_template("index.html.jinja").render(
        data=data,
        answers=answers.answers(data),
        legend=markdown.legend(data),
        summary=tables.summary(data, data["presets"]),
        groups=groups,
        plots=[made for made in (plots.plot(data, target) for target in data["targets"]) if made],
        reference=data_address(pictures[data["reference"]]) if data["reference"] in pictures else None,
        compared=_compared(data, pictures),
        clocks=[(*device, tables.times(everything, device)) for device in tables.timed_by(everything)],
        missing=tables.missing(everything),
        machine=markdown.machine(data),
        view={
            "degrees": f"{illustrate.VIEW:g}",
            "roughness": illustrate.ROUGHNESS,
            "metalness": illustrate.METALNESS,
        },
        scale=data_address(images.scale(256)),
        scale_ticks=_SCALE,
        headed=headed,
    )


def headed(table: Table) -> tuple[list[tuple[str, int]], list[str]]:
    """The head of a table in two rows: "navi21, cycles" is cycles under navi21. Groups with how many columns they span;
    there are none where no column has one."""
    split = [column.partition(", ") if ", " in column else ("", "", column) for column in table.columns]
    spans = [(name, len(list(cells))) for name, cells in groupby(split, key=lambda parts: parts[0])]
    return (spans if any(name for name, _ in spans) else []), [parts[2] for parts in split]


def _group(
    data: Mapping[str, Any],
    title: str,
    macro: str,
    ends: str,
    entries: Sequence[Mapping[str, Any]],
    maps: Mapping[str, Mapping[str, np.ndarray]],
) -> Group:
    shown = [entry["name"] for entry in entries if entry["name"] in maps]
    kinds = dict.fromkeys(kind for name in shown for kind in maps[name])
    return Group(
        title,
        macro,
        ends,
        tables.sources(entries),
        tables.errors(entries),
        tables.extremes(entries),
        tables.energy(entries),
        tables.costs(data, entries),
        [(kind, [(name, data_address(images.heat(maps[name][kind]))) for name in shown]) for kind in kinds],
        markdown.dominated(data, entries),
    )


def _compared(data: Mapping[str, Any], pictures: Mapping[str, np.ndarray]) -> list[Compared]:
    """Every preset but the reference, where both were drawn."""
    reference = pictures.get(data["reference"])
    made = []
    for preset in data["presets"]:
        name = preset["name"]
        if reference is None or name not in pictures or name == data["reference"]:
            continue
        factor = images.amplification(pictures[name], reference)
        off = images.difference(pictures[name], reference, factor)
        made.append(Compared(name, data_address(pictures[name]), data_address(off), factor, preset["scene"]))
    return made
