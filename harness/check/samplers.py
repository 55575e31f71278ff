"""Checks which texture SHADERed gives to which sampler: by its search of the text, against what was meant."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from ..native import Stage
from . import declarations, flow, renderer, roles
from .declarations import Declared
from .state import Bound, PassState, State

_CUBE = re.compile(r"samplerCube")


@dataclass(frozen=True)
class Found:
    """What SHADERed's search takes for a sampler's declaration, in line ``line`` of the text."""

    name: str
    line: int


@lru_cache(maxsize=64)
def search(text: str) -> tuple[Found, ...]:
    """SHADERed's search, with lines: it never goes beyond one."""
    return tuple(
        Found(name, number)
        for number, line in enumerate(text.split("\n"), 1)
        if "sampler" in line
        for name in renderer.declared_samplers(line)
    )


def declared(text: str) -> dict[str, Declared]:
    """The samplers that a preprocessed text declares."""
    return {n: d for n, d in declarations.uniforms(text).items() if "sampler" in d.type}


def given(shader_pass: PassState) -> list[tuple[Bound, str]]:
    """Each bound object with the name of the sampler that SHADERed gives it to. None at all where text that declares
    nothing takes a texture or a declaration is overlooked: others are at the wrong one then, and that is said already.
    """
    if shader_pass.program is None or Stage.FRAGMENT not in shader_pass.sources:
        return []
    found = search(shader_pass.sources[Stage.FRAGMENT].text)
    real = declared(shader_pass.preprocessed[Stage.FRAGMENT])
    pairs = list(zip(shader_pass.bound, found, strict=False))
    if any(_is_none(place, real) for _, place in pairs) or _overlooked(found, real):
        return []
    return [(bound, place.name) for bound, place in pairs if place.name in real]


def wanted_role(shader_pass: PassState, sampler: str) -> str | None:
    """What a sampler is for, by its name or by its use."""
    return roles.of_name(sampler) or flow.role(shader_pass.preprocessed[Stage.FRAGMENT], sampler)


def check(state: State) -> None:
    """Checks the samplers of all passes that compile."""
    for shader_pass in state.passes:
        if shader_pass.program is not None and Stage.FRAGMENT in shader_pass.sources:
            _check_pass(state, shader_pass)


def _check_pass(state: State, shader_pass: PassState) -> None:
    source, bound = shader_pass.sources[Stage.FRAGMENT], shader_pass.bound
    real = declared(shader_pass.preprocessed[Stage.FRAGMENT])
    found = search(source.text)
    names = [f.name for f in found]
    listed = ", ".join(names) or "none"
    for k, place in enumerate(found[: len(bound)]):
        if _is_none(place, real):
            state.add(
                "HS301",
                source.origin(place.line),
                f'"{source.text.split(chr(10))[place.line - 1].strip()}" takes "{bound[k].name}" of pass '
                f'"{shader_pass.name}", but declares no sampler there',
                "remove the text, or write it so that no ; follows the word sampler in its line",
            )
    for k in range(len(found), 0 if _overlooked(found, real) else len(bound)):
        state.add(
            "HS303",
            bound[k].bind,
            f'"{bound[k].name}" goes to no sampler of pass "{shader_pass.name}": the declarations are, in '
            f"order: {listed}",
            "declare a sampler for it, or remove the bind",
        )
    _check_active(state, shader_pass, real, found)
    _check_roles(state, shader_pass)


def _is_none(place: Found, real: dict[str, Declared]) -> bool:
    """Whether what the search found declares no sampler, not even one whose name it misread."""
    return place.name not in real and all(d.line != place.line for d in real.values())


def _overlooked(found: tuple[Found, ...], real: dict[str, Declared]) -> bool:
    """Whether the search finds nothing where a sampler is declared."""
    return not {d.line for d in real.values()} <= {f.line for f in found}


def _check_active(state: State, shader_pass: PassState, real: dict[str, Declared], found: tuple[Found, ...]) -> None:
    source, bound = shader_pass.sources[Stage.FRAGMENT], shader_pass.bound
    names = [f.name for f in found]
    vertex: dict[str, tuple[Stage, Declared]] = {}
    for stage, text in shader_pass.preprocessed.items():
        vertex |= {n: (stage, d) for n, d in declared(text).items()}
    active = {re.match(r"\w+", n)[0] for n in shader_pass.program.uniforms}
    for name in sorted(active & set(vertex)):
        if name not in real:
            stage, there = vertex[name]
            state.add(
                "HS305",
                shader_pass.sources[stage].origin(there.line),
                f'the sampler "{name}" of pass "{shader_pass.name}" stands in the {stage.name.lower()} shader alone: '
                "it reads unit 0",
                "declare it in the pixel shader too",
            )
            continue
        at = source.origin(real[name].line)
        k = names.index(name) if name in names else None
        if k is None:
            text = source.text.split("\n")[real[name].line - 1].strip()
            state.add(
                "HS304",
                at,
                f'SHADERed\'s search does not find the sampler "{name}" of pass "{shader_pass.name}" in "{text}"',
                f"write uniform {real[name].type} {name}; in a line of its own, with single spaces",
            )
        elif k >= len(bound):
            there = ", ".join(b.name for b in bound) or "none"
            state.add(
                "HS302",
                at,
                f'the sampler "{name}" of pass "{shader_pass.name}" is declaration {k + 1}, but {len(bound)} '
                "textures are "
                f"bound ({there})",
                f'bind a texture to pass "{shader_pass.name}" in a slot after the others',
            )
        elif bool(_CUBE.search(real[name].type)) != (bound[k].element.attributes.get("cube", "")[:1] in tuple("1tTyY")):
            kind = "a cube map" if _CUBE.search(real[name].type) else "no cube map"
            state.add(
                "HS308",
                bound[k].bind,
                f'"{bound[k].name}" goes to the {real[name].type} "{name}" of pass "{shader_pass.name}", which '
                f"wants {kind}",
                "put the textures into the order of the declarations",
            )


def _check_roles(state: State, shader_pass: PassState) -> None:
    """Roles by the file's name and by the sampler's use that contradict each other."""
    for bound, name in given(shader_pass):
        role = roles.of_file(bound.path) if bound.path else None
        wanted = wanted_role(shader_pass, name)
        if role is not None and wanted is not None and wanted != role:
            state.add(
                "HS306",
                bound.bind,
                f'"{bound.path}", a {role} map by its name, goes to the sampler "{name}" of pass "{shader_pass.name}", '
                f"which is for {wanted}",
                "give the slots the order of the declarations",
            )
