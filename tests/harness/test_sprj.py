"""The reader of .sprj files. Expected values are the formulas and examples of SHADERed's own behaviour."""

from __future__ import annotations

import pytest
from sprj_files import QUAD_ITEM, line_of, shader_pass, write_project

from harness import ProjectError, sprj
from harness.project import VARIABLE_TYPES, ArcballCamera, FirstPersonCamera, Geometry, Model, RenderState

CUBE = '<item name="Box" type="geometry"><type>Cube</type></item>'


def variables(*elements: str) -> str:
    return "<variables>\n" + "\n".join(elements) + "\n</variables>"


def row(*values: object) -> str:
    return "<row>" + "".join(f"<value>{v}</value>" for v in values) + "</row>"


def read_variable(folder, element: str):
    return sprj.read(write_project(folder, shader_pass(extra=variables(element)))).passes[0].variables[0]


def refusal(path) -> ProjectError:
    with pytest.raises(ProjectError) as caught:
        sprj.read(path)
    assert caught.value.file == str(path)
    return caught.value


# ---- What is read -----------------------------------------------------------------------------------------


def test_passes_keep_their_order(tmp_path):
    project = sprj.read(write_project(tmp_path, shader_pass("First") + shader_pass("Second")))
    assert [p.name for p in project.passes] == ["First", "Second"]


def test_every_part_knows_its_line(tmp_path):
    extra = """<inputlayout><item value="Position" semantic="POSITION" /></inputlayout>
<variables>
<variable type="float" name="level"><row><value>1</value></row></variable>
</variables>
<itemvalues>
<value variable="level" for="Box"><row><value>2</value></row></value>
</itemvalues>
<macros>
<define name="N">1</define>
</macros>"""
    objects = '<object type="texture" path="t.png">\n<bind slot="0" name="Quad" /></object>'
    settings = """<entry type="camera" fp="false"><distance>6</distance>
<pitch>0</pitch><yaw>0</yaw><roll>0</roll></entry>"""
    path = write_project(tmp_path, shader_pass(items=CUBE, extra=extra), objects=objects, settings=settings)
    project = sprj.read(path)
    p = project.passes[0]
    assert {
        "pass": p.line,
        "vs": p.vertex.line,
        "ps": p.fragment.line,
        "item": p.items[0].line,
        "variable": p.variables[0].line,
        "item value": p.item_values[0].line,
        "macro": p.macros[0].line,
        "texture": project.textures[0].line,
        "bind": project.textures[0].binds[0].line,
        "camera": project.settings.camera.line,
    } == {
        "pass": line_of(path, "<pass"),
        "vs": line_of(path, 'type="vs"'),
        "ps": line_of(path, 'type="ps"'),
        "item": line_of(path, 'name="Box"'),
        "variable": line_of(path, "<variable type"),
        "item value": line_of(path, "<value variable"),
        "macro": line_of(path, "<define"),
        "texture": line_of(path, "<object "),
        "bind": line_of(path, "<bind"),
        "camera": line_of(path, '"camera"'),
    }


@pytest.mark.parametrize("name", VARIABLE_TYPES)
def test_a_variable_without_rows_is_zero(tmp_path, name):
    variable = read_variable(tmp_path, f'<variable type="{name}" name="v" />')
    assert (variable.type.name, set(variable.value)) == (name, {0})


@pytest.mark.parametrize(
    "text, value",
    [("0.7", 0.7), ("5e-1", 0.5), ("  0.75 ", 0.75), ("-.5", -0.5), ("+2.", 2.0), ("1E3", 1000.0)],
)
def test_floats(tmp_path, text, value):
    assert read_variable(tmp_path, f'<variable type="float" name="v">{row(text)}</variable>').value == (value,)


@pytest.mark.parametrize("text", ["", "0,5", "1.5f", "abc", "nan", "inf", "1e99", "1_0", "0x10", "1 2"])
def test_what_is_no_float_is_an_error_in_its_line(tmp_path, text):
    path = write_project(
        tmp_path, shader_pass(extra=variables('<variable type="float" name="v">', row(text), "</variable>"))
    )
    error = refusal(path)
    assert error.line == line_of(path, "<row>") and 'variable "v" of pass "Quad"' in error.message


