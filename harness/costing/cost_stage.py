"""The stages that costs are counted on: a fragment stage around one GLSL function, and a null one of its interface.

Inputs come as varyings, so nothing is folded; every number of the outputs is written, so nothing is dropped.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .. import native
from ..calling.call import Function
from ..errors import CallError, NativeError
from ..interpreting import spirv
from ..language.glsl import Source
from ..language.leaf import Leaf, leaves
from ..language.signature import VOID, Numeric, Signature
from ..native import Stage

VERSION = "#version 450"  # the first that Vulkan takes
LOCATIONS_MAX = 32  # of varyings, which any driver takes (128 numbers)
OUTPUTS_MAX = 8

_LOAD, _ACCESS_CHAIN, _VARIABLE = 61, 65, 59
#: storage classes of what comes from outside by descriptors: UniformConstant, Uniform, StorageBuffer
_RESOURCES = {0, 2, 12}

_FROM_BITS = {"int": "floatBitsToInt({})", "uint": "floatBitsToUint({})", "bool": "({} > 0.5)", "float": "{}"}
_TO_BITS = {"int": "intBitsToFloat({})", "uint": "uintBitsToFloat({})", "bool": "float({})", "float": "{}"}


@dataclass(frozen=True)
class Stages:
    """SPIR-V of a vertex stage, of the fragment stage that calls the function, and of the one that does not."""

    vertex: np.ndarray
    fragment: np.ndarray
    null: np.ndarray


def stages(function: Function) -> Stages:
    """What is to be compiled for a function.

    CallError when it has overloads, reads uniforms, yields nothing, or is not of the mode "as-written".
    """
    if len(function.signatures) > 1:
        listed = "".join(f"\n    {s}" for s in function.signatures)
        raise CallError(f"{function.__name__} is overloaded, so its cost is not one:{listed}", _source(function).path)
    (signature,) = function.signatures
    if function.mode != "as-written":
        raise CallError(f"costs are those of the source as written, not of mode {function.mode!r}", *signature.origin)
    try:
        interface = _Interface(signature)
    except CallError as error:
        raise CallError(f"{error.message}; it is {signature}", *signature.origin) from None
    try:
        fragment = native.glsl_spirv_vulkan(Stage.FRAGMENT, raised(_source(function).text) + interface.call())
    except NativeError as error:
        raise _source(function).error(str(error)) from None
    if _reads_resources(fragment):
        message = f"{signature} reads uniforms or textures, and only what reads none can be counted"
        raise CallError(message, *signature.origin)
    return Stages(
        native.glsl_spirv_vulkan(Stage.VERTEX, interface.vertex()),
        fragment,
        native.glsl_spirv_vulkan(Stage.FRAGMENT, interface.null()),
    )


def _source(function: Function) -> Source:
    """The text that a function stands in, as the compiler gets it."""
    return function._library.source


def _reads_resources(words: np.ndarray) -> bool:
    """Whether a module reads uniforms, textures or buffers."""
    resources = set()
    for code, operands in spirv.instructions(words.tolist()):
        if code == _VARIABLE and operands[2] in _RESOURCES:
            resources.add(operands[1])
        elif code in (_LOAD, _ACCESS_CHAIN) and operands[2] in resources:
            return True
    return False


def raised(text: str) -> str:
    """The text with a #version that Vulkan takes."""
    return VERSION + "\n" + text.partition("\n")[2].rstrip("\n") + "\n"


