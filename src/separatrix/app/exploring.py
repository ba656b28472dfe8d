"""Routes of the sliders: eta and margins of a changed study at once, its curve refined in the background."""

from __future__ import annotations

import hashlib
import json
import math
from pathlib import Path
from typing import NamedTuple

import xarray as xr
from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, JSONResponse, Response

from separatrix.app import draft
from separatrix.app.page import Page
from separatrix.app.plotly import Spec, spec
from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.chain.solution import Solution, solve
from separatrix.errors import InputError
from separatrix.figures.hover import stability_plot
from separatrix.figures.style import VERMILION
from separatrix.limits.curve import restitution_threshold
from separatrix.limits.map_records import parameters, value_in, varied
from separatrix.limits.point import CriticalFriction
from separatrix.limits.response import Side
from separatrix.messages import noted_warnings
from separatrix.study import Study
from separatrix.units import format_quantity, shown

POCKET_FRICTION = "cage.ball_cage_friction"
SLIDERS = (
    *("film.thickness", "film.race_friction", "cage.mass", "cage.pocket_clearance", "cage.land_clearance"),
    POCKET_FRICTION,
)
OF_THE_CURVE = ("cage.mass", "cage.pocket_clearance", "cage.land_clearance")
"""What moves the curve; the others move the bearing or the friction along it."""

REACH = 4.0
"""A slider goes from the study's value divided by this to it times this."""

EXPLORED = "explored"
"""Folder of the refined curves, in that of the answers."""


class Slider(NamedTuple):
    """One number of a study that can be moved: its value in SI and as text."""

    key: str
    label: str
    value: float
    text: str


class Curve(NamedTuple):
    """A finished curve: where it is, the values that its study had besides, and why it is outdated, if so."""

    place: Path
    verb: str
    values: dict[str, float]
    outdated: str


def routes(page: Page) -> APIRouter:
    """Return the routes of the sliders."""
    router = APIRouter()

    @router.get("/explore/{name:path}", response_class=HTMLResponse)
    def explore(name: str) -> Response:
        study = page.studies.read(page.folder.study(name))
        if study.cage is None:
            raise InputError(f"{name}: the sliders", "need the section [cage]", cure="Add it to the inputs.")
        answers = page.answered(name)
        found = sliders(study)
        return page.html("explore.html", name=name, title=study.title, sliders=found, answers=answers)

    @router.get("/explored/{name:path}")
    def explored(request: Request, name: str) -> Response:
        values = _values(request)
        study = page.studies.read(page.folder.study(name))
        best = _curve(page, name, {key: value for key, value in values.items() if key in OF_THE_CURVE})
        with draft.ONE_AT_A_TIME, noted_warnings():
            changed = varied(study, values) if values else study
            found = _found(page, solve(changed), values, best)
        return JSONResponse(found)

    @router.post("/refine/{name:path}")
    def refine(request: Request, name: str) -> Response:
        values = {key: value for key, value in _values(request).items() if key in OF_THE_CURVE}
        if not values:
            raise InputError("The curve", "is that of the study")
        place = _place(page, name, values)
        title = f"stability, other {', '.join(map(_label, values))}"
        for job in page.jobs.all():  # an older place of the same slider is of no use any more
            if job.is_active and job.study == name and job.title == title and job.task.values != values:
                page.jobs.cancel(job.number)
        path = page.folder.study(name)
        job = page.jobs.ask("stability", path, place, name=name, title=title, values=values)
        return JSONResponse({"job": job.number})

    return router


def _values(request: Request) -> dict[str, float]:
    values = {}
    for key, text in request.query_params.items():
        if key not in SLIDERS:
            continue
        try:
            values[key] = float(text)
        except ValueError:
            values[key] = math.nan
        if not 0.0 < values[key] < math.inf:
            unit = parameters()[key].unit if key in parameters() else "-"
            raise InputError(key, f"must be finite and > 0 [{unit}]", got=shown(text), cure="Write it in SI.")
    return values


