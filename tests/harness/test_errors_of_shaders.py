"""What a mistake in a shader, or in a call of it, is told as: the user's file and line, what is wrong, what there is.

Expected places are found in the text of the files by the marker ``HERE`` in a comment on the line at fault.
"""

from __future__ import annotations

import numpy as np
import pytest

from harness import CallError, GlslError, HarnessError, native, shader


@pytest.fixture
def write(tmp_path):
    def write(**files: str):
        for name, text in files.items():
            (tmp_path / f"{name}.glsl").write_text(text)
        return tmp_path / "main.glsl"

    return write


def refusal(action) -> HarnessError:
    with pytest.raises(HarnessError) as caught:
        action()
    return caught.value


def line_of_fault(text: str) -> int:
    return next(n for n, line in enumerate(text.split("\n"), 1) if "HERE" in line)


def assert_at_fault(error: HarnessError, path, text: str) -> None:
    """The error lies in the line with the mark, says so, and shows the line."""
    line = line_of_fault(text)
    assert isinstance(error, GlslError)
    assert (error.file, error.line) == (str(path), line)
    assert str(error).startswith(f"{path}:{line}: ")
    assert str(error) == f"{path}:{line}: {error.message}"


#: mistake -> a text with the mark on the line where compilers place it, and what they say
MISTAKES = {
    "syntax": ("float f() {\n    return 1.0 +; // HERE\n}\n", "syntax error"),
    "undeclared": ("float f() {\n    float x = 1.0;\n    return missing * x; // HERE\n}\n", "'missing' : undeclared"),
    "type": (
        "float f() {\n    return 1.0;\n}\nfloat g() {\n    vec2 v = f(); // HERE\n    return v.x;\n}\n",
        "convert",
    ),
    "unknown function": ("float f() {\n\n    return shade(1.0); // HERE\n}\n", "no matching overloaded function"),
    "missing semicolon": ("float f() {\n    float x = 1.0\n    return x; // HERE\n}\n", "syntax error"),
    "missing semicolon at the end": ("float f() { return 1.0; }\nfloat g; float h // HERE", "syntax error"),
    "missing brace at the end": ("float f() {\n    return 1.0; // HERE\n", "syntax error"),
    "unfinished comment": ("float f() { return 1.0; }\n/* HERE", "End of input in comment"),
    "unfinished #if": ("float f() { return 1.0; }\n#if 1\nfloat g; // HERE\n", "missing #endif"),
    "#error": ("float f() { return 1.0; }\n#error no, HERE\n", "no"),
    "unknown directive": ("float f() { return 1.0; }\n#defin X // HERE\n", "invalid directive"),
    "twice defined": ("float f() { return 1.0; }\nfloat f() { return 2.0; } // HERE\n", "already has a body"),
    "wrong return": ("struct S { float x; };\nS f() {\n    return 1.0; // HERE\n}\n", "'return' : type does not match"),
    "no return value": ("float f() {\n    return; // HERE\n}\n", "must return a value"),
    "assignment to a constant": ("const float K = 1.0;\nvoid f() {\n    K = 2.0; // HERE\n}\n", "can't modify a const"),
    "unknown member": ("struct S { float x; };\nfloat f(S s) {\n    return s.y; // HERE\n}\n", "no such field"),
    "a second version": ("float f() { return 1.0; }\n#version 330 // HERE\n", "must occur first"),
    "an unfinished macro": ("#define F(x) x\nfloat f() {\n    return F(1.0; // HERE\n}\n", ""),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_with_its_line(write, mistake):
    text, message = MISTAKES[mistake]
    path = write(main=text)
    error = refusal(lambda: shader(path))
    assert_at_fault(error, path, text)
    assert message in error.message


@pytest.mark.parametrize("mistake", ["syntax", "undeclared", "type", "missing semicolon"])
def test_the_line_is_shown(write, mistake):
    """White space and comments apart."""
    text, _ = MISTAKES[mistake]
    shown = refusal(lambda: shader(write(main=text))).message.split("\n")[1]
    fault = next(line for line in text.split("\n") if "HERE" in line)
    assert shown.partition("//")[0].split() == fault.partition("//")[0].split()


@pytest.mark.parametrize("mistake", ["syntax", "undeclared", "type", "unknown function", "#error"])
def test_a_mistake_in_an_included_file_is_told_there(write, mistake, tmp_path):
    text, message = MISTAKES[mistake]
    path = write(main='#version 330\n\n#include "outer.glsl"\n', outer='// one\n#include "inner.glsl"\n', inner=text)
    error = refusal(lambda: shader(path))
    assert_at_fault(error, tmp_path / "inner.glsl", text)
    assert message in error.message


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_below_includes_and_macros_is_told_there(write, mistake):
    text = '#include "inner.glsl"\n' + MISTAKES[mistake][0]
    path = write(main=text, inner="float inner_1;\nfloat inner_2;\nfloat inner_3;\n")
    assert_at_fault(refusal(lambda: shader(path, defines={"A": 1, "B(x)": "x"})), path, text)


def test_a_mistake_in_a_macro_names_the_macro(write):
    error = refusal(lambda: shader(write(main="float f() { return 1.0; }\n"), defines={"A": 1, "2B": 1}))
    assert str(error).startswith("macros:2: ")


def test_a_mistake_within_a_macro_is_told_where_it_is_used(write):
    text = "#define BAD missing\n\nfloat f() {\n    return BAD; // HERE\n}\n"
    path = write(main=text)
    assert_at_fault(refusal(lambda: shader(path)), path, text)


def test_several_mistakes_are_told_with_a_place_each(write):
    path = write(main="float f() { return a; }\n\nfloat g() { return b; }\n")
    error = refusal(lambda: shader(path))
    assert error.line == 1
    assert "'a' : undeclared" in error.message
    assert f"{path}:3: 'b' : undeclared" in error.message


def test_many_mistakes_are_not_all_told(write):
    path = write(main="".join(f"float f{n}() {{ return missing_{n}; }}\n" for n in range(20)))
    message = refusal(lambda: shader(path)).message
    assert "missing_0" in message
    assert "missing_19" not in message
    assert message.splitlines()[-1].startswith("... and ")


# ---- What only the driver refuses ------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", ["as-written", "precise"])
def test_a_mistake_that_only_the_driver_finds_is_told_with_its_line(write, mode):
    """glslang lets a parameter of a definition go without a name; Mesa does not."""
    native.open_context()
    if "Mesa" not in native.context_info()["version"]:
        pytest.skip("another driver may take it")
    text = '#include "inner.glsl"\nfloat f(float x) { return x; }\nfloat g(float) { return 3.0; } // HERE\n'
    path = write(main=text, inner="float one;\nfloat two;\n")
    error = refusal(lambda: shader(path, mode=mode, defines={"A": 1}).f(1))
    assert_at_fault(error, path, text)
    assert "lacks a name" in error.message


def test_a_recursive_function_is_refused_by_name(write):
    """glslang does not see it before linking; the driver does."""
    text = "float g(float x);\nfloat f(float x) { return g(x); }\nfloat g(float x) { return f(x); }\n"
    error = refusal(lambda: shader(write(main=text)).f(1))
    assert isinstance(error, GlslError)
    assert error.file.endswith("main.glsl")
    assert "recursi" in error.message


def test_a_function_without_a_body_is_refused_by_name(write):
    text = "float g(float x);\nfloat f(float x) { return g(x); }\n"
    error = refusal(lambda: shader(write(main=text)).f(1))
    assert isinstance(error, GlslError)
    assert "main.glsl" in str(error)
    assert "`g" in error.message or "'g" in error.message or "g(" in error.message


# ---- Calls -----------------------------------------------------------------------------------------------------------

CALLED = """struct Light { vec3 direction; float power; };
uniform float gain;

float f(vec3 v, float s) { return v.x * s; }
float lit(Light light) { return light.power; }
float chosen(int i, uint u, bool b) { return float(i); }
float gained(float x) { return gain * x; }
float many(float x) { return x; }
float many(vec3 x) { return x.x; }
vec2 of_array(float x[3]) { return vec2(x[0]); }
float of_lights(Light l[2]) { return l[0].power; }
void nothing(float x) { }
float sampled(sampler2D map) { return 1.0; }
"""
LIGHT = {"direction": [0, 0, 1], "power": 2}

#: call -> the function, the call, and what the message says
CALLS = {
    "too few": ("f", lambda f: f([1, 2, 3]), "f lacks s; it is float f(vec3 v, float s)"),
    "none": ("f", lambda f: f(), "f lacks v, s"),
    "too many": ("f", lambda f: f([1, 2, 3], 1, 2), "f takes 2 arguments, got 3"),
    "twice": ("f", lambda f: f([1, 2, 3], 1, v=[1, 2, 3]), "f got v twice"),
    "unknown keyword": ("f", lambda f: f([1, 2, 3], 1, t=1), "has no parameter t and reads no such uniform"),
    "shape": ("f", lambda f: f([1, 2], 1), "v is a vec3: an array of shape (..., 3), got (2,)"),
    "scalar for vector": ("f", lambda f: f(1, 1), "v is a vec3: an array of shape (..., 3), got ()"),
    "broadcast": ("f", lambda f: f(np.ones((4, 3)), np.ones(5)), "do not broadcast: v (4,), s (5,)"),
    "ragged": ("f", lambda f: f([1, [2, 3]], 1), "v is no array"),
    "text": ("f", lambda f: f("abc", 1), "v is a vec3, got numbers of type <U3"),
    "nothing given": ("f", lambda f: f(None, 1), "v is a vec3, got None"),
    "complex": ("f", lambda f: f([1j, 2, 3], 1), "got numbers of type complex128"),
    "float for int": ("chosen", lambda f: f(1.5, 1, True), "i is an int, got numbers of type float64; it is"),
    "int for bool": ("chosen", lambda f: f(1, 1, 1), "b is a bool, got numbers of type int64"),
    "bool for int": ("chosen", lambda f: f(True, 1, True), "i is an int, got numbers of type bool"),
    "int too large": ("chosen", lambda f: f(2**31, 1, True), "i is an int: -2147483648 ... 2147483647"),
    "negative uint": ("chosen", lambda f: f(1, -1, True), "u is a uint: 0 ... 4294967295"),
    "uint too large": ("chosen", lambda f: f(1, 2**32, True), "u is a uint: 0 ... 4294967295"),
    "array for struct": ("lit", lambda f: f([1, 2, 3]), "light is a Light: a dict of direction, power, got list"),
    "struct lacks a member": ("lit", lambda f: f({"power": 1}), "a dict of direction, power, got power"),
    "struct has one too many": ("lit", lambda f: f(LIGHT | {"size": 1}), "got direction, power, size"),
    "member's shape": ("lit", lambda f: f(LIGHT | {"direction": 1}), "light.direction is a vec3"),
    "array's length": ("of_array", lambda f: f([1, 2]), "x is a float[3]: an array of shape (..., 3), got (2,)"),
    "number for structs": ("of_lights", lambda f: f(1), "l is a Light[2]: 2 values, got int"),
    "dict for structs": ("of_lights", lambda f: f(LIGHT), "l is a Light[2]: 2 values, got dict"),
    "too few structs": ("of_lights", lambda f: f([LIGHT]), "l is a Light[2]: 2 values, got 1"),
    "member of an element": ("of_lights", lambda f: f([LIGHT, LIGHT | {"power": "x"}]), "l[1].power is a float"),
    "uniform missing": ("gained", lambda f: f(1), "gained reads the uniform float gain: give it by its name"),
    "uniform's shape": ("gained", lambda f: f(1, gain=[1, 2]), "uniform gain is one float, not an array of them"),
    "uniform's type": ("gained", lambda f: f(1, gain="x"), "gain is a float, got numbers of type <U1"),
    "uniform of another": ("f", lambda f: f([1, 2, 3], 1, gain=1), "has no parameter gain and reads no such uniform"),
    "nothing comes back": ("nothing", lambda f: f(1), "void nothing(float x) yields nothing"),
    "sampler": ("sampled", lambda f: f(1), "map is a sampler2D, which cannot be given as an array"),
}


@pytest.fixture(scope="module")
def called(tmp_path_factory):
    path = tmp_path_factory.mktemp("called") / "main.glsl"
    path.write_text(CALLED)
    return shader(path)


@pytest.mark.parametrize("call", CALLS)
def test_a_wrong_call_says_what_was_expected_and_where_it_is(called, call):
    name, make, message = CALLS[call]
    error = refusal(lambda: make(called[name]))
    assert isinstance(error, CallError)
    assert isinstance(error, TypeError)
    assert message in error.message
    assert error.file.endswith("main.glsl")
    assert f" {name}(" in CALLED.split("\n")[error.line - 1]
    assert str(error) == f"{error.file}:{error.line}: {error.message}"


#: call -> the whole message, with the place
EXACT = {
    "no such function": (
        lambda s: s.sampledd,
        "{file}: no function sampledd; did you mean sampled? There are: "
        "f, lit, chosen, gained, many, of_array, of_lights, nothing, sampled",
    ),
    "no such function, by its case": (
        lambda s: s["GAINED"],
        "{file}: no function GAINED; did you mean gained? There are: "
        "f, lit, chosen, gained, many, of_array, of_lights, nothing, sampled",
    ),
    "too many arguments": (
        lambda s: s.gained(1, 2, gain=3),
        "{file}:7: gained takes 1 argument, got 2; it is float gained(float x)",
    ),
    "too few arguments": (
        lambda s: s.chosen(1),
        "{file}:6: chosen lacks u, b; it is float chosen(int i, uint u, bool b)",
    ),
    "an argument under another name": (
        lambda s: s.lit(ligth=LIGHT),
        "{file}:5: lit lacks light, got ligth; did you mean light?; it is float lit(Light light)",
    ),
    "a scalar for a vector": (
        lambda s: s.f(1, 1),
        "{file}:4: v is a vec3: an array of shape (..., 3), got (); it is float f(vec3 v, float s)",
    ),
    "a wrong length": (
        lambda s: s.f(np.ones((5, 4)), 1),
        "{file}:4: v is a vec3: an array of shape (..., 3), got (5, 4); it is float f(vec3 v, float s)",
    ),
    "a wrong type": (
        lambda s: s.f([1, 2, 3], "x"),
        "{file}:4: s is a float, got numbers of type <U1; it is float f(vec3 v, float s)",
    ),
    "an object": (
        lambda s: s.f([1, 2, 3], object()),
        "{file}:4: s is a float, got an object of type object; it is float f(vec3 v, float s)",
    ),
    "an iterator": (
        lambda s: s.f([1, 2, 3], iter([1])),
        "{file}:4: s is a float, got an iterator: stream() takes one, chunk by chunk; it is float f(vec3 v, float s)",
    ),
    "NaN for an int": (
        lambda s: s.chosen([1, np.nan], 1, True),
        "{file}:6: i is an int, got numbers of type float64 (nan among them); "
        "it is float chosen(int i, uint u, bool b)",
    ),
    "shapes that do not go together": (
        lambda s: s.f(np.ones((4, 3)), np.ones((2, 3))),
        "{file}:4: the arguments do not broadcast: v (4,), s (2, 3); it is float f(vec3 v, float s)",
    ),
    "members that do not go together": (
        lambda s: s.lit({"direction": np.ones((4, 3)), "power": [1, 2]}),
        "{file}:5: the arguments do not broadcast: light.direction (4,), light.power (2,); "
        "it is float lit(Light light)",
    ),
    "an unknown keyword": (
        lambda s: s.gained(1, gian=1),
        "{file}:7: float gained(float x) has no parameter gian and reads no such uniform; did you mean gain?",
    ),
    "a missing uniform": (
        lambda s: s.gained(1),
        "{file}:7: gained reads the uniform float gain: give it by its name",
    ),
    "a wrong member": (
        lambda s: s.lit({"direction": [0, 0, 1], "powr": 2}),
        "{file}:5: light is a Light: a dict of direction, power, got direction, powr; did you mean power?; "
        "it is float lit(Light light)",
    ),
    "an unknown mode": (
        lambda s: s.f.with_mode("precice"),
        "no mode 'precice'; did you mean precise? There are: as-written, precise",
    ),
}


@pytest.mark.parametrize("fault", EXACT)
def test_what_a_wrong_call_is_told(called, fault):
    make, message = EXACT[fault]
    error = refusal(lambda: make(called))
    assert isinstance(error, CallError)
    assert str(error) == message.format(file=error.file)


def test_an_unknown_function_lists_those_that_there_are(called):
    error = refusal(lambda: called.g)
    assert error.message == (
        "no function g; there are: f, lit, chosen, gained, many, of_array, of_lights, nothing, sampled"
    )
    assert str(error).startswith(error.file)


def test_an_unknown_function_is_an_unknown_attribute(called):
    assert not hasattr(called, "g")
    assert getattr(called, "g", None) is None


def test_a_file_without_functions_says_so(write):
    assert "there are: none at all" in refusal(lambda: shader(write(main="uniform float x;\n")).f).message


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda s: s.many(np.ones(2), 1),
            "many: no overload fits these arguments; there are:"
            "\n    float many(float x): many takes 1 argument, got 2"
            "\n    float many(vec3 x): many takes 1 argument, got 2",
        ),
        (
            lambda s: s.many("x"),
            "many: no overload fits these arguments; there are:"
            "\n    float many(float x): x is a float, got numbers of type <U1"
            "\n    float many(vec3 x): x is a vec3, got numbers of type <U1",
        ),
        (
            lambda s: s.many(np.ones(3)),  # a vec3, or three floats
            'many: more than one overload fits these arguments; choose one by shader["many(float)"]; there are:'
            "\n    float many(float x)\n    float many(vec3 x)",
        ),
    ],
)
def test_overloads_are_listed_where_none_or_several_fit(called, call, message):
    error = refusal(lambda: call(called))
    assert error.message == message
    assert error.file.endswith("main.glsl")


def test_an_unknown_mode_lists_those_that_there_are(called):
    assert "no mode 'exact'; there are: as-written, precise" in str(refusal(lambda: called.with_mode("exact")))


def test_a_wrong_call_leaves_the_function_usable(called):
    refusal(lambda: called.f([1, 2], 1))
    assert called.f([1, 2, 3], 4) == 4