@pytest.mark.parametrize("text", ["", "1.5", "2147483648", "-99999999999999999999999", "0x10", "1e3"])
def test_what_is_no_int_is_an_error(tmp_path, text):
    error = refusal(
        write_project(tmp_path, shader_pass(extra=variables(f'<variable type="int" name="v">{row(text)}</variable>')))
    )
    assert 'variable "v" of pass "Quad"' in error.message


def test_truth_is_the_first_character(tmp_path):
    element = f'<variable type="bool4" name="v">{row("1", "Yes", "True", "no")}</variable>'
    assert read_variable(tmp_path, element).value == (True, True, True, False)


def test_a_row_of_a_matrix_is_a_glsl_column(tmp_path):
    # GLSL's m[0] is (1, 2), the first row of the file, and column by column is the order of upload.
    element = f'<variable type="float2x2" name="m">{row(1, 2)}{row(3, 4)}</variable>'
    assert read_variable(tmp_path, element).value == (1, 2, 3, 4)


def test_a_value_outside_a_row_is_not_read(tmp_path):
    assert read_variable(tmp_path, '<variable type="float" name="v"><value>3</value></variable>').value == (0,)


def test_more_values_than_the_type_has_are_an_error(tmp_path):
    path = write_project(
        tmp_path, shader_pass(extra=variables(f'<variable type="float2" name="v">{row(1, 2, 3)}</variable>'))
    )
    assert "more values than a float2" in refusal(path).message


def test_a_system_value_of_another_type_is_the_constant_zero(tmp_path):
    variable = read_variable(tmp_path, '<variable type="float" name="v" system="CameraPosition3" />')
    assert (variable.system, variable.value) == (None, (0,))


def test_item_values_for_what_is_not_in_the_pass_are_left_out(tmp_path):
    extra = (
        variables('<variable type="float" name="v" />', '<variable type="float" name="t" system="Time" />')
        + f"""<itemvalues><value variable="nothing" for="QuadItem">{row(1)}</value>
<value variable="v" for="Nobody">{row(1)}</value>
<value variable="t" for="QuadItem">{row(1)}</value>
<value variable="v" for="QuadItem">{row(4)}</value></itemvalues>"""
    )
    found = sprj.read(write_project(tmp_path, shader_pass(extra=extra))).passes[0].item_values
    assert [(v.variable.name, v.item, v.value) for v in found] == [("v", "QuadItem", (4,))]


def test_only_active_macros_are_read(tmp_path):
    extra = """<macros><define name="A" active="true">1</define><define name="B" active="false">2</define>
<define name="C">vec3(1.0)</define><define name="D" active="true"></define>
<define name="F(x)">(x)</define></macros>"""
    macros = sprj.read(write_project(tmp_path, shader_pass(extra=extra))).passes[0].macros
    assert [(m.name, m.value) for m in macros] == [("A", "1"), ("C", "vec3(1.0)"), ("D", ""), ("F(x)", "(x)")]


@pytest.mark.parametrize("extra", ["", "<inputlayout />"])
def test_the_default_layout(tmp_path, extra):
    layout = sprj.read(write_project(tmp_path, shader_pass(extra=extra))).passes[0].layout
    assert layout == ("Position", "Normal", "Texcoord")


def test_an_item_without_tags_has_the_defaults(tmp_path):
    item = sprj.read(write_project(tmp_path, shader_pass(items='<item name="I" type="geometry" />'))).passes[0].items[0]
    assert item == Geometry(
        name="I",
        state=RenderState(),
        position=(0, 0, 0),
        rotation=(0, 0, 0),
        scale=(1, 1, 1),
        line=item.line,
        shape="Cube",
        size=(1, 1, 1),
    )


def test_a_render_state_holds_for_the_items_after_it(tmp_path):
    items = (
        '<item name="A" type="geometry" /><item name="S" type="renderstate"><cull>false</cull></item>'
        '<item name="B" type="geometry" /><item name="C" type="geometry" />'
    )
    states = [i.state for i in sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items]
    assert states == [RenderState(), *[RenderState(cull=False, depth_clamp=True)] * 2]


