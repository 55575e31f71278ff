"""One project while it is tuned: what it can do without, the search for its rungs, what that comes to, the file."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from .. import ladder as ladders
from ..errors import HarnessError, LadderError, ProjectError
from ..ladder import Ladder, Preset
from ..picture import write
from ..projects import sprj
from ..projects.project import Pass, Project
from ..projects.xml_lines import parse, read_bytes
from ..rendering import programs
from ..trade.scene import Difference
from ..viewing import view_macros
from . import edit, needs, views
from .compare import Comparison, draw
from .needs import Need
from .pictures import Pictures, with_macros
from .search import Found, Search, State, Step
from .stage_cost import Costs, code
from .tuning import Budget, Choice, PassCost, Refusal, Tuning


class Tuner:
    """One project while it is tuned."""

    def __init__(
        self,
        path: Path,
        budget: Budget,
        target: str,
        reference: str,
        n_views: int,
        size: tuple[int, int],
        drawn: Callable[[], None] | None,
    ):
        self._path, self._budget, self._size = path, budget, size
        self._count, self._tell = 0, drawn
        self._data = read_bytes(path)
        self._project = sprj.read(path, data=self._data)
        if parse(path, data=self._data).get("version", "1") != "2":
            raise ProjectError("a project of version 1 has no macros: save it in SHADERed 1.5.6 first", path)
        self._ladder = _ladder(self._project)
        self._preset: Preset | None = self._ladder.preset(reference) if self._ladder else None
        self._views = views.orbit(self._project, n_views)
        self._made: dict[bytes, Pictures] = {}
        self._chosen: Pictures | None = None  # of the project without what is not needed
        by_preset = self._preset_macros(self._project)
        self._compared = Comparison(self._pictures(self._data), by_preset, budget)
        passes = [with_macros(p, by_preset[p.name]) for p in _drawn(self._project)]
        self._costs = Costs(self._project, passes, target)

    # ---- Pictures ----------------------------------------------------------------------------------------------------

    def _pictures(self, data: bytes) -> Pictures:
        """The pictures of the project that is in these bytes."""
        if data not in self._made:
            project = self._project if data is self._data else sprj.read(self._path, data=data)
            self._made[data] = Pictures(project, self._views, self._size, self._picture_drawn)
        return self._made[data]

    def _picture_drawn(self) -> None:
        self._count += 1
        if self._tell is not None:
            self._tell()

    # ---- What passes know --------------------------------------------------------------------------------------------

    def _known(self, shader_pass: Pass) -> dict[str, str]:
        """The reference's rungs of the terms that are mentioned in a pass's shaders."""
        if self._preset is None:
            return {}
        texts = [source.text for source in programs.sources(self._project, shader_pass).values()]
        return {m: r for m, r in self._preset.macros.items() if any(re.search(rf"\b{m}\b", text) for text in texts)}

    def _preset_macros(self, project: Project) -> dict[str, dict[str, str]]:
        """The same of all passes."""
        return {p.name: self._known(p) for p in _drawn(project)}

    def _rungs(self, project: Project) -> dict[tuple[str, str], tuple[str, ...]]:
        """The rungs of the terms that make a difference in a pass's code, by pass and macro."""
        found = {}
        for p in _drawn(project):
            known = self._known(p)
            for macro in known:
                rungs = tuple(rung.value for rung in self._ladder.term(macro).rungs)
                codes = {code(project, with_macros(p, known | {macro: rung})) for rung in rungs}
                if len(codes) > 1:
                    found[p.name, macro] = rungs
        return found

    def _written(self, project: Project) -> dict[tuple[str, str], str | None]:
        """The rungs that a project has as it is, None where its shaders do not say."""
        defaults = {ladder.name: ladder.default for ladder in view_macros.find(project).ladders}
        found = {}
        for p in _drawn(project):
            own = {m.name: m.value.strip() for m in p.macros}
            for macro in self._known(p):
                found[p.name, macro] = own.get(macro, defaults.get(macro))
        return found

    # ---- The run -----------------------------------------------------------------------------------------------------

    def run(self) -> Tuning:
        """What is chosen."""
        kept, data = self._needs()
        self._chosen = pictures = self._pictures(data)
        found, beyond = self._search(pictures)
        written = self._written(pictures.project)
        final = data
        for (name, macro), rung in found.state.items():
            if written[name, macro] != rung:
                final = edit.set_macro(final, name, macro, rung)
        own = self._pictures(self._data)
        return Tuning(
            project=str(self._path),
            reference=self._preset.name if self._preset else None,
            budget=self._budget,
            views=tuple(self._views),
            size=self._size,
            unit=self._costs.unit,
            driver=self._costs.driver,
            reason=self._costs.reason,
            macros=_by_pass(found.state),
            costs=tuple(self._pass_costs(pictures.project, found.state)),
            choices=tuple(self._choices(kept, found.state)),
            refused=tuple(Refusal(s.pass_name, s.macro, s.rung, s.saves, beyond[s]) for s in found.refused),
            written=self._compared.difference(own, {}),
            chosen=self._compared.difference(pictures, _by_pass(found.state)),
            pictures=self._count,
            data=final,
            changes=final != self._data,
        )

    def _needs(self) -> tuple[list[Need], bytes]:
        """What can be done without, and the project without it."""
        macros = self._preset.macros if self._preset else {}
        found = needs.find(self._path, self._data, self._ladder, macros)
        kept, data = found, self._without(self._data, found)
        if found and data is None:  # one of them is needed after all
            kept, data = [], self._data
            for need in found:
                less = self._without(data, [need])
                if less is not None:
                    kept, data = [*kept, need], less
        pictures = self._pictures(data)
        layouts = needs.find_layouts(pictures.project, pictures.passes({}), data)
        less = self._without(data, layouts)
        return (kept, data) if less is None else ([*kept, *layouts], less)

    def _without(self, data: bytes, listed: Sequence[Need]) -> bytes | None:
        """The project without these; None where its picture is beyond the budget then, or it does not compile."""
        for need in listed:
            data = need.apply(data)
        if not listed:
            return data
        try:
            pictures = self._pictures(data)
            _, fits = self._compared.measure(pictures, self._preset_macros(pictures.project))
        except HarnessError:
            return None
        return data if fits else None

    def _search(self, pictures: Pictures) -> tuple[Found, dict[Step, Difference]]:
        project = pictures.project
        rungs = self._rungs(project)
        beyond: dict[tuple, Difference] = {}

        def off(state: State) -> float | None:
            difference, fits = self._compared.measure(pictures, _by_pass(state))
            if not fits:
                beyond[tuple(sorted(state.items()))] = difference
            return difference.mean if fits else None

        by_name = {p.name: p for p in _drawn(project)}

        def costs(asked: Sequence[tuple[str, State]]) -> list[float]:
            made = [with_macros(by_name[name], _by_pass(state)[name]) for name, state in asked]
            return [c.cycles for c in self._costs.of(made)]

        starts = self._starts(project, rungs)
        found = Search(rungs, costs, off, reference=starts[-1]).cheapest(starts)
        if found is None:  # not even the reference: what is not needed took all of the budget
            raise AssertionError("the reference is beyond the budget")
        return found, {s: beyond[tuple(sorted(s.of(found.state).items()))] for s in found.refused}

    def _starts(self, project: Project, rungs: Mapping[tuple[str, str], Sequence[str]]) -> list[State]:
        """The project as it is, and the reference."""
        if self._preset is None:
            return [{}]
        written = self._written(project)
        own = {key: written[key] for key in rungs}
        reference = {key: self._preset.macros[key[1]] for key in rungs}
        return [own, reference] if all(own[key] in rungs[key] for key in rungs) else [reference]

    # ---- What it comes to --------------------------------------------------------------------------------------------

    def _pass_costs(self, project: Project, state: State) -> list[PassCost]:
        own = _drawn(self._project)
        written = self._costs.of(own)
        reference = self._costs.of([with_macros(p, self._known(p)) for p in own])
        macros = _by_pass(state)
        chosen = self._costs.of([with_macros(p, macros.get(p.name, {})) for p in _drawn(project)])
        return [
            PassCost(p.name, w.cycles, r.cycles, c.cycles)
            for p, w, r, c in zip(own, written, reference, chosen, strict=True)
        ]

    def _choices(self, kept: Sequence[Need], state: State) -> list[Choice]:
        """What each choice saves, after those before it, and what it changes alone."""
        own, reference = self._pictures(self._data), self._preset_macros(self._project)
        listed: list[tuple[str, str, str | None, Difference]] = []
        chain: list[Pass] = []  # a pass before and after each choice
        data = self._data
        for need in kept:
            before, data = data, need.apply(data)
            alone = self._pictures(need.apply(self._data))
            difference = self._compared.difference(alone, self._preset_macros(alone.project))
            listed.append((need.pass_name, need.text, None, difference))
            chain += [self._by_preset(text, need.pass_name) for text in (before, data)]
        for name, chosen in _by_pass(state).items():
            shader_pass = self._by_preset(data, name)
            for macro, rung in chosen.items():
                if reference[name][macro] == rung:
                    continue
                only = {**reference, name: reference[name] | {macro: rung}}
                listed.append((name, f"{macro} = {rung}", macro, self._compared.difference(own, only)))
                chain += [shader_pass, with_macros(shader_pass, {macro: rung})]
                shader_pass = chain[-1]
        costs = [cost.cycles for cost in self._costs.of(chain)]
        return [
            Choice(name, text, macro, before - after, difference)
            for (name, text, macro, difference), before, after in zip(listed, costs[::2], costs[1::2], strict=True)
        ]

    def _by_preset(self, data: bytes, name: str) -> Pass:
        """A pass of the project in these bytes, by the reference preset."""
        (shader_pass,) = (p for p in sprj.read(self._path, data=data).passes if p.name == name)
        return with_macros(shader_pass, self._known(shader_pass))

    # ---- Writing -----------------------------------------------------------------------------------------------------

    def write(self, tuning: Tuning) -> None:
        """Writes the project with all choices. HarnessError, and nothing is written, where it would not render as
        found, or where the file is another by now."""
        wanted = draw(self._chosen, tuning.macros)
        there = draw(self._pictures(tuning.data), {})
        if not all(map(np.array_equal, wanted, there)):
            raise HarnessError("what would be written does not render as what was found", self._path)
        real = self._path.resolve()  # by name: the renaming must not turn a link into a file
        if read_bytes(real) != self._data:
            raise HarnessError("the file has changed while it was tuned; nothing is written", self._path)
        mode = stat.S_IMODE(real.stat().st_mode)
        write(real, lambda file: file.write(tuning.data))
        os.chmod(real, mode)


def _drawn(project: Project) -> list[Pass]:
    return [p for p in project.passes if isinstance(p, Pass)]


def _ladder(project: Project) -> Ladder | None:
    """The ladder of a project, None where it has none."""
    try:
        return ladders.of_project(project)
    except LadderError as error:
        if error.file != str(project.file):  # there is one, and something is wrong with it
            raise
        return None


def _by_pass(state: State) -> dict[str, dict[str, str]]:
    found: dict[str, dict[str, str]] = {}
    for (name, macro), rung in state.items():
        found.setdefault(name, {})[macro] = rung
    return found
