"""One GLSL function, compiled in one mode, over arrays: its inputs, uniforms, textures, and how much of it at once."""

from __future__ import annotations

import re
import time
from functools import cache

import numpy as np

from .. import native
from ..errors import CallError, GlslError, NativeError
from ..language import dialect, rewrite
from ..language.glsl import Source
from ..language.leaf import leaves
from ..language.signature import Opaque, Signature, signatures
from ..native import gl_enums
from . import loops
from .shader_text import Inputs
from .stages import ComputeStage, FragmentStage, Job, lanes
from .texture_argument import SAMPLERS, Texture

BUFFERS_MAX = 16  # arrays with a buffer of their own; GL promises 16 units a stage, and textures take some
#: texture units below are those of the buffers
FIRST_UNIT = BUFFERS_MAX
#: elements that are evaluated at once where their numbers are copied together first
PACKED_STEP = 1 << 16
#: the same where loops are counted: few at first, for they may be endless; more while that takes less than this
COUNTED_STEPS = 1 << 10, 1 << 18
COUNTED_SECONDS = 0.05

_FIRST = "[0]"


class Evaluation:
    """One GLSL function, compiled in one mode: ``run`` takes flat arrays and gives flat arrays."""

    def __init__(self, source: Source, signature: Signature, mode: str):
        """GlslError when the source does not compile in this mode, CallError when the function cannot be called."""
        self.signature = signature
        spoken = dialect.dialect(source, mode)
        self._source, self._spoken = source, spoken
        text, initialised = rewrite.uniform_initialisers(source.text)
        if spoken.translated:
            source = dialect.replaced(source, text)
            signature = self._translated(source)
        try:
            opaque = [(n, p) for n, p in enumerate(signature.inputs) if isinstance(p.type, Opaque)]
            for _, p in opaque:
                if p.type.name not in SAMPLERS:
                    known = ", ".join(SAMPLERS)
                    raise CallError(f"{p.name} is a {p.type}, which cannot be given; of textures, {known} can")
            #: parameter or uniform -> (the uniform that a texture is set by, its type)
            self.samplers = {p.name: (f"hn_tex{n}", p.type.name) for n, p in opaque}
            #: (parameter, [(name of the array in ``run``, leaf)]) of those that are numbers
            self.inputs = [
                (p.name, [(f"hn_in{n}_{k}", leaf) for k, leaf in enumerate(leaves(p.type))])
                for n, p in enumerate(signature.inputs)
                if p.name not in self.samplers
            ]
            self.outputs = [(name, list(leaves(kind))) for name, kind in signature.outputs]
        except CallError as error:
            raise CallError(f"{error.message}; it is {signature}", *signature.origin) from None
        if not any(parts for _, parts in self.outputs):
            raise CallError(f"{signature} yields nothing", *signature.origin)
        given = [(name, buffer, leaf) for name, buffers in self.inputs for buffer, leaf in buffers]
        inputs = Inputs(given, dict(self.samplers), packed=len(given) > BUFFERS_MAX)
        self._set: dict[str, tuple[int, np.ndarray]] = {}
        self._textures: dict[str, Texture] = {}
        self._open(mode)
        self._counts = lanes() is not None and loops.most_passes(source.text, signature.name) >= loops.CAP
        self._packed = inputs.packed
        self._stage = self._compiled(Job(source, spoken, signature, inputs, self.outputs, self._counts))
        program = self._stage.program
        #: those that the function reads; of an array the first element stands for all
        self.uniforms = self._read(
            {n.removesuffix(_FIRST): u for n, u in program.uniforms.items() if not n.startswith("hn_")}
        )
        for name, uniform in self.uniforms.items():
            kind = gl_enums.GLSL_TYPE_NAMES.get(uniform.type)
            if kind in SAMPLERS:
                self.samplers[name] = name, kind
        #: uniforms that need not be given -> the value that the source gives them, in GL's order
        self.initial = self._initial([name for name in self.uniforms if re.match(r"\w+", name)[0] in initialised])

    def _open(self, mode: str) -> None:
        native.open_context()
        if mode == "mediump" and not _computes_in_half():
            raise CallError(
                f"mode mediump: this driver ({native.context_info()['renderer']}) computes it in single precision",
                *self.signature.origin,
            )

    def _read(self, uniforms: dict[str, native.Variable]) -> dict[str, native.Variable]:
        """Without the members of structures that nothing reads: the driver lists all of them where one is read."""
        if not any("." in name for name in uniforms):
            return uniforms
        from ..interpreting.interpretation import uniforms_read  # which few functions have to pay for

        read = uniforms_read(self._source, self.signature)
        return {
            name: u
            for name, u in uniforms.items()
            if "." not in name or name in read or gl_enums.GLSL_TYPE_NAMES.get(u.type) in SAMPLERS
        }

    def _translated(self, source: Source) -> Signature:
        """The function's signature in the dialect that the mode compiles, which has precisions."""
        try:
            found = signatures(
                dialect.checked(source, self._spoken),
                rewrite.struct_names(source.text),
                rewrite.result_names(source.text),
            )
        except GlslError as error:
            raise self._refused(error) from None
        own = self.signature
        return next(s for s in found if (s.name, s.origin, str(s)) == (own.name, own.origin, str(own)))

    def _refused(self, error: GlslError) -> GlslError:
        if not self._spoken.translated:
            return error
        version = f"{self._spoken.version // 100}.{self._spoken.version % 100:02}"
        told = f"in mode {self._spoken.mode} the source is compiled as GLSL ES {version}, which does not take this: "
        return GlslError(told + error.message, error.file, error.line)

    def _compiled(self, job: Job) -> ComputeStage | FragmentStage:
        if native.compute_available():
            try:
                return ComputeStage(job, self._prepare)
            except NativeError:
                pass  # it needs what only a fragment has, or the other stage says better what is wrong
        try:
            return FragmentStage(job, self._prepare)
        except NativeError as error:
            stage, _, log = str(error).partition(": ")
            found = self._source.error(log if stage in ("vertex", "fragment") else str(error))
            raise self._refused(found) from None

    def array_length(self, name: str) -> int | None:
        """How many elements of a uniform the function reads; None where it is no array."""
        return self.uniforms[name].size if name not in self._stage.program.uniforms else None

    def set_uniform(self, name: str, value: np.ndarray) -> None:
        """Sets a numeric uniform that the function reads; ``value`` in numpy's order, an array's elements first."""
        kind = self.uniforms[name].type
        if gl_enums.GLSL_TYPE_NAMES[kind].startswith("mat"):
            value = value.swapaxes(-1, -2)
        self._set_everywhere(name, kind, value)

    def reset_uniform(self, name: str) -> None:
        """Gives a uniform of ``initial`` the value that the source states."""
        self._set_everywhere(name, self.uniforms[name].type, self.initial[name])

    def set_sampler(self, name: str, texture: Texture) -> None:
        """Sets the texture of a parameter or a uniform, one of ``samplers``. CallError when it is of another kind."""
        kind = self.samplers[name][1]
        if not isinstance(texture, Texture):
            message = f"{name} is a {kind}: give it a harness.Texture, got {type(texture).__name__}"
            raise CallError(f"{message}; it is {self.signature}", *self.signature.origin)
        if texture.sampler != kind:
            message = f"{name} is a {kind}, but {texture} is one for a {texture.sampler}"
            raise CallError(f"{message}; it is {self.signature}", *self.signature.origin)
        self._textures[name] = texture

    def _set_everywhere(self, name: str, kind: int, value: np.ndarray) -> None:
        self._set[name] = kind, value
        for program in self._stage.programs():
            _set_uniform(program, name, kind, value)

    def _prepare(self, program: native.Program) -> None:
        """Sets the uniforms of a program that was compiled after they were given."""
        for name, (kind, value) in self._set.items():
            _set_uniform(program, name, kind, value)

    def _initial(self, names: list[str]) -> dict[str, np.ndarray]:
        if (
            names and self._spoken.translated
        ):  # GLSL ES has no initialisers: what the source's own language makes of them
            known = Evaluation(self._source, self.signature, "as-written").initial
            return {name: known[name] for name in names if name in known}
        program = self._stage.program
        return {
            name: program.uniform(name if name in program.uniforms else name + _FIRST, self.uniforms[name].size)
            for name in names
        }

    def _bind_textures(self) -> None:
        for unit, (name, texture) in enumerate(self._textures.items(), FIRST_UNIT):
            texture.bind(unit)
            self._set_everywhere(self.samplers[name][0], gl_enums.GL_SAMPLER_2D, np.int32([unit]))

    def run(self, arrays: dict[str, np.ndarray], count: int) -> list[list[np.ndarray]]:
        """Evaluates the function ``count`` times.

        ``arrays`` maps each buffer's name to (count, size) or (1, size) numbers of the leaf's dtype, C-contiguous.
        Returns for each output its leaves, as arrays (count, size). CallError when a loop was stopped by the driver.
        """
        stage = self._stage
        planes = [np.empty((count, size), np.float32) for size in stage.planes]
        if self._textures:
            self._bind_textures()
        most = self._most()
        step = min(most, COUNTED_STEPS[0]) if self._counts else most
        first = 0
        while first < count:
            n = min(step, count - first)
            some = {name: a if len(a) == 1 else a[first : first + n] for name, a in arrays.items()}
            parts = [plane[first : first + n] for plane in planes]
            if self._counts:
                start = time.perf_counter()
                self._run_counted(some, parts, n)
                if time.perf_counter() - start < COUNTED_SECONDS:
                    step = min(2 * step, most, COUNTED_STEPS[1])
            else:
                stage.run(some, parts, n)
            first += n
        rest = iter(stage.values(planes))
        return [
            [next(rest).view(leaf.dtype) if leaf.type.base != "float" else next(rest) for leaf in parts]
            for _, parts in self.outputs
        ]

    def _most(self) -> int:
        """How many elements at once; every part of an array aligned like the first, so that none is copied."""
        texels = [leaf.texels for _, buffers in self.inputs for _, leaf in buffers]
        packed = sum(leaf.size for _, buffers in self.inputs for _, leaf in buffers) // 4 + 1
        most = native.evaluate_limit() // (packed if self._packed else max([1, *texels]))
        most = min(most, self._stage.limit(), PACKED_STEP if self._packed else most)
        return max(most // 4 * 4 or most, 1)

    def _run_counted(self, arrays: dict[str, np.ndarray], planes: list[np.ndarray], count: int) -> None:
        """Evaluates, and asks whether a loop was stopped."""
        passes = np.empty((count, 1), np.float32)
        self._stage.run(arrays, [*planes, passes], count)
        if passes.view(np.int32).max(initial=0) <= loops.SURE:
            return
        if isinstance(self._stage, FragmentStage):
            raise CallError(
                f"the loops of {self.signature} ran more than {loops.SURE} passes for one element; in a fragment "
                "stage, which it needs, the software renderer may have stopped them silently",
                *self.signature.origin,
            )
        line = self._stage.line_where_stopped(arrays, [*planes, passes], count)
        if line:
            raise CallError(
                f"the loops of {self.signature} ran {loops.CAP} passes for one element, this one the last, where the "
                "software renderer stops them silently: it is endless, or needs a smaller bound",
                *self._source.origin(line),
            )


def _set_uniform(program: native.Program, name: str, kind: int, value: np.ndarray) -> None:
    """Sets a uniform, or an array from its first element on, where the program reads it."""
    name = name if name in program.uniforms else name + _FIRST
    if name in program.uniforms:
        program.set_uniform(name, kind, value)


@cache
def _computes_in_half() -> bool:
    """Whether the driver's mediump is half precision: (1 + 2^-11) - 1 is 0 there. Not every processor has it."""
    source = Source("", "#version 330\n", (("", 1),))
    rest = [
        native.compute_head(),
        "uniform highp samplerBuffer hn_x; uniform highp int hn_count;",
        "layout(std430, binding = 0) writeonly buffer hn_Out { highp float hn_out[]; };",
        "void main() { vec2 x = texelFetch(hn_x, 0).xy; float sum = x.x + x.y, left = sum - x.x; hn_out[0] = left; }",
    ]
    spoken = dialect.dialect(source, "mediump")
    if not native.compute_available():
        return False
    program = native.Program.compute(dialect.complete(source, rest, spoken, compute=True))
    result = np.empty((1, 1), np.float32)
    program.evaluate({"hn_x": np.float32([[1, 2**-11]])}, [result], 1)
    return bool(result[0, 0] == 0)
