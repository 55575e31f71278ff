"""What is measured: each rung of a ladder, the other terms at their defaults, and each preset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..calling.call import shader
from ..calling.function import Function
from ..errors import LadderError, among
from ..ladder import Ladder, Preset, Rung, Term
from ..projects.project import Project
from ..viewing import view_macros
from . import sampling

#: the preset that the others' values, times and pictures are compared with
REFERENCE = "exact"
#: the function that computes the whole model
WHOLE = "shade"


@dataclass(frozen=True)
class Choice:
    """A rung or a preset, and what it is compared with.

    ``own`` is the function whose error it has, a rung's that of its term, with the ``domain`` of its arguments;
    ``whole`` is the one whose soundness, energy, cost and time are measured: ``shade`` where its file has one, else
    ``own``.
    """

    entry: Rung | Preset
    term: Term | None
    path: Path
    include_dirs: Sequence[str | Path]
    own: str
    whole: str
    domain: Mapping[str, Any]
    macros: Mapping[str, str]
    exact: Mapping[str, str]  # of the formula that its model error is against
    reference: Mapping[str, str]  # of what its time is compared with, and its picture
    scene: Mapping[str, str]  # of its picture
    _loaded: dict[str, Any] = field(default_factory=dict, compare=False, repr=False)

    @property
    def name(self) -> str:
        """The value of its macro, or the preset's name."""
        return self.entry.name if isinstance(self.entry, Preset) else self.entry.value

    def function(self, name: str, macros: Mapping[str, str] | None = None) -> Function:
        """A function of its file, under its own macros or others. GlslError, CallError when there is none."""
        key = repr(sorted((self.macros if macros is None else macros).items()))
        if key not in self._loaded:
            self._loaded[key] = shader(self.path, self.macros if macros is None else macros, self.include_dirs)
        return self._loaded[key][name]

    @property
    def whole_domain(self) -> Mapping[str, Any]:
        """Of the arguments of ``whole``."""
        return sampling.SHADE if self.whole == WHOLE else self.domain

    def described(self) -> dict[str, Any]:
        """What the data says of it before anything is measured."""
        rung = self.entry if isinstance(self.entry, Rung) else None
        return {
            "name": self.name,
            "title": self.entry.title,
            "source": self.entry.source,
            "domain": rung.domain if rung else "",
            "suits": list(rung.suits) if rung else [],
            "macros": dict(self.macros),
            "function": self.own,
            "whole": self.whole,
        }


def choices(project: Project, ladder: Ladder, only: str | None = None) -> list[Choice]:
    """All rungs, term by term, then the presets; or the one named ``only``.

    LadderError when there is none of that name, or no preset ``exact``; GlslError when a file does not compile.
    """
    reference = ladder.preset(REFERENCE).macros
    folder = ladder.path.parent
    files = {term.file: _functions(folder / term.file, project) for term in ladder.terms}
    found = []
    for term in ladder.terms:
        if term.function not in files[term.file]:
            known = among(term.function, files[term.file])
            raise LadderError(f'term "{term.name}": {term.file} has no function {term.function}{known}', ladder.path)
        whole = WHOLE if WHOLE in files[term.file] else term.function
        for rung in term.rungs:
            macros = {term.macro: rung.value}
            found.append(
                Choice(
                    entry=rung,
                    term=term,
                    path=folder / term.file,
                    include_dirs=project.include_dirs,
                    own=term.function,
                    whole=whole,
                    domain=term.inputs,
                    macros=macros,
                    exact={term.macro: term.exact},
                    reference=reference,
                    scene={**reference, **macros},
                )
            )
    file = shade_file(ladder, files)
    for preset in ladder.presets:
        found.append(
            Choice(
                entry=preset,
                term=None,
                path=folder / file,
                include_dirs=project.include_dirs,
                own=WHOLE,
                whole=WHOLE,
                domain=sampling.SHADE,
                macros=preset.macros,
                exact=reference,
                reference=reference,
                scene=preset.macros,
            )
        )
    if only is None:
        return found
    named = [choice for choice in found if choice.name == only]
    if not named:
        known = among(only, [choice.name for choice in found])
        raise LadderError(f"there is no rung and no preset {only}{known}", ladder.path)
    return named


def shade_file(ladder: Ladder, files: Mapping[str, Sequence[str]]) -> str:
    """The file of the ladder that has ``shade``, of ``files`` and their functions. LadderError where none has."""
    for file, functions in files.items():
        if WHOLE in functions:
            return file
    raise LadderError(f"none of {', '.join(files)} has a function {WHOLE}, the model that presets are of", ladder.path)


def _functions(path: Path, project: Project) -> list[str]:
    return [function.__name__ for function in shader(path, include_dirs=project.include_dirs)]


def defaults(project: Project, ladder: Ladder) -> dict[str, str | None]:
    """The value of each term's macro where no pass says anything; None where no shader of the project tells it."""
    there = {found.name: found.default for found in view_macros.find(project).ladders}
    return {term.macro: there.get(term.macro) for term in ladder.terms}
