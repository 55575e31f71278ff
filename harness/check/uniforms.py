"""Checks variables against uniforms: names, types, system values, values of items, and how values are written."""

from __future__ import annotations

import re

from ..errors import did_you_mean
from ..native import Stage, gl_enums
from ..projects.project import SYSTEM_TYPES, VARIABLE_TYPES
from ..projects.xml_lines import Element
from . import declarations
from .declarations import Declared
from .state import PassState, State, flag
from .structure import read_number

#: functions that compute a variable -> the types that it can have, None for any
_MATRIX = ("float4x4",)
FUNCTIONS: dict[str, tuple[str, ...] | None] = {
    "Pointer": None,
    "CameraSnapshot": _MATRIX,
    "ObjectProperty": ("float3", "float4"),
    "ScalarSin": ("float",),
    "ScalarCos": ("float",),
    "VectorNormalize": ("float2", "float3", "float4"),
} | {
    f"Matrix{name}": _MATRIX
    for name in (
        *("Identity", "Translation", "Scaling", "RotationX", "RotationY", "RotationZ", "RotationAxis", "LookAtLH"),
        *("LookToLH", "PerspectiveFovLH", "OrthographicLH", "PerspectiveLH", "RotationNormal", "RotationRollPitchYaw"),
    )
}


def check(state: State) -> None:
    """Checks the variables of all passes; against the uniforms only where the pass compiles."""
    for shader_pass in state.passes:
        for variable in shader_pass.variables:
            _check_variable(state, shader_pass, variable)
        _check_equal_names(state, shader_pass)
        _check_item_values(state, shader_pass)
        _check_macros(state, shader_pass)
        if shader_pass.program is not None:
            _check_uniforms(state, shader_pass)


def _what(shader_pass: PassState, variable: Element) -> str:
    return f'variable "{variable.attributes.get("name", "")}" of pass "{shader_pass.name}"'


def _check_variable(state: State, shader_pass: PassState, variable: Element) -> None:
    what, kind = _what(shader_pass, variable), variable.attributes.get("type", "")
    if kind not in VARIABLE_TYPES:
        state.add(
            "HS211",
            variable,
            f'{what}: there is no type "{kind}"; SHADERed takes float for it',
            f"write one of {', '.join(VARIABLE_TYPES)}",
        )
        kind = "float"
    system, function = variable.attributes.get("system", ""), variable.attributes.get("function", "")
    if system and system not in ("--NONE--", "PluginVariable"):
        if system not in SYSTEM_TYPES:
            hint = did_you_mean(system, SYSTEM_TYPES)
            state.add("HS205", variable, f'{what}: there is no system value "{system}"{hint}', "correct its name")
        elif SYSTEM_TYPES[system] != kind:
            state.add(
                "HS205",
                variable,
                f"{what}: the system value {system} is a {SYSTEM_TYPES[system]}, not a {kind}",
                f'write type="{SYSTEM_TYPES[system]}", in the shader too',
            )
    elif function and function not in ("None", "PluginFunction"):
        if function not in FUNCTIONS:
            hint = did_you_mean(function, FUNCTIONS)
            state.add("HS205", variable, f'{what}: there is no function "{function}"{hint}', "correct its name")
        elif FUNCTIONS[function] and kind not in FUNCTIONS[function]:
            types = " or ".join(FUNCTIONS[function])
            state.add(
                "HS205", variable, f"{what}: the function {function} gives {types}, not {kind}", f"make it a {types}"
            )
    else:
        _check_values(state, variable, kind, what)
        drawn = [i for i in shader_pass.items if i.attributes.get("type") != "renderstate"]
        if flag(variable, "invert") and VARIABLE_TYPES[kind].rows > 1 and len(drawn) > 1:
            state.add("HS212", variable, f"{what} is constant and inverted", "write the inverse and leave out invert")


