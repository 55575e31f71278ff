"""Where the choices of a trade lie: cost against error, a panel for the presets and one for each term, labels placed so
that none covers another. Coordinates only; templates/pareto.svg.jinja draws them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from . import figures, pareto, text
from .pareto import Point

WIDTH, HEIGHT = 290, 270  # of a panel with all that belongs to it
COLUMNS = 4
LEFT, RIGHT, TOP, BOTTOM = 48, 8, 34, 44  # of a panel, outside its frame
CHARACTER, LINE = 6.9, 13  # of a label, as wide as capitals of 11 pixels in the widest of usual sans-serif fonts
GAP = 5  # between two labels beside each other
RADIUS = 7  # of a mark, with its ring
THICK = 1.5  # half the width of the front's line, with room
HEADROOM = 0.6  # decades above the largest error and below the smallest


@dataclass(frozen=True)
class Box:
    """From (left, top) to (right, bottom), y down."""

    left: float
    top: float
    right: float
    bottom: float

    def overlap(self, other: Box) -> float:
        """The area that both cover."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.bottom, other.bottom) - max(self.top, other.top)
        return width * height if width > 0 and height > 0 else 0.0


@dataclass(frozen=True)
class Mark:
    """One choice at (x, y), its ``label`` in a box, and ``by`` whom it is dominated, if it is. ``tip`` tells its
    figures. ``far``: a line has to show to what the label belongs."""

    x: float
    y: float
    label: str
    box: Box
    far: bool
    by: str | None
    default: bool
    tip: str


@dataclass(frozen=True)
class Panel:
    """The presets, or the rungs of a term. ``frame`` is what the axes enclose, ``steps`` the corners of the front."""

    title: str
    macro: str
    frame: Box
    marks: Sequence[Mark]
    steps: Sequence[tuple[float, float]]
    x_ticks: Sequence[tuple[float, str]]
    y_ticks: Sequence[tuple[float, str]]


@dataclass(frozen=True)
class Plot:
    """All panels of one target."""

    target: str
    width: float
    height: float
    panels: Sequence[Panel]


def plot(data: Mapping[str, Any], target: str) -> Plot | None:
    """The plot of one target; None where nothing was measured on it. The axis of errors is the same in all panels."""
    groups = [("Presets", "", None, data["presets"], 2)]
    groups += [(t["title"], t["macro"], t["default"], t["rungs"], 1) for t in data["terms"]]
    known = [(*group, figures.points(group[3], target)) for group in groups]
    known = [group for group in known if group[-1]]
    if not known:
        return None
    decades = _decades([point.error for group in known for point in group[-1]])
    panels = []
    column = row = 0
    for title, macro, default, entries, span, points in known:
        if column + span > COLUMNS:
            column, row = 0, row + 1
        frame = Box(
            column * WIDTH + LEFT, row * HEIGHT + TOP, (column + span) * WIDTH - RIGHT, (row + 1) * HEIGHT - BOTTOM
        )
        panels.append(_panel(title, macro, default, entries, points, frame, decades))
        column += span
    return Plot(target, COLUMNS * WIDTH, (row + 1) * HEIGHT, panels)


def _panel(
    title: str,
    macro: str,
    default: str | None,
    entries: Sequence[Mapping[str, Any]],
    points: Sequence[Point],
    frame: Box,
    decades: tuple[float, float],
) -> Panel:
    low, high = _padded([point.cost for point in points])

    def x(cost: float) -> float:
        return frame.left + (cost - low) / (high - low) * (frame.right - frame.left)

    def y(wrong: float) -> float:
        if wrong in (0, math.inf):  # on the frame
            return frame.bottom if wrong == 0 else frame.top
        share = (math.log10(wrong) - decades[0]) / (decades[1] - decades[0])
        return frame.bottom - share * (frame.bottom - frame.top)

    corners = [(x(point.cost), y(point.error)) for point in pareto.front(points)]
    steps = [(corners[0][0], frame.top)]
    for corner in corners:
        steps += [(corner[0], steps[-1][1]), corner]
    steps.append((frame.right, corners[-1][1]))
    steps = steps[1:]
    beaten = pareto.dominated(points)
    places = [(x(point.cost), y(point.error)) for point in points]
    labels = [_short(point.name, points) for point in points]
    boxes = place(places, labels, frame, steps)
    measured = {entry["name"]: entry for entry in entries}
    marks = [
        Mark(
            *at,
            label,
            box,
            _distance(at, box) > RADIUS + 5,
            beaten.get(point.name),
            point.name == default,
            _tip(point, measured[point.name], beaten.get(point.name)),
        )
        for point, at, label, box in zip(points, places, labels, boxes, strict=True)
    ]
    first, last = math.ceil(decades[0]), math.floor(decades[1])
    exponents = range(last, first - 1, -2 if last - first > 4 else -1)
    return Panel(
        title,
        macro,
        frame,
        marks,
        steps,
        [(x(tick), f"{tick:g}") for tick in _ticks(low, high, 6 if frame.right - frame.left > WIDTH else 3)],
        [(y(10.0**exponent), f"1e{exponent}" if exponent else "1") for exponent in exponents],
    )


