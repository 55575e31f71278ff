"""Version 1 of the project format, as the reader gives it."""

from __future__ import annotations

import pytest
from sprj_files import item, read, refusal, row

from harness.projects import sprj
from harness.projects.project import ArcballCamera, Blend, RenderState, Stencil, StencilSide

CUBE = item("Box")


def version_1(folder, *, items=CUBE, targets="", objects="", settings="", variables=""):
    """A project of version 1 with one pass."""
    path = folder / "project.sprj"
    path.write_text(f"""<project>
<pipeline>
<pass name="Simple">
<shader type="vs"><path>shaders\\a.vert</path><entry>main</entry><variables>{variables}</variables></shader>
<shader type="ps"><path>b.frag</path><entry>main</entry></shader>
{targets}
<items>{items}</items>
<inputlayout><item value="Color" /></inputlayout>
<macros><define name="N">1</define></macros>
</pass>
</pipeline>
<objects>{objects}</objects>
<settings>{settings}</settings>
</project>
""")
    return path


def test_shaders_and_what_version_1_does_not_know(tmp_path):
    (p,) = read(version_1(tmp_path)).passes
    assert (p.name, p.vertex.path, p.fragment.path) == ("Simple", "shaders/a.vert", "b.frag")
    assert (p.layout, p.macros, p.targets) == (("Position", "Normal", "Texcoord"), (), (None,))


def test_version_1_knows_no_tessellation(tmp_path):
    later = "".join(
        f'<shader type="{t}" used="true"><path>{t}.glsl</path><entry>main</entry></shader>'
        for t in ("gs", "tcs", "tes")
    )
    path = version_1(tmp_path, targets=later)
    (p,) = sprj.read(path).passes
    assert p.geometry.path == "gs.glsl" and p.tess_control is p.tess_evaluation is None


def test_variables_are_under_their_shaders(tmp_path):
    element = f'<variable type="float" name="v" invert="true">{row(2)}</variable>'
    (variable,) = read(version_1(tmp_path, variables=element)).passes[0].variables
    assert (variable.name, variable.value, variable.invert) == ("v", (2,), False)


def test_the_window_has_a_name(tmp_path):
    objects = '<object type="rendertexture" name="rt" fsize="4,4" r="255" g="51" />'
    targets = '<rendertexture name="rt" /><rendertexture name="Window" />'
    project = read(version_1(tmp_path, targets=targets, objects=objects))
    assert project.passes[0].targets == ("rt", None)
    assert project.render_textures[0].color == pytest.approx((1, 0.2, 0, 0))
    assert "Window" in refusal(version_1(tmp_path, targets="<rendertexture />")).message


def state_of(folder, state: str) -> RenderState:
    return read(version_1(folder, items=state + CUBE)).passes[0].items[0].state


def test_blend_states(tmp_path):
    tags = """<srcblend>One</srcblend><destblend>Zero</destblend><blendop>Max</blendop>
<srcblendalpha>Zero</srcblendalpha><destblendalpha>One</destblendalpha><alphablendop>Min</alphablendop>
<bf_red>2</bf_red><bf_green>3</bf_green><bf_blue>5</bf_blue><bf_alpha>5</bf_alpha>"""
    blend = Blend("One", "Zero", "Max", "Zero", "One", "Min", (2, 3, 5, 5))
    assert state_of(tmp_path, item("S", tags, kind="blend")) == RenderState(depth_clamp=True, blend=blend)


def test_depth_and_stencil_states(tmp_path):
    tags = """<depthenable>false</depthenable><depthfunc>Always</depthfunc><stencilenable>true</stencilenable>
<frontfunc>Never</frontfunc><frontpass>Zero</frontpass><frontfail>Invert</frontfail><backfail>Replace</backfail>"""
    front, back = StencilSide("Never", "Invert", "Invert", "Zero"), StencilSide("Equal", "Replace", "Replace", "Keep")
    assert state_of(tmp_path, item("S", tags, kind="depthstencil")) == RenderState(
        depth_clamp=True, depth_test=False, depth_function="Always", stencil=Stencil(255, 255, front, back)
    )


@pytest.mark.parametrize("cull, expected", [("None", (False, False)), ("Front", (True, True)), ("Back", (True, False))])
def test_rasterizer_states(tmp_path, cull, expected):
    tags = f"<wireframe>true</wireframe><cull>{cull}</cull><ccw>false</ccw><depthclip>false</depthclip>"
    state = state_of(tmp_path, item("S", tags, kind="rasterizer"))
    assert (state.cull, state.cull_front) == expected
    assert (state.wireframe, state.ccw, state.depth_clamp) == (True, False, False)


def test_settings(tmp_path):
    settings = """<entry type="camera"><distance>6</distance><rotationX>1</rotationX><rotationY>2</rotationY>
<rotationZ>3</rotationZ></entry><entry type="clearcolor" r="51" g="255" />"""
    read_settings = read(version_1(tmp_path, settings=settings)).settings
    camera = read_settings.camera
    assert camera == ArcballCamera(6, pitch=2, yaw=1, roll=3, line=camera.line)
    assert read_settings.clear_color == pytest.approx((0.2, 1, 0, 0))
