"""``harness submission``: what is in the archive, what the report says, and what is refused."""

from __future__ import annotations

import base64
import io
import os
import re
import stat
import subprocess
import sys
import zipfile
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from submission_files import NAMES, TINT, replace, write_small

from harness import HarnessError, render, submission
from harness.projects import sprj
from harness.submission import contents, evidence, exercise

SIZE = (64, 36)


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


def test_what_the_exercises_file_says_is_text(page):
    assert "<h1>Small &lt;&amp; sweet&gt;</h1>" in page


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
