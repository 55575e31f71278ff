"""ladder.toml: the project's says what its shaders have, and a bad one is told in one line with its file and key."""

from __future__ import annotations

import re

import pytest
from sprj_files import read, shader_pass, write_project

from harness import LadderError, ladder, shader
from harness.language.glsl import VERSION, load
from harness.projects import sprj
from harness.searching.domain import samples

LADDER = """
[[term]]
name = "V"
title = "Visibility"
macro = "BRDF_V"
file = "brdf.glsl"
function = "visibility"
exact = "V_EXACT"
inputs = { NoL = "[0,1]" }
[[term.rung]]
value = "V_EXACT"
title = "Smith"
source = "Heitz 2014"
domain = "everywhere"
suits = ["desktop", "mobile"]
[[term.rung]]
value = "V_HAMMON"
title = "Hammon"
source = "Hammon 2017"
domain = "everywhere"
suits = []
[[preset]]
name = "fast"
title = "Fast"
source = "us"
[preset.macros]
BRDF_V = "V_HAMMON"
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "brdf.glsl").write_text("float visibility(float NoL) { return NoL; }\n")
    return tmp_path


def written(folder, text):
    path = folder / "ladder.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def own(root):
    return ladder.of_project(sprj.read(root / "project.sprj"))


# ---- The project's own -----------------------------------------------------------------------------------------------


def test_the_project_has_the_ladder_beside_its_shaders(own, root):
    assert own.path.resolve() == root / "shaders" / "ladder.toml"
    assert [term.macro for term in own.terms] == [
        "BRDF_D",
        "BRDF_V",
        "BRDF_F",
        "BRDF_DIFFUSE",
        "BRDF_MULTI",
        "SRGB_DECODE",
    ]
    assert [preset.name for preset in own.presets] == ["exercise", "exact", "default", "desktop", "mobile", "offline"]


def text_of(own, file):
    """A shader's text with its includes."""
    return load(own.path.parent / file, library=True, version=VERSION).text


def choices(text, macro):
    """The numbered macros above a macro's default in a shader's text, and the default."""
    match = re.search(rf"((?:^#define \w+ +\d+.*\n)+)#ifndef {macro}\n#define {macro} (\w+)", text, re.MULTILINE)
    return dict(re.findall(r"^#define (\w+) +(\d+)", match[1], re.MULTILINE)), match[2]


def test_it_lists_the_rungs_that_the_shaders_have_in_the_order_of_their_numbers(own):
    for term in own.terms:
        numbers, default = choices(text_of(own, term.file), term.macro)
        assert [rung.value for rung in term.rungs] == list(numbers), term.macro
        assert list(numbers.values()) == [str(n) for n in range(len(numbers))], term.macro
        assert default in numbers


def test_every_macro_of_rungs_in_the_shaders_is_in_it(own):
    """A macro with a default of its own among numbered ones is a ladder; but the tone curve, which is no model."""
    text = "".join(text_of(own, name) for name in ("brdf.glsl", "color.glsl"))
    found = set(re.findall(r"^#define \w+ +\d+.*\n#ifndef (\w+)", text, re.MULTILINE))
    assert found == {term.macro for term in own.terms} | {"TONE_CURVE"}


def test_the_default_preset_is_what_the_shaders_default_to(own):
    defaults = {term.macro: choices(text_of(own, term.file), term.macro)[1] for term in own.terms}
    assert defaults == own.preset("default").macros


def test_the_exact_preset_is_each_terms_exact_rung(own):
    assert own.preset("exact").macros == {term.macro: term.exact for term in own.terms}


def test_the_default_differs_from_the_exact_by_a_cheaper_D_and_the_exercises_decoding(own):
    exact = own.preset("exact").macros
    assert own.preset("default").macros == {**exact, "BRDF_D": "D_PROJECT", "SRGB_DECODE": "SRGB_POWER"}


def test_every_term_is_a_function_of_the_inputs_that_it_states(own):
    for term in own.terms:
        function = shader(own.path.parent / term.file)[term.function]
        assert len(samples(function, term.inputs, 10)) > 0


def test_a_title_is_said_once(own):
    titles = [rung.title for term in own.terms for rung in term.rungs]
    assert len(titles) == len(set(titles))
    assert {suit for term in own.terms for rung in term.rungs for suit in rung.suits} == {
        "desktop",
        "mobile",
        "offline",
    }


# ---- Reading ---------------------------------------------------------------------------------------------------------


def test_what_is_written_is_read(folder):
    found = ladder.load(written(folder, LADDER))
    (term,) = found.terms
    assert found.path == folder / "ladder.toml"
    assert (term.name, term.title, term.macro, term.file) == ("V", "Visibility", "BRDF_V", "brdf.glsl")
    assert (term.function, term.exact, term.inputs) == ("visibility", "V_EXACT", {"NoL": "[0,1]"})
    assert term.rungs[0] == ladder.Rung("V_EXACT", "Smith", "Heitz 2014", "everywhere", ("desktop", "mobile"))
    assert [rung.value for rung in term.rungs] == ["V_EXACT", "V_HAMMON"]
    assert found.presets == (ladder.Preset("fast", "Fast", "us", {"BRDF_V": "V_HAMMON"}),)
    assert found.term("BRDF_V") is term
    assert found.preset("fast") is found.presets[0]


