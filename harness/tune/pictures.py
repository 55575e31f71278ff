"""Pictures of a project under many sets of macros: everything is loaded once, and a pass is linked once a set."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..projects.project import ComputePass, Macro, Pass, Project
from ..projects.traps import Traps
from ..rendering.camera import Camera
from ..rendering.frames import Stage
from ..rendering.prepare import PreparedPass, prepare, relink
from ..rendering.system import Moment

#: name of a pass -> its macros that are others than the project's
Macros = Mapping[str, Mapping[str, str]]


def with_macros(shader_pass: Pass | ComputePass, macros: Mapping[str, str]) -> Pass | ComputePass:
    """The pass with macros defined, those that it has keeping their place."""
    there = [replace(m, value=macros[m.name]) if m.name in macros else m for m in shader_pass.macros]
    names = {m.name for m in there}
    new = [Macro(name, value, shader_pass.line) for name, value in macros.items() if name not in names]
    return replace(shader_pass, macros=(*there, *new))


class Pictures:
    """Draws a project from several views."""

    def __init__(
        self, project: Project, views: Sequence[Camera], size: tuple[int, int], drawn: Callable[[], None] | None = None
    ):
        """``drawn`` is called after each picture. HarnessError for what is wrong in the project."""
        self.project, self.views, self.size = project, views, size
        self._drawn = drawn or (lambda: None)
        self._traps = Traps()
        self._own = prepare(project, self._traps)
        self._linked: dict[tuple, PreparedPass] = {}

    def passes(self, macros: Macros) -> list[PreparedPass]:
        """The passes, ready to draw. GlslError where one does not compile under its macros."""
        return [self._pass(p, macros.get(p.shader_pass.name, {})) for p in self._own]

    def _pass(self, own: PreparedPass, macros: Mapping[str, str]) -> PreparedPass:
        if not macros:
            return own
        key = own.shader_pass.name, tuple(sorted(macros.items()))
        if key not in self._linked:
            self._linked[key] = relink(self.project, own, with_macros(own.shader_pass, macros))
        return self._linked[key]

    def look(self, macros: Macros) -> Callable[[int], np.ndarray]:
        """A function that draws the picture, (h, w, 4) uint8, of one of the views."""
        stage = Stage(self.project, self.passes(macros), self.size, self._traps)

        def picture(view: int) -> np.ndarray:
            stage.system.look(self.views[view])
            stage.draw(Moment())
            self._drawn()
            return stage.window.read_bytes()[::-1]

        return picture
