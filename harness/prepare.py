"""Gets the passes of a project ready to draw: programs, meshes, textures in their units, uniforms.

What a pass came to is open to tests and reports: its program's active uniforms and attributes, its shaders'
final texts, and which texture went to which sampler.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from . import glsl, native, shapes, textures
from .errors import GlslError, NativeError, ProjectError
from .native import Field, gl_enums
from .project import Geometry, Item, Model, Pass, Project, RenderState, Shader, TextureObject
from .uniforms import PassUniforms

#: macros that SHADERed 1.5.6 gives to every shader
SYSTEM_MACROS = {"SHADERED_DESKTOP": "", "SHADERED_VERSION": "1005005"}

#: SHADERed's own search for samplers, over the bare text: comments, dead branches and parameters count
_SAMPLER = re.compile(r"[a-z]?sampler[^\r\n]+ [^\r\n]+;")

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


@dataclass(frozen=True)
class BoundTexture:
    """A texture in its unit. ``sampler`` is the declaration that it went to, None where there are too few."""

    unit: int
    sampler: str | None
    object: TextureObject
    texture: native.Texture


@dataclass(frozen=True)
class PreparedItem:
    """An item with its mesh; attribute location k reads ``fields[k]``."""

    item: Geometry | Model
    mesh: native.Mesh
    fields: tuple[Field, ...]
    state: native.State


@dataclass(frozen=True)
class PreparedPass:
    """A pass ready to draw. ``program.uniforms`` and ``program.attributes`` are what the linker left."""

    shader_pass: Pass
    vertex: glsl.Source
    fragment: glsl.Source
    program: native.Program
    uniforms: PassUniforms
    textures: tuple[BoundTexture, ...]
    items: tuple[PreparedItem, ...]


def declared_samplers(fragment_text: str) -> list[str]:
    """What SHADERed takes for the samplers' names, in the order in which it gives them textures."""
    return [match[0].partition(" ")[2][:-1] for match in _SAMPLER.finditer(fragment_text)]


def prepare(project: Project) -> list[PreparedPass]:
    """The project's passes, ready to draw; each file is read once.

    ProjectError, with the .sprj's line, for files that are missing or damaged and for what does not fit
    together; GlslError for shaders.
    """
    # One thread, so that images are decoded while shaders compile. More gain nothing: Pillow holds the GIL.
    thread = ThreadPoolExecutor(max_workers=1)
    try:
        images = _start_images(project, thread)
        native.open_context()
        programs = [_program(project, p) for p in project.passes]
        meshes = _Meshes(project)
        items = [[meshes.item(p, item) for item in p.items] for p in project.passes]
        made = {t.path: _texture(project, t, images[t.path]) for t in project.textures}
    finally:
        thread.shutdown(cancel_futures=True)
    return [
        PreparedPass(
            p,
            vertex,
            fragment,
            program,
            bound_uniforms,
            _bind(project, p, fragment, program, made),
            tuple(drawn),
        )
        for p, (vertex, fragment, program, bound_uniforms), drawn in zip(project.passes, programs, items, strict=True)
    ]


# ---- Shaders ---------------------------------------------------------------------------------------------


def _program(project: Project, shader_pass: Pass) -> tuple[glsl.Source, glsl.Source, native.Program, PassUniforms]:
    defines = SYSTEM_MACROS | {macro.name: macro.value for macro in shader_pass.macros}

    def load(shader: Shader, stage: str) -> glsl.Source:
        path = project.path(shader.path)
        if not os.path.isfile(path):
            raise ProjectError(
                f'<shader type="{stage}"> of pass "{shader_pass.name}": there is no file "{shader.path}"',
                project.file,
                shader.line,
            )
        return glsl.load(path, defines, project.include_dirs)

    vertex, fragment = load(shader_pass.vertex, "vs"), load(shader_pass.fragment, "ps")
    try:
        program = glsl.link(vertex, fragment)
    except GlslError as error:
        raise GlslError(f'{error.message}\n(in pass "{shader_pass.name}")', error.file, error.line) from None
    return vertex, fragment, program, PassUniforms(project, shader_pass, program)


# ---- Meshes ----------------------------------------------------------------------------------------------


def _state(state: RenderState) -> native.State:
    cull = gl_enums.GL_FRONT if state.cull_front else gl_enums.GL_BACK
    return native.State(
        cull if state.cull else gl_enums.GL_NONE, gl_enums.GL_CCW if state.ccw else gl_enums.GL_CW, state.depth_clamp
    )