def test_a_render_state_forgets_the_one_before(tmp_path):
    """What it leaves out takes SHADERed's defaults: culling back, counter-clockwise, depth clamp on."""
    items = (
        '<item name="S" type="renderstate"><cullfront>true</cullfront><ccw>false</ccw></item>'
        '<item name="T" type="renderstate" /><item name="B" type="geometry" />'
    )
    (item,) = sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items
    assert item.state == RenderState(cull=True, cull_front=False, ccw=True, depth_clamp=True)


def test_render_states_start_anew_in_each_pass(tmp_path):
    first = shader_pass(
        "First", items='<item name="S" type="renderstate"><cull>false</cull></item><item name="A" type="geometry" />'
    )
    second = shader_pass("Second", items='<item name="B" type="geometry" />')
    project = sprj.read(write_project(tmp_path, first + second))
    assert project.passes[1].items[0].state == RenderState()


def test_pitch_yaw_and_roll_keep_their_axes(tmp_path):
    items = """<item name="I" type="geometry"><type>Plane</type><roll>3</roll><yaw>2</yaw><pitch>1</pitch>
<z>6</z><y>5</y><x>4</x><scaleZ>9</scaleZ><scaleY>8</scaleY><scaleX>7</scaleX></item>"""
    item = sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0]
    assert (item.rotation, item.position, item.scale) == ((1, 2, 3), (4, 5, 6), (7, 8, 9))


def test_backslashes_in_paths_are_turned(tmp_path):
    items = r'<item name="M" type="model"><filepath>models\a.glb</filepath></item>'
    item = sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0]
    assert isinstance(item, Model) and item.path == "models/a.glb"


def test_white_space_belongs_to_a_path(tmp_path):
    items = '<item name="M" type="model"><filepath> a.glb </filepath></item>'
    assert sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0].path == " a.glb "


def test_a_comment_ends_a_text(tmp_path):
    items = '<item name="M" type="model"><filepath>a.glb<!-- old -->b.glb</filepath></item>'
    assert sprj.read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0].path == "a.glb"


def test_a_leading_slash_does_not_leave_the_folder(tmp_path):
    project = sprj.read(write_project(tmp_path, shader_pass()))
    assert project.path("/a.png") == tmp_path / "a.png"


def test_texture_defaults(tmp_path):
    objects = '<object type="texture" path="t.png"><bind slot="3" name="Quad" /></object>'
    (texture,) = sprj.read(write_project(tmp_path, shader_pass(), objects=objects)).textures
    assert (texture.vflip, texture.min_filter, texture.mag_filter, texture.wrap_s, texture.wrap_t) == (
        False,
        "Linear",
        "Nearest",
        "Repeat",
        "Repeat",
    )


def test_objects_that_no_drawn_pass_binds_are_left_out(tmp_path):
    objects = """<object type="texture" path="t.png"><bind slot="0" name="Nobody" /></object>
<object type="audio" path="s.ogg" /><object type="rendertexture" name="rt" rsize="1,1" />"""
    assert sprj.read(write_project(tmp_path, shader_pass(), objects=objects)).textures == ()


def test_default_settings(tmp_path):
    settings = sprj.read(write_project(tmp_path, shader_pass())).settings
    assert (settings.camera, settings.clear_color, settings.use_alpha) == (
        ArcballCamera(4, 28, 317, 0),
        (0, 0, 0, 0),
        False,
    )


def test_include_dirs_end_with_the_project_folder(tmp_path):
    settings = '<entry type="ipaths"><path>a</path><path>../b/</path></entry>'
    project = sprj.read(write_project(tmp_path, shader_pass(), settings=settings))
    assert project.include_dirs == [tmp_path / "a", tmp_path / "../b", tmp_path]


