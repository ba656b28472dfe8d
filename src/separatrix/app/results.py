"""Routes of the answers: tables, figures to hover over, files, the moving cage, a point of a map."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import xarray as xr
from fastapi import APIRouter, Depends
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, Response
from markupsafe import Markup

from separatrix.app.files import ANSWER_SUFFIXES
from separatrix.app.motion import motion
from separatrix.app.page import Page, form_of
from separatrix.app.plotly import spec
from separatrix.errors import InputError
from separatrix.figures.envelope import has_envelope
from separatrix.figures.envelope_hover import envelope_plots, sweep_plots
from separatrix.figures.hover import Plot, candidates_plot, map_plot, stability_plot, traction_plot
from separatrix.figures.space import is_in_space
from separatrix.figures.space_page import view as space_view
from separatrix.figures.style import study_of
from separatrix.limits.map_parameters import KICK, RESTITUTION
from separatrix.questions import verb_named
from separatrix.units import format_number, printable, shown

Form = Annotated[dict[str, str], Depends(form_of)]

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

SHOWN = (".png",)
POINT = "points"
"""Folder of the runs at points of a map, in that of the answers."""

SHOWN_INLINE = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif", ".txt": "text/plain"}
"""Files that the browser shows; all others it keeps."""


def routes(page: Page) -> APIRouter:
    """Return the routes of the answers."""
    router = APIRouter()

    @router.get("/answer/{verb}/{name:path}", response_class=HTMLResponse)
    def answer(verb: str, name: str, environment: int = 0) -> Response:
        found = page.document(name, verb_named(verb).name)
        if found is None:
            raise InputError(f"{name}: {verb}", "has no answer yet", cure="Run the verb.")
        place = page.folder.answers(name)
        return page.html(
            "answer.html",
            name=name,
            verb=verb,
            found=found,
            text=_text(place / f"{verb}.txt"),
            plots=_plots(page.dataset(place / f"{verb}.nc") if verb == "sweep" else None, verb),
            pictures=_files(place, verb, SHOWN),
            files=_files(place, verb, ANSWER_SUFFIXES),
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
        if kind is None:
            return FileResponse(path, filename=path.name)
        return FileResponse(path, media_type=kind)

    @router.get("/cage/{name:path}", response_class=HTMLResponse)
    def cage(name: str, point: str = "") -> Response:
        data = _run(page, name, point)
        view = Markup(space_view(data)) if is_in_space(data) else None  # noqa: S704 - its texts are escaped
        found = {key: float(data[key]) for key in ("kick", "cage_ball_cage_friction") if key in data}
        words = str(data.attrs.get("title", name))
        return page.html(
            "cage.html",
            name=name,
            point=point,
            title=words,
            found=found,
            view=view,
            answers=page.answered(name),
        )

    @router.get("/motion/{name:path}")
    def moving(name: str, point: str = "") -> Response:
        data = _run(page, name, point)
        if is_in_space(data):
            raise InputError(name, "moves in space", cure="The page of its cage has its data.")
        return JSONResponse(motion(data))

    @router.post("/point/{name:path}", response_class=HTMLResponse)
    def point(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        data = page.dataset(page.folder.answers(name) / "map.nc")
        if data is None:
            raise InputError(f"{name}: map", "has no answer yet", cure="Run the map first.")
        values = {str(data[f"{axis}_parameter"].values): _nearest(data, axis, sent) for axis in "xy"}
        folder = "_".join(f"{key.rpartition('.')[2]}-{format_number(v, 4)}" for key, v in values.items())
        place = page.folder.answers(name) / POINT / printable(folder, 100).replace("/", "-")
        question: dict[str, Any] = {"kick": values.pop(KICK, float(data["kick"])), **_models(data)}
        if RESTITUTION in values:
            question["restitution_factor"] = values.pop(RESTITUTION)
        page.jobs.ask(
            "simulate", path, place, name=name, title=f"simulate {folder}", question=question, values=values
        )
        return page.html("jobs.html", jobs=page.jobs.all())

    return router


def _plots(data: xr.Dataset | None, verb: str) -> list[str]:
    """Return the names of the figures to hover over; a sweep without an envelope has its cases."""
    if verb == "sweep":
        if data is None or "case" not in data.sizes:
            return []
        return ["envelope" if has_envelope(data) else "cases"]
    return [*PLOTS.get(verb, {})]


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _files(place: Path, verb: str, suffixes: tuple[str, ...]) -> list[str]:
    """Return the names of the files of an answer."""
    if not place.is_dir():
        return []
    stems = FIGURES_OF.get(verb, (f"{verb}-",))
    return sorted(
        path.name
        for path in place.iterdir()
        if path.suffix in suffixes and (path.stem == verb or path.stem.startswith(stems)) and path.is_file()
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


def _models(data: xr.Dataset) -> dict[str, str]:
    """Return the models of motion and ball that a map was made with: its points are simulated with them."""
    cage = study_of(data).get("cage", {})
    return {name: str(cage[name]["value"]) for name in ("motion", "ball") if name in cage}


def _nearest(data: xr.Dataset, axis: str, sent: dict[str, str]) -> float:
    """Return the value of the map's axis next to the place that was clicked, in SI."""
    from separatrix.figures.map import axis_values

    try:
        at = float(sent.get(axis, ""))
    except ValueError:
        raise InputError(axis, "must be a number") from None
    return float(data[axis].values[int(np.argmin(np.abs(axis_values(data, axis) - at)))])
