"""The test fragment: a shader of our own around one GLSL function, fed from arrays and read back into arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import native, rewrite
from .errors import CallError, NativeError
from .glsl import Source
from .native import gl_enums
from .signature import DTYPES, VOID, Array, Numeric, Opaque, Signature, Struct, Type

OUTPUT_FLOATS = 4  # a fragment output is a vec4
OUTPUTS_MAX = 8  # the most that GL 3.3 promises

#: name of the mode -> what it does to the source
MODES = {
    "as-written": "the source as it stands: the driver may rewrite its arithmetic",
    "precise": "every operation as written, in the order written",
}
PRECISE_VERSION = "#version 400"  # the first with `precise`

_SAMPLERS = {
    "float": "samplerBuffer",
    "int": "isamplerBuffer",
    "uint": "usamplerBuffer",
    "bool": "usamplerBuffer",
}
_TO_BITS = {"int": "intBitsToFloat({})", "uint": "uintBitsToFloat({})", "bool": "uintBitsToFloat(uint({}))"}


@dataclass(frozen=True)
class Leaf:
    """A numeric part of a value: ``path`` leads to it in GLSL (``.albedo``, ``[2]``), ``keys`` in Python."""

    path: str
    keys: tuple[str | int, ...]
    type: Numeric

    @cached_property
    def size(self) -> int:
        """How many numbers it has."""
        return self.type.rows * self.type.columns

    @cached_property
    def components(self) -> int:
        """Numbers per texel of its buffer: as many as divide it evenly, for each fetch costs."""
        return next(n for n in (4, 3, 2, 1) if self.size % n == 0)

    @cached_property
    def texels(self) -> int:
        """Texels per value."""
        return self.size // self.components

    @cached_property
    def dtype(self) -> np.dtype:
        """numpy's type of the 4-byte numbers that go through GL."""
        return np.dtype(np.uint32 if self.type.base == "bool" else DTYPES[self.type.base])


def leaves(kind: Type, path: str = "", keys: tuple[str | int, ...] = ()) -> Iterator[Leaf]:
    """The numeric parts of a type. CallError for what is no data."""
    if isinstance(kind, Struct):
        for name, member in kind.members:
            yield from leaves(member, f"{path}.{name}", (*keys, name))
    elif isinstance(kind, Array):
        for k in range(kind.length):
            yield from leaves(kind.element, f"{path}[{k}]", (*keys, k))
    elif isinstance(kind, Opaque) or kind.base not in DTYPES:
        raise CallError(f"values of type {kind} cannot be passed as arrays")
    else:
        yield Leaf(path, keys, kind)


def _order(kind: Numeric) -> list[int]:
    """For each component in GLSL's order (column by column) its place in numpy's (row by row)."""
    return np.arange(kind.rows * kind.columns).reshape(kind.rows, kind.columns).T.ravel().tolist()


def _fetch(leaf: Leaf, buffer: str, target: str) -> str:
    """GLSL that reads one value of a leaf from its buffer. The batch's end and single values repeat the last one."""
    vector = {"float": "vec4", "int": "ivec4"}.get(leaf.type.base, "uvec4")
    texel = f"min(hn_i, textureSize({buffer}) / {leaf.texels} - 1) * {leaf.texels}"
    fetched = [f"{vector} t{k} = texelFetch({buffer}, e + {k});" for k in range(leaf.texels)]
    parts = [f"t{j // leaf.components}[{j % leaf.components}]" for j in _order(leaf.type)]
    if leaf.type.base == "bool":
        parts = [f"{part} != 0u" for part in parts]
    return f"{{ int e = {texel}; {' '.join(fetched)} {target} = {leaf.type}({', '.join(parts)}); }}"


def _numbers(leaf: Leaf, value: str) -> list[str]:
    """GLSL for the numbers of a leaf as floats, in numpy's order."""
    kind = leaf.type
    bits = _TO_BITS.get(kind.base, "{}")
    if kind.columns > 1:
        return [bits.format(f"{value}[{c}][{r}]") for r in range(kind.rows) for c in range(kind.columns)]
    return [bits.format(f"{value}[{r}]") for r in range(kind.rows)] if kind.rows > 1 else [bits.format(value)]


