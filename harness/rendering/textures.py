"""Texture files as pixels, as SHADERed loads them: 8-bit RGBA, no colour conversion.

Read with Pillow where SHADERed reads them with stb_image; Radiance and Photoshop pictures and DirectDraw surfaces by
readers of their own.
"""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from PIL import Image

from ..errors import HarnessError
from . import dds, psd, radiance, stb_image

#: formats that SHADERed reads and Pillow reads alike; .hdr, .psd and .dds come beside them
FORMATS = ("PNG", "JPEG", "BMP", "TGA", "GIF", "PPM")
#: the longest side of a texture in pixels, which is GL's limit on common hardware
LARGEST_SIDE = 16384
#: the most pixels that the textures of a project may have in all: 1 GiB
MOST_PIXELS = 2**28
#: what a file of that many pixels can take
MOST_BYTES = 8 * MOST_PIXELS
#: Pillow looks for it at the end of a TGA, and fails where a file of a pixel or two is smaller
_TGA_FOOTER_BYTES = 26


class TextureError(HarnessError):
    """An image file cannot be a texture; the message says why, without the file's name."""


@contextmanager
def _opened(path: Path) -> Iterator[Image.Image]:
    """The image with only its header read. What goes wrong here or within, at decoding, is a TextureError."""
    with _errors_as_texture_errors(path), open(path, "rb") as file:
        if os.path.getsize(path) < _TGA_FOOTER_BYTES:
            yield Image.open(io.BytesIO(file.read().ljust(_TGA_FOOTER_BYTES, b"\0")), formats=FORMATS)
        else:
            yield Image.open(file, formats=FORMATS)


@contextmanager
def _errors_as_texture_errors(path: Path) -> Iterator[None]:
    if not os.path.isfile(path):
        raise TextureError("there is no such file")
    try:
        with warnings.catch_warnings():
            # Pillow warns where our own limits still hold.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            yield
    except (TextureError, MemoryError):
        raise
    except Image.DecompressionBombError:
        raise TextureError(f"the image has more than {2 * Image.MAX_IMAGE_PIXELS} pixels") from None
    except Image.UnidentifiedImageError:
        kinds = ", ".join((*FORMATS, "HDR", "PSD", "DDS"))
        raise TextureError(f"the file is damaged or of a kind that is not supported ({kinds} are)") from None
    except Exception as error:  # what decoders raise on a damaged file is not documented
        if isinstance(error, OSError) and error.errno:
            raise TextureError(f"the file cannot be read ({error.strerror})") from None
        raise TextureError(f"the file is damaged ({error})") from None


def _other_kind(path: Path):
    """The reader for what Pillow does not read as SHADERed does; SHADERed tells surfaces by their names alone."""
    if path.suffix == ".dds":
        return dds
    with open(path, "rb") as file:
        head = file.read(16)
    if head.startswith(psd.MAGIC):
        return psd
    return radiance if head.startswith(radiance.MAGICS) else None


def _bytes(path: Path) -> bytes:
    if os.path.getsize(path) > MOST_BYTES:
        raise TextureError(f"the file has more than {MOST_BYTES >> 20} MiB")
    return path.read_bytes()


def size(path: str | os.PathLike) -> tuple[int, ...]:
    """Width and height, of a surface (.dds) depth too, by the file's header; nothing is decoded.

    TextureError when it is missing or too large.
    """
    path = Path(path)
    with _errors_as_texture_errors(path):
        reader = _other_kind(path)
        if reader is not None:
            with open(path, "rb") as file:
                sides = reader.size(file.read(1 << 16))
        else:
            with _opened(path) as image:
                sides = image.size
        if min(sides) < 1 or max(sides) > LARGEST_SIDE:
            shown = " x ".join(map(str, sides))
            raise TextureError(f"the image is {shown} pixels, not 1 to {LARGEST_SIDE} a side")
        if np.prod(sides, dtype=np.int64) > MOST_PIXELS:
            raise TextureError(f"the image has more than {MOST_PIXELS} pixels")
    return sides


def read(path: str | os.PathLike, *, vflip: bool = False, volume: bool = False) -> np.ndarray:
    """The pixels, (h, w, 4) uint8, of a ``volume`` (depth, h, w, 4). Row 0 is v = 0: the bottom row of the image, its
    top with ``vflip``, which does nothing to a volume.

    TextureError when the file is missing, damaged or too large; the size is looked at before anything is decoded.
    """
    path = Path(path)
    size(path)
    with _errors_as_texture_errors(path):
        reader = _other_kind(path)
        if volume and reader is not dds:
            raise TextureError("a 3D texture is a .dds file")
        if reader is dds:
            slices = dds.read(_bytes(path))
            return slices if volume else np.ascontiguousarray(slices[0][::-1] if vflip else slices[0])
        rgba = reader.read(_bytes(path)) if reader else _read_with_pillow(path)
    return np.ascontiguousarray(rgba if vflip else rgba[::-1])


def _read_with_pillow(path: Path) -> np.ndarray:
    with _opened(path) as image:
        if image.format in stb_image.FORMATS:
            otherwise = stb_image.rgba(image, _bytes(path))
            if otherwise is not None:
                return otherwise
        image.load()
        if image.mode.startswith("I"):  # 16-bit gray: SHADERed keeps the upper byte
            image = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
        return np.asarray(image.convert("RGBA"))


def read_face(path: str | os.PathLike) -> np.ndarray:
    """The pixels of a cube map's face, (h, w, 4) uint8, top row first. SHADERed makes faces opaque unless they have
    red, green, blue and alpha; surfaces (.dds) it turns over."""
    path = Path(path)
    if path.suffix == ".dds":
        return read(path)
    rgba = read(path, vflip=True)
    if _other_kind(path) is None:
        with _opened(path) as image:
            if image.mode in ("LA", "La"):
                raise TextureError("a face of gray with alpha shows whatever is in memory in SHADERed")
    return rgba
