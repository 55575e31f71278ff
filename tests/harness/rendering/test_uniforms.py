"""What reaches the uniforms of a pass: constants, system values, functions, values of items."""

from __future__ import annotations

import numpy as np
import pytest
from sprj_files import (
    QUAD_VERT,
    SIZE,
    constant,
    drawn,
    first_floats,
    floats,
    item,
    line_of,
    row,
    shader_pass,
    texture,
    variables,
    write_project,
    write_quad,
    write_texture,
)

from harness import ProjectError
from harness.projects.project import SYSTEM_TYPES
from harness.rendering.render import Renderer, render

#: looks along +z from 6 away
CAMERA = """<entry type="usealpha" val="true" /><entry type="camera" fp="false"><distance>6</distance>
<pitch>0</pitch><yaw>0</yaw><roll>0</roll></entry>"""


@pytest.mark.parametrize(
    "system, glsl, read, expected",
    [
        ("Time", "float", "vec4(v)", (0, 0, 0, 0)),
        ("TimeDelta", "float", "vec4(v)", [1 / 60] * 4),
        ("FrameIndex", "int", "vec4(float(v))", (0, 0, 0, 0)),
        ("ViewportSize", "vec2", "v.xyxy", (4, 3, 4, 3)),
        ("MousePosition", "vec2", "v.xyxy", (0, 0, 0, 0)),
        ("Mouse", "vec4", "v", (0, 0, 0, 0)),
        ("MouseButton", "vec4", "v", (0, 0, 0, 0)),
        ("IsPicked", "bool", "vec4(float(v))", (0, 0, 0, 0)),
        ("IsSavingToFile", "bool", "vec4(float(v))", (1, 1, 1, 1)),
        ("CameraPosition", "vec4", "v", (0, 0, -6, 1)),
        ("CameraPosition3", "vec3", "v.xyzz", (0, 0, -6, -6)),
        ("CameraDirection3", "vec3", "v.xyzz", (0, 0, 6, 6)),
        ("KeysWASD", "ivec4", "vec4(v)", (0, 0, 0, 0)),
        ("PickPosition", "vec3", "v.xyzz", (0, 0, 0, 0)),
        # The camera is 6 away on -z: it sees (0, 0, 0) at depth 6, and x turned round.
        ("View", "mat4", "v * vec4(1.0, 2.0, 0.0, 1.0)", (-1, 2, -6, 1)),
        # m11 = 1 / tan 22.5 degrees = 2.41421, m00 = m11 / (4/3)
        ("Projection", "mat4", "vec4(v[0][0], v[1][1], v[2][3], v[3][3])", (1.81066, 2.41421, -1, 0)),
        ("ViewProjection", "mat4", "v * vec4(1.0, 1.0, 0.0, 1.0)", (-1.81066, 2.41421, 5.8012, 6)),
        ("Orthographic", "mat4", "v * vec4(4.0, 3.0, -0.1, 1.0)", (1, -1, -1, 1)),
        ("ViewOrthographic", "mat4", "vec4(v[0][0], v[1][1], v[2][2], v[3][3])", (-0.5, -2 / 3, 0.0020002, 1)),
        ("GeometryTransform", "mat4", "v * vec4(1.0)", (3, 1, 1, 1)),
    ],
)
def test_system_values(tmp_path, system, glsl, read, expected):
    extra = variables(f'<variable type="{SYSTEM_TYPES[system]}" name="v" system="{system}" />')
    path = write_quad(tmp_path, f"color = {read};", f"uniform {glsl} v;", extra=extra, settings=CAMERA)
    path.write_text(path.read_text().replace("<type>ScreenQuadNDC</type>", "<type>ScreenQuadNDC</type><x>2</x>"))
    np.testing.assert_allclose(first_floats(path), expected, atol=1e-4)


def test_invert_gives_the_inverse_of_the_item_s_matrix(tmp_path):
    extra = variables(
        '<variable type="float4x4" name="m" system="GeometryTransform" />',
        '<variable type="float4x4" name="i" system="GeometryTransform" invert="true" />',
    )
    read = "mat4 p = m * i; color = vec4(p[0][0], p[1][2], p[3][1], i[3][0]);"
    path = write_quad(tmp_path, read, "uniform mat4 m, i;", extra=extra)
    turned = "<type>ScreenQuadNDC</type><x>2</x><scaleX>4</scaleX>"
    path.write_text(path.read_text().replace("<type>ScreenQuadNDC</type>", turned))
    np.testing.assert_allclose(first_floats(path)[:3], (1, 0, 0), atol=1e-6)


