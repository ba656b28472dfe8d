"""The command line: `separatrix VERB STUDY [--json] [--out DIR] [--quiet] [--jobs N]`."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

__all__ = ["main", "process"]

INTERRUPTED = 130
"""Exit status after Ctrl-C."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line on `arguments`, by default those of the process; return its exit status.

    0 answered, 1 a fault of ours, 2 a wrong input (a line a mistake on standard error), 130 interrupted.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy reads it; our threads are those of --jobs
    try:
        from separatrix.front.cli import run_command_line

        return run_command_line(arguments)
    except KeyboardInterrupt:
        from separatrix.front.console import interrupted

        return interrupted("no file was written.")


def process() -> NoReturn:
    """Run the command line and end the process; threads that an interrupt left behind end with it."""
    status = main()
    if status != INTERRUPTED:
        sys.exit(status)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # a closed one, or none
            stream.flush()
    os._exit(status)
