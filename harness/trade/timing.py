"""How long an evaluation takes on what computes here, in nanoseconds: the arithmetic alone, no memory.

A compute stage of 65 536 invocations makes its inputs itself: each number starts at a hash of the invocation and of its
place, and goes on by a step of its own, modulo 1 (a Weyl sequence); unit vectors are such numbers, normalised, on the
side of +z. An invocation evaluates in a loop and writes the sum of all results, so that nothing can be left out. From
that the time of a loop is taken that makes the same inputs and adds them up. All take turns, round after round.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from .. import native
from ..calling.function import Function
from ..errors import CallError, HarnessError, NativeError
from ..language import dialect
from ..language.leaf import leaves
from ..native import gl_enums
from ..processes import process
from ..searching.domain import Domain
from ..searching.inputs import named_leaves
from ..searching.spaces import Interval, Unit
from .values import only

INVOCATIONS = 1 << 16
ROUNDS = 15
#: the loop is made so long that the first job takes this at least
SECONDS = 0.008
LOOPS = 4, 1 << 12  # evaluations of an invocation, at least and at most: llvmpipe stops loops after 65 535 passes
#: of the shortest of so many times of a loop and of one half as long: less, and evaluations were left out
GROWTH = 1.3
PAIRS = 6
ATTEMPTS = 4
#: a step of a Weyl sequence: the fractions of the square roots of primes are as irrational as it gets
_PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53)
_SOFTWARE = ("llvmpipe", "softpipe", "swrast")

_HASH = """
highp uint hn_hash(highp uint hn_x)
{
    hn_x = hn_x * 747796405u + 2891336453u;
    hn_x = ((hn_x >> ((hn_x >> 28u) + 4u)) ^ hn_x) * 277803737u;
    return (hn_x >> 22u) ^ hn_x;
}
"""  # PCG's output permutation [O'Neill 2014]


@dataclass(frozen=True)
class Job:
    """What is timed: a stage that evaluates, the one that is taken from it, and the place of the job that it is
    compared with."""

    text: str
    null: str
    reference: int


@dataclass(frozen=True)
class Time:
    """Nanoseconds an evaluation takes: the median of the rounds, and the quartiles; ``ratio`` to the reference's,
    None where that is no more than the null loop's.

    The median of the null loop is taken from each. ``reason``: why they mean nothing, where the time did not grow with
    the count of evaluations.
    """

    ns: float
    low: float
    high: float
    ratio: float | None
    reason: str | None = None


def job(function: Function, domain: Mapping[str, Any], reference: int) -> Job:
    """The stages for a function of a domain. CallError, DomainError when it has no such inputs."""
    signature = only(function)
    where = Domain.of(function, domain)
    numbers, made = 0, []
    for name, leaf in named_leaves(signature).items():
        space = where.spaces.get(name)
        if leaf.type.base != "float" or leaf.type.columns > 1 or not isinstance(space, Unit | Interval):
            raise CallError(f"{name} of {signature} cannot be made in a shader", *signature.origin)
        parts = [f"hn_s[{numbers + k}]" for k in range(leaf.size)]
        numbers += leaf.size
        made.append(_unit(parts) if isinstance(space, Unit) else _interval(leaf.type, parts, space))
    names = [f"hn_a{k}" for k in range(len(signature.parameters))]
    targets = [f"{a}{leaf.path}" for a, p in zip(names, signature.parameters, strict=True) for leaf in leaves(p.type)]
    declared = [f"{p.type} {a};" for a, p in zip(names, signature.parameters, strict=True)]
    body = [*declared, *(f"{target} = {value};" for target, value in zip(targets, made, strict=True))]
    result = f"{signature.result} hn_result = {signature.name}({', '.join(names)});"
    sums = [_sum("hn_result" + leaf.path, leaf.size) for leaf in leaves(signature.result)]
    own = [_sum(t, leaf.size) for t, leaf in zip(targets, named_leaves(signature).values(), strict=True)]
    return Job(
        _text(function, numbers, [*body, result, f"hn_sum += {' + '.join(sums)};"]),
        _text(function, numbers, [*body, f"hn_sum += {' + '.join(own)};"]),
        reference,
    )


def _unit(parts: list[str]) -> str:
    *across, last = parts
    shifted = [f"{part} * 2.0 - 1.0" for part in across]
    return f"normalize(vec{len(parts)}({', '.join([*shifted, f'{last} + 0.05'])}))"


def _interval(kind: Any, parts: list[str], space: Interval) -> str:
    low, width = float(space.low), float(space.high) - float(space.low)
    scaled = parts if (low, width) == (0, 1) else [f"({part} * {width!r} + {low!r})" for part in parts]
    return scaled[0] if len(parts) == 1 else f"{kind}({', '.join(scaled)})"


def _sum(value: str, size: int) -> str:
    return value if size == 1 else f"dot({value}, vec{size}(1.0))"


def steps(count: int) -> list[float]:
    """The steps of so many Weyl sequences."""
    return [float(np.sqrt(_PRIMES[k % len(_PRIMES)]) * (1 + k // len(_PRIMES)) % 1) for k in range(count)]


def _text(function: Function, numbers: int, body: list[str]) -> str:
    source = function._library.source
    rest = [
        _HASH,
        native.compute_head(),
        "layout(std430, binding = 0) writeonly buffer hn_Out0 { highp float hn_out0[]; };",
        "uniform highp int hn_count;",
        "uniform highp int hn_loops;",
        "void main()",
        "{",
        "int hn_i = int(gl_GlobalInvocationID.x);",
        "if (hn_i >= hn_count) return;",
        f"float hn_s[{numbers}];",
        *(
            f"hn_s[{k}] = float(hn_hash(uint(hn_i) * {numbers}u + {k}u) >> 8u) * {2.0**-24!r};"
            for k in range(numbers)
        ),
        "float hn_sum = 0.0;",
        "for (int hn_k = 0; hn_k < hn_loops; ++hn_k) {",
        *(f"hn_s[{k}] = fract(hn_s[{k}] + {step!r});" for k, step in enumerate(steps(numbers))),
        *body,
        "}",
        "hn_out0[hn_i] = hn_sum;",
        "}",
    ]  # fmt: skip
    text = dialect.complete(source, rest, dialect.dialect(source, "as-written"), compute=True)
    return without_blank_lines(text)  # of two that are one the time is one


def without_blank_lines(text: str) -> str:
    """The text, such that macros that change nothing change nothing of it."""
    return "".join(line for line in text.splitlines(keepends=True) if line.strip())


# ---- Running ---------------------------------------------------------------------------------------------------------


class _Stage:
    """A compiled stage."""

    def __init__(self, text: str):
        native.open_context()
        self._program = native.Program.compute(text)
        self._out = np.empty((INVOCATIONS, 1), np.float32)

    def run(self, loops: int) -> float:
        """Seconds that it takes."""
        if "hn_loops" in self._program.uniforms:  # not where all results are one constant
            self._program.set_uniform("hn_loops", gl_enums.GL_INT, np.array([loops], np.int32))
        start = time.perf_counter()
        self._program.evaluate({}, [self._out], INVOCATIONS)
        return time.perf_counter() - start

    def sums(self, loops: int) -> np.ndarray:
        """What each invocation adds up to."""
        self.run(loops)
        return self._out[:, 0].copy()


def device() -> tuple[str, str]:
    """The backend of this process, and what it computes on, in the driver's words."""
    native.open_context()
    info = native.context_info()
    return info["backend"], info["renderer"]


