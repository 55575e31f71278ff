"""``harness submission``: what is in the archive, what the report says, and what is refused."""

from __future__ import annotations

import base64
import io
import os
import re
import shutil
import stat
import subprocess
import sys
import zipfile
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from sprj_files import QUAD_VERT, shader_pass, texture, write_project, write_texture

from harness import HarnessError, render, sprj, submission
from harness.submission import contents, evidence, exercise

SIZE = (64, 36)

FRAGMENT = """#version 330
#ifdef GL_GOOGLE_include_directive
#extension GL_GOOGLE_include_directive : enable
#endif
#include "library/tint.glsl"
uniform sampler2D picture;
in vec2 uv;
out vec4 color;
void main()
{
    if (uv.x > 0.5)
        discard;
    color = vec4(tint(texture(picture, uv).rgb), 1.0);
}
"""
TINT = """// What is above.

// A colour made redder; <b> & co. are no tags.
vec3 tint(
    vec3 c)
{
    return c * vec3(1.0, 0.5, 0.25);
}
"""
EXERCISE = """
title = "Small & sweet"
course = "Course"
summary = "Summary"
alt = "A half"
tests = ["tests"]

[[part]]
name = "1"
title = "A tint"
points = 3
asked = "A tint."
done = "It is there."
tests = ["tests/test_small.py::test_that_passes"]
[[part.region]]
pass = "Quad"
caption = "The left half."
[[part.shader]]
file = "shaders/library/tint.glsl"
function = "tint"
"""
TESTS = """import pytest

@pytest.mark.parametrize("n", range(3))
def test_that_passes(n):
    pass

@pytest.mark.skip
def test_that_is_skipped():
    pass
"""
NAMES = [
    "project.sprj",
    "report.html",
    "shaders/library/tint.glsl",
    "shaders/quad.frag",
    "shaders/quad.vert",
    "textures/red.png",
]


def write_small(folder: Path) -> Path:
    """A project of one pass, drawn to the left half, with an include, a texture, tests, and files it does not use."""
    for name in ("shaders/library", "textures", "docs", "tests"):
        (folder / name).mkdir(parents=True)
    (folder / "shaders/quad.vert").write_text(QUAD_VERT)
    (folder / "shaders/quad.frag").write_text(FRAGMENT)
    (folder / "shaders/library/tint.glsl").write_text(TINT)
    (folder / "shaders/unused.glsl").write_text(TINT)
    write_texture(folder, "textures/red.png", (200, 100, 50))
    write_texture(folder, "textures/unused.png")
    (folder / "textures/make_textures.py").write_text("")
    (folder / exercise.FILE).write_text(EXERCISE)
    (folder / "tests/test_small.py").write_text(TESTS)
    layout = '<inputlayout><item value="Position" semantic="P" /><item value="Texcoord" semantic="T" /></inputlayout>'
    passes = shader_pass(fragment="shaders/quad.frag", extra=layout).replace('"quad.vert"', '"shaders/quad.vert"')
    settings = '<entry type="ipaths"><path>shaders</path></entry>'
    return write_project(folder, passes, objects=texture("textures/red.png"), settings=settings)


def make(project: Path, **options):
    output = project.parent / "build" / "submission.zip"
    submission.make(project, output, size=SIZE, supersample=1, **options)
    return output.read_bytes()


@pytest.fixture
def small(tmp_path):
    return write_small(tmp_path / "small")


@pytest.fixture(scope="module")
def told():
    """What was said while ``made`` was made."""
    return []


@pytest.fixture(scope="module")
def made(tmp_path_factory, told):
    """A small project, and the bytes of its archive."""
    project = write_small(tmp_path_factory.mktemp("made") / "project of mine")
    return project, make(project, progress=told.append)


@pytest.fixture(scope="module")
def page(made):
    return opened(made[1]).read("report.html").decode()


def opened(packed: bytes) -> zipfile.ZipFile:
    return zipfile.ZipFile(io.BytesIO(packed))


