"""Variables, values of single items, and macros, as the reader gives them."""

from __future__ import annotations

import pytest
from sprj_files import constant, line_of, read, refusal, row, shader_pass, variables, warned, write_project

from harness.projects.project import FUNCTIONS, NAME_FUNCTIONS


def project_with(folder, *elements: str):
    return write_project(folder, shader_pass(extra=variables(*elements)))


def variable_of(project):
    return project.passes[0].variables[-1]


def test_a_system_value(tmp_path):
    element = '<variable type="float4x4" name="v" system="View" invert="true" lastframe="true" />'
    variable = variable_of(read(project_with(tmp_path, element)))
    assert (variable.system, variable.invert, variable.last_frame) == ("View", True, True)


@pytest.mark.parametrize(
    "attributes, words",
    [
        ('type="float" system="CameraPosition3"', "CameraPosition3 is of type float3, not float"),
        ('type="float" system="Clock"', 'there is no system value "Clock"'),
        ('type="float" function="Square"', 'there is no function "Square"'),
        ('type="float" function="MatrixScaling"', "MatrixScaling gives float4x4, not float"),
        ('type="float5"', 'the type of variable "v" of pass "Quad" is "float5", of which SHADERed makes float'),
        ('type="float" invert="true"', "invert does nothing to a float"),
        ('type="float" lastframe="true"', "lastframe does nothing without a system value"),
    ],
)
def test_what_shadered_leaves_out_is_a_warning(tmp_path, attributes, words):
    path = project_with(tmp_path, f'<variable {attributes} name="v" />')
    project, warning = warned(path)
    variable = variable_of(project)
    assert words in warning.message and warning.line == line_of(path, 'name="v"')
    assert (variable.type.name, variable.value, variable.system, variable.function) == ("float", (0,), None, None)
    assert not variable.invert and not variable.last_frame


def test_a_function_beside_a_system_value_does_nothing(tmp_path):
    project, warning = warned(
        project_with(tmp_path, '<variable type="float4x4" name="v" system="View" function="MatrixIdentity" />')
    )
    assert variable_of(project).function is None and "does nothing beside a system value" in warning.message


def test_the_arguments_of_a_function_without_its_type_are_a_constant(tmp_path):
    element = f'<variable type="float3" name="v" function="MatrixScaling">{row(1, 2, 3)}</variable>'
    project, _ = warned(project_with(tmp_path, element))
    assert variable_of(project).value == (1, 2, 3)


@pytest.mark.parametrize("function", [f for f in FUNCTIONS if f != "MatrixRotationRollPitchYaw"])
def test_missing_arguments_are_0_and_others_too_many(tmp_path, function):
    count, types = FUNCTIONS[function]
    start = f'<variable type="{types[0]}" name="v" function="{function}">'
    given = read(project_with(tmp_path, f"{start}{row(*[7][:count])}</variable>"))
    assert variable_of(given).arguments == ((7.0,) + (0.0,) * (count - 1) if count else ())
    error = refusal(project_with(tmp_path, f"{start}{row(*range(count + 1))}</variable>"))
    assert f"more arguments than {function} takes ({count})" in error.message


def test_roll_pitch_yaw_is_not_computed(tmp_path):
    element = '<variable type="float4x4" name="v" function="MatrixRotationRollPitchYaw" />'
    _, warning = warned(project_with(tmp_path, element))
    assert "SHADERed does not compute MatrixRotationRollPitchYaw" in warning.message


@pytest.mark.parametrize("function", NAME_FUNCTIONS)
def test_names_that_there_are_not(tmp_path, function):
    count, types = NAME_FUNCTIONS[function]
    names = row(*("gone", "Position")[:count])
    element = f'<variable type="{types[-1]}" name="v" function="{function}">{names}</variable>'
    _, warning = warned(project_with(tmp_path, element))
    assert 'variable "v" of pass "Quad": there is no' in warning.message and '"gone"' in warning.message


def test_names_that_there_are(tmp_path):
    path = project_with(
        tmp_path,
        constant("source", "float3", 1, 2, 3),
        f'<variable type="float3" name="p" function="Pointer">{row("source")}</variable>',
        f'<variable type="float3" name="o" function="ObjectProperty">{row("QuadItem", "Scale")}</variable>',
    )
    assert [v.arguments for v in read(path).passes[0].variables] == [(), ("source",), ("QuadItem", "Scale")]


def test_an_inverted_constant_is_a_warning(tmp_path):
    project, warning = warned(project_with(tmp_path, '<variable type="float4x4" name="v" invert="true" />'))
    assert variable_of(project).invert and "inverted again at each draw" in warning.message


@pytest.mark.parametrize(
    "attributes, word", [('system="PluginVariable"', "PluginVariable"), ('function="PluginFunction"', "PluginFunction")]
)
def test_values_of_plugins_are_not_supported(tmp_path, attributes, word):
    path = project_with(tmp_path, f'<variable type="float" name="v" {attributes} />')
    error = refusal(path)
    assert word in error.message and "not supported" in error.message and error.line == line_of(path, 'name="v"')


# ---- Values of single items ------------------------------------------------------------------------------------------


def with_item_value(folder, attributes: str, *elements: str):
    values = f"<itemvalues>\n<value {attributes}>{row(4)}</value>\n</itemvalues>"
    return write_project(folder, shader_pass(extra=variables(*elements) + values))


def test_a_value_of_an_item(tmp_path):
    path = with_item_value(tmp_path, 'variable="v" for="QuadItem"', '<variable type="float" name="v" />')
    (found,) = read(path).passes[0].item_values
    assert (found.variable.name, found.item, found.value, found.line) == (
        "v",
        "QuadItem",
        (4,),
        line_of(path, "<value v"),
    )


@pytest.mark.parametrize(
    "attributes, words",
    [
        ('variable="w" for="QuadItem"', 'the pass has no variable "w"'),
        ('variable="v" for="quaditem"', 'the pass has no item "quaditem"'),
        ('variable="t" for="QuadItem"', "has a system value"),
    ],
)
def test_item_values_for_what_is_not_in_the_pass_are_left_out(tmp_path, attributes, words):
    elements = '<variable type="float" name="v" />', '<variable type="float" name="t" system="Time" />'
    project, warning = warned(with_item_value(tmp_path, attributes, *elements))
    assert project.passes[0].item_values == () and words in warning.message


def test_an_item_value_of_a_function_crashes_shadered(tmp_path):
    path = with_item_value(
        tmp_path, 'variable="v" for="QuadItem"', '<variable type="float" name="v" function="ScalarSin" />'
    )
    assert "SHADERed crashes" in refusal(path).message


# ---- Macros ----------------------------------------------------------------------------------------------------------


def test_only_active_macros_are_read(tmp_path):
    extra = """<macros><define name="A" active="true">1</define><define name="B" active="false">2</define>
<define name="C">vec3(1.0)</define><define name="D" active="true"></define>
<define name="F(x)">(x)</define></macros>"""
    macros = read(write_project(tmp_path, shader_pass(extra=extra))).passes[0].macros
    assert [(m.name, m.value) for m in macros] == [("A", "1"), ("C", "vec3(1.0)"), ("D", ""), ("F(x)", "(x)")]


def test_a_macro_with_two_values(tmp_path):
    extra = '<macros>\n<define name="N">1</define>\n<define name="N">2</define>\n</macros>'
    path = write_project(tmp_path, shader_pass(extra=extra))
    first = line_of(path, ">1</define>")
    assert refusal(path).message == f'pass "Quad" defines the macro "N" twice, first in line {first}'