def test_of_two_variables_of_one_name_the_later_holds(tmp_path):
    extra = variables(constant("v", "float", 1), constant("v", "float", 2))
    assert first_floats(write_quad(tmp_path, "color = vec4(v);", "uniform float v;", extra=extra))[0] == 2


def test_of_an_array_the_first_element_is_set(tmp_path):
    extra = variables(constant("v[0]", "float", 5))
    read = "color = vec4(v[0], v[1], v[int(uv.x)], 1.0);"
    path = write_quad(tmp_path, read, "uniform float v[3];", extra=extra)
    np.testing.assert_array_equal(first_floats(path)[:3], (5, 0, 5))


def test_a_variable_that_no_shader_has_is_harmless(tmp_path):
    path = write_quad(tmp_path, "", extra=variables(constant("nothing", "float3", 1, 2, 3)))
    assert render(path, SIZE).any()


def test_an_initialiser_holds_without_a_variable(tmp_path):
    assert first_floats(write_quad(tmp_path, "color = vec4(v);", "uniform float v = 0.5;"))[0] == 0.5


def test_an_item_s_value_holds_for_that_item_only(tmp_path):
    # Three thirds of the picture, one item each, drawn in order; the second has a value of its own.
    vert = QUAD_VERT.replace("uniform", "").replace("void main", "uniform mat4 model;\nvoid main")
    vert = vert.replace("vec4(position, 0.0, 1.0)", "model * vec4(position, 0.0, 1.0)")
    items = "".join(
        f'<item name="I{n}" type="geometry"><type>ScreenQuadNDC</type><scaleX>0.3</scaleX><x>{x}</x></item>'
        for n, x in enumerate((-0.66, 0, 0.66))
    )
    extra = variables('<variable type="float4x4" name="model" system="GeometryTransform" />', constant("v", "float", 1))
    extra += '<itemvalues><value variable="v" for="I1"><row><value>2</value></row></value></itemvalues>'
    write_quad(tmp_path, "color = vec4(v);", "uniform float v;")
    (tmp_path / "quad.vert").write_text(vert)
    path = write_project(tmp_path, shader_pass(items=items, extra=extra))
    np.testing.assert_array_equal(floats(path, (3, 1))[0, :, 0], (1, 2, 1))


@pytest.mark.parametrize(
    "project_type, glsl_type",
    [("float", "vec3"), ("int", "float"), ("float", "int"), ("int", "uint"), ("float3x3", "mat4")],
)
def test_a_type_that_is_not_the_shader_s_is_refused(tmp_path, project_type, glsl_type):
    zero = f"{glsl_type}(0)"
    path = write_quad(
        tmp_path,
        f"color = vec4(v == {zero});",
        f"uniform {glsl_type} v;",
        extra="\n" + variables(f'<variable type="{project_type}" name="v" />'),
    )
    with pytest.raises(ProjectError) as caught:
        render(path, SIZE)
    message = caught.value.message
    assert message.startswith(f'pass "Quad": variable "v" has type {project_type}, ')
    assert message.endswith(f"but the shader's uniform is {glsl_type}")
    assert caught.value.line == line_of(path, 'name="v"')


def test_macros_reach_both_stages(tmp_path):
    write_quad(tmp_path, "color = vec4(LEVEL, from_vertex, float(SHADERED_VERSION), 1.0);", "in float from_vertex;")
    vert = QUAD_VERT.replace("out vec2 uv;", "out vec2 uv;\nout float from_vertex;")
    (tmp_path / "quad.vert").write_text(vert.replace("uv = texcoord;", "uv = texcoord;\nfrom_vertex = 2.0 * LEVEL;"))
    extra = '<macros><define name="LEVEL">3.0</define></macros>'
    path = write_project(tmp_path, shader_pass(extra=extra))
    np.testing.assert_array_equal(first_floats(path)[:3], (3, 6, 1005005))


