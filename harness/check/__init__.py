"""What can be known of a SHADERed project without looking at its picture: ``check(path)`` lists it."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from ..errors import ProjectError
from ..language import glsl
from ..projects import sprj_v1
from ..projects.xml_lines import Element, parse
from . import features, models, samplers, shaders, structure, textures, uniforms
from .findings import RULES, SEVERITIES, Finding, Rule
from .state import State

__all__ = ["RULES", "SEVERITIES", "Finding", "Rule", "check"]


# Shapes and models of absurd numbers overflow silently, as in SHADERed.
@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def check(project_path: str | os.PathLike) -> list[Finding]:
    """All findings about a project, by file and line. What keeps a part from being looked at is itself a finding."""
    path = Path(project_path)
    try:
        root = parse(path)
        unreadable = structure.check_root(root)
        if unreadable is None and root.get("version", "1") == "1":
            sprj_v1.modernize(root)
    except ProjectError as error:
        unreadable = error
    if unreadable is not None:
        fix = "correct the file, or save it again from SHADERed 1.5.6"
        return [Finding("HS001", unreadable.message, fix, glsl.shown_path(path), unreadable.line)]
    state = compiled(path, root)
    uniforms.check(state)
    samplers.check(state)
    textures.check(state)
    models.check(state)
    features.check(state)
    structure.check_reader(state)
    return sorted(state.findings, key=lambda f: (_rank(f, state), f.file, f.line or 0, f.code))


def compiled(path: Path, root: Element) -> State:
    """The state of the checks with the passes compiled, for all that looks at them."""
    state = State(path, root)
    structure.check(state)
    shaders.check(state)
    return state


def _rank(finding: Finding, state: State) -> int:
    """The .sprj first."""
    return int(finding.file != glsl.shown_path(state.path))
