"""One case of the fuzz: a project of the corpus with one or two of its files spoilt, and what becomes of it.

Every outcome is a result, or an error that names a file: never another exception, nor a file that was not there.
"""

from __future__ import annotations

import os
import random
import shutil
import tempfile
from pathlib import Path

from mutations import spoil

from harness import HarnessError, native
from harness.calling import library
from harness.check import check
from harness.language import glsl
from harness.native import Stage
from harness.projects import sprj
from harness.projects.traps import Traps
from harness.rendering.render import Renderer

KINDS = {".sprj": "xml", ".png": "bytes", ".jpg": "bytes", ".hdr": "bytes", ".bmp": "bytes", ".tga": "bytes"}
KINDS |= {".gltf": "bytes", ".glb": "bytes", ".obj": "bytes", ".bin": "bytes", ".dds": "bytes"}
SIZE = 16, 12


class WrongError(Exception):
    """What a case shows to be wrong; ``str()`` says it in a paragraph."""


def corpus(root: Path, more: list[str]) -> list[Path]:
    """The .sprj files of the repository and of other folders, in an order that does not depend on the machine."""
    found = [root / "project.sprj", *sorted((root / "tests" / "conformance").glob("*/*.sprj"))]
    return found + [path for folder in more for path in sorted(Path(folder).rglob("*.sprj"))]


def describe(project: Path, seed: str, number: int) -> tuple[str, list[Path], random.Random]:
    """What is tried, which files of the project are spoilt, and the chance that spoils them."""
    chance = random.Random(f"{seed}:{number}")
    target = chance.choice(("read", "read", "expand", "expand", "check", "render"))
    files = sorted(p for p in project.parent.rglob("*") if p.is_file() and _used(project, p))
    shaders = [p for p in files if _kind(p) == "glsl"]
    others = [p for p in files if p.suffix != ".sprj"]
    if target == "read":
        spoilt = [project]
    elif target == "expand" and shaders:
        spoilt = chance.sample(shaders, min(len(shaders), chance.choice((1, 1, 2))))
    else:
        spoilt = [
            chance.choice((project, project, chance.choice(shaders or [project]), chance.choice(others or [project])))
        ]
    return target, spoilt, chance


def _used(project: Path, path: Path) -> bool:
    """Not what lies in other folders of a repository, beside the project's."""
    parts = path.relative_to(project.parent).parts
    folders = ("shaders", "textures", "models", "include", "lib")
    return path == project or (len(parts) > 1 and parts[0] in folders and path.suffix not in (".py", ".pyc"))


def _kind(path: Path) -> str:
    return KINDS.get(path.suffix, "glsl")


def run(project: Path, seed: str, number: int, keep: str | None = None) -> str:
    """Tries a case in a folder of its own, which is left in ``keep``. What came of it: "done" or "refused".

    WrongError for what should not be. Everything that is printed meanwhile is dropped.
    """
    target, spoilt, chance = describe(project, seed, number)
    with tempfile.TemporaryDirectory(prefix="fuzz-") as temporary:
        folder = Path(temporary, "project")
        copied = _copy(project, folder)
        for path in spoilt:
            copy = copied[path]
            copy.unlink()
            copy.write_bytes(spoil(path.read_bytes(), _kind(path), chance))
        if keep is not None:
            shutil.copytree(folder, keep, dirs_exist_ok=True)
        before = _listing(folder)
        here = os.getcwd()
        os.mkdir(Path(temporary, "here"))
        os.chdir(Path(temporary, "here"))
        try:
            outcome = _try(target, copied[project], [copied[p] for p in spoilt])
            if os.listdir(".") or _listing(folder) != before:
                raise WrongError("a file was written or changed")
        finally:
            os.chdir(here)
    return f"{target}: {outcome}"


def _copy(project: Path, folder: Path) -> dict[Path, Path]:
    copied = {}
    for path in sorted(p for p in project.parent.rglob("*") if p.is_file() and _used(project, p)):
        copied[path] = folder / path.relative_to(project.parent)
        copied[path].parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, copied[path])
    return copied


def _listing(folder: Path) -> list[tuple[str, int, int]]:
    return sorted((str(p), p.stat().st_mtime_ns, p.stat().st_size) for p in folder.rglob("*"))


def _try(target: str, project: Path, spoilt: list[Path]) -> str:
    try:
        _TARGETS[target](project, spoilt)
    except HarnessError as error:
        if not error.message.strip() or len(error.message) > 20_000:
            raise WrongError(f"the message has {len(error.message)} characters") from error
        if target != "render" and error.file is None:
            raise WrongError(f"the error names no file: {error}") from error
        if error.line is not None and error.line < 1:
            raise WrongError(f"the error names line {error.line}") from error
        return "refused"
    return "done"


def _read(project: Path, spoilt: list[Path]) -> None:
    traps = Traps(keep_going=True)
    try:
        sprj.read(project, traps)
    finally:
        for said in (*traps.warnings, *traps.errors):
            if said.file is None:
                raise WrongError(f"names no file: {said}")
    sprj.read(project)


def _expand(project: Path, spoilt: list[Path]) -> None:
    refused = None
    for path in spoilt:
        for how in ({}, {"library": True, "version": glsl.VERSION}):
            try:
                source = glsl.load(path, {"A": "1", "F(x)": "x"}, [project.parent, path.parent], **how)
                if source.text.count("\n") != len(source.origins):
                    raise WrongError(f"{source.text.count(chr(10))} lines, {len(source.origins)} origins")
                glsl.check(Stage.FRAGMENT, source, spirv=True)
            except HarnessError as error:
                refused = error
        try:
            loaded = library.load(path, {}, [project.parent])
            for signature, comment in loaded.comments.items():
                f"{signature} {comment}"
        except HarnessError as error:
            refused = error
    if refused is not None:
        raise refused


def _check(project: Path, spoilt: list[Path]) -> None:
    try:
        found = check(project)
    except HarnessError as error:
        raise WrongError(f"the check gives up, where it should find: {error}") from error
    for finding in found:
        if not finding.message or not finding.fix or (finding.line is not None and finding.line < 1):
            raise WrongError(f"a finding lacks something: {finding}")


def _render(project: Path, spoilt: list[Path]) -> None:
    renderer = Renderer(project, SIZE, keep_going=True)
    renderer.draw()
    if renderer.picture().shape != (SIZE[1], SIZE[0], 4):
        raise WrongError("the picture has another size")
    if error := native.take_error():
        raise WrongError(f"GL: {error}")
    if renderer.errors:
        raise renderer.errors[0]


_TARGETS = {"read": _read, "expand": _expand, "check": _check, "render": _render}