def place(
    places: Sequence[tuple[float, float]],
    labels: Sequence[str],
    frame: Box,
    line: Sequence[tuple[float, float]] = (),
) -> list[Box]:
    """A box for the label of each mark: beside it where there is room, else the nearest place within the frame that no
    mark, no other label and no part of ``line`` takes, its corners, one straight above or beside the last."""
    taken = [Box(x - RADIUS, y - RADIUS, x + RADIUS, y + RADIUS) for x, y in places]
    for (x, y), (to_x, to_y) in zip(line, line[1:], strict=False):
        taken.append(Box(min(x, to_x) - THICK, min(y, to_y) - THICK, max(x, to_x) + THICK, max(y, to_y) + THICK))
    for (x, y), label in zip(places, labels, strict=True):
        width = len(label) * CHARACTER + GAP
        around = [_within(frame, left, top, width) for left, top in _around(x, y, width)]
        taken.append(min(around, key=lambda box: sum(box.overlap(other) for other in taken)))
    return taken[len(taken) - len(places) :]


def _within(frame: Box, left: float, top: float, width: float) -> Box:
    """A label's box, moved into the frame where it is outside."""
    left = max(min(left, frame.right - width), frame.left)
    top = max(min(top, frame.bottom - LINE), frame.top)
    return Box(left, top, left + width, top + LINE)


def _around(x: float, y: float, width: float) -> list[tuple[float, float]]:
    """Left and top of boxes around a mark, the nearest first: right, left, above and below, then farther out."""
    middle, gap = y - LINE / 2, RADIUS + 1
    found = [(x + gap, middle), (x - gap - width, middle), (x - width / 2, y - gap - LINE), (x - width / 2, y + gap)]
    for ring in range(1, 16):
        shift = ring * 7
        for up in (-1, 1):
            top = middle + up * (shift + 4)
            found += [(x + gap, top), (x - gap - width, top), (x - width / 2, top)]
    return found


def _distance(at: tuple[float, float], box: Box) -> float:
    """From a mark's middle to the nearest point of its label's box."""
    across = max(box.left - at[0], 0, at[0] - box.right)
    along = max(box.top - at[1], 0, at[1] - box.bottom)
    return math.hypot(across, along)


def _short(name: str, points: Sequence[Point]) -> str:
    """V_HAMMON among V_... as HAMMON: the panel's title says the rest."""
    prefix = name.partition("_")[0] + "_"
    return name.removeprefix(prefix) if all(point.name.startswith(prefix) for point in points) else name


def _tip(point: Point, entry: Mapping[str, Any], by: str | None) -> str:
    model = text.number(entry["model"]["p99"])
    told = f"{point.name}: {point.cost:g} cycles, error {text.number(point.error)}, of which the formula {model}"
    return told + (f"; dominated by {by}" if by else "")


def _decades(errors: Sequence[float]) -> tuple[float, float]:
    """Exponents of ten around all errors that are finite and not 0."""
    exponents = [math.log10(wrong) for wrong in errors if 0 < wrong < math.inf] or [0.0]
    return min(exponents) - HEADROOM, max(exponents) + HEADROOM


def _padded(costs: Sequence[float]) -> tuple[float, float]:
    """A range with room beside the outermost marks."""
    low, high = min(costs), max(costs)
    margin = 0.14 * (high - low) or 0.05 * abs(high) or 1.0
    return low - margin, high + margin


def _ticks(low: float, high: float, wanted: int) -> list[float]:
    """Round numbers in a range, about so many."""
    raw = (high - low) / wanted
    unit = 10.0 ** math.floor(math.log10(raw))
    step = next(unit * factor for factor in (1, 2, 5, 10) if unit * factor >= raw)
    first = math.ceil(low / step)
    return [n * step for n in range(first, math.floor(high / step) + 1)]
