"""What a project may take of memory: bounded, and one message says what did not fit and what to do.

Each command runs with a limit of half a GiB, of which a small picture needs a third; what each project asks for is
several times that.
"""

from __future__ import annotations

import struct
import subprocess
import sys
import zlib

import pytest
from sprj_files import texture, write_quad

from harness.processes import worker

LIMIT = 512 << 20
HINT = "needs more than 512M of memory; --memory allows more"

BOUND = '<bind slot="0" name="Quad" />'

#: runs a command and then prints the most memory, in KiB, that a process under it had at once
MEASURED = """
import resource, sys
from harness import cli
code = cli.main(sys.argv[1:])
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
sys.exit(code)
"""


def harness(folder, *arguments, memory="512M"):
    command = [sys.executable, "-c", MEASURED, *map(str, arguments), "--memory", memory]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=100)


def render(folder, *more, memory="512M"):
    return harness(folder, "render", "project.sprj", "-o", "out.png", "--size", "32x24", *more, memory=memory)


def assert_one_message(done, *parts):
    """Exit code 1, one line that says all the parts, and never much more memory than the limit."""
    assert done.returncode == 1, done.stderr
    assert done.stderr.count("\n") == 1, done.stderr
    for part in parts:
        assert part in done.stderr
    # What the files of libraries take is not counted, but resident: below 200 MiB.
    assert int(done.stdout) << 10 < LIMIT + (200 << 20)


def assert_nothing_written(folder, before):
    assert sorted(p.name for p in folder.iterdir()) == before


def names(folder):
    return sorted(p.name for p in folder.iterdir())


def test_an_ordinary_project_needs_no_more_than_half_a_gib(root, tmp_path):
    write_quad(tmp_path, "")
    assert render(tmp_path).returncode == 0
    done = harness(root, "render", "project.sprj", "-o", tmp_path / "scene.png", "--size", "640x360")
    assert (done.returncode, done.stderr) == (0, "")


def test_a_giant_render_texture(tmp_path):
    target = '<object type="rendertexture" name="rt" fsize="7000,7000" format="R32G32B32A32_FLOAT">{}</object>'
    write_quad(tmp_path, "", objects=target.format(BOUND))
    there = names(tmp_path)
    assert_one_message(render(tmp_path), 'the render texture "rt"', HINT)
    assert_nothing_written(tmp_path, there)


def test_a_giant_picture(tmp_path):
    write_quad(tmp_path, "")
    there = names(tmp_path)
    assert_one_message(render(tmp_path, "--size", "8000x8000"), HINT)
    assert_nothing_written(tmp_path, there)


def test_many_images(tmp_path):
    image = '<object type="image" name="i{}" width="4096" height="4096" format="R32G32B32A32_FLOAT">{}</object>\n'
    write_quad(tmp_path, "", objects="".join(image.format(n, BOUND) for n in range(3)))
    assert_one_message(render(tmp_path), HINT)


def test_a_giant_buffer(tmp_path):
    write_quad(tmp_path, "", objects=f'<object type="buffer" name="b" size="268435456" format="float">{BOUND}</object>')
    assert_one_message(render(tmp_path), HINT)


def png_of_zeros(width, height):
    """A whole PNG of one bit a pixel, packed to a thousandth of that."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    packer = zlib.compressobj(9)
    rows = b"".join(packer.compress(bytes(1 + width // 8)) for _ in range(height)) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def test_a_decompression_bomb(tmp_path):
    """13000 pixels a side: 645 MiB as RGBA, of a file of 20 KB."""
    write_quad(tmp_path, "", objects=texture("bomb.png"))
    (tmp_path / "bomb.png").write_bytes(png_of_zeros(13000, 13000))
    there = names(tmp_path)
    for command in (render(tmp_path), harness(tmp_path, "check", "project.sprj")):
        assert_one_message(command, HINT)
    assert_nothing_written(tmp_path, there)


def test_a_shader_with_a_giant_array(tmp_path):
    write_quad(tmp_path, "color.x = a[int(uv.x * 1e8)];", "float a[200000000];")
    there = names(tmp_path)
    done = render(tmp_path, "--time-limit", "30")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    assert_nothing_written(tmp_path, there)


def test_macros_that_multiply(tmp_path):
    doublings = "".join(f"#define M{n} M{n - 1} M{n - 1}\n" for n in range(1, 40))
    write_quad(tmp_path, "M39", f"#define M0 color.x += 1.0;\n{doublings}")
    there = names(tmp_path)
    assert_one_message(render(tmp_path, "--timeout", "2"), "ran out of time after 2 s")
    assert_nothing_written(tmp_path, there)


def test_a_call_of_a_giant_batch(tmp_path):
    (tmp_path / "f.glsl").write_text("mat4 f(float x, float y) { return mat4(x * y); }\n")
    column, row = ",".join(["[1]"] * 3000), ",".join(["1"] * 3000)
    assert_one_message(harness(tmp_path, "call", "f.glsl", "f", f"x=[{column}]", f"y=[{row}]"), HINT)


def test_a_hunt_and_its_workers(tmp_path):
    (tmp_path / "f.glsl").write_text("float a[200000000];\nfloat f(float x) { return a[int(x * 1e8)]; }\n")
    done = harness(tmp_path, "hunt", "f.glsl", "f", "--domain", "x=[0,1]", "--samples", "1000", "--workers", "1")
    assert done.returncode == 1
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("text", ["2", "0", "-1G", "G", "1e3", "1G2", "", "nan"])
def test_what_is_no_amount_of_memory(text):
    with pytest.raises(ValueError, match="no amount|too little"):
        worker.memory(text)


@pytest.mark.parametrize(
    ("text", "size"),
    [("2G", 2 << 30), ("1.5g", 3 << 29), ("512MiB", 512 << 20), ("300MB", 300 << 20), (str(1 << 30), 1 << 30)],
)
def test_amounts_of_memory(text, size):
    assert worker.memory(text) == size
    assert worker.memory(worker.shown_memory(size)) == size
