"""The jobs of the page: one queue for all its tabs, and the process that computes them one after another."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.util import find_spec
from itertools import count
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from separatrix.front.console import LOOK, LeftBehind, Pace, breakable, compiled_once
from separatrix.front.page.folder import LOG, REPORT, Folder
from separatrix.ground.errors import InputError, SeparatrixError, json_text
from separatrix.ground.files import reading_only_in, staged

if TYPE_CHECKING:
    from separatrix.ground.plain_data import Document
    from separatrix.verbs import Computed
    from separatrix.verbs.verb import Verb
    from separatrix.verdict.long_jobs import Progress

WAITING, RUNNING = "waiting", "running"
MOST_WAITING, MOST_KEPT = 20, 50
_AT_THE_END = 10.0
"""Time that the process has to write what it finished when the page is closed [s]."""

INTERRUPTED = "cancelled", "Finished runs are kept: resume to go on."
LOST = f"The computing process ended; the terminal of `separatrix app` may show why. {INTERRUPTED[1]}"

Send = Callable[..., None]
"""Sends the page what has changed of a job, by the names of its fields."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """A question to a study or log of this name, and how far it is; times are those of `time.monotonic`."""

    number: int
    verb: str
    name: str
    question: Mapping[str, object] = field(default_factory=dict)  # options, with the model of the cage
    state: str = WAITING
    share: float | None = None  # of the work that is done; None before that is known
    left: float | None = None  # time that the rest takes [s]; None before a tenth is done
    is_cancelling: bool = False
    message: str = ""
    started: float | None = None
    ended: float | None = None

    @property
    def is_active(self) -> bool:
        """Whether it waits or runs."""
        return self.state in (WAITING, RUNNING)

    @property
    def seconds(self) -> float:
        """Time since it was started; until its end if it has ended."""
        return 0.0 if self.started is None else (self.ended or time.monotonic()) - self.started


class Jobs:
    """The queue and its process, which is started with the first job and again if it was killed."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self._lock, self._jobs, self._numbers = threading.Lock(), dict[int, Job](), count(1)
        self._waiting = SimpleQueue[int | None]()
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._thread = threading.Thread(target=self._hand_over, daemon=True)
        self._thread.start()

    def ask(self, verb: str, name: str, question: Mapping[str, object] | None = None) -> Job:
        """Put a question into the queue unless the same one is active already; refused if too many wait."""
        with self._lock:
            job = Job(number=next(self._numbers), verb=verb, name=name, question=dict(question or {}))
            active = [one for one in self._jobs.values() if one.is_active]
            for one in active:
                if (one.verb, one.name, one.question) == (verb, name, job.question):
                    return one
            if len(active) >= MOST_WAITING:
                raise InputError("The queue", f"has {MOST_WAITING} jobs", cure="Wait, or cancel some.")
            for one in [one for one in self._jobs.values() if not one.is_active][:-MOST_KEPT]:
                del self._jobs[one.number]
            self._jobs[job.number] = job
            self._waiting.put(job.number)
            return job

    def all(self) -> list[Job]:
        """Return the jobs, the newest first."""
        with self._lock:
            return [*reversed(self._jobs.values())]

    def cancel(self, number: int) -> None:
        """End a job: one that runs keeps what it finished."""
        with self._lock:
            job = self._jobs.get(number)
            if job is not None and job.state == WAITING:
                self._change(number, state="cancelled", message="Cancelled before it began.")
            elif job is not None and job.state == RUNNING and self._pipe is not None:
                self._change(number, message="Cancelling.", is_cancelling=True)
                with contextlib.suppress(OSError):  # its process has just ended
                    self._pipe.send(number)

    def resume(self, number: int) -> None:
        """Ask a question again: it goes on with the runs that are kept."""
        job = next((one for one in self.all() if one.number == number), None)
        if job is None:
            raise InputError("The job", "is no longer listed", cure="Run the verb again: it resumes too.")
        self.ask(job.verb, job.name, job.question)

    def close(self) -> None:
        """End the process; the job in hand writes what it finished."""
        for job in self.all():
            self.cancel(job.number)
        self._waiting.put(None)
        self._thread.join(_AT_THE_END)
        if self._process is not None:
            self._process.terminate()

    def _hand_over(self) -> None:
        """Hand one job after another to the process, and follow it to its end."""
        while (number := self._waiting.get()) is not None:
            try:
                with self._lock:
                    job = self._jobs.get(number)
                    if job is None or job.state != WAITING:  # cancelled
                        continue
                    job = self._change(number, state=RUNNING, started=time.monotonic())
                    pipe = self._pipe_of_process()
                    pipe.send(job)
                while job.is_active:
                    changes = pipe.recv()
                    with self._lock:
                        job = self._change(number, **changes)
            except (EOFError, OSError):
                with self._lock:
                    is_left = self._jobs[number].is_cancelling  # it ended with work that was left behind
                    state, message = INTERRUPTED if is_left else ("failed", LOST)
                    self._change(number, state=state, message=message)
                    self._process = None

    def _pipe_of_process(self) -> Connection:
        """Return the pipe to the process, which is started if there is none."""
        if self._pipe is None or self._process is None or not self._process.is_alive():
            context = multiprocessing.get_context("spawn")
            self._pipe, theirs = context.Pipe()
            self._process = context.Process(target=work, args=(theirs, self.root), daemon=True)
            self._process.start()
            theirs.close()
        return self._pipe

    def _change(self, number: int, **new: Any) -> Job:
        job = replace(self._jobs[number], **new)
        self._jobs[number] = job = job if job.is_active else replace(job, ended=time.monotonic())
        return job


