"""What the fragment stage of a pass costs for a pixel, under any macros: the whole of it, as it stands in the project.

By the machine code that Mesa's AMD driver makes of it for a chip that need not be there, uniforms as a buffer and
textures as textures; where that cannot be had, by weighted SPIR-V operations, and the reason is said.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .. import native
from ..costing import isa, spirv_cost
from ..costing.cost_stage import VERSION, raised
from ..errors import NativeError
from ..interpreting import spirv
from ..language import glsl
from ..native import Stage
from ..projects.project import Pass, Project
from ..rendering import programs

_DECORATE, _LOCATION, _BINDING = 71, 30, 33
#: what harness_isa has room for
_TEXTURES = 16
_FROM_FLOAT = {"float": "{}", "int": "int(64.0 * {})", "uint": "uint(64.0 + 32.0 * {})"}


@dataclass(frozen=True)
class StageCost:
    """Of one pixel's shader. ``cycles`` are those of a wave of 64 on the chip, by its inverse throughput; where there
    is no chip, weighted SPIR-V operations, and then there are no ``instructions`` and no ``vgprs``."""

    cycles: float
    instructions: int | None = None
    vgprs: int | None = None


class Costs:
    """Counts the fragment stages of a project's passes, each text once."""

    def __init__(self, project: Project, passes: Sequence[Pass], target: str):
        """NativeError when there is no chip ``target``. Whether it can be asked is tried on the ``passes``."""
        self._project, self._target = project, target
        self._of_macros: dict[tuple, StageCost] = {}  # by file and macros
        self._of_text: dict[str, StageCost] = {}
        self.driver: str | None = None
        #: why SPIR-V operations are counted, or None when machine code is
        self.reason = isa.unavailable()
        if self.reason is None:
            try:
                self.of(passes)
            except NativeError as error:
                self.reason = error.message
                self._of_macros.clear()
                self._of_text.clear()

    @property
    def unit(self) -> str:
        """What is counted."""
        return "SPIR-V operations" if self.reason else f"{self._target} cycles"

    def of(self, passes: Sequence[Pass]) -> list[StageCost]:
        """The costs of the passes' fragment stages under the macros that they have. GlslError for what does not
        compile."""
        keys = [(p.fragment.path, tuple((m.name, m.value) for m in p.macros)) for p in passes]
        asked = {k: p for k, p in zip(keys, passes, strict=True) if k not in self._of_macros}
        sources = {k: programs.sources(self._project, p)[Stage.FRAGMENT] for k, p in asked.items()}
        new = {s.text: s for s in sources.values() if s.text not in self._of_text}
        try:
            self._of_text |= dict(zip(new, self._counted(list(new)), strict=True))
        except NativeError:
            for source in new.values():  # is it the user's text?
                glsl.check(Stage.FRAGMENT, source)
            raise
        self._of_macros |= {k: self._of_text[source.text] for k, source in sources.items()}
        return [self._of_macros[k] for k in keys]

    def _counted(self, texts: Sequence[str]) -> list[StageCost]:
        if self.reason is not None:
            return [StageCost(spirv_cost.count_stage(native.glsl_spirv(Stage.FRAGMENT, text))) for text in texts]
        if not texts:
            return []
        costs = isa.whole([_stages(text) for text in texts], self._target)
        self.driver = costs[0].driver
        return [StageCost(c.inverse_throughput, c.instructions, c.vgprs) for c in costs]


def code(project: Project, shader_pass: Pass) -> bytes:
    """What tells whether macros make a difference in a pass: the code of its stages, without what is not called."""
    found = b""
    for stage, source in programs.sources(project, shader_pass).items():
        try:
            found += native.glsl_spirv_vulkan(stage, raised(source.text)).tobytes()
        except NativeError:  # Vulkan's rules are others, and so are those of what it does not compile
            found += native.glsl_preprocess(stage, source.text).encode()
    return found


def _stages(text: str) -> tuple[np.ndarray, np.ndarray]:
    """SPIR-V of a fragment stage, and of a vertex stage that gives it values of which nothing can be told."""
    fragment = native.glsl_spirv_vulkan(Stage.FRAGMENT, raised(text))
    module, words = spirv.read(fragment), fragment.tolist()
    locations = {o[0]: o[2] for code, o in spirv.instructions(words) if code == _DECORATE and o[1] == _LOCATION}
    inputs = [(locations[v.id], v) for v in module.variables.values() if v.storage == spirv.INPUT and v.id in locations]
    return _compiled_vertex(_vertex(inputs)), _rebound(fragment, module)


@lru_cache(maxsize=8)
def _compiled_vertex(text: str) -> np.ndarray:
    return native.glsl_spirv_vulkan(Stage.VERTEX, text)


def _vertex(inputs: Sequence[tuple[int, spirv.Variable]]) -> str:
    """A vertex stage that writes these inputs of a fragment stage, by location."""
    head, body, unknown = [VERSION], ["gl_Position = vec4(0.0);"], _unknown()
    for location, variable in inputs:
        kind, name = variable.type, f"hn_out{location}"
        if kind.number is None or kind.number.kind not in _FROM_FLOAT or kind.number.width != 32:
            raise NativeError(f'the input "{variable.name}" is a {kind}, which is not counted')
        element, count = (kind.element, kind.length) if kind.kind == "array" else (kind, 1)
        if element.kind == "array":
            raise NativeError(f'the input "{variable.name}" is a {kind}, which is not counted')
        size = int(np.prod(element.shape, dtype=int))
        flat = "" if kind.number.kind == "float" else "flat "
        head.append(f"layout(location = {location}) {flat}out {element} {name}{f'[{count}]' * (kind.kind == 'array')};")
        for k in range(count):
            numbers = ", ".join(_FROM_FLOAT[kind.number.kind].format(next(unknown)) for _ in range(size))
            body.append(f"{name}{f'[{k}]' * (kind.kind == 'array')} = {element}({numbers});")
    return "\n".join([*head, "void main()", "{", *body, "}", ""])


def _unknown() -> Iterator[str]:
    k = 0
    while True:
        yield f"sin(float(gl_VertexIndex) + {k}.5)"
        k += 1


def _rebound(words: np.ndarray, module: spirv.Module) -> np.ndarray:
    """The module with the bindings that harness_isa knows: the uniforms' buffer is 0, textures come after it."""
    outside = [v for v in module.variables.values() if v.storage not in (spirv.INPUT, spirv.OUTPUT, spirv.PRIVATE)]
    textures = [v for v in outside if v.storage == spirv.UNIFORM_CONSTANT and v.type.kind == "opaque"]
    uniforms = [v for v in outside if v.storage == spirv.UNIFORM]
    if len(textures) > _TEXTURES or len(uniforms) > 1 or len(textures) + len(uniforms) < len(outside):
        raise NativeError(f"it reads more than uniforms and {_TEXTURES} textures, which is not counted")
    places = {v.id: k for k, v in enumerate([*uniforms, *textures], 0 if uniforms else 1)}
    rebound, place = words.copy(), 5
    while place < len(words):
        length, code = int(words[place]) >> 16, int(words[place]) & 0xFFFF
        if code == _DECORATE and words[place + 2] == _BINDING:
            rebound[place + 3] = places[int(words[place + 1])]
        place += length
    return rebound
