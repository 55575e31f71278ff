"""How passes are drawn: targets and their clears, states, topologies, stages, instances, buffers, compute passes."""

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
    shader_pass,
    texture,
    variables,
    write_project,
    write_quad,
    write_texture,
)

from harness import ProjectError
from harness.projects import sprj
from harness.projects.traps import Traps
from harness.rendering import buffers
from harness.rendering.render import Renderer, render

QUAD = "<type>ScreenQuadNDC</type>"
ALPHA = '<entry type="usealpha" val="true" />'


def renderer_of(path, size=SIZE) -> Renderer:
    renderer = Renderer(path, size)
    renderer.draw()
    return renderer


def state(name: str, tags: str) -> str:
    return item(name, tags, kind="renderstate")


def quad_pass(name: str, *targets: str, fragment: str = "quad.frag", extra: str = "", items: str = "") -> str:
    """A pass with a full-screen quad to render textures, "" for the window."""
    listed = "".join(f'<rendertexture name="{t}" />' if t else "<rendertexture />" for t in targets)
    return shader_pass(name, fragment=fragment, items=items or item(f"{name}Quad", QUAD), extra=listed + extra)


def target(name: str, attributes: str = 'rsize="1,1"', *binds: tuple[str, int]) -> str:
    listed = "".join(f'<bind slot="{slot}" name="{p}" />' for p, slot in binds)
    return f'<object type="rendertexture" name="{name}" {attributes}>{listed}</object>\n'


def level(value: float) -> str:
    """A constant that the fragment shader of ``leveled`` shows."""
    return variables(constant("level", "float4", *([value] * 4)))


def leveled(folder, passes: str, **parts: str):
    """A project whose quad.frag shows the variable ``level``."""
    write_quad(folder, "color = level;", "uniform vec4 level;")
    return write_project(folder, passes, settings=ALPHA + parts.pop("settings", ""), **parts)


def fragment(folder, name: str, body: str, declarations: str) -> str:
    (folder / name).write_text(f"#version 330\n{declarations}\nin vec2 uv;\nvoid main()\n{{\n{body}\n}}\n")
    return name


# ---- Render textures ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "attributes, size", [('rsize="0.5,0.34"', (2, 1)), ('fsize="7,5"', (7, 5)), ('rsize="2,1"', (8, 3))]
)
def test_sizes_of_render_textures(tmp_path, attributes, size):
    system = variables('<variable type="float2" name="viewport" system="ViewportSize" />')
    write_quad(tmp_path, "color = vec4(viewport, gl_FragCoord.xy);", "uniform vec2 viewport;")
    path = write_project(
        tmp_path, quad_pass("P", "rt", extra=system), objects=target("rt", f'{attributes} format="R32G32B32A32_FLOAT"')
    )
    pixels = renderer_of(path).targets()["rt"]
    assert pixels.shape == (size[1], size[0], 4)
    np.testing.assert_array_equal(pixels[-1, -1], (*size, size[0] - 0.5, size[1] - 0.5))


@pytest.mark.parametrize(
    "name, expected",
    [
        ("RGBA", (1, 0, 128 / 255, 51 / 255)),
        ("R32G32B32A32_FLOAT", (7.5, -0.25, 0.5, 0.2)),
        ("R16G16B16A16_FLOAT", (7.5, -0.25, 0.5, np.float16(0.2))),
        ("R32_FLOAT", (7.5, 0, 0, 1)),
        ("R8G8", (1, 0, 0, 1)),
        ("R8G8B8A8_SNORM", (1, -32 / 127, 64 / 127, 25 / 127)),
        ("R11G11B10_FLOAT", (7.5, 0, 0.5, 1)),
    ],
)
def test_formats_of_render_textures(tmp_path, name, expected):
    write_quad(tmp_path, "color = vec4(7.5, -0.25, 0.5, 0.2);")
    path = write_project(tmp_path, quad_pass("P", "rt"), objects=target("rt", f'rsize="1,1" format="{name}"'))
    np.testing.assert_allclose(renderer_of(path).targets()["rt"][0, 0], expected, atol=1e-6)


def test_a_format_that_nothing_can_be_drawn_to(tmp_path):
    write_quad(tmp_path, "")
    path = write_project(tmp_path, quad_pass("P", "rt"), objects="\n" + target("rt", 'rsize="1,1" format="R9G9B9_E5"'))
    with pytest.raises(ProjectError, match='"rt" of format R9G9B9_E5') as caught:
        render(path, SIZE)
    assert caught.value.line == line_of(path, "<object ")


