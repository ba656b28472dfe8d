"""What all routes share: the folder with its files, the jobs, the templates, the answers that were read."""

from __future__ import annotations

import json
import re
import tomllib
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import parse_qs, quote

from fastapi import Depends, Request
from fastapi.responses import HTMLResponse
from jinja2 import Environment, PackageLoader, StrictUndefined

from separatrix import __version__
from separatrix.front.page.jobs import Job, Jobs
from separatrix.front.page.worker import LOG, REPORT
from separatrix.ground.errors import InputError
from separatrix.ground.files import is_inside
from separatrix.ground.toml import read_text
from separatrix.ground.units import printable, shown
from separatrix.verbs import VERBS

STUDY_SUFFIXES = (".toml", ".xlsx", ".xlsm", ".ods")
ANSWER_SUFFIXES = (
    *(".json", ".txt", ".nc", ".png", ".svg", ".pdf", ".html", ".csv", ".xlsx", ".gif"),
    ".toml",
)
TABLE_SUFFIX = ".csv"
LOGS, MAP, OF_LOG = "logs", ".map.toml", ".answer"
"""Folder of the logs of tribometers; endings of a column map and of the folder of an answer, beside a log."""

MOST_STUDIES, DEEPEST = 500, 3
_NAME = re.compile(r"[^\W_][\w .,()+-]{0,99}")
_HEADER = re.compile(rb"^\s*\[bearing\]|^\s*extends\s*=", re.MULTILINE)
_SHEET = re.compile(rb'name="bearing"', re.IGNORECASE)
_BEGINNING = 64 * 1024

