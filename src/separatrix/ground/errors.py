"""What separatrix tells a user: refusals of one line each, notes of validity, text safe for a terminal."""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache


class SeparatrixError(Exception):
    """Base of every error that separatrix raises on purpose."""


class InputError(SeparatrixError, ValueError):
    """A wrong input: its path, the rule, what was given, the cure.

    Parameters
    ----------
    path : str
        The quantity and where it stands, for instance ``"case.toml, line 7: [bearing] inner_conformity"``.
    rule : str
        What must hold, with the unit of its numbers: ``"must lie between 0.5 and 0.6 [-]"``.
    got : str
        The value given; empty if there was none.
    cure : str
        A sentence that helps; may be empty.
    """

    def __init__(self, path: str, rule: str, got: str = "", cure: str = "") -> None:
        super().__init__(path, rule, got, cure)
        self.path, self.rule, self.got, self.cure = path, rule, got, cure
        self.problems: tuple[InputError, ...] = ()
        self.line = 0
        """Of the file that was asked for; 0 if it is not known, or in another file."""

        self.key: tuple[str | int, ...] = ()
        """Section and key in that file; empty for the file as a whole."""

    def __str__(self) -> str:
        if self.problems:
            return "\n".join(map(str, self.problems))
        text = f"{self.path} {self.rule}".rstrip()
        text += f"; got {self.got}." if self.got else "."
        return f"{text} {self.cure}".rstrip()

    def at(self, path: str, *, cure: str | None = None) -> InputError:
        """Return the same fault at another path, with its own cure or this one."""
        return InputError(path, self.rule, self.got, self.cure if cure is None else cure)


def together(problems: Sequence[InputError]) -> InputError:
    """One error for everything wrong at once, a line each; its `problems` holds each."""
    single = [one for problem in problems for one in problem.problems or (problem,)]
    if len(single) == 1:
        return single[0]
    error = InputError("\n".join(map(str, single)), "")
    error.problems = tuple(single)
    return error


@contextmanager
def noted(problems: list[InputError]) -> Iterator[None]:
    """Add a refusal to the list of problems instead of raising it."""
    try:
        yield
    except InputError as error:
        problems.extend(error.problems or (error,))


class ConvergenceError(SeparatrixError, RuntimeError):
    """An iteration did not settle; carries how far it came."""

    def __init__(self, message: str, iterations: int = 0, residual: float = 0.0) -> None:
        super().__init__(message, iterations, residual)
        self.message, self.iterations, self.residual = message, iterations, residual

    def __str__(self) -> str:
        return self.message


class DataError(SeparatrixError, LookupError):
    """A table of the library lacks what was asked for."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


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


_encoded = json.JSONEncoder(allow_nan=False).encode


@cache
def _row_encoded(line: str) -> Callable[[object], str]:
    """Return what encodes a dictionary with a line a key."""
    return json.JSONEncoder(allow_nan=False, separators=(f",{line}", ": ")).encode


def json_text(value: object, line: str = "\n") -> str:
    """Return plain data as JSON: a line a key and a row of a table, all numbers of an array on one."""
    inside = f"{line} "
    if isinstance(value, dict) and value:
        if not any(isinstance(one, dict | list) for one in value.values()):  # a row of a table: at once
            return f"{{{inside}{_row_encoded(inside)(value)[1:-1]}{line}}}"
        rows = (f"{_encoded(key)}: {json_text(one, inside)}" for key, one in value.items())
        return f"{{{inside}{f',{inside}'.join(rows)}{line}}}"
    if isinstance(value, list) and any(isinstance(one, dict) for one in value):
        return f"[{inside}{f',{inside}'.join(json_text(one, inside) for one in value)}{line}]"
    return _encoded(value)


def grouped(notes: Iterable[str]) -> list[str]:
    """Return the first of the sentences that differ in numbers only, and how many more there are."""
    alike: dict[str, list[str]] = {}
    for note in dict.fromkeys(notes):
        alike.setdefault(re.sub(r"[0-9][0-9.e+-]*", "0", note), []).append(note)
    return [f"{n[0]} (And {len(n) - 1} more with other numbers.)" if n[1:] else n[0] for n in alike.values()]
