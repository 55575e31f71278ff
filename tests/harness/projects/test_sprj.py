"""The reader of .sprj files: passes, names, what is left out and what is refused. Expected values are the formulas and
examples of SHADERed's own behaviour."""

from __future__ import annotations

import pytest
from sprj_files import item, line_of, read, refusal, shader_pass, variables, warned, write_project

from harness import ProjectError
from harness.projects import sprj
from harness.projects.project import ComputePass
from harness.projects.traps import Traps

COMPUTE = '<pass name="Fill" type="compute">{}<shader type="cs" path="c.comp" entry="main" /></pass>'


def test_passes_keep_their_order(tmp_path):
    project = read(write_project(tmp_path, shader_pass("First") + shader_pass("Second")))
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
    path = write_project(tmp_path, shader_pass(items=item("Box"), extra=extra), objects=objects, settings=settings)
    project = read(path)
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


@pytest.mark.parametrize("extra", ["", "<inputlayout />"])
def test_the_default_layout(tmp_path, extra):
    layout = read(write_project(tmp_path, shader_pass(extra=extra))).passes[0].layout
    assert layout == ("Position", "Normal", "Texcoord")


def test_a_leading_slash_does_not_leave_the_folder(tmp_path):
    project = read(write_project(tmp_path, shader_pass()))
    assert project.path("/a.png") == tmp_path / "a.png"


def test_inactive_passes_and_passes_without_items_are_left_out(tmp_path):
    inactive = '<pass name="Off" active="false"><rendertexture name="gone" />' + item("Box") + "</pass>"
    empty = '<pass name="Empty"><shader type="gs" used="true" path="x" entry="main" /><items /></pass>'
    project = read(write_project(tmp_path, inactive + empty + shader_pass()))
    assert [p.name for p in project.passes] == ["Quad"]


def test_unknown_elements_are_ignored(tmp_path):
    extra = '<colour of="money" />'
    project = read(write_project(tmp_path, shader_pass(extra=extra), rest="<!-- x --><plugindata /><other />"))
    assert len(project.passes) == 1


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


