"""What the uniforms of a pass are set to: constants, system values, functions, values of single items.

SHADERed keeps the value of a variable in memory, changes it in place at each draw and then hands it to GL. Pointers
read that memory, and an inverted constant is inverted again and again: so the memory is kept here too.
"""

from __future__ import annotations

import numpy as np

from .. import native
from ..errors import ProjectError
from ..native import gl_enums
from ..projects.project import ComputePass, Item, Pass, Project, Variable
from ..projects.traps import Traps
from . import functions, transforms
from .system import System

_GL_TYPES = {name: enum for enum, name in gl_enums.GLSL_TYPE_NAMES.items()}
#: how much of a uniform's name SHADERed looks at
_NAME_LENGTH = 63


class Memory:
    """All variables that were bound so far, in that order: where pointers look for a name."""

    def __init__(self):
        self._bound: dict[int, _Value] = {}
        self._by_name: dict[str, _Value] = {}

    def add(self, value: _Value) -> None:
        """Adds a variable, the first time that it is bound."""
        if id(value) not in self._bound:
            self._bound[id(value)] = value
            self._by_name.setdefault(value.variable.name, value)

    def find(self, name: str) -> _Value | None:
        """The first variable of that name."""
        return self._by_name.get(name)


class _Value:
    """A variable and the memory of its value: 4-byte words, matrices column by column."""

    def __init__(self, variable: Variable):
        self.variable = variable
        self.dtype = np.float32 if variable.type.base == "float" else np.int32
        self.words = self.words_of(variable.value or (0,) * variable.type.size)
        self.constant = self.words

    def words_of(self, numbers) -> np.ndarray:
        return np.array(numbers).astype(self.dtype).reshape(-1).view(np.uint32)

    def set(self, numbers: np.ndarray) -> None:
        """Matrices as (row, column)."""
        self.words[:] = self.words_of(np.asarray(numbers).T)

    def invert(self) -> None:
        n = self.variable.type.rows
        matrix = self.words.view(np.float32).reshape(n, n).T
        self.words[:] = transforms.inverse(matrix).T.reshape(-1).view(np.uint32)


def takes(gl_type: int, variable: Variable) -> bool:
    """Whether GL sets a uniform of that type by a variable: of the same type; any number sets a bool, and a bool is
    given as an integer."""
    in_shader = gl_enums.GLSL_TYPE_NAMES.get(gl_type)
    if in_shader is None:
        return False
    size = variable.type.size if variable.type.rows == 1 else None
    alike = {variable.type.glsl}
    if size is not None:
        alike.add("bool" if size == 1 else f"bvec{size}")
        if variable.type.base == "bool":
            alike.add("int" if size == 1 else f"ivec{size}")
    return in_shader in alike


class PassUniforms:
    """The variables of a pass, in the memory that SHADERed keeps them in, and the uniforms that they set."""

    def __init__(self, project: Project, shader_pass: Pass | ComputePass, program: native.Program, traps: Traps):
        """ProjectError, unless ``traps`` goes on, when a variable's type is not that of its uniform."""
        self._program = program
        self._project = project
        self._values = [_Value(v) for v in shader_pass.variables]
        uniforms = {
            name[:_NAME_LENGTH]: name for name, u in program.uniforms.items() if u.type != gl_enums.GL_SAMPLER_2D
        }
        self._uniforms: dict[int, str] = {}
        for k, variable in enumerate(shader_pass.variables):
            if variable.name in uniforms:
                self._uniforms[k] = uniforms[variable.name]
        #: the variables that are used, in order; of two with one name the later holds
        self.variables = list({v.name: v for k, v in enumerate(shader_pass.variables) if k in self._uniforms}.values())
        self._settable = {
            k
            for k, uniform in self._uniforms.items()
            if self._fits(shader_pass, self._values[k].variable, uniform, traps)
        }
        self._set: dict[str, bytes] = {}
        self._of_items = self._item_values(getattr(shader_pass, "item_values", ()))

    def _fits(self, shader_pass: Pass | ComputePass, variable: Variable, uniform: str, traps: Traps) -> bool:
        gl_type = self._program.uniforms[uniform].type
        if takes(gl_type, variable):
            return True
        in_shader = gl_enums.GLSL_TYPE_NAMES.get(gl_type, "of another type")
        traps.survive(
            ProjectError(
                f'pass "{shader_pass.name}": variable "{variable.name}" has type {variable.type.name}, '
                f"{variable.type.glsl} in GLSL, but the shader's uniform is {in_shader}",
                self._project.file,
                variable.line,
            )
        )
        return False

    def _item_values(self, item_values) -> dict[str, list[tuple[_Value, np.ndarray]]]:
        """Item -> the variables with a value of its own, in memory of its own. Of a name it is the first variable."""
        of_items: dict[str, list[tuple[_Value, np.ndarray]]] = {}
        for own in item_values:
            value = next((v for v in self._values if v.variable.name == own.variable.name), None)
            if value is not None:
                of_items.setdefault(own.item, []).append((value, value.words_of(own.value)))
        return of_items

    def bind(self, item: Item | None, system: System, memory: Memory) -> None:
        """Sets the uniforms for a draw of ``item``, or for a compute pass."""
        own = self._of_items.get(item.name, ()) if item is not None else ()
        for value, words in own:
            value.words = words
        for k, value in enumerate(self._values):
            memory.add(value)
            if k not in self._uniforms:
                continue
            variable = value.variable
            if variable.system is not None:
                value.set(system.value(variable.system, item, last=variable.last_frame))
            elif variable.function is not None:
                self._compute(value, memory)
            if variable.invert:
                value.invert()
            if k in self._settable:
                self._upload(value, self._uniforms[k])
        for value, _ in own:
            value.words = value.constant

    def _compute(self, value: _Value, memory: Memory) -> None:
        variable = value.variable
        match variable.function:
            case "Pointer":
                source = memory.find(variable.arguments[0])
                if source is not None:
                    # SHADERed copies as much as the pointer holds, from what may hold less.
                    words = source.words[: len(value.words)]
                    value.words[: len(words)] = words
            case "CameraSnapshot":
                identity = np.eye(4).reshape(-1)
                value.words[:] = value.words_of(self._project.cameras.get(variable.arguments[0], identity))
            case "ObjectProperty":
                name, what = variable.arguments
                if name in self._project.places:
                    position, rotation, scale = self._project.places[name]
                    properties = {"Position": (*position, 1), "Rotation": (*rotation, 0), "Scale": (*scale, 0)}
                    value.words[:] = value.words_of(properties.get(what, (0,) * 4)[: len(value.words)])
            case _:
                computed = functions.compute(variable.function, variable.arguments, len(value.words))
                value.words[:] = value.words_of(computed)

    def _upload(self, value: _Value, uniform: str) -> None:
        """Hands the value to GL, unless it has it."""
        data = value.words.tobytes()
        if self._set.get(uniform) == data:
            return
        # One element: of an array SHADERed sets the first alone.
        self._program.set_uniform(uniform, _GL_TYPES[_as_set(value.variable)], value.words)
        self._set[uniform] = data


def _as_set(variable: Variable) -> str:
    """The GLSL type by which a variable is handed over: a bool goes as an integer."""
    if variable.type.base != "bool":
        return variable.type.glsl
    return "int" if variable.type.size == 1 else f"ivec{variable.type.size}"
