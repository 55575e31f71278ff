"""The errors that a user's input can cause: each says what is wrong and, where it is known, in which file and line.

Only the command line turns them into text and an exit code; everywhere else they are exceptions.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


class HarnessError(Exception):
    """Something in the input is at fault. ``str()`` is ``file:line: message``, as compilers print it."""

    def __init__(self, message: str, file: str | Path | None = None, line: int | None = None):
        self.message = message
        self.file = None if file is None else str(file)
        self.line = line
        place = "".join(f"{part}:" for part in (self.file, line) if part is not None)
        super().__init__(f"{place} {message}" if place else message)


class GlslError(HarnessError):
    """A shader does not compile or link, or an include is missing."""


class ProjectError(HarnessError):
    """A .sprj file is malformed, names what does not exist, or asks for what is not supported."""


class CallError(HarnessError, TypeError):
    """A GLSL function is called with arguments that do not fit, or does not exist."""


class NativeError(HarnessError):
    """The native library or the driver under it refuses; the message names the operation."""


class CompareError(HarnessError, ValueError):
    """A comparison that could not fail, or has no meaning: nothing to compare, shapes or tolerances that do not fit."""


class DomainError(HarnessError, ValueError):
    """Inputs are described by what is no domain, or does not suit the parameter."""


class LadderError(HarnessError, ValueError):
    """A ladder.toml is missing, malformed or contradicts itself, or lacks what is asked for."""


def did_you_mean(name: str, there: Iterable[str]) -> str:
    """What a message about an unknown name ends with: the nearest of the names that there are, or nothing."""
    from difflib import get_close_matches  # errors alone pay for it

    by_case = {known.lower(): known for known in there}
    near = get_close_matches(name.lower(), by_case, 1)
    return f"; did you mean {by_case[near[0]]}?" if near else ""


def among(name: str, there: Iterable[str]) -> str:
    """The same, with the names that there are."""
    hint = did_you_mean(name, there)
    return f"{hint}{' There' if hint else '; there'} are: {', '.join(there) or 'none at all'}"
