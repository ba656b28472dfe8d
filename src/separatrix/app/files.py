"""The files of the folder that the page shows: only what is inside it, and nothing hidden."""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from separatrix.errors import InputError
from separatrix.units import printable, shown

STUDY_SUFFIXES = (".toml", ".xlsx", ".xlsm", ".ods")
ANSWER_SUFFIXES = (
    *(".json", ".txt", ".nc", ".png", ".svg", ".pdf", ".html", ".csv", ".xlsx", ".gif", ".mp4"),
    ".toml",
)
TABLE_SUFFIX = ".csv"
MOST_STUDIES, DEEPEST = 500, 3
_NAME = re.compile(r"[^\W_][\w .,()+-]{0,99}")
_HEADER = re.compile(rb"^\s*\[bearing\]|^\s*extends\s*=", re.MULTILINE)
_SHEET = re.compile(rb'name="bearing"', re.IGNORECASE)
_BEGINNING = 64 * 1024
LOGS = "logs"
"""Folder of the tribometer logs that were dropped on the page."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Folder:
    """The folder of a page; names in it are relative, with slashes."""

    root: Path

    def inside(self, name: str) -> Path:
        """Return the path of a file or folder.

        Raises
        ------
        InputError
            It does not exist, is hidden, or is outside, be it by a link.
        """
        parts = name.split("/")
        is_plain = bool(name) and not any(c in name for c in "\0\\:") and "" not in parts
        if is_plain and not any(part.startswith(".") for part in parts):
            path = self.root.joinpath(*parts)
            try:
                found = path.resolve(strict=True)
            except (OSError, RuntimeError, ValueError):
                raise InputError(shown(name), "does not exist in this folder") from None
            if found.is_relative_to(self.root.resolve()):
                return path
        raise InputError(shown(name), "is not the name of a file in this folder")

    def new(self, name: str) -> Path:
        """Return the path of a file to make beside the studies; its name is letters, digits, dots, dashes.

        Raises
        ------
        InputError
            It is not such a name, or it is taken.
        """
        if not _NAME.fullmatch(name) or Path(name).name != name:
            cure = "Use letters, digits, spaces, dots and dashes."
            raise InputError(shown(name), "is not a name for a file", cure=cure)
        path = self.root / name
        if path.exists() or path.is_symlink():
            raise InputError(shown(name), "exists already", cure="Choose another name.")
        return path

    def study(self, name: str) -> Path:
        """Return the path of a study."""
        path = self.inside(name)
        if path.suffix not in STUDY_SUFFIXES or not path.is_file():
            raise InputError(shown(name), "is not a study")
        return path

    def answers(self, name: str) -> Path:
        """Return the folder of the answers to a study, that of the command line; it need not exist."""
        path = self.study(name)
        return path.parent / printable(path.stem, 100)

    def tables(self, name: str) -> list[str]:
        """Return the names of the CSV files beside a study: what `sweep` may take its cases from."""
        return [
            path.name
            for path in sorted(self.study(name).parent.iterdir())
            if path.suffix.lower() == TABLE_SUFFIX
            and not path.name.startswith(".")
            and not path.is_symlink()
            and path.is_file()
        ][:MOST_STUDIES]

    def table(self, name: str, table: str) -> Path:
        """Return the path of a CSV file beside a study.

        Raises
        ------
        InputError
            It is not one of `tables`.
        """
        if table not in self.tables(name):
            raise InputError("--cases", "must be a CSV file beside the study", got=shown(table))
        return self.study(name).parent / table

    def name(self, path: Path) -> str:
        """Return the name of a file in the folder."""
        return path.relative_to(self.root).as_posix()

    def studies(self) -> list[str]:
        """Return the names of the studies, those on top first."""
        return sorted((self.name(path) for path in self._studies(self.root, 1)), key=_place)[:MOST_STUDIES]

    def _studies(self, folder: Path, depth: int) -> Iterator[Path]:
        for path in sorted(folder.iterdir()):
            if path.name.startswith(".") or path.is_symlink():
                continue
            if path.is_dir() and depth < DEEPEST:
                yield from self._studies(path, depth + 1)
            elif path.suffix in STUDY_SUFFIXES and path.is_file() and is_study(path):
                yield path


def _place(name: str) -> tuple[int, str]:
    return name.count("/"), name.casefold()


def is_study(path: Path) -> bool:
    """Whether a file begins as a study does, or has its sheets; a library or a friction file does not."""
    if path.suffix != ".toml":
        part = "content.xml" if path.suffix == ".ods" else "xl/workbook.xml"
        try:
            with zipfile.ZipFile(path) as book, book.open(part) as sheets:
                return _SHEET.search(sheets.read(_BEGINNING)) is not None
        except (
            OSError,
            KeyError,
            ValueError,
            RuntimeError,
            zipfile.BadZipFile,
            zlib.error,
        ):  # not a workbook
            return False
    with path.open("rb") as file:
        return _HEADER.search(file.read(_BEGINNING)) is not None
