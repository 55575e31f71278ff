"""Files on disk, pictures above all: written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import numpy as np
from PIL import Image

from .errors import HarnessError

#: zlib's level: 1 takes a fifth of the time of 6 for a file that is a tenth larger
COMPRESSION = 1


def write_png(path: str | os.PathLike, pixels: np.ndarray) -> None:
    """Writes ``pixels``, (h, w, 3 or 4) or (h, w) uint8 with the top row first. HarnessError when that cannot be done.

    The file appears complete or does not change.
    """
    write(path, lambda file: Image.fromarray(pixels).save(file, format="PNG", compress_level=COMPRESSION))


def write(path: str | os.PathLike, save: Callable[[BinaryIO], None]) -> None:
    """Writes what ``save`` puts into a file: under another name beside it, which is then renamed."""
    path = Path(path)
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    except OSError as error:
        raise HarnessError(f"cannot write the file: {error.strerror}", path) from error
    try:
        with os.fdopen(handle, "wb") as file:
            save(file)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except BaseException as error:
        os.unlink(temporary)
        if isinstance(error, OSError):
            raise HarnessError(f"cannot write the file: {error.strerror}", path) from error
        raise
