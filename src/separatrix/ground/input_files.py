"""Files that a user names: checked before they are opened, noted while read, restored to be read again.

A pipe or a device may never end, so `size_of` comes before every opening. A study is read again from what its
answer keeps. Then every file that a file names is one of those kept: `place` refuses any other, so that the
files of a stranger's answer reach nothing of this machine.
"""

from __future__ import annotations

import hashlib
import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from separatrix.ground.errors import InputError
from separatrix.ground.units import printable, shown

MOST_BYTES = 64 * 1024**2
"""Of all files that an answer keeps together."""

MOST_FILES, LONGEST_NAME = 500, 400

_PACKAGE = Path(__file__).resolve().parents[1]
"""What the package ships may be read from everywhere."""


@dataclass(slots=True)
class Reading:
    """What was read: content of each file by its path as it was opened."""

    files: dict[Path, bytes] = field(default_factory=dict)
    absolute: set[str] = field(default_factory=set)
    """Absolute paths that the files name, as they are written."""


_only_in: ContextVar[Path | None] = ContextVar("only_in", default=None)
_reading: ContextVar[Reading | None] = ContextVar("reading", default=None)
_restored: ContextVar[tuple[Path, Mapping[str, str]] | None] = ContextVar("restored", default=None)
"""Folder of the files of an answer, and the name there of each absolute path."""


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


@contextmanager
def noting() -> Iterator[Reading]:
    """Note the files that are read within it, for `note` and `place` below; also for one around it."""
    found, around = Reading(), _reading.get()
    token = _reading.set(found)
    try:
        yield found
    finally:
        _reading.reset(token)
        if around is not None:
            around.files |= found.files


def note(path: Path, content: bytes) -> None:
    """Note the content of a file that was read."""
    reading = _reading.get()
    if reading is not None:
        reading.files[path] = content


def place(folder: Path, name: str) -> Path:
    """Path of a file or folder that a file in `folder` names.

    Raises
    ------
    InputError
        The files are those of an answer, and it does not keep this one.
    """
    reading, restored = _reading.get(), _restored.get()
    is_absolute = Path(name).is_absolute()
    if restored is None:
        if reading is not None and is_absolute:
            reading.absolute.add(name)
        return folder / name
    root, links = restored
    found = folder / name
    if not folder.is_relative_to(root):  # of a shipped study
        return found
    if is_absolute:
        found = root / links.get(checksum_of_name(name), "..")
    if not Path(os.path.abspath(found)).is_relative_to(root):
        raise InputError(shown(name), "names a file that the answer does not keep")
    return found


def checksum_of_name(name: str) -> str:
    """Key of an absolute path in an answer, which does not have the path itself."""
    return hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()


@contextmanager
def restored(files: Mapping[str, bytes], links: Mapping[str, str]) -> Iterator[Path]:
    """Yield a temporary folder with files by relative name, with slashes, which may name only one another.

    `links` has the name here of each absolute path, by `checksum_of_name`. Names that leave the folder are
    refused, and too many or too large files.
    """
    if len(files) > MOST_FILES or sum(map(len, files.values())) > MOST_BYTES:
        raise InputError("The files of the answer", f"must be at most {MOST_FILES}, {MOST_BYTES >> 20} MB")
    for name in (*files, *links.values()):
        refuse_unsafe(name)
    with tempfile.TemporaryDirectory(prefix="separatrix-") as made:
        root = Path(os.path.abspath(made))
        for name, content in files.items():
            path = root / name
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
                with path.open("xb") as file:
                    file.write(content)
            except OSError as error:
                raise InputError(shown(name), f"cannot be restored ({error.strerror})") from None
        token = _restored.set((root, dict(links)))
        try:
            with reading_only_in(root):
                yield root
        finally:
            _restored.reset(token)


def refuse_unsafe(name: str) -> None:
    """Refuse the name of a kept file that is absolute, has a drive, or climbs out of its folder."""
    parts = name.split("/")
    odd = any(part in ("", ".", "..") or part != part.strip() or part.endswith(".") for part in parts)
    marks = not name.isprintable() or "\\" in name or ":" in name
    if odd or marks or len(name) > LONGEST_NAME or PurePosixPath(name).is_absolute():
        rule = "must be a relative name inside the folder of the study"
        raise InputError("The name of a kept file", rule, f'"{printable(name, 80)}"')
