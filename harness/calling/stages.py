"""The programs around one GLSL function: a compute stage for one element or several, or a fragment stage."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .. import native
from ..language import dialect, rewrite
from ..language.dialect import Dialect
from ..language.glsl import Source
from ..language.leaf import Leaf
from ..language.signature import Signature
from . import loops, shader_text
from .shader_text import WIDE, Inputs

VECTOR = 4  # numbers of a fragment's output
OUTPUTS_MAX = 8  # outputs of a fragment, and blocks of a compute stage, that GL promises
NUMBERS_OF_WIDE = 64  # numbers in and out of a function above which several elements at once do not pay
ALONE_AT_ONCE = 64  # elements that are evaluated at once, each by a group of its own: few, for they may be endless
#: elements from which on another program, for several at once, pays
COUNT_OF_WIDE = 1 << 15


@dataclass(frozen=True)
class Job:
    """What a stage is made for: the function, where its numbers come from, and what to do to its text."""

    source: Source
    spoken: Dialect
    signature: Signature
    inputs: Inputs
    outputs: Sequence[tuple[str, Sequence[Leaf]]]
    counts_loops: bool

    @property
    def leaves(self) -> list[Leaf]:
        """The leaves of all outputs."""
        return [leaf for _, parts in self.outputs for leaf in parts]

    def call(self, element: int = 0, *, wide: bool = False) -> tuple[list[str], list[list[str]]]:
        """The statements of one call, and the numbers of each of its leaves."""
        return shader_text.call(self.signature, self.inputs, self.outputs, element, wide=wide, half=self.spoken.half)

    def declarations(self) -> list[str]:
        """The samplers among the parameters."""
        return [f"uniform {kind} {name};" for name, kind in self.inputs.samplers.values()]


def lanes() -> int | None:
    """How many elements the driver takes through a loop together; None when it is not llvmpipe, which stops no loop."""
    renderer = native.context_info()["renderer"]
    bits = re.search(r"llvmpipe.*?(\d+) bits", renderer)
    return int(bits[1]) // 32 if bits else None


class ComputeStage:
    """Evaluates in a compute stage. Output planes: one for each leaf, or one for all where they are too many.

    NativeError when the function does not compile there: a derivative has no meaning in it, for one.
    """

    def __init__(self, job: Job, prepare: Callable[[native.Program], None]):
        self._job, self._prepare = job, prepare
        self._packed = len(job.leaves) + job.counts_loops > OUTPUTS_MAX
        sizes = [leaf.size for leaf in job.leaves]
        #: numbers of an element in each plane
        self.planes = [sum(sizes)] if self._packed else sizes
        self.program = self._made(1, loops.COUNT_EACH)
        self._wide: native.Program | None = None
        self._groups: native.Program | None = None
        numbers = sum(sizes) + sum(leaf.size for *_, leaf in job.inputs.leaves)
        self._can_be_wide = (
            not (self._packed or job.inputs.packed or job.counts_loops)
            and numbers <= NUMBERS_OF_WIDE
            and not rewrite.has_variables(job.source.text)
            and WIDE * loops.most_passes(job.source.text, job.signature.name) < loops.CAP
        )

    def _made(self, elements: int, counter: str, start: str = "") -> native.Program:
        job = self._job
        declarations, reads = shader_text.read(job.inputs, elements)
        calls, planes = [], []
        for element in range(elements):
            body, numbers = job.call(element, wide=elements > 1)
            calls.append(body)
            numbers = [[n for leaf in numbers for n in leaf]] if self._packed else numbers
            planes = [[*a, *b] for a, b in zip(planes, numbers, strict=True)] if planes else numbers
        if job.counts_loops:
            planes.append(["intBitsToFloat(hn_passes)"])
        main = shader_text.compute_body([start, *reads], calls, planes)
        rest = [*declarations, *job.declarations(), native.compute_head(), *main]
        counter = counter if job.counts_loops else ""
        return native.Program.compute(dialect.complete(job.source, rest, job.spoken, compute=True, counter=counter))

    def limit(self) -> int:
        """The most elements that ``run`` takes at once."""
        return native.compute_limit(max(self.planes))

    def programs(self) -> list[native.Program]:
        """Those compiled so far, which all want the same uniforms."""
        return [p for p in (self.program, self._wide, self._groups) if p]

    def run(self, arrays: Mapping[str, np.ndarray], planes: Sequence[np.ndarray], count: int) -> None:
        """Evaluates into ``planes``, several elements at once where there are many.

        ``arrays`` maps each buffer to (count, size) or (1, size) numbers.
        """
        done = 0
        if self._can_be_wide and count >= COUNT_OF_WIDE:
            if self._wide is None:
                self._wide = self._made(WIDE, "")
                self._prepare(self._wide)
            done = count // WIDE * WIDE
            groups = {
                buffer: (np.tile(a, (WIDE, 1)) if len(a) == 1 else a[:done]).reshape(-1, 4)
                for buffer, a in arrays.items()
            }
            self._wide.evaluate(groups, [plane[:done] for plane in planes], done, WIDE)
        if done < count:
            rest = {buffer: a if len(a) == 1 else a[done:] for buffer, a in arrays.items()}
            self.program.evaluate(self._texels(rest), [plane[done:] for plane in planes], count - done)

    def line_where_stopped(self, arrays: Mapping[str, np.ndarray], planes: Sequence[np.ndarray], count: int) -> int:
        """The line of a loop that the driver stopped; 0 when it stopped none. ``planes`` are written again.

        A group of elements that part ways takes more passes than any of them. So where a group reached the cap its
        elements are evaluated each by itself, by a group of its own.
        """
        lanes_ = lanes()
        if self._groups is None:
            self._groups = self._made(1, loops.COUNT_GROUPS.format(lanes_), loops.START_GROUP.format(lanes_))
            self._prepare(self._groups)
        self._groups.evaluate(self._texels(arrays), planes, count)
        if not planes[-1].view(np.int32).any():
            return 0
        for first in range(0, count, ALONE_AT_ONCE):
            n = min(ALONE_AT_ONCE, count - first)
            some = {b: a if len(a) == 1 else np.repeat(a[first : first + n], lanes_, axis=0) for b, a in arrays.items()}
            repeated = [np.empty((n * lanes_, plane.shape[1]), np.float32) for plane in planes]
            self._groups.evaluate(self._texels(some), repeated, n * lanes_)
            if line := int(repeated[-1].view(np.int32).max()):
                return line
            for plane, values in zip(planes, repeated, strict=True):
                plane[first : first + n] = values[::lanes_]
        return 0

    def _texels(self, arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        return texels(self._job.inputs, arrays)

    def values(self, planes: Sequence[np.ndarray]) -> list[np.ndarray]:
        """The leaves (count, size) in the planes."""
        if not self._packed:
            return list(planes)
        ends = np.cumsum([leaf.size for leaf in self._job.leaves])
        return np.split(planes[0], ends[:-1], axis=1)


class FragmentStage:
    """Evaluates in a fragment stage, or in several where the outputs are too many. Planes: vectors of the leaves.

    NativeError when the function does not compile.
    """

    def __init__(self, job: Job, prepare: Callable[[native.Program], None]):
        self._job = job
        body, numbers = job.call()
        vectors = [n[k : k + VECTOR] for n in numbers for k in range(0, len(n), VECTOR)]
        if job.counts_loops:
            vectors.append(["intBitsToFloat(hn_passes)"])
        declarations, reads = shader_text.read(job.inputs, 1)
        vertex = native.evaluate_vertex()
        if job.spoken.es:
            vertex = vertex.replace(vertex.partition("\n")[0], f"#version {job.spoken.version} es")
        #: numbers of an element in each plane
        self.planes = [len(vector) for vector in vectors][: len(vectors) - job.counts_loops]
        self._programs = []
        for first in range(0, len(vectors), OUTPUTS_MAX):
            main = shader_text.fragment_body(reads, body, vectors[first : first + OUTPUTS_MAX])
            text = dialect.complete(
                job.source,
                [*declarations, *job.declarations(), *main],
                job.spoken,
                compute=False,
                counter=loops.COUNT_EACH if job.counts_loops else "",
            )
            self._programs.append(native.Program(vertex, text))
        self.program = self._programs[-1]

    def limit(self) -> int:
        """The most elements that ``run`` takes at once."""
        return native.evaluate_limit()

    def programs(self) -> list[native.Program]:
        """All, which want the same uniforms."""
        return self._programs

    def run(self, arrays: Mapping[str, np.ndarray], planes: Sequence[np.ndarray], count: int) -> None:
        """As ComputeStage.run."""
        for k, program in enumerate(self._programs):
            some = planes[k * OUTPUTS_MAX : (k + 1) * OUTPUTS_MAX]
            program.evaluate(texels(self._job.inputs, arrays), some, count)

    def values(self, planes: Sequence[np.ndarray]) -> list[np.ndarray]:
        """The leaves (count, size) in the planes."""
        rest = iter(planes)
        found = []
        for leaf in self._job.leaves:
            pieces = [next(rest) for _ in range(0, leaf.size, VECTOR)]
            found.append(pieces[0] if len(pieces) == 1 else np.concatenate(pieces, axis=1))
        return found


def texels(inputs: Inputs, arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays as the texels of their buffers; or all of them in one."""
    if not inputs.packed:
        return {buffer: arrays[buffer].reshape(-1, leaf.components) for _, buffer, leaf in inputs.leaves}
    packed = np.zeros((max(map(len, arrays.values())), inputs.packed_size), np.uint32)
    first = 0
    for _, buffer, leaf in inputs.leaves:
        packed[:, first : first + leaf.size] = arrays[buffer].view(np.uint32)
        first += leaf.size
    return {shader_text.PACKED: packed.reshape(-1, 4)}