def refusal(project: Path, **options) -> str:
    """What is said of a project that is refused: nothing may be written."""
    with pytest.raises(HarnessError) as caught:
        make(project, **options)
    assert not (project.parent / "build" / "submission.zip").exists()
    return str(caught.value)


def harness(folder: Path, *arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "harness.cli", "submission", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, timeout=120)


def replace(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


# ---- The archive -----------------------------------------------------------------------------------------------------


def test_it_holds_what_the_project_uses_and_nothing_else(made):
    assert opened(made[1]).namelist() == NAMES


def test_its_files_are_the_projects(made):
    project, packed = made
    with opened(packed) as archive:
        for name in set(NAMES) - {"report.html"}:
            assert archive.read(name) == (project.parent / name).read_bytes()


@pytest.fixture(scope="module")
def commanded(tmp_path_factory):
    """The same project in another folder, at another time, and the command that packed it there."""
    project = write_small(tmp_path_factory.mktemp("elsewhere") / "deeper" / "small")
    (project.parent / "shaders/quad.frag").chmod(0o755)
    for path in project.parent.rglob("*"):
        os.utime(path, (1e9, 1e9))
    return project, harness(project.parent, "--size", "64x36", "--supersample", "1")


def test_it_is_the_same_bytes_from_another_folder_at_another_time(made, commanded):
    project, _ = commanded
    assert (project.parent / "build/submission.zip").read_bytes() == made[1]


def test_its_entries_tell_nothing_of_the_machine(made):
    for entry in opened(made[1]).infolist():
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        assert stat.S_IMODE(entry.external_attr >> 16) == 0o644
        assert not entry.extra and not entry.comment


def test_no_byte_of_it_names_the_folder(made):
    project, packed = made
    assert b"project of mine" not in packed


def test_its_picture_is_the_projects(made, page):
    (source,) = re.findall(r'<img src="data:image/png;base64,([^"]+)" width', page)
    shown = np.asarray(Image.open(io.BytesIO(base64.b64decode(source))).convert("RGBA"))
    assert np.array_equal(shown, render(made[0], SIZE))


def test_an_archive_that_is_there_stays_when_the_next_is_refused(small):
    output = small.parent / "build" / "submission.zip"
    output.parent.mkdir()
    output.write_bytes(b"before")
    replace(small.parent / "shaders/quad.frag", "discard;", "discard")
    with pytest.raises(HarnessError):
        make(small)
    assert output.read_bytes() == b"before"
    assert [p.name for p in output.parent.iterdir()] == ["submission.zip"]


# ---- The files of a project ------------------------------------------------------------------------------------------


def test_a_models_parts_are_its_files(small):
    folder = small.parent
    (folder / "ring.bin").write_bytes(b"")
    (folder / "ring.gltf").write_text('{"buffers": [{"uri": "ring.bin"}, {"uri": "data:,"}], "images": [{}]}')
    (folder / "ring.mtl").write_text("")
    (folder / "ring.obj").write_text("mtllib ring.mtl\n")
    models = "".join(f'<item name="{n}" type="model"><filepath>ring.{n}</filepath></item>' for n in ("gltf", "obj"))
    replace(small, "</items>", models + "</items>")
    assert {"ring.gltf", "ring.bin", "ring.obj", "ring.mtl"} <= contents.files(small).keys()


def test_what_an_inactive_pass_names_is_packed(small):
    replace(small, 'active="true"', 'active="false"')
    assert set(contents.files(small)) == set(NAMES) - {"report.html"}


@pytest.mark.parametrize("path", ["/textures/red.png", "C:/red.png", "\\\\server\\red.png"])
def test_an_absolute_path_is_refused(small, path):
    replace(small, 'path="textures/red.png"', f'path="{path}"')
    with pytest.raises(HarnessError, match=r"project.sprj:\d+: .*is an absolute path"):
        contents.files(small)


def test_a_path_out_of_the_folder_is_refused(small):
    shutil.copy(small.parent / "textures/red.png", small.parent.parent)
    replace(small, 'path="textures/red.png"', 'path="../red.png"')
    with pytest.raises(HarnessError, match=r'project.sprj:\d+: "../red.png" lies outside'):
        contents.files(small)


def test_a_link_out_of_the_folder_is_refused(small):
    target = small.parent.parent / "red.png"
    (small.parent / "textures/red.png").rename(target)
    (small.parent / "textures/red.png").symlink_to(target)
    with pytest.raises(HarnessError, match='"textures/red.png" lies outside'):
        contents.files(small)


@pytest.mark.parametrize("path", ["/home/me/tint.glsl", "C:\\Users\\me\\tint.glsl", "FOLDER/tint.glsl"])
def test_a_path_of_somebodys_machine_in_a_file_is_refused(small, path):
    path = path.replace("FOLDER", str(small.parent))
    replace(small.parent / "shaders/library/tint.glsl", "// What is above.\n", f"// What\n// is in {path}\n")
    with pytest.raises(HarnessError, match=r"tint.glsl:2: .*absolute path"):
        contents.files(small)


# ---- What is refused -------------------------------------------------------------------------------------------------


def test_a_project_that_fails_the_check_is_refused(small):
    replace(small.parent / "shaders/quad.frag", "discard;", "discord;")
    assert re.search(r"the check finds errors.*\nshaders/quad.frag:12: HS103: .*discord", refusal(small))


def test_a_project_whose_tests_fail_is_refused(small):
    (small.parent / "tests/test_more.py").write_text("def test_that_fails():\n    assert 1 + 1 == 3\n")
    said = refusal(small)
    assert "the tests fail" in said and "test_that_fails" in said


def test_an_archive_that_lacks_something_is_refused(small, monkeypatch):
    files = contents.files(small)
    del files["textures/red.png"]
    monkeypatch.setattr(contents, "files", lambda project: files)
    assert "HS401" in refusal(small, tests=False)


def test_an_archive_with_another_picture_is_refused(small, monkeypatch):
    real, folders = submission._render, []

    def drawn(folder, *rest):
        folders.append(folder)
        picture = real(folder, *rest).copy()
        picture[0, 0, 0] += len(folders) == 2
        return picture

    monkeypatch.setattr(submission, "_render", drawn)
    assert "the picture is another" in refusal(small, tests=False)
    assert folders[0] == small.parent and not folders[1].is_relative_to(small.parent)


@pytest.mark.parametrize(
    ("test", "why"),
    [
        ("tests/test_small.py::test_that_is_skipped", "is skipped here"),
        ("other/test_small.py::test_that_passes", "is not among those of tests"),
    ],
)
def test_a_test_that_did_not_pass_is_no_evidence(small, test, why):
    read = exercise.read(small)
    results = evidence.run_tests(read, small.parent)
    assert results.of(read, "tests/test_small.py::test_that_passes") == evidence.TestResult(3, 0)
    with pytest.raises(HarnessError, match=why):
        results.of(read, test)


def test_a_test_that_is_not_there_is_refused_even_when_tests_are_not_run(small):
    replace(small.parent / exercise.FILE, "::test_that_passes", "::test_that_passed")
    assert "there is no test tests/test_small.py::test_that_passed" in refusal(small, tests=False)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('pass = "Quad"', 'pass = "Squad"', "no pass Squad; did you mean Quad"),
        ('function = "tint"', 'function = "tin"', "no function tin; did you mean tint"),
        ("points = 3", "", r"\[\[part\]\] number 1 lacks points = a whole number"),
        ("points = 3", "points = 'x'", "must have points = a whole number"),
        ('caption = "T', 'within = [0.5, 0, 0.5, 1]\ncaption = "T', "is not left, top, right, bottom"),
        ("::test_that_passes", "", "is not a test of the form"),
        ("[[part]]", "[[part", "malformed TOML"),
    ],
)
def test_a_fault_in_the_exercises_file_is_told(small, old, new, said):
    replace(small.parent / exercise.FILE, old, new)
    assert re.search(said, refusal(small, tests=False))


