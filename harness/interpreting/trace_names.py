"""What of an interpreted function is recorded in a trace, and what it is called there.

Recorded is what makes or keeps a float: each operation under its expression (``NoH * NoH``), unless the value goes
straight into a variable or is returned; each assignment under the variable's name, ``m.albedo`` or ``v.x``; parameters
under theirs; what a function returns under ``D_GGX()``.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from ..language import literals
from . import spirv
from .interpreter_builtins import BUILTINS
from .interpreter_ops import OPERATIONS
from .interpreter_steps import Step
from .spirv import Function, Instruction, Type

if TYPE_CHECKING:
    from .interpreter import Frame, Program

_LONGEST = 48  # characters of an expression
_SELECT, _TRANSPOSE = 169, 84
_FROM_INTEGER, _FLOAT_TO_FLOAT = (111, 112), 115
_COMPONENTS = "xyzw"
#: how strongly the operators of GLSL bind; everything else binds more
_BINDING = {"*": 5, "/": 5, "%": 5, "+": 4, "-": 4, "<<": 3, ">>": 3}
_SIMPLE = re.compile(r"[\w.\[\]]+$|[\w.]+\([^()]*\)$")


class Names:
    """The names in one function."""

    def __init__(self, program: Program, function: Function):
        self._program, self._function, self._outs = program, function, _outs(program, function)
        instructions = [i for block in function.blocks for i in block.instructions]
        self._made = {i.result: i for i in instructions if i.result}
        self._uses = Counter(operand for i in instructions for operand in set(_values(i)))
        self._passed = {operand for i in instructions if i.opcode == spirv.CALL for operand in i.operands[1:]}
        variables = [*program.module.variables.values(), *function.variables]
        self._variables = {v.id: (v.name, v.type) for v in variables}
        self._variables |= {
            identifier: (name, kind.element if kind.kind == "pointer" else kind)
            for identifier, kind, name in function.parameters
        }
        self._kept = {k for i in instructions for k in self._keeps(i)}

    def _keeps(self, i: Instruction) -> tuple[int, ...]:
        """The value that an assignment or a return records in place of the operation that made it."""
        if i.opcode == spirv.STORE and self._is_named(i.operands[0]):
            return (i.operands[1],)
        return (i.operands[0],) if i.opcode == spirv.RETURN_VALUE else ()

    def _is_named(self, pointer: int) -> bool:
        """Whether an assignment is the user's: not to a copy of an argument, nor to what holds the value of a ?:."""
        return pointer not in self._passed and (pointer not in self._variables or self._variables[pointer][0] != "")

    def record_parameters(self) -> tuple[Step, ...]:
        """Steps that record the parameters of a call."""
        steps = []
        for identifier, kind, name in self._function.parameters:
            pointer = kind.kind == "pointer"
            held = kind.element if pointer else kind
            if identifier not in self._outs and _has_floats(held):
                steps.append(self._parameter(identifier, name, held, pointer))
        return tuple(steps)

    def _parameter(self, identifier: int, name: str, kind: Type, pointer: bool) -> Step:
        line = self._function.line

        def record(registers: list, frame: Frame) -> None:
            value = registers[identifier].load() if pointer else registers[identifier]
            frame.run.recorder(name, kind, line, value, frame.mask, None)

        return record

    def record(self, i: Instruction) -> Step | None:
        """A step that records what an instruction leaves; None where that is nothing to be recorded."""
        if i.opcode == spirv.STORE:
            pointer, source = i.operands
            if not self._is_named(pointer):
                return None
            name, kind = self._text(pointer), self._held(pointer)
        elif i.opcode == spirv.RETURN_VALUE:
            source, name, kind = i.operands[0], f"{self._function.name}()", self._function.result
        elif self._computes(i) and not (i.result in self._kept and self._uses[i.result] == 1):
            source, name, kind = i.result, self._text(i.result), i.type
        else:
            return None
        if kind is None or not _has_floats(kind):
            return None
        made = self._made.get(source)
        inputs = _values(made) if made and self._computes(made) else None
        line = i.line

        def record(registers: list, frame: Frame) -> None:
            given = None if inputs is None else [registers[k] for k in inputs]
            frame.run.recorder(name, kind, line, registers[source], frame.mask, given)

        return record

    def _computes(self, i: Instruction) -> bool:
        """Whether an instruction can make what is not finite of what is."""
        if i.opcode in _FROM_INTEGER:
            return self._program.numbers.floating == np.float16  # the largest float16 is 65504
        if i.opcode in (spirv.EXT_INST, _FLOAT_TO_FLOAT):
            return True
        return i.opcode in OPERATIONS and i.opcode not in (_SELECT, _TRANSPOSE)

    # ---- Expressions ---------------------------------------------------------------------------------------------

    def _text(self, identifier: int) -> str:
        """An expression as GLSL, shortened."""
        text = self._expression(identifier)
        if len(text) > _LONGEST:
            text = self._expression(identifier, depth=1)
        return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."

    def _expression(self, identifier: int, depth: int = 20) -> str:
        if identifier in self._variables:
            name = self._variables[identifier][0]
            if name.startswith(literals.PREFIX):
                return str(self._program.literals[identifier][0])
            return name or "..."
        if identifier in self._program.module.constants:
            value = self._program.template[identifier]
            return f"{value.ravel()[0]:g}" if not isinstance(value, list) and value.size == 1 else "const"
        i = self._made.get(identifier)
        if i is None or depth < 0:
            return "..."
        match i.opcode:
            case spirv.LOAD | spirv.COPY_OBJECT:
                return self._expression(i.operands[0], depth)
            case spirv.ACCESS_CHAIN:
                return self._part(i.operands[0], i.operands[1:], depth)
            case 81:
                return self._extracted(i, depth)
            case 79:
                first = self._made_length(i.operands[0])
                letters = "".join(_COMPONENTS[k % first] for k in i.operands[2:])
                return f"{self._operand(i.operands[0], depth)}.{letters}"
            case 80:
                parts = i.operands[:1] if len(set(i.operands)) == 1 else i.operands
                return f"{i.type}({self._list(parts, depth)})"
            case spirv.CALL:
                name = self._program.module.functions[i.operands[0]].name
                return f"{name}(...)" if len(i.operands) > 1 else f"{name}()"
            case spirv.EXT_INST:
                name = BUILTINS.get(i.operands[1], ("built-in",))[0]
                return f"{name}({self._list(i.operands[2:], depth)})"
            case opcode if opcode in OPERATIONS:
                return self._operation(OPERATIONS[opcode][0], i.operands, depth)
            case opcode if opcode in range(109, 116):
                return f"{i.type}({self._list(i.operands, depth)})"
        return "..."

    def _operation(self, form: str, operands: tuple[int, ...], depth: int) -> str:
        if "(" in form:
            return form.format(*(self._expression(k, depth - 1) for k in operands))
        return form.format(*(self._operand(k, depth) for k in operands))

    def _operand(self, identifier: int, depth: int) -> str:
        text = self._expression(identifier, depth - 1)
        return text if _SIMPLE.match(text) or text == "..." else f"({text})"

    def _list(self, identifiers: tuple[int, ...], depth: int) -> str:
        return ", ".join(self._expression(k, depth - 1) for k in identifiers)

    def _made_length(self, identifier: int) -> int:
        i = self._made.get(identifier)
        return i.type.length if i else 4

    def _extracted(self, i: Instruction, depth: int) -> str:
        text, kind = self._operand(i.operands[0], depth), None
        made = self._made.get(i.operands[0])
        if made:
            kind = made.type
        elif i.operands[0] in self._variables:
            kind = self._variables[i.operands[0]][1]
        for k in i.operands[1:]:
            text += _step(kind, str(k), k)
            kind = _inside(kind, k)
        return text

    def _part(self, base: int, indices: tuple[int, ...], depth: int) -> str:
        text, kind = self._expression(base, depth), self._held(base)
        constants = self._program.module.constants
        for identifier in indices:
            known = constants[identifier].bits if identifier in constants else None
            text += _step(kind, self._expression(identifier, depth - 1), known)
            kind = _inside(kind, known or 0)
        return text

    def _held(self, pointer: int) -> Type | None:
        """The type of what a pointer leads to."""
        if pointer in self._variables:
            return self._variables[pointer][1]
        made = self._made.get(pointer)
        return made.type.element if made and made.type else None


