"""Checks the shaders of each pass as SHADERed compiles them: by glslang for SPIR-V, by the driver, and linked."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path

from ..errors import GlslError, NativeError, did_you_mean
from ..language import glsl
from ..native import Stage
from ..projects.xml_lines import Element
from . import includes, loops, renderer
from .state import PassState, State, flag, path_of
from .structure import check_path

#: what both compilers take; the driver's context is 3.3 core, and 4.6 is beyond Mesa's software
_VERSIONS = re.compile(
    r"#version[ \t]+(330|400|410|420|430|440|450)([ \t]+core)?[ \t]*(//.*)?\r?$|#version[ \t]+3[12]0 es\b"
)
_BOM = b"\xef\xbb\xbf"
_LONG_NAMES = {"vs": "vertex", "ps": "pixel", "cs": "compute"}
#: enough for the driver to get to the stage that is of interest
_TRIVIAL = {
    Stage.VERTEX: "#version 330\nvoid main() { gl_Position = vec4(0.0); }\n",
    Stage.FRAGMENT: "#version 330\nvoid main() {}\n",
}

# In glslang's syntax tree: what a stage reads or declares, with the line where.
_READ = re.compile(
    r"^0:(\S+) +'(\w+)' \((?: layout\([^)]*\))? (?:smooth|flat|noperspective|centroid|sample) (?:\w+ )*?in "
)
_WRITTEN = re.compile(r"^0:\S+ +'(\w+)' \((?: ?layout\([^)]*\))? (?:\w+ )*?out ", re.MULTILINE)


def check(state: State) -> None:
    """Checks all passes, and gives each its sources and its program as far as they compile."""
    told: set[tuple] = set()
    for shader_pass in state.passes:
        stages = _stages(state, shader_pass)
        if stages is None:
            continue
        fine = True
        for stage, (path, at) in stages.items():
            fine &= _load(state, shader_pass, stage, path, at)
        fine = all([_check_glslang(state, shader_pass, stage, told) for stage in shader_pass.sources]) and fine
        shader_pass.is_complete &= len(shader_pass.sources) == len(stages)
        if fine and shader_pass.is_complete:
            _link(state, shader_pass, told)
        else:
            _compile_rest(state, shader_pass, told)
        for stage, source in shader_pass.sources.items():
            if stage in shader_pass.preprocessed:
                loops.check(state, shader_pass, source, shader_pass.preprocessed[stage])


def _stages(state: State, shader_pass: PassState) -> dict[Stage, tuple[Path, Element]] | None:
    """The pass's shader files by stage; None where it is not the checker's to compile."""
    element, name = shader_pass.element, shader_pass.name
    needed = ("cs",) if element.attributes.get("type") == "compute" else ("vs", "ps")
    found: dict[str, Element] = {}
    for shader in element.all("shader"):
        kind = shader.attributes.get("type", "")
        if kind in needed or (kind in ("gs", "tcs", "tes") and flag(shader, "used")):
            found[kind] = shader
    complete, plain = True, True
    for kind in needed:
        if kind not in found:
            state.add(
                "HS101",
                element,
                f'pass "{name}" has no {_LONG_NAMES[kind]} shader',
                f'add <shader type="{kind}" path="..." entry="main" />',
            )
            complete = False
    stages: dict[Stage, tuple[Path, Element]] = {}
    for kind, shader in found.items():
        relative = path_of(shader.attributes.get("path", ""))
        path = state.file(relative)
        check_path(state, shader, relative)
        if shader.attributes.get("entry", "main") != "main":
            state.add(
                "HS111",
                shader,
                f'the entry of the {kind} shader of pass "{name}" is "{shader.attributes["entry"]}"',
                'write entry="main"',
            )
        if not relative or not os.path.isfile(path):
            hint = did_you_mean(relative, _files_beside(path, relative))
            state.add(
                "HS101",
                shader,
                f'<shader type="{kind}"> of pass "{name}": there is no file "{relative}"{hint}',
                "correct the path: it is relative to the .sprj, and white space in it counts",
            )
            complete = False
        elif relative.rpartition(".")[2] in ("hlsl", "vk"):
            state.add(
                "HS112",
                shader,
                f'<shader type="{kind}"> of pass "{name}": "{relative}" is not plain GLSL by its extension',
                "name it .glsl, .vert or .frag if it is plain GLSL",
            )
            plain = False
        elif kind not in renderer.STAGES:
            plain = False
        else:
            stages[renderer.STAGES[kind]] = path, shader
    if not plain:
        return None
    order = list(renderer.STAGES.values())
    shader_pass.is_complete = complete
    return dict(sorted(stages.items(), key=lambda pair: order.index(pair[0])))


def _files_beside(path: Path, relative: str) -> list[str]:
    folder = os.path.dirname(relative)
    try:
        return [os.path.join(folder, name) for name in os.listdir(path.parent)]
    except OSError:
        return []


def defines_of(shader_pass: PassState) -> dict[str, str]:
    """The macros that the pass's shaders get, in order, SHADERed's own first."""
    own = {d.attributes.get("name", ""): d.text for d in shader_pass.macros}
    return renderer.SYSTEM_MACROS | own


def _load(state: State, shader_pass: PassState, stage: Stage, path: Path, at: Element) -> bool:
    """Reads one shader; whether there is a text for the compilers."""
    if not _check_version(state, path):
        return False
    defines = defines_of(shader_pass)
    if not includes.check(state, stage, path, defines):
        return False
    try:
        shader_pass.sources[stage] = glsl.load(path, defines, state.include_dirs)
    except GlslError as error:
        state.add("HS101", (error.file or glsl.shown_path(path), error.line), error.message, "correct the file")
        return False
    return True


def _check_version(state: State, path: Path) -> bool:
    """Whether line 1 is as both compilers need it."""
    try:
        data = path.read_bytes()
    except OSError:
        return True  # glsl.load says why
    file = glsl.shown_path(path)
    if data.startswith(_BOM):
        state.add("HS102", (file, 1), "a byte order mark stands before #version", "save the file as UTF-8 without BOM")
        return False
    lines = data.decode(errors="replace").split("\n")
    if _VERSIONS.match(lines[0]):
        return True
    if lines[0].startswith("#version"):
        state.add(
            "HS102",
            (file, 1),
            f'"{lines[0].strip()}" is not taken by both compilers',
            "write #version 330 (400 to 450, 310 es and 320 es work too)",
        )
        return False
    later = next((n for n, text in enumerate(lines, 1) if re.match(r"\s*#\s*version\b", text)), None)
    if later is None:
        state.add("HS102", (file, 1), "there is no #version", "begin the file with #version 330")
        return False
    only_blank = all(not text.strip() for text in lines[: later - 1])
    state.add(
        "HS102",
        (file, later),
        f"#version stands in line {later}, not at the beginning of line 1",
        "move it to the first line, above all comments",
        "warning" if only_blank else None,
    )
    return False


def _place(state: State, shader_pass: PassState, source: glsl.Source, line: int) -> tuple[str, int | None] | Element:
    """Where line ``line`` of the text came from; for a macro of the pass, its element."""
    if line < 1:
        return source.path, None
    file, number = source.origin(line)
    if file != "macros":
        return file, number
    name = list(defines_of(shader_pass))[number - 1]
    return next((d for d in shader_pass.macros if d.attributes.get("name") == name), shader_pass.element)


def _tell(
    state: State, shader_pass: PassState, code: str, source: glsl.Source, log: str, told: set[tuple], who: str
) -> None:
    """Adds the errors of a compiler's log, one a line, and none in lines that have one already."""
    by_line: dict[int, list[str]] = {}
    for line, message in source.errors(log):
        by_line.setdefault(line, []).append(message)
    for line, messages in by_line.items():
        at = _place(state, shader_pass, source, line)
        place = (glsl.shown_path(state.path), at.line) if isinstance(at, Element) else at
        if place in told:
            continue
        told.add(place)
        quoted = source.text.split("\n")[line - 1].strip() if line > 0 else ""
        state.add(
            code,
            at,
            f'{who}: {"; ".join(messages)} (in pass "{shader_pass.name}")',
            f"correct the line: {quoted}" if quoted else "correct the shader",
        )


