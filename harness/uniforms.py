"""What the uniforms of a pass are set to: constants, SHADERed's system values, values of single items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from . import camera as cameras
from . import native, transforms
from .errors import ProjectError
from .native import gl_enums
from .project import Geometry, Item, Number, Pass, Project, Variable, VariableType

_GL_TYPES = {name: enum for enum, name in gl_enums.GLSL_TYPE_NAMES.items()}

#: seconds between two frames, as SHADERed has it when it renders to a file
TIME_DELTA = 1 / 60
#: where SHADERed puts a ScreenQuad, on the far plane of its orthographic view
SCREEN_QUAD_Z = -1000.0


@dataclass(frozen=True)
class Frame:
    """What all items of a picture share: system value -> array, matrices as (row, column)."""

    width: int
    height: int
    values: Mapping[str, np.ndarray]


def frame(project: Project, width: int, height: int) -> Frame:
    """The system values of a picture of that size: the first frame, at time 0, mouse and keys at rest."""
    camera = project.settings.camera
    view, projection = cameras.view(camera), cameras.projection(width, height)
    orthographic = cameras.orthographic(width, height)
    position = cameras.position(camera)
    values = {
        "Time": 0.0,
        "TimeDelta": TIME_DELTA,
        "FrameIndex": 0,
        "ViewportSize": (width, height),
        "MousePosition": (0, 0),
        "Mouse": (0, 0, 0, 0),
        "MouseButton": (0, 0, 0, 0),
        "View": view,
        "Projection": projection,
        "ViewProjection": transforms.product(projection, view),
        "Orthographic": orthographic,
        "ViewOrthographic": transforms.product(orthographic, view),
        "IsPicked": False,
        "IsSavingToFile": True,
        "CameraPosition": (*position, 1),
        "CameraPosition3": position,
        "CameraDirection3": cameras.direction(camera),
        "KeysWASD": (0, 0, 0, 0),
        "PickPosition": (0, 0, 0),
    }
    return Frame(width, height, {name: np.asarray(value) for name, value in values.items()})


def item_matrix(item: Item, width: int, height: int) -> np.ndarray:
    """An item's GeometryTransform (4, 4). A ScreenQuad is placed in shares of the target, from its middle."""
    if isinstance(item, Geometry) and item.shape == "ScreenQuad":
        size = np.array([width, height], np.float32)
        x, y = (np.array(item.position[:2], np.float32) + np.float32(0.5)) * size
        scale = np.array(item.scale[:2], np.float32) * size
        return transforms.item_matrix((x, y, SCREEN_QUAD_Z), item.rotation, (*scale, 1))
    return transforms.item_matrix(item.position, item.rotation, item.scale)


class PassUniforms:
    """The variables of a pass that reach an active uniform of its program."""

    def __init__(self, project: Project, shader_pass: Pass, program: native.Program):
        """ProjectError when a variable's type is not that of its uniform."""
        self._program = program
        named = {v.name: v for v in shader_pass.variables}  # of two with one name the later holds
        #: the variables that are used, in order
        self.variables = [v for v in named.values() if v.name in program.uniforms]
        self._gl_types = {v.name: program.uniforms[v.name].type for v in self.variables}
        for variable in self.variables:
            in_shader = gl_enums.GLSL_TYPE_NAMES.get(self._gl_types[variable.name], "of another type")
            if in_shader != variable.type.glsl:
                raise ProjectError(
                    f'pass "{shader_pass.name}": variable "{variable.name}" has type {variable.type.name}, '
                    f"{variable.type.glsl} in GLSL, but the shader's uniform is {in_shader}",
                    project.file,
                    variable.line,
                )
        self._of_items: dict[str, list[tuple[Variable, tuple[Number, ...]]]] = {}
        for value in shader_pass.item_values:
            if any(value.variable is v for v in self.variables):
                self._of_items.setdefault(value.item, []).append((value.variable, value.value))

    def set_frame(self, frame: Frame) -> None:
        """Sets what all items of the pass share."""
        for variable in self.variables:
            if variable.system is None:
                self._set(variable, _constant(variable.type, variable.value))
            elif variable.system in frame.values:
                self._set_system(variable, frame.values[variable.system])

    def set_item(self, item: Item, frame: Frame) -> None:
        """Sets what is the item's own."""
        matrix = None
        for variable in self.variables:
            if variable.system == "GeometryTransform":
                matrix = item_matrix(item, frame.width, frame.height) if matrix is None else matrix
                self._set_system(variable, matrix)
        for variable, value in self._of_items.get(item.name, ()):
            self._set(variable, _constant(variable.type, value))

    def restore(self, item: Item) -> None:
        """Gives the pass's values back to what ``set_item`` changed."""
        for variable, _ in self._of_items.get(item.name, ()):
            self._set(variable, _constant(variable.type, variable.value))

    def _set_system(self, variable: Variable, value: np.ndarray) -> None:
        if variable.invert:
            value = transforms.inverse(value)
        self._set(variable, value.T)  # column by column; no change for vectors

    def _set(self, variable: Variable, value: np.ndarray) -> None:
        dtype = np.float32 if variable.type.name.startswith("float") else np.int32
        # One element: of an array SHADERed sets the first alone.
        self._program.set_uniform(variable.name, self._gl_types[variable.name], value.astype(dtype))


def _constant(variable_type: VariableType, value: tuple[Number, ...]) -> np.ndarray:
    return np.array(value).reshape(variable_type.rows, variable_type.columns)
