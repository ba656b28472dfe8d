"""Files that a user names: checked before they are opened.

A pipe or a device may never end, so `size_of` comes before every opening.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from separatrix.ground.errors import InputError

_PACKAGE = Path(__file__).resolve().parents[1]
"""What the package ships may be read from everywhere."""


_only_in: ContextVar[Path | None] = ContextVar("only_in", default=None)


@contextmanager
def reading_only_in(folder: Path) -> Iterator[None]:
    """Refuse, within it, every file outside a folder, also by a link, that is not of the package."""
    token = _only_in.set(folder.resolve())
    try:
        yield
    finally:
        _only_in.reset(token)


def is_inside(path: Path, folder: Path) -> bool:
    """Whether a path is in a folder, links of both followed; it need not exist."""
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):  # links in a circle
        return False


def size_of(path: Path, where: str) -> int:
    """Size in bytes of a regular file, links followed; no other may be opened. `where` names it in a refusal.

    Raises
    ------
    InputError
        It does not exist, is a folder, a pipe or a device, or is outside of `reading_only_in`.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:
        raise unreadable(where, error) from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(where, "is a folder, not a file", cure="Name a file in it.")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(where, "is not a regular file", cure="Save its output to a file, and name that.")
    folder = _only_in.get()
    if folder is not None and not (is_inside(path, folder) or is_inside(path, _PACKAGE)):
        raise InputError(where, "is outside the folder that may be read", cure="Copy it into the folder.")
    return found.st_size


def unreadable(where: str, error: OSError | ValueError) -> InputError:
    """Refusal of a file that the system refused; a ValueError is that of a NUL in its name."""
    reason = os.strerror(error.errno) if isinstance(error, OSError) and error.errno else "no such file"
    return InputError(where, f"cannot be read: {reason[:1].lower()}{reason[1:]}")
