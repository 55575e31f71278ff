"""Watching files. Expected: every file that a picture is made of, and each way in which one changes."""

from __future__ import annotations

from pathlib import Path

import pytest
from sprj_files import item, read, shader_pass, texture, write_project, write_quad, write_texture

from harness.viewing.watch import Watch, files


def test_everything_that_the_picture_is_made_of_is_watched(tmp_path):
    write_quad(tmp_path, "color = vec4(value());", '#include "inner.glsl"')
    (tmp_path / "inner.glsl").write_text('#include "innermost.glsl"\nfloat value() { return half(); }\n')
    (tmp_path / "innermost.glsl").write_text("float half() { return 0.5; }\n")
    write_texture(tmp_path, "a.png")
    items = item("m", "<filepath>m.obj</filepath>", kind="model")
    project = read(write_project(tmp_path, shader_pass(items=items), objects=texture("a.png")))
    names = {path.name for path in files(project)}
    assert names == {"project.sprj", "quad.vert", "quad.frag", "inner.glsl", "innermost.glsl", "a.png", "m.obj"}


def test_an_include_that_comes_later_is_noticed(tmp_path):
    path = write_quad(tmp_path, "", '#include "later.glsl"')
    watch = Watch(files(read(path)))
    assert not watch.changed()
    (tmp_path / "later.glsl").write_text("// here\n")
    assert watch.changed()


@pytest.fixture
def watched(tmp_path) -> Path:
    path = tmp_path / "a.txt"
    path.write_text("a")
    return path


def test_nothing_changes_by_itself(watched):
    watch = Watch([watched, watched.parent / "missing"])
    assert not watch.changed() and not watch.changed()


@pytest.mark.parametrize("change", ["write", "remove", "replace", "make"])
def test_a_change_is_told_once(watched, change):
    other = watched.parent / "b.txt"
    watch = Watch([watched, other])
    if change == "write":
        watched.write_text("ab")
    elif change == "remove":
        watched.unlink()
    elif change == "replace":  # as editors save; even with the same time and size
        new = watched.parent / "new"
        new.write_text("b")
        new.rename(watched)
    else:
        other.write_text("")
    assert watch.changed()
    assert not watch.changed()