def test_a_ratio_of_nothing(tmp_path):
    path = leveled(tmp_path, quad_pass("P", "rt"), objects=target("rt", 'rsize="0.1,1"'))
    with pytest.raises(ProjectError, match='the render texture "rt" would be 0 x 3 pixels'):
        render(path, SIZE)


def test_a_render_texture_is_read_as_it_was_drawn_and_linearly(tmp_path):
    write_quad(tmp_path, "color = vec4(gl_FragCoord.x - 0.5);")
    show = fragment(tmp_path, "show.frag", "c = texture(t, vec2(0.5, 0.5));", "uniform sampler2D t; out vec4 c;")
    path = write_project(
        tmp_path,
        quad_pass("P", "rt") + quad_pass("Show", "", fragment=show),
        objects=target("rt", 'fsize="2,1" format="R32_FLOAT"', ("Show", 0)),
    )
    assert first_floats(path)[0] == 0.5  # between the texels 0 and 1


def test_several_targets(tmp_path):
    body = "a = vec4(0.25); b = vec4(0.5); c = vec4(0.75);"
    outputs = "\n".join(f"layout(location = {k}) out vec4 {n};" for k, n in enumerate("abc"))
    write_quad(tmp_path, "")
    name = fragment(tmp_path, "three.frag", body, outputs)
    objects = target("one", 'rsize="1,1" format="R32_FLOAT"') + target("two", 'rsize="1,1" format="R16_FLOAT"')
    path = write_project(tmp_path, quad_pass("P", "two", "", "one", fragment=name), objects=objects)
    renderer = renderer_of(path)
    targets = renderer.targets()
    assert (targets["two"][..., 0] == 0.25).all() and (targets["one"][..., 0] == 0.75).all()
    assert (renderer.floats()[..., 0] == 0.5).all()


def test_targets_of_different_sizes_share_the_size_of_the_last(tmp_path):
    outputs = "uniform vec2 size; layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;"
    write_quad(tmp_path, "")
    name = fragment(tmp_path, "both.frag", "a = b = vec4(size, gl_FragCoord.x, 1.0);", outputs)
    objects = "".join(
        target(name, f'fsize="{size}" format="R32G32B32A32_FLOAT"') for name, size in (("x", "5,7"), ("y", "2,3"))
    )
    size = variables('<variable type="float2" name="size" system="ViewportSize" />')
    path = write_project(tmp_path, quad_pass("P", "x", "y", fragment=name, extra=size), objects=objects)
    found = renderer_of(path).targets()["y"]
    np.testing.assert_array_equal(found, np.broadcast_to([[(2, 3, x + 0.5, 1) for x in range(2)]], (3, 2, 4)))


# ---- Clears ----------------------------------------------------------------------------------------------------


DISCARD = '<macros><define name="DISCARD">1</define></macros>'


def discarding(folder, passes: str, **parts: str):
    """A project whose quad.frag draws nothing where DISCARD is defined, and ``level`` elsewhere."""
    path = leveled(folder, passes, **parts)
    frag = folder / "quad.frag"
    frag.write_text(frag.read_text().replace("color = level;", "color = level;\n#ifdef DISCARD\ndiscard;\n#endif"))
    return path


def test_the_clear_colour_of_a_render_texture(tmp_path):
    attributes = 'rsize="1,1" format="R32G32B32A32_FLOAT" r="0.5" g="-1" b="2" a="0.25"'
    path = discarding(tmp_path, quad_pass("P", "rt", extra=DISCARD), objects=target("rt", attributes))
    np.testing.assert_array_equal(renderer_of(path).targets()["rt"][0, 0], (0.5, -1, 2, 0.25))


@pytest.mark.parametrize(
    "order, kept",
    [
        (("rt", "rt"), True),  # two passes in a row share what is there
        (("rt", "", "rt"), False),  # another one between them, and it is cleared again
    ],
)
def test_when_a_render_texture_is_cleared(tmp_path, order, kept):
    passes = "".join(quad_pass(f"P{n}", name, extra=level(0.5) if n == 0 else DISCARD) for n, name in enumerate(order))
    path = discarding(tmp_path, passes, objects=target("rt", 'rsize="1,1" format="R32_FLOAT" r="2"'))
    assert renderer_of(path).targets()["rt"][0, 0, 0] == (0.5 if kept else 2)


