"""Costs of whole fragment stages. Expected: what AMD's documents say of single instructions, and SPIR-V's weights."""

from __future__ import annotations

import pytest
from sprj_files import write_quad, write_texture

from harness import GlslError
from harness.costing import isa
from harness.interpreting import spirv
from harness.projects import sprj
from harness.tune.pictures import with_macros
from harness.tune.stage_cost import Costs, _stages, code

NO_DRIVER = pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))
#: a texture, a uniform, an input, and the macro MORE
HEAD = "uniform sampler2D map;\nuniform vec3 tint;\nfloat unused(float x) { return UNUSED; }"
BODY = "color = texture(map, uv) * vec4(tint, 1.0); MORE"


@pytest.fixture
def counted(tmp_path):
    """Costs of the stage, and their source, with each of some texts for MORE."""

    def count(*more: str, target: str = "vega10", head: str = HEAD, body: str = BODY, **macros: str):
        write_texture(tmp_path, "t.png")
        project = sprj.read(write_quad(tmp_path, body, head))
        passes = [with_macros(project.passes[0], {"MORE": text, "UNUSED": "x"} | macros) for text in more]
        costs = Costs(project, passes[:1], target)
        return costs, [c.cycles for c in costs.of(passes)]

    return count


@NO_DRIVER
@pytest.mark.parametrize(("target", "cycles"), [("vega10", 4), ("navi21", 2), ("gfx1100", 2)])
def test_instructions_cost_their_cycles(counted, target, cycles):
    """A GCN unit takes 16 of 64 lanes a cycle, an RDNA unit 32. In a short stage the texture would take longer."""
    product_and_fract = "color.r = fract(color.r * tint.x); "
    costs, (short, long) = counted(20 * product_and_fract, 30 * product_and_fract, target=target)
    assert costs.reason is None and costs.unit == f"{target} cycles" and costs.driver.startswith("Mesa")
    assert long - short == 10 * 2 * cycles


@NO_DRIVER
def test_what_is_not_read_is_not_counted(counted):
    _, (whole, without_map, nothing) = counted("", "color = vec4(tint * uv.x, 1.0);", "color = vec4(1.0);")
    assert whole > without_map > nothing


@NO_DRIVER
def test_inputs_of_all_types(counted):
    head = HEAD + "\nflat in int count; flat in uvec2 pair; in mat3 frame; in float many[3];"
    more = "color.rgb += frame * tint * float(count) + many[2] + float(pair.y);"
    costs, (plain, with_them) = counted("", more, head=head)
    assert costs.reason is None and with_them > plain


def test_the_uniforms_are_the_first_binding_and_textures_come_after():
    head = "#version 330\nuniform sampler2D a, b;\nin vec2 uv;\nout vec4 color;\n"
    main = "void main() { color = texture(b, uv) + texture(a, uv)"
    buffer, textures = {0: spirv.UNIFORM}, {1: spirv.UNIFORM_CONSTANT, 2: spirv.UNIFORM_CONSTANT}
    for text, wanted in (
        (f"{head}{main}; }}\n", textures),
        (f"{head}uniform vec4 tint;\n{main} + tint; }}\n", buffer | textures),
    ):
        _, fragment = _stages(text)
        module = spirv.read(fragment)
        bindings = {o[0]: o[2] for code, o in spirv.instructions(fragment.tolist()) if code == 71 and o[1] == 33}
        assert {place: module.variables[k].storage for k, place in bindings.items()} == wanted


def test_by_spirv_where_there_is_no_driver(counted, monkeypatch):
    monkeypatch.setattr(isa, "unavailable", lambda: "no driver today")
    costs, (plain, more) = counted("", "color.r = exp2(color.r);")
    assert (costs.reason, costs.unit) == ("no driver today", "SPIR-V operations")
    assert more - plain == 4


def test_by_spirv_where_the_stage_is_not_for_vulkan(counted):
    """An array of textures is none of those that there is room for."""
    head, body = HEAD + "\nuniform sampler2D maps[2];", BODY.replace("MORE", "color += texture(maps[1], uv); MORE")
    costs, (plain, more) = counted("", "color.r = exp2(color.r);", head=head, body=body)
    assert costs.reason is not None and more - plain == 4


def test_a_mistake_in_the_shader_is_the_users(counted):
    with pytest.raises(GlslError, match="quad.frag"):
        counted("color = nothing;")


def test_what_is_not_called_makes_no_difference(tmp_path):
    write_texture(tmp_path, "t.png")
    project = sprj.read(write_quad(tmp_path, BODY, HEAD))
    one, other, more = (
        code(project, with_macros(project.passes[0], {"MORE": more, "UNUSED": unused}))
        for more, unused in (("", "x"), ("", "x * x"), ("color.r += 1.0;", "x"))
    )
    assert one == other != more
