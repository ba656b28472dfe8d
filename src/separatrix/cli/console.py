"""What goes to the terminal: standard output that never crashes, one line of error, progress."""

from __future__ import annotations

import _thread
import contextlib
import os
import re
import sys
import threading
import unicodedata
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TextIO

from separatrix.errors import InputError

INTERRUPTED = 130
"""Exit status after Ctrl-C."""

RETRY = 0.02
"""Time after which a swallowed interrupt is sent again [s]."""


_SUSPECT = re.compile(r"[^\n\x20-\x7e]")


def harmless(text: str) -> str:
    """Return the text with control characters spelled out, except ends of lines.

    A terminal obeys them, and a title, a name or a log's header may come from somebody else. Characters that
    cannot be seen, such as those that turn the direction of writing, are spelled out too.
    """
    return _SUSPECT.sub(_spelled, text)


def _spelled(found: re.Match[str]) -> str:
    c = found.group()
    is_seen = c.isprintable() or unicodedata.category(c) == "Zs"
    return c if is_seen else c.encode("unicode_escape").decode()


def one_line(text: str) -> str:
    """Return the text on one line, with what no terminal should be sent spelled out."""
    return harmless(" ".join(text.split()))


def complain(message: str) -> None:
    """Write one line to standard error; a closed one is not a reason to fail."""
    with contextlib.suppress(OSError, ValueError):
        write(sys.stderr, f"separatrix: {one_line(message)}\n")


def interrupted(what: str) -> int:
    """Say in one line that the work was interrupted, and return the exit status for it."""
    complain(f"interrupted; {what}")
    return INTERRUPTED


class Interruptible:
    """Let Ctrl-C end the work inside, also where the compiler's callbacks swallow it.

    A swallowed interrupt is sent again a little later, unless the work has ended by then; an error that it
    left behind counts as the interrupt.
    """

    def __enter__(self) -> None:
        self._again: list[threading.Timer] = []
        self._usual = sys.unraisablehook
        sys.unraisablehook = self._note

    def _note(self, unraisable: sys.UnraisableHookArgs) -> None:
        if unraisable.exc_type is not KeyboardInterrupt:
            self._usual(unraisable)
            return
        self._again.append(threading.Timer(RETRY, _thread.interrupt_main))
        self._again[-1].start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.unraisablehook = self._usual
        for timer in self._again:
            timer.cancel()
            timer.join()
        if self._again and error is not None:
            raise KeyboardInterrupt from error


def write(stream: TextIO | None, text: str) -> None:
    """Write harmless text to a stream in whatever encoding it has; None (a closed stream) swallows it."""
    if stream is None:
        return
    encoding = stream.encoding or "ascii"
    stream.write(harmless(text).encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def answer(text: str) -> None:
    """Write the answer to standard output; a reader that went away (`| head`) is no error.

    Raises
    ------
    InputError
        The output cannot be written, for instance to a full disk.
    """
    try:
        write(sys.stdout, text)
    except BrokenPipeError:
        _discard_standard_output()
    except OSError as error:
        _discard_standard_output()
        raise InputError("Standard output", f"cannot be written ({error.strerror or error})") from error


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
    from rich.markup import escape
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(escape(harmless(title)), total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
