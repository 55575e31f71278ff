"""Writes the GLSL around a function: statements that read its arguments, call it, and name the numbers of its results.

Names that begin with hn_ are ours. Nothing of GLSL's own that a library may redefine is called here but before its
text, and every precision is stated, so that the same words do in GLSL and in GLSL ES.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..language.leaf import Leaf
from ..language.signature import VOID, Signature

#: name of the buffer that holds the numbers of all arguments, as bits, where each cannot have a buffer of its own
PACKED = "hn_packed"
WIDE = 4  # elements that an invocation evaluates where it pays: their numbers fill whole texels

_SAMPLERS = {"float": "samplerBuffer", "int": "isamplerBuffer", "uint": "usamplerBuffer", "bool": "usamplerBuffer"}
_VECTORS = {"float": "vec4", "int": "ivec4", "uint": "uvec4", "bool": "uvec4"}
_FROM_BITS = {"float": "uintBitsToFloat({})", "int": "int({})", "uint": "{}", "bool": "{}"}
_TO_BITS = {
    "float": "{}",
    "int": "intBitsToFloat({})",
    "uint": "uintBitsToFloat({})",
    "bool": "uintBitsToFloat(uint({}))",
}

#: declared before the library's text in mode mediump: a number as the nearest half precision has it, ties to even
HALF = "highp float hn_half(highp float hn_x) { return unpackHalf2x16(packHalf2x16(vec2(hn_x, 0.0))).x; }"


@dataclass(frozen=True)
class Inputs:
    """Where the arguments come from.

    ``leaves`` are (parameter, buffer, leaf); ``samplers`` maps opaque parameters to our uniforms of their types.
    """

    leaves: Sequence[tuple[str, str, Leaf]]
    samplers: Mapping[str, tuple[str, str]]
    packed: bool

    @property
    def packed_size(self) -> int:
        """Numbers of one element in the packed buffer: whole texels."""
        size = sum(leaf.size for *_, leaf in self.leaves)
        return size + -size % 4


def _order(leaf: Leaf) -> list[int]:
    """For each component in GLSL's order (column by column) its place in numpy's (row by row)."""
    rows, columns = leaf.type.rows, leaf.type.columns
    return [r * columns + c for c in range(columns) for r in range(rows)]


def _fetches(buffer: str, vector: str, texels: int) -> list[str]:
    """Reads the texels of one value, or of WIDE values. The batch's end and single values repeat the last one."""
    last = f"textureSize({buffer}) / {texels} - 1"
    place = f"int {buffer}_e = (hn_i < {last} ? hn_i : {last}) * {texels};"  # not min(): it may be the library's own
    return [place, *(f"highp {vector} {buffer}_t{k} = texelFetch({buffer}, {buffer}_e + {k});" for k in range(texels))]