def test_without_the_exercises_file_nothing_is_packed(small):
    (small.parent / exercise.FILE).unlink()
    assert "exercise.toml: cannot read the exercise's parts" in refusal(small)


def test_without_jinja2_it_is_told_what_to_install(small, monkeypatch):
    monkeypatch.setitem(sys.modules, "jinja2", None)
    assert "shader-harness[submission]" in refusal(small, tests=False)


# ---- The report ------------------------------------------------------------------------------------------------------


class Links(HTMLParser):
    """What a page refers to, and its tags."""

    def __init__(self, text: str):
        super().__init__()
        self.tags: set[str] = set()
        self.targets: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        self.targets += [value for name, value in attributes if name in ("src", "href", "srcset", "action", "data")]


def test_the_report_needs_nothing_but_itself(page):
    links = Links(page)
    assert len(links.targets) >= 3
    assert all(target.startswith(("data:image/png;base64,", "#")) for target in links.targets)
    assert not links.tags & {"script", "link", "iframe", "object", "embed"}
    assert "@import" not in page and "url(" not in page


def test_the_report_quotes_a_function_with_its_comment_and_place(made, page):
    text = re.sub(r"<span[^>]*>|</span>", "", page)
    for line in TINT.splitlines()[2:]:
        assert line.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;") in text
    assert "// What is above." not in text
    assert "shaders/library/tint.glsl:4" in text


