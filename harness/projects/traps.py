"""What SHADERed passes over in silence: collected as warnings, each with its place in the .sprj.

SHADERed ignores, guesses or drops what it does not understand, and shows a picture all the same. The picture is the
same here, and a warning says what happened. Where SHADERed crashes or loads nothing there is an error instead; with
``keep_going`` an error costs the part that it is about, and the rest is drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ..errors import HarnessError


@dataclass(frozen=True)
class Warning:
    """Something that SHADERed says nothing about. ``str()`` is ``file:line: warning: message``."""

    message: str
    file: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        place = "".join(f"{part}:" for part in (self.file, self.line) if part is not None)
        return f"{place} warning: {self.message}" if place else f"warning: {self.message}"


@dataclass
class Traps:
    """The warnings about one project, and with ``keep_going`` the errors that were survived, in order."""

    keep_going: bool = False
    warnings: list[Warning] = field(default_factory=list)
    errors: list[HarnessError] = field(default_factory=list)

    def warn(self, message: str, file: str | None = None, line: int | None = None) -> None:
        """Adds a warning, once."""
        warning = Warning(message, None if file is None else str(file), line)
        if warning not in self.warnings:
            self.warnings.append(warning)

    def survive(self, error: HarnessError) -> None:
        """Raises the error, or with ``keep_going`` keeps it and returns: the caller leaves the part out."""
        if not self.keep_going:
            raise error
        self.errors.append(error)