def test_first_person_camera(tmp_path):
    settings = """<entry type="camera" fp="true"><positionX>1</positionX>
<positionY>2</positionY><positionZ>3</positionZ><yaw>40</yaw><pitch>5</pitch></entry>"""
    path = write_project(tmp_path, shader_pass(), settings=settings)
    assert sprj.read(path).settings.camera == FirstPersonCamera((1, 2, 3), 5, 40, line_of(path, '"camera"'))


def test_inactive_passes_and_passes_without_items_are_left_out(tmp_path):
    inactive = '<pass name="Off" active="false"><rendertexture name="gone" />' + CUBE + "</pass>"
    empty = '<pass name="Empty"><shader type="gs" used="true" path="x" entry="main" /><items /></pass>'
    project = sprj.read(write_project(tmp_path, inactive + empty + shader_pass()))
    assert [p.name for p in project.passes] == ["Quad"]


def test_unknown_elements_are_ignored(tmp_path):
    extra = '<colour of="money" />'
    project = sprj.read(write_project(tmp_path, shader_pass(extra=extra), rest="<!-- x --><plugindata /><other />"))
    assert len(project.passes) == 1


# ---- What is refused --------------------------------------------------------------------------------------

OBJECT = '<object type="{}" name="o" path="o" {}><bind slot="0" name="Quad" /></object>'

NOT_SUPPORTED = {
    "compute pass": ({"passes": '<pass name="HERE" type="compute" />'}, '"HERE"'),
    "audio pass": ({"passes": '<pass name="HERE" type="audio" />'}, '"HERE"'),
    "plugin": ({"rest": '<plugins><entry name="HERE" ver="1" /></plugins>'}, '"HERE"'),
    "geometry shader": ({"extra": '<shader type="gs" used="true" path="HERE" entry="main" />'}, '"gs"'),
    "HLSL": ({"extra": '<shader type="ps" path="HERE.hlsl" entry="main" />'}, '"HERE.hlsl"'),
    "Vulkan GLSL": ({"extra": '<shader type="ps" path="HERE.vk" entry="main" />'}, '"HERE.vk"'),
    "several targets": ({"extra": "<rendertexture />\n<rendertexture /><!-- HERE -->"}, "<rendertexture>"),
    "layout value": (
        {"extra": '<inputlayout><item value="BufferFloat" /><!-- HERE --></inputlayout>'},
        "BufferFloat",
    ),
    "function": (
        {"extra": variables('<variable type="float" name="HERE" function="ScalarSin" />')},
        "ScalarSin",
    ),
    "system value": (
        {"extra": variables('<variable name="HERE" system="PluginVariable" />')},
        "PluginVariable",
    ),
    "last frame": (
        {"extra": variables('<variable type="float" name="HERE" system="Time" lastframe="true" />')},
        "last frame",
    ),
    "inverted constant": (
        {"extra": variables('<variable type="float4x4" name="HERE" invert="true" />')},
        "inverting a constant",
    ),
    "render state": (
        {"items": '<item name="S" type="renderstate"><depthtest name="HERE">false</depthtest></item>'},
        "<depthtest>",
    ),
    "vertex buffer": ({"items": '<item name="HERE" type="vertexbuffer" />'}, '"vertexbuffer"'),
    "instancing": (
        {"items": '<item name="HERE" type="geometry"><instanced>true</instanced></item>'},
        "<instanced>",
    ),
    "topology": (
        {"items": '<item name="HERE" type="geometry"><topology>LineList</topology></item>'},
        "LineList",
    ),
    "cube map": ({"objects": OBJECT.format("texture", 'cube="true" left="HERE"')}, 'cube="true"'),
    "keyboard texture": (
        {"objects": OBJECT.format("texture", 'keyboard_texture="true" left="HERE"')},
        "keyboard",
    ),
    "bound render texture": ({"objects": OBJECT.format("rendertexture", 'rsize="HERE"')}, '"rendertexture"'),
    "buffer": ({"objects": OBJECT.format("buffer", 'size="HERE"')}, '"buffer"'),
    "image": ({"objects": OBJECT.format("image", 'width="HERE"')}, '"image"'),
    "audio": ({"objects": OBJECT.format("audio", 'x="HERE"')}, '"audio"'),
}


