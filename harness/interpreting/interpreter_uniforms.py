"""Which uniforms an interpreted function reads, by the names and types under which a driver would list them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..language.literals import PREFIX
from . import spirv
from .spirv import Function, Instruction, Module, Type

Path = tuple[int | None, ...]  # None: an index that is not known before the call


@dataclass(frozen=True)
class Uniform:
    """A numeric uniform, or one such member of a structure: where it lies, and what it is."""

    type: Type
    variable: int
    path: tuple[int, ...]


def read_by(module: Module, function: Function) -> dict[str, Uniform]:
    """The uniforms that a function may read, also by way of functions and of global variables that begin with them."""
    paths = _paths(module, function.id, set())
    entry = module.functions[module.entry]
    pending = [v for v in paths if _storage(module, v) == spirv.PRIVATE]
    seen = set(pending)
    while pending:
        for variable, found in _begins_with(module, entry, pending.pop()).items():
            paths.setdefault(variable, set()).update(found)
            if _storage(module, variable) == spirv.PRIVATE and variable not in seen:
                seen.add(variable)
                pending.append(variable)
    uniforms = {}
    for identifier, variable in module.variables.items():
        if identifier not in paths or variable.name.startswith(PREFIX):
            continue
        if variable.storage == spirv.UNIFORM_CONSTANT:
            for name, kind, path in _numeric(variable.name, variable.type, ()):
                if any(_overlap(path, used) for used in paths[identifier]):
                    uniforms[name] = Uniform(kind, identifier, path)
    return uniforms


def _storage(module: Module, identifier: int) -> int | None:
    variable = module.variables.get(identifier)
    return variable.storage if variable else None


def _numeric(name: str, kind: Type, path: tuple[int, ...]) -> Iterator[tuple[str, Type, tuple[int, ...]]]:
    """The numeric parts of a uniform, each an array of numbers at most."""
    if kind.number is not None:
        yield name, kind, path
    elif kind.kind == "struct":
        for k, (member, inner) in enumerate(kind.members):
            yield from _numeric(f"{name}.{member}" if name else member, inner, (*path, k))
    elif kind.kind == "array":
        for k in range(kind.length):
            yield from _numeric(f"{name}[{k}]", kind.element, (*path, k))


def _overlap(path: tuple[int, ...], used: Path) -> bool:
    return all(b is None or a == b for a, b in zip(path, used, strict=False))


def _path(module: Module, instruction: Instruction) -> Path:
    """The indices of an access chain."""
    constants = module.constants
    return tuple(constants[k].bits if k in constants else None for k in instruction.operands[1:])


def _instructions(function: Function) -> Iterator[Instruction]:
    return (i for block in function.blocks for i in block.instructions)


def _paths(module: Module, function: int, seen: set[int]) -> dict[int, set[Path]]:
    """Global variable -> the parts of it that a function and those that it calls touch."""
    found: dict[int, set[Path]] = {}
    if function in seen:
        return found
    seen.add(function)
    for i in _instructions(module.functions[function]):
        if i.opcode == spirv.ACCESS_CHAIN and i.operands[0] in module.variables:
            found.setdefault(i.operands[0], set()).add(_path(module, i))
        elif i.opcode == spirv.LOAD and i.operands[0] in module.variables:
            found.setdefault(i.operands[0], set()).add(())
        elif i.opcode == spirv.CALL:
            for variable, paths in _paths(module, i.operands[0], seen).items():
                found.setdefault(variable, set()).update(paths)
    return found


def _begins_with(module: Module, entry: Function, private: int) -> dict[int, set[Path]]:
    """What the initial value of a global variable is computed from, as main() stores it."""
    made = {i.result: i for i in _instructions(entry) if i.result}
    stores = [i for i in _instructions(entry) if i.opcode == spirv.STORE]
    found: dict[int, set[Path]] = {}
    pending, seen = [private], set()
    while pending:
        identifier = pending.pop()
        if identifier in seen:
            continue
        seen.add(identifier)
        pending += [s.operands[1] for s in stores if _base(made, s.operands[0]) == identifier]
        i = made.get(identifier)
        if identifier in module.variables:
            if identifier != private:
                found.setdefault(identifier, set()).add(())
        elif i and i.opcode == spirv.CALL:
            for variable, paths in _paths(module, i.operands[0], set()).items():
                found.setdefault(variable, set()).update(paths)
            pending += i.operands[1:]
        elif i and i.opcode == spirv.ACCESS_CHAIN and i.operands[0] in module.variables:
            found.setdefault(i.operands[0], set()).add(_path(module, i))
        elif i:
            pending += i.operands
    return found


def _base(made: dict[int, Instruction], pointer: int) -> int:
    """The variable that a pointer leads into."""
    while pointer in made:
        pointer = made[pointer].operands[0]
    return pointer
