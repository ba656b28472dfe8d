"""The one check of a file that a user names, before it is opened: a pipe or a device may never end."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path

from separatrix.errors import InputError

_only_in: ContextVar[Path | None] = ContextVar("only_in", default=None)
_OWN = Path(__file__).resolve().parent
"""What the package ships may be read from everywhere."""


@contextlib.contextmanager
def reading_only_in(folder: Path) -> Iterator[None]:
    """Refuse, within it, every file that is outside a folder, be it by a link, and that we do not ship."""
    token = _only_in.set(folder.resolve())
    try:
        yield
    finally:
        _only_in.reset(token)


def size_of(path: Path, where: str) -> int:
    """Size in bytes of a regular file, links followed; nothing else is to be opened.

    Parameters
    ----------
    path : Path
        As the user named it.
    where : str
        Its name in the refusal.

    Raises
    ------
    InputError
        There is none, it is a folder, a pipe or a device, or it is outside of `reading_only_in`.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:
        raise unreadable(where, error) from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(where, "is a folder, not a file", cure="Name a file in it.")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(where, "is not a regular file", cure="Save what it gives to a file, and name that.")
    folder, real = _only_in.get(), path.resolve()
    if folder is not None and not (real.is_relative_to(folder) or real.is_relative_to(_OWN)):
        raise InputError(where, "is outside the folder that may be read", cure="Copy it into the folder.")
    return found.st_size


def unreadable(where: str, error: OSError | ValueError) -> InputError:
    """Refusal of a file that the system does not give; a ValueError is that of a NUL in its name."""
    reason = os.strerror(error.errno) if isinstance(error, OSError) and error.errno else "no such file"
    return InputError(where, f"cannot be read: {reason[:1].lower()}{reason[1:]}")
