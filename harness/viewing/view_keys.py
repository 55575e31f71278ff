"""The keys of the viewer: which does what, by GLFW's codes of them."""

from __future__ import annotations

import enum

_F1, _DIGIT_1 = 290, ord("1")
#: arrow keys -> (ahead, to the right)
ARROWS = {262: (0, 1), 263: (0, -1), 264: (-1, 0), 265: (1, 0)}
#: as many features and ladders as there are keys for
MOST = 9


class Action(enum.Enum):
    """What a key asks for; the value is what the help calls it."""

    SAVE = "save a picture of what is shown"
    RESET = "reset the camera to the project's"
    ERROR = "error view: the difference to the reference rungs, amplified, on and off"
    WRITE = "write the camera into the .sprj"
    HELP = "print the keys"
    CLOSE = "close"


_KEYS = {
    ord("S"): Action.SAVE,
    ord("R"): Action.RESET,
    ord("E"): Action.ERROR,
    ord("W"): Action.WRITE,
    ord("H"): Action.HELP,
    256: Action.CLOSE,
}
_NAMES = {256: "Esc"}


def action(code: int) -> Action | None:
    """What the key asks for by itself."""
    return _KEYS.get(code)


def feature(code: int) -> int | None:
    """The index of the feature that F1 ... F9 toggle."""
    return code - _F1 if _F1 <= code < _F1 + MOST else None


def ladder(code: int) -> int | None:
    """The index of the ladder that 1 ... 9 step."""
    return code - _DIGIT_1 if _DIGIT_1 <= code < _DIGIT_1 + MOST else None


def describe(features: tuple[str, ...], ladders: tuple[str, ...]) -> str:
    """The keys, one a line."""
    lines = [(_NAMES.get(code, chr(code)), what.value) for code, what in _KEYS.items()]
    lines += [(f"F{k}", f"{name} on and off") for k, name in enumerate(features[:MOST], 1)]
    lines += [(str(k), f"next of {name}") for k, name in enumerate(ladders[:MOST], 1)]
    lines += [("drag", "rotate"), ("wheel", "zoom (arcball)"), ("arrows", "walk (first person)")]
    return "\n".join(f"  {key:<7}{what}" for key, what in lines)