def test_presets_may_be_missing(folder):
    assert ladder.load(written(folder, LADDER.partition("[[preset]]")[0])).presets == ()


@pytest.mark.parametrize(
    ("found", "put", "message"),
    [
        ('title = "Visibility"\n', "", 'term "V": title is missing: a text'),
        ('title = "Visibility"', "title = 3", 'term "V": title must be a text'),
        ('title = "Visibility"', 'title = " "', 'term "V": title must be a text'),
        ('name = "V"\n', "", "term 1: name is missing: a text"),
        ('inputs = { NoL = "[0,1]" }', 'inputs = "[0,1]"', 'term "V": inputs must be a table of texts'),
        ('inputs = { NoL = "[0,1]" }', "inputs = { NoL = 1 }", 'term "V": inputs must be a table of texts'),
        ("suits = []", "suits = [1]", 'term "V", rung "V_HAMMON": suits must be a list of texts'),
        ("suits = []", 'suits = "all"', 'term "V", rung "V_HAMMON": suits must be a list of texts'),
        ("suits = []\n", "", 'term "V", rung "V_HAMMON": suits is missing: a list of texts'),
        (
            "suits = []",
            "suits = []\nsuit = 1",
            'term "V", rung "V_HAMMON": suit means nothing here; did you mean suits?',
        ),
        (
            'exact = "V_EXACT"',
            'exact = "V_EXAKT"',
            'term "V": exact = "V_EXAKT" is none of its rungs; did you mean V_EXACT?',
        ),
        ('file = "brdf.glsl"', 'file = "no.glsl"', 'term "V": file = "no.glsl" is not there, beside the ladder'),
        ('value = "V_HAMMON"', 'value = "V_EXACT"', 'the file: [[term.rung]] value = "V_EXACT" is there twice'),
        (
            'BRDF_V = "V_HAMMON"',
            'BRDF_V = "V_HAMON"',
            'preset "fast": macros.BRDF_V = "V_HAMON" is no rung of it; did you',
        ),
        ('BRDF_V = "V_HAMMON"', 'BRDF_W = "V_HAMMON"', 'preset "fast": macros.BRDF_W is the macro of no term; did you'),
        ('BRDF_V = "V_HAMMON"', "", 'preset "fast": macros lacks BRDF_V: a preset has a rung of every term'),
        ('source = "us"', 'source = "us"\ncolor = "red"', 'preset "fast": color means nothing here'),
        ("[[preset]]", '[[preset]]\nname = "slow"\n[[preset]]', 'preset "slow": title is missing: a text'),
        ("[[term]]", "[other]\n[[term]]", "the file: other means nothing here"),
        ('exact = "V_EXACT"', 'exact = "V_EXACT"\nsort = 1', 'term "V": sort means nothing here'),
        ("[[term]]", "[[term]", "malformed TOML: "),
    ],
)
def test_a_bad_file_is_told_in_one_line_with_its_key(folder, found, put, message):
    assert found in LADDER
    path = written(folder, LADDER.replace(found, put, 1))
    with pytest.raises(LadderError) as error:
        ladder.load(path)
    assert str(error.value).startswith(f"{path}: {message}")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("text", ["", "term = []", "term = 3", "[term]\nname = 1"])
def test_a_file_without_terms_is_none(folder, text):
    with pytest.raises(LadderError, match=r"the file: term (is missing: |must be )tables, each as \[\[\.\.\.term\]\]"):
        ladder.load(written(folder, text))


def test_two_terms_of_a_name_or_macro_are_told(folder):
    term = LADDER.partition("[[preset]]")[0]
    other = term.replace('"V"', '"W"')
    with pytest.raises(LadderError, match=r'\[\[term\]\] name = "V" is there twice'):
        ladder.load(written(folder, term + term))
    with pytest.raises(LadderError, match=r'\[\[term\]\] macro = "BRDF_V" is there twice'):
        ladder.load(written(folder, term + other))


def test_two_presets_of_a_name_are_told(folder):
    _, head, preset = LADDER.partition("[[preset]]")
    with pytest.raises(LadderError, match=r'\[\[preset\]\] name = "fast" is there twice'):
        ladder.load(written(folder, LADDER + head + preset))


def test_a_file_that_is_not_there_or_no_text_is_told(folder):
    with pytest.raises(LadderError, match=r"ladder\.toml: cannot read the ladder: No such file"):
        ladder.load(folder / "ladder.toml")
    (folder / "ladder.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(LadderError, match="malformed TOML"):
        ladder.load(folder / "ladder.toml")


def test_what_is_not_in_it_is_told_with_what_is(own):
    with pytest.raises(
        LadderError, match=r"there is no preset dektop; did you mean desktop\? There are: exercise, exact"
    ):
        own.preset("dektop")
    with pytest.raises(LadderError, match="there is no term with the macro BRDF_W; did you mean BRDF_"):
        own.term("BRDF_W")


def test_a_project_without_a_ladder_is_told_where_it_was_looked_for(tmp_path):
    project = read(write_project(tmp_path, shader_pass("One")))
    with pytest.raises(LadderError, match=r"\.sprj: there is no ladder\.toml beside its shaders"):
        ladder.of_project(project)
