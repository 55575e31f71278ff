"""Which files a picture is made of, and whether one of them has changed."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NoReturn

from ..errors import GlslError, HarnessError
from ..language import glsl
from ..projects import sprj
from ..projects.project import Buffer, ComputePass, CubeMap, Model, Project, Shader, TextureObject

#: between two looks
SECONDS = 0.5


def files(project: Project) -> set[Path]:
    """The project's file, shaders, their includes, textures, models and the content of buffers, there or not."""
    found = {project.file}
    for shader_pass in project.passes:
        for value in vars(shader_pass).values():
            if isinstance(value, Shader):
                found |= _with_includes(project, project.path(value.path))
        if not isinstance(shader_pass, ComputePass):
            found |= {project.path(i.path) for i in shader_pass.items if isinstance(i, Model)}
    for described in project.objects:
        if isinstance(described, CubeMap):
            found |= {project.path(path) for path in described.faces}
        elif isinstance(described, TextureObject | Buffer):
            found.add(project.path(described.path))
    return found


def _with_includes(project: Project, path: Path) -> set[Path]:
    try:
        source = glsl.load(path, include_dirs=project.include_dirs, version=glsl.VERSION)
    except GlslError:
        return {path}
    found = {path, *(Path(file) for file, _ in source.origins)}
    # Whatever is missing comes into one of these folders, which changes them.
    return found | set(project.include_dirs) if source.missing_includes else found


class Watch:
    """Files as they are now."""

    def __init__(self, paths: Iterable[str | os.PathLike]):
        self._stamps = {Path(path): _stamp(path) for path in paths}

    def changed(self) -> bool:
        """Whether one of them was changed, made or removed since the last time that this said so."""
        now = {path: _stamp(path) for path in self._stamps}
        different = now != self._stamps
        self._stamps = now
        return different


def follow(path: str | os.PathLike, work: Callable[[], object]) -> NoReturn:
    """Does the work now, and again whenever a file of the project in ``path`` changes."""
    watched = {Path(path)}
    while True:
        try:
            watched = files(sprj.read(path))
        except HarnessError:
            pass  # which the work says; what was watched so far may mend it
        watch = Watch(watched)
        work()
        while not watch.changed():
            time.sleep(SECONDS)


def _stamp(path: str | os.PathLike) -> tuple[int, int, int] | None:
    """What changes when a file is written or another put in its place; None where there is none."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
