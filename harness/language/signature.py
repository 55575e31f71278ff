"""GLSL types and function signatures, as the compiler states them: read from glslang's dump of the syntax tree."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .. import native
from ..errors import NativeError
from ..native import Stage
from .glsl import Source

#: base type -> numpy type of its values
DTYPES = {"float": np.float32, "int": np.int32, "uint": np.uint32, "bool": np.bool_}
_VECTOR_PREFIX = {"float": "vec", "int": "ivec", "uint": "uvec", "bool": "bvec", "double": "dvec"}


@dataclass(frozen=True)
class Numeric:
    """A scalar, vector or matrix: ``columns`` x ``rows`` numbers of ``base``; a vector is one column.

    ``precision`` is what GLSL ES makes of it, highp, mediump or lowp; it tells no two types apart.
    """

    base: str
    rows: int = 1
    columns: int = 1
    precision: str = field(default="", compare=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of one value as a numpy array: (), (n,), or (rows, columns)."""
        if self.columns > 1:
            return self.rows, self.columns
        return (self.rows,) if self.rows > 1 else ()

    def __str__(self):
        if self.columns > 1:
            size = f"{self.columns}" if self.columns == self.rows else f"{self.columns}x{self.rows}"
            return ("d" if self.base == "double" else "") + f"mat{size}"
        return f"{_VECTOR_PREFIX[self.base]}{self.rows}" if self.rows > 1 else self.base


@dataclass(frozen=True)
class Array:
    """``length`` values of one type; the dimension comes first in numpy."""

    element: Type
    length: int

    def __str__(self):
        lengths, element = "", self
        while isinstance(element, Array):
            lengths, element = f"{lengths}[{element.length}]", element.element
        return f"{element}{lengths}"


@dataclass(frozen=True)
class Struct:
    """A structure. ``name`` is None where it has none."""

    members: tuple[tuple[str, Type], ...]
    name: str | None = None

    def __str__(self):
        return self.name or "struct"


@dataclass(frozen=True)
class Opaque:
    """What is no data: a sampler, an image, or void."""

    name: str

    def __str__(self):
        return self.name


Type = Numeric | Array | Struct | Opaque
VOID = Opaque("void")


@dataclass(frozen=True)
class Parameter:
    """A parameter; ``direction`` is ``in``, ``out`` or ``inout``."""

    name: str
    type: Type
    direction: str

    def __str__(self):
        return f"{'' if self.direction == 'in' else self.direction + ' '}{self.type} {self.name}"


@dataclass(frozen=True, eq=False)
class Signature:
    """A function of a shader, and the (file, line) where it is defined. Each is equal to itself alone."""

    name: str
    result: Type
    parameters: tuple[Parameter, ...]
    origin: tuple[str, int]

    @cached_property
    def inputs(self) -> tuple[Parameter, ...]:
        """The parameters that a caller gives."""
        return tuple(p for p in self.parameters if p.direction != "out")

    @cached_property
    def outputs(self) -> tuple[tuple[str, Type], ...]:
        """What a call yields, as (name, type): the returned value under the name ``result``, then out parameters."""
        result = () if self.result == VOID else (("result", self.result),)
        return result + tuple((p.name, p.type) for p in self.parameters if p.direction != "in")

    def __str__(self):
        return f"{self.result} {self.name}({', '.join(map(str, self.parameters))})"


class _TypeReader:
    """Reads a type as glslang spells it, e.g. ``in 2-element array of 3-component vector of float``."""

    _WORD = re.compile(r"\s*([\w.]+)")
    _SKIPPED = {
        "temp",
        "global",
        "const",
        "in",
        "out",
        "inout",
        "precise",
        "noContraction",
    }

    def __init__(self, text: str):
        self.rest = text.replace("(read only)", "")

    def _take(self, pattern: str) -> re.Match | None:
        match = re.match(r"\s*" + pattern, self.rest)
        if match:
            self.rest = self.rest[match.end() :]
        return match

    def read(self) -> Type:
        """The next type of the text."""
        precision = ""
        while True:
            if match := self._take(r"(highp|mediump|lowp)\b"):
                precision = match[1]
            if match := self._take(r"(\d+)-element array of\b"):
                return Array(self.read(), int(match[1]))
            if match := self._take(r"(\d+)-component vector of (\w+)"):
                return Numeric(match[2], int(match[1]), 1, precision)
            if match := self._take(r"(\d+)X(\d+) matrix of (\w+)"):
                return Numeric(match[3], int(match[2]), int(match[1]), precision)
            if self._take(r"structure\{"):
                return self._members()
            match = self._take(r"([\w.]+)")
            if not match:
                raise ValueError(f"glslang names a type that is not understood: {self.rest!r}")
            if match[1] not in self._SKIPPED:
                known = match[1] in ("float", "int", "uint", "bool", "double")
                return Numeric(match[1], 1, 1, precision) if known else Opaque(match[1])

    def _members(self) -> Struct:
        members = []
        while not self._take(r"\}"):
            member = self.read()
            name = self._take(r"(\w+),?")
            members.append((name[1], member))
        return Struct(tuple(members))


