"""The pytest plugin: each test here runs pytest on a small project."""

from __future__ import annotations

import re
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

pytest_plugins = ["pytester"]

QUIET = "-p", "no:cacheprovider", "-W", "ignore:Module already imported"


@pytest.fixture
def project(pytester):
    """A project with f.glsl beside its tests, and pytest to run on it."""
    pytester.makefile(".glsl", f="float twice(float x) { return 2.0 * x; }\n")
    return pytester


def run(project, *options):
    return project.runpytest_subprocess(*QUIET, *options)  # a process has one context, which this one may hold


# ---- The fixture shader ----------------------------------------------------------------------------------------------


def test_a_test_with_a_shader_runs_in_both_modes_and_can_name_others(project):
    project.makepyfile("def test(shader, glsl_mode): print('in', glsl_mode, shader('f.glsl').twice(3))")
    result = run(project, "-s", "-v")
    result.assert_outcomes(passed=2)
    assert re.findall(r"in (\S+) 6.0", result.stdout.str()) == ["as-written", "precise"]
    run(project, "--glsl-modes=precise").assert_outcomes(passed=1)


def test_the_shader_is_compiled_in_the_mode(project):
    """1 + x - x, which the driver makes 1 where it may rewrite; as written it is 0 for a large x."""
    project.makefile(".glsl", g="float rest(float x) { return (1.0 + x) - x; }\n")
    project.makepyfile(
        "def test(shader, glsl_mode):\n"
        "    assert shader('g.glsl').rest(1e10) == {'as-written': 1, 'precise': 0}[glsl_mode]\n"
    )
    run(project).assert_outcomes(passed=2)


def test_a_mark_of_the_test_chooses_its_modes(project):
    project.makepyfile(
        "import pytest\n"
        "@pytest.mark.parametrize('glsl_mode', ['precise'])\n"
        "def test(shader): assert shader('f.glsl').twice(3) == 6"
    )
    run(project).assert_outcomes(passed=1)


def test_a_mode_that_is_not_there_is_a_wrong_usage(project):
    project.makepyfile("def test(shader): pass")
    result = run(project, "--glsl-modes=exact")
    assert result.ret == pytest.ExitCode.INTERRUPTED or result.ret == pytest.ExitCode.USAGE_ERROR
    assert "no mode 'exact'; there are: as-written, precise" in result.stdout.str() + result.stderr.str()


def test_a_backend_that_is_not_there_is_refused_with_those_that_are(project, capfd):
    result = run(project, "--glsl-backend=vulkan")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    assert re.search(r"invalid choice: 'vulkan' \(choose from '?osmesa", result.stderr.str() + capfd.readouterr().err)


def test_files_are_found_beside_the_test_then_in_the_root(project):
    """In a folder below, and with includes of the root; what is beside the test comes first."""
    project.makeini("[pytest]\nglsl_root = lib\n")
    project.mkdir("lib")
    (project.path / "lib" / "other.glsl").write_text('#include "parts/one.glsl"\nfloat two() { return one() + 1.0; }\n')
    (project.path / "lib" / "parts").mkdir()
    (project.path / "lib" / "parts" / "one.glsl").write_text("float one() { return ONE; }\n")
    (project.path / "lib" / "f.glsl").write_text("wrong\n")
    project.mkdir("sub")
    (project.path / "sub" / "f.glsl").write_text('#include "parts/one.glsl"\nfloat two() { return one() + 1.5; }\n')
    (project.path / "sub" / "test_sub.py").write_text(
        "def test(shader):\n"
        "    assert shader('other.glsl', defines={'ONE': 1.0}).two() == 2\n"
        "    assert shader('other.glsl', {'ONE': '10.0'}).two() == 11\n"
        "    assert shader('f.glsl', {'ONE': 1.0}).two() == 2.5\n"
    )
    run(project).assert_outcomes(passed=2)


def test_a_file_that_is_not_there_is_an_error_that_says_where_it_was_looked_for(project):
    project.makeini("[pytest]\nglsl_root = lib\n")
    project.makepyfile("def test(shader): shader('nix.glsl')")
    result = run(project, "--glsl-modes=precise")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*GlslError: nix.glsl: no such file in *lib; the ini option glsl_root names more*"])


