"""A small copy of the project that a test may break: the backdrop, one metal teapot, one with all four maps.

A broken copy is a list of edits (file, old text, new text), and what must be found is (code, file, text of its line).
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from PIL import Image

KEPT_PASSES = ("Backdrop", "Metals", "Painted metal")
ITEM = re.compile(r'        <item name="Metal[2-7]" type="model">.*?</item>\n', re.DOTALL)


class Scene:
    """The copy's folder, with ways to change it and to say where findings are."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.project = folder / "project.sprj"

    def replace(self, file: str, old: str, new: str, count: int = 1) -> None:
        """Replaces a text that must be there; count -1 for all of them."""
        path = self.folder / file
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, count))

    def write(self, file: str, text: str | bytes) -> None:
        path = self.folder / file
        path.parent.mkdir(exist_ok=True)
        path.unlink(missing_ok=True)
        path.write_bytes(text.encode() if isinstance(text, str) else text)

    def image(self, file: str, color: tuple[int, int, int]) -> None:
        """Makes a texture one colour."""
        (self.folder / file).unlink()
        Image.new("RGB", (4, 4), color).save(self.folder / file)

    def line(self, file: str, snippet: str) -> int:
        """The first line of a file that holds a text."""
        lines = (self.folder / file).read_text().split("\n")
        return next(n for n, text in enumerate(lines, 1) if snippet in text)

    def breaks(self, edits: list[tuple], *wanted: tuple[str, str, str]) -> None:
        """Edits the copy; exactly that is found, in the order of files and lines."""
        for edit in edits:
            self.replace(*edit)
        assert self.found() == [(code, file, self.line(file, snippet)) for code, file, snippet in wanted]

    def found(self) -> list[tuple[str, str, int | None]]:
        """(code, file, line) of all that is found."""
        from harness.check import check

        findings = check(self.project)
        assert all(f.message and f.fix and f.why for f in findings)
        return [(f.code, str(Path(f.file).resolve().relative_to(self.folder.resolve())), f.line) for f in findings]


@pytest.fixture(scope="session")
def template(tmp_path_factory, root) -> Path:
    folder = tmp_path_factory.mktemp("template")
    text = (root / "project.sprj").read_text()
    for name in re.findall(r'<pass name="([^"]*)"', text):
        if name not in KEPT_PASSES:
            text = re.sub(rf'    <pass name="{name}".*?</pass>\n', "", text, flags=re.DOTALL)
            text = re.sub(
                rf'    <object [^>]*>\s*<bind slot="\d" name="{name}" />\s*</object>\n', "", text, flags=re.DOTALL
            )
    text = ITEM.sub("", text)
    text = re.sub(r'        <value variable="\w+" for="Metal[2-7]">.*\n', "", text)
    (folder / "project.sprj").write_text(text)
    shutil.copytree(root / "shaders", folder / "shaders")
    (folder / "textures").mkdir()
    for path in (root / "textures").glob("*.png"):
        Image.open(path).convert("RGB").resize((16, 16), Image.Resampling.NEAREST).save(folder / "textures" / path.name)
    return folder


@pytest.fixture
def scene(template, root, tmp_path) -> Scene:
    folder = tmp_path / "scene"
    shutil.copytree(template, folder)
    (folder / "models").symlink_to(root / "models")
    return Scene(folder)