def _check_glslang(state: State, shader_pass: PassState, stage: Stage, told: set[tuple]) -> bool:
    source = shader_pass.sources[stage]
    try:
        renderer.check_for_spirv(stage, source.text)
        shader_pass.preprocessed[stage] = renderer.preprocess(stage, source.text)
    except NativeError as error:
        _tell(state, shader_pass, "HS103", source, str(error), told, "glslang")
        return False
    return True


def _compile_rest(state: State, shader_pass: PassState, told: set[tuple]) -> None:
    """What the driver says of each stage by itself, where the pass cannot be linked."""
    for stage in shader_pass.preprocessed:
        source = shader_pass.sources[stage]
        if stage in _TRIVIAL:
            _compile(state, shader_pass, _TRIVIAL | {stage: source.text}, stage, source, told)


def _compile(
    state: State,
    shader_pass: PassState,
    texts: Mapping[Stage, str],
    stage: Stage,
    source: glsl.Source,
    told: set[tuple],
) -> None:
    try:
        renderer.link(dict(texts))
    except NativeError as error:
        name, _, log = str(error).partition(": ")
        if name == stage.name.lower():
            _tell(state, shader_pass, "HS104", source, log, told, "the driver")


def _link(state: State, shader_pass: PassState, told: set[tuple]) -> None:
    sources = shader_pass.sources
    _check_varyings(state, shader_pass)
    try:
        shader_pass.program = renderer.link({stage: source.text for stage, source in sources.items()})
    except NativeError as error:
        name, _, log = str(error).partition(": ")
        if name != "link":
            _compile_rest(state, shader_pass, told)
            return
        last = sources[max(sources, key=list(renderer.STAGES.values()).index)]
        state.add(
            "HS105",
            (last.path, _line_of(last, log)),
            f'the stages of pass "{shader_pass.name}" do not link: {" ".join(log.split())}',
            "give it the same name, type and qualifiers in both stages",
        )


