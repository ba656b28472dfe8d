"""Routes of the answers: tables, figures, files, the moving cage, a point of a map, report, comparison."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr
from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, Response
from markupsafe import Markup

from separatrix.app import draft
from separatrix.app.page import ANSWER_SUFFIXES, Folder, Form, Page
from separatrix.app.plotly import spec
from separatrix.app.worker import REPORT
from separatrix.comparing.pair import compared
from separatrix.comparing.saved import VERBS, read_answers
from separatrix.comparing.shown import in_words, input_words, pair_words, result_words, shown_rows
from separatrix.errors import InputError
from separatrix.figures.envelope import envelope_plots, has_envelope, sweep_plots
from separatrix.figures.hover import Plot, candidates_plot, map_plot, stability_plot, traction_plot
from separatrix.figures.style import study_of
from separatrix.figures.view import view
from separatrix.input_files import reading_only_in
from separatrix.limits.map_records import KICK, RESTITUTION
from separatrix.questions import verb_named
from separatrix.reporting.content import NEEDED
from separatrix.units import format_number, printable, shown

PLOTS: dict[str, dict[str, Callable[[xr.Dataset], Plot | tuple[Plot, ...]]]] = {
    "traction": {"curves": traction_plot},
    "stability": {"curve": stability_plot},
    "rank": {"curve": stability_plot, "candidates": candidates_plot},
    "map": {"map": map_plot},
    "sweep": {"envelope": envelope_plots, "cases": sweep_plots},
}
"""Verb -> its figures to hover over, each one plot or several panels."""

READ = (*PLOTS, "simulate")
"""Verbs whose datasets the page reads."""

FIGURES_OF = {
    "stability": ("stability-curve",),
    "rank": ("rank-", "stability-curve"),
    "map": ("stability-map",),
    "sweep": ("stability-map", "sweep-", "envelope"),
    "simulate": ("simulation",),
}
"""Verb -> how the names of its figures begin, if not as the verb."""

POINT = "points"
"""Folder of the runs at points of a map, in that of the answers."""

SHOWN_INLINE = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif", ".txt": "text/plain"}
"""Files that the browser shows; all others it keeps."""


def routes(page: Page) -> APIRouter:
    """Return the routes of the answers."""
    router = APIRouter()

    @router.get("/answer/{verb}/{name:path}", response_class=HTMLResponse)
    def answer(verb: str, name: str, environment: int = 0) -> Response:
        found = page.document(page.folder.answers(name), verb_named(verb).name)
        if found is None:
            raise InputError(f"{name}: {verb}", "has no answer yet", cure="Run the verb.")
        place = page.folder.answers(name)
        text = place / f"{verb}.txt"
        return page.html(
            "answer.html",
            name=name,
            verb=verb,
            found=found,
            outdated=page.outdated(name, place, verb),
            text=text.read_text(encoding="utf-8") if page.folder.has(text) else "",
            plots=_plots(page.dataset(place / f"{verb}.nc") if verb == "sweep" else None, verb),
            pictures=_files(page.folder, place, verb, (".png",)),
            files=_files(page.folder, place, verb, ANSWER_SUFFIXES),
            folder=page.folder.name(place),
            environment=environment,
            answers=page.answered(name),
            jobs=page.jobs.all(),
        )

    @router.get("/plot/{verb}/{figure}/{name:path}")
    def plot(verb: str, figure: str, name: str, environment: int | None = None) -> Response:
        draw = PLOTS.get(verb, {}).get(figure)
        data = page.dataset(page.folder.answers(name) / f"{verb_named(verb).name}.nc")
        if draw is None or data is None:
            raise InputError(f"{name}: {verb}", "has no such figure")
        if environment is not None and "environment" in data.dims and figure == "curve":
            data = data.isel(environment=min(max(environment, 0), data.sizes["environment"] - 1))
        found = draw(data)
        return JSONResponse(spec(*found) if isinstance(found, tuple) else spec(found))

    @router.get("/file/{name:path}")
    def file(name: str) -> Response:
        path = page.folder.inside(name)
        if not path.is_file() or path.suffix not in ANSWER_SUFFIXES:
            raise InputError(shown(name), "is not a file of an answer")
        kind = SHOWN_INLINE.get(path.suffix)
        return FileResponse(path, media_type=kind, filename=None if kind else path.name)

    @router.get("/cage/{name:path}", response_class=HTMLResponse)
    def cage(name: str, point: str = "") -> Response:
        data = _run(page, name, point)
        found = {key: float(data[key]) for key in ("kick", "cage_ball_cage_friction") if key in data}
        return page.html(
            "cage.html",
            name=name,
            point=point,
            title=str(data.attrs.get("title", name)),
            outdated="" if point else page.outdated(name, page.folder.answers(name), "simulate"),
            found=found,
            view=Markup(view(data)),  # noqa: S704 - its texts are escaped
            answers=page.answered(name),
        )

    @router.post("/point/{name:path}", response_class=HTMLResponse)
    def point(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        data = page.dataset(page.folder.answers(name) / "map.nc")
        if data is None:
            raise InputError(f"{name}: map", "has no answer yet", cure="Run the map first.")
        values = {str(data[f"{axis}_parameter"].values): _nearest(data, axis, sent) for axis in "xy"}
        folder = "_".join(f"{key.rpartition('.')[2]}-{format_number(v, 4)}" for key, v in values.items())
        place = page.folder.answers(name) / POINT / printable(folder, 100).replace("/", "-")
        cage = study_of(data).get("cage", {})  # simulated with the models of motion and ball of its map
        question: dict[str, object]
        question = {name: str(cage[name]["value"]) for name in ("motion", "ball") if name in cage}
        question["kick"] = values.pop(KICK, float(data["kick"]))
        if RESTITUTION in values:
            question["restitution_factor"] = values.pop(RESTITUTION)
        page.jobs.ask(
            "simulate", path, place, name=name, title=f"simulate {folder}", question=question, values=values
        )
        return page.html("jobs.html", jobs=page.jobs.all())

    @router.post("/report/{name:path}", response_class=HTMLResponse)
    def report(name: str) -> Response:
        path = page.folder.study(name)
        draft.save_to_run(path, page.folder.root)
        page.jobs.ask(REPORT, path, page.folder.answers(name), name=name)
        return page.html("jobs.html", jobs=page.jobs.all())

    @router.get("/report/{name:path}", response_class=HTMLResponse)
    def written(name: str) -> Response:
        place = page.folder.answers(name)
        files = [file for file in ("report.html", "report.pdf") if page.folder.has(place / file)]
        if not files:
            cure = "Make it on the page of the study."
            raise InputError(f"{name}: report", "is not written yet", cure=cure)
        outdated = _report_outdated(page, name, min((place / file).stat().st_mtime_ns for file in files))
        return page.html(
            "report.html", name=name, files=files, folder=page.folder.name(place), outdated=outdated
        )

    @router.get("/compare", response_class=HTMLResponse)
    def compare(first: str = "", second: str = "", verb: str = "") -> Response:
        names = [name for name in page.folder.studies() if page.answered(name)]
        found: dict[str, object] = {"verbs": [], "verb": verb, "comparison": None, "outdated": []}
        if first and second:
            found = _compared(page, first, second, verb)
        return page.html("compare.html", names=names, first=first, second=second, **found)

    return router


def _report_outdated(page: Page, name: str, written: int) -> str:
    """Return why a report of this time is not that of the study and its answers now; empty if it is."""
    place = page.folder.answers(name)
    shown = [verb for verb in NEEDED if verb in page.answered(name)]
    reasons = page.outdated_answers(name)
    if old := [verb for verb in shown if verb in reasons]:
        return (
            f"An answer in this report, {old[0]}, is outdated. {reasons[old[0]]} Then make the report again."
        )
    newer = [verb for verb in shown if (place / f"{verb}.json").stat().st_mtime_ns > written]
    return f"Newer than this report: {', '.join(newer)}. Make the report again." if newer else ""


def _plots(data: xr.Dataset | None, verb: str) -> list[str]:
    """Return the names of the figures to hover over; a sweep without an envelope has its cases."""
    if verb == "sweep":
        if data is None or "case" not in data.sizes:
            return []
        return ["envelope" if has_envelope(data) else "cases"]
    return [*PLOTS.get(verb, {})]


def _files(folder: Folder, place: Path, verb: str, suffixes: tuple[str, ...]) -> list[str]:
    if not place.is_dir():
        return []
    stems = FIGURES_OF.get(verb, (f"{verb}-",))
    return sorted(
        path.name
        for path in place.iterdir()
        if path.suffix in suffixes and (path.stem == verb or path.stem.startswith(stems)) and folder.has(path)
    )


def _run(page: Page, name: str, point: str) -> xr.Dataset:
    """Return the dataset of a simulated run: that of the study, or one at a point of its map."""
    place = page.folder.answers(name)
    if point:
        place = page.folder.inside(f"{page.folder.name(place)}/{POINT}/{point}")
    data = page.dataset(place / "simulate.nc")
    if data is None:
        raise InputError(f"{name}: simulate", "has no answer yet", cure="Run the verb.")
    return data


def _nearest(data: xr.Dataset, axis: str, sent: dict[str, str]) -> float:
    """Return the value of the map's axis next to the place that was clicked, in SI."""
    from separatrix.figures.map import axis_values

    try:
        at = float(sent.get(axis, ""))
    except ValueError:
        raise InputError(axis, "must be a number") from None
    return float(data[axis].values[int(np.argmin(np.abs(axis_values(data, axis) - at)))])


