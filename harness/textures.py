"""Texture files as pixels, as SHADERed loads them: 8-bit RGBA, no colour conversion, read with Pillow."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

from .errors import HarnessError

#: formats that SHADERed reads as well; its others (.hdr, .dds, .psd, .gif) it changes in ways of its own
FORMATS = ("PNG", "JPEG", "BMP", "TGA")
#: the longest side of a texture in pixels, which is GL's limit on common hardware
LARGEST_SIDE = 16384
#: the most pixels that the textures of a project may have in all: 1 GiB
MOST_PIXELS = 2**28


class TextureError(HarnessError):
    """An image file cannot be a texture; the message says why, without the file's name."""


@contextmanager
def _opened(path: Path) -> Iterator[Image.Image]:
    """The image with only its header read. What goes wrong here or within, at decoding, is a TextureError."""
    if not os.path.isfile(path):
        raise TextureError("there is no such file")
    try:
        with open(path, "rb") as file, warnings.catch_warnings():
            # Pillow warns where our own limits still hold.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            yield Image.open(file, formats=FORMATS)
    except TextureError:
        raise
    except Image.DecompressionBombError:
        raise TextureError(f"the image has more than {2 * Image.MAX_IMAGE_PIXELS} pixels") from None
    except Image.UnidentifiedImageError:
        kinds = ", ".join(FORMATS)
        raise TextureError(f"the file is damaged or of a kind that is not supported ({kinds} are)") from None
    except Exception as error:  # what decoders raise on a damaged file is not documented
        if isinstance(error, OSError) and error.errno:
            raise TextureError(f"the file cannot be read ({error.strerror})") from None
        raise TextureError(f"the file is damaged ({error})") from None


def size(path: str | os.PathLike) -> tuple[int, int]:
    """Width and height by the file's header; nothing is decoded. TextureError when it is missing or too large."""
    with _opened(Path(path)) as image:
        width, height = image.size
        if min(width, height) < 1 or max(width, height) > LARGEST_SIDE:
            raise TextureError(f"the image is {width} x {height} pixels, not 1 to {LARGEST_SIDE} a side")
    return width, height


def read(path: str | os.PathLike, *, vflip: bool = False) -> np.ndarray:
    """The pixels, (h, w, 4) uint8. Row 0 is v = 0: the bottom row of the image, its top with ``vflip``.

    TextureError when the file is missing, damaged or too large; the size is looked at before anything is decoded.
    """
    size(path)
    with _opened(Path(path)) as image:
        image.load()
        if image.mode.startswith("I"):  # 16-bit gray: SHADERed keeps the upper byte
            image = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
        rgba = np.asarray(image.convert("RGBA"))
    return np.ascontiguousarray(rgba if vflip else rgba[::-1])
