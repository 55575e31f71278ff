"""The costs on GPUs that are not there: what the driver says, what is taken from it, and what is refused."""

from __future__ import annotations

import json

import pytest

from harness import CallError, HarnessError, ladder, shader
from harness.costing import isa

pytestmark = pytest.mark.skipif(isa.unavailable() is not None, reason=str(isa.unavailable()))

EXPECTED = "tests/cost/expected.json"

#: cycles of a wave of 64, as AMD's ISA documents have them: a GCN unit takes 16 lanes a cycle, an RDNA unit 32; a
#: transcendental runs at a quarter of the rate, on RDNA in a unit of its own beside the other instructions
CYCLES = {"vega10": 4, "navi21": 2, "gfx1100": 2}


def assert_equal_tables(got, want):
    """Both as tables, row by row, when they differ."""
    rows = [
        f"  {name:<46} {target:<8} {str(got[name][target]):<22} {want.get(name, {}).get(target)}"
        for name in got
        for target in got[name]
        if got[name][target] != want.get(name, {}).get(target)
    ]
    head = "  function, chip, [instructions, VGPRs, latency, cycles], expected"
    assert not rows, "\n".join(["the costs are others:", head, *rows, "all of them:", json.dumps(got)])


@pytest.fixture(scope="module")
def rungs(root):
    """Name -> function: shade() on every rung and in every preset, a rung's own function, and those of the exercise."""
    steps = ladder.load(root / "shaders" / "ladder.toml")
    brdf = root / "shaders" / "brdf.glsl"
    found = {"shade": shader(brdf)["shade"]}
    for term in steps.terms:
        for rung in term.rungs:
            file = root / "shaders" / term.file
            name = "shade" if file == brdf else term.function
            found[f"{name} {rung.value}"] = shader(file, {term.macro: rung.value})[name]
    for preset in steps.presets:
        found[f"shade as {preset.name}"] = shader(brdf, preset.macros)["shade"]
    for rung in ("F_MULTIPLY", "F_POW"):
        found[f"shade_exercise {rung}"] = shader(brdf, {"BRDF_F": rung})["shade_exercise"]
    for name in ("D_GGX", "V_SmithGGXCorrelated", "V_Hammon", "F_Schlick"):
        found[name] = shader(brdf)[name]
    return found


@pytest.fixture(scope="module")
def costs(rungs):
    """(name, target) -> Cost."""
    return {
        (name, target): cost
        for target in isa.TARGETS
        for name, cost in zip(rungs, isa.costs(list(rungs.values()), target), strict=True)
    }


def test_what_every_rung_costs(rungs, costs, root):
    """A rung that has become dearer, or cheaper, is told with its numbers. Another Mesa has others."""
    known = json.loads((root / EXPECTED).read_text())
    driver = next(iter(costs.values())).driver
    if driver not in known:
        pytest.skip(f"{EXPECTED} has costs for {', '.join(known)}, not for {driver}")
    got = {
        name: {
            target: [cost.instructions, cost.vgprs, cost.latency, cost.inverse_throughput]
            for target in isa.TARGETS
            for cost in (costs[name, target],)
        }
        for name in rungs
    }
    assert_equal_tables(got, known[driver])


def test_the_arrangement_of_the_exercise_costs_what_was_found_elsewhere(costs):
    """Its cycles beyond a null stage with another program and harness: 336 on GCN 5, 138 on RDNA 2; with pow 360."""
    assert costs["shade_exercise F_MULTIPLY", "vega10"].inverse_throughput == 336
    assert costs["shade_exercise F_MULTIPLY", "navi21"].inverse_throughput == 138
    assert costs["shade_exercise F_POW", "vega10"].inverse_throughput == 360


def test_Hammons_V_saves_two_square_roots_and_two_products(costs):
    """On GCN two of 16 cycles and two of 4, on RDNA the four instructions' two each."""
    for target, saving in (("vega10", 40), ("navi21", 8), ("gfx1100", 8)):
        exact, cheap = costs["shade", target], costs["shade V_HAMMON", target]
        assert exact.inverse_throughput - cheap.inverse_throughput == saving


def test_the_model_of_the_chip_is_the_drivers(rungs):
    """Cycles counted in the assembly are the driver's figure wherever there is no branch, null stages included."""
    from harness.costing import cost_stage

    made = [cost_stage.stages(function) for function in rungs.values()]
    for target in isa.TARGETS:
        pairs = [(s.vertex, words) for s in made for words in (s.fragment, s.null)]
        for compiled in isa._run(pairs, target):
            assert isa.vector_cycles(compiled["assembly"], target) == compiled["statistics"]["Inverse Throughput"]


# ---- Functions whose cost is known -----------------------------------------------------------------------------------


@pytest.mark.parametrize("target", isa.TARGETS)
def test_a_multiply_add_is_one_instruction(functions, target):
    chain = "float f(float x, float y) {{ return {}; }}"
    short, long = "x * y + x", "((x * y + x) * y + x) * x + y"
    fewer, more = isa.costs([functions(chain.format(text)).f for text in (short, long)], target)
    assert more.instructions - fewer.instructions == 2
    assert more.inverse_throughput - fewer.inverse_throughput == 2 * CYCLES[target]