class _Interface:
    """Inputs and outputs of the stages of one function.

    The null stage uses all inputs. Where the function does not, the inputs' own cost is taken from it all the same:
    compare functions of one interface that use the same inputs.
    """

    def __init__(self, signature: Signature):
        self._signature = signature
        self._arguments = [f"hn_arg{k}" for k in range(len(signature.parameters))]
        inputs = [
            (f"{argument}{leaf.path}", leaf)
            for argument, p in zip(self._arguments, signature.parameters, strict=True)
            if p.direction != "out"
            for leaf in leaves(p.type)
        ]
        #: (GLSL that is assigned to, its leaf, names of its varyings): a matrix has one a column
        self._inputs = []
        self._varyings: list[tuple[str, int]] = []
        for target, leaf in inputs:
            names = [f"hn_in{len(self._varyings) + column}" for column in range(leaf.type.columns)]
            self._inputs.append((target, leaf, names))
            self._varyings += [(name, leaf.type.rows) for name in names]
        results = [("hn_result", signature.result)] if signature.result != VOID else []
        results += [
            (argument, p.type)
            for argument, p in zip(self._arguments, signature.parameters, strict=True)
            if p.direction != "in"
        ]
        numbers = [number for name, kind in results for leaf in leaves(kind) for number in _numbers(leaf, name)]
        self._outputs = [numbers[k : k + 4] for k in range(0, len(numbers), 4)]
        if not numbers:
            raise CallError("yields nothing, so nothing of it would be left")
        if len(self._outputs) > OUTPUTS_MAX or len(self._varyings) > LOCATIONS_MAX:
            raise CallError("takes or yields more numbers than a fragment stage can")

    def _declarations(self, direction: str) -> Iterator[str]:
        for location, (name, size) in enumerate(self._varyings):
            yield f"layout(location = {location}) {direction} {Numeric('float', size)} {name};"

    def vertex(self) -> str:
        """Writes varyings of which the compiler can tell nothing, least of all that two are the same."""
        unknown = (f"sin(float(gl_VertexIndex) + {k}.5)" for k in range(4 * LOCATIONS_MAX))
        body = [
            f"{name} = {Numeric('float', size)}({', '.join(next(unknown) for _ in range(size))});"
            for name, size in self._varyings
        ]
        return _text([VERSION, *self._declarations("out")], ["gl_Position = vec4(0.0);", *body])

    def call(self) -> str:
        """What is put after the source: a main() that calls the function once."""
        parameters = self._signature.parameters
        body = [f"{p.type} {a};" for a, p in zip(self._arguments, parameters, strict=True)]
        for target, leaf, names in self._inputs:
            parts = [
                _FROM_BITS[leaf.type.base].format(_component(name, leaf.type.rows, row))
                for name in names
                for row in range(leaf.type.rows)
            ]
            body.append(f"{target} = {leaf.type}({', '.join(parts)});")
        call = f"{self._signature.name}({', '.join(self._arguments)});"
        body.append(call if self._signature.result == VOID else f"{self._signature.result} hn_result = {call}")
        return self._fragment([], self._outputs, body)

    def null(self) -> str:
        """Uses every number once, by multiply-adds: the least that an interface can be made to cost.

        Output number j is the fold of number j of each input, of a shorter one j modulo its length; what an input has
        beyond the outputs' count goes round.
        """
        count = sum(map(len, self._outputs))
        folded = []
        for j in range(count):
            operands = []
            for _, leaf, names in self._inputs:
                own = [_component(name, leaf.type.rows, row) for name in names for row in range(leaf.type.rows)]
                operands += own[j::count] or [own[j % len(own)]]
            folded.append(_fold(operands))
        return self._fragment([VERSION], [folded[k : k + 4] for k in range(0, count, 4)], [])

    def _fragment(self, head: list[str], outputs: list[list[str]], body: list[str]) -> str:
        declarations = [*head, *self._declarations("in")]
        written = []
        for location, numbers in enumerate(outputs):
            declarations.append(f"layout(location = {location}) out vec4 hn_out{location};")
            written.append(f"hn_out{location} = vec4({', '.join(numbers + ['1.0'] * (4 - len(numbers)))});")
        return _text(declarations, [*body, *written])


def _component(name: str, rows: int, row: int) -> str:
    return f"{name}[{row}]" if rows > 1 else name


def _numbers(leaf: Leaf, value: str) -> list[str]:
    """GLSL for the numbers of a leaf as floats, column by column."""
    value += leaf.path
    columns = [f"{value}[{c}]" for c in range(leaf.type.columns)] if leaf.type.columns > 1 else [value]
    parts = (_component(column, leaf.type.rows, row) for column in columns for row in range(leaf.type.rows))
    return [_TO_BITS[leaf.type.base].format(part) for part in parts]


def _fold(operands: list[str]) -> str:
    """a b + c, then that times d plus e, and so on."""
    folded, *rest = operands or ["0.0"]
    while len(rest) > 1:
        folded, rest = f"fma({folded}, {rest[0]}, {rest[1]})", rest[2:]
    return f"({folded} + {rest[0]})" if rest else folded


def _text(declarations: list[str], body: list[str]) -> str:
    return "\n".join([*declarations, "void main()", "{", *body, "}", ""])