@pytest.mark.parametrize("what", NOT_SUPPORTED)
def test_what_is_not_supported_is_refused_by_name_and_line(tmp_path, what):
    parts, word = NOT_SUPPORTED[what]
    parts = dict(parts)
    inner = {key: parts.pop(key) for key in ("items", "extra") if key in parts}
    passes = parts.pop("passes", "") + shader_pass(**inner)
    path = write_project(tmp_path, passes, **parts)
    error = refusal(path)
    assert "not supported" in error.message and word in error.message
    assert error.line == line_of(path, "HERE")


def test_a_render_texture_that_exists_is_not_supported(tmp_path):
    objects = '<object type="rendertexture" name="rt" rsize="1,1" />'
    path = write_project(tmp_path, shader_pass(extra='<rendertexture name="rt" />'), objects=objects)
    error = refusal(path)
    assert error.message == 'pass "Quad" draws to the render texture "rt": that is not supported'
    assert error.line == line_of(path, "<rendertexture")


def test_a_render_texture_that_does_not_exist(tmp_path):
    error = refusal(write_project(tmp_path, shader_pass(extra='<rendertexture name="rt" />')))
    assert error.message == 'pass "Quad" draws to the render texture "rt", which is not among the objects'


def test_names_that_differ_in_case_only_are_both_named(tmp_path):
    items = '<item name="Ball" type="geometry" />\n<item name="ball" type="geometry" />'
    path = write_project(tmp_path, shader_pass(items=items))
    error = refusal(path)
    first = line_of(path, '"Ball"')
    assert error.message == f'the name "ball" is taken: "Ball" of line {first}; case does not count'
    assert error.line == line_of(path, '"ball"')


def test_an_item_may_not_have_a_pass_s_name(tmp_path):
    assert "is taken" in refusal(write_project(tmp_path, shader_pass(items=QUAD_ITEM.format(name="quad")))).message


def test_a_model_with_two_layouts_is_refused(tmp_path):
    model = '<item name="{}" type="model"><filepath>m.glb</filepath></item>'
    layout = '<inputlayout><item value="Position" /></inputlayout>'
    passes = shader_pass("A", items=model.format("MA")) + shader_pass("B", items=model.format("MB"), extra=layout)
    path = write_project(tmp_path, passes)
    error = refusal(path)
    assert '"m.glb"' in error.message and '"A"' in error.message and '"B"' in error.message
    assert error.line == line_of(path, '"MB"')


@pytest.mark.parametrize("stage, name", [("vs", "vertex"), ("ps", "pixel")])
def test_a_pass_needs_both_shaders(tmp_path, stage, name):
    path = write_project(tmp_path, shader_pass())
    text = path.read_text()
    path.write_text("\n".join(line for line in text.splitlines() if f'"{stage}"' not in line))
    error = refusal(path)
    assert error.message == f'pass "Quad" has no {name} shader (<shader type="{stage}">)'


def test_the_entry_must_be_main(tmp_path):
    error = refusal(write_project(tmp_path, shader_pass(extra='<shader type="ps" path="a.frag" entry="PS" />')))
    assert '"PS"' in error.message and '"main"' in error.message


def test_a_macro_with_two_values(tmp_path):
    extra = '<macros>\n<define name="N">1</define>\n<define name="N">2</define>\n</macros>'
    path = write_project(tmp_path, shader_pass(extra=extra))
    first = line_of(path, ">1</define>")
    assert refusal(path).message == f'pass "Quad" defines the macro "N" twice, first in line {first}'


def test_there_is_no_such_shape(tmp_path):
    items = '<item name="I" type="geometry"><type>Teapot</type></item>'
    assert refusal(write_project(tmp_path, shader_pass(items=items))).message.endswith('there is no shape "Teapot"')


def test_two_objects_of_one_file(tmp_path):
    objects = '<object type="texture" path="a/t.png" />\n<object type="texture" path="a\\t.png" />'
    path = write_project(tmp_path, shader_pass(), objects=objects)
    error = refusal(path)
    assert '"a/t.png"' in error.message and f"line {line_of(path, 'a/t.png')}" in error.message
    assert error.line == line_of(path, "a\\t.png")


