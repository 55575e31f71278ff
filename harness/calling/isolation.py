"""Evaluates GLSL functions in a worker process, which may hang or crash in the caller's place.

The worker holds the GL context and what it has compiled. Arrays go through memory that both share, everything else
through a pipe. A worker that dies is replaced at the next call.
"""

from __future__ import annotations

import mmap
import os
import pickle
import threading
import time
import weakref
from collections.abc import Callable
from itertools import count as numbers
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from ..errors import HarnessError
from ..language.glsl import Source
from ..language.signature import Signature
from ..processes.process import Process, reply
from ..processes.worker import MEMORY_BYTES
from .engine import engine
from .evaluation import Evaluation
from .texture_argument import Texture

SECONDS = 60.0

_START_SECONDS = 60.0  # to start a worker: Python and the libraries, not the user's work
_WINDOW_BYTES = 64 << 20  # the shared memory: larger batches go through it part by part
_ALIGNMENT = 64
_PATIENCE = 5.0  # for a process to be gone that no longer answers: its dying may take a moment
_NUMBER_BYTES = 8  # the most that a number of a result takes

Origin = tuple[str, int] | tuple[str]


class Worker:
    """A process for the work on one shader: started when it is needed, and again after it died.

    A request may take ``seconds``, the process ``memory_bytes`` of memory. Threads may share it: they wait for
    one another. It ends with this object.
    """

    def __init__(self, seconds: float = SECONDS, memory_bytes: int = MEMORY_BYTES):
        self._seconds, self._memory_bytes = seconds, memory_bytes
        self._file = os.memfd_create("harness")
        weakref.finalize(self, os.close, self._file)
        os.ftruncate(self._file, _WINDOW_BYTES)
        self.window = mmap.mmap(self._file, _WINDOW_BYTES)
        self.lock = threading.RLock()
        self._process: Process | None = None
        self._finalizer: weakref.finalize | None = None
        #: what the process that runs now has compiled
        self.compiled: set[int] = set()

    def call(self, what: str, where: Origin, work: Callable, *arguments: Any) -> Any:
        """``work(*arguments)``, a function of a module, in the process. Its errors are raised here.

        HarnessError says that ``what``, which is to be found ``where``, took too long, died, or needed too much memory.
        """
        return self.request(what, where, self.deadline(), _called, work, arguments)

    def evaluation(self, source: Source, signature: Signature, mode: str) -> RemoteEvaluation:
        """What ``Evaluation(source, signature, mode)`` is here, there."""
        return RemoteEvaluation(self, source, signature, mode)

    def deadline(self) -> float:
        """When a request that begins now has to be done. A worker is started before the clock is."""
        with self.lock:
            if self._process is None:
                self._start()
        return time.monotonic() + self._seconds

    def request(self, what: str, where: Origin, deadline: float, work: Callable, *arguments: Any) -> Any:
        """As ``call``; ``work`` gets the worker's ``_Workplace`` first."""
        with self.lock:
            if self._process is None:
                self._start()
            message = pickle.dumps((work, arguments))
            connection = self._process.connection
            try:
                connection.send_bytes(message)
                in_time = connection.poll(max(0.0, deadline - time.monotonic()))
                done, result = pickle.loads(connection.recv_bytes()) if in_time else (False, None)
            except (EOFError, OSError):
                raise HarnessError(
                    f"{what}: its worker process died ({self._stop(_PATIENCE)}), of a crash of the driver or for want "
                    f"of memory (its limit is {self._memory_bytes >> 20} MiB)",
                    *where,
                ) from None
            except BaseException:  # interrupted: its answer, still to come, would be taken for the next one's
                self._stop()
                raise
            if not in_time:
                self._stop()
        if not in_time:
            raise HarnessError(f"{what} was stopped: it took longer than its limit of {self._seconds:g} s", *where)
        if done:
            return result
        if isinstance(result, MemoryError):
            raise HarnessError(f"{what} needs more than its limit of {self._memory_bytes >> 20} MiB of memory", *where)
        raise result

    def _start(self) -> None:
        started = Process(_serve, self._file, files=[self._file], memory_bytes=self._memory_bytes)
        self._process, self._finalizer = started, weakref.finalize(self, started.end)
        self.compiled.clear()
        try:
            if not started.connection.poll(_START_SECONDS):
                raise HarnessError(f"the worker process did not start within {_START_SECONDS:g} s ({self._stop()})")
            started.connection.recv_bytes()
        except (EOFError, OSError):
            raise HarnessError(
                f"the worker process died at its start ({self._stop(_PATIENCE)}); "
                f"its limit is {self._memory_bytes >> 20} MiB of memory"
            ) from None
        except BaseException:
            self._stop()
            raise

    def _stop(self, patience: float = 0.0) -> str:
        ended, self._process = self._process, None
        self._finalizer.detach()
        return ended.end(patience)


