"""What all routes share: the folder with its files, the jobs, the templates, the answers that were read."""

from __future__ import annotations

import json
import re
import tomllib
from dataclasses import dataclass
from functools import lru_cache
from os.path import exists
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from urllib.parse import parse_qs, quote

from fastapi import Depends, Request
from fastapi.responses import HTMLResponse
from jinja2 import Environment, PackageLoader, StrictUndefined

from separatrix import __version__
from separatrix.ground.errors import InputError
from separatrix.ground.files import is_inside
from separatrix.ground.toml import read_text
from separatrix.ground.units import printable, shown
from separatrix.verbs import VERBS
from separatrix.verbs.verb import kind_of

if TYPE_CHECKING:
    from separatrix.front.page.worker import Job, Jobs

REPORT, LOG = "report", "tribometer"
"""In the place of a verb: the report of a study, and the tool whose question is to a log."""

LOGS, MAP, OF_LOG = "logs", ".map.toml", ".answer"
"""Folder of the logs of tribometers; endings of a column map and of the folder of an answer, beside a log."""

MOST_STUDIES, DEEPEST = 500, 3
_NAME = re.compile(r"[^\W_][\w .,()+-]{0,99}")
_PART = r"[^./\0\\:][^/\0\\:]*"
_HEADER = re.compile(rb"^\s*\[bearing\]|^\s*extends\s*=", re.MULTILINE)
_BEGINNING = 64 * 1024

TEMPLATES = Environment(
    loader=PackageLoader("separatrix.front.page"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Folder:
    """The folder of a page; names in it are relative, with slashes."""

    root: Path

    def inside(self, name: str) -> Path:
        """Return the path of a file; refused if missing, hidden, or outside, be it by a link."""
        if not re.fullmatch(rf"{_PART}(?:/{_PART})*", name):
            raise InputError(shown(name), "is not the name of a file in this folder")
        path = self.root / name
        if not (exists(path) and self.has(path) and is_inside(path.parent, self.root)):
            raise InputError(shown(name), "does not exist in this folder")
        return path

    def has(self, path: Path) -> bool:
        """Whether a path is a file of the folder; one that a link leads out to is not."""
        return path.is_file() and is_inside(path, self.root)

    def refuse_link_out(self, path: Path) -> None:
        """Refuse a file or folder to write to where a link leads out of the folder."""
        if not is_inside(path, self.root):
            rule = "leads out of the folder of the studies"
            raise InputError(shown(path.name), rule, cure="Remove this link.")

    def new(self, name: str, place: str = "") -> Path:
        """Return the path of a file to make beside the studies or in a folder there, or refuse its name."""
        if not _NAME.fullmatch(name) or Path(name).name != name:
            cure = "Use letters, digits, spaces, dots and dashes."
            raise InputError(shown(name), "is not a name for a file", cure=cure)
        path = self.root / place / name
        self.refuse_link_out(path.parent)
        if path.exists() or path.is_symlink():
            raise InputError(shown(name), "exists already", cure="Choose another name.")
        return path

    def study(self, name: str) -> Path:
        """Return the path of a study."""
        path = self.inside(name)
        if path.suffix != ".toml":
            raise InputError(shown(name), "is not a study")
        return path

    def answers(self, name: str, verb: str = "") -> Path:
        """Return the folder of the answers to a study, that of the command line, or to a log."""
        if verb == LOG:
            return self.log(name).with_name(name + OF_LOG)
        path = self.study(name)
        return path.with_name(printable(path.stem, 100))

    def logs(self) -> list[str]:
        """Return the names of the logs of tribometers."""
        found = [path for path in self.root.glob(f"{LOGS}/[!.]*") if path.suffix != ".toml"]
        return sorted(path.name for path in found if self.has(path) and is_inside(path.parent, self.root))

    def log(self, name: str) -> Path:
        """Return the path of a log."""
        if name not in self.logs():
            raise InputError(shown(name), "is not a log of this folder")
        return self.root / LOGS / name

    def name(self, path: Path) -> str:
        """Return the name of a file in the folder."""
        return path.relative_to(self.root).as_posix()

    def studies(self) -> list[str]:
        """Return the names of the studies, those on top first."""
        found = (path for depth in range(DEEPEST) for path in self.root.glob("*/" * depth + "*.toml"))
        names = (self.name(path) for path in found if self._is_study(path))
        return sorted(names, key=lambda name: (name.count("/"), name.casefold()))[:MOST_STUDIES]

    def _is_study(self, path: Path) -> bool:
        """Whether a path is a file that begins as a study does, is not hidden, and to which no link leads."""
        name = self.name(path)
        if not path.is_file() or "/." in f"/{name}" or path.resolve() != self.root.resolve() / name:
            return False
        with path.open("rb") as file:
            return _HEADER.search(file.read(_BEGINNING)) is not None


@lru_cache(maxsize=64)
def _loaded(path: Path, state: int) -> Any:  # noqa: ARG001 - each state is read once
    """Return the content of a file of JSON or TOML; None if it is damaged."""
    try:
        return tomllib.loads(read_text(path)) if path.suffix == ".toml" else json.loads(path.read_bytes())
    except (ValueError, OSError, RecursionError):
        return None


@dataclass(slots=True, kw_only=True)
class Page:
    """The folder that is shown, and what works for it."""

    folder: Folder
    jobs: Jobs

    def html(self, template: str, status: int = 200, **values: object) -> HTMLResponse:
        """Return a page or a part of one."""
        return HTMLResponse(TEMPLATES.get_template(template).render(**values), status)

    def running(self) -> HTMLResponse:
        """Return the list of jobs."""
        return self.html("jobs.html", jobs=self.jobs.all())

    def loaded(self, path: Path) -> dict[str, Any]:
        """Return the content of a file of JSON or TOML; an empty one if it is damaged or missing."""
        found = _loaded(path, path.stat().st_mtime_ns) if self.folder.has(path) else None
        return found if isinstance(found, dict) else {}

    def title(self, study: str) -> str:
        """Return the title that the file of a study has; empty if it has none of its own."""
        title = self.loaded(self.folder.study(study)).get("title")
        return title if isinstance(title, str) else ""

    def answered(self, study: str) -> list[str]:
        """Return the verbs that a study has saved answers of, in the order of the chain."""
        place = self.folder.answers(study)
        return [verb for verb in VERBS if self.folder.has(place / f"{verb}.json")]


def address(job: Job) -> str:
    """Return where the answer of a job is shown."""
    place = {REPORT: "files", LOG: "log"}.get(job.verb, f"answer/{job.verb}")
    return f"/{place}/{quote(job.name)}"


TEMPLATES.globals |= {"version": __version__, "address": address, "helps": VERBS, "kind_of": kind_of}


async def _body_of(request: Request) -> bytes:
    return await request.body()


Body = Annotated[bytes, Depends(_body_of)]
"""What was sent."""


def _form_of(body: Body) -> dict[str, str]:
    """Return the fields of a form that was sent, the last of each name."""
    sent = parse_qs(body.decode("utf-8", "replace"), keep_blank_values=True)
    return {name: values[-1] for name, values in sent.items()}


Form = Annotated[dict[str, str], Depends(_form_of)]
"""The fields of a form that was sent."""
