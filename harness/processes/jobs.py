"""Runs one function on many items in parallel: in processes of this machine, or on a Dask cluster.

A worker that dies has its item run again; no result is lost, and none is counted twice.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import queue
import reprlib
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from importlib.metadata import version
from multiprocessing import connection
from typing import Any, TypeVar

from ..errors import HarnessError
from . import process

ATTEMPTS = 3  # of an item, before the workers' deaths are laid to it

_PATIENCE = 5.0  # for a worker to be gone that no longer answers
_CONNECT_SECONDS = 5
_WORKERS_SECONDS = 10
_QUEUED = 2  # items on the way for each worker of a cluster: one at work, one waiting, so that none idles

Item = TypeVar("Item")
Result = TypeVar("Result")


def run(
    work: Callable[[Item], Result],
    items: Iterable[Item],
    *,
    scheduler: str | None = None,
    workers: int | None = None,
) -> Iterator[tuple[int, Result]]:
    """Yields (index of the item, ``work(item)``) for each item once, as they are done.

    ``work`` is a function of a module that the workers can import, items and results can be pickled. ``items`` is read
    only as fast as it is worked through. ``scheduler`` is the address of a Dask scheduler, such as
    "tcp://host:8786"; without one, ``workers`` processes are started here (as many as there are cores).

    What ``work`` raises is raised here, and ends the rest. HarnessError when an item's worker dies ``ATTEMPTS`` times,
    or the cluster cannot be used.
    """
    if scheduler is None:
        return _run_here(work, items, workers or len(os.sched_getaffinity(0)))
    return _run_there(work, items, scheduler)


def _died(index: int, item: Any, how: str) -> HarnessError:
    return HarnessError(
        f"the worker process died {ATTEMPTS} times ({how}) on item {index}: {reprlib.repr(item)}; "
        "a crash of the driver, or too little memory"
    )


# ---- On this machine ------------------------------------------------------------------------------------------------


def _run_here(work: Callable, items: Iterable, workers: int) -> Iterator[tuple[int, Any]]:
    work_bytes = pickle.dumps(work)
    waiting = enumerate(items)
    again: deque[tuple[int, Any]] = deque()
    deaths: dict[int, int] = {}
    idle: list[process.Process] = []
    busy: dict[connection.Connection, tuple[process.Process, int, Any]] = {}

    def fill() -> None:
        while len(busy) < workers:
            index, item = again.popleft() if again else next(waiting, (None, None))
            if index is None:
                return
            message = pickle.dumps(item)
            worker = idle.pop() if idle else process.Process(_serve, work_bytes)
            busy[worker.connection] = worker, index, item
            with contextlib.suppress(OSError):  # dead: to be read from its connection as well
                worker.connection.send_bytes(message)

    try:
        fill()
        while busy:
            ready = connection.wait(list(busy))[0]
            worker, index, item = busy.pop(ready)
            try:
                reply = ready.recv_bytes()
            except (EOFError, OSError):
                how = worker.end(_PATIENCE)
                deaths[index] = deaths.get(index, 0) + 1
                if deaths[index] == ATTEMPTS:
                    raise _died(index, item, how) from None
                again.append((index, item))
                fill()
                continue
            idle.append(worker)
            done, result = pickle.loads(reply)
            if not done:
                raise result
            fill()  # before the caller takes his time over the result
            yield index, result
    finally:
        for worker in [*idle, *(worker for worker, _, _ in busy.values())]:
            worker.end()


def _serve(there: connection.Connection, work: bytes) -> None:
    while True:
        there.send_bytes(process.reply(_unpickled, work, there.recv_bytes()))


# ---- On a cluster ---------------------------------------------------------------------------------------------------


def _run_there(work: Callable, items: Iterable, scheduler: str) -> Iterator[tuple[int, Any]]:
    try:
        import distributed
    except ImportError:
        raise HarnessError("a Dask scheduler needs dask.distributed: pip install 'shader-harness[cluster]'") from None
    work_bytes = pickle.dumps(work)
    with _client(distributed, scheduler) as client:
        checked: set[str] = set()
        waiting = enumerate(items)
        running: dict[int, tuple[Any, Any]] = {}
        finished: queue.SimpleQueue[int] = queue.SimpleQueue()

        def fill() -> None:
            room = _QUEUED * _check_workers(client, scheduler, checked)
            while len(running) < room:
                index, item = next(waiting, (None, None))
                if index is None:
                    return
                # As bytes: a Dask worker that cannot import what it is sent dies of it.
                future = client.submit(process.reply, _unpickled, work_bytes, pickle.dumps(item), pure=False)
                running[index] = future, item
                future.add_done_callback(lambda _, index=index: finished.put(index))

        fill()
        while running:
            try:
                index = finished.get(timeout=_WORKERS_SECONDS)
            except queue.Empty:
                _check_workers(client, scheduler, checked)
                continue
            future, item = running[index]
            try:
                done, result = pickle.loads(future.result(timeout=_WORKERS_SECONDS))
            except TimeoutError:  # its worker took the result along, so that it is at work again
                _check_workers(client, scheduler, checked)
                finished.put(index)
                continue
            except distributed.KilledWorker as error:
                raise _died(index, item, "by the scheduler's account") from error
            except (OSError, distributed.CancelledError) as error:
                raise HarnessError(f"the Dask scheduler at {scheduler} went away: {error}") from error
            del running[index]
            if not done:
                raise result
            fill()
            yield index, result


def _unpickled(work: bytes, item: bytes) -> Any:
    return pickle.loads(work)(pickle.loads(item))


def _client(distributed: Any, scheduler: str) -> Any:
    try:
        return distributed.Client(scheduler, timeout=_CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError) as error:
        raise HarnessError(
            f"no Dask scheduler answers at {scheduler}: {error}; start one with: dask scheduler"
        ) from None


def _check_workers(client: Any, scheduler: str, checked: set[str]) -> int:
    """How many workers there are. Refuses none, and those not ``checked`` yet that cannot work as this process can."""
    try:
        client.wait_for_workers(1, timeout=_WORKERS_SECONDS)
    except TimeoutError:
        raise HarnessError(
            f"the scheduler at {scheduler} has no workers; start some with: dask worker {scheduler} --nthreads 1"
        ) from None

    def there() -> str | None:  # sent as it is, not by its name: our package may not be there
        import importlib.metadata

        try:
            import harness.processes.jobs  # noqa: F401

            return importlib.metadata.version("shader-harness")
        except ImportError:
            return None

    threads = client.nthreads()
    new = sorted(threads.keys() - checked)
    ours = version("shader-harness")
    for address, theirs in client.run(there, workers=new, on_error="return").items() if new else ():
        if isinstance(theirs, Exception):  # it has gone already
            continue
        if theirs != ours:
            has = f"has shader-harness {theirs}" if theirs else "has no shader-harness"
            raise HarnessError(
                f"the worker {address} {has}, and {ours} is needed: pip install shader-harness=={ours} there"
            )
        if threads[address] != 1:
            raise HarnessError(
                f"the worker {address} runs {threads[address]} threads, and OpenGL belongs to one: "
                "start it with --nthreads 1"
            )
        checked.add(address)
    return max(1, len(threads))  # one that left in this moment leaves room for the next
