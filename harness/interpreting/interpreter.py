"""Runs SPIR-V functions over numpy batches, all lanes at once, in a number system of choice.

Control flow: a block is run for the lanes that arrive at it, and of the blocks that lanes wait at the first in the
module is run next. SPIR-V puts what a construct contains before what follows it, so lanes that part meet again where
the construct ends, and a loop's go round until the last has left. Values are computed in all lanes, whether they take
part or not; only stores, returned values and merges ask which do. Written for what glslang makes of GLSL without
optimisation: an unnamed value is not used beyond the statement that it belongs to.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..errors import CallError
from . import spirv
from .interpreter_memory import Cell, Mask, Numbers, merged
from .interpreter_ops import Value
from .interpreter_steps import Step, compile_step, constant_values
from .spirv import Module

#: how often all loops together may go round, for one chunk of a batch, before they are given up as endless; the
#: software renderer stops at 65 535, and says nothing
LOOP_LIMIT = 100_000

_BRANCH, _CONDITIONAL, _SWITCH, _RETURN, _VALUE, _KILL = range(6)
_EXITS = {
    spirv.BRANCH: _BRANCH,
    spirv.BRANCH_CONDITIONAL: _CONDITIONAL,
    spirv.SWITCH: _SWITCH,
    spirv.RETURN: _RETURN,
    spirv.UNREACHABLE: _RETURN,
    spirv.RETURN_VALUE: _VALUE,
    spirv.KILL: _KILL,
}


class Frame:
    """What the steps of a function find: which lanes take part, and the run that they belong to."""

    __slots__ = ("mask", "run")

    def __init__(self, mask: Mask, run: Run):
        self.mask, self.run = mask, run


def _ignored(*recorded) -> None:
    """The recorder of a run that nobody follows."""


class Run:
    """One evaluation of a batch of ``lanes`` elements. ``recorder`` is told of every value that steps record."""

    def __init__(self, program: Program, lanes: int, recorder: Callable | None = None):
        self.program, self.lanes, self.recorder = program, lanes, recorder or _ignored
        self.jumps = 0
        self.killed: Mask = None  # the lanes that met a discard, None: none

    def kill(self, mask: Mask) -> None:
        """Ends these lanes."""
        mask = np.ones(self.lanes, bool) if mask is None else mask
        self.killed = mask if self.killed is None else self.killed | mask

    def living(self, mask: Mask) -> Mask:
        """The lanes of the mask that met no discard."""
        if self.killed is None:
            return mask
        return ~self.killed if mask is None else mask & ~self.killed

    def jump(self, line: int) -> None:
        """Counts one more round of the loop that begins on this line."""
        self.jumps += 1
        if self.jumps > LOOP_LIMIT:
            message = f"a loop does not end: the call's loops have gone round {LOOP_LIMIT} times"
            raise CallError(message, *self.program.origin(line))


class _Block:
    """A block ready to be run; targets are indices of blocks."""

    __slots__ = ("phis", "steps", "calls", "exit", "operand", "targets", "loop")

    def __init__(self, function: spirv.Function, block: spirv.Block, places: dict[int, int], steps: list[Step]):
        last = block.instructions[-1]
        self.phis = [
            (i.result, {places[label]: value for value, label in zip(i.operands[::2], i.operands[1::2], strict=True)})
            for i in block.instructions
            if i.opcode == spirv.PHI
        ]
        self.steps = tuple(steps)
        self.calls = any(i.opcode == spirv.CALL for i in block.instructions)
        self.exit = _EXITS[last.opcode]
        self.operand = last.operands[0] if last.operands else 0
        self.loop = block.loop
        self.targets: list = []
        if self.exit == _BRANCH:
            self.targets = [places[last.operands[0]]]
        elif self.exit == _CONDITIONAL:
            self.targets = [places[last.operands[1]], places[last.operands[2]]]
        elif self.exit == _SWITCH:
            cases = zip(last.operands[2::2], last.operands[3::2], strict=True)
            self.targets = [places[last.operands[1]], [(np.uint32(value), places[label]) for value, label in cases]]

    def successors(self, registers: list, mask: Mask) -> Sequence[tuple[int, Mask]]:
        """Where the lanes go on, as (block, lanes)."""
        if self.exit == _BRANCH:
            return ((self.targets[0], mask),)
        if self.exit == _CONDITIONAL:
            condition = registers[self.operand]
            if condition.shape[-1] == 1:
                return ((self.targets[0 if condition[0] else 1], mask),)
            return _parted([(self.targets[0], condition)], self.targets[1], mask)
        if self.exit == _SWITCH:
            selector = registers[self.operand].view(np.uint32)
            groups: dict[int, np.ndarray] = {}
            for value, target in self.targets[1]:
                groups[target] = groups.get(target, False) | (selector == value)
            if selector.shape[-1] == 1:
                taken = next((target for target, lanes in groups.items() if lanes[0]), self.targets[0])
                return ((taken, mask),)
            return _parted(list(groups.items()), self.targets[0], mask)
        return ()


def _parted(groups: list[tuple[int, np.ndarray]], default: int, mask: Mask) -> list[tuple[int, Mask]]:
    """The lanes of a mask by where they go; those of no group to the default."""
    parts = []
    rest = mask
    for target, lanes in groups:
        lanes = lanes if rest is None else lanes & rest
        if lanes.all():
            return [*parts, (target, None)]
        if lanes.any():
            parts.append((target, lanes))
            rest = ~lanes if rest is None else rest & ~lanes
    if rest is None or rest.any():
        parts.append((default, rest))
    return parts


class _Code:
    """A function ready to be run."""

    def __init__(self, program: Program, function: spirv.Function):
        places = {block.label: k for k, block in enumerate(function.blocks)}
        self.template = program.template
        self.parameters = [identifier for identifier, _, _ in function.parameters]
        self.variables = [
            (v.id, program.numbers.unassigned(v.type) if v.initializer is None else program.template[v.initializer])
            for v in function.variables
        ]
        names = program.names_of(function)
        self.nothing = None if function.result.kind == "void" else program.numbers.unassigned(function.result)
        self.entry = names.record_parameters() if names else ()
        self.blocks = []
        for block in function.blocks:
            steps = [compile_step(program, instruction, names) for instruction in block.instructions]
            self.blocks.append(_Block(function, block, places, [s for s in steps if s]))


class Program:
    """The functions of a module, compiled as they are called.

    ``numbers`` says what its floats are, ``literals`` the values of the uniforms that are literals, by their ids,
    ``origin`` maps a line to (file, line), ``label`` names the arithmetic in messages. ``names`` makes, of a program
    and a function, what says which of its values are recorded and how they are called; None: nothing is.
    """

    def __init__(
        self,
        module: Module,
        numbers: Numbers,
        literals: dict[int, np.ndarray],
        origin: Callable[[int], tuple[str, int]],
        label: str,
        names: Callable | None = None,
    ):
        self.module, self.numbers, self.literals, self.origin, self.label = module, numbers, literals, origin, label
        self._names = names
        self.cells = {v.id: Cell(numbers.unassigned(v.type)) for v in module.variables.values()}
        self.template: list = [None] * module.bound
        for identifier, value in constant_values(module, numbers).items():
            self.template[identifier] = value
        for identifier, cell in self.cells.items():
            self.template[identifier] = cell
        self._code: dict[int, _Code] = {}

    def names_of(self, function: spirv.Function):
        """What names the values of a function that are recorded; None where nothing is."""
        return self._names(self, function) if self._names else None

    def initialize(self) -> None:
        """Gives the global variables their initial values, which depend on uniforms alone."""
        for variable in self.module.variables.values():
            if variable.storage == spirv.PRIVATE:
                start = variable.initializer
                value = self.numbers.unassigned(variable.type) if start is None else self.template[start]
                self.cells[variable.id].value = value
        self.call(self.module.entry, [], None, Run(self, 1))

    def call(self, function: int, arguments: list, mask: Mask, run: Run) -> Value | None:
        """Runs a function by its id; arguments are values or, for pointers, cells."""
        code = self._code.get(function)
        if code is None:
            code = self._code[function] = _Code(self, self.module.functions[function])
        registers = code.template.copy()
        for identifier, argument in zip(code.parameters, arguments, strict=True):
            registers[identifier] = argument
        for identifier, start in code.variables:
            registers[identifier] = Cell(start)
        frame = Frame(mask, run)
        for step in code.entry:
            step(registers, frame)
        result = _follow(code, registers, frame)
        return code.nothing if result is None else result  # where all lanes met a discard


def _follow(code: _Code, registers: list, frame: Frame) -> Value | None:
    """Runs the blocks of a function until all lanes have returned."""
    run, entered = frame.run, frame.mask
    waiting: dict[int, list[tuple[Mask, int]]] = {}  # block -> the lanes that arrived, and from which block
    result = None
    place, arrivals = 0, [(entered, -1)]
    while True:
        block = code.blocks[place]
        mask = _union(arrivals, entered, run)
        for identifier, sources in block.phis:
            value = registers[sources[arrivals[0][1]]]
            for lanes, source in arrivals[1:]:
                value = merged(lanes, registers[sources[source]], value)
            registers[identifier] = value
        frame.mask = mask
        for step in block.steps:
            step(registers, frame)
        if block.calls and run.killed is not None:
            mask = run.living(mask)
        if block.exit == _VALUE:
            value = registers[block.operand]
            result = value if result is None or mask is None else merged(mask, value, result)
        elif block.exit == _KILL:
            run.kill(mask)
        elif run.killed is None or mask is None or mask.any():
            for target, lanes in block.successors(registers, mask):
                if target <= place and code.blocks[target].loop is not None:
                    run.jump(code.blocks[target].loop)
                waiting.setdefault(target, []).append((lanes, place))
        if not waiting:
            return result
        place = min(waiting)
        arrivals = waiting.pop(place)


def _union(arrivals: list[tuple[Mask, int]], entered: Mask, run: Run) -> Mask:
    """All lanes that arrived; the mask that the function was entered with where they are all again."""
    if len(arrivals) == 1:
        return arrivals[0][0]
    mask = arrivals[0][0]
    for lanes, _ in arrivals[1:]:
        mask = mask | lanes
    count = run.lanes if entered is None else np.count_nonzero(entered)
    return entered if np.count_nonzero(mask) == count else mask
