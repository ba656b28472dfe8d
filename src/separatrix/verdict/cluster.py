"""Runs on other processes or machines: a Dask scheduler that is running, or processes started here.

Only the runs of cages go there, by their numbers; what decides which runs are wanted, and the ledger, stay
here. So the answer is the same to the last bit, also when a worker is lost: its runs are made again.
"""

from __future__ import annotations

import contextlib
import re
import socket
from collections.abc import Iterator
from concurrent.futures import Executor

from separatrix.ground.errors import InputError
from separatrix.verdict.long_jobs import program

WAITING = 2
"""Threads here for each worker's thread, so that no worker waits for its next piece."""

MOST_LOCAL = 1024
PATIENCE = 20.0
"""Time to reach a scheduler [s]."""

_ADDRESS = re.compile(r"(?:(?:tcp|tls)://)?\[?([^/\s\[\]]+)\]?:([0-9]{1,5})")


@contextlib.contextmanager
def cluster(address: str) -> Iterator[tuple[Executor, int]]:
    """Connect to a cluster; yield its executor, and how many pieces to send at once.

    Parameters
    ----------
    address : str
        Of a running Dask scheduler, such as ``"tcp://host:8786"``; or ``"local:N"`` for N processes here.

    Raises
    ------
    InputError
        dask[distributed] is not installed, the address is wrong, nothing answers there, it has no workers,
        or a worker has another version of separatrix.
    """
    try:
        import distributed
    except ImportError:
        cure = 'Install it: pip install "separatrix[cluster]".'
        raise InputError("--cluster", "needs the extra cluster", cure=cure) from None
    if not address.startswith("local:"):
        _refuse_unreachable(address)
    with contextlib.ExitStack() as stack:
        scheduler: object = address
        if address.startswith("local:"):
            scheduler = stack.enter_context(
                distributed.LocalCluster(
                    n_workers=_processes(address),
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},  # of its metrics: else 8787
                    silence_logs=50,  # a worker that is lost is not a fault
                )
            )
        try:
            client = stack.enter_context(
                distributed.Client(scheduler, timeout=PATIENCE, set_as_default=False)
            )
        except (OSError, ValueError, TypeError) as error:
            raise _not_a_scheduler(address, error) from None
        threads = sum(client.nthreads().values())
        if threads == 0:
            raise InputError(
                "--cluster", "has no workers", f'"{address}"', "Start some: dask worker ADDRESS."
            )
        _refuse_other_versions(client)
        yield client.get_executor(pure=False, retries=3), WAITING * threads


def _refuse_unreachable(address: str) -> None:
    """Refuse an address where nothing answers: a client of Dask that failed would leave its thread behind."""
    found = _ADDRESS.fullmatch(address)
    try:
        if found is None:
            raise ValueError("it must be tcp://HOST:PORT")
        socket.create_connection((found[1], int(found[2])), timeout=PATIENCE).close()
    except (OSError, OverflowError, ValueError) as error:
        raise _not_a_scheduler(address, error) from None


def _not_a_scheduler(address: str, error: Exception) -> InputError:
    cure = "Start one with dask scheduler, or write local:N for N processes here."
    rule = f"is not the address of a running Dask scheduler ({' '.join(str(error).split()):.100})"
    return InputError("--cluster", rule, f'"{address}"', cure)


def _processes(address: str) -> int:
    text = address.removeprefix("local:")
    if not re.fullmatch(r"[0-9]{1,4}", text) or not 1 <= int(text) <= MOST_LOCAL:
        raise InputError("--cluster", f"must be local:N with N from 1 to {MOST_LOCAL}", f'"{address}"')
    return int(text)


def _refuse_other_versions(client: object) -> None:
    """Refuse workers whose program differs: their runs would be another engine's."""
    own = program()
    try:
        found = client.run(program)  # type: ignore[attr-defined]
    except ImportError as error:
        rule = f"has workers without separatrix ({error})"
        raise InputError("--cluster", rule, cure="Install the same version there.") from None
    others = sorted(worker for worker, theirs in found.items() if theirs != own)
    if others:
        cure = "Install the same version there, and restart the workers."
        raise InputError("--cluster", "has workers with another version of separatrix", others[0], cure)
