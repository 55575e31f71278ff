"""What tuning a project came to, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..rendering.camera import Camera
from ..trade.scene import Difference


@dataclass(frozen=True)
class Budget:
    """How far a picture may be from the reference: ``max`` of any channel of any pixel in 1/255, ``flip`` the mean
    ꟻLIP error of any view. None: as far as it likes; one of them is given."""

    max: float | None = None
    flip: float | None = None

    def holds(self, difference: Difference) -> bool:
        """Whether a difference is within it."""
        return (self.max is None or difference.max <= self.max) and (self.flip is None or difference.flip <= self.flip)

    def __str__(self):
        limits = [f"{self.max:g}/255 in every channel of every pixel"] if self.max is not None else []
        return " and ".join(limits + ([f"a mean FLIP error of {self.flip:g}"] if self.flip is not None else []))


@dataclass(frozen=True)
class Choice:
    """Something chosen for a pass: a rung of a term, or to do without something that is not needed (``macro`` None).

    ``saves`` is what it takes off the pass's cost when all choices are made one after the other, so that they add up;
    ``alone`` is what it changes in the picture by itself, in the worst of the views.
    """

    pass_name: str
    text: str
    macro: str | None
    saves: float
    alone: Difference


@dataclass(frozen=True)
class PassCost:
    """What a pass's fragment stage costs: as it is written, by the reference preset, as it was chosen."""

    name: str
    written: float
    reference: float
    chosen: float


@dataclass(frozen=True)
class Refusal:
    """A single step further down. ``more_than`` is how far it takes the picture in the first view that is over."""

    pass_name: str
    macro: str
    rung: str
    saves: float
    more_than: Difference


@dataclass(frozen=True)
class Tuning:
    """All of it. ``macros`` are the rungs chosen, by pass and macro; ``unit`` says what costs are counted in, and
    ``reason`` why that is not a chip's cycles. ``data`` is the project with all choices written into it."""

    project: str
    reference: str | None
    budget: Budget
    views: tuple[Camera, ...]
    size: tuple[int, int]
    unit: str
    driver: str | None
    reason: str | None
    macros: Mapping[str, Mapping[str, str]]
    costs: tuple[PassCost, ...]
    choices: tuple[Choice, ...]
    refused: tuple[Refusal, ...]
    written: Difference  # the project as it is, against the reference
    chosen: Difference
    pictures: int  # how many were drawn
    data: bytes
    changes: bool  # whether data is another than what is in the file
