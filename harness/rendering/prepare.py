"""Gets the passes of a project ready to draw: programs, items, objects in their units, uniforms.

What a pass came to is open to tests and reports: its program's active uniforms and attributes, its shaders'
final texts, and which texture went to which sampler.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from .. import native
from ..errors import HarnessError, ProjectError
from ..language import glsl
from ..native import Stage, gl_enums
from ..projects.project import ComputePass, Object, Pass, Project, RenderTexture
from ..projects.traps import Traps
from . import programs, resources
from .meshes import Meshes, PreparedItem
from .programs import SYSTEM_MACROS as SYSTEM_MACROS
from .programs import declared_samplers
from .uniforms import PassUniforms

_SAMPLER_TARGETS = {
    gl_enums.GL_SAMPLER_2D: gl_enums.GL_TEXTURE_2D,
    gl_enums.GL_SAMPLER_3D: gl_enums.GL_TEXTURE_3D,
    gl_enums.GL_SAMPLER_CUBE: gl_enums.GL_TEXTURE_CUBE_MAP,
}


@dataclass(frozen=True)
class BoundTexture:
    """A texture in its unit. ``sampler`` is the declaration that it went to, None where there are too few.
    ``texture`` is None of a render texture: it is made when the size of the window is known."""

    unit: int
    sampler: str | None
    object: Object
    texture: native.Texture | None


@dataclass(frozen=True)
class BoundStorage:
    """An image in its unit, or a buffer in its binding."""

    index: int
    object: Object
    made: native.Texture | native.Buffer


@dataclass(frozen=True)
class PreparedPass:
    """A pass ready to draw. ``program.uniforms`` and ``program.attributes`` are what the linker left."""

    shader_pass: Pass | ComputePass
    sources: Mapping[Stage, glsl.Source]
    program: native.Program
    uniforms: PassUniforms
    textures: tuple[BoundTexture, ...]
    storage: tuple[BoundStorage, ...]
    items: tuple[PreparedItem, ...]

    @property
    def vertex(self) -> glsl.Source:
        """The vertex shader's final text."""
        return self.sources[Stage.VERTEX]

    @property
    def fragment(self) -> glsl.Source:
        """The fragment shader's final text."""
        return self.sources[Stage.FRAGMENT]


@dataclass(frozen=True)
class _Made:
    """The objects of the project on the GL side, by name."""

    textures: Mapping[str, native.Texture]
    images: Mapping[str, native.Texture]
    buffers: Mapping[str, native.Buffer]


def prepare(project: Project, traps: Traps | None = None) -> list[PreparedPass]:
    """The project's passes, ready to draw; each file is read once. ``traps`` receives the warnings.

    ProjectError, with the .sprj's line, for files that are missing or damaged and for what does not fit
    together; GlslError for shaders. With ``traps.keep_going`` what they are about is left out.
    """
    traps = Traps() if traps is None else traps
    # One thread, so that images are decoded while shaders compile. More gain nothing: Pillow holds the GIL.
    thread = ThreadPoolExecutor(max_workers=1)
    try:
        pictures = resources.Pictures(project, thread, traps)
        native.open_context()
        linked = []
        for p in project.passes:
            try:
                linked.append((p, *programs.link(project, p)))
            except HarnessError as error:
                traps.survive(error)
        buffers = resources.make_buffers(project, traps)
        meshes = Meshes(project, buffers, traps)
        items = {p.name: meshes.items(p) for p, _, _ in linked if isinstance(p, Pass)}
        made = _Made(pictures.textures(), resources.make_images(project, traps), buffers)
    finally:
        thread.shutdown(cancel_futures=True)
    return [
        PreparedPass(
            p,
            sources,
            program,
            PassUniforms(project, p, program, traps),
            _bind_textures(project, p, sources, program, made, traps),
            _bind_storage(project, p, made, traps),
            items.get(p.name, ()),
        )
        for p, sources, program in linked
    ]