def _check_values(state: State, at: Element, kind: str, what: str) -> None:
    """The rows of a constant: numbers that SHADERed does not read, too many, or out of place."""
    wanted = VARIABLE_TYPES[kind]
    if at.all("value"):
        state.add("HS211", at.all("value")[0], f"{what}: a <value> outside a <row> is not read", "put it in a <row>")
    rows = at.all("row")
    if len(rows) > wanted.rows or any(len(row.all("value")) > wanted.columns for row in rows):
        state.add(
            "HS211",
            at,
            f"{what}: more values than a {kind} has ({wanted.rows} x {wanted.columns})",
            "leave out what is too much: it overwrites other values",
        )
    if kind.startswith("bool"):
        return
    for value in (v for row in rows for v in row.all("value")):
        number = read_number(value.text)
        if number is None or (kind.startswith("int") and number != int(number)):
            state.add(
                "HS211",
                value,
                f'{what}: "{value.text.strip()}" is not {"an integer" if kind.startswith("int") else "a number"}',
                "write it with a point and digits only, such as 0.5 or 5e-1",
            )


def _check_equal_names(state: State, shader_pass: PassState) -> None:
    seen: dict[str, int] = {}
    for variable in shader_pass.variables:
        name = variable.attributes.get("name", "")
        if name in seen:
            state.add(
                "HS207",
                variable,
                f"{_what(shader_pass, variable)} is there twice, first in line {seen[name]}",
                "remove one of the two",
            )
        seen[name] = variable.line


def _check_item_values(state: State, shader_pass: PassState) -> None:
    variables = {v.attributes.get("name", ""): v for v in shader_pass.variables}
    items = [i.attributes.get("name", "") for i in shader_pass.items]
    for value in shader_pass.element.nested("itemvalues", "value"):
        of, item = value.attributes.get("variable", ""), value.attributes.get("for", "")
        what = f'variable "{of}" for item "{item}" of pass "{shader_pass.name}"'
        variable = variables.get(of)
        if variable is None or item not in items:
            missing = f'variable "{of}"' if variable is None else f'item "{item}"'
            hint = did_you_mean(of, variables) if variable is None else did_you_mean(item, items)
            state.add("HS210", value, f"{what}: the pass has no {missing}{hint}", "correct the name")
        elif variable.attributes.get("function", "None") not in ("", "None"):
            state.add(
                "HS004",
                value,
                f"{what}: the variable has a function, and SHADERed crashes on a value of its own",
                "make it a constant, or leave the value out",
            )
        elif variable.attributes.get("system", "--NONE--") not in ("", "--NONE--"):
            state.add("HS210", value, f"{what}: the variable has a system value", "leave the value out")
        else:
            kind = variable.attributes.get("type", "")
            _check_values(state, value, kind if kind in VARIABLE_TYPES else "float", what)


def _check_macros(state: State, shader_pass: PassState) -> None:
    """Macros that no shader of the pass mentions."""
    if not shader_pass.sources or not shader_pass.is_complete:
        return
    own = {d.attributes.get("name", ""): d for d in shader_pass.macros}
    words: set[str] = set()
    for source in shader_pass.sources.values():
        for text, (file, _) in zip(source.text.split("\n"), source.origins, strict=False):
            words.update(re.findall(r"\w+", text) if file != "macros" else re.findall(r"\w+", text)[2:])
    for name, define in own.items():
        if re.match(r"\w*", name)[0] not in words:
            hint = did_you_mean(name, [w for w in words if w.isupper() and len(w) > 3])
            state.add(
                "HS604",
                define,
                f'no shader of pass "{shader_pass.name}" mentions the macro "{name}"{hint}',
                "correct its name, or remove it",
            )


def _check_uniforms(state: State, shader_pass: PassState) -> None:
    active = {n: u for n, u in shader_pass.program.uniforms.items() if not n.startswith("gl_")}
    declared: dict[str, tuple[Stage, Declared]] = {}
    for stage, text in shader_pass.preprocessed.items():
        for name, found in declarations.uniforms(text).items():
            declared.setdefault(name, (stage, found))
    variables = {v.attributes.get("name", ""): v for v in shader_pass.variables}
    for name, variable in variables.items():
        _check_one(state, shader_pass, name, variable, active, declared)
    told = set()
    for name, uniform in active.items():
        kind = gl_enums.GLSL_TYPE_NAMES.get(uniform.type, "sampler")
        base = re.match(r"\w+", name)[0]
        at = _place(shader_pass, declared, base)
        if uniform.location < 0:
            block = _block(shader_pass, name)
            if block not in told:
                message = f'pass "{shader_pass.name}" reads "{name}" of a uniform block'
                state.add("HS209", block or at, message, "declare its members as uniforms of their own")
            told.add(block)
        elif kind in _GLSL_TYPES:
            _check_active(state, shader_pass, name, uniform, kind, variables, at)
            initialiser = declared[base][1].initialiser if base in declared else ""
            if initialiser and base not in told:
                told.add(base)
                state.add(
                    "HS206",
                    at,
                    f'the uniform "{base}" has the initialiser {initialiser}',
                    "give a variable that value and leave the initialiser out",
                )


