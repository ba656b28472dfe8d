"""The process that computes for the page: one question after another, so that its kernels stay loaded."""

from __future__ import annotations

import _thread
import os
import signal
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from importlib.util import find_spec
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from separatrix.front.console import LeftBehind, Pace, breakable
from separatrix.ground.errors import InputError, SeparatrixError
from separatrix.ground.units import shown

if TYPE_CHECKING:
    from separatrix.study.study import Study

REPORT = "report"
"""In the place of a verb: the report of a study."""

LOG = "tribometer"
"""The verb whose question is to a log, not to a study."""

END = "end"
"""What the page sends when it is closed."""

INTERRUPTED = ("cancelled", "The answer has what was finished. Resume to go on.")

EVERY = 0.2
"""Least time between two reports of progress [s]."""


Send = Callable[..., None]
"""Sends the page what has changed of a job, by the names of `separatrix.front.page.jobs.Job`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A question: verb, study or log, folder of the answer, options of the verb with the models of motion."""

    number: int
    verb: str
    study: Path
    folder: Path
    root: Path
    question: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Cancel:
    """A cancel of one job, which has begun or not, and of no other."""

    number: int


class Reporter(Pace):
    """Reports how far a long job is."""

    def __init__(self, send: Send) -> None:
        super().__init__()
        self.send, self._last = send, 0.0

    def __call__(self, done: float, total: float) -> None:
        """Report the share that is done and the time left, now and then and at the end."""
        super().__call__(done, total)
        now = time.monotonic()
        if done == total or now - self._last > EVERY:
            self._last = now
            self.send(share=self.share or None, left=self.left)


def work(pipe: Connection) -> None:
    """Compute tasks from a pipe until it ends; the body of the process.

    A cancel interrupts its own task as Ctrl-C would, also before it began: what was finished is kept and
    answered. Work that it leaves behind ends with the process. A fault of ours ends the process with its
    place in the terminal. The page begins another one.
    """
    waiting: SimpleQueue[Task | None] = SimpleQueue()
    in_hand: list[int] = []
    cancelled: set[int] = set()
    is_ended, main = threading.Event(), threading.get_ident()

    def break_in(number: int) -> None:
        if number in in_hand:  # a true signal, where there is one: it ends a wait, too
            getattr(signal, "pthread_kill", lambda *_: _thread.interrupt_main())(main, signal.SIGINT)

    def refuse_cancelled(*_: object) -> None:
        for number in in_hand:
            if is_ended.is_set() or number in cancelled:
                cancelled.discard(number)
                raise KeyboardInterrupt

    signal.signal(signal.SIGINT, refuse_cancelled)

    def listen() -> None:
        while True:
            try:
                message = pipe.recv()
            except (EOFError, OSError):  # the page is gone
                message = END
            if isinstance(message, Task):
                waiting.put(message)
                continue
            if isinstance(message, Cancel):
                cancelled.add(message.number)
                break_in(message.number)
                continue
            is_ended.set()
            for number in in_hand:
                break_in(number)
            waiting.put(None)
            return

    threading.Thread(target=listen, daemon=True).start()

    def send(number: int, **changes: object) -> None:
        try:
            pipe.send((number, changes))
        except OSError:  # the page is gone; the task ends by itself
            in_hand.clear()

    while True:
        task = waiting.get()
        if task is None:
            return
        _compute(task, in_hand, refuse_cancelled, partial(send, task.number))


def _compute(task: Task, in_hand: list[int], refuse_cancelled: Callable[[], None], send: Send) -> None:
    try:
        in_hand.append(task.number)
        refuse_cancelled()  # one that was cancelled before it began
        send(state="running")
        state, message = breakable(partial(_answered, task, send))
    except LeftBehind:
        os._exit(0)
    except KeyboardInterrupt:
        state, message = "cancelled", "Cancelled before anything was finished."
    except SeparatrixError as error:
        problems = error.problems if isinstance(error, InputError) and error.problems else (error,)
        state, message = "refused", "\n".join(str(one) for one in problems)
    finally:
        in_hand.clear()  # nothing interrupts the end
    send(state=state, message=message)