TEMPLATES = Environment(
    loader=PackageLoader("separatrix.front.page"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
TEMPLATES.globals |= {"version": __version__}


@dataclass(frozen=True, slots=True, kw_only=True)
class Folder:
    """The folder of a page; names in it are relative, with slashes."""

    root: Path

    def inside(self, name: str) -> Path:
        """Return the path of a file or folder; refused if missing, hidden, or outside, be it by a link."""
        parts = name.split("/")
        is_plain = bool(name) and not any(c in name for c in "\0\\:") and "" not in parts
        if is_plain and not any(part.startswith(".") for part in parts):
            path = self.root.joinpath(*parts)
            if not (is_inside(path, self.root) and is_inside(path.parent, self.root) and _exists(path)):
                raise InputError(shown(name), "does not exist in this folder")
            return path
        raise InputError(shown(name), "is not the name of a file in this folder")

    def has(self, path: Path) -> bool:
        """Whether a path is a file of the folder; one that a link leads out to is not."""
        return path.is_file() and is_inside(path, self.root)

    def new(self, name: str, place: str = "") -> Path:
        """Return the path of a file to make beside the studies or in a folder there, or refuse its name."""
        if name == ".toml":
            raise InputError("The name", "must not be empty", cure="Type one, for instance my-bearing.")
        if not _NAME.fullmatch(name) or Path(name).name != name:
            cure = "Use letters, digits, spaces, dots and dashes."
            raise InputError(shown(name), "is not a name for a file", cure=cure)
        path = self.root / place / name
        if not is_inside(path.parent, self.root):
            raise InputError(shown(place), "leads out of the folder of the studies", cure="Remove this link.")
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

    def logs(self) -> list[str]:
        """Return the names of the logs of tribometers."""
        place = self.root / LOGS
        found = place.iterdir() if place.is_dir() and is_inside(place, self.root) else ()
        return sorted(
            one.name for one in found if self.has(one) and one.name[0] != "." and one.suffix != ".toml"
        )

    def log(self, name: str) -> Path:
        """Return the path of a log."""
        if name not in self.logs():
            raise InputError(shown(name), "is not a log of this folder")
        return self.root / LOGS / name

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
        """Return the path of a CSV file beside a study; refused if it is not one of `tables`."""
        if table not in self.tables(name):
            raise InputError("--cases", "must be a CSV file beside the study", got=shown(table))
        return self.study(name).parent / table

    def name(self, path: Path) -> str:
        """Return the name of a file in the folder."""
        return path.relative_to(self.root).as_posix()

    def studies(self) -> list[str]:
        """Return the names of the studies, those on top first."""
        names = (self.name(path) for path in self._studies(self.root, 1))
        return sorted(names, key=lambda name: (name.count("/"), name.casefold()))[:MOST_STUDIES]

    def _studies(self, folder: Path, depth: int) -> Iterator[Path]:
        for path in sorted(folder.iterdir()):
            if path.name.startswith(".") or path.is_symlink():
                continue
            if path.is_dir() and depth < DEEPEST:
                yield from self._studies(path, depth + 1)
            elif path.suffix in STUDY_SUFFIXES and path.is_file() and _is_study(path):
                yield path


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a name that the system cannot have
        return False


def _is_study(path: Path) -> bool:
    """Whether a file begins as a study does, or has its sheets; a library or a friction file does not."""
    if path.suffix != ".toml":
        part = "content.xml" if path.suffix == ".ods" else "xl/workbook.xml"
        try:
            with zipfile.ZipFile(path) as book, book.open(part) as sheets:
                return _SHEET.search(sheets.read(_BEGINNING)) is not None
        except (OSError, KeyError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error):
            return False  # not a workbook
    with path.open("rb") as file:
        return _HEADER.search(file.read(_BEGINNING)) is not None


@lru_cache(maxsize=64)
def _loaded(state: tuple[Path, int]) -> Any:
    """Return the content of a file of JSON or TOML, read once for each state of it; None if it is damaged."""
    path, _ = state
    try:
        return tomllib.loads(read_text(path)) if path.suffix == ".toml" else json.loads(path.read_bytes())
    except (ValueError, InputError, OSError, RecursionError):
        return None


@dataclass(slots=True, kw_only=True)
class Page:
    """The folder that is shown, and what works for it."""

    folder: Folder
    jobs: Jobs

    def html(self, template: str, **values: object) -> HTMLResponse:
        """Return a page or a part of one; a list of jobs leads to their answers."""
        return HTMLResponse(TEMPLATES.get_template(template).render(address=self.address, **values))

    def running(self) -> HTMLResponse:
        """Return the list of jobs."""
        return self.html("jobs.html", jobs=self.jobs.all())

    def loaded(self, path: Path) -> dict[str, Any]:
        """Return the content of a file of JSON or TOML; an empty one if it is damaged or missing."""
        found = _loaded((path, path.stat().st_mtime_ns)) if self.folder.has(path) else None
        return found if isinstance(found, dict) else {}

    def title(self, study: str) -> str:
        """Return the title that the file of a study has; empty if it has none of its own."""
        path = self.folder.study(study)
        title = self.loaded(path).get("title") if path.suffix == ".toml" else ""
        return title if isinstance(title, str) else ""

    def answered(self, study: str) -> list[str]:
        """Return the verbs that a study has saved answers of, in the order of the chain."""
        place = self.folder.answers(study)
        return [verb for verb in VERBS if self.folder.has(place / f"{verb}.json")]

    def address(self, job: Job) -> str:
        """Return where the answer of a job is shown."""
        if job.task.verb == REPORT:
            return f"/files/{quote(job.study)}"
        return (
            f"/log/{quote(job.study)}"
            if job.task.verb == LOG
            else f"/answer/{job.task.verb}/{quote(job.study)}"
        )


async def _form_of(request: Request) -> dict[str, str]:
    """Return the fields of a form that was sent, the last of each name."""
    sent = parse_qs((await request.body()).decode("utf-8", "replace"), keep_blank_values=True)
    return {name: values[-1] for name, values in sent.items()}


Form = Annotated[dict[str, str], Depends(_form_of)]
"""The fields of a form that was sent."""
