"""The ladder of a project's shaders: for each term the rungs that its macro chooses among, and presets of one of each.

It is written in ladder.toml beside the shaders:

    [[term]]
    name = "V"
    title = "Visibility"
    macro = "BRDF_V"
    file = "brdf.glsl"          # beside the ladder
    function = "visibility"     # computes the term by the rung that the macro chooses
    exact = "V_EXACT"           # what the other rungs are measured against
    inputs = { NoL = "[0,1]" }  # where the function's arguments come from, as `harness hunt --domain` says it
    [[term.rung]]
    value = "V_EXACT"
    title = "Smith, height-correlated"
    source = "Heitz 2014, eq. 99"
    domain = "everywhere"       # where it is meant to hold
    suits = ["desktop"]         # what it is meant for
    [[preset]]
    name = "exact"
    title = "As exact as it gets"
    source = "Heitz 2014"
    [preset.macros]             # of every term
    BRDF_V = "V_EXACT"
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .errors import LadderError, among
from .projects.project import Project, Shader

FILE = "ladder.toml"


@dataclass(frozen=True)
class Rung:
    """A way to compute a term. ``value`` is what the macro is then; ``source`` names author, year and equation."""

    value: str
    title: str
    source: str
    domain: str
    suits: tuple[str, ...]


@dataclass(frozen=True)
class Term:
    """A term of the model. ``file``, beside the ladder, has ``function``; ``exact`` is the value of one rung."""

    name: str
    title: str
    macro: str
    file: str
    function: str
    exact: str
    inputs: Mapping[str, str]
    rungs: tuple[Rung, ...]


@dataclass(frozen=True)
class Preset:
    """A whole model: a rung of every term, by macro."""

    name: str
    title: str
    source: str
    macros: Mapping[str, str]


@dataclass(frozen=True)
class Ladder:
    """All of the file at ``path``."""

    path: Path
    terms: tuple[Term, ...]
    presets: tuple[Preset, ...]

    def term(self, macro: str) -> Term:
        """The term whose rungs a macro chooses. LadderError where there is none."""
        return self._named({term.macro: term for term in self.terms}, macro, "term with the macro")

    def preset(self, name: str) -> Preset:
        """The preset of a name. LadderError where there is none."""
        return self._named({preset.name: preset for preset in self.presets}, name, "preset")

    def _named(self, there: Mapping[str, Any], name: str, what: str) -> Any:
        if name not in there:
            raise LadderError(f"there is no {what} {name}{among(name, there)}", self.path)
        return there[name]


def load(path: str | Path) -> Ladder:
    """Reads a ladder.toml. LadderError, with file and key, where it is missing, malformed or contradicts itself."""
    path = Path(path)
    try:
        top = _Table(tomllib.loads(path.read_text(encoding="utf-8")), path, "the file")
    except OSError as error:
        raise LadderError(f"cannot read the ladder: {error.strerror}", path) from None
    except ValueError as error:  # no TOML, or no UTF-8
        raise LadderError(f"malformed TOML: {error}", path) from None
    terms = [_term(table) for table in top.tables("term")]
    for kind in ("name", "macro"):
        top.unique([getattr(term, kind) for term in terms], f"[[term]] {kind}")
    top.unique([rung.value for term in terms for rung in term.rungs], "[[term.rung]] value")
    presets = [_preset(table, terms) for table in top.tables("preset", required=False)]
    top.unique([preset.name for preset in presets], "[[preset]] name")
    top.done()
    return Ladder(path, tuple(terms), tuple(presets))


def of_project(project: Project) -> Ladder:
    """The ladder.toml beside one of a project's shaders, looked for in the order of its passes. LadderError where there
    is none."""
    shaders = [s for p in project.passes for s in vars(p).values() if isinstance(s, Shader)]
    folders = list(dict.fromkeys(project.path(shader.path).parent for shader in shaders))
    for folder in folders:
        if (folder / FILE).is_file():
            return load(folder / FILE)
    looked = ", ".join(str(folder) for folder in folders) or "it has none"
    raise LadderError(f"there is no {FILE} beside its shaders ({looked}), to say what there is to choose", project.file)


def _term(table: _Table) -> Term:
    term = Term(
        *(table.text(key) for key in ("name", "title", "macro", "file", "function", "exact")),
        table.texts_by_name("inputs"),
        tuple(_rung(entry) for entry in table.tables("rung")),
    )
    if not (table.path.parent / term.file).is_file():
        raise table.error(f'file = "{term.file}" is not there, beside the ladder')
    values = [rung.value for rung in term.rungs]
    if term.exact not in values:
        raise table.error(f'exact = "{term.exact}" is none of its rungs{among(term.exact, values)}')
    table.done()
    return term


def _rung(table: _Table) -> Rung:
    rung = Rung(*(table.text(key) for key in ("value", "title", "source", "domain")), table.texts("suits"))
    table.done()
    return rung


def _preset(table: _Table, terms: list[Term]) -> Preset:
    preset = Preset(*(table.text(key) for key in ("name", "title", "source")), table.texts_by_name("macros"))
    there = {term.macro: [rung.value for rung in term.rungs] for term in terms}
    for macro, value in preset.macros.items():
        if macro not in there:
            raise table.error(f"macros.{macro} is the macro of no term{among(macro, there)}")
        if value not in there[macro]:
            raise table.error(f'macros.{macro} = "{value}" is no rung of it{among(value, there[macro])}')
    lacking = [macro for macro in there if macro not in preset.macros]
    if lacking:
        raise table.error(f"macros lacks {', '.join(lacking)}: a preset has a rung of every term")
    table.done()
    return preset


@dataclass(frozen=True)
class _Table:
    """A table of the file, whose values are looked at when they are taken; ``what`` it is called in messages."""

    values: dict[str, Any]
    path: Path
    what: str
    taken: set[str] = field(default_factory=set)

    def error(self, message: str) -> LadderError:
        return LadderError(f"{self.what}: {message}", self.path)

    def text(self, key: str) -> str:
        return self._take(key, "a text", lambda value: isinstance(value, str) and value.strip() != "")

    def texts(self, key: str) -> tuple[str, ...]:
        return tuple(self._take(key, "a list of texts", lambda value: isinstance(value, list) and _all_texts(value)))

    def texts_by_name(self, key: str) -> dict[str, str]:
        return self._take(key, "a table of texts", lambda value: isinstance(value, dict) and _all_texts(value.values()))

    def tables(self, key: str, required: bool = True) -> list[_Table]:
        self.taken.add(key)
        if not required and key not in self.values:
            return []
        entries = self._take(
            key,
            f"tables, each as [[...{key}]]",
            lambda value: isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value),
        )
        within = "" if self.what == "the file" else f"{self.what}, "
        return [_Table(entry, self.path, f"{within}{key} {_name(entry, n)}") for n, entry in enumerate(entries, 1)]

    def unique(self, names: list[str], what: str) -> None:
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise self.error(f'{what} = "{twice}" is there twice')

    def done(self) -> None:
        """After all that has a meaning was taken."""
        for key in self.values:
            if key not in self.taken:
                raise self.error(f"{key} means nothing here{among(key, self.taken)}")

    def _take(self, key: str, what: str, fits: Callable[[Any], bool]) -> Any:
        self.taken.add(key)
        if key not in self.values:
            raise self.error(f"{key} is missing: {what}")
        if not fits(self.values[key]):
            raise self.error(f"{key} must be {what}")
        return self.values[key]


def _all_texts(values: Iterable[Any]) -> bool:
    return all(isinstance(value, str) for value in values)


def _name(entry: dict[str, Any], number: int) -> str:
    """What a message calls an entry: as the file does, where that is a text, else by its number."""
    names = (entry.get(key) for key in ("name", "value"))
    return next((f'"{name}"' for name in names if isinstance(name, str) and name), str(number))