def test_version_3_is_refused(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text('<?xml version="1.0"?>\n<project version="3">\n</project>')
    error = refusal(path)
    assert error.message.startswith("version 3 of the project format is not supported") and error.line == 2


# ---- Names ---------------------------------------------------------------------------------------------------


def test_of_names_that_differ_in_case_only_the_second_is_dropped(tmp_path):
    items = item("Ball", "<x>1</x>") + "\n" + item("ball", "<x>2</x>")
    path = write_project(tmp_path, shader_pass(items=items))
    project, warning = warned(path)
    first = line_of(path, '"Ball"')
    assert [i.name for i in project.passes[0].items] == ["Ball"]
    assert warning.message == (
        f'the name "ball" is taken: "Ball" of line {first}; case does not count, and SHADERed drops this item'
    )
    assert warning.line == line_of(path, '"ball"')


def test_an_item_with_a_pass_s_name_is_dropped(tmp_path):
    items = item("A") + item("quad")
    project, _ = warned(write_project(tmp_path, shader_pass(items=items)))
    assert [i.name for i in project.passes[0].items] == ["A"]


def test_the_items_of_a_pass_that_is_dropped_go_to_the_first(tmp_path):
    passes = shader_pass("P", items=item("A")) + shader_pass("P", items=item("B"), fragment="other.frag")
    project, warning = warned(write_project(tmp_path, passes))
    (p,) = project.passes
    assert [i.name for i in p.items] == ["A", "B"] and p.fragment.path == "quad.frag"
    assert "SHADERed drops this pass" in warning.message


def test_the_items_of_a_pass_with_another_case_are_lost(tmp_path):
    passes = shader_pass("P", items=item("A")) + shader_pass("p", items=item("B"))
    project, _ = warned(write_project(tmp_path, passes))
    assert [[i.name for i in p.items] for p in project.passes] == [["A"]]


@pytest.mark.parametrize("what", ["pass", "item"])
def test_what_has_no_name(tmp_path, what):
    passes = shader_pass("") if what == "pass" else shader_pass(items=item(""))
    assert refusal(write_project(tmp_path, passes)).message == f"a {what} without a name"


def test_too_many_items(tmp_path, monkeypatch):
    monkeypatch.setattr(sprj, "MOST_ITEMS", 2)
    items = "".join(item(f"I{n}") for n in range(3))
    assert "more than 2 items" in refusal(write_project(tmp_path, shader_pass(items=items))).message


# ---- Stages, targets, layouts --------------------------------------------------------------------------------


def stages(*extra: str) -> str:
    return "\n".join(
        f'<shader type="{e.split()[0]}" path="s.glsl" entry="main" {" ".join(e.split()[1:])} />' for e in extra
    )


def test_stages_that_are_used(tmp_path):
    extra = stages('gs used="true"', 'tcs used="true"', 'tes used="true"')
    (p,) = read(write_project(tmp_path, shader_pass(extra=extra).replace('active="true"', 'patchverts="4"'))).passes
    assert {p.geometry.path, p.tess_control.path, p.tess_evaluation.path} == {"s.glsl"} and p.patch_vertices == 4


def test_stages_that_are_not_used(tmp_path):
    (p,) = read(write_project(tmp_path, shader_pass(extra=stages('gs used="false"', 'tcs used="false"')))).passes
    assert (p.geometry, p.tess_control, p.patch_vertices) == (None, None, 0)


def test_a_stage_that_does_not_say_so(tmp_path):
    project, warning = warned(write_project(tmp_path, shader_pass(extra=stages("gs"))))
    assert project.passes[0].geometry is None and 'it lacks used="true"' in warning.message


@pytest.mark.parametrize("count, expected", [("0", 1), ("99", 32)])
def test_patches_are_clamped(tmp_path, count, expected):
    text = shader_pass(extra=stages('tcs used="true"', 'tes used="true"'))
    project, warning = warned(write_project(tmp_path, text.replace('active="true"', f'patchverts="{count}"')))
    assert project.passes[0].patch_vertices == expected and "patchverts" in warning.message


def test_tessellation_needs_both_stages(tmp_path):
    error = refusal(write_project(tmp_path, shader_pass(extra=stages('tcs used="true"'))))
    assert "no tessellation evaluation shader" in error.message


def test_too_many_targets(tmp_path):
    error = refusal(write_project(tmp_path, shader_pass(extra="<rendertexture />" * 17)))
    assert "17 targets; SHADERed can hold 16" in error.message


@pytest.mark.parametrize("value", ["Binormal", "Nothing"])
def test_a_layout_value_that_there_is_not_is_the_position(tmp_path, value):
    extra = f'<inputlayout><item value="Normal" />\n<item value="{value}" /></inputlayout>'
    path = write_project(tmp_path, shader_pass(extra=extra))
    project, warning = warned(path)
    assert project.passes[0].layout == ("Normal", "Position")
    assert f'is "{value}", of which SHADERed makes Position' in warning.message
    assert warning.line == line_of(path, value)


def test_a_model_has_the_layout_of_the_last_pass(tmp_path):
    model = "<filepath>m.glb</filepath>"
    layout = '<inputlayout><item value="Color" /></inputlayout>'
    passes = shader_pass("A", items=item("MA", model, kind="model"))
    passes += shader_pass("B", items=item("MB", model, kind="model"), extra=layout)
    project, warning = warned(write_project(tmp_path, passes))
    assert project.model_layouts == {"m.glb": (("Color",), None)}
    assert '"m.glb"' in warning.message and '"A"' in warning.message and '"B"' in warning.message


@pytest.mark.parametrize("path", ["a.hlsl", "a.vk"])
def test_other_languages_are_not_supported(tmp_path, path):
    project_path = write_project(tmp_path, shader_pass(extra=f'\n<shader type="ps" path="{path}" entry="main" />'))
    error = refusal(project_path)
    assert f'"{path}" is not GLSL' in error.message and "not supported" in error.message
    assert error.line == line_of(project_path, path)


# ---- Other passes --------------------------------------------------------------------------------------------


def test_a_compute_pass(tmp_path):
    passes = COMPUTE.format('<groupsize x="4" z="2" />' + variables('<variable type="float" name="v" />'))
    (p, _) = read(write_project(tmp_path, passes + shader_pass())).passes
    assert isinstance(p, ComputePass)
    assert (p.compute.path, p.groups, [v.name for v in p.variables]) == ("c.comp", (4, 1, 2), ["v"])


def test_too_many_groups(tmp_path):
    passes = COMPUTE.format('<groupsize x="65536" />')
    assert "65536 work groups along x; at most 65535" in refusal(write_project(tmp_path, passes)).message


@pytest.mark.parametrize("kind", ["audio", "plugin"])
def test_passes_that_are_not_supported(tmp_path, kind):
    path = write_project(tmp_path, f'\n<pass name="Other" type="{kind}" />' + shader_pass())
    error = refusal(path)
    assert error.message == f'pass "Other": passes of type "{kind}" are not supported'
    assert error.line == line_of(path, '"Other"')


def test_plugins_are_not_supported(tmp_path):
    path = write_project(tmp_path, shader_pass(), rest='<plugins>\n<entry name="Extra" ver="1" /></plugins>')
    error = refusal(path)
    assert error.message == 'the plugin "Extra" is not supported' and error.line == line_of(path, '"Extra"')


def test_keep_going_leaves_out_what_is_not_supported(tmp_path):
    passes = '<pass name="Sound" type="audio" />' + shader_pass("Bad", fragment="a.hlsl") + shader_pass("Good")
    path = write_project(
        tmp_path, passes, objects='<object type="audio" path="a"><bind slot="0" name="Good" /></object>'
    )
    traps = Traps(keep_going=True)
    project = sprj.read(path, traps)
    assert [p.name for p in project.passes] == ["Good"] and project.objects == ()
    assert len(traps.errors) == 3 and all(isinstance(e, ProjectError) and e.line for e in traps.errors)


def test_keep_going_leaves_out_the_passes_of_a_render_texture_that_cannot_be(tmp_path):
    passes = shader_pass("Bad", extra='<rendertexture name="rt" />') + shader_pass("Good")
    objects = '<object type="rendertexture" name="rt" rsize="wide"><bind slot="0" name="Good" /></object>'
    traps = Traps(keep_going=True)
    project = sprj.read(write_project(tmp_path, passes, objects=objects), traps)
    assert [p.name for p in project.passes] == ["Good"] and len(traps.errors) == 1


def test_keep_going_does_not_make_a_project_of_what_is_none(tmp_path):
    path = tmp_path / "project.sprj"
    path.write_text("<project version='9' />")
    with pytest.raises(ProjectError):
        sprj.read(path, Traps(keep_going=True))


def test_items_of_inactive_passes_have_places(tmp_path):
    inactive = f'<pass name="Off" active="false"><items>{item("Lamp", "<x>3</x><yaw>1</yaw>")}</items></pass>'
    places = read(write_project(tmp_path, inactive + shader_pass())).places
    assert places["Lamp"] == ((3, 0, 0), (0, 1, 0), (1, 1, 1))
