"""Runs work on untrusted shaders and projects in a process of its own, with a limit on time and memory.

A shader can loop for ever and a file can crash a driver; neither may take the caller along.
"""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
from collections.abc import Callable

from .errors import HarnessError

SECONDS = 120.0
MEMORY_BYTES = 8 << 30  # of address space: a 1 GiB texture and its mipmaps fit, a decompression bomb does not

_POLL_SECONDS = 0.002


def run(work: Callable[[], int], seconds: float = SECONDS, memory_bytes: int = MEMORY_BYTES) -> int:
    """What ``work`` returns, an exit code, from a child process that inherits everything and changes nothing here.

    HarnessError when it takes longer than ``seconds``, or ends by a signal, as crashes do.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        _run_child(work, memory_bytes)
    try:
        status = _wait(child, seconds)
    except BaseException:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        raise
    if os.WIFSIGNALED(status):
        name = signal.Signals(os.WTERMSIG(status)).name
        raise HarnessError(f"the driver or a library under it crashed ({name}) on this input")
    return os.WEXITSTATUS(status)


def _wait(child: int, seconds: float) -> int:
    end = time.monotonic() + seconds
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return status
        if time.monotonic() > end:
            raise HarnessError(f"ran out of time after {seconds:g} s; --time-limit allows more")
        time.sleep(_POLL_SECONDS)


def _run_child(work: Callable[[], int], memory_bytes: int) -> None:
    """Never returns. Leaves by _exit: what the parent registered for its own end is the parent's."""
    code = 1
    try:
        resource.setrlimit(resource.RLIMIT_AS, (memory_bytes, memory_bytes))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        code = work()
    except MemoryError:
        print(f"harness: needs more than {memory_bytes >> 20} MiB of memory", file=sys.stderr)
    except BaseException:
        sys.excepthook(*sys.exc_info())
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
