"""Messages to a user: warnings of validity collected, text that a terminal or a file can be sent."""

from __future__ import annotations

import json
import re
import threading
import unicodedata
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TextIO

from separatrix.ground.errors import ValidityWarning

_SUSPECT = re.compile(r"[^\n\x20-\x7e]")


def harmless(text: str) -> str:
    """Return the text with control characters spelled out, except ends of lines.

    A terminal obeys them, and a title or a log's header may come from a stranger. Invisible characters, such
    as those that change the direction of writing, are spelled out too.
    """
    return _SUSPECT.sub(_spelled, text)


def _spelled(found: re.Match[str]) -> str:
    c = found.group()
    is_seen = c.isprintable() or unicodedata.category(c) == "Zs"
    return c if is_seen else c.encode("unicode_escape").decode()


def one_line(text: str) -> str:
    """Return the harmless text on one line."""
    return harmless(" ".join(text.split()))


def json_text(value: object, line: str = "\n") -> str:
    """Return plain data as JSON: a line a key and a row of a table, all numbers of an array on one."""
    inside = f"{line} "
    if isinstance(value, dict) and value:
        rows = (f"{json.dumps(key)}: {json_text(one, inside)}" for key, one in value.items())
        return f"{{{inside}{f',{inside}'.join(rows)}{line}}}"
    if isinstance(value, list) and any(isinstance(one, dict) for one in value):
        return f"[{inside}{f',{inside}'.join(json_text(one, inside) for one in value)}{line}]"
    return json.dumps(value, allow_nan=False)


def grouped(notes: Iterable[str]) -> list[str]:
    """Return the first of the sentences that differ in numbers only, and how many more there are."""
    alike: dict[str, list[str]] = {}
    for note in notes:
        alike.setdefault(re.sub(r"[0-9][0-9.e+-]*", "0", note), []).append(note)
    return [f"{n[0]} (And {len(n) - 1} more with other numbers.)" if n[1:] else n[0] for n in alike.values()]


@contextmanager
def noted_warnings() -> Iterator[list[str]]:
    """Collect warnings of validity, each sentence once; other warnings take their usual way."""
    notes: list[str] = []
    one_at_a_time = threading.Lock()  # threads of a pool warn too
    with warnings.catch_warnings():
        warnings.simplefilter("always", ValidityWarning)
        usual = warnings.showwarning

        def note(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if not issubclass(category, ValidityWarning):
                usual(message, category, filename, lineno, file, line)
                return
            with one_at_a_time:
                if str(message) not in notes:
                    notes.append(str(message))

        warnings.showwarning = note  # put back by catch_warnings
        yield notes