def _answered(task: Task, send: Send) -> tuple[str, str]:
    """Compute and write one answer, or a report; return how it ended, and a message."""
    from separatrix.ground.files import reading_only_in
    from separatrix.study.reading import read_study
    from separatrix.verbs import asked_study, computed, verb_named
    from separatrix.verbs.answer_files import document, save_answer

    question = dict(task.question)
    models = {name: str(question.pop(name)) for name in ("motion", "ball") if question.get(name)}
    with reading_only_in(task.root):
        _refuse_links_out(task)
        task.folder.mkdir(parents=True, exist_ok=True)
        if task.verb == LOG:
            return _reduced(task, send)
        if task.verb == REPORT:
            return _reported(task, read_study(task.study), send)
        verb = verb_named(task.verb)
        study, options = asked_study(verb, task.study, models), verb.options(**question)
        found = computed(verb, study, options, folder=task.folder, progress=Reporter(send))
        send(message="Drawing the figures and writing the files.")
        save_answer(task.folder, verb, document(verb, found), options=options)
        if not found.is_complete:
            return INTERRUPTED
        taken = f"{found.runs_taken} runs were taken from an earlier job." if found.runs_taken else ""
        return "finished", taken


def _refuse_links_out(task: Task) -> None:
    """Refuse to write where a link leads out of the folder of the page."""
    from separatrix.ground.files import is_inside

    for path in (task.folder, *(task.folder.iterdir() if task.folder.is_dir() else ())):
        if not is_inside(path, task.root):
            rule = "leads out of the folder of the studies"
            raise InputError(shown(path.name), rule, cure="Remove this link.")


def _reported(task: Task, study: Study, send: Send) -> tuple[str, str]:
    """Write the report of a study; answers that it lacks are computed first, as the command does."""
    from separatrix.verbs import computed, verb_named
    from separatrix.verbs.answer_files import document, save_answer
    from separatrix.verbs.report import add_missing, is_answer_to, report_of, wanted
    from separatrix.verbs.saved_answers import read_answer

    def compute(name: str) -> dict[str, Any]:
        send(message=f"Computing {name} for the report.")
        verb = verb_named(name)
        made = document(verb, computed(verb, study, folder=task.folder, progress=Reporter(send)))
        save_answer(task.folder, verb, made)
        return made

    kept = {one: task.folder / f"{one}.json" for one in wanted(study)}
    known = {one: read_answer(path) for one, path in kept.items() if path.exists()}
    found = {one: answer for one, answer in known.items() if is_answer_to(answer, study)}
    missing = add_missing(found, list(kept), compute)
    if any(answer.get("complete") is False for answer in found.values()):
        return INTERRUPTED
    send(message="Writing the report.")
    report_of(found, missing).write(task.folder, with_pdf=find_spec("typst") is not None)
    return "finished", ""


def _reduced(task: Task, send: Send) -> tuple[str, str]:
    """Reduce a log and write its answer; one that leaves questions open gets a draft of its column map."""
    from separatrix.friction.logs import UnmappedError
    from separatrix.ground.errors import json_text
    from separatrix.ground.files import staged
    from separatrix.verbs import processors, tool_named

    tool = tool_named(LOG)
    try:
        found = tool.compute(tool.options(files=(task.study,), **task.question), processors(), Reporter(send))
    except UnmappedError as error:
        if not error.place.exists():
            error.place.write_text(error.draft, encoding="utf-8", newline="\n")
        cure = "Answer the questions in the draft of the column map, on the page of this log."
        raise error.at(error.path, cure=cure) from None
    with staged(task.folder) as stage:
        (stage / f"{LOG}.json").write_text(json_text(found) + "\n", encoding="utf-8")
    return "finished", ""
