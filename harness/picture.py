"""Files on disk, pictures above all: written whole or not at all."""

from __future__ import annotations

import base64
import errno
import io
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO
from urllib.parse import quote

import numpy as np
from PIL import Image

from .errors import HarnessError

#: zlib's level: 1 takes a fifth of the time of 6 for a file that is a tenth larger
COMPRESSION = 1
#: what file systems and systems say that have no files without names, or no /proc
_NO_NAMELESS_FILES = {errno.EOPNOTSUPP, errno.EISDIR, errno.EINVAL, errno.ENOENT}


def write_png(path: str | os.PathLike, pixels: np.ndarray) -> None:
    """Writes ``pixels``, (h, w, 3 or 4) or (h, w) uint8 with the top row first. HarnessError when that cannot be done.

    The file appears complete or does not change.
    """
    write(path, lambda file: Image.fromarray(pixels).save(file, format="PNG", compress_level=COMPRESSION))


def data_address(pixels: np.ndarray) -> str:
    """``pixels``, (h, w, 4) uint8, as a PNG in a data: address. An alpha of 255 everywhere is left out."""
    opaque = (pixels[..., 3] == 255).all()
    made = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels[..., :3] if opaque else pixels)).save(made, "PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(made.getvalue()).decode()


def write_targets(folder: str | os.PathLike, targets: Mapping[str, np.ndarray]) -> None:
    """Writes render textures, (h, w, 4) float32 with the bottom row first: NAME.npy as they are, and NAME.png clamped
    to 0...1 with the top row first. Characters that no file name has are written as %XX."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HarnessError(f"cannot make the folder: {error.strerror}", folder) from error
    for name, floats in targets.items():
        file_name = quote(name, safe=" ()+,;=@[]!")
        write(folder / f"{file_name}.npy", lambda file, floats=floats: np.save(file, floats))
        clamped = np.clip(np.nan_to_num(floats[::-1], nan=0.0), 0, 1)
        write_png(folder / f"{file_name}.png", np.floor(clamped * 255 + 0.5).astype(np.uint8))


def write(path: str | os.PathLike, save: Callable[[BinaryIO], None]) -> None:
    """Writes what ``save`` puts into a file, which takes its name when it is whole, and the place of what had it."""
    path = Path(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        try:
            # Without a name as long as it is written: nothing of it stays behind, however this process ends.
            with open(os.open(path.parent, os.O_TMPFILE | os.O_RDWR, 0o666), "wb+") as file:
                save(file)
                file.flush()
                _give_name(file, temporary)
        except OSError as error:
            if error.errno not in _NO_NAMELESS_FILES:
                raise
            with open(temporary, "xb") as file:
                save(file)
        os.replace(temporary, path)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise HarnessError(f"cannot write the file: {error.strerror}", path) from error
        raise


def _give_name(file: BinaryIO, path: Path) -> None:
    folder = os.open(path.parent, os.O_PATH)
    try:  # with a folder, for os.link follows the link in /proc then only
        os.link(f"/proc/self/fd/{file.fileno()}", path.name, src_dir_fd=folder, dst_dir_fd=folder)
    finally:
        os.close(folder)
