"""A fresh Python process to talk to: started anew, never forked, since a process that holds a GL context must not be.

It ends with the process that started it, however that one ends.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import resource
import signal
import subprocess
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any

from ..errors import HarnessError
from .worker import limit_memory

#: what the new process runs: it finds modules where this one does, then leaves the rest to ``_main``
_START = """
import sys
from multiprocessing.connection import Connection
connection = Connection(int(sys.argv[1]))
sys.path[:] = connection.recv()
from harness.processes import process
process._main(connection)
"""


class Process:
    """A Python process that calls ``serve(connection, *arguments)`` and ends when that returns.

    ``serve`` is a function of a module; ``connection`` is the other end of ours. ``files`` are descriptors that it
    gets under the same numbers, ``memory_bytes`` limits its memory. When it is dead, ``connection`` raises
    EOFError or OSError.
    """

    def __init__(
        self,
        serve: Callable[..., None],
        *arguments: Any,
        files: Sequence[int] = (),
        memory_bytes: int | None = None,
    ):
        # Pickled first: what cannot be sent must not leave a process behind.
        first = pickle.dumps((serve, arguments, memory_bytes))
        self.connection, theirs = Pipe()
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-c", _START, str(theirs.fileno())],
                stdin=subprocess.PIPE,  # closed by our end, whatever that is: see _leave_with_parent
                pass_fds=[theirs.fileno(), *files],
            )
        with contextlib.suppress(OSError):  # dead already: the first use of the connection says so
            self.connection.send(sys.path)
            self.connection.send_bytes(first)

    def end(self, patience: float = 0.0) -> str:
        """How it ended, as "SIGSEGV" or "exit code 1"; killed, if that takes longer than ``patience`` seconds."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(patience)
        self._process.kill()
        code = self._process.wait()
        self._process.stdin.close()
        self.connection.close()
        return signal.Signals(-code).name if code < 0 else f"exit code {code}"


def attempt(work: Callable[..., Any], *arguments: Any) -> tuple[bool, Any]:
    """(True, what ``work`` returns) or (False, the exception that it raises), such as can be sent to a process."""
    try:
        return True, work(*arguments)
    except Exception as error:
        if not isinstance(error, HarnessError):  # no user's fault: where it happened will be asked for
            error.add_note("In another process: " + traceback.format_exc().rstrip())
        try:
            pickle.loads(pickle.dumps(error))
        except Exception:
            return False, RuntimeError(f"{type(error).__name__}: {error}")
        return False, error


def reply(work: Callable[..., Any], *arguments: Any) -> bytes:
    """What ``attempt`` gives, pickled; that it cannot be is such an exception too."""
    outcome = attempt(work, *arguments)
    try:
        return pickle.dumps(outcome)
    except Exception as error:
        return pickle.dumps((False, TypeError(f"the result cannot be sent to another process: {error}")))


def result_of(replied: bytes) -> Any:
    """What ``reply`` was the reply of; what that raised is raised."""
    done, result = pickle.loads(replied)
    if not done:
        raise result
    return result


def _main(connection: Connection) -> None:
    os.set_inheritable(connection.fileno(), False)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole group; the parent decides
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(EOFError, OSError):  # the parent has gone
        serve, arguments, memory_bytes = pickle.loads(connection.recv_bytes())
        if memory_bytes is not None:
            limit_memory(memory_bytes)
        serve(connection, *arguments)


def _leave_with_parent() -> None:
    os.read(0, 1)
    os._exit(1)