def test_a_shader_is_compiled_once_and_again_when_it_changes(project):
    project.makepyfile(
        "from pathlib import Path\n"
        "seen = []\n"
        "def test_1(shader): seen.append(shader('f.glsl'))\n"
        "def test_2(shader): assert shader('f.glsl') is seen[0]\n"
        "def test_3(shader):\n"
        "    Path('f.glsl').write_text('float twice(float x) { return x + x + 1.0; }')\n"
        "    assert shader('f.glsl').twice(3) == 7\n"
    )
    run(project, "--glsl-modes=precise").assert_outcomes(passed=3)


def test_a_test_of_the_projects_own_shader_fixture_is_left_alone(project):
    project.makeconftest("import pytest\n@pytest.fixture\ndef shader(): return 'mine'")
    project.makepyfile("def test(shader): assert shader == 'mine'")
    run(project).assert_outcomes(passed=1)


# ---- Errors of GL ----------------------------------------------------------------------------------------------------

LEAVE = "import ctypes; from harness import native; native.open_context(); ctypes.CDLL('libOSMesa.so.8').glEnable(4)"


def test_an_error_of_gl_that_is_left_over_fails_the_test_and_no_other(project):
    project.makepyfile(f"def test_1():\n    {LEAVE}\ndef test_2(): pass")
    result = run(project)
    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["the test left an error that no operation has reported: GL: GL_INVALID_ENUM"])


def test_an_error_of_gl_left_by_a_failing_test_is_told_with_it(project):
    project.makepyfile(f"def test_1():\n    {LEAVE}\n    assert 1 == 2\ndef test_2(): pass")
    result = run(project)
    result.assert_outcomes(failed=1, passed=1)
    result.stdout.fnmatch_lines(["E*assert 1 == 2", "It also left an error: GL: GL_INVALID_ENUM"])


def test_an_error_of_gl_left_by_a_teardown_is_its_own(project):
    project.makepyfile(
        f"import pytest\n@pytest.fixture\ndef thing():\n    yield\n    {LEAVE}\n"
        "def test_1(thing): pass\ndef test_2(): pass"
    )
    run(project).assert_outcomes(errors=1, passed=2)


# ---- Golden files ----------------------------------------------------------------------------------------------------


def test_a_golden_file_is_asked_for_written_and_then_compared(project):
    project.makepyfile(
        "import numpy as np\n"
        "def test(golden):\n"
        "    golden('a.npy', np.float32([1, 2, np.nan, np.inf]))\n"
        "    golden('b.png', np.full((4, 5, 3), 7, np.uint8))\n"
    )
    result = run(project)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["E*there is no golden file golden/a.npy", "E*got: *", "E*pytest --update-golden"])
    result = run(project, "--update-golden")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines([f"golden file written: {project.path}/golden/a.npy", "golden file written: *b.png"])
    assert np.asarray(Image.open(project.path / "golden" / "b.png")).shape == (4, 5, 3)
    run(project).assert_outcomes(passed=1)


def test_a_difference_is_shown_made_bright_with_what_was_got(project):
    (project.path / "golden").mkdir()
    want = np.full((4, 5, 3), 100, np.uint8)
    Image.fromarray(want).save(project.path / "golden" / "b.png")
    project.makepyfile(
        "import numpy as np\n"
        "def test(golden):\n"
        "    got = np.full((4, 5, 3), 100, np.uint8)\n"
        "    got[1, 2] = 103, 98, 100\n"
        "    golden('b.png', got, atol=3)\n"
        "    golden('b.png', got, atol=1)\n"
    )
    out = run(project).stdout.str()
    assert "2 of 60 values are more than 1 from golden/b.png; the worst, at (1, 2, 0): got 103, golden 100" in out
    got = np.asarray(Image.open(re.search(r"  got: (/\S+)", out)[1])).astype(int)
    difference = np.asarray(Image.open(re.search(r"difference, white where it is 3: (/\S+)", out)[1]))
    assert got[1, 2].tolist() == [103, 98, 100]
    assert difference[1, 2].tolist() == [255, 170, 0] and difference.sum() == 255 + 170


