"""Routes of the logs of tribometers: drop them, correct how they are read, move the end of running-in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from separatrix.friction.friction_file import UNITS
from separatrix.friction.logs.column_map import column_map_of
from separatrix.front.page.answers import body_of
from separatrix.front.page.editing import Fault, faults_in
from separatrix.front.page.folder import LOG, LOGS, MAP, Form, Page
from separatrix.ground.errors import InputError
from separatrix.ground.toml import read_text


def routes(page: Page) -> APIRouter:
    """Return the routes of the logs."""
    router = APIRouter(default_response_class=HTMLResponse)

    def map_path(name: str) -> Path:
        path = page.folder.log(name).with_name(name + MAP)
        page.folder.refuse_link_out(path)
        return path

    def map_of(name: str) -> dict[str, Any]:
        """Return the column map of a log with its faults; an empty text where the format needs none."""
        path, faults = map_path(name), tuple[Fault, ...]()
        text = read_text(path) if path.exists() else ""
        try:
            if text:
                column_map_of(text, path.name)
        except InputError as error:
            faults = faults_in(error, path.name, path.name)
        return {"name": name, "text": text, "faults": faults}

    def keep(name: str, content: bytes) -> None:
        """Keep a log that was dropped; one of the same name and content is there already."""
        if name in page.folder.logs() and page.folder.log(name).read_bytes() == content:
            return
        path = page.folder.new(name, LOGS)
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)

    @router.get("/logs")
    def logs() -> Response:
        return page.html("logs.html", names=page.folder.logs())

    @router.put("/logs/{name}")
    async def drop(name: str, request: Request) -> Response:
        await run_in_threadpool(keep, name, await request.body())
        return page.html("log_list.html", names=page.folder.logs())

    @router.get("/log/{name}")
    def log(name: str) -> Response:
        answer = page.folder.answers(name, LOG) / f"{LOG}.json"
        shown = {"title": "", "subtitle": "", "body": "", "refused": ""}
        if page.folder.has(answer):
            shown = body_of(page, LOG, name)
        tests = page.loaded(answer).get("tests") or [{}]
        unit = UNITS.get(tests[0].get("run_in_axis"), "s")
        return page.html("log.html", unit=unit, **shown, **map_of(name))

    @router.post("/map/{name}")
    def correct(name: str, sent: Form) -> Response:
        text = sent.get("text", "").replace("\r\n", "\n")
        map_path(name).write_text(text, encoding="utf-8", newline="\n")
        return page.html("map.html", **map_of(name))

    @router.post("/reduce/{name}")
    def reduce(name: str, sent: Form) -> Response:
        columns, run_in = map_path(name), sent.get("run_in", "").strip()
        question = {"column_map": columns if columns.exists() else None, "run_in": run_in or None}
        page.jobs.ask(LOG, name, question)
        return page.running()

    return router
