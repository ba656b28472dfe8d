"""Files are written aside and renamed into place; nothing is ever left half-written."""

from __future__ import annotations

import contextlib
import os
import tempfile
import uuid
from collections.abc import Iterator
from pathlib import Path

from separatrix.errors import InputError


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yield a folder inside `folder` to write into; at the end its files take their places, all or none.

    Raises
    ------
    InputError
        The folder cannot be written, or is full.
    """
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".separatrix-") as stage:
            yield Path(stage)
            for path in sorted(Path(stage).iterdir()):
                path.replace(folder / path.name)
    except OSError as error:
        raise _cannot_write(folder, error) from error


@contextlib.contextmanager
def writable_folder(path: Path) -> Iterator[Path]:
    """Make the folder and see that it can be written, before the long work; take it away if left empty.

    Parameters
    ----------
    path : Path
        The folder; its parents are made too.

    Raises
    ------
    InputError
        It is a file, or cannot be made or written.
    """
    missing: list[Path] = []
    try:
        _make_writable(path, missing)
        yield path
    finally:  # also where an interrupt comes before the work
        _remove_empty(missing)


def _make_writable(path: Path, missing: list[Path]) -> None:
    """Make the folder, and write in it; note which folders were not there."""
    probe = path / f".separatrix-{uuid.uuid4().hex}"
    try:
        missing += [folder for folder in (path, *path.parents) if not folder.exists()]
        path.mkdir(parents=True, exist_ok=True)
        probe.touch(exist_ok=False)
    except OSError as error:
        raise _cannot_write(path, error) from error
    finally:  # also where an interrupt comes just after it was made
        with contextlib.suppress(OSError):
            probe.unlink()


def _remove_empty(folders: list[Path]) -> None:
    """Remove those folders, deepest first, that are empty."""
    with contextlib.suppress(OSError):
        for folder in folders:
            folder.rmdir()


def _cannot_write(path: Path, error: OSError) -> InputError:
    reason = error.strerror or str(error)
    where = "the file" if isinstance(error, FileExistsError | NotADirectoryError) else "the folder"
    cure = "Name a folder that can be written: --out DIR."
    return InputError(f"--out {path}", f"cannot be written ({where}: {reason})", cure=cure)


def refuse_existing(path: Path) -> None:
    """Refuse the name of a new file that is taken, be it by a link that leads nowhere."""
    if os.path.lexists(path):
        raise _exists_already(path)


def _exists_already(path: Path) -> InputError:
    return InputError(str(path), "exists already", cure="It was not touched; name a new file.")


def write_new(path: Path, content: bytes) -> None:
    """Write a file that must not exist yet.

    Raises
    ------
    InputError
        There is something of that name, or the folder cannot be written.
    """
    try:
        with path.open("xb") as file:
            file.write(content)
    except FileExistsError as error:
        raise _exists_already(path) from error
    except OSError as error:
        raise InputError(str(path), f"cannot be written ({error.strerror or error})") from error
