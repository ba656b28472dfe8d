"""Routes of the tribometer logs: drop them, see what was read and where running-in ends, move that end."""

from __future__ import annotations

import glob
from collections.abc import Iterator
from pathlib import Path

import xarray as xr
from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, JSONResponse, Response

from separatrix.app import draft
from separatrix.app.page import LOGS, Folder, Form, Page
from separatrix.app.plotly import Spec, upright
from separatrix.errors import InputError
from separatrix.figures.style import BLUE, GREY, VERMILION
from separatrix.friction.file import friction_text
from separatrix.friction.logs import read_log
from separatrix.friction.logs.column_map import RUN_IN_END, ColumnMap
from separatrix.friction.reduction import RUN_IN_END as WHERE
from separatrix.friction.reduction import Reduction
from separatrix.friction.tribometer import OTHERS, ReducedLogs, tribometer
from separatrix.input_files import is_inside
from separatrix.messages import noted_warnings
from separatrix.present.tribometer import in_words, page_data
from separatrix.units import format_number, shown

UNITS = {"time": "s", "distance": "m", "cycles": ""}
"""Axis along which running-in is cut -> its unit."""

STATED = ("material", "counterface", "medium")
"""What the form may state of all logs that go into a friction file."""


def routes(page: Page) -> APIRouter:
    """Return the routes of the logs."""
    router = APIRouter()
    place = page.folder.root / LOGS
    ends: dict[str, str] = {}  # where running-in ends in a log, if the user moved it

    def uploads() -> Folder:
        if not is_inside(place, page.folder.root):
            raise InputError(LOGS, "leads out of the folder of the studies", cure="Remove this link.")
        place.mkdir(exist_ok=True)
        return Folder(root=place)

    def names() -> list[str]:
        return _names(Folder(root=place)) if is_inside(place, page.folder.root) else []

    @router.get("/logs", response_class=HTMLResponse)
    def logs() -> Response:
        return page.html("logs.html", names=names())

    @router.put("/logs/{name}", response_class=HTMLResponse)
    async def drop(name: str, request: Request) -> Response:
        content = await request.body()
        await run_in_threadpool(_keep, uploads(), name, content)
        return page.html("log_list.html", names=names())

    @router.get("/log/{name}", response_class=HTMLResponse)
    def log(name: str, run_in: str | None = None) -> Response:
        run_in = ends.get(name, "") if run_in is None else run_in.strip()
        found = _reduced(uploads().inside(name), run_in)
        ends[name] = run_in
        words = in_words(found, written=None, plots=None)
        tests = [_test(one) for one in found.reductions]
        return page.html("log.html", name=name, tests=tests, words=words, run_in=run_in)

    @router.get("/log-figure/{name}/{number}")
    def figure(name: str, number: int, run_in: str = "") -> Response:
        found = _reduced(uploads().inside(name), run_in).reductions
        if not 0 <= number < len(found):
            raise InputError(name, "has no such test")
        return JSONResponse(_trace(found[number]))

    @router.post("/logs-friction", response_class=HTMLResponse)
    def friction(sent: Form) -> Response:
        path = page.folder.new(f"{sent.get('name', '').strip().removesuffix('.toml')}.toml")
        stated = {key: words for key in STATED if (words := sent.get(key, "").strip())}
        files = [uploads().inside(name) for name in names()]
        _check_conflicts(files, stated)
        moved = {file.name: end for file in files if (end := ends.get(file.name))}
        by_file = {glob.escape(name): {RUN_IN_END: end} for name, end in moved.items()}
        found = _reduced(files, "", complete=True, column_map=ColumnMap(test=stated, files=by_file))
        if found.friction_tests is None:
            cure = "State material, counterface and medium beside the name."
            raise InputError("The logs", "do not all state their materials", cure=cure)
        path.write_text(friction_text(found.friction_tests), encoding="utf-8")
        return page.html("written.html", name=path.name, moved=moved)

    return router