class RemoteEvaluation:
    """An ``Evaluation`` in a worker process: the same attributes and methods."""

    _keys = numbers()

    def __init__(self, worker: Worker, source: Source, signature: Signature, mode: str):
        self._worker, self._recipe = worker, (source, signature, mode)
        self._key = next(self._keys)
        self._settings: dict[str, tuple[str, tuple]] = {}
        attributes, self._lengths = self._compile(worker.deadline())
        self.__dict__.update(attributes)
        self.signature = signature

    def array_length(self, name: str) -> int | None:
        """As Evaluation.array_length."""
        return self._lengths[name]

    def set_uniform(self, name: str, value: np.ndarray) -> None:
        """As Evaluation.set_uniform; it is sent with the next ``run``, to whichever process does that."""
        self._settings[name] = "set_uniform", (name, np.array(value))

    def reset_uniform(self, name: str) -> None:
        """As Evaluation.reset_uniform."""
        self._settings[name] = "reset_uniform", (name,)

    def set_sampler(self, name: str, texture: Texture) -> None:
        """As Evaluation.set_sampler."""
        self._settings[name] = "set_sampler", (name, texture)

    def run(self, arrays: dict[str, np.ndarray], count: int) -> list[list[np.ndarray]]:
        """As Evaluation.run. HarnessError when it takes too long, dies, or needs too much memory."""
        with self._worker.lock:
            deadline = self._worker.deadline()
            if self._key not in self._worker.compiled:
                self._compile(deadline)
            step = self._step(arrays)
            results: list[list[np.ndarray]] = []
            for first in range(0, max(count, 1), step):
                n = min(step, count - first)
                parts = {name: a if len(a) == 1 else a[first : first + n] for name, a in arrays.items()}
                placed, end = _placed(self._worker.window, 0, list(parts.values()))
                request = dict(zip(parts, placed, strict=True)), end, n, list(self._settings.values())
                outputs = self._request(deadline, _run, self._key, *request)
                if not results:
                    results = [
                        [np.empty((count, *shape[1:]), dtype) for _, shape, dtype in leaves] for leaves in outputs
                    ]
                for arrays_, leaves in zip(results, outputs, strict=True):
                    for array, place in zip(arrays_, leaves, strict=True):
                        array[first : first + n] = _view(self._worker.window, *place)
            return results

    def _step(self, arrays: dict[str, np.ndarray]) -> int:
        """How many elements, with their results, have room in the window."""
        leaves = [leaf for _, parts in self.outputs for leaf in parts]
        each = sum(leaf.size * _NUMBER_BYTES for leaf in leaves)
        each += sum(a.shape[1] * a.itemsize for a in arrays.values() if len(a) != 1)
        once = sum(a.nbytes for a in arrays.values() if len(a) == 1) + _ALIGNMENT * (len(arrays) + len(leaves))
        step = (_WINDOW_BYTES - once) // each
        if step < 1:
            raise HarnessError(f"{self.signature} is too large for a worker process", *self.signature.origin)
        return step // 4 * 4 or step

    def _compile(self, deadline: float) -> tuple[dict[str, Any], dict[str, int | None]]:
        found = self._request(deadline, _compile, self._key, *self._recipe)
        self._worker.compiled.add(self._key)
        return found

    def _request(self, deadline: float, work: Callable, *arguments: Any) -> Any:
        signature = self._recipe[1]
        return self._worker.request(signature.name, signature.origin, deadline, work, *arguments)


#: offset in the window, shape, dtype
Place = tuple[int, tuple[int, ...], np.dtype]


def _view(window: mmap.mmap, offset: int, shape: tuple[int, ...], dtype: np.dtype) -> np.ndarray:
    return np.ndarray(shape, dtype, window, offset)


def _placed(window: mmap.mmap, offset: int, arrays: list[np.ndarray]) -> tuple[list[Place], int]:
    """Copies arrays into the window from ``offset`` on; where they are, and the offset after them."""
    places = []
    for array in arrays:
        place = offset, array.shape, array.dtype
        _view(window, *place)[...] = array
        places.append(place)
        offset += -(-array.nbytes // _ALIGNMENT) * _ALIGNMENT
    return places, offset


# ---- In the worker process ------------------------------------------------------------------------------------------


#: what the other side has to know of an evaluation, but for the signature
_PUBLIC = ("inputs", "outputs", "uniforms", "samplers", "initial")


class _Workplace:
    def __init__(self, window: mmap.mmap):
        self.window = window
        self.evaluations: dict[int, Evaluation] = {}


def _serve(connection: Connection, file: int) -> None:
    workplace = _Workplace(mmap.mmap(file, _WINDOW_BYTES))
    connection.send_bytes(b"ready")
    while True:
        work, arguments = pickle.loads(connection.recv_bytes())
        connection.send_bytes(reply(work, workplace, *arguments))


def _called(workplace: _Workplace, work: Callable, arguments: tuple) -> Any:
    return work(*arguments)


def _compile(
    workplace: _Workplace, key: int, source: Source, signature: Signature, mode: str
) -> tuple[dict[str, Any], dict[str, int | None]]:
    """What is public of the evaluation, and the lengths of its uniforms."""
    evaluation = workplace.evaluations[key] = engine(source, signature, mode)
    public = {name: getattr(evaluation, name) for name in _PUBLIC}
    return public, {name: evaluation.array_length(name) for name in evaluation.uniforms}


def _run(
    workplace: _Workplace,
    key: int,
    inputs: dict[str, Place],
    end: int,
    count: int,
    settings: list[tuple[str, tuple]],
) -> list[list[Place]]:
    evaluation = workplace.evaluations[key]
    for method, arguments in settings:
        getattr(evaluation, method)(*arguments)
    arrays = {name: _view(workplace.window, *place) for name, place in inputs.items()}
    outputs = []
    for leaves in evaluation.run(arrays, count):
        places, end = _placed(workplace.window, end, leaves)
        outputs.append(places)
    return outputs