_GLSL_TYPES = {kind.glsl for kind in VARIABLE_TYPES.values()} | {"uint", "uvec2", "uvec3", "uvec4"}


def _place(shader_pass: PassState, declared: dict, base: str) -> Element | tuple[str, int]:
    if base not in declared:
        return shader_pass.element
    stage, found = declared[base]
    return shader_pass.sources[stage].origin(found.line)


def _block(shader_pass: PassState, name: str) -> tuple[str, int] | None:
    """Where the block with a member of that name is declared."""
    member = re.match(r"\w+", name.rpartition(".")[2])[0]
    for stage, text in shader_pass.preprocessed.items():
        for line, body in declarations.blocks(text):
            if re.search(rf"\b{member}\b", body):
                return shader_pass.sources[stage].origin(line)
    return None


def _check_one(
    state: State, shader_pass: PassState, name: str, variable: Element, active: dict, declared: dict
) -> None:
    what = _what(shader_pass, variable)
    kind = VARIABLE_TYPES.get(variable.attributes.get("type", ""), VARIABLE_TYPES["float"])
    if name in active:
        in_shader = gl_enums.GLSL_TYPE_NAMES.get(active[name].type, "of another type")
        if not _takes(in_shader, kind):
            fitting = next((t.name for t in VARIABLE_TYPES.values() if t.glsl == in_shader), None)
            state.add(
                "HS201",
                variable,
                f"{what} has type {kind.name}, {kind.glsl} in GLSL, but the shader's uniform is {in_shader}",
                f'write type="{fitting}"' if fitting else f"declare the uniform as {kind.glsl}",
            )
        return
    base = re.match(r"\w*", name)[0]
    if base not in declared:
        hint = did_you_mean(name, [n for n in active if n not in _names(shader_pass)])
        state.add("HS203", variable, f"{what}: no shader of the pass has such a uniform{hint}", "correct or remove it")
    elif f"{name}[0]" in active or re.search(r"\[[1-9]\d*\]$", name):
        state.add("HS203", variable, f'{what}: of an array SHADERed sets "{base}[0]" alone', f"name it {base}[0]")
    else:
        state.add("HS204", variable, f"{what} has no effect: the uniform is declared but not used", "remove it")


def _names(shader_pass: PassState) -> set[str]:
    """The names of a pass's variables."""
    return {v.attributes.get("name", "") for v in shader_pass.variables}


def _takes(in_shader: str, kind) -> bool:
    """Whether GL sets a uniform by a variable: any number sets a bool, and a bool is given as an integer."""
    alike = {kind.glsl}
    if kind.rows == 1:
        alike.add("bool" if kind.columns == 1 else f"bvec{kind.columns}")
        if kind.name.startswith("bool"):
            alike.add("int" if kind.columns == 1 else f"ivec{kind.columns}")
    return in_shader in alike


def _check_active(
    state: State, shader_pass: PassState, name: str, uniform, kind: str, variables: dict, at: Element | tuple[str, int]
) -> None:
    fitting = next((t.name for t in VARIABLE_TYPES.values() if t.glsl == kind), None)
    if name not in variables:
        hint = did_you_mean(name, [v for v in variables if v not in shader_pass.program.uniforms])
        state.add(
            "HS202",
            at,
            f'the uniform {kind} "{name}" of pass "{shader_pass.name}" has no variable{hint}',
            f'add <variable type="{fitting}" name="{name}"> to the pass'
            if fitting
            else "use int: no variable is a uint",
        )
    if uniform.size > 1 and name.endswith("[0]"):
        state.add(
            "HS208",
            at,
            f'elements 1 to {uniform.size - 1} of the uniform array "{name[:-3]}" of pass "{shader_pass.name}" stay 0',
            "use uniforms of their own, or an array of structs",
        )