@pytest.mark.parametrize(
    "project_type, glsl_type, given, expected",
    [("bool", "int", "true", 1), ("float", "bool", "0.5", 1), ("int", "bool", "0", 0), ("bool3", "ivec3", "1", 1)],
)
def test_types_that_gl_takes_for_each_other(tmp_path, project_type, glsl_type, given, expected):
    extra = variables(constant("v", project_type, given))
    component = "v.x" if "vec" in glsl_type else "v"
    path = write_quad(tmp_path, f"color = vec4(float({component}));", f"uniform {glsl_type} v;", extra=extra)
    assert first_floats(path)[0] == expected


def test_keep_going_leaves_a_uniform_of_another_type_at_0(tmp_path):
    extra = variables(constant("v", "float", 7), constant("w", "float", 3))
    path = write_quad(tmp_path, "color = vec4(float(v) + w);", "uniform int v; uniform float w;", extra=extra)
    renderer = Renderer(path, SIZE, keep_going=True)
    renderer.draw()
    assert renderer.floats()[0, 0, 0] == 3 and '"v" has type float' in renderer.errors[0].message


def test_time_and_frame_are_what_the_caller_says(tmp_path):
    extra = variables(
        *(f'<variable type="{SYSTEM_TYPES[s]}" name="{s}" system="{s}" />' for s in ("Time", "TimeDelta", "FrameIndex"))
    )
    declarations = "uniform float Time, TimeDelta; uniform int FrameIndex;"
    path = write_quad(tmp_path, "color = vec4(Time, TimeDelta, float(FrameIndex), 1.0);", declarations, extra=extra)
    renderer = Renderer(path, SIZE)
    renderer.draw(frame=7, time=2.5, delta=0.25)
    np.testing.assert_array_equal(renderer.floats()[0, 0, :3], (2.5, 0.25, 7))


def test_values_of_the_last_frame(tmp_path):
    names = {"FrameIndex": "int", "TimeDelta": "float"}
    extra = variables(
        *(f'<variable type="{t}" name="{s}" system="{s}" lastframe="true" />' for s, t in names.items()),
        '<variable type="float4x4" name="model" system="GeometryTransform" lastframe="true" />',
    )
    declarations = "uniform float TimeDelta; uniform int FrameIndex; uniform mat4 model;"
    path = write_quad(tmp_path, "color = vec4(FrameIndex, TimeDelta, model[0][0], 1.0);", declarations, extra=extra)
    renderer = Renderer(path, SIZE)
    seen = []
    for frame in (4, 5):
        renderer.draw(frame, delta=frame / 8)
        seen.append(tuple(renderer.floats()[0, 0, :3]))
    # There was no frame before the first: its items have no places.
    assert seen == [(0, pytest.approx(1 / 60), 0), (4, 0.5, 1)]


# ---- Functions -----------------------------------------------------------------------------------------------


def function(name: str, variable_type: str, *arguments: object, function_of: str) -> str:
    return f'<variable type="{variable_type}" name="{name}" function="{function_of}">{row(*arguments)}</variable>'


@pytest.mark.parametrize(
    "what, expected", [("Position", (1, 2, 3, 1)), ("Scale", (4, 1, 1, 0)), ("Rotation", (0, 0.5, 0, 0))]
)
def test_properties_of_an_item_of_another_pass(tmp_path, what, expected):
    other = item("Lamp", "<x>1</x><y>2</y><z>3</z><scaleX>4</scaleX><yaw>0.5</yaw>")
    extra = variables(function("v", "float4", "Lamp", what, function_of="ObjectProperty"))
    write_quad(tmp_path, "color = v;", "uniform vec4 v;")
    passes = shader_pass(extra=extra) + f'<pass name="Off" active="false"><items>{other}</items></pass>'
    path = write_project(tmp_path, passes, settings=CAMERA)
    np.testing.assert_array_equal(first_floats(path), expected)


def test_a_pointer_reads_a_variable_bound_before(tmp_path):
    extra = variables(
        function("early", "float", "later", function_of="Pointer"),
        constant("later", "float", 5),
        function("late", "float", "later", function_of="Pointer"),
    )
    write_quad(tmp_path, "color = vec4(early, late, 0.0, 1.0);", "uniform float early, late;")
    items = item("A", "<type>ScreenQuadNDC</type>") + item("B", "<type>ScreenQuadNDC</type>")
    first = write_project(tmp_path, shader_pass(items=items.partition("</item>")[0] + "</item>", extra=extra))
    np.testing.assert_array_equal(first_floats(first)[:2], (0, 5))
    # By the second item all were bound once; equal depth fails, so it is drawn with the depth test off.
    off = item("S", "<depthtest>false</depthtest>", kind="renderstate")
    second = write_project(tmp_path, shader_pass(items=off + items, extra=extra))
    np.testing.assert_array_equal(first_floats(second)[:2], (5, 5))