def relink(project: Project, prepared: PreparedPass, shader_pass: Pass | ComputePass) -> PreparedPass:
    """``prepared`` as ``shader_pass``, which is the same pass under other macros: linked anew, and given what it has.

    GlslError where it does not compile so.
    """
    traps = Traps()
    loaded, program = programs.link(project, shader_pass)
    given = {b.object.name: b.texture for b in prepared.textures if b.texture is not None}
    return replace(
        prepared,
        shader_pass=shader_pass,
        sources=loaded,
        program=program,
        uniforms=PassUniforms(project, shader_pass, program, traps),
        textures=_bind_textures(project, shader_pass, loaded, program, _Made(given, {}, {}), traps),
    )


def _bind_textures(
    project: Project,
    shader_pass: Pass | ComputePass,
    sources: Mapping[Stage, glsl.Source],
    program: native.Program,
    made: _Made,
    traps: Traps,
) -> tuple[BoundTexture, ...]:
    """The pass's textures by slot, gaps closed: the k-th to unit k and to its pixel shader's k-th declared sampler.

    The samplers of compute shaders SHADERed leaves where their own ``layout(binding = ...)`` puts them.
    """
    available = {**made.textures, **made.images}
    objects = [o for o in project.bound(shader_pass.name) if isinstance(o, RenderTexture) or o.name in available]
    samplers = declared_samplers(sources[Stage.FRAGMENT].text) if Stage.FRAGMENT in sources else []
    bound = tuple(
        BoundTexture(unit, samplers[unit] if unit < len(samplers) else None, o, available.get(o.name))
        for unit, o in enumerate(objects)
    )
    for texture in bound:
        uniform = program.uniforms.get(texture.sampler)
        if uniform is not None:
            program.set_uniform(texture.sampler, uniform.type, np.array([texture.unit], np.int32))
            _warn_of_kind(project, shader_pass, texture, uniform.type, traps)
    given = {texture.sampler for texture in bound}
    if isinstance(shader_pass, ComputePass):
        return bound
    for name, uniform in program.uniforms.items():
        if uniform.type in _SAMPLER_TARGETS and name not in given:
            traps.warn(
                f'pass "{shader_pass.name}": no texture goes to the sampler "{name}", and it shows what is in unit 0; '
                f"{len(bound)} are bound and the declarations that SHADERed finds are, in order: "
                f"{', '.join(samplers) or 'none'}",
                str(project.file),
                shader_pass.line,
            )
    return bound


def _warn_of_kind(
    project: Project, shader_pass: Pass | ComputePass, bound: BoundTexture, gl_type: int, traps: Traps
) -> None:
    target = gl_enums.GL_TEXTURE_2D if bound.texture is None else bound.texture.target
    if _SAMPLER_TARGETS.get(gl_type, target) != target:
        traps.warn(
            f'pass "{shader_pass.name}": the sampler "{bound.sampler}" is a {gl_enums.GLSL_TYPE_NAMES[gl_type]}, but '
            f'"{bound.object.name}" goes to it, which is none',
            str(project.file),
            bound.object.line,
        )


def _bind_storage(
    project: Project, shader_pass: Pass | ComputePass, made: _Made, traps: Traps
) -> tuple[BoundStorage, ...]:
    """What the pass can write to, by slot, gaps closed: the k-th to image unit or binding k."""
    found = []
    for described in project.bound(shader_pass.name, storage=True):
        if described.name in made.buffers:
            found.append((described, made.buffers[described.name]))
        elif described.name in made.images:
            found.append((described, made.images[described.name]))
    bound = []
    for index, (described, thing) in enumerate(found):
        if isinstance(thing, native.Texture) and isinstance(shader_pass, Pass):
            traps.survive(
                ProjectError(
                    f'the image "{described.name}" is bound to pass "{shader_pass.name}" to be written: SHADERed does '
                    "that in compute passes alone, and here it is not supported",
                    project.file,
                    described.line,
                )
            )
        else:
            bound.append(BoundStorage(index, described, thing))
    return tuple(bound)
