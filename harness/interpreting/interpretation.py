"""The interpreter as an engine of calls: one GLSL function, evaluated by us in strict IEEE arithmetic, by no driver.

It has the face of ``evaluation.Evaluation``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import cached_property, lru_cache

import numpy as np

from .. import native
from ..calling.evaluation import Evaluation
from ..errors import CallError, NativeError
from ..language import literals, rewrite, signature
from ..language.glsl import Source
from ..language.leaf import Leaf, leaves
from ..language.signature import DTYPES, VOID, Array, Opaque, Parameter, Signature, Struct
from ..native import Stage, gl_enums
from . import interpreter_uniforms, spirv
from .interpreter import Program, Run
from .interpreter_memory import Cell, Numbers, Place
from .interpreter_ops import Value, stacked
from .interpreter_uniforms import Uniform

#: name of an arithmetic -> (numpy's type of its floats, what its versions of functions are called)
PRECISIONS = {
    "float32": (np.float32, "strict float32"),
    "float64": (np.float64, "double"),
    "float16": (np.float16, "half-precision"),
}
#: elements of the batch that are computed at once: few enough for the cache, many enough to make Python's share small
LANES = 8192

#: a bool that is false: what it guards is compiled, for it is called, but not run
_NEVER = "hn_never"
_GL_TYPES = {name: enum for enum, name in gl_enums.GLSL_TYPE_NAMES.items()}


@lru_cache(maxsize=256)
def _module(text: str, main: str) -> tuple[spirv.Module, tuple[str, ...]]:
    """The SPIR-V of a text with this main(), and the literals that were taken out of the text.

    Where the text does not compile without them (one decides the length of an array, say), they stay in it: then the
    compiler folds what is constant, and a constant in double is the shortest decimal that float32 rounds to the same.
    """
    lifted, found = literals.lift(text)
    try:
        return spirv.read(native.glsl_spirv(Stage.FRAGMENT, lifted + main)), tuple(found)
    except NativeError:
        return spirv.read(native.glsl_spirv(Stage.FRAGMENT, literals.for_spirv(text) + main)), ()


class Interpretation:
    """One GLSL function in one arithmetic: ``run`` takes flat arrays and gives flat arrays.

    ``precision`` is a key of PRECISIONS: every operation is rounded to it, and so are the arguments, which come in
    float32, and the literals, which come with all their digits. Float results are of its type. ``names`` as in
    ``interpreter.Program``. GlslError when the source does not compile, CallError when the function takes or returns
    what is no data.
    """

    def __init__(self, source: Source, called: Signature, precision: str, names: Callable | None = None):
        self.signature, self.precision, self._source = called, precision, source
        floating, label = PRECISIONS[precision]
        if not called.outputs and names is None:
            raise CallError(f"{called} yields nothing", *called.origin)
        for p in called.inputs:
            if isinstance(p.type, Opaque):
                message = f"{p.name} is a {p.type}, and what reads a texture has no {label} version"
                raise CallError(f"{message}; it is {called}", *called.origin)
        try:
            self.inputs = [
                (p.name, [(f"hn_in{n}_{k}", leaf) for k, leaf in enumerate(leaves(p.type))])
                for n, p in enumerate(called.inputs)
            ]
            self.outputs = [(name, list(leaves(kind))) for name, kind in called.outputs]
        except CallError as error:
            raise CallError(f"{error.message}; it is {called}", *called.origin) from None
        try:
            module, found = _module(source.text, _main(called))
        except NativeError as error:
            raise source.error(str(error)) from None
        self._numbers = Numbers(floating)
        values = _literal_values(module, found, floating)
        self._program = Program(module, self._numbers, values, source.origin, label, names)
        self.function = _called(module)
        self._places = interpreter_uniforms.read_by(module, self.function)
        #: those that the function reads, as a driver describes them
        self.uniforms = {name: _described(uniform) for name, uniform in self._places.items()}
        self.samplers: dict[str, tuple[str, str]] = {}  # as Evaluation.samplers: nothing here reads a texture
        self._buffers = {p: [buffer for buffer, _ in buffers] for p, buffers in self.inputs}

    def array_length(self, name: str) -> int | None:
        """How many elements a uniform has; None where it is no array."""
        kind = self._places[name].type
        return kind.length if kind.kind == "array" else None

    def set_uniform(self, name: str, value: np.ndarray) -> None:
        """Sets a numeric uniform that the function reads; ``value`` in numpy's order, an array's elements first."""
        uniform = self._places[name]
        if "matrix" in (uniform.type.kind, getattr(uniform.type.element, "kind", "")):
            value = value.swapaxes(-1, -2)
        self._store(uniform, value)

    @cached_property
    def initial(self) -> dict[str, np.ndarray]:
        """As ``Evaluation.initial``, and from it: the compiler does not tell the value of a uniform.

        What the driver finds without use is 0.
        """
        names = rewrite.uniform_initialisers(self._source.text)[1]
        if not names:
            return {}
        known = Evaluation(self._source, self.signature, "as-written").initial
        stated = {name: uniform.type for name, uniform in self._places.items() if re.match(r"\w+", name)[0] in names}
        values = {name: np.zeros(kind.shape, np.float32) for name, kind in stated.items()}
        for name in stated.keys() & known.keys():
            values[name].flat[: known[name].size] = known[name]  # of an array the driver keeps what is read
        return values

    def reset_uniform(self, name: str) -> None:
        """Gives a uniform of ``initial`` the value that the source states."""
        self._store(self._places[name], self.initial[name])

    def _store(self, uniform: Uniform, value: np.ndarray) -> None:
        cell = self._program.cells[uniform.variable]
        place = Place(cell, uniform.path) if uniform.path else cell
        with np.errstate(over="ignore"):
            place.store(value.astype(self._numbers.dtype(uniform.type.number))[..., None], None)

    def run(self, arrays: dict[str, np.ndarray], count: int) -> list[list[np.ndarray]]:
        """Evaluates the function ``count`` times, as ``Evaluation.run``; floats come in the arithmetic's own type.

        What an element yields where the function discards it is NaN, and 0 for what is no float. CallError, with file
        and line, where the function does what this arithmetic has no version of, or a loop does not end.
        """
        results = [[np.empty((count, leaf.size), self._dtype(leaf)) for leaf in parts] for _, parts in self.outputs]
        for first in range(0, count, LANES):
            chunk = slice(first, min(first + LANES, count))
            for parts, values in zip(results, self.evaluate(arrays, chunk), strict=True):
                for part, value in zip(parts, values, strict=True):
                    part[chunk] = value
        return results

    def evaluate(
        self, arrays: dict[str, np.ndarray], chunk: slice, recorder: Callable | None = None
    ) -> list[list[np.ndarray]]:
        """The elements of a batch in ``chunk``, of which there must be some: for each output its leaves, (n, size).

        ``recorder`` as in ``interpreter.Run``.
        """
        run = Run(self._program, chunk.stop - chunk.start, recorder)
        with np.errstate(all="ignore"):
            self._program.initialize()
            cells: dict[str, Cell] = {}
            arguments = []
            for parameter, (_, kind, _) in zip(self.signature.parameters, self.function.parameters, strict=True):
                cell = cells[parameter.name] = Cell(self._argument(parameter, kind, arrays, chunk))
                arguments.append(cell if kind.kind == "pointer" else cell.value)
            result = self._program.call(self.function.id, arguments, None, run)
            values = [] if self.signature.result == VOID else [result]
            values += [cells[p.name].value for p in self.signature.parameters if p.direction != "in"]
            return [
                [self._flat(leaf, part, run) for leaf, part in zip(parts, _parts(value, kind), strict=True)]
                for value, (_, parts), (_, kind) in zip(values, self.outputs, self.signature.outputs, strict=True)
            ]

    def _dtype(self, leaf: Leaf) -> np.dtype:
        return self._numbers.floating if leaf.type.base == "float" else leaf.dtype

    def _argument(self, parameter: Parameter, kind: spirv.Type, arrays: dict[str, np.ndarray], chunk: slice) -> Value:
        if parameter.direction == "out":
            return self._numbers.unassigned(kind.element)
        flat = (arrays[buffer] for buffer in self._buffers[parameter.name])
        rows = iter([a if len(a) == 1 else a[chunk] for a in flat])
        return self._assembled(parameter.type, rows)

    def _assembled(self, kind: signature.Type, rows: Iterator[np.ndarray]) -> Value:
        """The value of a type from its leaves, (n, size) each."""
        if isinstance(kind, Struct):
            return [self._assembled(member, rows) for _, member in kind.members]
        if isinstance(kind, Array):
            parts = [self._assembled(kind.element, rows) for _ in range(kind.length)]
            return parts if isinstance(parts[0], list) else stacked(parts)
        row = next(rows)
        value = row.T.reshape(*kind.shape, len(row))
        value = value.swapaxes(0, 1) if kind.columns > 1 else value
        dtype = self._numbers.floating if kind.base == "float" else np.dtype(DTYPES[kind.base])
        return np.ascontiguousarray(value, dtype)

    def _flat(self, leaf: Leaf, value: np.ndarray, run: Run) -> np.ndarray:
        """A leaf's numbers in numpy's order, (n, size)."""
        value = value.swapaxes(0, 1) if leaf.type.columns > 1 else value
        flat = np.broadcast_to(value, (*value.shape[:-1], run.lanes)).reshape(leaf.size, run.lanes).T
        if run.killed is None:
            return flat
        return np.where(run.killed[:, None], np.nan if leaf.type.base == "float" else 0, flat)


def _parts(value: Value, kind: signature.Type) -> Iterator[np.ndarray]:
    """The numeric parts of a value, in the order of ``evaluation.leaves``."""
    if isinstance(kind, Struct):
        for part, (_, member) in zip(value, kind.members, strict=True):
            yield from _parts(part, member)
    elif isinstance(kind, Array):
        for part in value:
            yield from _parts(part, kind.element)
    else:
        yield value


def _literal_values(module: spirv.Module, found: tuple[str, ...], floating: type) -> dict[int, np.ndarray]:
    """The literals that were made uniforms, by the ids of these."""
    with np.errstate(over="ignore"):  # beyond the type is Inf, as in GLSL
        return {
            v.id: np.array([float(found[int(v.name.removeprefix(literals.PREFIX))])]).astype(floating)
            for v in module.variables.values()
            if v.name.startswith(literals.PREFIX)
        }


def _main(called: Signature) -> str:
    """A main() whose last call is of this function. It begins with what the compiler adds: global variables' values."""
    names = [f"hn_{n}" for n in range(len(called.parameters))]
    variables = " ".join(f"{p.type} {name};" for p, name in zip(called.parameters, names, strict=True))
    call = f"{called.name}({', '.join(names)});"
    return f"\nuniform bool {_NEVER};\nvoid main() {{ if ({_NEVER}) {{ {variables} {call} }} }}\n"


def _called(module: spirv.Module) -> spirv.Function:
    """The function that main() calls last."""
    entry = module.functions[module.entry]
    calls = [i.operands[0] for block in entry.blocks for i in block.instructions if i.opcode == spirv.CALL]
    return module.functions[calls[-1]]


def _described(uniform: Uniform) -> native.Variable:
    kind, size = uniform.type, 1
    while kind.kind == "array":
        kind, size = kind.element, size * kind.length
    return native.Variable(_GL_TYPES.get(str(kind), 0), size, 0)


def uniforms_read(source: Source, called: Signature) -> set[str]:
    """The names of the uniforms that a function may read, as its SPIR-V tells. GlslError when it does not compile."""
    try:
        module, _ = _module(source.text, _main(called))
    except NativeError as error:
        raise source.error(str(error)) from None
    return set(interpreter_uniforms.read_by(module, _called(module)))