def test_a_pointer_to_a_smaller_variable(tmp_path):
    extra = variables(constant("s", "float2", 1, 2), function("v", "float3", "s", function_of="Pointer"))
    path = write_quad(tmp_path, "color = vec4(v, 1.0);", "uniform vec3 v;", extra=extra)
    np.testing.assert_array_equal(first_floats(path)[:3], (1, 2, 0))


def test_a_pointer_reads_the_first_variable_of_that_name(tmp_path):
    write_quad(tmp_path, "color = vec4(v, p, 0.0, 1.0);", "uniform float v, p;")
    pointer = function("p", "float", "v", function_of="Pointer")
    first = shader_pass("First", extra=variables(constant("v", "float", 3)))
    off = item("S", "<depthtest>false</depthtest>", kind="renderstate") + item("Q", "<type>ScreenQuadNDC</type>")
    path = write_project(
        tmp_path, first + shader_pass("Second", items=off, extra=variables(constant("v", "float", 4), pointer))
    )
    np.testing.assert_array_equal(first_floats(path)[:2], (4, 3))


def test_63_characters_of_a_name_count(tmp_path):
    name = "n" * 64
    extra = variables(constant(name[:63], "float", 1))
    path = write_quad(tmp_path, f"color = vec4({name});", f"uniform float {name};", extra=extra)
    assert first_floats(path)[0] == 1


def test_a_variable_does_not_set_a_sampler(tmp_path):
    write_texture(tmp_path, "t.png", (51, 0, 0))
    extra = variables(constant("t", "int", 3))
    path = write_quad(
        tmp_path, "color = texture(t, uv);", "uniform sampler2D t;", extra=extra, objects=texture("t.png")
    )
    assert first_floats(path)[0] == pytest.approx(0.2)


def test_a_camera_snapshot(tmp_path):
    camera = "".join(row(*(10 * r + c for c in range(4))) for r in range(4))
    extra = variables(function("m", "float4x4", "c", function_of="CameraSnapshot"))
    path = write_quad(
        tmp_path,
        "color = m * vec4(0.0, 0.0, 1.0, 0.0);",
        "uniform mat4 m;",
        extra=extra,
        settings=CAMERA,
        rest=f'<cameras><camera name="c">{camera}</camera></cameras>',
    )
    np.testing.assert_array_equal(first_floats(path), (2, 12, 22, 32))


def test_a_function_reaches_its_uniform(tmp_path):
    extra = variables(function("m", "float4x4", 1, 2, 3, function_of="MatrixTranslation"))
    path = write_quad(
        tmp_path, "color = m * vec4(10.0, 10.0, 10.0, 1.0);", "uniform mat4 m;", extra=extra, settings=CAMERA
    )
    np.testing.assert_array_equal(first_floats(path), (11, 12, 13, 1))


def test_an_inverted_constant_is_inverted_at_each_draw(tmp_path):
    """Two thirds of the picture, an item each: the second gets the matrix itself."""
    vert = QUAD_VERT.replace("void main", "uniform mat4 model;\nvoid main")
    vert = vert.replace("vec4(position, 0.0, 1.0)", "model * vec4(position, 0.0, 1.0)")
    items = "".join(
        item(f"I{n}", f"<type>ScreenQuadNDC</type><scaleX>0.5</scaleX><x>{x}</x>") for n, x in enumerate((-0.5, 0.5))
    )
    scale = '<variable type="float2x2" name="m" invert="true">' + row(4, 0) + row(0, 4) + "</variable>"
    extra = variables('<variable type="float4x4" name="model" system="GeometryTransform" />', scale)
    write_quad(tmp_path, "color = vec4(m[0][0]);", "uniform mat2 m;")
    (tmp_path / "quad.vert").write_text(vert)
    path = write_project(tmp_path, shader_pass(items=items, extra=extra))
    np.testing.assert_array_equal(drawn(path, (2, 1))[0][0, :, 0], (0.25, 4))
