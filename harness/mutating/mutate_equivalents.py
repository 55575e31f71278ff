"""The list of mutants that no test can notice, each with the reason why: a TOML file beside the tests.

[[equivalent]]
line = "return x * x;"
ids = ["noise.glsl:square+2:12:arguments:1-2"]
reason = "..."
"""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import HarnessError
from ..language.glsl_syntax import without_comments
from .mutants import Mutant

NAME = "mutation-equivalent.toml"


@dataclass(frozen=True)
class Equivalents:
    """What a file lists: id -> (code of the line, reason)."""

    path: Path
    listed: dict[str, tuple[str, str]]

    @classmethod
    def read(cls, path: str | Path) -> Equivalents:
        """HarnessError where the file is missing, no TOML, or lacks something."""
        path = Path(path)
        try:
            entries = tomllib.loads(path.read_text()).get("equivalent", [])
        except OSError as error:
            raise HarnessError(f"cannot read the equivalent mutants: {error.strerror}", path) from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise HarnessError(str(error), path) from None
        listed = {}
        for number, entry in enumerate(entries, 1):
            lacking = [name for name in ("line", "ids", "reason") if not entry.get(name)]
            if lacking:
                raise HarnessError(f"entry {number} has no {', '.join(lacking)}", path)
            for name in entry["ids"]:
                if name in listed:
                    raise HarnessError(f"{name} is listed twice", path)
                listed[name] = entry["line"], entry["reason"]
        return cls(path, listed)

    def of(self, file_name: str, text: str, found: Sequence[Mutant]) -> set[str]:
        """The ids, without the file's name, that are listed for a file. HarnessError for what is not there any more."""
        lines = without_comments(text).split("\n")
        there = {mutant.id: lines[mutant.line - 1].strip() for mutant in found}
        ids = set()
        for name, (line, _) in self.listed.items():
            file, _, mutant = name.partition(":")
            if file != file_name:
                continue
            if mutant not in there:
                raise HarnessError(f"{name} is listed as equivalent, and there is no such mutant any more", self.path)
            if there[mutant] != line:
                message = f"{name} is listed as equivalent for the line {line!r}, which is {there[mutant]!r} now"
                raise HarnessError(message, self.path)
            ids.add(mutant)
        return ids


def beside(tests: Sequence[str | Path], root: str | Path) -> Path | None:
    """The list beside the tests: in the folder of the first or above it, within ``root``. None where there is none."""
    first = Path(tests[0] if tests else "tests").resolve()
    for folder in (first, *first.parents):
        if (folder / NAME).is_file():
            return folder / NAME
        if folder == Path(root).resolve():
            return None
    return None
