"""What goes to the terminal: standard output that never crashes, one line of error, progress."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Protocol, TextIO


class Progress(Protocol):
    """Called as work gets done, with the share done between 0 and 1."""

    def __call__(self, done: int, total: int) -> None:
        """Say that `done` of `total` pieces are finished."""


def one_line(text: str) -> str:
    """Return the text on one line, with what no terminal should be sent spelled out."""
    joined = " ".join(text.split())
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in joined)


def complain(message: str) -> None:
    """Write one line to standard error; a closed one is not a reason to fail."""
    with contextlib.suppress(OSError, ValueError):
        write(sys.stderr, f"separatrix: {one_line(message)}\n")


def write(stream: TextIO | None, text: str) -> None:
    """Write text to a stream in whatever encoding it has; None (a closed stream) swallows it."""
    if stream is None:
        return
    encoding = stream.encoding or "ascii"
    stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def answer(text: str) -> None:
    """Write the answer to standard output; a reader that went away (`| head`) is no error.

    Raises
    ------
    OSError
        The output could not be written, for instance on a full disk.
    """
    try:
        write(sys.stdout, text)
    except BrokenPipeError:
        _discard_standard_output()


def _discard_standard_output() -> None:
    """Point standard output at nothing, so that the interpreter's last flush does not complain."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextlib.contextmanager
def progress_bar(title: str, *, quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Yield what the work calls with (done, total), drawn on standard error; None without a terminal."""
    if quiet or sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