def _names(folder: Folder) -> list[str]:
    if not folder.root.is_dir():
        return []
    files = (path for path in folder.root.iterdir() if folder.has(path) and not path.name.startswith("."))
    return sorted(path.name for path in files if path.suffix.casefold() not in OTHERS)


def _keep(folder: Folder, name: str, content: bytes) -> None:
    """Keep a log that was dropped; one of the same name and content is there already."""
    known = folder.root / name
    if "/" not in name and folder.has(known) and known.read_bytes() == content:
        return
    folder.new(name).write_bytes(content)


def _check_conflicts(files: list[Path], stated: dict[str, str]) -> None:
    """Refuse words of the form that a log contradicts: they are for the logs that state nothing."""
    if not stated:
        return
    with draft.ONE_AT_A_TIME, noted_warnings():
        logs = [log for file in files for log in read_log(file)]
    for log in logs:
        for key, words in stated.items():
            own = getattr(log.conditions, key)
            if own not in (None, words):
                rule = f"states another {key} than the form, {shown(words)}"
                cure = (
                    "Leave this field empty, or write the friction files of different materials one by one."
                )
                raise InputError(log.source, rule, shown(own), cure)


def _reduced(
    paths: Path | list[Path], run_in: str, *, complete: bool = False, column_map: ColumnMap | None = None
) -> ReducedLogs:
    """Return what logs show; `run_in` is where running-in ends, or empty to find it."""
    with draft.ONE_AT_A_TIME, noted_warnings():
        try:
            return tribometer(paths, run_in=run_in or None, complete=complete, column_map=column_map)
        except InputError as error:
            if error.path != WHERE or isinstance(paths, list):
                raise
            raise error.at(f"{paths.name}: the end of running-in") from None


def _test(one: Reduction) -> dict[str, object]:
    found, unit = one.test, UNITS[one.test.run_in_axis]
    low, high = found.interval
    return {
        "source": found.source,
        "friction": format_number(found.friction, 3),
        "interval": f"{format_number(low, 3)} to {format_number(high, 3)}",
        "run_in": f"{format_number(found.run_in_end, 4)} {unit}".strip(),
        "method": found.run_in_method,
        "axis": found.run_in_axis,
        "unit": unit,
        "flags": list(found.flags),
    }


def _trace(one: Reduction) -> Spec:
    """Return the figure of a test: friction with its extremes, the cut of running-in, the steady mean."""
    data, found = page_data(one), one.test
    unit = UNITS[found.run_in_axis]
    along, at = data["trace"].values.tolist(), found.run_in_end
    cut = {"color": VERMILION, "width": 2, "dash": "dash"}
    cut_words = {"text": "running-in ends", "textangle": -90}
    mean = {"x0": at, "x1": found.steady_end, "y0": found.friction, "y1": found.friction}
    label = f"{found.run_in_axis} [{unit}]" if unit else found.run_in_axis
    return {
        "data": [*_lines(along, data)],
        "layout": {
            "title": {"text": "", "font": {"size": 15}},
            "xaxis": {"title": {"text": label}, "zeroline": False},
            "yaxis": {"title": {"text": "friction [-]"}, "zeroline": False},
            "hovermode": "x unified",
            "margin": {"l": 60, "r": 20, "t": 20, "b": 50},
            "legend": {"orientation": "h", "y": -0.25},
            "shapes": [
                {"type": "line", "line": cut, "label": cut_words, **upright(at)},
                {"type": "line", "line": {"color": VERMILION, "width": 1.5}, **mean},
            ],
        },
        "cut": {"at": at, "unit": unit},
    }


def _lines(along: list[float], data: xr.Dataset) -> Iterator[Spec]:
    for name, words, look in (
        ("trace_low", "lowest", {"color": GREY, "width": 0.7}),
        ("trace_high", "highest", {"color": GREY, "width": 0.7}),
        ("trace_mean", "mean", {"color": BLUE, "width": 1.5}),
    ):
        yield {"x": along, "y": data[name].values.tolist(), "name": words, "mode": "lines", "line": look}
