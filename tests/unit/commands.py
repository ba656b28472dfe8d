"""What many tests call: the command line, tables of mistakes, the refusal of a file, what a job has kept."""

from __future__ import annotations

import json
import pickle
import sqlite3
import sys
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from separatrix.app.worker import work
from separatrix.cli import main
from separatrix.ground.errors import InputError
from separatrix.verdict.ledger import NAME

COMMAND = [sys.executable, "-m", "separatrix"]
"""The real command, as a process is started with."""


def work_undrawn(pipe: Connection) -> None:
    """Compute for the page as `separatrix.app.worker.work` does, but leave pictures out."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("separatrix.figures.save_all", lambda *_: None)
        work(pipe)


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


def table(text: str) -> list:
    """Return the cases of a table: what is wrong, and the words of its refusal between semicolons."""
    rows = (row.partition(" :: ") for row in text.strip().replace("\n    ::", " ::").splitlines())
    return [
        pytest.param(wrong.replace(r"\n", "\n"), words.split(" ; "), id=f"{number} {wrong[:50]}")
        for number, (wrong, _, words) in enumerate(rows)
    ]


def refusal(words: list[str], read: Callable, *arguments: object, lines: int = 1, **more: object) -> str:
    """Return the refusal of an input, which has these words on so many short lines (0: any)."""
    with pytest.raises(InputError) as caught:
        read(*arguments, **more)
    text = str(caught.value)
    assert [word for word in words if word not in text] == [], text
    assert [line for line in text.split("\n") if not line.isprintable() or len(line) >= 400] == []
    assert lines in (0, text.count("\n") + 1), text
    assert str(pickle.loads(pickle.dumps(caught.value))) == text  # noqa: S301 - our own bytes
    return text


def pieces(folder: Path) -> int:
    """Return how many pieces are in the ledger of a folder that another process may write."""
    try:
        with sqlite3.connect(f"file:{folder / NAME}?mode=ro", uri=True) as connection:
            return int(connection.execute("SELECT count(*) FROM piece").fetchone()[0])
    except sqlite3.OperationalError:
        return 0
