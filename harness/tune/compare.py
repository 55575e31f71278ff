"""Pictures of a project and of its variants against those of the reference, from all views."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..errors import HarnessError
from ..trade import scene
from ..trade.scene import Difference
from .pictures import Macros, Pictures
from .tuning import Budget


class Comparison:
    """The pictures of the reference, and how far others are from them."""

    def __init__(self, pictures: Pictures, macros: Macros, budget: Budget):
        """The reference is what ``pictures`` show under ``macros``. HarnessError where that is not twice the same."""
        self._budget = budget
        self._reference = draw(pictures, macros)
        self._worst_first = list(range(len(self._reference)))
        if not np.array_equal(pictures.look(macros)(0), self._reference[0]):
            raise HarnessError(
                "the same frame drawn twice gives two pictures: what earlier frames leave shows in them, and choices "
                "cannot be told from that",
                pictures.project.file,
            )

    def difference(self, pictures: Pictures, macros: Macros) -> Difference:
        """Over all views."""
        return _joined([self._seen(picture, view) for view, picture in enumerate(draw(pictures, macros))])

    def measure(self, pictures: Pictures, macros: Macros) -> tuple[Difference, bool]:
        """The difference over all views and True where it is within the budget, else that of the first view that is
        beyond and False. The views that have been beyond it of late are looked at first."""
        look, seen = pictures.look(macros), []
        for view in list(self._worst_first):
            seen.append(self._seen(look(view), view))
            if not self._budget.holds(seen[-1]):
                self._worst_first.remove(view)
                self._worst_first.insert(0, view)
                return seen[-1], False
        return _joined(seen), True

    def _seen(self, picture: np.ndarray, view: int) -> Difference:
        return scene.difference(picture, self._reference[view], flip=self._budget.flip is not None)


def draw(pictures: Pictures, macros: Macros) -> list[np.ndarray]:
    """The picture of each view."""
    look = pictures.look(macros)
    return [look(view) for view in range(len(pictures.views))]


def _joined(differences: Sequence[Difference]) -> Difference:
    """Over several views of one size: the worst maximum and ꟻLIP error, and shares of all pixels."""
    flips = [d.flip for d in differences if d.flip is not None]
    return Difference(
        max(d.max for d in differences),
        float(np.mean([d.mean for d in differences])),
        max(flips, default=None),
        float(np.mean([d.changed for d in differences])),
    )