def test_two_textures_in_one_slot(tmp_path):
    objects = OBJECT.format("texture", "") + OBJECT.format("texture", "").replace('path="o"', 'path="p"')
    error = refusal(write_project(tmp_path, shader_pass(), objects=objects))
    assert error.message == 'slot 0 of pass "Quad" has "o" already'


def test_a_texture_bound_to_a_pass_twice(tmp_path):
    objects = """<object type="texture" path="o">
<bind slot="0" name="Quad" /><bind slot="1" name="Quad" /></object>"""
    error = refusal(write_project(tmp_path, shader_pass(), objects=objects))
    assert error.message.startswith('"o" is bound to pass "Quad" twice')


@pytest.mark.parametrize("slot", ["-1", "one", "1.5"])
def test_slots_that_are_none(tmp_path, slot):
    objects = f'<object type="texture" path="o"><bind slot="{slot}" name="Quad" /></object>'
    assert "slot" in refusal(write_project(tmp_path, shader_pass(), objects=objects)).message


@pytest.mark.parametrize("attribute", ["min_filter", "mag_filter", "wrap_s", "wrap_t"])
def test_filters_and_wraps_that_do_not_exist(tmp_path, attribute):
    objects = OBJECT.format("texture", f'{attribute}="Cubic"')
    error = refusal(write_project(tmp_path, shader_pass(), objects=objects))
    assert error.message.startswith(f'{attribute} is "Cubic"; there are ')


def test_a_camera_entry_must_be_complete(tmp_path):
    settings = '<entry type="camera" fp="false"><distance>6</distance><pitch>0</pitch><yaw>0</yaw></entry>'
    path = write_project(tmp_path, shader_pass(), settings=settings)
    error = refusal(path)
    assert "no <roll>" in error.message and error.line == line_of(path, '"camera"')


@pytest.mark.parametrize(
    "extra",
    [
        variables(f'<variable type="float" name="{"v" * 64}" />'),
        f'<macros><define name="{"N" * 32}">1</define></macros>',
        f'<macros><define name="N">{"1" * 512}</define></macros>',
        f'<shader type="ps" path="{"p" * 512}" entry="main" />',
    ],
)
def test_texts_that_overflow_shadered_s_buffers(tmp_path, extra):
    assert "more than SHADERed can hold" in refusal(write_project(tmp_path, shader_pass(extra=extra))).message


def test_version_3_is_refused(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text('<?xml version="1.0"?>\n<project version="3">\n</project>')
    error = refusal(path)
    assert error.message.startswith("version 3 of the project format is not supported") and error.line == 2


def test_version_1_is_refused(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text("<project />")
    assert refusal(path).message.startswith("version 1 of the project format is not supported")


def test_another_xml_file(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text("<svg />")
    assert "<svg> is not a SHADERed project" in refusal(path).message


def test_a_mismatched_tag_names_both_lines(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text('<project version="2">\n<items>\n<item />\n</item>\n</project>')
    error = refusal(path)
    assert error.line == 4 and "<items> of line 2" in error.message


@pytest.mark.parametrize("data", [b"", b"not xml", b"<project>", b"<a/><b/>", b"\xff\xfe\x00", b"<a>&x;</a>"])
def test_malformed_xml(tmp_path, data):
    path = tmp_path / "project.sprj"
    path.write_bytes(data)
    assert refusal(path).message.startswith("malformed XML: ")


def test_a_document_type_is_refused_before_its_entities(tmp_path):
    entities = ['<!ENTITY a0 "x">'] + [f'<!ENTITY a{n} "{f"&a{n - 1};" * 10}">' for n in range(1, 12)]
    path = tmp_path / "project.sprj"
    path.write_text("<!DOCTYPE p [" + "".join(entities) + ']>\n<project version="2">&a11;</project>')
    error = refusal(path)
    assert error.line == 1 and "<!DOCTYPE>" in error.message


def test_a_project_that_is_not_there(tmp_path):
    assert "cannot read the project" in refusal(tmp_path / "gone.sprj").message
