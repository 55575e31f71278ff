"""The objects of a project on the GL side: textures, cube maps, images, buffers. Each file is read once."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np

from .. import native
from ..errors import ProjectError
from ..native import Sampling, gl_enums
from ..projects.project import Buffer, CubeMap, Image, KeyboardTexture, Object, Project, TextureObject
from ..projects.traps import Traps
from . import buffers, states, textures

_FILTERS = {
    "Nearest": gl_enums.GL_NEAREST,
    "Linear": gl_enums.GL_LINEAR,
    "Nearest_MipmapNearest": gl_enums.GL_NEAREST_MIPMAP_NEAREST,
    "Linear_MipmapNearest": gl_enums.GL_LINEAR_MIPMAP_NEAREST,
    "Nearest_MipmapLinear": gl_enums.GL_NEAREST_MIPMAP_LINEAR,
    "Linear_MipmapLinear": gl_enums.GL_LINEAR_MIPMAP_LINEAR,
}
_WRAPS = {
    "ClampToEdge": gl_enums.GL_CLAMP_TO_EDGE,
    "Repeat": gl_enums.GL_REPEAT,
    "MirroredRepeat": gl_enums.GL_MIRRORED_REPEAT,
}
_EDGE = gl_enums.GL_CLAMP_TO_EDGE
_CUBE_SAMPLING = Sampling(gl_enums.GL_LINEAR, gl_enums.GL_LINEAR, _EDGE, _EDGE, _EDGE)
_IMAGE_SAMPLING = Sampling(gl_enums.GL_LINEAR, gl_enums.GL_NEAREST)
_KEYBOARD_SAMPLING = Sampling(gl_enums.GL_NEAREST, gl_enums.GL_NEAREST)
_KEYBOARD_SHAPE = 3, 256
#: the most bytes of images and of buffers in all
MOST_BYTES = 1 << 30


class Pictures:
    """The image files of a project, decoded beside everything else."""

    def __init__(self, project: Project, thread: ThreadPoolExecutor, traps: Traps):
        """Looks at all headers at once, and starts to decode when all are in order. ProjectError where one is not;
        with ``keep_going`` its object is left out."""
        self._project = project
        self._traps = traps
        self._decoding: dict[str, list[Future[np.ndarray]]] = {}
        total = 0
        for texture in project.textures:
            if isinstance(texture, KeyboardTexture):
                continue
            try:
                for path in _files(texture):
                    total += int(np.prod(textures.size(project.path(path)), dtype=np.int64))
                if total > textures.MOST_PIXELS:
                    raise textures.TextureError(f"more than {textures.MOST_PIXELS} pixels of textures in all")
            except textures.TextureError as error:
                traps.survive(self._error(texture, error))
            else:
                self._decoding[texture.name] = [thread.submit(read) for read in _readers(project, texture)]

    def _error(self, texture: TextureObject | CubeMap, error: textures.TextureError) -> ProjectError:
        if isinstance(texture, CubeMap):
            what = f'<object type="texture" cube="true"> "{texture.name}" ({", ".join(texture.faces)})'
        else:
            what = f'<object type="texture" path="{texture.path}">'
        return ProjectError(f"{what}: {error.message}", self._project.file, texture.line)

    def textures(self) -> dict[str, native.Texture]:
        """The textures by name, on the GL side."""
        made = {}
        for texture in self._project.textures:
            try:
                if isinstance(texture, KeyboardTexture):
                    made[texture.name] = native.Texture.empty(_KEYBOARD_SHAPE, gl_enums.GL_R8, _KEYBOARD_SAMPLING)
                elif texture.name in self._decoding:
                    made[texture.name] = _texture(texture, [f.result() for f in self._decoding[texture.name]])
            except textures.TextureError as error:
                self._traps.survive(self._error(texture, error))
        return made


def _files(texture: TextureObject | CubeMap) -> tuple[str, ...]:
    return texture.faces if isinstance(texture, CubeMap) else (texture.path,)


def _readers(project: Project, texture: TextureObject | CubeMap) -> list[Callable[[], np.ndarray]]:
    if isinstance(texture, CubeMap):
        return [lambda path=path: textures.read_face(project.path(path)) for path in texture.faces]
    how = {"vflip": texture.vflip} | ({"volume": True} if texture.volume else {})
    return [lambda: textures.read(project.path(texture.path), **how)]


def _texture(texture: TextureObject | CubeMap, pixels: list[np.ndarray]) -> native.Texture:
    if isinstance(texture, CubeMap):
        if len({face.shape for face in pixels}) > 1 or pixels[0].shape[0] != pixels[0].shape[1]:
            raise textures.TextureError("the faces of a cube map are squares of one size, or it shows nothing")
        return native.Texture.cube(np.stack(pixels), _CUBE_SAMPLING)
    sampling = Sampling(
        _FILTERS[texture.min_filter],
        _FILTERS[texture.mag_filter],
        _WRAPS[texture.wrap_s],
        _WRAPS[texture.wrap_t],
    )
    return native.Texture.create(pixels[0], sampling)


def make_images(project: Project, traps: Traps) -> dict[str, native.Texture]:
    """The images by name, all 0."""

    def make(image: Image) -> native.Texture:
        return native.Texture.empty(image.size[::-1], states.FORMATS[image.format], _IMAGE_SAMPLING)

    return _make(project, project.images, lambda i: 16 * int(np.prod(i.size, dtype=np.int64)), make, traps)


def make_buffers(project: Project, traps: Traps) -> dict[str, native.Buffer]:
    """The buffers by name; those of no bytes are not made."""

    def make(buffer: Buffer) -> native.Buffer:
        return native.Buffer(buffers.content(project, buffer, traps))

    return _make(project, [b for b in project.buffers if b.size > 0], lambda b: b.size, make, traps)


def _make(project: Project, objects, size: Callable[[Object], int], make: Callable, traps: Traps) -> dict:
    made, total = {}, 0
    for described in objects:
        total += size(described)
        try:
            if total > MOST_BYTES:
                raise ProjectError(
                    f'"{described.name}": more than {MOST_BYTES >> 20} MiB in all', project.file, described.line
                )
            made[described.name] = make(described)
        except ProjectError as error:
            traps.survive(error)
    return made