@pytest.mark.parametrize("between, kept", [((), True), (("",), True), (("x", "y"), True), (("", "x"), False)])
def test_a_second_target_counts_as_just_drawn_until_as_many_come_again(tmp_path, between, kept):
    outputs = "layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;"
    path = discarding(tmp_path, "")
    both = fragment(tmp_path, "both.frag", "a = b = vec4(0.5);", outputs)
    passes = quad_pass("A", "x", "y", fragment=both)
    if between:
        passes += quad_pass("B", *between, extra=DISCARD)
    objects = target("x") + target("y", 'rsize="1,1" format="R32_FLOAT" r="2"')
    path = write_project(tmp_path, passes + quad_pass("C", "y", extra=DISCARD), objects=objects)
    assert renderer_of(path).targets()["y"][0, 0, 0] == (0.5 if kept else 2)


def test_without_clear_a_render_texture_keeps_its_last_frame(tmp_path):
    """The sum of a geometric series, one term a frame: x becomes (x + 1) / 2."""
    write_quad(tmp_path, "color = vec4(1.0);")
    blend = state(
        "S",
        "<blend>true</blend><colorsrcfactor>Blend Factor</colorsrcfactor>"
        + "".join(f"<blendfactor_{c}>1</blendfactor_{c}>" for c in "rgba")
        + "<colordstfactor>One</colordstfactor>",
    )
    path = write_project(
        tmp_path,
        quad_pass("P", "rt", items=blend + item("Q", QUAD)),
        objects=target("rt", 'rsize="1,1" format="R32_FLOAT" clear="false"'),
    )
    renderer = Renderer(path, SIZE)
    seen = []
    for frame in range(3):
        renderer.draw(frame)
        seen.append(renderer.targets()["rt"][0, 0, 0])
    assert seen == [1, 2, 3]


def test_a_pass_of_render_states_alone_clears(tmp_path):
    write_quad(tmp_path, "")
    path = write_project(tmp_path, shader_pass(items=state("S", "")), settings='<entry type="clearcolor" r="2" />')
    assert first_floats(path)[0] == 2


def test_the_window_is_cleared_once(tmp_path):
    passes = quad_pass("A", "", extra=level(0.5)) + quad_pass("B", "rt") + quad_pass("C", "", extra=DISCARD)
    settings = '<entry type="clearcolor" r="2" />'
    assert first_floats(discarding(tmp_path, passes, objects=target("rt"), settings=settings))[0] == 0.5


def test_depth_is_kept_within_the_window_and_cleared_between_targets(tmp_path):
    # Equal depth fails: of two quads in one target the first stays.
    passes = quad_pass("A", "", extra=level(0.25)) + quad_pass("B", "rt", extra=level(0.5))
    passes += quad_pass("C", "", extra=level(0.75)) + quad_pass("D", "rt", extra=level(1))
    renderer = renderer_of(leveled(tmp_path, passes, objects=target("rt", 'rsize="1,1" format="R32_FLOAT"')))
    assert renderer.floats()[0, 0, 0] == 0.25 and renderer.targets()["rt"][0, 0, 0] == 1


def test_the_depth_of_several_targets_is_the_last_ones(tmp_path):
    """B draws behind what A drew, into the depth that A's last target lent: nothing of B is seen."""
    path = leveled(tmp_path, "")
    outputs = "layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;"
    both = fragment(tmp_path, "both.frag", "a = b = vec4(0.5);", outputs)
    objects = target("x") + target("y", 'rsize="1,1" format="R32_FLOAT"')
    passes = quad_pass("A", "x", "y", fragment=both) + quad_pass("B", "y", extra=level(1))
    path = write_project(tmp_path, passes, objects=objects)
    assert renderer_of(path).targets()["y"][0, 0, 0] == 0.5


def test_a_pass_that_leaves_the_depth_locked_locks_the_next_clear(tmp_path):
    """The next target's depth is what it was at first, 0: nothing is in front of it."""
    locked = item("AQ", QUAD) + state("AS", "<depthmask>false</depthmask>")
    passes = quad_pass("A", "", items=locked) + quad_pass("B", "rt", extra=level(1))
    renderer = renderer_of(leveled(tmp_path, passes, objects=target("rt", 'rsize="1,1" format="R32_FLOAT"')))
    assert renderer.targets()["rt"][0, 0, 0] == 0
    assert "ends with depthmask false" in renderer.warnings[0].message