_PROBE = "hn_struct_"
_FUNCTION = re.compile(r"^0:(\d+) +Function Definition: (\w+)\((.*?) \( (.*)\)$")
_PARAMETER = re.compile(r"^0:\S+ +'(\w*)' \( (.*)\)$")


def _definitions(tree: str) -> Iterator[tuple[int, str, list[str], Type, list[tuple[str, str]]]]:
    """(line, name, mangled parameters, result, [(parameter name, spelled type)]) of each function in a dump."""
    lines = iter(tree.splitlines())
    for line in lines:
        if not (match := _FUNCTION.match(line)):
            continue
        mangled = match[3].split(";")[:-1]
        next(lines)  # "Function Parameters:"
        spelled = [(p[1], p[2]) for p in (_PARAMETER.match(next(lines)) for _ in mangled)]
        yield int(match[1]), match[2], mangled, _TypeReader(match[4]).read(), spelled


def _direction(spelled: str) -> str:
    qualifiers = spelled.partition("{")[0].split()
    return next((word for word in ("out", "inout") if word in qualifiers), "in")


def _named(kind: Type, names: Iterator[str]) -> Type:
    """The type with its structures named from ``names``: the outer before the inner, in the order of the members."""
    if isinstance(kind, Array):
        return Array(_named(kind.element, names), kind.length)
    if isinstance(kind, Struct):
        name = next(names, None)
        return Struct(tuple((n, _named(t, names)) for n, t in kind.members), name)
    return kind


def _parameter_type(mangled: str, spelled: str) -> Type:
    """The dump spells a structure by its members; the mangled name of the function has the names."""
    return _named(_TypeReader(spelled).read(), iter(re.findall(r"struct-(\w+)", mangled)))


def _result_type(kind: Type, struct: Struct | None) -> Type:
    """The type with the structure in it replaced by ``struct``, the same with its names."""
    if isinstance(kind, Array):
        return Array(_result_type(kind.element, struct), kind.length)
    return struct if isinstance(kind, Struct) and struct else kind


def signatures(source: Source, struct_names: Sequence[str], result_names: Sequence[str]) -> list[Signature]:
    """All functions that ``source`` defines, in order. GlslError when it does not compile.

    ``struct_names`` are its global structures, ``result_names`` what each function returns. The dump names structures
    where they are parameters alone, so each is made the parameter of a function of its own.
    """
    probes = "".join(f"void {_PROBE}{n}({n} s) {{}}\n" for n in struct_names)
    try:
        tree = native.glsl_tree(Stage.FRAGMENT, source.text + probes)
    except NativeError as error:
        raise source.error(str(error)) from None
    definitions = list(_definitions(tree))
    structs = {
        name.removeprefix(_PROBE): _parameter_type(mangled[0], spelled[0][1])
        for _, name, mangled, _, spelled in definitions
        if name.startswith(_PROBE)
    }
    own = (d for d in definitions if not d[1].startswith(_PROBE))
    return [
        Signature(
            name,
            _result_type(result, structs.get(result_name)),
            tuple(
                Parameter(parameter or f"unnamed_{n}", _parameter_type(code, text), _direction(text))
                for n, (code, (parameter, text)) in enumerate(zip(mangled, spelled, strict=True), 1)
            ),
            source.origin(line),
        )
        for (line, name, mangled, result, spelled), result_name in zip(own, result_names, strict=True)
    ]