class Evaluation:
    """One GLSL function, compiled in one mode: ``run`` takes flat arrays and gives flat arrays."""

    def __init__(self, source: Source, signature: Signature, mode: str):
        self.signature = signature
        self.inputs = [
            (p.name, [(f"hn_in_{p.name}_{k}", leaf) for k, leaf in enumerate(leaves(p.type))]) for p in signature.inputs
        ]
        self.outputs = [(name, list(leaves(kind))) for name, kind in signature.outputs]
        widths = [
            min(OUTPUT_FLOATS, leaf.size - start)
            for _, parts in self.outputs
            for leaf in parts
            for start in range(0, leaf.size, OUTPUT_FLOATS)
        ]
        if not widths:
            raise CallError(f"{signature} yields nothing", *signature.origin)
        if len(widths) > OUTPUTS_MAX:
            raise CallError(f"{signature} yields more than {OUTPUTS_MAX} vectors at once", *signature.origin)
        self._widths = widths
        text = source.text.rstrip("\n") + "\n" + self._main()
        if mode == "precise":
            version, _, rest = rewrite.make_precise(text).partition("\n")
            version = PRECISE_VERSION if version.split()[1] < "400" else version
            text = f"{version}\n{rest}"
        try:
            native.open_context()
            self._program = native.Program(native.evaluate_vertex(), text)
        except NativeError as error:
            stage, _, log = str(error).partition(": ")
            raise source.error(log if stage in ("vertex", "fragment") else str(error)) from None
        self.uniforms = {n: u for n, u in self._program.uniforms.items() if not n.startswith("hn_")}

    def _main(self) -> str:
        """The rest of the shader: buffers, outputs, and a main() that calls the function once."""
        declarations = ["uniform int hn_first;", "uniform int hn_width;"]
        body = ["int hn_i = hn_first + int(gl_FragCoord.y) * hn_width + int(gl_FragCoord.x);"]
        for name, buffers in self.inputs:
            declarations += [f"uniform {_SAMPLERS[leaf.type.base]} {buffer};" for buffer, leaf in buffers]
            body += [_fetch(leaf, buffer, f"hn_{name}{leaf.path}") for buffer, leaf in buffers]
        variables = [f"{p.type} hn_{p.name};" for p in self.signature.parameters]
        call = f"{self.signature.name}({', '.join('hn_' + p.name for p in self.signature.parameters)});"
        body += [call if self.signature.result == VOID else f"{self.signature.result} hn_result = {call}"]

        location = 0
        for name, parts in self.outputs:
            for leaf in parts:
                numbers = _numbers(leaf, f"hn_{name}{leaf.path}")
                for start in range(0, len(numbers), OUTPUT_FLOATS):
                    four = (numbers[start : start + OUTPUT_FLOATS] + ["0.0"] * 3)[:OUTPUT_FLOATS]
                    declarations.append(f"layout(location = {location}) out vec4 hn_out_{location};")
                    body.append(f"hn_out_{location} = vec4({', '.join(four)});")
                    location += 1
        return "\n".join([*declarations, "void main()", "{", *variables, *body, "}", ""])

    def set_uniform(self, name: str, value: np.ndarray) -> None:
        """Sets a numeric uniform that the function reads; ``value`` in numpy's order."""
        kind = self.uniforms[name].type
        if kind in (gl_enums.GL_FLOAT_MAT2, gl_enums.GL_FLOAT_MAT3, gl_enums.GL_FLOAT_MAT4):
            value = value.swapaxes(-1, -2)
        self._program.set_uniform(name, kind, value)

    def run(self, arrays: dict[str, np.ndarray], count: int) -> list[list[np.ndarray]]:
        """Evaluates the function ``count`` times.

        ``arrays`` maps each buffer's name to (count, size) or (1, size) numbers of the leaf's dtype, C-contiguous.
        Returns for each output its leaves, as arrays (count, size).
        """
        given = [(buffer, leaf) for _, buffers in self.inputs for buffer, leaf in buffers]
        planes = [np.empty((count, width), np.float32) for width in self._widths]
        step = native.evaluate_limit() // max([1, *(leaf.texels for _, leaf in given)])
        for first in range(0, count, step):
            n = min(step, count - first)
            texels = {
                buffer: (a if len(a) == 1 else a[first : first + n]).reshape(-1, leaf.components)
                for buffer, leaf in given
                for a in (arrays[buffer],)
            }
            self._program.evaluate(texels, [plane[first : first + n] for plane in planes], n)
        return self._assembled(planes)

    def _assembled(self, planes: list[np.ndarray]) -> list[list[np.ndarray]]:
        rest = iter(planes)
        outputs = []
        for _, parts in self.outputs:
            values = []
            for leaf in parts:
                pieces = [next(rest) for _ in range(0, leaf.size, OUTPUT_FLOATS)]
                value = pieces[0] if len(pieces) == 1 else np.concatenate(pieces, axis=1)
                values.append(value.view(leaf.dtype) if leaf.type.base != "float" else value)
            outputs.append(values)
        return outputs