# ---- Render states -----------------------------------------------------------------------------------------------


def quads_with(folder, tags: str, *, under: float = 0.5, over: float = 0.25):
    """A quad, and over it another in a state: what one pixel becomes."""
    items = item("Under", QUAD) + state("S", tags) + item("Over", QUAD)
    values = (
        f'<itemvalues><value variable="level" for="Over"><row>{f"<value>{over}</value>" * 4}</row></value></itemvalues>'
    )
    return first_floats(leveled(folder, shader_pass(items=items, extra=level(under) + values)))


NO_DEPTH = "<depthtest>false</depthtest>"


@pytest.mark.parametrize(
    "tags, expected",
    [
        ("", 0.5),  # equal depth fails
        (NO_DEPTH, 0.25),
        ("<depthfunc>Always</depthfunc>", 0.25),
        ("<depthfunc>LessEqual</depthfunc>", 0.25),
        ("<depthfunc>Greater</depthfunc>", 0.5),
        ("<depthfunc>Equal</depthfunc>", 0.25),
        ("<depthfunc>NotEqual</depthfunc>", 0.5),
        ("<depthfunc>Never</depthfunc>", 0.5),
    ],
)
def test_depth_functions(tmp_path, tags, expected):
    assert quads_with(tmp_path, tags)[0] == expected


@pytest.mark.parametrize(
    "function, source, destination, expected",
    # under 0.5, over 0.25, alpha as colour; factor 1 * s + d and so on
    [
        ("Add", "One", "One", 0.75),
        ("Subtract", "One", "One", -0.25),
        ("Reverse Subtract", "One", "One", 0.25),
        ("Min", "Zero", "Zero", 0.25),
        ("Max", "Zero", "Zero", 0.5),
        ("Add", "Source Alpha", "Inverse Source Alpha", 0.25 * 0.25 + 0.75 * 0.5),
        ("Add", "Destination Color", "Zero", 0.125),
        ("Add", "Inverse Destination Alpha", "Source Color", 0.25 * 0.5 + 0.5 * 0.25),
        ("Add", "Blend Factor", "Inverse Blend Factor", 0.25 * 2 - 0.5),
        ("Add", "Saturated Source Alpha", "Zero", 0.25 * 0.25),  # min(source alpha, 1 - destination alpha)
    ],
)
def test_blending(tmp_path, function, source, destination, expected):
    tags = f"{NO_DEPTH}<blend>true</blend>" + "".join(f"<blendfactor_{c}>2</blendfactor_{c}>" for c in "rgba")
    for part in ("color", "alpha"):
        tags += f"<{part}func>{function}</{part}func><{part}srcfactor>{source}</{part}srcfactor>"
        tags += f"<{part}dstfactor>{destination}</{part}dstfactor>"
    pixel = quads_with(tmp_path, tags)
    assert pixel[0] == expected
    # Of alpha itself the saturated source is 1.
    assert pixel[3] == (0.25 if "Saturated" in source else expected)


@pytest.mark.parametrize(
    "function, seen", [("Equal", True), ("NotEqual", False), ("Always", True), ("Never", False), ("Less", False)]
)
def test_the_stencil_of_an_item_holds_for_the_next(tmp_path, function, seen):
    write = (
        NO_DEPTH
        + """<stenciltest>true</stenciltest><stencilmask>255</stencilmask>
<stencilfrontfunc>Always</stencilfrontfunc><stencilfrontpass>Replace</stencilfrontpass>"""
    )
    read = NO_DEPTH + f"<stenciltest>true</stenciltest><stencilfrontfunc>{function}</stencilfrontfunc>"
    items = state("W", write) + item("Under", QUAD) + state("R", read) + item("Over", QUAD)
    own = '<itemvalues><value variable="level" for="Over"><row><value>1</value></row></value></itemvalues>'
    path = leveled(tmp_path, shader_pass(items=items, extra=level(0.5) + own))
    assert first_floats(path)[0] == (1 if seen else 0.5)