def sliders(study: Study) -> list[Slider]:
    """Return the sliders of the numbers that a study has."""
    units = {key: parameter.unit for key, parameter in parameters().items()}
    values = {key: value_in(study, key) for key in SLIDERS}
    if study.cage is not None:
        values[POCKET_FRICTION] = _friction(solve(study))
    return [
        Slider(key, _label(key), value, format_quantity(value, units.get(key, "-"), 3))
        for key, value in values.items()
        if value is not None and value > 0.0
    ]


def _label(key: str) -> str:
    return key.rpartition(".")[2].replace("_", " ")


def _friction(solution: Solution) -> float | None:
    friction = solution.friction
    return None if friction is None else float(friction.mean)


def _place(page: Page, name: str, values: dict[str, float]) -> Path:
    mark = hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:12]
    return page.folder.answers(name) / EXPLORED / mark


def _curve(page: Page, name: str, values: dict[str, float]) -> Curve | None:
    """Return the finished curve that fits best: of these values, of the study, or an outdated one."""
    own = page.folder.answers(name)
    places = [(own, verb, dict[str, float]()) for verb in ("stability", "rank")]
    if values:
        places.insert(0, (_place(page, name, values), "stability", values))
    found = [
        Curve(place, verb, its, page.outdated(name, place, verb, its))
        for place, verb, its in places
        if page.folder.has(place / f"{verb}.nc") and page.document(place, verb) is not None
    ]
    current = [one for one in found if not one.outdated]
    return next(iter([*current, *(one for one in found if not one.values)]), None)


def _found(page: Page, solution: Solution, values: dict[str, float], best: Curve | None) -> dict[str, object]:
    """Return eta, the margins on the finished curve that fits best, and the figure."""
    study, eta = solution.study, solution.restitution.restitution_factor
    of_curve = {key: value for key, value in values.items() if key in OF_THE_CURVE}
    outdated = best.outdated if best else ""
    is_refined = best is not None and best.values == of_curve and not outdated
    data = page.dataset(best.place / f"{best.verb}.nc") if best else None
    document = page.document(best.place, best.verb) if best else None
    friction, threshold = _friction(solution), None
    if document is not None and friction is not None:
        rows = document.get("stability", document)["curve"]
        curve = [CriticalFriction(**{**row, "side": row["side"] and Side[row["side"]]}) for row in rows]
        threshold = restitution_threshold(curve, friction).value
    words = "not known" if threshold is None else f"{threshold:.2f}"
    made_of, environment = cage_candidate(study), environment_of(study.ranking) if study.ranking else ""
    return {
        "values": {one.key: one.text for one in sliders(study)},
        "eta": f"{eta:.3f}",
        "damping": format_quantity(solution.restitution.race_damping, "N s/m", 3),
        "friction": "not known" if friction is None else f"{friction:.3g}",
        "threshold": "1 (not reached)" if threshold is not None and threshold >= 1.0 else words,
        "margin": "not known" if threshold is None else f"{threshold - eta:+.2f}",
        "is_refined": is_refined,
        "is_to_refine": best is not None and bool(of_curve) and not is_refined,
        "is_outdated": bool(outdated),
        "outdated": outdated,
        "has_curve": data is not None,
        "whose": ", ".join(one for one in (made_of.name if made_of else "", environment) if one),
        "figure": None if data is None else _figure(data, eta, friction),
    }


def _figure(data: xr.Dataset, eta: float, friction: float | None) -> Spec:
    """Return the stability curve with the changed bearing on it, a point that the sliders move."""
    figure = spec(stability_plot(data))
    figure["layout"]["shapes"] = []
    if friction is not None:
        look = {"color": VERMILION, "size": 15, "symbol": "star", "line": {"width": 1, "color": "white"}}
        here = {"name": "with the sliders", "x": (eta,), "y": (friction,), "mode": "markers", "marker": look}
        figure["data"].append({**here, "hoverinfo": "name"})
    return figure
