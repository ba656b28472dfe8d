"""Routes of what is handed over: the report of a study, and two studies compared."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, Response

from separatrix.app import draft
from separatrix.app.page import Page
from separatrix.comparing.pair import compared
from separatrix.comparing.saved import VERBS, Saved, read_answers
from separatrix.comparing.text import in_words, input_words, pair_words, result_words, shown_rows
from separatrix.errors import InputError

REPORT = "report"
FILES = ("report.html", "report.pdf")


def routes(page: Page) -> APIRouter:
    """Return the routes of reports and comparisons."""
    router = APIRouter(default_response_class=HTMLResponse)

    @router.post("/report/{name:path}")
    def report(name: str) -> Response:
        path = page.folder.study(name)
        draft.save_to_run(path, page.folder.root)
        page.jobs.ask(REPORT, path, page.folder.answers(name), name=name)
        return page.html("jobs.html", jobs=page.jobs.all())

    @router.get("/report/{name:path}")
    def written(name: str) -> Response:
        place = page.folder.answers(name)
        files = [file for file in FILES if (place / file).is_file()]
        if not files:
            raise InputError(
                f"{name}: report", "is not written yet", cure="Make it on the page of the study."
            )
        return page.html("report.html", name=name, files=files, folder=page.folder.name(place))

    @router.get("/compare")
    def compare(first: str = "", second: str = "", verb: str = "") -> Response:
        names = [name for name in page.folder.studies() if page.answered(name)]
        shown: dict[str, Any] = {"verbs": [], "verb": verb, "comparison": None}
        if first and second:
            shown = _compared(page.folder.answers(first), page.folder.answers(second), verb)
        return page.html("compare.html", names=names, first=first, second=second, **shown)

    return router


def _compared(first: Path, second: Path, verb: str) -> dict[str, Any]:
    """Return the comparison of two folders of answers, by one verb that both have."""
    pair = [_answers(place) for place in (first, second)]
    shared = [one for one in VERBS if all(one in found for found in pair)]
    if not shared:
        raise InputError(
            f"{first.name} and {second.name}", "have no answer of one verb", cure="Run one of both."
        )
    chosen = verb if verb in shared else shared[0]
    found = compared(pair[0][chosen], pair[1][chosen])
    own = found.environment or ""
    return {
        "verbs": shared,
        "verb": chosen,
        "comparison": found,
        "text": in_words(found, full=True),
        "verdicts": [(row.place, row.name, *pair_words(row)) for row in found.verdicts],
        "rows": [result_words(row, own) for row in shown_rows(found)],
        "inputs": [
            (at.key, *(input_words(one, at.unit) for one in (at.first, at.second)))
            for at in found.differences
        ],
    }


def _answers(place: Path) -> dict[str, Saved]:
    if not place.is_dir():
        raise InputError(place.name, "has no answers yet", cure="Run a verb of it.")
    return read_answers(place)
