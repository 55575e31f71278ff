"""Draws frames of prepared passes: targets, clears and draws in SHADERed's order, with SHADERed's rules for them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import native
from ..errors import NativeError, ProjectError
from ..native import Call, Target, gl_enums
from ..projects.project import ComputePass, Image, Pass, Project
from ..projects.traps import Traps
from . import states
from .meshes import PreparedItem
from .prepare import PreparedPass
from .system import Moment, System
from .uniforms import Memory

#: of the window and all render textures
MOST_PIXELS = 2**26
_UNITS = 16


class Stage:
    """The window and the render textures of a project, and everything that lasts from frame to frame."""

    def __init__(
        self, project: Project, passes: Sequence[PreparedPass], size: tuple[int, int], traps: Traps | None = None
    ):
        """``size`` of the window in pixels. ProjectError for render textures that cannot be."""
        self._project = project
        self._passes = passes
        self._size = size
        self._traps = Traps() if traps is None else traps
        self._check_pixels()
        window_format = gl_enums.GL_RGBA32F if project.settings.use_alpha else gl_enums.GL_RGB32F
        self.window = Target(*size, window_format)
        self._render_textures = {t.name: t for t in project.render_textures}
        self._targets: dict[str | None, Target] = {None: self.window} | self._make_targets()
        self._joined = {p.shader_pass.name: self._join(p.shader_pass) for p in passes if _draws(p)}
        #: the values that SHADERed itself gives to variables
        self.system = System(project, size)
        self._memory = Memory()
        self._depth_write = True
        for unit in range(_UNITS):
            for target in (gl_enums.GL_TEXTURE_2D, gl_enums.GL_TEXTURE_3D, gl_enums.GL_TEXTURE_CUBE_MAP):
                native.bind_texture(unit, target, 0)

    # ---- Targets ---------------------------------------------------------------------------------------------

    def _check_pixels(self) -> None:
        total = self._size[0] * self._size[1]
        for texture in self._project.render_textures:
            width, height = texture.pixels(self._size)
            what = f'the render texture "{texture.name}"'
            if width < 1 or height < 1:
                raise ProjectError(f"{what} would be {width} x {height} pixels", self._project.file, texture.line)
            total += width * height
            if total > MOST_PIXELS:
                raise ProjectError(
                    f"{what}: {width} x {height} pixels; with it the window and the render textures have more than "
                    f"{MOST_PIXELS} in all",
                    self._project.file,
                    texture.line,
                )

    def _make_targets(self) -> dict[str, Target]:
        made = {}
        for texture in self._project.render_textures:
            try:
                made[texture.name] = Target(*texture.pixels(self._size), states.FORMATS[texture.format])
            except NativeError as error:
                message = f'the render texture "{texture.name}" of format {texture.format}: {error.message}'
                raise ProjectError(message, self._project.file, texture.line) from None
        return made

    def _size_of(self, shader_pass: Pass) -> tuple[int, int]:
        """The size that a pass draws to: that of its last render texture, or the window's."""
        named = [t for t in shader_pass.targets if t is not None]
        return self._render_textures[named[-1]].pixels(self._size) if named else self._size

    def _join(self, shader_pass: Pass) -> Target | None:
        targets = [self._targets[t] for t in shader_pass.targets]
        if len(targets) == 1:
            return targets[0]
        try:
            return Target.join(targets, *self._size_of(shader_pass))
        except NativeError as error:
            self._traps.warn(
                f'pass "{shader_pass.name}" draws nothing: {error.message}', str(self._project.file), shader_pass.line
            )
            return None

    def read_targets(self) -> dict[str, np.ndarray]:
        """The render textures and 2D images by name: (h, w, 4) float32, row 0 at v = 0."""
        found = {name: target.read_texels() for name, target in self._targets.items() if name is not None}
        for prepared in self._passes:
            for bound in prepared.storage:
                if isinstance(bound.object, Image) and len(bound.object.size) == 2:
                    found[bound.object.name] = bound.made.read()
        return found

    # ---- Frames ----------------------------------------------------------------------------------------------

    # Matrices of absurd numbers overflow silently, as in SHADERed.
    @np.errstate(divide="ignore", invalid="ignore", over="ignore")
    def draw(self, moment: Moment) -> None:
        """Draws one frame."""
        self.system.begin(moment)
        clears = _Clears(self._project)
        for prepared in self._passes:
            if isinstance(prepared.shader_pass, ComputePass):
                self._dispatch(prepared)
            else:
                self._draw_pass(prepared, clears)

    def _bind(self, prepared: PreparedPass) -> None:
        for bound in prepared.textures:
            (bound.texture or self._targets[bound.object.name]).bind(bound.unit)
        for bound in prepared.storage:
            if isinstance(bound.made, native.Buffer):
                bound.made.bind(bound.index)
            else:
                native.bind_image(bound.index, bound.made, states.FORMATS[bound.object.format])

    def _dispatch(self, prepared: PreparedPass) -> None:
        self._bind(prepared)
        prepared.uniforms.bind(None, self.system, self._memory)
        native.dispatch(prepared.program, prepared.shader_pass.groups)

    def _draw_pass(self, prepared: PreparedPass, clears: _Clears) -> None:
        shader_pass = prepared.shader_pass
        target = self._joined[shader_pass.name]
        if target is None:
            return
        # SHADERed clears in the state that the pass before left.
        if clears.depth(shader_pass.targets[-1]):
            target.clear_depth(self._depth_write)
        for index, color in clears.colors(shader_pass.targets, self._render_textures):
            target.clear_color(index, color)
        self.system.set_size(self._size_of(shader_pass))
        self._bind(prepared)
        for item in prepared.items:
            self.system.set_item(item.item)
            prepared.uniforms.bind(item.item, self.system, self._memory)
            self._draw_item(prepared, item, target)
        self._depth_write = shader_pass.end_state.depth_write

    def _draw_item(self, prepared: PreparedPass, item: PreparedItem, target: Target) -> None:
        if item.topology is None or (item.item.instances is not None and item.item.instances < 1):
            return
        if item.mesh is None and item.n_vertices == 0:
            return
        call = Call(
            prepared.program,
            item.attributes,
            item.mesh,
            item.n_vertices,
            item.topology,
            item.item.instances,
            prepared.shader_pass.patch_vertices,
            item.state,
        )
        try:
            target.draw(call)
        except NativeError as error:
            # A geometry stage that wants other primitives, for one: GL draws nothing, and SHADERed does not look.
            self._traps.warn(
                f'item "{item.item.name}" of pass "{prepared.shader_pass.name}": nothing is drawn, because GL refuses '
                f"its topology with the pass's shaders ({error.message})",
                str(self._project.file),
                item.item.line,
            )


def _draws(prepared: PreparedPass) -> bool:
    return isinstance(prepared.shader_pass, Pass)


class _Clears:
    """What a frame has cleared so far. SHADERed clears a target when a pass comes to it that is not the last's."""

    def __init__(self, project: Project):
        self._clear_color = project.settings.clear_color
        self._window_is_clear = False
        self._before: list[str | None] = []  # longer than the pass before had targets, once one had more
        self._depth_before: str | None = ""  # a name that no target has

    def depth(self, owner: str | None) -> bool:
        """Whether the depth that belongs to the target ``owner`` is cleared now; the window's is once a frame."""
        changed = owner != self._depth_before
        self._depth_before = owner
        return changed and not (owner is None and self._window_is_clear)

    def colors(self, targets: Sequence[str | None], render_textures) -> list[tuple[int, Sequence[float]]]:
        """The targets to clear, by index, and their colours."""
        found: list[tuple[int, Sequence[float]]] = []
        for index, name in enumerate(targets):
            if name is None:
                if not self._window_is_clear:
                    found.append((index, self._clear_color))
                self._window_is_clear = True
            elif name not in self._before and render_textures[name].clear:
                found.append((index, render_textures[name].color))
        self._before[: len(targets)] = targets
        return found
