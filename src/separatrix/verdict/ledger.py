"""Finished pieces of a long job in an SQLite file, so that an interrupted job can resume."""

from __future__ import annotations

import hashlib
import sqlite3
import threading
from functools import cache
from pathlib import Path

import separatrix
from separatrix.ground.errors import InputError

NAME = "finished-runs.sqlite"
"""The file in the folder of the answers."""

DECIDE = ("cage", "chain", "friction", "ground", "study")
"""Rooms of the package whose sources decide what a run is: not what judges or tells it."""

_TABLE = "CREATE TABLE IF NOT EXISTS piece (key BLOB PRIMARY KEY, found BLOB) WITHOUT ROWID"


class Ledger:
    """Pieces by their key, a checksum of all that they depend on: many jobs may share a file.

    The file is made when the first piece is written; a file of another kind is refused. A piece is written at
    once, so that a kill loses only those under way, and with a checksum that binds it to its key: one that
    was changed, or stands at another key, counts as absent.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.goes_on = path, path.exists()
        self.taken = 0
        """Runs that were read here instead of being computed."""
        self._lock = threading.Lock()
        self._connection: sqlite3.Connection | None = None
        if self.goes_on:
            self._execute("SELECT 1 FROM piece LIMIT 1")

    def get(self, key: bytes) -> bytes | None:
        """Return the piece of a key; None if there is none that is whole."""
        with self._lock:
            if self._connection is None:
                return None
            row = self._execute("SELECT found FROM piece WHERE key = ?", (key,)).fetchone()
        if row is None or not isinstance(row[0], bytes):
            return None
        seal, found = row[0][:SEAL], row[0][SEAL:]
        return found if seal == _seal(key, found) else None

    def put(self, key: bytes, found: bytes) -> None:
        """Keep a piece."""
        with self._lock:
            self._execute("INSERT OR REPLACE INTO piece VALUES (?, ?)", (key, _seal(key, found) + found))

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            if self._connection is not None:
                self._connection.close()

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


SEAL = hashlib.sha256().digest_size


def _seal(key: bytes, found: bytes) -> bytes:
    """Checksum that binds a piece to its key."""
    return hashlib.sha256(key + found).digest()


def key_of(*parts: object) -> bytes:
    """Checksum of the inputs of a piece, by their exact text, and of the sources that decide it."""
    text = "\n".join(map(repr, parts))
    return hashlib.sha256(program() + text.encode()).digest()


@cache
def program() -> bytes:
    """Checksum of the sources of the rooms that decide what a run is."""
    package = Path(separatrix.__file__).parent
    sources = (path for room in DECIDE for path in sorted((package / room).rglob("*.py")))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).digest()
