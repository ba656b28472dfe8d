"""Files: checked before they are opened, and written aside and renamed, so that none is left half-written.

A pipe or a device may never end, so `size_of` comes before every opening.
"""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
import uuid
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


# ---- writing

_AHEAD = ".separatrix-"
"""Beginning of the names of folders and files written aside."""


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yield a folder inside `folder` to write into; at the end its files take their places, all or none.

    A folder that cannot be written is refused.
    """
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=_AHEAD) as stage:
            yield Path(stage)
            for path in sorted(Path(stage).iterdir()):
                path.replace(folder / path.name)
    except OSError as error:
        raise _cannot_write(folder, error) from error


@contextmanager
def writable_folder(path: Path) -> Iterator[Path]:
    """Make the folder and its parents, and test that it can be written, before the long work.

    Folders that it made are removed at the end if they are empty. One that cannot be written is refused.
    """
    probe, missing = path / f"{_AHEAD}{uuid.uuid4().hex}", list[Path]()
    try:
        try:
            missing += [folder for folder in (path, *path.parents) if not folder.exists()]
            path.mkdir(parents=True, exist_ok=True)
            probe.touch(exist_ok=False)
        except OSError as error:
            raise _cannot_write(path, error) from error
        finally:  # also where an interrupt comes just after it was made
            with contextlib.suppress(OSError):
                probe.unlink()
        yield path
    finally:  # also where an interrupt comes before the work
        with contextlib.suppress(OSError):
            for folder in missing:  # the deepest first
                folder.rmdir()


def _cannot_write(path: Path, error: OSError) -> InputError:
    reason = error.strerror or str(error)
    where = "the file" if isinstance(error, FileExistsError | NotADirectoryError) else "the folder"
    cure = "Name a folder that can be written: --out DIR."
    return InputError(f"--out {path}", f"cannot be written ({where}: {reason})", cure=cure)


def refuse_existing(path: Path) -> None:
    """Refuse the name of a new file that is taken, also by a broken link."""
    if os.path.lexists(path):
        raise _exists_already(path)


def _exists_already(path: Path) -> InputError:
    return InputError(str(path), "exists already", cure="It was not touched; name a new file.")


def write_new(path: Path, content: bytes) -> None:
    """Write a file that must not exist yet."""
    try:
        with path.open("xb") as file:
            file.write(content)
    except FileExistsError as error:
        raise _exists_already(path) from error
    except OSError as error:
        raise InputError(str(path), f"cannot be written ({error.strerror or error})") from error
