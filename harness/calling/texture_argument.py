"""Textures that functions are called with: arrays or image files, in place of a sampler2D."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

import numpy as np

from .. import native
from ..errors import CallError
from ..native import gl_enums
from ..rendering import textures

_WRAPS = {
    "repeat": gl_enums.GL_REPEAT,
    "clamp": gl_enums.GL_CLAMP_TO_EDGE,
    "mirror": gl_enums.GL_MIRRORED_REPEAT,
}
#: name -> (minifying filter, magnifying filter)
_FILTERS = {
    "nearest": (gl_enums.GL_NEAREST, gl_enums.GL_NEAREST),
    "linear": (gl_enums.GL_LINEAR, gl_enums.GL_LINEAR),
    "mipmap": (gl_enums.GL_LINEAR_MIPMAP_LINEAR, gl_enums.GL_LINEAR),
}
#: type of the array's numbers -> (GL's format, the sampler that reads it, the number of a full alpha)
_FORMATS = {
    "uint8": (gl_enums.GL_RGBA8, "sampler2D", 255),
    "float32": (gl_enums.GL_RGBA32F, "sampler2D", 1),
    "int32": (gl_enums.GL_RGBA32I, "isampler2D", 1),
    "uint32": (gl_enums.GL_RGBA32UI, "usampler2D", 1),
}
#: the samplers that a Texture can be given for
SAMPLERS = ("sampler2D", "isampler2D", "usampler2D")


class Texture:
    """A two-dimensional texture to give to a function's sampler2D, or to a uniform of that type.

    ``image`` is the path of a picture (8 bits a channel; read as the renderer reads its textures), or an array (h, w)
    or (h, w, 1 ... 4): uint8 (0 ... 255 become 0 ... 1) or float32 (which float64 and float16 become), for an
    isampler2D int32, for a usampler2D uint32. Channels that it lacks are 0, alpha is 1.

    Row 0 is the top of the picture, as numpy and Pillow have it, and v = 1: the texture coordinate (0, 0) is the lower
    left corner of the picture, the middle of pixel [row, column] is ((column + 1/2) / w, 1 - (row + 1/2) / h).

    ``wrap`` is "repeat", "clamp" (to the edge) or "mirror". ``filter`` is "nearest", "linear", or "mipmap" (linear
    between linear levels). A function is evaluated where there is no neighbouring pixel to tell how far apart samples
    lie, so texture() reads level 0; textureLod() and textureGrad() choose the level. llvmpipe weights texels in steps
    of 1/256. ``srgb`` decodes uint8 colours from sRGB (IEC 61966-2-1) before they are filtered, alpha not, as GL does
    with a texture of the format SRGB8_ALPHA8; here exactly, where llvmpipe's own decoding is off by .001.

    One texture serves the whole batch of a call. CallError for what cannot be a texture.
    """

    def __init__(
        self,
        image: np.ndarray | str | os.PathLike,
        wrap: Literal["repeat", "clamp", "mirror"] = "repeat",
        filter: Literal["nearest", "linear", "mipmap"] = "linear",  # noqa: A002 -- GL's word
        srgb: bool = False,
    ):
        for name, value, known in (("wrap", wrap, _WRAPS), ("filter", filter, _FILTERS)):
            if value not in known:
                raise CallError(f"a texture has no {name} {value!r}; there are: {', '.join(known)}")
        #: the picture's path, where it alone tells all of the texture
        self.file: str | None = None
        if isinstance(image, (str, os.PathLike)):
            if (wrap, filter, srgb) == ("repeat", "linear", False):
                self.file = os.fspath(image)
            try:
                texels = textures.read(Path(image))  # row 0 is v = 0 already
            except textures.TextureError as error:
                raise CallError(error.message, os.fspath(image)) from None
        else:
            texels = _texels(image)
        self._format, self.sampler, _ = _FORMATS[texels.dtype.name]
        if srgb:
            if self._format != gl_enums.GL_RGBA8:
                raise CallError(f"only a texture of 8-bit numbers can be sRGB, this is of {texels.dtype}")
            texels, self._format = _decoded(texels), gl_enums.GL_RGBA32F
        if self.sampler != "sampler2D" and filter != "nearest":
            raise CallError(f"a texture of {texels.dtype} cannot be filtered: give it filter='nearest'")
        self._texels, self._wrap, self._filters = texels, _WRAPS[wrap], _FILTERS[filter]
        self._texture: native.Texture | None = None

    def __repr__(self):
        return f"<Texture {self._texels.shape[1]}x{self._texels.shape[0]} {self._texels.dtype}>"

    def __getstate__(self):
        """Without what is in this process's context."""
        return self.__dict__ | {"_texture": None}

    def bind(self, unit: int) -> None:
        """Makes it the texture of a unit of the open context."""
        if self._texture is None:
            sampling = native.Sampling(*self._filters, self._wrap, self._wrap)
            self._texture = native.Texture.of_format(self._texels, self._format, sampling)
        self._texture.bind(unit)


def _texels(image: np.ndarray) -> np.ndarray:
    """An array as RGBA texels (h, w, 4), row 0 at v = 0."""
    array = np.asarray(image)
    if array.dtype in (np.float64, np.float16):
        with np.errstate(over="ignore"):  # beyond float32 is Inf
            array = array.astype(np.float32)
    if array.dtype.name not in _FORMATS:
        raise CallError(f"a texture is of {', '.join(_FORMATS)}, got numbers of type {array.dtype}")
    if array.ndim == 2:
        array = array[..., None]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or 0 in array.shape:
        raise CallError(f"a texture is an array (h, w) or (h, w, 1 ... 4), got {np.shape(image)}")
    rgba = np.zeros((*array.shape[:2], 4), array.dtype)
    rgba[..., 3] = _FORMATS[array.dtype.name][2]
    rgba[..., : array.shape[2]] = array[::-1]
    return rgba


def _decoded(texels: np.ndarray) -> np.ndarray:
    """8-bit texels as linear float32."""
    code = np.arange(256) / 255
    linear = np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
    return np.concatenate([linear[texels[..., :3]], code[texels[..., 3:]]], axis=-1).astype(np.float32)
