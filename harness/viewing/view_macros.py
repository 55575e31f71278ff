"""The macros of a project that a viewer can change: features on or off, and the rungs of ladders.

Both are found in the shaders' own text. A ladder is a macro with a default among numbered choices:

    #define V_EXACT 0
    #define V_HAMMON 1
    #ifndef BRDF_V
    #define BRDF_V V_EXACT
    #endif

A feature is a macro HAS_... that a pass of the project defines as 0 or 1.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..errors import GlslError
from ..language import glsl
from ..projects.project import VARIABLE_TYPES, ComputePass, Macro, Object, Pass, Project, Sampled, Shader, Variable

_DEFAULT = re.compile(r"^#ifndef +(?P<name>\w+)[^\n]*\n#define +(?P=name) +(?P<value>\w+)[^\n]*\n#endif", re.MULTILINE)
_CHOICE = re.compile(r"^#define +(\w+) +\d+ *(?://[^\n]*)?$", re.MULTILINE)
_MAP = re.compile(r"HAS_(\w+)_MAP")


@dataclass(frozen=True)
class Ladder:
    """A macro and what it can be; ``default`` is what it is where no pass says anything, the reference."""

    name: str
    choices: tuple[str, ...]
    default: str


@dataclass(frozen=True)
class Macros:
    """What there is to change in a project."""

    features: tuple[str, ...]
    ladders: tuple[Ladder, ...]


@dataclass(frozen=True)
class Changes:
    """What was changed: the features that are the other way round, and the rungs, by macro."""

    flipped: frozenset[str] = frozenset()
    rungs: Mapping[str, str] = field(default_factory=dict)

    def flip(self, feature: str) -> Changes:
        """With the feature the other way round."""
        return replace(self, flipped=self.flipped ^ {feature})

    def step(self, ladder: Ladder, now: str | None) -> Changes:
        """With the next rung of the ladder; after the last the first. ``now`` is the project's own, or None where its
        passes differ: then that comes before the first."""
        order: list[str | None] = [*ladder.choices] if now in ladder.choices else [None, *ladder.choices]
        own = now if now in ladder.choices else None
        following = order[(order.index(self.rungs.get(ladder.name, own)) + 1) % len(order)]
        rungs = {name: rung for name, rung in self.rungs.items() if name != ladder.name}
        return replace(self, rungs=rungs if following == own else rungs | {ladder.name: following})

    def __str__(self) -> str:
        return ", ".join(
            [*(f"{n}={r}" for n, r in self.rungs.items()), *(f"{n} flipped" for n in sorted(self.flipped))]
        )


def find(project: Project) -> Macros:
    """What there is to change, in the order of the shaders' text."""
    features: dict[str, None] = {}
    ladders: dict[str, Ladder] = {}
    defined = {macro.name for p in project.passes for macro in p.macros}
    for text in {_text(project, p): None for p in project.passes}:
        end = 0
        for match in _DEFAULT.finditer(text):
            choices = tuple(_CHOICE.findall(text[end : match.start()]))
            end = match.end()
            if match["name"].startswith("HAS_") and match["name"] in defined:
                features[match["name"]] = None
            elif match["value"] in choices:
                first = choices.index(match["value"])
                # Of the numbered macros above it the choices are those of one run, which begins with 0.
                ladders.setdefault(match["name"], Ladder(match["name"], _run(text, choices, first), match["value"]))
    features |= dict.fromkeys(n for p in project.passes for n in (m.name for m in p.macros) if n.startswith("HAS_"))
    return Macros(tuple(features), tuple(ladders.values()))


def _run(text: str, choices: tuple[str, ...], inside: int) -> tuple[str, ...]:
    numbers = [int(re.search(rf"^#define +{name} +(\d+)", text, re.MULTILINE)[1]) for name in choices]
    start = max(k for k in range(inside + 1) if k == 0 or numbers[k] == 0)
    end = next((k for k in range(inside + 1, len(choices)) if numbers[k] == 0), len(choices))
    return choices[start:end]


