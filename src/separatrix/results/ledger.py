"""The finished points of a map on disk, so that an interrupted one goes on: SQLite, one row a point."""

from __future__ import annotations

import contextlib
import hashlib
import json
import sqlite3
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import separatrix
from separatrix.cage import Verdict
from separatrix.errors import InputError
from separatrix.results.plain import plain, plain_record
from separatrix.stability.map_records import MapPoint, MapQuestion
from separatrix.stability.map_rule import first_look
from separatrix.study import Study

NAME = "map-points.sqlite"
"""The file in the folder of the answers."""

_TABLE = (
    "CREATE TABLE IF NOT EXISTS point "
    "(question TEXT, x REAL, y REAL, answer TEXT, PRIMARY KEY (question, x, y)) WITHOUT ROWID"
)


class Ledger:
    """Points of one question in a file that may hold those of others too.

    Points are found by their values, not by their place in a grid: a finer grid goes on from a coarser one.

    Parameters
    ----------
    path : Path
        The file; it is made with the first point that is kept.
    question : MapQuestion
        Its study, parameters, kick and runs, and the program itself, are the key.
    """

    def __init__(self, path: Path, question: MapQuestion) -> None:
        self.path, self.key = path, question_key(question)
        self._connection: sqlite3.Connection | None = None

    def points(self) -> dict[tuple[float, float], MapPoint]:
        """Finished points by (x, y); none if there is no file."""
        if not self.path.exists():
            return {}
        with _readable(self.path):
            rows = self._open().execute("SELECT answer FROM point WHERE question = ?", (self.key,)).fetchall()
            points = [_point(json.loads(answer)) for (answer,) in rows]
        return {(point.x, point.y): point for point in points}

    def keep(self, points: Iterable[MapPoint]) -> None:
        """Write points that were run; a refusal costs nothing to find again."""
        rows = [(self.key, p.x, p.y, json.dumps(plain_record(p))) for p in points if p.runs]
        if rows:
            with _readable(self.path), self._open() as connection:
                connection.executemany("INSERT OR REPLACE INTO point VALUES (?, ?, ?, ?)", rows)

    def forget(self) -> None:
        """Remove the points of this question."""
        if self.path.exists():
            with _readable(self.path), self._open() as connection:
                connection.execute("DELETE FROM point WHERE question = ?", (self.key,))

    def close(self) -> None:
        """Close the file."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def _open(self) -> sqlite3.Connection:
        if self._connection is None:
            self._connection = sqlite3.connect(self.path, timeout=30.0)
            self._connection.execute("PRAGMA journal_mode = WAL")
            self._connection.execute("PRAGMA synchronous = NORMAL")
            self._connection.execute(_TABLE)
        return self._connection


@contextlib.contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        yield
    except (sqlite3.Error, ValueError, TypeError, KeyError) as error:
        cure = "Remove it, or name another folder: --out DIR."
        raise InputError(str(path), f"cannot be used to keep points ({error})", cure=cure) from error


def _point(row: dict[str, Any]) -> MapPoint:
    point = MapPoint(**row)
    return replace(point, decision=None if row["decision"] is None else Verdict[row["decision"]])


def question_key(question: MapQuestion) -> str:
    """Checksum of what the points of a map depend on: study, parameters, kick, runs, and the program."""
    asked = {
        "study": _asked(question.study),
        "parameters": [question.x.parameter, question.y.parameter],
        "kick": question.kick,
        "runs": [first_look(question.runs), question.runs],
        "program": [separatrix.__version__, source_checksum(Path(separatrix.__file__).parent)],
    }
    return hashlib.sha256(json.dumps(asked, sort_keys=True).encode()).hexdigest()


def _asked(study: Study) -> dict[str, Any]:
    """Inputs of a study, without names and places in files."""
    values = _without_records(plain(study, "study"))
    return {key: value for key, value in values.items() if key not in ("name", "title", "origins")}


SETTLED = ("record", "records", "law")
"""Keys of what is behind a number: a record of the library, the tests; the number itself stands beside."""


def _without_records(value: Any) -> Any:
    """The same without whole records of the library: their numbers stand in the materials."""
    if isinstance(value, dict):
        return {key: _without_records(v) for key, v in value.items() if key not in SETTLED}
    return [_without_records(item) for item in value] if isinstance(value, list) else value


def source_checksum(package: Path) -> str:
    """Checksum of the sources of the package: other code may give other numbers."""
    sources = (path.read_bytes() for path in sorted(package.rglob("*.py")))
    return hashlib.sha256(b"".join(sources)).hexdigest()
