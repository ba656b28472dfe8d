"""The jobs of the page: one queue for all its tabs, computed by one process, each with its progress."""

from __future__ import annotations

import multiprocessing
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from separatrix.front.page.worker import END, Cancel, Task, work
from separatrix.ground.errors import InputError

WAITING, RUNNING = "waiting", "running"
ACTIVE = (WAITING, RUNNING)
MOST_WAITING, MOST_KEPT = 20, 50
_AT_THE_END = 10.0
"""Time that the process has to write what it finished when the page is closed [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """A question of the page and how far it is; times are those of `time.monotonic`."""

    task: Task
    study: str
    state: str = WAITING
    share: float | None = None  # of the work that is done; None before that is known
    left: float | None = None  # time that the rest takes [s]; None before a tenth is done
    is_cancelling: bool = False
    message: str = ""
    started: float | None = None
    ended: float | None = None

    @property
    def number(self) -> int:
        """Its number."""
        return self.task.number

    @property
    def is_active(self) -> bool:
        """Whether it waits or runs."""
        return self.state in ACTIVE

    @property
    def seconds(self) -> float:
        """Time since it was started; until its end if it has ended."""
        return 0.0 if self.started is None else (self.ended or time.monotonic()) - self.started


class Jobs:
    """The queue and its process, which is started with the first job and again if it was killed."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self._lock, self._last, self._is_closed = threading.Lock(), 0, False
        self._jobs: dict[int, Job] = {}
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None

    def ask(
        self,
        verb: str,
        study: Path,
        folder: Path,
        *,
        name: str,
        question: Mapping[str, object] | None = None,
    ) -> Job:
        """Put a question into the queue unless the same one is active already; refused if too many wait."""
        with self._lock:
            asked = Task(
                number=self._last + 1,
                verb=verb,
                study=study,
                folder=folder,
                root=self.root,
                question=dict(question or {}),
            )
            active = [job for job in self._jobs.values() if job.is_active]
            for job in active:
                if replace(job.task, number=asked.number) == asked:
                    return job
            if len(active) >= MOST_WAITING:
                raise InputError("The queue", f"has {MOST_WAITING} jobs", cure="Wait, or cancel some.")
            self._last += 1
            self._jobs[asked.number] = job = Job(task=asked, study=name)
            ended = [number for number, one in self._jobs.items() if not one.is_active]
            for number in ended[: max(0, len(ended) - MOST_KEPT)]:
                del self._jobs[number]
            self._feed()
            return job

    def all(self) -> list[Job]:
        """Return the jobs, the newest first."""
        with self._lock:
            return sorted(self._jobs.values(), key=lambda job: -job.number)

    def job(self, number: int) -> Job | None:
        """Return a job by its number; None if there is none."""
        with self._lock:
            return self._jobs.get(number)

    def cancel(self, number: int) -> None:
        """End a job: one that runs keeps what it finished."""
        with self._lock:
            job = self._jobs.get(number)
            if job is None or not job.is_active:
                return
            if job.state == WAITING:
                self._change(number, state="cancelled", message="Cancelled before it began.")
            elif self._pipe is not None:
                self._change(number, message="Cancelling.", is_cancelling=True)
                self._pipe.send(Cancel(number))

    def forget_ended(self) -> None:
        """Drop the jobs that have ended from the list; their answers stay."""
        with self._lock:
            self._jobs = {number: job for number, job in self._jobs.items() if job.is_active}

    def close(self) -> None:
        """End the process; the job in hand writes what it finished."""
        with self._lock:
            self._is_closed = True
            process, pipe = self._process, self._pipe
        if process is not None and pipe is not None:
            try:
                pipe.send(END)
            except OSError:  # it has ended already
                return
            process.join(_AT_THE_END)
            process.terminate()

    def _feed(self) -> None:
        """Hand the first waiting job to the process, if none is in hand."""
        if self._is_closed or any(job.state == RUNNING for job in self._jobs.values()):
            return
        first = next((job for job in self._jobs.values() if job.state == WAITING), None)
        if first is None:
            return
        if self._process is None or not self._process.is_alive():
            self._start()
        if self._pipe is not None:
            self._change(first.number, state=RUNNING, started=time.monotonic())
            self._pipe.send(first.task)

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=work, args=(theirs,), name="separatrix worker", daemon=True)
        process.start()
        theirs.close()
        self._process, self._pipe = process, ours
        threading.Thread(target=self._listen, args=(ours,), daemon=True).start()

    def _listen(self, pipe: Connection) -> None:
        while True:
            try:
                number, changes = pipe.recv()
            except (EOFError, OSError):
                with self._lock:
                    self._lost(pipe)
                return
            with self._lock:
                if changes.get("state", RUNNING) not in ACTIVE:
                    changes["ended"] = time.monotonic()
                self._change(number, **changes)
                self._feed()

    def _lost(self, pipe: Connection) -> None:
        """Note that the process has ended in the middle of a job, and go on with the next."""
        if self._pipe is pipe:
            self._process = self._pipe = None
        for job in [job for job in self._jobs.values() if job.state == RUNNING]:
            state, why = (
                "failed",
                "The computing process ended; the terminal of `separatrix app` may show why. ",
            )
            if job.is_cancelling:  # it ended with work that was left behind
                state, why = "cancelled", ""
            words = f"{why}Finished runs are kept: resume to go on."
            self._change(job.number, state=state, message=words, ended=time.monotonic())
        self._feed()

    def _change(self, number: int, **new: Any) -> None:
        if number in self._jobs:
            self._jobs[number] = replace(self._jobs[number], **new)
