"""The pytest plugin: GLSL functions in tests of any project, in several modes, and golden pictures and arrays.

Every project's tests load it where this package is installed: nothing slow is imported before a test asks for it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from .calling.call import Shader
    from .comparing.golden import Golden

BACKENDS = ("osmesa", "egl", "glfw")  # native.BACKENDS, which costs an import
_BACKEND_VARIABLE = "HARNESS_BACKEND"  # native.BACKEND_VARIABLE, likewise

_DRIVER = "glsl_driver"  # the properties of a test that reports (JUnit XML) tell
_MODE = "glsl_mode"
_WRITTEN = "golden_written"


class _Session:
    """What the tests of one process share."""

    def __init__(self):
        self.compiled: dict[tuple, Shader] = {}
        self.written: set[Path] = set()
        self.told: set[str] = set()  # the drivers that the report has named already


_SESSION = pytest.StashKey[_Session]()


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("glsl", "GLSL functions in tests (shader-harness)")
    group.addoption("--glsl-backend", choices=BACKENDS, help="what opens the OpenGL context (osmesa)")
    group.addoption(
        "--glsl-modes",
        default="as-written,precise",
        metavar="MODE,...",
        help="tests that use the fixture shader run once in each of these modes (%(default)s)",
    )
    group.addoption(
        "--update-golden",
        action="store_true",
        help="write the golden files that are missing or do not agree with what the tests get",
    )
    parser.addini("glsl_root", "folders where shader() looks for files after the test's own", type="paths", default=[])


def pytest_configure(config: pytest.Config) -> None:
    config.stash[_SESSION] = _Session()
    if backend := config.getoption("glsl_backend"):
        os.environ[_BACKEND_VARIABLE] = backend


# ---- Fixtures --------------------------------------------------------------------------------------------------------


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if _MODE in metafunc.fixturenames and _MODE not in _parametrized(metafunc):
        metafunc.parametrize(_MODE, _modes(metafunc.config))


def _parametrized(metafunc: pytest.Metafunc) -> set[str]:
    """The names that a test's own marks give values to."""
    names = set()
    for mark in metafunc.definition.iter_markers("parametrize"):
        given = mark.args[0] if mark.args else mark.kwargs["argnames"]
        names.update(name.strip() for name in (given.split(",") if isinstance(given, str) else given))
    return names


def _modes(config: pytest.Config) -> list[str]:
    from .language.dialect import MODES

    modes = [mode.strip() for mode in config.getoption("glsl_modes").split(",")]
    for mode in modes:
        if mode not in MODES:
            raise pytest.UsageError(f"--glsl-modes: no mode {mode!r}; there are: {', '.join(MODES)}")
    return modes


@pytest.fixture
def glsl_mode(request: pytest.FixtureRequest) -> str:
    """The mode that ``shader`` compiles in; a test that asks for it runs once in each of --glsl-modes."""
    return _modes(request.config)[0]  # where a test asks for it while it runs


@pytest.fixture
def shader(request: pytest.FixtureRequest, glsl_mode: str) -> Callable[..., Shader]:
    """``shader("noise.glsl", defines={"OCTAVES": 3})``: the functions of a GLSL file, in each of --glsl-modes.

    As ``harness.shader``, but a relative path is looked for in the folder of the test, then in those of the ini option
    ``glsl_root``, where includes are looked for as well. What did not change is compiled once for all tests.
    """
    import harness

    from .language import glsl

    config = request.config
    roots = config.getini("glsl_root")
    shared = config.stash[_SESSION]
    request.node.user_properties += [(_MODE, glsl_mode), (_DRIVER, _driver())]

    def load(
        path: str | Path,
        defines: Mapping[str, Any] | None = None,
        include_dirs: Sequence[str | Path] = (),
        mode: str = glsl_mode,
        **options: Any,
    ) -> Shader:
        places = [request.path.parent, *roots]
        file = _found(Path(path), places)
        folders = [_found(Path(folder), places) for folder in include_dirs] + roots
        macros = {name: str(text) for name, text in (defines or {}).items()}
        source = glsl.load(file, macros, [*folders, file.parent], version=glsl.VERSION, library=True)
        key = (source.path, source.text, mode, *sorted(options.items()))
        if key not in shared.compiled:
            shared.compiled[key] = harness.shader(file, macros, folders, mode, **options)
        return shared.compiled[key]

    return load


def _found(path: Path, places: Sequence[Path]) -> Path:
    from .errors import GlslError
    from .language.glsl import shown_path

    found = next((place / path for place in places if (place / path).exists()), None)
    if found is None:
        looked = ", ".join(shown_path(place) for place in places)
        raise GlslError(f"no such file in {looked}; the ini option glsl_root names more folders", path)
    return found


@pytest.fixture
def golden(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Golden]:
    """``golden("marble.png", picture, atol=1)``: fails unless ``golden/marble.png`` beside the test agrees.

    --update-golden writes it.
    """
    from .comparing.golden import Golden

    written = request.config.stash[_SESSION].written
    before = set(written)
    yield Golden(request.path.parent / "golden", tmp_path, request.config.getoption("update_golden"), written)
    request.node.user_properties += [(_WRITTEN, str(path)) for path in sorted(written - before)]


# ---- Errors of GL that nobody has reported ---------------------------------------------------------------------------


def _left_over() -> str | None:
    native = sys.modules.get("harness.native")  # without it there is no GL
    return native.take_error() if native else None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    return (yield from _without_left_over(item, "call"))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item: pytest.Item) -> Iterator[None]:
    return (yield from _without_left_over(item, "teardown"))


def _without_left_over(item: pytest.Item, phase: str) -> Iterator[None]:
    """Fails a phase of a test that leaves an error; one that fails anyway tells of it. The next test starts clean."""
    try:
        result = yield
    except BaseException:
        if error := _left_over():
            item.add_report_section(phase, "OpenGL", f"It also left an error: {error}")
        raise
    if error := _left_over():
        pytest.fail(f"the test left an error that no operation has reported: {error}", pytrace=False)
    return result


# ---- Reports ---------------------------------------------------------------------------------------------------------


def _driver() -> str:
    from .info import info

    known = info()
    return ", ".join(
        [known["driver"], *(f"{name} {known[name]}" for name in ("Mesa", "glslang") if name in known), known["CPU"]]
    )


def pytest_report_collectionfinish(config: pytest.Config, items: Sequence[pytest.Item]) -> list[str]:
    """Names the driver before the first test, where there are such tests, for only they start it."""
    if config.option.collectonly or not any(_MODE in getattr(item, "fixturenames", ()) for item in items):
        return []
    config.stash[_SESSION].told.add(_driver())
    return [f"GLSL: {_driver()}"]


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Names the drivers of other processes (pytest-xdist), and the golden files that were written."""
    reports = [report for reports in terminalreporter.stats.values() for report in reports]
    properties = [pair for report in reports for pair in getattr(report, "user_properties", ())]
    drivers = {value for name, value in properties if name == _DRIVER} - config.stash[_SESSION].told
    for driver in sorted(drivers):
        terminalreporter.write_line(f"GLSL: {driver}")
    for path in sorted({value for name, value in properties if name == _WRITTEN}):
        terminalreporter.write_line(f"golden file written: {path}")
