"""The test shader: one of our own around a single GLSL function, fed from arrays and read back into arrays.

It is a compute stage where there is one, and a fragment stage elsewhere; both give the same bits.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import native, rewrite
from .errors import CallError, GlslError, NativeError
from .glsl import Source
from .native import gl_enums
from .signature import DTYPES, VOID, Array, Numeric, Opaque, Signature, Struct, Type

OUTPUT_FLOATS = 4  # a fragment output is a vec4
OUTPUTS_MAX = 8  # the most that GL 3.3 promises

#: name of the mode -> what it does to the source
MODES = {
    "as-written": "the source as it stands: the driver may rewrite its arithmetic",
    "precise": "every operation as written, in the order written",
    "double": "every operation as written, in float64, by our interpreter instead of the driver",
}
VERSION = 330  # the first that the test fragment can be written in
PRECISE_VERSION = 400  # the first with `precise`
COMPUTE_VERSION = 430  # the first with compute stages

_FIRST = "[0]"
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
    last = f"textureSize({buffer}) / {leaf.texels} - 1"
    texel = f"(hn_i < {last} ? hn_i : {last}) * {leaf.texels}"  # not min(): a shader may have one of its own
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


def _at_least(version: int, text: str) -> str:
    """The text, its #version raised where it is lower."""
    stated, _, rest = text.partition("\n")
    words = stated.split()
    if int(words[1]) < version:
        words[1] = str(version)
    return f"{' '.join(words)}\n{rest}"


def _finished(source: Source, rest: list[str], mode: str, version: int) -> str:
    """The source with what is put after it, in a mode, for a version of GLSL at least."""
    text = "\n".join([source.text.rstrip("\n"), *rest, ""])
    return _at_least(version, rewrite.make_precise(text) if mode == "precise" else text)


class Evaluation:
    """One GLSL function, compiled in one mode: ``run`` takes flat arrays and gives flat arrays."""

    def __init__(self, source: Source, signature: Signature, mode: str):
        stated = source.text.partition("\n")[0].split()  # "#version", number, profile
        if int(stated[1]) < VERSION or "es" in stated:
            raise GlslError(f"{' '.join(stated)}: functions can be called from {VERSION} on", *source.origin(1))
        self.signature = signature
        try:
            self.inputs = [
                (p.name, [(f"hn_in{n}_{k}", leaf) for k, leaf in enumerate(leaves(p.type))])
                for n, p in enumerate(signature.inputs)
            ]
            self.outputs = [(name, list(leaves(kind))) for name, kind in signature.outputs]
        except CallError as error:
            raise CallError(f"{error.message}; it is {signature}", *signature.origin) from None
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
        try:
            native.open_context()
            self._program = self._compute_program(source, mode) or self._fragment_program(source, mode)
        except NativeError as error:
            stage, _, log = str(error).partition(": ")
            raise source.error(log if stage in ("vertex", "fragment") else str(error)) from None
        #: those that the function reads; of an array the first element stands for all
        self.uniforms = {
            n.removesuffix(_FIRST): u for n, u in self._program.uniforms.items() if not n.startswith("hn_")
        }

    def _fragment_program(self, source: Source, mode: str) -> native.Program:
        declarations, body, numbers = self._call()
        declarations += ["uniform int hn_first;", "uniform int hn_width;"]
        index = "int hn_i = hn_first + int(gl_FragCoord.y) * hn_width + int(gl_FragCoord.x);"
        for location, (values, width) in enumerate(zip(numbers, self._widths, strict=True)):
            declarations.append(f"layout(location = {location}) out vec4 hn_out{location};")
            body.append(f"hn_out{location} = vec4({', '.join(values + ['0.0'] * (OUTPUT_FLOATS - width))});")
        main = ["void main()", "{", index, *body, "}"]
        version = PRECISE_VERSION if mode == "precise" else VERSION
        text = _finished(source, [*declarations, *main], mode, version)
        return native.Program(native.evaluate_vertex(), text)

    def _compute_program(self, source: Source, mode: str) -> native.Program | None:
        """The same in a compute stage; None where there is none, or the function needs what only a fragment has."""
        if not native.compute_available():
            return None
        declarations, body, numbers = self._call()
        declarations.append("uniform int hn_count;")
        for k, (values, width) in enumerate(zip(numbers, self._widths, strict=True)):
            declarations.append(f"layout(std430, binding = {k}) writeonly buffer hn_Out{k} {{ float hn_out{k}[]; }};")
            body += [f"hn_out{k}[hn_i * {width} + {c}] = {value};" for c, value in enumerate(values)]
        index = ["int hn_i = int(gl_GlobalInvocationID.x);", "if (hn_i >= hn_count) return;"]
        main = [native.compute_head(), "void main()", "{", *index, *body, "}"]
        try:
            return native.Program.compute(_finished(source, [*declarations, *main], mode, COMPUTE_VERSION))
        except NativeError:
            return None

    def _call(self) -> tuple[list[str], list[str], list[list[str]]]:
        """GLSL that reads the arguments of element hn_i and calls the function once.

        Declarations, statements, and for each output vector the numbers that go into it.
        """
        parameters = [(f"hn_arg{n}", p) for n, p in enumerate(self.signature.parameters)]
        variables = {p.name: variable for variable, p in parameters}
        declarations = []
        body = [f"{p.type} {variable};" for variable, p in parameters]
        for name, buffers in self.inputs:
            declarations += [f"uniform {_SAMPLERS[leaf.type.base]} {buffer};" for buffer, leaf in buffers]
            body += [_fetch(leaf, buffer, f"{variables[name]}{leaf.path}") for buffer, leaf in buffers]
        call = f"{self.signature.name}({', '.join(variables.values())});"
        body += [call if self.signature.result == VOID else f"{self.signature.result} hn_result = {call}"]
        results = [] if self.signature.result == VOID else ["hn_result"]
        results += [variable for variable, p in parameters if p.direction != "in"]
        vectors = []
        for result, (_, parts) in zip(results, self.outputs, strict=True):
            for leaf in parts:
                numbers = _numbers(leaf, f"{result}{leaf.path}")
                vectors += [numbers[k : k + OUTPUT_FLOATS] for k in range(0, len(numbers), OUTPUT_FLOATS)]
        return declarations, body, vectors

    def array_length(self, name: str) -> int | None:
        """How many elements of a uniform the function reads; None where it is no array."""
        return self.uniforms[name].size if name not in self._program.uniforms else None

    def set_uniform(self, name: str, value: np.ndarray) -> None:
        """Sets a numeric uniform that the function reads; ``value`` in numpy's order, an array's elements first."""
        kind = self.uniforms[name].type
        name = name if name in self._program.uniforms else name + _FIRST
        if gl_enums.GLSL_TYPE_NAMES[kind].startswith("mat"):
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
        if native.compute_available():
            step = min(step, native.compute_limit(max(self._widths)))
        step = step // 4 * 4 or step  # every part of an array aligned like the first, so that none is copied
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
