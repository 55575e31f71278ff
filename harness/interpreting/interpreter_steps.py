"""Makes of each SPIR-V instruction a step: a Python function that takes the registers and leaves its result in them.

``registers`` are values, cells and places by the ids of SPIR-V.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ..errors import CallError
from . import spirv
from .interpreter_builtins import BUILTINS, UNPACKED
from .interpreter_memory import Cell, Numbers, Place, _with, element, index_of
from .interpreter_ops import OPERATIONS, Value, float_to_int, stacked
from .spirv import Instruction, Module, Type

if TYPE_CHECKING:
    from .interpreter import Frame, Program

Step = Callable[[list, "Frame"], None]

_CONVERSIONS = range(109, 116)

_FLOAT_TO_UINT, _FLOAT_TO_INT = 109, 110
_MODF = 35  # of GLSL.std.450

#: opcodes that have no meaning outside a driver -> what a user knows them as
_ABSENT = {
    **dict.fromkeys((*range(86, 99), 100, *range(103, 108)), "a texture or image"),
    **dict.fromkeys(range(207, 216), "a derivative (dFdx, dFdy, fwidth)"),
    **dict.fromkeys(range(224, 243), "a barrier or atomic operation"),
}
_NO_STEP = {spirv.PHI, spirv.BRANCH, spirv.BRANCH_CONDITIONAL, spirv.SWITCH, spirv.RETURN, spirv.RETURN_VALUE}
_NO_STEP |= {spirv.KILL, spirv.UNREACHABLE}


def constant_values(module: Module, numbers: Numbers) -> dict[int, Value]:
    """The constants of a module.

    A float constant becomes the shortest decimal that rounds to it: what was written, in nearly all cases, for the
    compiler has rounded it to float32.
    """
    values: dict[int, Value] = {}
    for identifier, constant in module.constants.items():
        kind = constant.type
        if constant.parts is not None:
            values[identifier] = composed(kind, [values[part] for part in constant.parts])
        elif constant.bits is None:
            values[identifier] = numbers.filled(kind, 0)
        elif kind.kind == "float" and kind.width == 32:
            written = str(np.uint32(constant.bits).view(np.float32))
            values[identifier] = np.array([float(written)]).astype(numbers.floating)
        elif kind.kind == "bool":
            values[identifier] = np.array([constant.bits != 0])
        elif kind.width == 64:
            values[identifier] = np.array([constant.bits], np.uint64).view(numbers.dtype(kind))
        else:
            values[identifier] = np.array([constant.bits], np.uint32).view(numbers.dtype(kind))
    return values


def composed(kind: Type, parts: list[Value]) -> Value:
    """A vector of scalars and vectors, a matrix of columns, an array, a structure."""
    if kind.number is None:
        return list(parts)
    if kind.kind != "vector":
        return stacked(parts)
    return stacked([row for part in parts for row in (part if part.ndim > 1 else (part,))])


def compile_step(program: Program, i: Instruction, names) -> Step | None:
    """The step of an instruction; None where it has none."""
    if i.opcode in _NO_STEP:
        return names.record(i) if names and i.opcode == spirv.RETURN_VALUE else None
    step = _compiled(program, i)
    record = names.record(i) if names else None
    if record is None:
        return step

    def recorded(registers: list, frame: Frame) -> None:
        step(registers, frame)
        record(registers, frame)

    return recorded


def _compiled(program: Program, i: Instruction) -> Step | None:
    """The step that does what the instruction says."""
    to, operands = i.result, i.operands
    match i.opcode:
        case spirv.LOAD | spirv.ACCESS_CHAIN if name := _input(program.module, operands[0]):
            return _absent(program, i.line, f"{name}, which a stage gets,")
        case spirv.LOAD:
            return _load(program, to, operands[0])
        case spirv.STORE:
            return _store(operands[0], operands[1])
        case spirv.ACCESS_CHAIN | 66:
            return _access(program, to, operands[0], operands[1:])
        case spirv.CALL:
            return _call(to, operands[0], operands[1:])
        case spirv.EXT_INST:
            return _built_in(program, i)
        case 1:
            start = program.numbers.unassigned(i.type)
            return lambda registers, frame: registers.__setitem__(to, start)
        case spirv.COPY_OBJECT:
            return _operation(to, lambda a: a, operands)
        case 77 | 78 | 79 | 80 | 81 | 82:
            return _composite(i)
        case 124:
            return _bitcast(program, i)
        case opcode if opcode in _CONVERSIONS:
            return _operation(to, _conversion(program.numbers, i), operands)
        case opcode if opcode in OPERATIONS:
            return _operation(to, OPERATIONS[opcode][1], operands)
    return _absent(program, i.line, _ABSENT.get(i.opcode, f"SPIR-V instruction {i.opcode}"))


def _input(module: Module, pointer: int) -> str:
    """The name of the stage's input that a pointer is; "" where it is none."""
    variable = module.variables.get(pointer)
    if variable is None or variable.storage != spirv.INPUT:
        return ""
    return variable.name or variable.type.name


def _absent(program: Program, line: int, what: str) -> Step:
    """A step that fails where it is reached."""

    def fail(registers: list, frame: Frame) -> None:
        raise CallError(f"{what} has no {program.label} version", *program.origin(line))

    return fail


