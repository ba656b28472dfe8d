"""Finished pieces of a long job in an SQLite file, so that an interrupted job can resume."""

from __future__ import annotations

import hashlib
import sqlite3
import threading
import time
from functools import cache
from pathlib import Path

import separatrix
from separatrix.ground.errors import InputError

NAME = "finished-runs.sqlite"
"""The file in the folder of the answers."""

AT_LEAST_EVERY = 0.25
"""Time after which finished pieces are written [s]."""

_TABLE = "CREATE TABLE IF NOT EXISTS piece (key BLOB PRIMARY KEY, found BLOB) WITHOUT ROWID"


class Ledger:
    """Pieces by their key, a checksum of all that they depend on: many jobs may share a file.

    The file is made when the first piece is written; a file of another kind is refused. A kill loses the
    pieces since the last write, a fraction of a second of work.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.goes_on = path, path.exists()
        self.taken = 0
        """Runs that were read here instead of being computed."""
        self._lock, self._written = threading.Lock(), time.monotonic()
        self._new: dict[bytes, bytes] = {}
        self._connection: sqlite3.Connection | None = None
        if self.goes_on:
            self._execute("SELECT 1 FROM piece LIMIT 1")

    def get(self, key: bytes) -> bytes | None:
        """Return the piece of a key; None if there is none."""
        with self._lock:
            if key in self._new or self._connection is None:
                return self._new.get(key)
            row = self._execute("SELECT found FROM piece WHERE key = ?", (key,)).fetchone()
        return row[0] if row and isinstance(row[0], bytes) else None

    def put(self, key: bytes, found: bytes) -> None:
        """Keep a piece, to be written with others a little later."""
        with self._lock:
            self._new[key] = found
            if time.monotonic() - self._written > AT_LEAST_EVERY:
                self._write()

    def close(self) -> None:
        """Write the remaining pieces, and close the file."""
        with self._lock:
            if self._new:
                self._write()
            if self._connection is not None:
                self._connection.close()

    def _write(self) -> None:
        self._execute("BEGIN")
        for piece in self._new.items():
            self._execute("INSERT OR REPLACE INTO piece VALUES (?, ?)", piece)
        self._execute("COMMIT")
        self._new.clear()
        self._written = time.monotonic()

    def _execute(self, command: str, values: tuple[bytes, ...] = ()) -> sqlite3.Cursor:
        try:
            if self._connection is None:
                self._connection = sqlite3.connect(
                    self.path, timeout=30.0, check_same_thread=False, isolation_level=None
                )
                self._connection.execute("PRAGMA journal_mode = WAL")
                self._connection.execute("PRAGMA synchronous = NORMAL")
                self._connection.execute(_TABLE)
            return self._connection.execute(command, values)
        except sqlite3.Error as error:
            cure = "Remove it, or name another folder: --out DIR."
            raise InputError(str(self.path), f"cannot be used to keep runs ({error})", cure=cure) from error


def key_of(*parts: object) -> bytes:
    """Checksum of the inputs of a piece, by their exact text, and of the program's sources."""
    text = "\n".join(map(repr, parts))
    return hashlib.sha256(program() + text.encode()).digest()


@cache
def program() -> bytes:
    """Checksum of the sources of the package."""
    sources = sorted(Path(separatrix.__file__).parent.rglob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).digest()
