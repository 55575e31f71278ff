"""Items and render states, as the reader gives them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from sprj_files import item, line_of, read, refusal, shader_pass, warned, write_project

from harness.projects.project import Blend, Geometry, Model, RenderState, Stencil, StencilSide, VertexBuffer
from harness.rendering import states

#: a render state that says nothing
SAID_NOTHING = RenderState(depth_clamp=True)


def project_with(folder, items: str):
    return write_project(folder, shader_pass(items=items))


def items_of(project):
    return project.passes[0].items


def state_of(folder, tags: str) -> RenderState:
    return items_of(read(project_with(folder, item("S", tags, kind="renderstate") + item("I"))))[0].state


def test_an_item_without_tags_has_the_defaults(tmp_path):
    item = read(write_project(tmp_path, shader_pass(items='<item name="I" type="geometry" />'))).passes[0].items[0]
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
    states = [i.state for i in read(write_project(tmp_path, shader_pass(items=items))).passes[0].items]
    assert states == [RenderState(), *[RenderState(cull=False, depth_clamp=True)] * 2]


def test_a_render_state_forgets_the_one_before(tmp_path):
    """What it leaves out takes SHADERed's defaults: culling back, counter-clockwise, depth clamp on."""
    items = (
        '<item name="S" type="renderstate"><cullfront>true</cullfront><ccw>false</ccw></item>'
        '<item name="T" type="renderstate" /><item name="B" type="geometry" />'
    )
    (item,) = read(write_project(tmp_path, shader_pass(items=items))).passes[0].items
    assert item.state == RenderState(cull=True, cull_front=False, ccw=True, depth_clamp=True)


def test_render_states_start_anew_in_each_pass(tmp_path):
    first = shader_pass(
        "First", items='<item name="S" type="renderstate"><cull>false</cull></item><item name="A" type="geometry" />'
    )
    second = shader_pass("Second", items='<item name="B" type="geometry" />')
    project = read(write_project(tmp_path, first + second))
    assert project.passes[1].items[0].state == RenderState()


def test_pitch_yaw_and_roll_keep_their_axes(tmp_path):
    items = """<item name="I" type="geometry"><type>Plane</type><roll>3</roll><yaw>2</yaw><pitch>1</pitch>
<z>6</z><y>5</y><x>4</x><scaleZ>9</scaleZ><scaleY>8</scaleY><scaleX>7</scaleX></item>"""
    item = read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0]
    assert (item.rotation, item.position, item.scale) == ((1, 2, 3), (4, 5, 6), (7, 8, 9))


def test_backslashes_in_paths_are_turned(tmp_path):
    items = r'<item name="M" type="model"><filepath>models\a.glb</filepath></item>'
    item = read(write_project(tmp_path, shader_pass(items=items))).passes[0].items[0]
    assert isinstance(item, Model) and item.path == "models/a.glb"


def test_of_two_tags_the_last_holds(tmp_path):
    assert items_of(read(project_with(tmp_path, item("I", "<x>1</x><x>2</x>"))))[0].position == (2, 0, 0)


@pytest.mark.parametrize(
    "tags, words",
    [
        ("<type>Teapot</type>", 'the shape of item "I" of pass "Quad" is "Teapot", of which SHADERed makes Cube'),
        ("<topology>Fan</topology>", 'is "Fan", of which SHADERed makes TriangleList'),
        ("<x>1,5</x>", "of which SHADERed makes 1"),
    ],
)
def test_what_shadered_guesses_of_an_item(tmp_path, tags, words):
    path = project_with(tmp_path, item("I", f"\n{tags}\n"))
    project, warning = warned(path)
    (read_item,) = items_of(project)
    assert (read_item.shape, read_item.topology) == ("Cube", "TriangleList")
    assert words in warning.message and warning.line == line_of(path, tags)


@pytest.mark.parametrize("name", [t for t in states.TOPOLOGIES if t != "Undefined"])
def test_topologies(tmp_path, name):
    assert items_of(read(project_with(tmp_path, item("I", f"<topology>{name}</topology>"))))[0].topology == name


def test_an_undefined_topology_draws_nothing(tmp_path):
    _, warning = warned(project_with(tmp_path, item("I", "<topology>Undefined</topology>")))
    assert "nothing is drawn" in warning.message


def test_instances(tmp_path):
    tags = "<instanced>true</instanced><instancecount>9</instancecount><instancebuffer>b</instancebuffer>"
    (read_item,) = items_of(read(project_with(tmp_path, item("I", tags))))
    assert (read_item.instances, read_item.instance_buffer) == (9, "b")


def test_a_count_without_instanced_is_not_instanced(tmp_path):
    assert items_of(read(project_with(tmp_path, item("I", "<instancecount>9</instancecount>"))))[0].instances is None


@pytest.mark.parametrize("count", ["", "<instancecount>-1</instancecount>"])
def test_no_instances_are_a_warning(tmp_path, count):
    project, warning = warned(project_with(tmp_path, item("I", f"<instanced>1</instanced>{count}")))
    assert items_of(project)[0].instances < 1 and "nothing is drawn" in warning.message


def test_too_many_instances(tmp_path):
    tags = "<instanced>true</instanced><instancecount>2000000000</instancecount>"
    assert "2000000000 instances; at most 10000000" in refusal(project_with(tmp_path, item("I", tags))).message


def test_a_group_of_a_model_is_all_of_it(tmp_path):
    tags = "<filepath>m.obj</filepath><grouponly>true</grouponly><group>lid</group>"
    project, warning = warned(project_with(tmp_path, item("I", tags, kind="model")))
    assert isinstance(items_of(project)[0], Model) and "grouponly does nothing" in warning.message