def _operation(to: int, function: Callable[..., Value], operands: tuple[int, ...]) -> Step:
    """A step that computes; written out by the number of operands, for it is most of a call's cost."""
    if len(operands) == 1:
        (a,) = operands

        def unary(registers: list, frame: Frame) -> None:
            registers[to] = function(registers[a])

        return unary
    if len(operands) == 2:
        a, b = operands

        def binary(registers: list, frame: Frame) -> None:
            registers[to] = function(registers[a], registers[b])

        return binary

    def general(registers: list, frame: Frame) -> None:
        registers[to] = function(*[registers[k] for k in operands])

    return general


def _load(program: Program, to: int, pointer: int) -> Step | None:
    if pointer in program.literals:
        value = program.literals[pointer]
        return lambda registers, frame: registers.__setitem__(to, value)

    def load(registers: list, frame: Frame) -> None:
        registers[to] = registers[pointer].load()

    return load


def _store(pointer: int, value: int) -> Step:
    def store(registers: list, frame: Frame) -> None:
        registers[pointer].store(registers[value], frame.mask)

    return store


def _access(program: Program, to: int, base: int, indices: tuple[int, ...]) -> Step:
    constants = program.module.constants
    fixed = tuple(int(program.template[k][0]) if k in constants else None for k in indices)
    if None not in fixed:

        def at(registers: list, frame: Frame) -> None:
            start = registers[base]
            registers[to] = Place(start, fixed) if type(start) is Cell else Place(start.cell, start.path + fixed)

        return at

    def computed(registers: list, frame: Frame) -> None:
        path = tuple(
            index_of(registers[k]) if known is None else known for k, known in zip(indices, fixed, strict=True)
        )
        start = registers[base]
        registers[to] = Place(start, path) if type(start) is Cell else Place(start.cell, start.path + path)

    return computed


def _call(to: int, function: int, arguments: tuple[int, ...]) -> Step:
    def call(registers: list, frame: Frame) -> None:
        run = frame.run
        given = [registers[k] for k in arguments]
        registers[to] = run.program.call(function, given, frame.mask, run)
        frame.mask = run.living(frame.mask)

    return call


def _built_in(program: Program, i: Instruction) -> Step:
    _, number, *operands = i.operands
    if number not in BUILTINS:
        return _absent(program, i.line, f"the built-in function {number} of GLSL.std.450")
    if number == _MODF:
        return _modf(i.result, *operands)
    function = BUILTINS[number][1]
    if number in UNPACKED:
        dtype = program.numbers.dtype(i.type.number)
        return _operation(i.result, lambda word: function(word, dtype), tuple(operands))
    return _operation(i.result, function, tuple(operands))


def _modf(to: int, value: int, pointer: int) -> Step:
    """The fraction is the result, and the whole part goes where the pointer leads."""

    def modf(registers: list, frame: Frame) -> None:
        registers[to], whole = np.modf(registers[value])
        registers[pointer].store(whole, frame.mask)

    return modf


def _conversion(numbers: Numbers, i: Instruction) -> Callable[[np.ndarray], np.ndarray]:
    dtype = numbers.dtype(i.type.number)
    if i.opcode == _FLOAT_TO_INT or i.opcode == _FLOAT_TO_UINT:
        return float_to_int(dtype.type)
    return lambda a: a.astype(dtype)


def _bitcast(program: Program, i: Instruction) -> Step:
    """Between numbers of 32 bits; a float of another arithmetic has no such bits."""
    dtype = program.numbers.dtype(i.type.number)
    fail = _absent(program, i.line, "the bit pattern of a float")

    def cast(registers: list, frame: Frame) -> None:
        value = registers[i.operands[0]]
        if value.dtype.itemsize != 4 or dtype.itemsize != 4:
            fail(registers, frame)
        registers[i.result] = np.ascontiguousarray(value).view(dtype)

    return cast


def _composite(i: Instruction) -> Step:
    """Making, taking apart and rearranging vectors, matrices, arrays and structures."""
    to, operands = i.result, i.operands
    match i.opcode:
        case 77:
            return _operation(to, lambda vector, index: element(vector, index_of(index)), operands)
        case 78:
            return _operation(to, lambda vector, part, index: _with(vector, (index_of(index),), part, None), operands)
        case 79:
            return _shuffle(to, *operands[:2], list(operands[2:]))
        case 80:
            return _construct(i)
        case 81:
            source, path = operands[0], operands[1:]
            if len(path) == 1:
                (k,) = path
                return _operation(to, lambda value: value[k], (source,))

            def extract(value: Value) -> Value:
                for k in path:
                    value = value[k]
                return value

            return _operation(to, extract, (source,))
    path = operands[2:]
    return _operation(to, lambda part, whole: _with(whole, path, part, None), operands[:2])


def _construct(i: Instruction) -> Step:
    to, operands, kind = i.result, i.operands, i.type
    if kind.kind == "vector" and len(operands) == kind.length and len(set(operands)) == 1:
        return _operation(to, lambda a: np.broadcast_to(a, (kind.length, *a.shape)), operands[:1])
    return _operation(to, lambda *parts: composed(kind, list(parts)), operands)


def _shuffle(to: int, a: int, b: int, components: list[int]) -> Step:
    """Components of two vectors, counted through both."""

    def shuffle(registers: list, frame: Frame) -> None:
        first, second = registers[a], registers[b]
        if a == b or max(components) < len(first):
            registers[to] = first[[k % len(first) for k in components]]
        else:
            registers[to] = stacked([first[k] if k < len(first) else second[k - len(first)] for k in components])

    return shuffle
