"""Which GLSL a source is compiled as: its own, raised where a stage needs it, or in mode mediump GLSL ES 3.10."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .. import native
from ..calling import loops, shader_text
from ..errors import GlslError
from . import callees, precise
from .glsl import Source
from .tokens import Text

#: name of the mode -> what it does to the source
MODES = {
    "as-written": "the source as it stands: the driver may rewrite its arithmetic",
    "precise": "every operation as written, in the order written",
    "mediump": "the same in half precision, but for what the source declares highp",
    "double": "every operation as written, in float64, by our interpreter instead of the driver",
}
VERSION = 330  # the first that a function can be called from
PRECISE_VERSION = 400  # the first with `precise`
COMPUTE_VERSION = 430  # the first with compute stages
ES_VERSION = 310  # the first of GLSL ES with compute stages; mode mediump is compiled as this

_ES_EXTENSIONS = (
    "GL_EXT_texture_buffer",
    "GL_EXT_gpu_shader5",  # precise, fma
    "GL_EXT_shader_implicit_conversions",
    "GL_EXT_shader_non_constant_global_initializers",
)
#: what a source that states nothing else gets; an int is 32 bits wide also in half precision, as hashes need it
_PRECISION = (
    "precision {0} float; precision highp int; "
    "precision {0} sampler2D; precision highp isampler2D; precision highp usampler2D;"
)


@dataclass(frozen=True)
class Dialect:
    """The GLSL that a source is compiled as, and in which mode."""

    version: int
    es: bool
    mode: str

    @property
    def half(self) -> bool:
        """Whether numbers are rounded to half precision on the way in and out."""
        return self.mode == "mediump"

    @property
    def translated(self) -> bool:
        """Whether the source was written for another GLSL than it is compiled as."""
        return self.half


def dialect(source: Source, mode: str) -> Dialect:
    """How ``source`` is compiled in a mode. GlslError for versions that functions cannot be called from."""
    stated = source.text.partition("\n")[0].split()  # "#version", number, profile
    version, es = int(stated[1]), "es" in stated
    if version < (300 if es else VERSION):
        raise GlslError(f"{' '.join(stated)}: functions can be called from {VERSION} on, or 300 es", *source.origin(1))
    if es or mode == "mediump":
        return Dialect(max(version, ES_VERSION) if es else ES_VERSION, True, mode)
    return Dialect(version, False, mode)


def _with_head(text: str, version: str, head: str, extensions: tuple[str, ...] = ()) -> str:
    """The text with another #version, extensions, and ``head`` before its first token; its lines keep their numbers."""
    code = Text(text.partition("\n")[2])
    first = next(code.solid(), None)
    if first is not None:
        code.tokens[first].before = f"{head} {code.tokens[first].before}"
    numbered = [*(f"#extension {name} : enable" for name in extensions), "#line 2"] if extensions else []
    return "\n".join([version, *numbered, str(code)])


def replaced(source: Source, text: str) -> Source:
    """The source with another text of the same lines."""
    return replace(source, text=text, written=source.written or source.text)


def checked(source: Source, spoken: Dialect | None = None) -> Source:
    """The source as a compiler takes it that is to parse it: in that dialect, by default the one that it is written in.

    In GLSL ES all precisions get stated.
    """
    stated = source.text.partition("\n")[0].split()
    if not (spoken.es if spoken else "es" in stated):
        return source
    version = spoken.version if spoken else stated[1]
    head = _PRECISION.format("mediump" if spoken and spoken.half else "highp")
    return replaced(source, _with_head(source.text, f"#version {version} es", head, _ES_EXTENSIONS))


def complete(source: Source, rest: list[str], spoken: Dialect, *, compute: bool, counter: str = "") -> str:
    """The text of a stage: the source, in its dialect and mode, and what is put after it.

    With a ``counter``, which is put before it, its loops are counted.
    """
    text = "\n".join([source.text.rstrip("\n"), *rest, ""])
    if spoken.mode in ("precise", "mediump"):
        tree = (
            native.glsl_tree(native.Stage.FRAGMENT, checked(source, spoken).text) if callees.has_overloads(text) else ""
        )
        text = precise.make_precise(text, tree)
    if counter:
        text = loops.counted(text)
    if spoken.es:
        precisions = _PRECISION.format("mediump" if spoken.half else "highp")
        head = f"{precisions} {shader_text.HALF if spoken.half else ''} {counter}"
        return _with_head(text, f"#version {spoken.version} es", head, _ES_EXTENSIONS)
    least = max(COMPUTE_VERSION if compute else VERSION, PRECISE_VERSION if spoken.mode == "precise" else VERSION)
    stated = text.partition("\n")[0].split()
    stated[1] = str(max(least, spoken.version))
    return _with_head(text, " ".join(stated), counter)
