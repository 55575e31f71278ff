"""Shows a project live in a window: through a camera that the mouse moves, and following its files as they change."""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import HarnessError
from ..native.window import Event, Kind, Window
from ..picture import write_png
from ..projects import camera_entry, sprj
from ..projects.project import ComputePass, Project
from ..projects.traps import Traps
from ..rendering.camera import Camera
from ..rendering.render import Renderer
from . import view_camera, view_error, view_keys, view_macros, watch
from .view_keys import Action

#: the most seconds that the user waits for an answer while nothing moves
_IDLE = 0.05
_PRESSED, _RELEASED = 1, 0
#: values that differ from frame to frame while nobody touches anything
_MOVING = ("Time", "TimeDelta", "FrameIndex")


class Viewer:
    """A project in a window. ``run`` it, or give it ``handle`` events and ``step`` frames.

    HarnessError when the project cannot be drawn to begin with; later what is wrong is said in the title and on stderr,
    and the last picture stays.
    """

    def __init__(self, path: str | Path, window: Window, size: tuple[int, int]):
        self.path = Path(path)
        self._window = window
        self._size = size
        self._changes = view_macros.Changes()
        self._shows_error = False
        self._note = self._title = ""
        self._buttons: dict[int, tuple[float, float]] = {}
        self._pointer = (0.0, 0.0)
        self._arrows: set[int] = set()
        self._wanted: list[Action] = []
        self.closed = False
        self._start = self._last = self._looked = time.monotonic()
        self._frame = 0
        self._watch = watch.Watch([self.path])
        self._read()
        self.camera: Camera = self._project.settings.camera
        self._make()

    # ---- The project -----------------------------------------------------------------------------------------------

    def _read(self) -> None:
        project = sprj.read(self.path, Traps())
        self._watch = watch.Watch(watch.files(project))
        self._project = project
        self._macros = view_macros.find(project)

    def _make(self) -> None:
        """Makes what is drawn of the project and its changes; all of it or nothing."""
        shown = self._renderer_of(self._changes)
        reference = self._renderer_of(view_macros.reference(self._changes, self._macros)) if self._shows_error else None
        self._renderer, self._reference = shown, reference
        for said in shown.warnings:
            _say(str(said))
        self._dirty = True

    def _renderer_of(self, changes: view_macros.Changes) -> Renderer:
        return Renderer(self.path, self._size, change=lambda project: view_macros.changed(project, changes))

    def _try(self, changes: view_macros.Changes, shows_error: bool) -> bool:
        """Whether it can be drawn with these; else all stays as it was, and the reason is said."""
        before = self._changes, self._shows_error
        self._changes, self._shows_error = changes, shows_error
        try:
            self._make()
        except HarnessError as error:
            self._changes, self._shows_error = before
            self._fail(error)
            return False
        self._note = ""
        return True

    def reload(self) -> None:
        """Reads and makes everything anew. A camera that the file moved is taken; else the user's stays."""
        was = self._project.settings.camera
        try:
            self._read()
            self._make()
        except HarnessError as error:
            self._fail(error)
            return
        now = self._project.settings.camera
        if replace(now, line=0) != replace(was, line=0):
            self.camera = now
        self._note = ""
        _say(f"{self.path}: read again")

    def _fail(self, error: HarnessError) -> None:
        _say(str(error))
        self._note = f"ERROR {str(error).splitlines()[0]}"
        self._show_title()

    # ---- What the user does ----------------------------------------------------------------------------------------

    def handle(self, event: Event) -> None:
        """Does what an event asks for; what shows comes with the next ``step``."""
        match event.kind:
            case Kind.KEY:
                self._key(event)
            case Kind.BUTTON if event.action == _PRESSED:
                self._buttons[event.code] = self._pointer = event.x, event.y
            case Kind.BUTTON:
                self._buttons.pop(event.code, None)
            case Kind.MOVE:
                if self._buttons:
                    dx, dy = event.x - self._pointer[0], event.y - self._pointer[1]
                    self._look(view_camera.drag(self.camera, dx, dy))
                self._pointer = event.x, event.y
                self._dirty |= self._uses("MousePosition", "Mouse")
            case Kind.WHEEL:
                self._look(view_camera.zoom(self.camera, event.y))
            case Kind.SIZE:
                self._resize((int(event.x), int(event.y)))
            case Kind.CLOSE:
                self.closed = True

    def _key(self, event: Event) -> None:
        if event.code in view_keys.ARROWS:
            (self._arrows.discard if event.action == _RELEASED else self._arrows.add)(event.code)
        if event.action != _PRESSED:
            return
        feature, ladder, action = (f(event.code) for f in (view_keys.feature, view_keys.ladder, view_keys.action))
        if feature is not None and feature < len(self._macros.features):
            name = self._macros.features[feature]
            if self._try(self._changes.flip(name), self._shows_error):
                _say(f"{name}: {'flipped' if name in self._changes.flipped else 'as in the project'}")
        elif ladder is not None and ladder < len(self._macros.ladders):
            rungs = self._macros.ladders[ladder]
            own = view_macros.own_rung(self._project, rungs)
            if self._try(self._changes.step(rungs, own), self._shows_error):
                _say(f"{rungs.name}: {self._changes.rungs.get(rungs.name, 'as in the project')}")
        elif action is not None:
            self._do(action)

    def _do(self, action: Action) -> None:
        match action:
            case Action.CLOSE:
                self.closed = True
            case Action.RESET:
                self._look(self._project.settings.camera)
            case Action.ERROR:
                self._try(self._changes, not self._shows_error)
            case Action.HELP:
                names = tuple(ladder.name for ladder in self._macros.ladders)
                print(view_keys.describe(self._macros.features, names), flush=True)
            case Action.SAVE:
                self._wanted.append(action)  # of the next frame, before it is shown
                self._dirty = True
            case Action.WRITE:
                self._write_camera()

    def _write_camera(self) -> None:
        try:
            camera_entry.write_camera(self.path, self.camera)
        except HarnessError as error:
            self._fail(error)
            return
        self._note = "camera written"
        _say(f"{self.path}: camera written")
        self._dirty = True

    def _look(self, camera: Camera) -> None:
        self._dirty |= camera != self.camera
        self.camera = camera

    def _resize(self, size: tuple[int, int]) -> None:
        if size == self._size or min(size) < 1:  # a window in the dock has no pixels
            return
        before, self._size = self._size, size
        try:
            for renderer in self._renderers():
                renderer.resize(size)
        except HarnessError as error:
            self._size = before
            self._fail(error)
        self._dirty = True

    # ---- What is shown ---------------------------------------------------------------------------------------------

    def _renderers(self) -> list[Renderer]:
        return [self._renderer] + ([self._reference] if self._reference is not None else [])

    def _uses(self, *systems: str) -> bool:
        return any(v.system in systems for p in self._renderer.project.passes for v in p.variables)

    def is_still(self) -> bool:
        """Whether a frame shows what the one before did, as long as nobody touches anything."""
        project: Project = self._renderer.project
        keeps = any(isinstance(p, ComputePass) for p in project.passes) or any(
            not t.clear for t in project.render_textures
        )
        last = any(v.last_frame for p in project.passes for v in p.variables)
        return not (keeps or last or self._uses(*_MOVING) or self._arrows)

    def step(self) -> bool:
        """Reads files that changed, and draws a frame if it would show something new; says whether it did."""
        now = time.monotonic()
        if now - self._looked >= watch.SECONDS:
            self._looked = now
            if self._watch.changed():
                self.reload()
        if self._arrows:
            ahead, right = (sum(d) for d in zip(*(view_keys.ARROWS[a] for a in self._arrows), strict=True))
            self._look(view_camera.walk(self.camera, ahead, right, now - self._last))
        delta, self._last = now - self._last, now
        if self.is_still() and not self._dirty:
            return False
        self._dirty = False
        self._draw(now - self._start, delta)
        return True

    def _draw(self, seconds: float, delta: float) -> None:
        for renderer in self._renderers():
            renderer.look(self.camera)
            renderer.give(self._mouse())
            renderer.draw(self._frame, seconds, delta)
        self._frame += 1
        if self._reference is None:
            self._window.present(self._renderer.window)
        else:
            difference = view_error.differences(self._renderer.floats(), self._reference.floats())
            self._window.present_bytes(view_error.false_color(difference))
            self._note = f"error view x{view_error.GAIN:g}, largest {difference.max():.3g}"
        if Action.SAVE in self._wanted:
            self._save()
        self._wanted.clear()
        self._window.swap()
        self._show_title()

    def _mouse(self) -> dict[str, np.ndarray]:
        """As in the editor's preview: y upward from the window's lower edge, 0...1."""
        x, y = (p / s for p, s in zip(self._pointer, self._size, strict=True))
        buttons = [float(b in self._buttons) for b in (0, 1)]
        return {
            "MousePosition": np.array([x, 1 - y]),
            "Mouse": np.array([x, 1 - y, *buttons]),
            "IsSavingToFile": np.array(False),
        }

    def _save(self) -> None:
        taken = {p.name for p in Path().glob(f"{self.path.stem}-*.png")}
        name = next(n for k in range(1, 10**6) if (n := f"{self.path.stem}-{k}.png") not in taken)
        try:
            write_png(name, self._window.read())
        except HarnessError as error:
            self._fail(error)
            return
        self._note = f"saved {name}"
        _say(f"saved {name}")

    def _show_title(self) -> None:
        parts = [self.path.name, str(self._changes), self._note]
        title = " - ".join(part for part in parts if part)
        if title != self._title:
            self._title = title
            self._window.set_title(title)

    def run(self, frames: int | None = None) -> None:
        """Until the window is closed, or for so many rounds of events and, where something changed, a frame."""
        rounds = 0
        while not self.closed and rounds != frames:
            rounds += 1
            waits = self.is_still() and not self._dirty and not self._arrows
            for event in self._window.events(_IDLE if waits else 0.0):
                self.handle(event)
            if not self.closed:
                self.step()


def view(path: str | Path, size: tuple[int, int], frames: int | None = None) -> None:
    """Shows the project until its window is closed. HarnessError where there is no display or no project."""
    from .. import native

    project = Path(path)
    if not project.is_file():
        sprj.read(project)  # says so before a window opens
    native.choose_backend("glfw")
    native.open_context()
    window = Window(project.name, size)
    Viewer(project, window, size).run(frames)


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
