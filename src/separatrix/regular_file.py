"""The one check of a file that a user names, before it is opened: a pipe or a device may never end."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from separatrix.errors import InputError


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
        There is none, or it is a folder, a pipe or a device.
    """
    try:
        found = path.stat()
    except (OSError, ValueError) as error:
        raise unreadable(where, error) from None
    if stat.S_ISDIR(found.st_mode):
        raise InputError(where, "is a folder, not a file", cure="Name a file in it.")
    if not stat.S_ISREG(found.st_mode):
        raise InputError(where, "is not a regular file", cure="Save what it gives to a file, and name that.")
    return found.st_size


def unreadable(where: str, error: OSError | ValueError) -> InputError:
    """Refusal of a file that the system does not give; a ValueError is that of a NUL in its name."""
    reason = os.strerror(error.errno) if isinstance(error, OSError) and error.errno else "no such file"
    return InputError(where, f"cannot be read: {reason[:1].lower()}{reason[1:]}")