def test_agreeing_files_are_not_written_again_nor_twice_in_a_run(project):
    """So that a run in two modes does not hide that they disagree."""
    project.makepyfile(
        "import numpy as np\n"
        "def test(golden, glsl_mode): golden('a.npy', np.array([1.0 if glsl_mode == 'precise' else 2.0]))\n"
        "def test_2(golden): golden('b.npy', np.zeros(2), atol=0.5)\n"
    )
    (project.path / "golden").mkdir()
    np.save(project.path / "golden" / "b.npy", np.full(2, 0.25))
    result = run(project, "--update-golden")
    result.assert_outcomes(passed=2, failed=1)
    result.stdout.fnmatch_lines(["E*it was written in this run, by this test in another mode*"])
    assert np.load(project.path / "golden" / "b.npy").tolist() == [0.25, 0.25]


def test_what_is_within_the_tolerance_passes(project):
    (project.path / "golden").mkdir()
    np.save(project.path / "golden" / "a.npy", np.float32([1, -100, np.inf]))
    project.makepyfile(
        "import numpy as np\n"
        "def test(golden): golden('a.npy', np.float32([1.24, -110.0, np.inf]), atol=0.125, rtol=0.125)\n"
    )
    run(project).assert_outcomes(passed=1)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("golden('a.npy', np.float32([1, 2.5]))", "*1 of 2 values are more than 0 from*at (1,): got 2.5, golden 2.0"),
        ("golden('a.npy', np.float32([1, 2.5]), rtol=0.2)", "*1 of 2 values are more than 0 + 0.2 [*] |golden value|*"),
        ("golden('a.npy', np.float32([1, np.nan]), atol=9)", "*at (1,): got nan, golden 2.0"),
        ("golden('a.npy', np.float32([1, np.inf]), rtol=9)", "*at (1,): got inf, golden 2.0"),
        ("golden('a.npy', np.float64([1, 2]))", "*got (2,) of float64; golden/a.npy has (2,) of float32"),
        ("golden('a.npy', np.float32([[1, 2]]))", "*got (1, 2) of float32; golden/a.npy has (2,) of float32"),
        ("golden('a.png', np.float32([[1, 2]]))", "*a.png keeps a picture*got (1, 2) of float32*"),
        ("golden('a.jpg', np.float32([1, 2]))", '*a golden file is a "NAME.png" or a "NAME.npy", got \'a.jpg\''),
    ],
)
def test_what_is_wrong_is_said(project, call, said):
    (project.path / "golden").mkdir()
    np.save(project.path / "golden" / "a.npy", np.float32([1, 2]))
    project.makepyfile(f"import numpy as np\ndef test(golden): {call}")
    result = run(project)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([f"E*{said}"])


# ---- What it costs others --------------------------------------------------------------------------------------------


def test_a_project_without_shaders_pays_nothing(tmp_path):
    """Neither numpy nor the native library is loaded, and no header is printed."""
    test = "import sys\ndef test(): assert not {'numpy', 'PIL', 'harness.native'} & {*sys.modules}\n"
    (tmp_path / "test_plain.py").write_text(test)
    command = [sys.executable, "-m", "pytest", *QUIET, "-v"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0 and "1 passed" in done.stdout, done.stdout
    assert "GLSL" not in done.stdout


def test_the_driver_is_named_before_the_first_test_and_not_to_list_them(project):
    project.makepyfile("def test(shader): pass")
    lines = run(project).stdout.str().splitlines()
    collected = next(n for n, line in enumerate(lines) if line.startswith("collected 2 items"))
    assert re.match(r"GLSL: llvmpipe .*, Mesa [\d.]+, glslang [\d.]+, \S+", lines[collected + 1])
    assert sum(line.startswith("GLSL") for line in lines) == 1
    assert "GLSL:" not in run(project, "--co").stdout.str()
