"""Writes what a trade is told in: each file whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import HarnessError
from ..picture import write
from . import file, markdown, page, readme

#: beside the README
DATA = Path("docs") / "trade.json"


def files(
    folder: Path,
    data: Mapping[str, Any],
    pictures: Mapping[str, np.ndarray],
    maps: Mapping[str, Mapping[str, np.ndarray]],
) -> None:
    """trade.json, trade.md and index.html. HarnessError when the folder cannot be made or written."""
    made = {
        "trade.json": file.text(data),
        "trade.md": markdown.document(data),
        "index.html": page.page(data, pictures, maps),
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HarnessError(f"cannot make the folder: {error.strerror}", folder) from error
    for name, text in made.items():
        _write(folder / name, text)


def check(path: Path) -> None:
    """HarnessError when a README has no place for the table."""
    readme.place(_read(path), path)


def readme_and_data(path: Path, data: Mapping[str, Any]) -> None:
    """The README with the table of this trade, and the trade itself in docs/trade.json beside it."""
    updated = readme.updated(_read(path), data, path)
    _write(path.parent / DATA, file.text(data))
    _write(path, updated)


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise HarnessError(f"cannot read the file: {error.strerror}", path) from None


def _write(path: Path, text: str) -> None:
    write(path, lambda out: out.write(text.encode()))
