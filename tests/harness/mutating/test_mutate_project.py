"""Where a project begins, and what of it is copied."""

from __future__ import annotations

import subprocess

import pytest

from harness import HarnessError
from harness.mutating.mutate_project import find


def write(folder, *names):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("text")


def test_a_repository_is_what_git_knows_and_does_not_ignore(tmp_path, monkeypatch):
    write(tmp_path, "shaders/f.glsl", "tests/test_f.py", "tests/new.py", "build/large.o", "a name\nwith a break.txt")
    (tmp_path / ".gitignore").write_text("build\n")
    for arguments in (["init", "-q"], ["add", "shaders", "tests/test_f.py"]):
        subprocess.run(["git", "-C", tmp_path, *arguments], check=True)
    monkeypatch.chdir(tmp_path / "tests")
    found = find("../shaders/f.glsl", ["test_f.py"])
    assert found.root == str(tmp_path.resolve())
    assert (found.file, found.within, found.tests) == ("shaders/f.glsl", "tests", ("test_f.py",))
    names = {".gitignore", "shaders/f.glsl", "tests/test_f.py", "tests/new.py", "a name\nwith a break.txt"}
    assert set(found.files) == names


def test_a_file_that_git_ignores_belongs_to_it_all_the_same(tmp_path):
    write(tmp_path, "made/f.glsl")
    (tmp_path / ".gitignore").write_text("made\n")
    subprocess.run(["git", "-C", tmp_path, "init", "-q"], check=True)
    assert "made/f.glsl" in find(tmp_path / "made" / "f.glsl").files


def test_without_git_it_begins_where_pytest_is_configured(tmp_path):
    write(tmp_path, "a/pyproject.toml", "a/shaders/f.glsl", "a/tests/t.py")
    write(tmp_path, "a/.venv/x.py", "a/v/pyvenv.cfg", "b/other.py")
    found = find(tmp_path / "a" / "shaders" / "f.glsl", [tmp_path / "a" / "tests"])
    assert found.root == str((tmp_path / "a").resolve())
    assert set(found.files) == {"pyproject.toml", "shaders/f.glsl", "tests/t.py"}


def test_without_any_sign_it_is_what_holds_both(tmp_path):
    write(tmp_path, "a/shaders/f.glsl", "a/tests/t.py", "b/other.py")
    found = find(tmp_path / "a" / "shaders" / "f.glsl", [tmp_path / "a" / "tests" / "t.py"])
    assert found.root == str((tmp_path / "a").resolve())
    assert (found.within, found.tests) == (".", ("tests/t.py",))


@pytest.mark.parametrize("missing", ["file", "tests"])
def test_what_is_not_there_is_named(tmp_path, missing):
    write(tmp_path, "f.glsl")
    with pytest.raises(HarnessError, match="nowhere"):
        find(tmp_path / ("nowhere" if missing == "file" else "f.glsl"), [tmp_path / "nowhere"])


def test_tests_of_another_repository_are_refused(tmp_path):
    write(tmp_path, "a/f.glsl", "b/test_f.py")
    subprocess.run(["git", "-C", tmp_path / "a", "init", "-q"], check=True)
    with pytest.raises(HarnessError, match="not in the repository of f.glsl"):
        find(tmp_path / "a" / "f.glsl", [tmp_path / "b"])