def stencil_after(folder, *tags: str) -> float:
    """What quads drawn one after the other, each in a state with a stencil, leave in it.

    It is read bit by bit: a quad per bit adds 2^k where the reference, 1, and the stencil differ in bit k, or agree.
    """
    items, values = "", ""
    for n, of_state in enumerate(tags):
        test = ("" if "<depthtest>" in of_state else NO_DEPTH) + "<stenciltest>true</stenciltest>"
        test += "" if "<stencilmask>" in of_state else "<stencilmask>255</stencilmask>"
        items += state(f"S{n}", test + of_state) + item(f"Q{n}", QUAD)
    adds = f"{NO_DEPTH}<blend>true</blend><colorsrcfactor>One</colorsrcfactor><colordstfactor>One</colordstfactor>"
    for k in range(8):
        function = "Equal" if k == 0 else "NotEqual"
        reads = "".join(f"<stencil{side}func>{function}</stencil{side}func>" for side in ("front", "back"))
        keeps = f"<stenciltest>true</stenciltest><stencilref>{1 << k}</stencilref>{reads}"
        items += state(f"Read{k}", adds + keeps) + item(f"Bit{k}", QUAD)
        row = f"<value>{1 << k}</value>" * 4
        values += f'<value variable="level" for="Bit{k}"><row>{row}</row></value>'
    extra = level(0) + f"<itemvalues>{values}</itemvalues>"
    settings = '<entry type="clearcolor" r="0" g="0" b="0" a="0" />'
    return first_floats(leveled(folder, shader_pass(items=items, extra=extra), settings=settings))[0]


def side(name: str, function: str, *, passed: str = "Keep", fail: str = "Keep", depth: str = "Keep") -> str:
    return (
        f"<stencil{name}func>{function}</stencil{name}func><stencil{name}pass>{passed}</stencil{name}pass>"
        f"<stencil{name}fail>{fail}</stencil{name}fail><depth{name}fail>{depth}</depth{name}fail>"
    )


@pytest.mark.parametrize(
    "operations, expected",
    [
        (["Keep"], 0),
        (["Replace"], 1),
        (["Invert"], 255),
        (["Invert", "Zero"], 0),
        (["Increase", "Increase"], 2),
        (["Decrease"], 0),
        (["Invert", "Increase"], 255),
        (["Decrease Saturated"], 255),  # in SHADERed it is this one that wraps
        (["Invert", "Increase Saturated"], 0),
    ],
)
def test_stencil_operations(tmp_path, operations, expected):
    assert stencil_after(tmp_path, *(side("front", "Always", passed=o) for o in operations)) == expected


NEVER_DEPTH = "<depthtest>true</depthtest><depthfunc>Never</depthfunc>"


@pytest.mark.parametrize(
    "tags, expected",
    [
        (side("front", "Never", fail="Replace", passed="Invert", depth="Invert"), 1),
        (NEVER_DEPTH + side("front", "Always", depth="Replace", passed="Invert", fail="Invert"), 1),
        (side("front", "Always", passed="Replace") + side("back", "Always", passed="Invert"), 1),
        (
            "<cull>false</cull><ccw>false</ccw>"
            + side("front", "Always", passed="Replace")
            + side("back", "Always", passed="Invert"),
            255,
        ),
        ("<stencilmask>6</stencilmask>" + side("front", "Always", passed="Invert"), 6),
    ],
)
def test_what_a_stencil_operation_is_for(tmp_path, tags, expected):
    assert stencil_after(tmp_path, tags) == expected


@pytest.mark.parametrize("tags, seen", [("", True), ("<depthclamp>false</depthclamp>", False)])
def test_what_lies_before_the_near_plane_is_cut_or_clamped(tmp_path, tags, seen):
    path = leveled(tmp_path, shader_pass(items=state("S", NO_DEPTH + tags) + item("Q", QUAD), extra=level(1)))
    vert = tmp_path / "quad.vert"
    vert.write_text(vert.read_text().replace("vec4(position, 0.0, 1.0)", "vec4(position, -1.5, 1.0)"))
    assert (first_floats(path)[0] == 1) == seen


def test_wireframe(tmp_path):
    items = state("S", "<wireframe>true</wireframe>") + item("Q", QUAD)
    pixels = floats(leveled(tmp_path, shader_pass(items=items, extra=level(1))), (16, 16))[..., 0]
    # The diagonal that the two triangles share, and not what they fill. (The outer edges are at the picture's edge.)
    assert pixels[np.arange(15, -1, -1), np.arange(16)].sum() >= 14 and pixels[4:8, 4:6].sum() == 0


