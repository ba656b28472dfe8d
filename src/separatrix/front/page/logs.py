"""Routes of the logs of tribometers: drop them, correct how they are read, move the end of running-in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from separatrix.front.page.answers import body_of
from separatrix.front.page.drafts import Fault, faults_in
from separatrix.front.page.folder import LOGS, MAP, OF_LOG, Form, Page
from separatrix.front.page.worker import LOG
from separatrix.ground.errors import InputError
from separatrix.ground.files import is_inside
from separatrix.ground.toml import read_text

UNITS = {"time": "s", "distance": "m", "cycles": "cycles"}
"""Axis along which running-in is cut -> its unit."""


def routes(page: Page) -> APIRouter:
    """Return the routes of the logs."""
    router = APIRouter(default_response_class=HTMLResponse)

    @router.get("/logs")
    def logs() -> Response:
        return page.html("logs.html", names=page.folder.logs())

    @router.put("/logs/{name}")
    async def drop(name: str, request: Request) -> Response:
        await run_in_threadpool(_keep, page, name, await request.body())
        return page.html("log_list.html", names=page.folder.logs())

    @router.get("/log/{name}")
    def log(name: str) -> Response:
        return page.html("log.html", **_shown(page, name))

    @router.post("/map/{name}")
    def correct(name: str, sent: Form) -> Response:
        path = _map_of(page, name)
        path.write_text(sent.get("text", "").replace("\r\n", "\n"), encoding="utf-8", newline="\n")
        return page.html("map.html", **_map(page, name))

    @router.post("/reduce/{name}")
    def reduce(name: str, sent: Form) -> Response:
        path, columns = page.folder.log(name), _map_of(page, name)
        question: dict[str, object] = {"column_map": columns} if columns.exists() else {}
        if run_in := sent.get("run_in", "").strip():
            question["run_in"] = run_in
        page.jobs.ask(LOG, path, path.with_name(name + OF_LOG), name=name, question=question)
        return page.running()

    return router


def _keep(page: Page, name: str, content: bytes) -> None:
    """Keep a log that was dropped; one of the same name and content is there already."""
    place = page.folder.root / LOGS
    known = place / name
    if name in page.folder.logs() and known.read_bytes() == content:
        return
    path = page.folder.new(name, LOGS)
    place.mkdir(exist_ok=True)
    path.write_bytes(content)


def _map_of(page: Page, name: str) -> Path:
    path = page.folder.log(name).with_name(name + MAP)
    if not is_inside(path, page.folder.root):
        raise InputError(path.name, "leads out of the folder of the studies", cure="Remove this link.")
    return path


def _map(page: Page, name: str) -> dict[str, Any]:
    """Return the column map of a log with its faults; an empty text where the format needs none."""
    from separatrix.friction.logs.column_map import column_map_of

    path, faults = _map_of(page, name), tuple[Fault, ...]()
    text = read_text(path) if path.exists() else ""
    try:
        if text:
            column_map_of(text, path.name)
    except InputError as error:
        faults = faults_in(error, path.name, path.name)
    return {"name": name, "text": text, "faults": faults}


def _shown(page: Page, name: str) -> dict[str, Any]:
    answer = page.folder.log(name).with_name(name + OF_LOG) / f"{LOG}.json"
    found = page.loaded(answer)
    tests = found.get("tests") or [{}]
    shown = {"title": "", "subtitle": "", "body": "", "refused": ""}
    if page.folder.has(answer):
        shown = body_of(page, answer, LOG, name)
    return {**shown, **_map(page, name), "unit": UNITS.get(tests[0].get("run_in_axis", ""), "s")}