def own_rung(project: Project, ladder: Ladder) -> str | None:
    """What the project itself says, where all passes that know the ladder agree."""
    said = {
        next((m.value for m in p.macros if m.name == ladder.name), ladder.default)
        for p in project.passes
        if re.search(rf"\b{ladder.name}\b", _text(project, p))
    }
    return said.pop() if len(said) == 1 else None


def reference(changes: Changes, macros: Macros) -> Changes:
    """The same with every ladder on its default."""
    return replace(changes, rungs={ladder.name: ladder.default for ladder in macros.ladders})


def changed(project: Project, changes: Changes) -> Project:
    """The project with the changes.

    A pass whose HAS_..._MAP is taken away is no longer given that texture, by the place among its maps, so that the
    others keep theirs; and the uniform of that name, which the shader then has, is a half where the pass does not say.
    """
    unbound: set[tuple[str, str]] = set()
    passes = []
    for shader_pass in project.passes:
        text = _text(project, shader_pass)
        values = {m.name: m for m in shader_pass.macros}
        new = dict(values)
        for name, rung in changes.rungs.items():
            if re.search(rf"\b{name}\b", text):
                new[name] = Macro(name, rung, values[name].line if name in values else shader_pass.line)
        taken = []
        for name in changes.flipped & set(values):
            is_on = values[name].value.strip() != "0"
            new[name] = replace(values[name], value="0" if is_on else "1")
            if is_on and _MAP.fullmatch(name):
                taken.append(name)
        unbound |= {(o.name, shader_pass.name) for o in _textures_of(project, shader_pass, taken, text)}
        variables = shader_pass.variables + _halves(shader_pass, taken, text)
        passes.append(replace(shader_pass, macros=tuple(new.values()), variables=variables))
    textures = tuple(_without(t, unbound) for t in project.textures)
    return replace(project, passes=tuple(passes), textures=textures)


def _without(texture: Sampled, unbound: set[tuple[str, str]]) -> Sampled:
    return replace(texture, binds=tuple(b for b in texture.binds if (texture.name, b.pass_name) not in unbound))


def _textures_of(project: Project, shader_pass: Pass | ComputePass, taken: list[str], text: str) -> list[Object]:
    """The textures of these maps, where the pass has as many textures as maps."""
    on = {m.name for m in shader_pass.macros if _MAP.fullmatch(m.name) and m.value.strip() != "0"}
    maps = sorted(on, key=lambda name: text.find(f"#ifndef {name}"))
    bound = project.bound(shader_pass.name)
    return [o for name, o in zip(maps, bound, strict=True) if name in taken] if len(maps) == len(bound) else []


def _halves(shader_pass: Pass | ComputePass, taken: list[str], text: str) -> tuple[Variable, ...]:
    types = {t.glsl: t for t in VARIABLE_TYPES.values() if t.base == "float" and t.rows == 1}
    found = []
    for name in (_MAP.fullmatch(n)[1].lower() for n in taken):
        declared = re.search(rf"^ *uniform +(\w+) +{name} *;", text, re.MULTILINE)
        if declared and declared[1] in types and all(v.name != name for v in shader_pass.variables):
            kind = types[declared[1]]
            found.append(Variable(name, kind, (0.5,) * kind.size, system=None, invert=False, line=shader_pass.line))
    return tuple(found)


def _text(project: Project, shader_pass: Pass | ComputePass) -> str:
    """All the shaders of a pass with their includes; what cannot be read is left out."""
    found = []
    for shader in vars(shader_pass).values():
        if isinstance(shader, Shader):
            try:
                path = project.path(shader.path)
                found.append(glsl.load(path, include_dirs=project.include_dirs, version=glsl.VERSION).text)
            except GlslError:
                continue
    return "".join(found)