def test_a_square_root_runs_at_a_quarter_of_the_rate_on_gcn(functions):
    both = functions("float f(float x) { return x * x; } float g(float x) { return sqrt(x * x + 1.5); }")
    # beyond f: the addition, which becomes part of the product, and the root
    product, root = isa.costs([both.f, both.g], "vega10")
    assert root.inverse_throughput - product.inverse_throughput == 16


@pytest.mark.parametrize("target", isa.TARGETS)
def test_modifiers_are_free(functions, target):
    plain = functions("float f(float x, float y) { return x * y + x; }")
    modified = functions("float f(float x, float y) { return clamp(-x * abs(y) + x, 0.0, 1.0); }")
    without, with_them = isa.costs([plain.f, modified.f], target)
    assert with_them.inverse_throughput == without.inverse_throughput
    assert with_them.instructions == without.instructions


@pytest.mark.parametrize("target", isa.TARGETS)
def test_a_block_under_an_if_counts_in_full(functions, target):
    """The driver takes three quarters of it. It is what the same code costs with no if, and the test on top of it."""
    code = "float r = exp2(x); for (int k = 0; k < 24; ++k) r = r * x + y; {} return r;"
    straight = functions(f"float f(float x, float y) {{ {code.format('')} }}").f
    under_if = functions(f"float f(float x, float y) {{ if (x > y) {{ {code.format('')} }} return x; }}").f
    whole, flattered = isa.costs([straight, under_if], target)
    assert not whole.branches
    assert flattered.branches
    assert 0 <= flattered.inverse_throughput - whole.inverse_throughput <= 6 * CYCLES[target]


def test_nothing_is_folded_because_two_inputs_are_alike(functions):
    """f(x, y) with the same formula for both costs two of it, whatever the compiler might know of the inputs."""
    texts = ("x + y * exp2(x)", "exp2(y) + y * exp2(x)")
    compiled = [functions(f"float f(float x, float y) {{ return {text}; }}").f for text in texts]
    one, two = isa.costs(compiled, "vega10")
    assert two.inverse_throughput - one.inverse_throughput == 16


def test_every_kind_of_argument_and_result(functions):
    """Structs, arrays, matrices, whole numbers, truth values, out and inout."""
    text = """
        struct Inner {{ mat2x3 a; bool b; }};
        struct Outer {{ Inner inner[2]; ivec2 c; }};
        uvec3 f(Outer o, inout vec4 p, out mat3 q, out bool r) {{
            vec3 s = o.inner[0].a * p.xy + o.inner[1].a * p.zw;
            q = mat3(s, s.yzx, s.zxy) {};
            r = o.inner[0].b || o.inner[1].b;
            p *= float(o.c.x + o.c.y);
            return uvec3(s);
        }}
    """
    plain, scaled = isa.costs([functions(text.format(more)).f for more in ("", "* exp2(p.x)")], "vega10")
    assert scaled.inverse_throughput - plain.inverse_throughput == 16 + 3 * 4  # three of the nine products differ


def test_a_function_without_arguments_costs_as_its_stage_does(functions):
    assert isa.cost(functions("float f() { return 2.5; }").f).inverse_throughput == 0


# ---- Refusals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("uniform vec3 tint; vec3 f(vec3 x) { return x * tint; }", ["test.glsl:1:", "uniforms"]),
        ("uniform sampler2D map;\nvec4 f(vec2 x) { return texture(map, x); }", ["test.glsl:2:", "textures"]),
        ("float f(float x) { return x; } float f(vec2 x) { return x.y; }", ["overloaded", "float f(vec2 x)"]),
        ("void f(float x) {}", ["test.glsl:1:", "void f(float x)", "yields nothing"]),
        ("float f(float x[200]) { return x[7]; }", ["test.glsl:1:", "more numbers"]),
    ],
)
def test_what_cannot_be_counted_is_said(functions, text, parts):
    with pytest.raises(CallError) as caught:
        isa.cost(functions(text).f)
    for part in parts:
        assert part in str(caught.value)


def test_a_uniform_that_is_not_read_does_no_harm(functions):
    text = "uniform vec3 tint; vec3 g() { return tint; } vec3 f(vec3 x) { return x * 2.5; }"
    plain = functions("vec3 f(vec3 x) { return x * 2.5; }")
    assert isa.cost(functions(text).f) == isa.cost(plain.f)


def test_other_modes_are_refused(functions):
    with pytest.raises(CallError, match="'precise'"):
        isa.cost(functions("float f(float x) { return x; }", mode="precise").f)


def test_an_unknown_chip_lists_those_there_are(functions):
    with pytest.raises(HarnessError, match="voodoo2.*navi21"):
        isa.cost(functions("float f(float x) { return x; }").f, "voodoo2")


def test_without_a_driver_the_reason_and_the_remedy_are_said(functions, monkeypatch):
    monkeypatch.setenv("VK_LOADER_DRIVERS_SELECT", "no such driver")
    with pytest.raises(HarnessError, match="navi21.*make cost"):
        isa.cost(functions("float f(float x) { return x; }").f)


def test_a_program_that_is_not_there_is_named(functions, monkeypatch):
    monkeypatch.setenv(isa.PROGRAM_VARIABLE, "/nowhere/harness_isa")
    with pytest.raises(HarnessError, match="/nowhere/harness_isa"):
        isa.cost(functions("float f(float x) { return x; }").f)
