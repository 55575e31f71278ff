"""Numbers, truth values and texts as C reads them: the longest beginning that is a number, else 0."""

from __future__ import annotations

import math

import pytest
from sprj_files import line_of, read, refusal, row, shader_pass, variables, warned, write_project

from harness.projects.project import VARIABLE_TYPES


def project_with(folder, element: str):
    return write_project(folder, shader_pass(extra=variables(element)))


def value_of(project):
    return project.passes[0].variables[0].value


@pytest.mark.parametrize("name", VARIABLE_TYPES)
def test_a_variable_without_rows_is_zero(tmp_path, name):
    (variable,) = read(project_with(tmp_path, f'<variable type="{name}" name="v" />')).passes[0].variables
    assert variable.type.name == name and variable.value == (0,) * variable.type.size


@pytest.mark.parametrize(
    "text, value",
    [
        *[("0.7", 0.7), ("5e-1", 0.5), ("  0.75 ", 0.75), ("-.5", -0.5), ("+2.", 2.0), ("1E3", 1000.0)],
        *[("0x10", 16.0), ("0x1.8p1", 3.0), ("-0X.8", -0.5)],
    ],
)
def test_floats(tmp_path, text, value):
    assert value_of(read(project_with(tmp_path, f'<variable type="float" name="v">{row(text)}</variable>'))) == (value,)


@pytest.mark.parametrize(
    "text, value",
    [
        *[("", 0), ("0,5", 0), ("1.5f", 1.5), ("abc", 0), ("1_0", 1), ("1 2", 1), ("--1", 0), ("1e", 1), ("0x", 0)],
        *[("nan", math.nan), ("inf", math.inf), ("-Infinity", -math.inf), ("1e99", math.inf), ("-1e999", -math.inf)],
        ("1" * 10_000, math.inf),
    ],
)
def test_what_is_no_float_is_a_warning_in_its_line(tmp_path, text, value):
    path = project_with(tmp_path, f'<variable type="float" name="v">\n{row(text)}\n</variable>')
    project, warning = warned(path)
    assert value_of(project) == pytest.approx((value,), nan_ok=True)
    assert warning.line == line_of(path, "<row>")
    assert warning.message.startswith('a value of variable "v" of pass "Quad" is "')
    assert f"of which SHADERed makes {value:g}" in warning.message


@pytest.mark.parametrize("text, value", [("7", 7), (" -8 ", -8), ("0x1F", 31), ("+5", 5), ("2147483647", 2**31 - 1)])
def test_ints(tmp_path, text, value):
    assert value_of(read(project_with(tmp_path, f'<variable type="int" name="v">{row(text)}</variable>'))) == (value,)


@pytest.mark.parametrize(
    "text, value",
    [
        *[("", 0), ("1.5", 1), ("1e3", 1), ("x", 0), ("0xg", 0), ("2147483648", 2**31 - 1)],
        *[("-99999999999999999999999", -(2**31)), ("9" * 10_000, 2**31 - 1)],
    ],
)
def test_what_is_no_int_is_a_warning(tmp_path, text, value):
    project, warning = warned(project_with(tmp_path, f'<variable type="int" name="v">{row(text)}</variable>'))
    assert value_of(project) == (value,)
    assert warning.message.endswith(f"of which SHADERed makes {value}")


def test_truth_is_the_first_character(tmp_path):
    element = f'<variable type="bool4" name="v">{row("1", "Yes", "True", "no")}</variable>'
    assert value_of(read(project_with(tmp_path, element))) == (True, True, True, False)


def test_a_row_of_a_matrix_is_a_glsl_column(tmp_path):
    # GLSL's m[0] is (1, 2), the first row of the file, and column by column is the order of upload.
    element = f'<variable type="float2x2" name="m">{row(1, 2)}{row(3, 4)}</variable>'
    assert value_of(read(project_with(tmp_path, element))) == (1, 2, 3, 4)


def test_a_long_row_runs_on_into_the_next(tmp_path):
    element = f'<variable type="float2x2" name="m">{row(1, 2, 3, 4)}</variable>'
    project, warning = warned(project_with(tmp_path, element))
    assert value_of(project) == (1, 2, 3, 4) and "more values than a float2x2 has in a row" in warning.message


def test_rows_of_integers_are_all_the_first(tmp_path):
    project, warning = warned(project_with(tmp_path, f'<variable type="int2" name="v">{row(1, 2)}{row(3)}</variable>'))
    assert value_of(project) == (3, 2) and "more rows" in warning.message


def test_a_value_outside_a_row_is_not_read(tmp_path):
    project, warning = warned(project_with(tmp_path, '<variable type="float" name="v"><value>3</value></variable>'))
    assert value_of(project) == (0,) and "outside a <row> is not read" in warning.message


@pytest.mark.parametrize("rows", [row(1, 2, 3), row(1, 2) + row(3)])
def test_values_beyond_the_variable_are_an_error(tmp_path, rows):
    # There SHADERed would write into memory that is another's.
    path = project_with(tmp_path, f'<variable type="float2" name="v">{rows}</variable>')
    assert "more values than a float2 (1 x 2) holds" in refusal(path).message


@pytest.mark.parametrize(
    "extra",
    [
        variables(f'<variable type="float" name="{"v" * 64}" />'),
        f'<macros><define name="{"N" * 32}">1</define></macros>',
        f'<macros><define name="N">{"1" * 512}</define></macros>',
        f'<shader type="ps" path="{"p" * 512}" entry="main" />',
        variables(f'<variable type="float3" name="v" function="Pointer">{row("w" * 64)}</variable>'),
    ],
)
def test_texts_that_overflow_shadered_s_buffers(tmp_path, extra):
    assert "more than SHADERed can hold" in refusal(write_project(tmp_path, shader_pass(extra=extra))).message
