"""What goes to the terminal: standard output that never crashes, one line of error, progress."""

from __future__ import annotations

import contextlib
import contextvars
import ctypes
import math
import os
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from traceback import walk_stack
from types import FrameType
from typing import TYPE_CHECKING, TextIO, TypeVar

import click

from separatrix.front import INTERRUPTED
from separatrix.ground.errors import InputError, harmless, json_text, one_line

if TYPE_CHECKING:
    from separatrix.ground.units import Second

Answer = TypeVar("Answer")

LINE_EVERY: Second = 20.0
"""Time between two lines where standard error is not a terminal."""

REDRAWN_EVERY: Second = 0.2
"""Time between two writings of the line where it is one."""

FIRST_PART = 0.1
"""Share of the work after which the time of all is estimated."""

ENOUGH: Second = 10.0
"""Time within which nothing is estimated: what is over by then needs no estimate."""

TOO_LONG: Second = 60.0
"""Time after which even a rough estimate, from less work than that, is better than none."""

PATIENCE: Second = 1.6
"""Time that an interrupt waits for the work to end by itself, with what was finished."""

LOOK: Second = 0.05
"""Time between two looks at whether it has ended."""


def complain(message: str) -> None:
    """Write one line to standard error; a closed one is not a reason to fail."""
    with contextlib.suppress(OSError, ValueError):
        write(sys.stderr, f"separatrix: {one_line(message)}\n")


def interrupted(what: str) -> int:
    """Report in one line that the work was interrupted, and return the exit status for it."""
    complain(f"interrupted; {what}")
    return INTERRUPTED


class LeftBehind(KeyboardInterrupt):
    """An interrupt that the work did not follow in time: its thread still runs."""


def breakable(
    work: Callable[[], Answer], wait: Callable[[Future[Answer]], object] = lambda found: found.result()
) -> Answer:
    """Result of work in another thread, so that an interrupt ends it inside a kernel or the compiler, too.

    Ctrl-C or SIGTERM ends a long job at its next look, and raises KeyboardInterrupt in other work; a module
    that is being imported is waited for. What does not end within `PATIENCE`, or before a second interrupt,
    is left behind: the process must end, by `os._exit`.
    """
    if threading.current_thread() is not threading.main_thread():
        return work()
    found: Future[Answer] = Future()

    def do() -> None:
        try:
            found.set_result(work())
        except BaseException as error:  # noqa: BLE001 - raised again where the result is taken
            found.set_exception(error)

    thread = threading.Thread(target=contextvars.copy_context().run, args=(do,), daemon=True)
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        thread.start()
        try:
            wait(found)
        except KeyboardInterrupt:
            if thread.is_alive():
                _end(thread)
        if not found.done():
            raise LeftBehind
        return found.result()
    except KeyboardInterrupt:
        if thread.is_alive():
            raise LeftBehind from None
        raise
    finally:
        signal.signal(signal.SIGTERM, before or signal.SIG_DFL)


def _end(thread: threading.Thread) -> None:
    """End the work of a thread, or wait in vain."""
    from separatrix.verdict.long_jobs import AT_WORK

    until, is_told = time.monotonic() + PATIENCE, False
    while thread.is_alive() and time.monotonic() < until:
        if not is_told and not is_importing(sys._current_frames().get(thread.ident or 0)):
            is_told = True
            for stop in AT_WORK:
                stop.set()
            if not AT_WORK:
                raised = ctypes.py_object(KeyboardInterrupt)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident or 0), raised)
        thread.join(LOOK)


def is_importing(frame: FrameType | None) -> bool:
    """Whether a module is being imported at a place in the program, or in what called it."""
    frames = () if frame is None else (one for one, _ in walk_stack(frame))
    return any(one.f_code.co_filename.startswith("<frozen importlib") for one in frames)


@contextlib.contextmanager
def interruptible(ended: str) -> Iterator[None]:
    """Let an interrupt end a command with one line, `ended`: click would swallow the interrupt."""
    try:
        yield
    except KeyboardInterrupt:
        raise click.exceptions.Exit(interrupted(ended)) from None


