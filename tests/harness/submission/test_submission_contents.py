"""What of a project is packed to be handed in, and which paths are refused."""

from __future__ import annotations

import shutil

import pytest
from submission_files import NAMES, replace, write_small

from harness import HarnessError
from harness.submission import contents


@pytest.fixture
def small(tmp_path):
    return write_small(tmp_path / "small")


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


def test_a_link_into_the_folder_from_outside_is_refused(small):
    """Its name in the archive would lead out of wherever that is unpacked."""
    (small.parent.parent / "red.png").symlink_to(small.parent / "textures/red.png")
    replace(small, 'path="textures/red.png"', 'path="../red.png"')
    with pytest.raises(HarnessError, match='"../red.png" lies outside'):
        contents.files(small)


@pytest.mark.parametrize("path", ["/home/me/tint.glsl", "C:\\Users\\me\\tint.glsl", "FOLDER/tint.glsl"])
def test_a_path_of_somebodys_machine_in_a_file_is_refused(small, path):
    path = path.replace("FOLDER", str(small.parent))
    replace(small.parent / "shaders/library/tint.glsl", "// What is above.\n", f"// What\n// is in {path}\n")
    with pytest.raises(HarnessError, match=r"tint.glsl:2: .*absolute path"):
        contents.files(small)
