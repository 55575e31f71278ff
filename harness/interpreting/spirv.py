"""Reads a SPIR-V module into plain dataclasses: types, constants, global variables, functions, names and lines.

Khronos, SPIR-V Specification 1.0: the layout of section 2, the opcodes of section 3. Only what glslang writes for GLSL
is named; any other instruction is kept with its number.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

_MAGIC = 0x07230203
_HEADER = 5  # words


@dataclass(frozen=True)
class Type:
    """A type. ``kind`` is void, bool, int, uint, float, vector, matrix, array, struct, pointer or opaque.

    ``width`` are the bits of a number; ``element`` is the type of a component, a column, an element, or of what is
    pointed at; ``length`` the number of these; ``members`` the (name, type) of a structure.
    """

    kind: str
    width: int = 0
    element: Type | None = None
    length: int = 0
    members: tuple[tuple[str, Type], ...] = ()
    name: str = ""

    @property
    def number(self) -> Type | None:
        """The scalar type that it is all made of; None where there is a structure or an opaque type in it."""
        if self.kind in ("vector", "matrix", "array"):
            return self.element.number
        return self if self.kind in ("bool", "int", "uint", "float") else None

    @property
    def shape(self) -> tuple[int, ...]:
        """How the numbers of a type with a ``number`` are nested: (), (3,), matrices (columns, rows)."""
        return (self.length, *self.element.shape) if self.kind in ("vector", "matrix", "array") else ()

    def __str__(self):
        """As GLSL spells it."""
        if self.kind == "array":
            inner, lengths = self, ""
            while inner.kind == "array":
                inner, lengths = inner.element, f"{lengths}[{inner.length}]"
            return f"{inner}{lengths}"
        prefix = {"bool": "b", "int": "i", "uint": "u", "float": "d" if self.number and self.number.width == 64 else ""}
        if self.kind == "vector":
            return f"{prefix[self.element.kind]}vec{self.length}"
        if self.kind == "matrix":
            columns, rows = self.length, self.element.length
            return f"{prefix['float']}mat{columns}" + (f"x{rows}" if rows != columns else "")
        if self.kind == "float" and self.width == 64:
            return "double"
        return self.name or self.kind


@dataclass(frozen=True)
class Constant:
    """``bits`` of a scalar, ``parts`` (ids) of a composite; neither for zero."""

    type: Type
    bits: int | None = None
    parts: tuple[int, ...] | None = None


@dataclass(frozen=True)
class Variable:
    """A variable; ``type`` is what it holds, ``storage`` the number of its storage class."""

    id: int
    type: Type
    storage: int
    initializer: int | None
    name: str


UNIFORM_CONSTANT, INPUT, UNIFORM, OUTPUT, PRIVATE, FUNCTION = 0, 1, 2, 3, 6, 7


@dataclass(frozen=True)
class Instruction:
    """One instruction of a function: opcode, type and id of its result, its other words, its line."""

    opcode: int
    type: Type | None
    result: int
    operands: tuple[int, ...]
    line: int


@dataclass
class Block:
    """Instructions from a label to a branch or return; ``loop`` is the line of a loop that begins here."""

    label: int
    instructions: list[Instruction] = field(default_factory=list)
    loop: int | None = None


@dataclass
class Function:
    """A function; ``name`` is as in GLSL, ``parameters`` are (id, type, name), a pointer where it can be written."""

    id: int
    name: str
    result: Type
    parameters: list[tuple[int, Type, str]] = field(default_factory=list)
    variables: list[Variable] = field(default_factory=list)
    blocks: list[Block] = field(default_factory=list)
    line: int = 0


@dataclass
class Module:
    """A module; all maps are by id."""

    bound: int
    types: dict[int, Type] = field(default_factory=dict)
    constants: dict[int, Constant] = field(default_factory=dict)
    variables: dict[int, Variable] = field(default_factory=dict)
    functions: dict[int, Function] = field(default_factory=dict)
    entry: int = 0


# ---- Opcodes ---------------------------------------------------------------------------------------------------------

NAME, MEMBER_NAME, LINE, ENTRY_POINT = 5, 6, 8, 15
EXT_INST, CONSTANT_TRUE, CONSTANT_FALSE, CONSTANT, CONSTANT_COMPOSITE, CONSTANT_NULL = 12, 41, 42, 43, 44, 46
TYPE_FIRST, TYPE_LAST, UNDEF = 19, 39, 1
FUNCTION_BEGIN, PARAMETER, FUNCTION_END, CALL, VARIABLE, LOAD, STORE, ACCESS_CHAIN = 54, 55, 56, 57, 59, 61, 62, 65
COPY_OBJECT, PHI, LOOP_MERGE, SELECTION_MERGE, LABEL = 83, 245, 246, 247, 248
BRANCH, BRANCH_CONDITIONAL, SWITCH, KILL, RETURN, RETURN_VALUE, UNREACHABLE = 249, 250, 251, 252, 253, 254, 255

#: those of functions and constants that have a result, which all have a type too
_WITH_RESULT = {
    *(UNDEF, EXT_INST, 41, 42, 43, 44, 46, 48, 49, 50, 51, 52, 54, 55, 57, 59, 60, 61, 65, 66, 68),
    *range(77, 99),  # composites and sampling
    *(100, *range(103, 108)),
    *range(109, 192),  # conversions, arithmetic, comparisons
    *range(194, 206),  # bits
    *range(207, 216),  # derivatives
    *range(227, 243),  # atomics, without the store
    PHI,
}
_WITH_RESULT -= {228}


def _text(words: list[int]) -> str:
    return b"".join(w.to_bytes(4, "little") for w in words).split(b"\0", 1)[0].decode(errors="replace")


def instructions(words: Sequence[int]) -> Iterator[tuple[int, list[int]]]:
    """Opcode and operands of each instruction of a module, a list of words."""
    place = _HEADER
    while place < len(words):
        length, opcode = words[place] >> 16, words[place] & 0xFFFF
        yield opcode, words[place + 1 : place + length]
        place += length


class _Reader:
    """Fills a module, instruction by instruction."""

    def __init__(self, words: np.ndarray):
        self.words = words.tolist()
        self.module = Module(self.words[3])
        self.names: dict[int, str] = {}
        self.members: dict[tuple[int, int], str] = {}
        self.line = 0
        self.function: Function | None = None
        self.block: Block | None = None

    def read(self) -> Module:
        for opcode, operands in instructions(self.words):
            if opcode == NAME:
                self.names[operands[0]] = _text(operands[1:])
            elif opcode == MEMBER_NAME:
                self.members[operands[0], operands[1]] = _text(operands[2:])
            elif opcode == ENTRY_POINT:
                self.module.entry = operands[1]
            elif opcode == LINE:
                self.line = operands[1]
            elif TYPE_FIRST <= opcode <= TYPE_LAST:
                self._type(opcode, *operands)
            elif opcode in _WITH_RESULT:
                self._result(opcode, *operands)
            elif opcode == LABEL:
                self.block = Block(operands[0])
                self.function.blocks.append(self.block)
            elif opcode == LOOP_MERGE:
                self.block.loop = self.line
            elif opcode == FUNCTION_END:
                self.function = None
            elif self.function and opcode != SELECTION_MERGE:
                self.block.instructions.append(Instruction(opcode, None, 0, tuple(operands), self.line))
        return self.module

    def _type(self, opcode: int, result: int, *rest: int) -> None:
        types = self.module.types
        if opcode == 19:
            made = Type("void")
        elif opcode == 20:
            made = Type("bool")
        elif opcode == 21:
            made = Type("int" if rest[1] else "uint", rest[0])
        elif opcode == 22:
            made = Type("float", rest[0])
        elif opcode in (23, 24):
            made = Type("vector" if opcode == 23 else "matrix", element=types[rest[0]], length=rest[1])
        elif opcode == 28:
            made = Type("array", element=types[rest[0]], length=self.module.constants[rest[1]].bits)
        elif opcode == 30:
            members = tuple((self.members.get((result, k), ""), types[t]) for k, t in enumerate(rest))
            made = Type("struct", members=members, name=self.names.get(result, ""))
        elif opcode == 32:
            made = Type("pointer", element=types[rest[1]])
        else:  # images and samplers; functions, whose parts say all about them
            made = Type("opaque", name=f"type {opcode}")
        types[result] = made

    def _result(self, opcode: int, type_: int, result: int, *rest: int) -> None:
        kind = self.module.types[type_]
        if opcode == FUNCTION_BEGIN:
            name = self.names.get(result, "").partition("(")[0]
            self.function = Function(result, name, kind, line=self.line)
            self.module.functions[result] = self.function
        elif opcode == PARAMETER:
            self.function.parameters.append((result, kind, self.names.get(result, "")))
        elif opcode == VARIABLE:
            initializer = rest[1] if len(rest) > 1 else None
            variable = Variable(result, kind.element, rest[0], initializer, self.names.get(result, ""))
            if self.function:
                self.function.variables.append(variable)
            else:
                self.module.variables[result] = variable
        elif self.function:
            self.block.instructions.append(Instruction(opcode, kind, result, rest, self.line))
        elif opcode in (CONSTANT_TRUE, CONSTANT_FALSE):
            self.module.constants[result] = Constant(kind, bits=int(opcode == CONSTANT_TRUE))
        elif opcode == CONSTANT:
            self.module.constants[result] = Constant(kind, bits=sum(w << 32 * k for k, w in enumerate(rest)))
        elif opcode == CONSTANT_COMPOSITE:
            self.module.constants[result] = Constant(kind, parts=rest)
        else:
            self.module.constants[result] = Constant(kind)


def read(words: np.ndarray) -> Module:
    """The module of these words (uint32). ValueError when it is none of this machine's byte order."""
    if len(words) < _HEADER or words[0] != _MAGIC:
        raise ValueError("not a SPIR-V module")
    return _Reader(words).read()
