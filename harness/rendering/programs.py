"""The programs of passes: their shaders with macros and includes, compiled and linked as SHADERed does."""

from __future__ import annotations

import os
import re

from .. import native
from ..errors import GlslError, ProjectError
from ..language import glsl
from ..native import Stage
from ..projects.project import ComputePass, Pass, Project, Shader

#: macros that SHADERed 1.5.6 gives to every shader
SYSTEM_MACROS = {"SHADERED_DESKTOP": "", "SHADERED_VERSION": "1005005"}

#: SHADERed's own search for samplers, over the bare text: comments, dead branches and parameters count
_SAMPLER = re.compile(r"[a-z]?sampler[^\r\n]+ [^\r\n]+;")

#: field of Pass -> stage, type in the .sprj
_STAGES = {
    "vertex": (Stage.VERTEX, "vs"),
    "tess_control": (Stage.TESS_CONTROL, "tcs"),
    "tess_evaluation": (Stage.TESS_EVALUATION, "tes"),
    "geometry": (Stage.GEOMETRY, "gs"),
    "fragment": (Stage.FRAGMENT, "ps"),
    "compute": (Stage.COMPUTE, "cs"),
}


def declared_samplers(fragment_text: str) -> list[str]:
    """What SHADERed takes for the samplers' names, in the order in which it gives them textures."""
    return [match[0].partition(" ")[2][:-1] for match in _SAMPLER.finditer(fragment_text)]


def sources(project: Project, shader_pass: Pass | ComputePass) -> dict[Stage, glsl.Source]:
    """The pass's shaders as the compilers get them. GlslError; ProjectError for missing files."""
    defines = SYSTEM_MACROS | {macro.name: macro.value for macro in shader_pass.macros}
    found = {}
    for name, (stage, written) in _STAGES.items():
        shader = getattr(shader_pass, name, None)
        if shader is not None:
            found[stage] = _load(project, shader_pass, shader, written, defines)
    return found


def link(project: Project, shader_pass: Pass | ComputePass) -> tuple[dict[Stage, glsl.Source], native.Program]:
    """The pass's shaders as the compilers get them, and their program. GlslError; ProjectError for missing files."""
    loaded = sources(project, shader_pass)
    try:
        return loaded, glsl.link_stages(loaded)
    except GlslError as error:
        raise GlslError(f'{error.message}\n(in pass "{shader_pass.name}")', error.file, error.line) from None


def _load(
    project: Project, shader_pass: Pass | ComputePass, shader: Shader, written: str, defines: dict[str, str]
) -> glsl.Source:
    path = project.path(shader.path)
    if not os.path.isfile(path):
        raise ProjectError(
            f'<shader type="{written}"> of pass "{shader_pass.name}": there is no file "{shader.path}"',
            project.file,
            shader.line,
        )
    return glsl.load(path, defines, project.include_dirs)
