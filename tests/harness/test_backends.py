"""The three ways to a context. Expected: the same tests pass with each; one renderer gives the same bits by all."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

import pytest

from harness import NativeError, native

# Every kind of work that goes through GL: evaluation in both stages, textures, meshes, draws, pictures. For all tests
# with each backend there is `make test-backends`.
SUITE = ["tests/harness/calling/test_evaluation.py", "tests/harness/rendering/test_render.py"]


# A server that does not start anew, deaf meanwhile, whenever nobody is connected.
DISPLAY = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset"]


def in_process(backend: str, *command: str) -> subprocess.CompletedProcess:
    display = [*DISPLAY] if backend == "glfw" and not os.environ.get("DISPLAY") else []
    environment = {**os.environ, native.BACKEND_VARIABLE: backend}
    return subprocess.run([*display, sys.executable, *command], env=environment, capture_output=True, text=True)


def skip_without(backend: str) -> None:
    if backend == "glfw" and not os.environ.get("DISPLAY") and not shutil.which("xvfb-run"):
        pytest.skip("no display, and no xvfb-run to make one")


@pytest.mark.parametrize("backend", ["egl", "glfw"])
def test_the_same_tests_pass_with_each_backend(root, backend):
    skip_without(backend)
    done = in_process(backend, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-x", *(str(root / f) for f in SUITE))
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.mark.parametrize("backend", native.BACKENDS)
def test_the_context_is_the_backend_s_own(backend):
    skip_without(backend)
    program = "from harness import native; native.open_context(); print(native.context_info()['backend'])"
    assert in_process(backend, "-c", program).stdout == f"{backend}\n"


def test_a_process_keeps_to_one_backend():
    native.open_context()
    other = "egl" if native.context_info()["backend"] == "osmesa" else "osmesa"
    with pytest.raises(NativeError, match="two libraries of OpenGL in one process crash"):
        native.choose_backend(other)
    assert native.context_info()["backend"] != other


def test_a_backend_that_is_none_is_told_with_those_there_are():
    with pytest.raises(NativeError, match="no backend vulkan; there are: osmesa, egl, glfw"):
        native.choose_backend("vulkan")


def test_glfw_without_a_display_says_so():
    program = "from harness import native; native.open_context()"
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    environment[native.BACKEND_VARIABLE] = "glfw"
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    assert "GLFW finds no display" in done.stderr
