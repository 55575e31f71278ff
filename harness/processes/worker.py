"""Runs work on untrusted shaders and projects in a process of its own, with a limit on time and memory.

A shader can loop for ever and a file can crash a driver; neither may take the caller along.
"""

from __future__ import annotations

import os
import re
import resource
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

from ..errors import HarnessError

SECONDS = 120.0
LEAST_MEMORY_BYTES = 256 << 20  # to begin at all: Python, the libraries and a context take 170 MiB
MEMORY_BYTES = 4 << 30  # a picture of 8000 x 8000 pixels takes 2.5 GiB, the largest textures with mipmaps 3.5

_POLL_SECONDS = 0.002
_MEMORY_SECONDS = 0.02  # between two looks at what it takes
_WORDS_BYTES = 1 << 16  # the most that is kept of what libraries print
_PATIENCE = 1.0  # for it to end by itself at Ctrl-C, which reaches it too
_UNITS = {"K": 10, "M": 20, "G": 30, "T": 40}
#: what a process dies of that gets no memory, by the driver's, LLVM's and the C++ runtime's ways of noticing
_FOR_WANT_OF_MEMORY = (signal.SIGABRT, signal.SIGSEGV, signal.SIGBUS, signal.SIGILL, signal.SIGTRAP)
#: how they say it, on stderr
SAID_OF_MEMORY = re.compile(r"bad_alloc|out.of.memory|no memory for|memory alloc", re.IGNORECASE)
#: how CPython says that the system refused to map a thread's stack or a library
_NOTHING_MAPPED = re.compile(r"can't start new thread|[Cc]annot allocate memory|failed to map segment")


def run(work: Callable[[], int], seconds: float | None = SECONDS, memory_bytes: int = MEMORY_BYTES) -> int:
    """What ``work`` returns, an exit code, from a child process that inherits everything and changes nothing here.

    What libraries print on stderr is held back until the end, and part of the error where one crashes.

    HarnessError when it takes longer than ``seconds`` (None: no limit) or ends by a signal, as crashes do, or when it
    or a process that it starts needs more than ``memory_bytes``. RuntimeError in a process that holds a GL context.
    """
    native = sys.modules.get("harness.native")
    if native and native.context_is_open():
        raise RuntimeError("a process that holds a GL context must not be forked: its child would wait for ever")
    sys.stdout.flush()
    sys.stderr.flush()
    with open(os.memfd_create("stderr"), "rb+", buffering=0) as said:
        child = os.fork()
        if child == 0:
            _run_child(work, memory_bytes, said.fileno())
        watched = _Memory(child, memory_bytes)
        try:
            status = _wait(child, seconds, watched)
        except BaseException as error:
            if not isinstance(error, KeyboardInterrupt) or not _ended(child, _PATIENCE):
                os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
            raise
        last_words = os.pread(said.fileno(), _WORDS_BYTES, 0).decode(errors="replace")
    if os.WIFSIGNALED(status):
        raise HarnessError(_crash(signal.Signals(os.WTERMSIG(status)), watched, last_words))
    sys.stderr.write(last_words)
    return os.WEXITSTATUS(status)


def limit_memory(memory_bytes: int) -> None:
    """Lets this process, and those that it starts from now on, have that much memory each.

    What is limited is memory that can be written and is no one else's, not address space, of which drivers of GPUs
    reserve far more than they use. A stricter limit that is there already stays.
    """
    for kind, limit in ((resource.RLIMIT_DATA, memory_bytes), (resource.RLIMIT_CORE, 0)):
        hard = resource.getrlimit(kind)[1]
        limit = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(kind, (limit, limit))


def too_much(memory_bytes: int) -> str:
    """The message that so much memory does not suffice."""
    return f"needs more than {shown_memory(memory_bytes)} of memory; --memory allows more"