# ---- Topologies, instances, stages -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "topology, pixels",
    # Of the strip one triangle faces the camera, half of the picture with its diagonal.
    [("TriangleList", 64), ("TriangleStrip", 36), ("Undefined", 0)],
)
def test_topologies_of_the_quad(tmp_path, topology, pixels):
    items = item("Q", f"{QUAD}<topology>{topology}</topology>")
    found = floats(leveled(tmp_path, shader_pass(items=items, extra=level(1))), (8, 8))[..., 0]
    assert found.sum() == pixels


@pytest.mark.parametrize("topology, pixels", [("PointList", 3), ("LineStrip", 16), ("LineList", 8)])
def test_points_and_lines(tmp_path, topology, pixels):
    """Of a triangle over half of 9 x 9 pixels: its corners, two of its sides, one of its sides."""
    vert = QUAD_VERT.replace("vec2 position", "vec3 position").replace(
        "vec4(position, 0.0, 1.0)",
        "vec4(vec2(gl_VertexID == 1 ? 0.95 : -0.95, gl_VertexID == 2 ? 0.95 : -0.95), 0.0, 1.0)",
    )
    items = item("T", f"<type>Triangle</type><topology>{topology}</topology>")
    path = leveled(tmp_path, shader_pass(items=items, extra=level(1)))
    (tmp_path / "quad.vert").write_text(
        vert.replace("in vec2 texcoord", "in vec3 texcoord").replace("= texcoord", "= texcoord.xy")
    )
    found = floats(path, (9, 9))[..., 0].sum()
    assert abs(found - pixels) <= 1  # the last pixel of a line is not drawn


def test_instances(tmp_path):
    vert = QUAD_VERT.replace(
        "vec4(position, 0.0, 1.0)", "vec4(position.x / 4.0 - 0.75 + gl_InstanceID * 0.5, position.y, 0.0, 1.0)"
    )
    vert = vert.replace("out vec2 uv;", "out vec2 uv; flat out float n;").replace(
        "uv = ", "n = gl_InstanceID + 1; uv = "
    )
    write_quad(tmp_path, "color = vec4(n);", "flat in float n;")
    (tmp_path / "quad.vert").write_text(vert)
    items = item("Q", f"{QUAD}<instanced>true</instanced><instancecount>3</instancecount>")
    np.testing.assert_array_equal(floats(write_project(tmp_path, shader_pass(items=items)))[0, :, 0], (1, 2, 3, 0))


def write_buffer(folder, name: str, *rows: float) -> None:
    (folder / "buffers").mkdir(exist_ok=True)
    (folder / "buffers" / f"{name}.buf").write_bytes(np.array(rows, np.float32).tobytes())


def test_an_instance_buffer_follows_the_layout(tmp_path):
    vert = """#version 330
layout(location = 0) in vec3 position;
layout(location = 1) in float place;
layout(location = 2) in vec2 value;
out vec2 uv; flat out float n;
void main()
{
    n = value.x + value.y;
    uv = vec2(0.0);
    gl_Position = vec4(position.x / 2.0 + place, position.y * 2.0, 0.0, 1.0);
}
"""
    write_quad(tmp_path, "color = vec4(n);", "flat in float n;")
    (tmp_path / "quad.vert").write_text(vert)
    write_buffer(tmp_path, "rows", -0.75, 1, 2, -0.25, 3, 4, 0.75, 5, 6)
    tags = "<type>Plane</type><instanced>true</instanced><instancecount>3</instancecount>"
    items = state("S", "<cull>false</cull>") + item("I", tags + "<instancebuffer>rows</instancebuffer>")
    extra = '<inputlayout><item value="Position" /></inputlayout>'
    objects = '<object type="buffer" name="rows" size="36" format="float;vec2" />'
    path = write_project(tmp_path, shader_pass(items=items, extra=extra), objects=objects)
    np.testing.assert_array_equal(floats(path)[1, :, 0], (3, 7, 0, 11))


@pytest.mark.parametrize("tag", ["<instancebuffer>gone</instancebuffer>", "<buffer>gone</buffer>"])
def test_a_buffer_that_there_is_not(tmp_path, tag):
    kind, shape = ("vertexbuffer", "") if tag.startswith("<buffer") else ("geometry", "<type>Cube</type>")
    path = leveled(tmp_path, shader_pass(items=item("I", shape + tag, kind=kind)))
    with pytest.raises(ProjectError, match='there is no buffer "gone" with content: SHADERed crashes'):
        render(path, SIZE)


