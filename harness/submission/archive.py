"""Archives that are the same bytes whoever makes them, when and where."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

#: the earliest that the format can say
TIME = (1980, 1, 1, 0, 0, 0)
_UNIX, _FILE = 3, 0o100644


def pack(files: Mapping[str, bytes]) -> bytes:
    """A zip of files by their relative paths: sorted, no times, no owners, plain permissions.

    Stored, not deflated: what zlib makes differs between its versions, and pictures do not shrink.
    """
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_STORED) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, TIME)
            entry.create_system, entry.external_attr = _UNIX, _FILE << 16
            archive.writestr(entry, files[name])
    return made.getvalue()


def unpack(archive: bytes, folder: str | Path) -> None:
    """Unpacks into a folder. zipfile keeps all names below it."""
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        opened.extractall(folder)