def write(stream: TextIO | None, text: str) -> None:
    """Write harmless text to a stream in whatever encoding it has; None (a closed stream) swallows it."""
    if stream is None:
        return
    encoding = stream.encoding or "ascii"
    stream.write(harmless(text).encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def answer(text: str) -> None:
    """Write the answer to standard output; a reader that went away (`| head`) is no error, a full disk is."""
    try:
        write(sys.stdout, text)
    except OSError as error:
        with contextlib.suppress(OSError, ValueError):  # else the interpreter's last flush would complain
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            raise InputError("Standard output", f"cannot be written ({error.strerror or error})") from error


def answer_json(document: dict[str, object]) -> None:
    """Write a document to standard output."""
    answer(json_text(document) + "\n")


class Pace:
    """Share done and time left of a work; called with (done, total) by the work. Compiling is not work.

    The share is done / total while the total stays. Work that is found later, or expected no more, changes
    how much of the rest the next step is, not what was done: the share never falls.
    """

    def __init__(self) -> None:
        self.share = self._done = 0.0
        self.left: Second | None = None
        self._begun: Second | None = None

    def __call__(self, done: float, total: float) -> None:
        """Take in how far the work is; the first call, with nothing done, is its beginning."""
        from separatrix.ground.compiling import COMPILING

        now = COMPILING.clock()
        if self._begun is None:
            self._begun = now
        made, rest = max(done - self._done, 0.0), total - done
        if not 0.0 < total < math.inf:
            return
        self._done = max(done, self._done)
        self.share = 1.0 - (1.0 - self.share) * (rest / (made + rest) if rest > 0.0 else 0.0)
        spent = now - self._begun
        if done > 0.0 and spent > (ENOUGH if done >= FIRST_PART * total else TOO_LONG):
            self.left = spent * rest / done


def compiled_once() -> str:
    """Return that, and why, in words that go on."""
    from separatrix.ground.compiling import COMPILING

    why = f": {COMPILING.reason}" if COMPILING.reason else ""
    return f"compiled once on this machine, about a minute in all{why}."


class Life(Pace):
    """How far a verb is, in words. Its title is verb and study."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title, self.started, self.compiled = title, time.monotonic(), False

    def compiling(self) -> None:
        """Say once that kernels are compiled, which the next command finds done."""
        if not self.compiled:
            self.compiled = True
            complain(f"{self.title}: the solver is {compiled_once()}")

    def line(self) -> str:
        """Return how far the work is after which time."""
        passed = in_words(time.monotonic() - self.started)
        left = "" if self.left is None else f", about {in_words(self.left)} left"
        done = f"{math.floor(100.0 * self.share)} % after" if self.share else "at work for"
        return f"{self.title}: {done} {passed}{left}"


@contextlib.contextmanager
def progress_bar(title: str, *, quiet: bool) -> Iterator[Life]:
    """Yield what shows how far the work is, by the clock: the work may report nothing for long.

    On a terminal it is one line that is written again and disappears at the end, else a line now and then.
    """
    life, over = Life(title), threading.Event()
    if quiet or sys.stderr is None:
        yield life
        return
    from separatrix.ground.compiling import COMPILING

    is_terminal, width = sys.stderr.isatty(), shutil.get_terminal_size().columns - 1

    def show(text: str) -> None:
        with contextlib.suppress(OSError, ValueError):
            write(sys.stderr, f"\r{text[:width]:<{width}}\r")

    def speak() -> None:
        while not over.wait(REDRAWN_EVERY if is_terminal else LINE_EVERY):
            show(one_line(life.line())) if is_terminal else complain(life.line())

    speaker = threading.Thread(target=speak, daemon=True)
    COMPILING.heard.append(life.compiling)
    speaker.start()
    try:
        yield life
    finally:
        COMPILING.heard.remove(life.compiling)
        over.set()
        speaker.join()
        if is_terminal:
            show("")


def in_words(seconds: Second) -> str:
    """Return a time in a unit that suits it: 40 s, 3 min, 1.5 h."""
    if seconds < 99.5:
        return f"{float(f'{seconds:.2g}'):g} s"
    minutes = float(f"{seconds / 60.0:.2g}")
    return f"{minutes:g} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