def read(inputs: Inputs, elements: int) -> tuple[list[str], list[str]]:
    """Declarations, and the statements that fetch the numbers of element hn_i, or of ``elements`` from there on.

    With more elements than one hn_i counts groups of them.
    """
    if inputs.packed:
        return [f"uniform highp usamplerBuffer {PACKED};"], _fetches(PACKED, "uvec4", inputs.packed_size // 4)
    declarations, body = [], []
    for _, buffer, leaf in inputs.leaves:
        declarations.append(f"uniform highp {_SAMPLERS[leaf.type.base]} {buffer};")
        texels = leaf.texels if elements == 1 else leaf.size * elements // 4
        body += _fetches(buffer, _VECTORS[leaf.type.base], texels)
    return declarations, body


def _arguments(inputs: Inputs, variables: Mapping[str, str], element: int, wide: bool, half: bool) -> list[str]:
    """Statements that give the parameters' variables the fetched numbers of one of the elements."""
    body = []
    offset = 0
    for parameter, buffer, leaf in inputs.leaves:
        texel = PACKED if inputs.packed else buffer
        components = 4 if wide or inputs.packed else leaf.components
        first = offset if inputs.packed else element * leaf.size
        offset += leaf.size
        base = leaf.type.base
        parts = [f"{texel}_t{n // components}[{n % components}]" for n in (first + j for j in _order(leaf))]
        if inputs.packed:
            parts = [_FROM_BITS[base].format(part) for part in parts]
        if base == "bool":
            parts = [f"{part} != 0u" for part in parts]
        if half and base == "float" and leaf.type.precision != "highp":
            parts = [f"hn_half({part})" for part in parts]
        body.append(f"{variables[parameter]}{leaf.path} = {leaf.type}({', '.join(parts)});")
    return body


def _numbers(leaf: Leaf, value: str, half: bool) -> list[str]:
    """GLSL for the numbers of a leaf as floats, in numpy's order."""
    kind = leaf.type
    bits = "hn_half({})" if half and kind.base == "float" and kind.precision != "highp" else _TO_BITS[kind.base]
    if kind.columns > 1:
        return [bits.format(f"{value}[{c}][{r}]") for r in range(kind.rows) for c in range(kind.columns)]
    return [bits.format(f"{value}[{r}]") for r in range(kind.rows)] if kind.rows > 1 else [bits.format(value)]


def call(
    signature: Signature,
    inputs: Inputs,
    outputs: Sequence[tuple[str, Sequence[Leaf]]],
    element: int = 0,
    *,
    wide: bool = False,
    half: bool = False,
) -> tuple[list[str], list[list[str]]]:
    """Statements that call the function for one of the elements read, and for each leaf of its outputs its numbers.

    ``half`` rounds numbers to half precision on the way in and out, but for those that the library declares highp.
    """
    variables = {
        p.name: inputs.samplers[p.name][0] if p.name in inputs.samplers else f"hn_arg{element}_{n}"
        for n, p in enumerate(signature.parameters)
    }
    body = [
        f"{getattr(p.type, 'precision', '')} {p.type} {variables[p.name]};".lstrip()
        for p in signature.parameters
        if p.name not in inputs.samplers
    ]
    body += _arguments(inputs, variables, element, wide, half)
    result = f"hn_result{element}"
    called = f"{signature.name}({', '.join(variables.values())});"
    if signature.result == VOID:
        body.append(called)
    else:
        body.append(f"{getattr(signature.result, 'precision', '')} {signature.result} {result} = {called}".lstrip())
    results = [] if signature.result == VOID else [result]
    results += [variables[p.name] for p in signature.parameters if p.direction != "in"]
    return body, [
        _numbers(leaf, f"{value}{leaf.path}", half)
        for value, (_, parts) in zip(results, outputs, strict=True)
        for leaf in parts
    ]


def compute_body(reads: Sequence[str], calls: Sequence[Sequence[str]], planes: Sequence[Sequence[str]]) -> list[str]:
    """The body of a compute stage's main(), and before it the blocks that ``planes`` of numbers are written to.

    A plane's numbers are those of all elements of an invocation; they are written as whole vectors where they fill
    some.
    """
    blocks, writes = [], []
    for k, numbers in enumerate(planes):
        whole = len(calls) > 1
        step = 4 if whole else 1
        kind = "vec4" if whole else "float"
        blocks.append(f"layout(std430, binding = {k}) writeonly buffer hn_Out{k} {{ highp {kind} hn_out{k}[]; }};")
        count = len(numbers) // step
        for n in range(count):
            value = f"vec4({', '.join(numbers[4 * n : 4 * n + 4])})" if whole else numbers[n]
            writes.append(f"hn_out{k}[hn_i * {count} + {n}] = {value};")
    index = ["highp int hn_i = int(gl_GlobalInvocationID.x);", f"if (hn_i >= hn_count / {len(calls)}) return;"]
    return [
        *blocks,
        "uniform highp int hn_count;",
        "void main()",
        "{",
        *index,
        *reads,
        *(line for lines in calls for line in lines),
        *writes,
        "}",
    ]


def fragment_body(reads: Sequence[str], calls: Sequence[str], vectors: Sequence[Sequence[str]]) -> list[str]:
    """The same as a fragment stage: an output for each of ``vectors``, of at most four numbers."""
    declarations = ["uniform highp int hn_first;", "uniform highp int hn_width;"]
    writes = []
    for location, numbers in enumerate(vectors):
        declarations.append(f"layout(location = {location}) out highp vec4 hn_out{location};")
        writes.append(f"hn_out{location} = vec4({', '.join([*numbers, *['0.0'] * (4 - len(numbers))])});")
    index = "highp int hn_i = hn_first + int(gl_FragCoord.y) * hn_width + int(gl_FragCoord.x);"
    return [*declarations, "void main()", "{", index, *reads, *calls, *writes, "}"]
