"""Files are written aside and renamed into place, so that none is ever left half-written."""

from __future__ import annotations

import contextlib
import os
import platform
import re
import shutil
import tempfile
import uuid
import zlib
from collections.abc import Iterator
from pathlib import Path

from separatrix.ground.errors import InputError

_AHEAD = ".separatrix-"
_MINE = re.compile(re.escape(_AHEAD) + r"(?P<host>[0-9a-f]{8})-(?P<process>[0-9]+)-")


def _prefix() -> str:
    """Beginning of the names of files written aside: the machine and the process."""
    return f"{_AHEAD}{_host()}-{os.getpid()}-"


def _host() -> str:
    return f"{zlib.crc32(platform.node().encode()):08x}"


def _remove_left_behind(folder: Path) -> None:
    """Remove files that processes of this machine wrote aside before they were killed."""
    for path in folder.glob(f"{_AHEAD}*"):
        named = _MINE.match(path.name)
        if named is None or named["host"] != _host() or _is_alive(int(named["process"])):
            continue
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    """Whether a process exists; taken as true where the system has no harmless test."""
    if os.name == "posix":
        try:
            os.kill(process, 0)  # sends nothing
        except ProcessLookupError:
            return False
        except (OSError, OverflowError):  # it belongs to another user; or the number is none of a process
            return True
    return True


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Yield a folder inside `folder` to write into; at the end its files take their places, all or none.

    Such folders of processes that were killed are removed first. A folder that cannot be written is refused.
    """
    try:
        _remove_left_behind(folder)
        with tempfile.TemporaryDirectory(dir=folder, prefix=_prefix()) as stage:
            yield Path(stage)
            for path in sorted(Path(stage).iterdir()):
                path.replace(folder / path.name)
    except OSError as error:
        raise _cannot_write(folder, error) from error


@contextlib.contextmanager
def writable_folder(path: Path) -> Iterator[Path]:
    """Make the folder and its parents, and test that it can be written, before the long work.

    Folders that it made are removed at the end if they are empty. One that cannot be written is refused.
    """
    probe, missing = path / f"{_prefix()}{uuid.uuid4().hex}", list[Path]()
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