def test_a_vertex_buffer(tmp_path):
    tags = "<buffer>points</buffer><topology>PointList</topology><x>1</x>"
    (read_item,) = items_of(read(project_with(tmp_path, item("I", tags, kind="vertexbuffer"))))
    assert isinstance(read_item, VertexBuffer)
    assert (read_item.buffer, read_item.topology, read_item.position) == ("points", "PointList", (1, 0, 0))


@pytest.mark.parametrize("kind", ["plugin", "camera", ""])
def test_other_items_are_not_supported(tmp_path, kind):
    path = project_with(tmp_path, item("I", kind=kind))
    error = refusal(path)
    assert f'items of type "{kind}" are not supported' in error.message and error.line == line_of(path, 'name="I"')


# ---- Render states ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "tags, changed",
    [
        ("", {}),
        ("<wireframe>true</wireframe>", {"wireframe": True}),
        ("<depthtest>false</depthtest>", {"depth_test": False}),
        ("<depthmask>false</depthmask><depthmask>true</depthmask>", {}),
        ("<depthfunc>GreaterEqual</depthfunc>", {"depth_function": "GreaterEqual"}),
        ("<depthclamp>false</depthclamp>", {"depth_clamp": False}),
        ("<blend>true</blend>", {"blend": Blend()}),
        ("<colorsrcfactor>One</colorsrcfactor>", {}),  # without blend
        ("<stenciltest>true</stenciltest>", {"stencil": Stencil()}),
    ],
)
def test_tags_of_render_states(tmp_path, tags, changed):
    assert state_of(tmp_path, tags) == replace(SAID_NOTHING, **changed)


def test_all_of_a_blend(tmp_path):
    tags = """<blend>true</blend><colorsrcfactor>One</colorsrcfactor><colordstfactor>Zero</colordstfactor>
<colorfunc>Subtract</colorfunc><alphasrcfactor>Destination Color</alphasrcfactor>
<alphadstfactor>Inverse Blend Factor</alphadstfactor><alphafunc>Max</alphafunc>
<blendfactor_r>2</blendfactor_r><blendfactor_g>3</blendfactor_g><blendfactor_b>4</blendfactor_b>
<blendfactor_a>4</blendfactor_a>"""
    assert state_of(tmp_path, tags).blend == Blend(
        "One", "Zero", "Subtract", "Destination Color", "Inverse Blend Factor", "Max", (2, 3, 4, 4)
    )


def test_blue_of_the_blend_factor_is_its_alpha(tmp_path):
    tags = "<blend>true</blend><blendfactor_b>3</blendfactor_b><blendfactor_a>5</blendfactor_a>"
    project, warning = warned(project_with(tmp_path, item("S", tags, kind="renderstate") + item("I")))
    assert items_of(project)[0].state.blend.factor == (1, 1, 5, 5) and "blendfactor_a" in warning.message


def test_all_of_a_stencil(tmp_path):
    tags = """<stenciltest>true</stenciltest><stencilmask>255</stencilmask>
<stencilfrontfunc>Always</stencilfrontfunc><stencilbackfunc>Never</stencilbackfunc>
<stencilfrontpass>Replace</stencilfrontpass><stencilbackpass>Zero</stencilbackpass>
<stencilfrontfail>Increase</stencilfrontfail><stencilbackfail>Decrease Saturated</stencilbackfail>
<depthfrontfail>Invert</depthfrontfail><depthbackfail>Keep</depthbackfail>"""
    assert state_of(tmp_path, tags).stencil == Stencil(
        255,
        255,
        StencilSide("Always", "Increase", "Invert", "Replace"),
        StencilSide("Never", "Decrease Saturated", "Keep", "Zero"),
    )


def test_the_reference_is_a_mask(tmp_path):
    tags = "<stenciltest>true</stenciltest><stencilref>6</stencilref>"
    project, warning = warned(project_with(tmp_path, item("S", tags, kind="renderstate") + item("I")))
    assert items_of(project)[0].state.stencil.read_mask == 6 and "the reference is always 1" in warning.message


@pytest.mark.parametrize(
    "tag, otherwise",
    [
        ("colorsrcfactor", "Blend Factor"),
        ("alphafunc", "Add"),
        ("depthfunc", "Always"),
        ("stencilfrontpass", "Keep"),
    ],
)
def test_names_that_shadered_does_not_know(tmp_path, tag, otherwise):
    tags = f"<blend>1</blend><stenciltest>1</stenciltest><{tag}>Sometimes</{tag}>"
    _, warning = warned(project_with(tmp_path, item("S", tags, kind="renderstate") + item("I")))
    assert f'is "Sometimes", of which SHADERed makes {otherwise}; there are ' in warning.message


def test_a_factor_that_gl_refuses(tmp_path):
    tags = "<blend>1</blend><colorsrcfactor>Source 1 Color</colorsrcfactor>"
    error = refusal(project_with(tmp_path, item("S", tags, kind="renderstate") + item("I")))
    assert "which SHADERed does not pass on to GL" in error.message


@pytest.mark.parametrize("tag", ["<depthbias>0.5</depthbias>", "<alpha2coverage>true</alpha2coverage>"])
def test_tags_without_an_effect(tmp_path, tag):
    _, warning = warned(project_with(tmp_path, item("S", tag, kind="renderstate") + item("I")))
    assert "does nothing in SHADERed" in warning.message


def test_a_pass_that_leaves_the_depth_locked(tmp_path):
    items = item("I") + "\n" + item("S", "<depthmask>false</depthmask>", kind="renderstate")
    path = project_with(tmp_path, items)
    project, warning = warned(path)
    assert not project.passes[0].end_state.depth_write
    assert "ends with depthmask false" in warning.message and warning.line == line_of(path, 'name="S"')