def test_a_quotation_follows_its_function(small):
    read = exercise.read(small)
    (quotation,) = read.parts[0].quotations
    before = evidence.quote(read, sprj.read(small), quotation)
    replace(
        small.parent / "shaders/library/tint.glsl", "// A colour", "float other(float x) { return x; }\n\n// A colour"
    )
    after = evidence.quote(read, sprj.read(small), quotation)
    assert (before.first, before.function_line, before.last) == (3, 4, 8)
    assert (after.first, after.function_line, after.last) == (5, 6, 10)
    assert after.lines == before.lines == tuple(TINT.splitlines()[2:])


def test_a_region_is_where_its_pass_draws(small):
    read = exercise.read(small)
    (region,) = read.parts[0].regions
    picture = np.arange(1080 * 1920 * 4, dtype=np.uint32).reshape(1080, 1920, 4)
    crop = evidence.Regions(read, sprj.read(small)).crop(picture, region)
    # The left half, with a margin of 1.5 % of the width to the right.
    assert np.array_equal(crop, picture[:, : int(1920 * 0.515)])


def test_the_report_counts_points_and_cases(page):
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", page))
    assert "3 points" in text
    assert "all 3 passed, 1 skipped" in text
    assert "That passes (3 cases)" in text
    assert "not run" not in text


# ---- The command -----------------------------------------------------------------------------------------------------


def test_the_command_is_silent_in_a_pipe(commanded):
    _, done = commanded
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_refusal_is_one_message_and_exit_code_1(tmp_path):
    done = harness(tmp_path, "nix.sprj")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr and "exercise.toml" in done.stderr


def test_progress_is_told(made, told):
    assert [said.split()[0] for said in told] == ["checking", "rendering", "running", "writing", "unpacking"]


@pytest.fixture(scope="module")
def own(root, tmp_path_factory):
    """The archive of the exercise's own project, its tests not run."""
    output = tmp_path_factory.mktemp("own") / "submission.zip"
    submission.make(root / "project.sprj", output, size=(160, 90), supersample=1, tests=False)
    return opened(output.read_bytes())


def test_the_exercises_own_project_can_be_handed_in(own):
    names = set(own.namelist())
    assert {"project.sprj", "report.html", "shaders/features.glsl", "models/teapot.glb"} <= names
    assert not any(name.endswith((".py", "NormalDX.png", ".toml")) for name in names)


def test_without_tests_the_report_says_so(own):
    text = own.read("report.html").decode()
    assert "<strong>were not run</strong>" in text and "passed" not in text and "✓</" not in text


def test_the_exercises_points_are_five(root):
    points = [part.points for part in exercise.read(root / "project.sprj").parts]
    assert points == [2, 1, 1, 1]