def times(jobs: Sequence[Job], progress: Callable[[int, int], None] = lambda done, total: None) -> list[Time]:
    """The times of jobs here, by turns; ``progress`` is called with the rounds done and those in all.

    NativeError when this context has no compute stage, or one does not compile.
    """
    native.open_context()
    if not native.compute_available():
        raise NativeError(f"{device()[1]} has no compute stage")
    stages = {text: _Stage(text) for text in dict.fromkeys(t for j in jobs for t in (j.text, j.null))}
    loops = _enough(stages[jobs[0].text])
    grown = {text: _grows(stage, loops) for text, stage in stages.items()}
    samples: dict[str, list[float]] = {text: [] for text in stages}
    for k in range(ROUNDS):
        progress(k, ROUNDS)
        for text, stage in stages.items():
            samples[text].append(stage.run(loops))
    per_evaluation = 1e9 / (INVOCATIONS * loops)
    own = [(np.array(samples[j.text]) - np.median(samples[j.null])) * per_evaluation for j in jobs]
    medians = [float(np.median(values)) for values in own]
    return [_time(j, values, grown[j.text], medians) for j, values in zip(jobs, own, strict=True)]


def _time(job: Job, values: np.ndarray, grown: bool, medians: Sequence[float]) -> Time:
    low, median, high = (float(q) for q in np.quantile(values, (0.25, 0.5, 0.75)))
    reference = medians[job.reference]
    reason = None if grown else "twice as many evaluations do not take longer: they were left out"
    return Time(median, low, high, median / reference if reference > 0 else None, reason)


def _grows(stage: _Stage, loops: int) -> bool:
    """Whether more evaluations take longer: a compiler that sees no use in some leaves them out."""
    stage.run(loops)  # the driver compiles at the first
    for _ in range(ATTEMPTS):
        pairs = [(stage.run(loops), stage.run(loops // 2)) for _ in range(PAIRS)]
        long, short = map(min, zip(*pairs, strict=True))  # what a busy machine adds is seldom in the shortest
        if long >= GROWTH * short:
            return True
    return False


def _enough(stage: _Stage) -> int:
    """How many evaluations of an invocation take SECONDS."""
    loops, most = LOOPS
    stage.run(loops)
    while loops < most and stage.run(loops) < SECONDS:
        loops *= 2
    return loops


# ---- A GPU -----------------------------------------------------------------------------------------------------------


def times_on_gpu(jobs: Sequence[Job]) -> tuple[tuple[str, str], list[Time]] | None:
    """The device and the times on a GPU that EGL has, in a process of its own; None where it has none but software,
    or this process computes on it already."""
    if not any(name in device()[1] for name in _SOFTWARE):
        return None
    with _environment(native.BACKEND_VARIABLE, "egl"):
        worker = process.Process(_serve, list(jobs))
    try:
        done, found = worker.connection.recv()
    except (EOFError, OSError):
        return None
    finally:
        worker.end()
    if not done:
        raise found
    return found


def _serve(connection: Connection, jobs: list[Job]) -> None:
    connection.send_bytes(process.reply(_on_gpu, jobs))


def _on_gpu(jobs: list[Job]) -> tuple[tuple[str, str], list[Time]] | None:
    try:
        here = device()
    except HarnessError:
        return None
    return None if any(name in here[1] for name in _SOFTWARE) else (here, times(jobs))


@contextlib.contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before