def _values(i: Instruction) -> tuple[int, ...]:
    """The operands that are ids of values."""
    if i.opcode == spirv.EXT_INST:
        return i.operands[2:]
    if i.opcode == spirv.CALL:
        return i.operands[1:]
    if i.opcode == 81:
        return i.operands[:1]
    return i.operands[:2] if i.opcode in (79, 82) else i.operands


def _step(kind: Type | None, index: str, known: int | None) -> str:
    """How GLSL writes one step into a value."""
    if kind and known is not None and kind.kind == "struct":
        return f".{kind.members[known][0]}"
    if kind and known is not None and kind.kind == "vector" and known < len(_COMPONENTS):
        return f".{_COMPONENTS[known]}"
    return f"[{index}]"


def _inside(kind: Type | None, index: int) -> Type | None:
    if kind is None:
        return None
    return kind.members[index][1] if kind.kind == "struct" else kind.element


def _has_floats(kind: Type) -> bool:
    if kind.kind == "struct":
        return any(_has_floats(member) for _, member in kind.members)
    return (
        _has_floats(kind.element) if kind.kind == "array" else kind.number is not None and kind.number.kind == "float"
    )


def _outs(program: Program, function: Function) -> frozenset[int]:
    """The parameters of a function that bring nothing in: no call of it assigns to what it passes there."""
    found: set[int] = set()
    for caller in program.module.functions.values():
        instructions = [i for block in caller.blocks for i in block.instructions]
        stored = {i.operands[0] for i in instructions if i.opcode == spirv.STORE}
        own = {v.id for v in caller.variables}
        for i in instructions:
            if i.opcode == spirv.CALL and i.operands[0] == function.id:
                for (identifier, _, _), given in zip(function.parameters, i.operands[1:], strict=True):
                    if given in own and given not in stored:
                        found.add(identifier)
    return frozenset(found)
