"""What all routes share: the folder, the jobs, the templates, the answers that were read already."""

from __future__ import annotations

import json
import threading
import tomllib
from collections import OrderedDict
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs

from fastapi import Request
from fastapi.responses import HTMLResponse
from jinja2 import Environment, PackageLoader, StrictUndefined

from separatrix import __version__
from separatrix.app.files import Folder
from separatrix.app.jobs import Jobs
from separatrix.errors import InputError
from separatrix.questions import VERBS
from separatrix.toml_files import read_text
from separatrix.units import format_quantity

if TYPE_CHECKING:
    import xarray as xr

MOST_READ = 64
"""Answers and titles that are kept in memory."""

VERDICTS = {"STABLE": "stable", "UNSTABLE": "unstable", "UNDECIDED": "undecided"}
"""Verdict -> the class of its look."""

TEMPLATES = Environment(
    loader=PackageLoader("separatrix.app"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
TEMPLATES.globals |= {"version": __version__, "verdicts": VERDICTS}
TEMPLATES.filters["quantity"] = lambda value, unit: "-" if value is None else format_quantity(value, unit, 3)
TEMPLATES.filters["digits"] = lambda value, count=2: "-" if value is None else f"{value:.{count}f}"


@dataclass(slots=True)
class _Read:
    """What a file held when it was read; each file has its own lock, so that a long one delays no other."""

    stamp: int | None = None
    content: Any = None
    lock: threading.Lock = field(default_factory=threading.Lock)


@dataclass(slots=True)
class Page:
    """The folder that is shown, and what works for it."""

    folder: Folder
    jobs: Jobs
    _read: OrderedDict[Path, _Read] = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def html(self, template: str, *, status: int = 200, **values: Any) -> HTMLResponse:
        """Return a page or a part of one."""
        return HTMLResponse(TEMPLATES.get_template(template).render(**values), status)

    def document(self, study: str, verb: str) -> Mapping[str, Any] | None:
        """Return the saved answer of a verb as its document; None if there is none, or it is damaged."""
        return self.document_in(self.folder.answers(study), verb)

    def document_in(self, place: Path, verb: str) -> Mapping[str, Any] | None:
        """Return the document of a verb in a folder of answers, as `document` does."""
        path = place / f"{verb}.json"
        found: Mapping[str, Any] | None
        found = self._known(path, lambda: json.loads(path.read_text(encoding="utf-8")))
        return found

    def title(self, study: str) -> str:
        """Return the title that the file of a study has; empty if it has none of its own."""
        path = self.folder.study(study)

        def load() -> str:
            title = tomllib.loads(read_text(path)).get("title", "")
            return title if isinstance(title, str) else ""

        return (self._known(path, load) if path.suffix == ".toml" else None) or ""

    def dataset(self, path: Path) -> xr.Dataset | None:
        """Return a saved dataset; None if there is none."""

        def load() -> xr.Dataset:
            from separatrix.present import load

            return load(path)

        found: xr.Dataset | None = self._known(path, load)
        return found

    def _known(self, path: Path, load: Any) -> Any:
        """Return what a file holds, read once for each state of the file."""
        try:
            stamp = path.stat().st_mtime_ns
        except OSError:
            return None
        with self._lock:
            known = self._read.setdefault(path, _Read())
            self._read.move_to_end(path)
            if len(self._read) > MOST_READ:
                self._read.popitem(last=False)
        with known.lock:
            if known.stamp != stamp:
                try:
                    known.content = load()
                except (ValueError, InputError):
                    known.content = None
                known.stamp = stamp
            return known.content

    def newest(self, verbs: Collection[str]) -> list[Path]:
        """Return the saved datasets of these verbs in the folder, the newest first."""
        names = [(self.folder.answers(name), verb) for name in self.folder.studies() for verb in verbs]
        found = [path for place, verb in names if (path := place / f"{verb}.nc").is_file()]
        return sorted(found, key=lambda path: -path.stat().st_mtime_ns)

    def answered(self, study: str) -> list[str]:
        """Return the verbs that a study has saved answers of, in the order of the chain."""
        place = self.folder.answers(study)
        return [verb.name for verb in VERBS if (place / f"{verb.name}.json").is_file()]


async def form_of(request: Request) -> dict[str, str]:
    """Return the fields of a form that was sent, the last of each name."""
    sent = parse_qs((await request.body()).decode("utf-8", "replace"), keep_blank_values=True)
    return {name: values[-1] for name, values in sent.items()}