def memory(text: str) -> int:
    """Bytes of memory, such as 2G or 512M. ValueError for what is none, or too little to begin with."""
    match = re.fullmatch(r"(\d{1,15}(?:\.\d{1,9})?)([KMGT])?(i?B)?", text.strip(), re.IGNORECASE)
    size = int(float(match[1]) * 2 ** _UNITS.get((match[2] or "").upper(), 0)) if match else 0
    if not match:
        raise ValueError(f"{text!r} is no amount of memory such as 2G or 512M")
    if size < LEAST_MEMORY_BYTES:
        raise ValueError(f"{text} is too little to begin with: {shown_memory(LEAST_MEMORY_BYTES)} is the least")
    return size


def shown_memory(size: int) -> str:
    """Bytes as people write them, as ``memory`` reads them: 2G, 512M."""
    for unit, bits in reversed(_UNITS.items()):
        if size >= 1 << bits:
            return f"{size / (1 << bits):.4g}{unit}"
    return str(size)


def _wait(child: int, seconds: float | None, watched: _Memory) -> int:
    end = None if seconds is None else time.monotonic() + seconds
    look = 0.0
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status
        now = time.monotonic()
        if end is not None and now > end:
            raise HarnessError(f"ran out of time after {seconds:g} s; --time-limit allows more")
        if now > look:
            watched.look()
            look = now + _MEMORY_SECONDS
        time.sleep(_POLL_SECONDS)


def _ended(child: int, patience: float) -> bool:
    end = time.monotonic() + patience
    while not os.waitpid(child, os.WNOHANG)[0]:
        if time.monotonic() > end:
            return False
        time.sleep(_POLL_SECONDS)
    return True


class _Memory:
    """What a process takes of the memory that it may have."""

    _MEASURES = re.compile(r"^(VmData|RssAnon|RssShmem):\s*(\d+) kB$", re.MULTILINE)

    def __init__(self, process: int, limit: int):
        self.limit = limit
        self._status = Path(f"/proc/{process}/status")
        self._largest = 0

    def look(self) -> None:
        """HarnessError when it takes more than it may: no limit of the system's knows memory shared with others."""
        try:
            found = {name: int(kib) << 10 for name, kib in self._MEASURES.findall(self._status.read_text())}
        except OSError:
            return
        self._largest = max(self._largest, found.get("VmData", 0))
        if found.get("RssAnon", 0) + found.get("RssShmem", 0) > self.limit:
            raise HarnessError(too_much(self.limit))

    @property
    def nearly_all(self) -> bool:
        """Whether it has been seen to take so much that the next doubling of an array does not fit."""
        return self._largest > self.limit // 2


def _crash(how: signal.Signals, watched: _Memory, last_words: str) -> str:
    if how is signal.SIGKILL:
        return "was killed (SIGKILL), as the system does when it is short of memory; --memory sets a lower limit"
    if how in _FOR_WANT_OF_MEMORY and (watched.nearly_all or SAID_OF_MEMORY.search(last_words)):
        return f"{too_much(watched.limit)} ({how.name})"
    crash = f"the driver or a library under it crashed ({how.name}) on this input"
    if how in _FOR_WANT_OF_MEMORY:
        crash += f", or could not go on with {shown_memory(watched.limit)} of memory, its limit (--memory)"
    line = last_words.strip().rpartition("\n")[2]
    return f"{crash}: {line}" if line else crash


def _run_child(work: Callable[[], int], memory_bytes: int, libraries: int) -> None:
    """Never returns. Leaves by _exit: what the parent registered for its own end is the parent's."""
    code = 1
    try:
        _end_with_parent()
        sys.stderr = os.fdopen(os.dup(2), "w", buffering=1, errors="backslashreplace")
        os.dup2(libraries, 2)
        limit_memory(memory_bytes)
        code = work()
    except KeyboardInterrupt:
        code = 130
    except BaseException as error:
        if isinstance(error, MemoryError) or _NOTHING_MAPPED.search(str(error)):
            print(f"harness: {too_much(memory_bytes)}", file=sys.stderr)
        else:
            sys.excepthook(*sys.exc_info())
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _end_with_parent() -> None:
    """However the parent ends, this process does: no shader is computed for nobody."""
    import ctypes

    set_death_signal = 1  # PR_SET_PDEATHSIG
    ctypes.CDLL(None).prctl(set_death_signal, signal.SIGKILL)
