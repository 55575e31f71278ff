"""Reads the variables of a pass, the values of single items, and the pass's macros."""

from __future__ import annotations

from .project import (
    FUNCTIONS,
    NAME_FUNCTIONS,
    SYSTEM_TYPES,
    VARIABLE_TYPES,
    ItemValue,
    Macro,
    Variable,
    VariableType,
)
from .sprj_values import (
    MACRO_NAME_LIMIT,
    MACRO_VALUE_LIMIT,
    NAME_LIMIT,
    choice,
    flag,
    limited,
    real,
    values,
)
from .xml_lines import Element


def read_variables(elements: list[Element], pass_name: str) -> tuple[Variable, ...]:
    """The variables of a pass, in order."""
    return tuple(read_variable(element, pass_name) for element in elements)


def read_variable(element: Element, pass_name: str) -> Variable:
    """One ``<variable>``."""
    name = limited(element, element.get("name"), NAME_LIMIT, "the name of the variable")
    what = f'variable "{name}" of pass "{pass_name}"'
    written_type = choice(element, element.get("type"), tuple(VARIABLE_TYPES), "float", f"the type of {what}")
    variable_type = VARIABLE_TYPES[written_type]
    system = _system(element, variable_type, what)
    function = _function(element, variable_type, system, what)
    invert = flag(element, "invert", False)
    if invert and variable_type.rows == 1:
        element.warn(f"{what}: invert does nothing to a {variable_type.name}")
        invert = False
    if invert and system is None and function is None:
        element.warn(f"{what}: a constant is inverted again at each draw: every second item gets the matrix itself")
    last_frame = flag(element, "lastframe", False)
    if last_frame and system is None:
        element.warn(f"{what}: lastframe does nothing without a system value")
    return Variable(
        name=name,
        type=variable_type,
        value=values(element, variable_type, what) if system is None and function is None else (),
        system=system,
        invert=invert,
        line=element.line,
        last_frame=last_frame and system is not None,
        function=function,
        arguments=_arguments(element, function, what),
    )


def _system(element: Element, variable_type: VariableType, what: str) -> str | None:
    system = element.attributes.get("system")
    if not system or system == "--NONE--":
        return None
    if system == "PluginVariable":
        raise element.error(f'{what}: the system value "{system}" is not supported')
    if system not in SYSTEM_TYPES:
        element.warn(f'{what}: there is no system value "{system}"; SHADERed leaves it at its constant')
        return None
    if SYSTEM_TYPES[system] != variable_type.name:
        element.warn(
            f"{what}: the system value {system} is of type {SYSTEM_TYPES[system]}, not {variable_type.name}: "
            "SHADERed leaves it at its constant"
        )
        return None
    return system


def _function(element: Element, variable_type: VariableType, system: str | None, what: str) -> str | None:
    function = element.attributes.get("function")
    if not function or function == "None":
        return None
    if function == "PluginFunction":
        raise element.error(f'{what}: the function "{function}" is not supported')
    if function not in FUNCTIONS | NAME_FUNCTIONS:
        element.warn(f'{what}: there is no function "{function}"; SHADERed leaves it at its constant')
        return None
    _, types = (FUNCTIONS | NAME_FUNCTIONS)[function]
    if system is not None:
        element.warn(f"{what}: the function {function} does nothing beside a system value")
        return None
    if variable_type.name not in types:
        element.warn(
            f"{what}: the function {function} gives {' or '.join(types)}, not {variable_type.name}: "
            "SHADERed takes its arguments for a constant"
        )
        return None
    if function == "MatrixRotationRollPitchYaw":
        element.warn(f"{what}: SHADERed does not compute {function} and shows whatever is in memory; here it is 0")
    return function


def _arguments(element: Element, function: str | None, what: str) -> tuple[float, ...] | tuple[str, ...]:
    """The ``<value>``s of the last row that has them; SHADERed's defaults, where the file gives fewer, are 0."""
    if function is None:
        return ()
    count, _ = (FUNCTIONS | NAME_FUNCTIONS)[function]
    by_name = function in NAME_FUNCTIONS
    given: list = ["" if by_name else 0.0] * count
    for row in element.all("row"):
        for k, value in enumerate(row.all("value")):
            if by_name:
                # All but the first name of an item go to the same place.
                given[min(k, count - 1)] = limited(value, value.text, NAME_LIMIT, f"a name in {what}")
            elif k >= count:
                raise value.error(f"{what} has more arguments than {function} takes ({count})")
            else:
                given[k] = real(value, value.text, f"an argument of {what}")
    return tuple(given)


def read_item_values(
    elements: list[Element], pass_name: str, variables: tuple[Variable, ...], items: list[str]
) -> tuple[ItemValue, ...]:
    """The values of single items. SHADERed leaves out those for what is not in the pass."""
    found = []
    for value in elements:
        of, item = value.get("variable"), value.get("for")
        what = f'variable "{of}" for item "{item}" of pass "{pass_name}"'
        variable = next((v for v in variables if v.name == of), None)
        if variable is None or item not in items:
            missing = f'variable "{of}"' if variable is None else f'item "{item}"'
            value.warn(f"{what}: the pass has no {missing}; SHADERed leaves the value out")
        elif variable.function is not None:
            raise value.error(f"{what}: the variable has a function, and SHADERed crashes on a value of its own")
        elif variable.system is not None:
            value.warn(f"{what}: the variable has a system value, and a value of its own does nothing")
        else:
            found.append(ItemValue(variable, item, values(value, variable.type, what), value.line))
    return tuple(found)


def read_macros(elements: list[Element], pass_name: str) -> tuple[Macro, ...]:
    """The active macros of a pass."""
    macros: dict[str, Macro] = {}
    for define in elements:
        if not flag(define, "active", True):
            continue
        what = f'macro of pass "{pass_name}"'
        macro = Macro(
            name=limited(define, define.get("name"), MACRO_NAME_LIMIT, f"the name of a {what}"),
            value=limited(define, define.text, MACRO_VALUE_LIMIT, f"the value of a {what}"),
            line=define.line,
        )
        if not macro.name.strip():
            raise define.error(f"a {what} has no name")
        other = macros.setdefault(macro.name, macro)
        if other.value != macro.value:
            raise define.error(f'pass "{pass_name}" defines the macro "{macro.name}" twice, first in line {other.line}')
    return tuple(macros.values())
