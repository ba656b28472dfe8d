"""Routes of the answers: tables, figures, files, the moving cage, the report."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import xarray as xr
from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, Response
from markupsafe import Markup

from separatrix.figures.envelope import envelope_plots, has_envelope, sweep_plots
from separatrix.figures.hover import Plot, candidates_plot, map_plot, stability_plot, traction_plot
from separatrix.figures.view import view
from separatrix.front.page import drafts as draft
from separatrix.front.page.folder import ANSWER_SUFFIXES, Folder, Page
from separatrix.front.page.plotly import spec
from separatrix.front.page.worker import REPORT
from separatrix.ground.errors import InputError
from separatrix.ground.units import shown
from separatrix.verbs import verb_named

PLOTS: dict[str, dict[str, Callable[[xr.Dataset], Plot | tuple[Plot, ...]]]] = {
    "traction": {"curves": traction_plot},
    "stability": {"curve": stability_plot},
    "rank": {"curve": stability_plot, "candidates": candidates_plot},
    "map": {"map": map_plot},
    "sweep": {"envelope": envelope_plots, "cases": sweep_plots},
}
"""Verb -> its figures to hover over, each one plot or several panels."""

FIGURES_OF = {
    "stability": ("stability-curve",),
    "rank": ("rank-", "stability-curve"),
    "map": ("stability-map",),
    "sweep": ("stability-map", "sweep-", "envelope"),
    "simulate": ("simulation",),
}
"""Verb -> how the names of its figures begin, if not as the verb."""

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
            text=text.read_text(encoding="utf-8") if page.folder.has(text) else "",
            plots=_plots(page.dataset(place, verb) if verb == "sweep" else None, verb),
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
        data = page.dataset(page.folder.answers(name), verb_named(verb).name)
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
    def cage(name: str) -> Response:
        data = page.dataset(page.folder.answers(name), "simulate")
        if data is None:
            raise InputError(f"{name}: simulate", "has no answer yet", cure="Run the verb.")
        found = {key: float(data[key]) for key in ("kick", "cage_ball_cage_friction") if key in data}
        return page.html(
            "cage.html",
            name=name,
            title=str(data.attrs.get("title", name)),
            found=found,
            view=Markup(view(data)),  # noqa: S704 - its texts are escaped
            answers=page.answered(name),
        )

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
        return page.html("report.html", name=name, files=files, folder=page.folder.name(place))

    return router


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
