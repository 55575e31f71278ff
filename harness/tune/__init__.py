"""Only what a scene requires: the cheapest shaders of a project that keep its picture within a budget.

The reference is the project as it is, with every term of its ladder on the rung of one preset. First goes what no pass
needs (``needs``), then each pass gets the cheapest rung of each term (``search``), by what its fragment stage costs on
a chip (``stage_cost``), as long as the pictures from several views (``views``, ``pictures``) stay within the budget.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from ..errors import HarnessError
from ..trade import scene
from . import views
from .tuner import Tuner
from .tuning import Budget, Choice, PassCost, Refusal, Tuning

__all__ = ["Budget", "Choice", "PassCost", "Refusal", "Tuning", "tune"]

#: of the pictures that are compared
SIZE = (640, 360)


def tune(
    project_path: str | os.PathLike,
    budget: Budget,
    *,
    target: str = "navi21",
    reference: str = "exact",
    n_views: int = views.COUNT,
    size: tuple[int, int] = SIZE,
    write_back: bool = False,
    drawn: Callable[[], None] | None = None,
) -> Tuning:
    """Tunes a project, and with ``write_back`` writes what was chosen into its file, once it has been seen to render
    as found. ``reference`` names a preset of its ladder; ``drawn`` is called after each picture.

    HarnessError for what is wrong in the project, as when it is rendered, and where there is nothing to compare with.
    """
    if budget.flip is not None and scene.flip_unavailable() is not None:
        raise HarnessError(scene.flip_unavailable())
    tuner = Tuner(Path(project_path), budget, target, reference, n_views, size, drawn)
    tuning = tuner.run()
    if write_back and tuning.changes:
        tuner.write(tuning)
    return tuning