def test_all_parts_of_a_model_are_drawn(tmp_path):
    """Two triangles, each in an object of its own: one covers the left half, one the right."""
    corners = [(-3, -1), (0, -1), (0, 5), (0, -1), (3, -1), (0, 5)]
    lines = [f"v {x} {y} 0" for x, y in corners]
    (tmp_path / "two.obj").write_text("\n".join([*lines[:3], "o a", "f 1 2 3", *lines[3:], "o b", "f 4 5 6"]) + "\n")
    path = leveled(
        tmp_path,
        shader_pass(
            items=item("M", "<filepath>two.obj</filepath>", kind="model"),
            extra=level(1) + '<inputlayout><item value="Position" semantic="POSITION" /></inputlayout>',
        ),
    )
    assert (floats(path)[0, :, 0] == 1).all()


def test_a_vertex_buffer(tmp_path):
    vert = """#version 330
layout(location = 0) in vec2 place;
layout(location = 1) in float value;
out vec2 uv; flat out float n;
void main() { n = value; uv = vec2(0.0); gl_Position = vec4(place, 0.0, 1.0); }
"""
    write_quad(tmp_path, "color = vec4(n);", "flat in float n;")
    (tmp_path / "quad.vert").write_text(vert)
    write_buffer(tmp_path, "points", -0.75, 0, 5, 0.75, 0, 6)
    items = item("I", "<buffer>points</buffer><topology>PointList</topology>", kind="vertexbuffer")
    objects = '<object type="buffer" name="points" size="24" format="vec2;float" />'
    pixels, warnings = drawn(write_project(tmp_path, shader_pass(items=items), objects=objects))
    np.testing.assert_array_equal(pixels[1, :, 0], (5, 0, 0, 6))
    assert warnings == []


def test_what_the_file_of_a_buffer_lacks_is_0(tmp_path):
    write_buffer(tmp_path, "b", 1)
    write_quad(tmp_path, "")
    objects = '<object type="buffer" name="b" size="8"><bind slot="0" name="Quad" /></object>'
    path = write_project(tmp_path, shader_pass(), objects=objects)
    _, (warning,) = drawn(path)
    project = sprj.read(path)
    assert buffers.content(project, project.buffers[0], Traps()) == np.float32(1).tobytes() + bytes(4)
    assert '"buffers/b.buf" has 4 of its 8 bytes' in warning


def stage(kind: str, path: str) -> str:
    return f'<shader type="{kind}" used="true" path="{path}" entry="main" />'


def test_a_geometry_stage(tmp_path):
    """It halves every triangle of the quad toward the right."""
    (tmp_path / "half.geom").write_text("""#version 330
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
in vec2 uv[];
out vec2 right;
void main()
{
    for (int i = 0; i < 3; ++i) {
        right = uv[i];
        gl_Position = gl_in[i].gl_Position;
        gl_Position.x = max(gl_Position.x, 0.0);
        EmitVertex();
    }
}
""")
    write_quad(tmp_path, "color = vec4(1.0, right, 1.0);", "in vec2 right;")
    (tmp_path / "quad.frag").write_text(
        (tmp_path / "quad.frag").read_text().replace("in vec2 uv;\n", "").replace("vec4(uv, 0.0, 1.0)", "vec4(0.0)")
    )
    path = write_project(tmp_path, shader_pass(extra=stage("gs", "half.geom")))
    np.testing.assert_array_equal(floats(path)[1, :, 0], (0, 0, 1, 1))


def test_tessellation(tmp_path):
    """Patches of three vertices, each cut into smaller triangles; the quad is covered all the same."""
    (tmp_path / "t.tcs").write_text("""#version 400
layout(vertices = 3) out;
void main()
{
    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
    gl_TessLevelInner[0] = gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = 3.0;
}
""")
    (tmp_path / "t.tes").write_text("""#version 400
layout(triangles) in;
out vec2 uv;
void main()
{
    uv = vec2(0.5);
    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position
                + gl_TessCoord.z * gl_in[2].gl_Position;
}
""")
    extra = stage("tcs", "t.tcs") + stage("tes", "t.tes") + level(0.5)
    items = item("Q", f"{QUAD}<topology>Patches</topology>")
    passes = shader_pass(items=items, extra=extra).replace('active="true"', 'patchverts="3"')
    pixels, warnings = drawn(leveled(tmp_path, passes))
    assert (pixels[..., 0] == 0.5).all() and warnings == []


