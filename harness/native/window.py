"""The window of harness.h: the glfw backend's, to look at; imported only by what opens one."""

from __future__ import annotations

import ctypes
import enum
from typing import NamedTuple

import numpy as np

from . import Target, _done, _library

_INT, _POINTER, _TEXT = ctypes.c_int, ctypes.c_void_p, ctypes.c_char_p


class _Event(ctypes.Structure):
    _fields_ = [
        ("kind", ctypes.c_int32),
        ("code", ctypes.c_int32),
        ("action", ctypes.c_int32),
        ("x", ctypes.c_double),
        ("y", ctypes.c_double),
    ]


_INT_POINTER = ctypes.POINTER(_INT)
_PROTOTYPES = {
    "hn_window_show": (_INT, [_TEXT, _INT, _INT]),
    "hn_window_title": (_INT, [_TEXT]),
    "hn_window_events": (_INT, [ctypes.POINTER(_Event), _INT, ctypes.c_double]),
    "hn_window_present": (_INT, [_POINTER]),
    "hn_window_present_bytes": (_INT, [_INT, _INT, _POINTER]),
    "hn_window_read": (_INT, [_INT_POINTER, _INT_POINTER, _POINTER, ctypes.c_size_t]),
    "hn_window_swap": (_INT, []),
}
for _name, (_result, _arguments) in _PROTOTYPES.items():
    _function = getattr(_library, _name)
    _function.restype, _function.argtypes = _result, _arguments

_CAPACITY = 256


class Kind(enum.IntEnum):
    """Kinds of events, as hn_event_kind."""

    KEY = 0
    BUTTON = 1
    MOVE = 2
    WHEEL = 3
    SIZE = 4
    CLOSE = 5


class Event(NamedTuple):
    """What the user did, as hn_event."""

    kind: Kind
    code: int = 0
    action: int = 0
    x: float = 0.0
    y: float = 0.0


class Window:
    """The context's window. NativeError where the backend is not glfw."""

    def __init__(self, title: str, size: tuple[int, int]):
        self._events = (_Event * _CAPACITY)()
        _done(_library.hn_window_show(title.encode(), *size))

    def set_title(self, title: str) -> None:
        """The text of its title bar."""
        _done(_library.hn_window_title(title.encode()))

    def events(self, seconds: float = 0.0) -> list[Event]:
        """The events since the last call; waits up to ``seconds`` for one."""
        count = _done(_library.hn_window_events(self._events, _CAPACITY, seconds))
        return [Event(Kind(e.kind), e.code, e.action, e.x, e.y) for e in self._events[:count]]

    def present(self, target: Target) -> None:
        """Draws a target over the window; seen after ``swap``."""
        _done(_library.hn_window_present(target._handle))

    def present_bytes(self, pixels: np.ndarray) -> None:
        """The same of pixels, (h, w, 4) uint8, top row first."""
        flipped = np.ascontiguousarray(pixels[::-1], np.uint8)
        height, width, _ = flipped.shape
        _done(_library.hn_window_present_bytes(width, height, flipped.ctypes.data))

    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        width, height = _INT(), _INT()
        _done(_library.hn_window_read(width, height, None, 0))
        return width.value, height.value

    def read(self) -> np.ndarray:
        """What was presented and not yet swapped: (h, w, 4) uint8, top row first, opaque."""
        width, height = self.size()
        pixels = np.empty((height, width, 4), np.uint8)
        _done(_library.hn_window_read(_INT(), _INT(), pixels.ctypes.data, pixels.nbytes))
        return pixels[::-1]

    def swap(self) -> None:
        """Shows what was presented."""
        _done(_library.hn_window_swap())
