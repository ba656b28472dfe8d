"""What goes to the terminal: standard output that never crashes, one line of error, progress."""

from __future__ import annotations

import _thread
import contextlib
import functools
import math
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, ParamSpec, TextIO

from separatrix.ground.errors import InputError, harmless, json_text, one_line

if TYPE_CHECKING:
    from separatrix.ground.units import Second

Given = ParamSpec("Given")

INTERRUPTED = 130
"""Exit status after Ctrl-C."""

LINE_EVERY: Second = 20.0
"""Time between two lines where standard error is not a terminal."""

WORTH_PRINTING: Second = 5.0
"""A shorter work does not tell its time."""

LOADING: Second = 1.0
"""Time from the beginning in which steps are taken from an earlier call."""

FIRST_PART = 0.05
"""Share of the steps after which the time of all is estimated."""

COMPILATION = "about a minute"
"""What compiling all that a ranking needs takes."""

RETRY = 0.02
"""Time after which a swallowed interrupt is sent again [s]."""


def complain(message: str) -> None:
    """Write one line to standard error; a closed one is not a reason to fail."""
    with contextlib.suppress(OSError, ValueError):
        write(sys.stderr, f"separatrix: {one_line(message)}\n")


def interrupted(what: str) -> int:
    """Report in one line that the work was interrupted, and return the exit status for it."""
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


def interruptible(ended: str) -> Callable[[Callable[Given, int]], Callable[Given, int]]:
    """Let an interrupt end a command with one line, `ended`: typer would swallow the interrupt."""

    def decorate(command: Callable[Given, int]) -> Callable[Given, int]:
        @functools.wraps(command)
        def decorated(*args: Given.args, **options: Given.kwargs) -> int:
            try:
                with Interruptible():
                    return command(*args, **options)
            except KeyboardInterrupt:
                return interrupted(ended)

        return decorated

    return decorate


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


class Life:
    """How far a verb is; called with (done, total) by the work. Its title is verb and study."""

    def __init__(self, title: str, *, quiet: bool = False) -> None:
        self.title, self.begun, self.quiet = title, time.monotonic(), quiet
        self.done = self.total = 0
        self.first = self.begun, 0  # when the work began in earnest, and what was done then
        self.told = self.compiled = quiet  # which prints nothing, as `--quiet` requires

    def __call__(self, done: int, total: int) -> None:
        """Take in how far the work is; its first part tells what all of it takes."""
        now = time.monotonic()
        if now - self.begun < LOADING or not self.total:  # what an earlier call kept comes at once
            self.first = now, done
        self.done, self.total = done, total
        share = (done - self.first[1]) / max(total - self.first[1], 1)
        if not self.told and now - self.begun > WORTH_PRINTING and FIRST_PART <= share < 1.0:
            self.told = True
            whole = self.first[0] - self.begun + (now - self.first[0]) / share
            complain(f"{self.title} takes about {in_words(whole)}.")

    def compiling(self) -> None:
        """Say once that kernels are compiled, which the next command finds done."""
        if not self.compiled:
            self.compiled = True
            complain(f"{self.title}: compiling once on this machine, {COMPILATION} in all.")

    def line(self) -> str:
        """Return how far the work is after which time."""
        passed = time.monotonic() - self.begun
        if not 0 < self.done <= self.total:
            return f"{self.title}: at work for {in_words(passed)}"
        share = math.floor(100.0 * self.done / self.total)
        steps = f"{self.done} of {self.total} steps ({share} %) after {in_words(passed)}"
        begun, before = self.first
        if self.done == before:
            return f"{self.title}: {steps}"
        left = (time.monotonic() - begun) * (self.total - self.done) / (self.done - before)
        return f"{self.title}: {steps}, about {in_words(left)} left"


@contextlib.contextmanager
def progress_bar(title: str, *, quiet: bool) -> Iterator[Life]:
    """Yield what shows how far the work is: on a terminal a bar that disappears at the end, else lines."""
    if quiet or sys.stderr is None:
        yield Life(title, quiet=True)
        return
    if not sys.stderr.isatty():
        with _lines(title) as life, _telling_of_compilation(life):
            yield life
        return
    from rich.console import Console
    from rich.markup import escape
    from rich.progress import Progress

    class Drawn(Life):
        def __call__(self, done: int, total: int) -> None:
            super().__call__(done, total)
            bar.update(task, completed=done, total=total)

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(escape(harmless(title)), total=None)
        with _telling_of_compilation(drawn := Drawn(title)):
            yield drawn


@contextlib.contextmanager
def _telling_of_compilation(life: Life) -> Iterator[None]:
    from separatrix.ground.compiling import COMPILING

    COMPILING.heard.append(life.compiling)
    try:
        yield
    finally:
        COMPILING.heard.remove(life.compiling)


@contextlib.contextmanager
def _lines(title: str) -> Iterator[Life]:
    """Print a line now and then, from a separate thread: the work may report nothing for long."""
    life, over = Life(title), threading.Event()

    def speak() -> None:
        while not over.wait(LINE_EVERY):
            complain(life.line())

    speaker = threading.Thread(target=speak, daemon=True)
    speaker.start()
    try:
        yield life
    finally:
        over.set()
        speaker.join()


def in_words(seconds: Second) -> str:
    """Return a time in a unit that suits it: 40 s, 3 min, 1.5 h."""
    if seconds < 99.5:
        return f"{float(f'{seconds:.2g}'):g} s"
    minutes = float(f"{seconds / 60.0:.2g}")
    return f"{minutes:g} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"