@pytest.mark.parametrize("topology, stages", [("Patches", ""), ("LineList", stage("gs", "half.geom"))])
def test_a_topology_that_gl_refuses_draws_nothing(tmp_path, topology, stages):
    (tmp_path / "half.geom").write_text("""#version 330
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
in vec2 uv[];
void main() { for (int i = 0; i < 3; ++i) { gl_Position = gl_in[i].gl_Position; EmitVertex(); } }
""")
    write_quad(tmp_path, "color = vec4(1.0);")
    frag = (tmp_path / "quad.frag").read_text()
    (tmp_path / "quad.frag").write_text(frag.replace("in vec2 uv;\n", "").replace("vec4(uv, 0.0, 1.0)", "vec4(0.0)"))
    items = item("Q", f"{QUAD}<topology>{topology}</topology>")
    pixels, (warning,) = drawn(write_project(tmp_path, shader_pass(items=items, extra=stages)))
    assert (pixels[..., 0] == 0).all()
    assert warning.startswith('item "Q" of pass "Quad": nothing is drawn, because GL refuses its topology')


# ---- Compute passes ----------------------------------------------------------------------------------------------

FILL = """#version 430
layout(local_size_x = 1) in;
layout(rgba32f, binding = 0) uniform image2D picture;
layout(std430, binding = 1) buffer Counts { float counts[]; };
uniform float factor;
void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    counts[at.x] += 1.0;
    imageStore(picture, at, vec4(factor * counts[at.x], at, 1.0));
}
"""


def compute_project(folder):
    (folder / "fill.comp").write_text(FILL)
    write_quad(folder, "color = texelFetch(picture, ivec2(gl_FragCoord.x, 0), 0);", "uniform sampler2D picture;")
    fill = '<pass name="Fill" type="compute"><shader type="cs" path="fill.comp" entry="main" /><groupsize x="4" />'
    fill += variables(constant("factor", "float", 3)) + "</pass>"
    objects = """<object type="image" name="picture" width="4" height="1">
<bind slot="0" name="Fill" /><bind slot="0" name="Quad" /></object>
<object type="buffer" name="counts" size="16" format="float"><bind slot="3" name="Fill" /></object>"""
    write_buffer(folder, "counts", 0, 10, 20, 30)
    return write_project(folder, fill + shader_pass(), objects=objects)


def test_a_compute_pass_fills_an_image(tmp_path):
    renderer = renderer_of(compute_project(tmp_path))
    np.testing.assert_array_equal(renderer.floats()[0, :, :3], [(3, 0, 0), (33, 1, 0), (63, 2, 0), (93, 3, 0)])
    np.testing.assert_array_equal(renderer.targets()["picture"][0, :, 0], (3, 33, 63, 93))


def test_a_buffer_lasts_from_frame_to_frame(tmp_path):
    renderer = Renderer(compute_project(tmp_path), SIZE)
    for frame in range(3):
        renderer.draw(frame)
    np.testing.assert_array_equal(renderer.floats()[0, :, 0], (9, 39, 69, 99))


def test_a_storage_buffer_of_a_shader_pass(tmp_path):
    block = "layout(std430, binding = 0) buffer Numbers { float numbers[]; };"
    path = write_quad(
        tmp_path,
        "color = vec4(numbers[int(gl_FragCoord.x)]);",
        block,
        objects='<object type="buffer" name="b" size="16"><bind slot="2" name="Quad" /></object>',
    )
    for name in ("quad.vert", "quad.frag"):
        shader = tmp_path / name
        shader.write_text(shader.read_text().replace("#version 330", "#version 430"))
    write_buffer(tmp_path, "b", 1, 2, 3, 4)
    np.testing.assert_array_equal(floats(path)[0, :, 0], (1, 2, 3, 4))


def test_a_sampler_of_a_compute_pass_reads_its_own_binding(tmp_path):
    path = compute_project(tmp_path)
    fill = FILL.replace("uniform float factor;", "uniform float factor;\nlayout(binding = 1) uniform sampler2D second;")
    (tmp_path / "fill.comp").write_text(fill.replace("factor * counts[at.x]", "texture(second, vec2(0.5)).g"))
    write_texture(tmp_path, "a.png", (255, 0, 0))
    write_texture(tmp_path, "b.png", (0, 51, 0))
    objects = texture("a.png", 0, "Fill") + texture("b.png", 1, "Fill") + "</objects>"
    path.write_text(path.read_text().replace("</objects>", objects))
    pixels, warnings = drawn(path)
    assert pixels[0, 0, 0] == pytest.approx(0.2) and warnings == []
