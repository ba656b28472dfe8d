"""The command line as the tests call it: its document, its refusal in one line, what a job has kept."""

import json
import pickle
import re
import sqlite3
import sys
import time
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
import pytest

from separatrix import InputError, Study, read_study
from separatrix.friction.friction_file import FrictionFile, FrictionTest
from separatrix.friction.logs.column_map import ColumnMap
from separatrix.front import main
from separatrix.front.page.worker import work
from separatrix.ground import toml
from separatrix.ground.reader import Document, read_document, read_text
from separatrix.verdict.long_jobs import NAME

COMMAND = [sys.executable, "-m", "separatrix"]
"""The real command, as a process is started with."""

SMALL = """
extends = "cryogenic-turbopump"
title = "A small ensemble"
[cage]
ball_cage_friction = 0.1
[stability]
kicks = ["0.5 m/s"]
runs = 4
duration = "4 ms"
restitution_factors = [0.3, 0.6, 0.9]
[ranking]
friction = "pin-on-disk-77K"
materials = ["Armalon", "Meldin HTC 100"]
"""
"""A study with an ensemble of no weight."""


def work_undrawn(pipe: Connection, root: Path) -> None:
    """Compute for the page as `separatrix.front.page.worker.work` does, but leave pictures out."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("separatrix.present.html.write_drawn", lambda *_: None)
        work(pipe, root)


def document(capsys, *arguments: str, status: int = 0) -> dict:
    """Return the document of a command, which has no NaN in it."""
    assert main([*arguments, "--json"]) == status
    return json.loads(capsys.readouterr().out, parse_constant=pytest.fail)


def refused(capsys, *arguments: str) -> str:
    """Return the line with which a command is refused; nothing is written."""
    before = sorted(Path().iterdir())
    assert main(list(arguments)) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n"), len(err) < 600, sorted(Path().iterdir())) == ("", 1, True, before), err
    return err


def written(folder: Path, text: str | bytes, name: str = "study.toml") -> Path:
    """Return the path of a file with this content."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def extended(folder: Path, text: str, base: str = "cryogenic-turbopump") -> Study:
    """Return a shipped study with this text over it."""
    return read_study(written(folder, f'extends = "{base}"\n{text}', "case.toml"))


def message_of(error: InputError) -> str:
    """Return the text of a refusal: a short printable line a mistake, the same from another process."""
    message = str(error)
    assert all(one.path and one.rule for one in error.problems or (error,)), message
    assert all(line.isprintable() and len(line) < 420 for line in message.split("\n")), message
    assert str(pickle.loads(pickle.dumps(error))) == message  # noqa: S301 - our own bytes
    return message


def refusal(path: str | Path, read=read_study) -> str:
    """Return the text with which a file is refused."""
    with pytest.raises(InputError) as caught:
        read(path)
    return message_of(caught.value)


def refusal_line(path: str | Path, read=read_study) -> str:
    """Return the one line of a refusal."""
    message = refusal(path, read)
    assert "\n" not in message
    return message


def log(path: Path, friction: float = 0.1, seed: int = 1, rows: int = 1500) -> None:
    """Write a log in CSV: running-in from 0.2, then noise about a friction."""
    time, rng = 0.5 * np.arange(rows), np.random.default_rng(seed)
    values = friction + (0.2 - friction) * np.exp(-time / 40.0) + 0.004 * rng.standard_normal(rows)
    lines = (f"{t:.2f},{f:.5f},20.0" for t, f in zip(time, values, strict=True))
    path.write_text("time (s),friction coefficient,normal force (N)\n" + "\n".join(lines) + "\n")


def column_map(document: dict, source: str = "column map") -> ColumnMap:
    """Return the column map of a parsed TOML document."""
    made = read_document(ColumnMap, Document(source, document, {})).value
    return replace(made, source=source, as_written=document)


def read_friction(path: Path) -> tuple[FrictionTest, ...]:
    """Return the tests of a friction file."""
    text = toml.read_text(path, FrictionFile.FILE)
    return read_text(FrictionFile, text, path.name).value.test


def rows_of(table: str) -> list[tuple[str, list[str]]]:
    r"""Return of each ``change :: words :: words`` of a table the change and the words of its refusal.

    A row goes on behind an indent; ``\n`` in a change is a new line.
    """
    rows = [line.split(" :: ") for line in re.sub(r"\n +", " ", table.strip()).splitlines()]
    return [(change.replace(r"\n", "\n"), words) for change, *words in rows]


def changed(base: str, change: str) -> str:
    """Return a text with one change: ``old => new``, ``+ added behind``, ``^ added before``."""
    if change[0] in "+^":
        more = change[1:].removeprefix(" ") + "\n"
        return base + more if change[0] == "+" else more + base
    old, _, new = change.partition(" =>")
    assert old in base
    return base.replace(old, new.removeprefix(" "), 1)


PATIENCE = 600.0
"""For what takes seconds where the machine is idle: one that hangs fails, a busy machine does not [s]."""


def wait_until(happened, seconds: float = PATIENCE) -> None:
    """Wait for something to happen."""
    end = time.monotonic() + seconds
    while not happened():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)


def root_of(page) -> Path:
    """Return the folder of a page."""
    return page.app.state.root


def pieces(folder: Path) -> int:
    """Return how many pieces are in the ledger of a folder that another process may write."""
    try:
        with sqlite3.connect(f"file:{folder / NAME}?mode=ro", uri=True) as connection:
            return int(connection.execute("SELECT count(*) FROM piece").fetchone()[0])
    except sqlite3.OperationalError:
        return 0