def _line_of(source: glsl.Source, log: str) -> int | None:
    """The line that declares the first name of a linker's log that a source declares."""
    for name in re.findall(r"[`'\"]?\b([A-Za-z_]\w*)\b", log):
        for line, text in enumerate(source.text.split("\n"), 1):
            if re.match(
                rf"\s*(?:layout\s*\(.*\)\s*)?(?:\w+\s+)*(?:in|out|uniform)\s.*\b{name}\b\s*(\[.*\])?\s*;", text
            ):
                file, number = source.origin(line)
                return number if file == source.path else None
    return None


def _check_varyings(state: State, shader_pass: PassState) -> None:
    """Fragment inputs that the stage before lacks."""
    order = [stage for stage in renderer.STAGES.values() if stage in shader_pass.sources]
    if Stage.FRAGMENT not in order:
        return
    before = order[order.index(Stage.FRAGMENT) - 1]
    fragment, source = shader_pass.sources[Stage.FRAGMENT], shader_pass.sources[before]
    written = {m[1] for m in _WRITTEN.finditer(renderer.tree(before, source.text))}
    body, _, _ = renderer.tree(Stage.FRAGMENT, fragment.text).partition("Linker Objects")
    seen = set()
    for line in body.splitlines():
        match = _READ.match(line)
        if match and match[2] not in written and match[2] not in seen:
            seen.add(match[2])
            number = int(match[1]) if match[1].isdigit() else 0
            state.add(
                "HS106",
                _place(state, shader_pass, fragment, number),
                f'pass "{shader_pass.name}" reads "{match[2]}", which {source.path} does not write',
                f"write it there: out ... {match[2]};",
            )
