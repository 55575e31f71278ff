"""The project that a file and its tests belong to: where it begins, and what of it the tests may need."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import HarnessError

MOST_FILES = 20_000  # more are no project but somebody's home

_MARKS = ("pyproject.toml", "pytest.ini", "tox.ini", "setup.cfg", "setup.py")
_SKIPPED = {"__pycache__", "node_modules", "build", "dist"}


@dataclass(frozen=True)
class Project:
    """``root`` is a folder, ``files`` are paths relative to it; so are ``file`` and ``within``, where tests are run.

    ``tests`` are paths relative to ``within``; none means those that pytest finds by itself.
    """

    root: str
    files: tuple[str, ...]
    file: str
    within: str
    tests: tuple[str, ...]


def find(file: str | Path, tests: Sequence[str | Path] = ()) -> Project:
    """The project of a file: its git repository, else the folder with pytest's configuration, else what holds both.

    HarnessError when the file or a test is not there, or they do not lie in one project.
    """
    file = Path(file).resolve()
    if not file.is_file():
        raise HarnessError("no such file", file)
    paths = []
    for test in tests:
        path = Path(str(test).partition("::")[0]).resolve()
        if not path.exists():
            raise HarnessError("no such tests", test)
        paths.append(path)
    root = _repository(file.parent)
    listed = root is not None
    if root is None:
        marked = (folder for folder in file.parents if any((folder / mark).is_file() for mark in _MARKS))
        root = next(marked, None)
    if root is None or not all(path.is_relative_to(root) for path in paths):
        if listed:
            raise HarnessError(f"the tests are not in the repository of {file.name}, {root}", tests[0])
        folders = [path if path.is_dir() else path.parent for path in paths]
        root, listed = Path(os.path.commonpath([file.parent, *folders])), False
    files = _tracked(root) if listed else _walked(root)
    here = Path.cwd().resolve()
    within = here if here.is_relative_to(root) else root
    name = str(file.relative_to(root))
    return Project(
        str(root),
        tuple(dict.fromkeys([*files, name])),
        name,
        str(within.relative_to(root)),
        tuple(os.path.relpath(path, within) for path in paths),
    )


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


def _repository(folder: Path) -> Path | None:
    top = _git(folder, "rev-parse", "--show-toplevel")
    return Path(top.removesuffix("\n")) if top else None


def _tracked(root: Path) -> list[str]:
    listed = _git(root, "ls-files", "-z", "--cached", "--others", "--exclude-standard") or ""
    return [name for name in listed.split("\0") if name]


def _walked(root: Path) -> list[str]:
    found = []
    for folder, inner, files in os.walk(root):
        inner[:] = [
            name
            for name in inner
            if name not in _SKIPPED and name[0] != "." and not os.path.exists(os.path.join(folder, name, "pyvenv.cfg"))
        ]
        found += (os.path.relpath(os.path.join(folder, name), root) for name in files)
        if len(found) > MOST_FILES:
            raise HarnessError(f"more than {MOST_FILES} files: make a git repository of what belongs together", root)
    return found