def _compared(page: Page, first: str, second: str, verb: str) -> dict[str, object]:
    """Return the comparison of the answers to two studies, by one verb that both have."""
    for name in (first, second):
        if not page.answered(name):
            raise InputError(name, "has no answers yet", cure="Run a verb of it.")
    with reading_only_in(page.folder.root):
        pair = [read_answers(page.folder.answers(name)) for name in (first, second)]
    shared = [one for one in VERBS if all(one in found for found in pair)]
    if not shared:
        raise InputError(f"{first} and {second}", "have no answer of one verb", cure="Run one of both.")
    chosen = verb if verb in shared else shared[0]
    found = compared(pair[0][chosen], pair[1][chosen])
    reasons = ((name, page.outdated_answers(name).get(chosen)) for name in (first, second))
    own = found.environment or ""
    return {
        "verbs": shared,
        "verb": chosen,
        "comparison": found,
        "outdated": [f"{name}: {reason}" for name, reason in reasons if reason],
        "text": in_words(found, full=True),
        "verdicts": [(row.place, row.name, *pair_words(row)) for row in found.verdicts],
        "rows": [result_words(row, own) for row in shown_rows(found)],
        "inputs": [
            (at.key, *(input_words(one, at.unit) for one in (at.first, at.second)))
            for at in found.differences
        ],
    }