class _Meshes:
    """Meshes of a project, each file and shape once."""

    def __init__(self, project: Project):
        self._project = project
        self._made: dict[object, native.Mesh] = {}

    def item(self, shader_pass: Pass, item: Geometry | Model) -> PreparedItem:
        if isinstance(item, Geometry) and item.shape == "ScreenQuadNDC":
            fields = Field.POSITION, Field.TEXCOORD  # whatever the pass's input layout
        else:
            fields = tuple(Field[value.upper()] for value in shader_pass.layout)
        return PreparedItem(item, self._mesh(shader_pass, item), fields, _state(item.state))

    def _mesh(self, shader_pass: Pass, item: Item) -> native.Mesh:
        if isinstance(item, Geometry):
            return self._once(
                (item.shape, item.size), lambda: native.Mesh.create(shapes.vertices(item.shape, item.size))
            )
        path = self._project.path(item.path)
        what = f'<item type="model"> "{item.name}" of pass "{shader_pass.name}"'
        if not os.path.isfile(path):
            raise ProjectError(f'{what}: there is no file "{item.path}"', self._project.file, item.line)
        try:
            return self._once(item.path, lambda: native.Mesh.load(path))
        except NativeError as error:
            raise ProjectError(
                f'{what}: cannot read the model "{item.path}": {error.message}', self._project.file, item.line
            ) from None

    def _once(self, key: object, make: Callable[[], native.Mesh]) -> native.Mesh:
        if key not in self._made:
            self._made[key] = make()
        return self._made[key]


# ---- Textures --------------------------------------------------------------------------------------------


def _texture_error(project: Project, texture: TextureObject, error: textures.TextureError) -> ProjectError:
    return ProjectError(f'<object type="texture" path="{texture.path}">: {error.message}', project.file, texture.line)


def _start_images(project: Project, thread: ThreadPoolExecutor) -> dict[str, Future[np.ndarray]]:
    """Looks at all headers at once, and starts to decode when all are in order."""
    total = 0
    for texture in project.textures:
        try:
            width, height = textures.size(project.path(texture.path))
            total += width * height
            if total > textures.MOST_PIXELS:
                raise textures.TextureError(f"more than {textures.MOST_PIXELS} pixels of textures in all")
        except textures.TextureError as error:
            raise _texture_error(project, texture, error) from None
    return {t.path: thread.submit(textures.read, project.path(t.path), vflip=t.vflip) for t in project.textures}


def _texture(project: Project, texture: TextureObject, image: Future[np.ndarray]) -> native.Texture:
    try:
        pixels = image.result()
    except textures.TextureError as error:
        raise _texture_error(project, texture, error) from None
    return native.Texture(
        pixels,
        _FILTERS[texture.min_filter],
        _FILTERS[texture.mag_filter],
        _WRAPS[texture.wrap_s],
        _WRAPS[texture.wrap_t],
    )


def _bind(
    project: Project,
    shader_pass: Pass,
    fragment: glsl.Source,
    program: native.Program,
    made: dict[str, native.Texture],
) -> tuple[BoundTexture, ...]:
    """The pass's textures by slot, gaps closed: the k-th to unit k and to the k-th sampler declared."""
    slots = sorted(
        (bind.slot, t.path, t) for t in project.textures for bind in t.binds if bind.pass_name == shader_pass.name
    )
    samplers = declared_samplers(fragment.text)
    bound = tuple(
        BoundTexture(unit, samplers[unit] if unit < len(samplers) else None, texture, made[path])
        for unit, (_, path, texture) in enumerate(slots)
    )
    for texture in bound:
        if texture.sampler in program.uniforms:
            program.set_uniform(texture.sampler, gl_enums.GL_SAMPLER_2D, np.array([texture.unit], np.int32))
    given = {texture.sampler for texture in bound}
    for name, uniform in program.uniforms.items():
        if uniform.type == gl_enums.GL_SAMPLER_2D and name not in given:
            # SHADERed would show whatever is in unit 0.
            raise ProjectError(
                f'pass "{shader_pass.name}": no texture goes to the sampler "{name}"; {len(bound)} are bound '
                f"and the declarations that SHADERed finds are, in order: {', '.join(samplers) or 'none'}",
                project.file,
                shader_pass.line,
            )
    return bound