# ---- the process, whose kernels stay loaded


def reporting(send: Send) -> Progress:
    """Return what reports how far a long job is: the share that is done, and the time left."""
    pace = Pace()

    def progress(done: float, total: float) -> None:
        pace(done, total)
        send(share=pace.share or None, left=pace.left)

    return progress


def work(pipe: Connection, root: Path) -> None:
    """Compute jobs from a pipe until it ends; the body of the process.

    The number of a job cancels it as Ctrl-C would, also before it began: what was finished is kept and
    answered. Work that it leaves behind ends with the process. A fault of ours ends the process with its
    place in the terminal. The page begins another one.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of the terminal: the page hears it, and ends the pipe
    with contextlib.suppress(EOFError, OSError):
        while True:
            job = pipe.recv()
            if isinstance(job, Job):  # not a cancel of one that has ended
                state, message = _ended(job, Folder(root=root), pipe)
                pipe.send({"state": state, "message": message})


def _ended(job: Job, folder: Folder, pipe: Connection) -> tuple[str, str]:
    """Compute a job, and return how it ended, and a message."""

    def wait(found: Future[Any]) -> None:
        while not found.done():
            try:
                is_cancelled = pipe.poll(LOOK) and pipe.recv() == job.number
            except (EOFError, OSError):  # the page is gone
                is_cancelled = True
            if is_cancelled:
                raise KeyboardInterrupt

    def send(**changes: object) -> None:
        with contextlib.suppress(OSError):
            pipe.send(changes)

    from separatrix.ground.compiling import COMPILING

    COMPILING.heard[:] = [lambda: send(message=f"The solver is {compiled_once()}")]
    try:
        ended: tuple[str, str] = breakable(partial(answered, job, folder, send), wait)
        return ended
    except LeftBehind:
        os._exit(0)
    except KeyboardInterrupt:
        return "cancelled", "Cancelled before anything was finished."
    except SeparatrixError as error:
        return "refused", str(error)


def answered(job: Job, folder: Folder, send: Send) -> tuple[str, str]:
    """Compute and write one answer, or a report with what it lacks; return how it ended, and a message."""
    from separatrix.verbs import asked_study, computed, verb_named
    from separatrix.verbs.answer_files import document, save_answer
    from separatrix.verbs.report import report_of_study

    source = folder.log(job.name) if job.verb == LOG else folder.study(job.name)
    place, question = folder.answers(job.name, job.verb), dict(job.question)
    with reading_only_in(folder.root):
        for path in (place, *(place.iterdir() if place.is_dir() else ())):
            folder.refuse_link_out(path)
        place.mkdir(parents=True, exist_ok=True)
        if job.verb == LOG:
            return _reduced(source, place, question, send)
        verb, model = verb_named("check" if job.verb == REPORT else job.verb), question.pop("model", None)
        study = asked_study(verb, source, str(model) if model else None)
        begin = partial(send, left=None)

        def compute(verb: Verb, options: Any = None) -> Computed:
            return computed(verb, study, options, folder=place, progress=reporting(send))

        def part(verb: Verb) -> Document:
            begin(message=f"Computing {verb.name} for the report.")
            return document(verb, compute(verb))

        if job.verb == REPORT:
            report = report_of_study(study, part, place, pictures=True)
            if report is None:
                return INTERRUPTED
            begin(message="Writing the report.")
            report.write(place, with_pdf=find_spec("typst") is not None)
            return "finished", ""
        found = compute(verb, verb.options(**question))
        begin(message="Drawing the figures and writing the files.")
        save_answer(place, verb, document(verb, found))
        taken = f"{found.runs_taken} runs were taken from an earlier job." if found.runs_taken else ""
        return ("finished", taken) if found.is_complete else INTERRUPTED


def _reduced(log: Path, place: Path, question: Mapping[str, Any], send: Send) -> tuple[str, str]:
    """Reduce a log and write its answer; one that leaves questions open gets a draft of its column map."""
    from separatrix.friction.logs import UnmappedError
    from separatrix.verbs import processors
    from separatrix.verbs.tribometer import Options, document, reduced

    try:
        found = reduced(Options(files=(log,), **question), processors(), reporting(send))
    except UnmappedError as error:
        cure = "Answer the questions in the draft of the column map, on the page of this log."
        raise error.with_draft_written().at(error.path, cure=cure) from None
    with staged(place) as stage:
        (stage / f"{LOG}.json").write_text(json_text(document(found)) + "\n", encoding="utf-8")
    return "finished", ""
