"""Routes of the answers, to studies and to logs: pages, figures, files, a point of a map, changed studies."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import quote
from zipfile import ZIP_DEFLATED, ZipFile

from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, Response

from separatrix.friction.friction_file import UNITS
from separatrix.friction.logs.column_map import column_map_of
from separatrix.front.page.editing import Fault, faults_in
from separatrix.front.page.folder import LOG, LOGS, MAP, Body, Form, Page
from separatrix.ground.errors import InputError
from separatrix.ground.files import reading_only_in
from separatrix.ground.toml import read_text
from separatrix.ground.units import shown
from separatrix.present import blocks, html
from separatrix.study.reading import read_study
from separatrix.verbs import VERBS, tool_named, verb_named
from separatrix.verbs.answer_files import AGAIN, asked_by, page_of_document, refusing_damage
from separatrix.verbs.map import at_point
from separatrix.verbs.parts.answer_page import is_chosen
from separatrix.verbs.report import differing
from separatrix.verdict.long_jobs import NAME as LEDGER

Named = TypeVar("Named", blocks.Picture, blocks.View)
EMPTY = dict.fromkeys(("title", "subtitle", "body", "refused"), "")
"""What a template shows of an answer."""

_SCRIPT = re.compile(r'<script( type="module")?>(.*?)</script>', re.DOTALL)
_POLICY = re.compile(r'<meta http-equiv="Content-Security-Policy".*?>', re.DOTALL)


def routes(page: Page) -> APIRouter:
    """Return the routes of the answers."""
    router = APIRouter(default_response_class=HTMLResponse)

    def block(verb: str, name: str, of: str, kind: type[Named]) -> Named:
        for one in page_of(page, verb, name).blocks:
            if isinstance(one, kind) and one.name == of:
                return one
        raise InputError(f"{name}: {verb}", f"has no {shown(of)}")

    @router.get("/answer/{verb}/{name:path}")
    def answer(verb: str, name: str) -> Response:
        known: dict[str, Any] = {"name": name, "verb": verb, "answers": page.answered(name)}
        known["changed"] = changed(page, name, page.loaded(file_of(page, verb, name)))
        return page.html("answer.html", **known, **body_of(page, verb, name))

    @router.get("/figure/{verb}/{of}/{name:path}")
    def figure(verb: str, of: str, name: str) -> Response:
        with refusing_damage(name):
            drawn = html.drawn(block(verb, name, of, blocks.Picture))
        return HTMLResponse(drawn, headers={"cache-control": "no-cache"})

    @router.get("/view/{verb}/{of}/{name:path}")
    def view(verb: str, of: str, name: str, script: str = "") -> Response:
        with refusing_damage(name):
            text = block(verb, name, of, blocks.View).html()
        scripts = {str(one.start()): one for one in _SCRIPT.finditer(text)}
        if script in scripts:  # in the page itself it would not run
            return Response(scripts[script][2], media_type="text/javascript")
        text = _SCRIPT.sub(
            lambda one: f'<script{one[1] or ""} src="?script={one.start()}" defer></script>', text
        )
        head = '<head>\n<link rel="icon" href="/static/icon.svg">'
        return HTMLResponse(_POLICY.sub("", text).replace("<head>", head, 1))

    def files_of(name: str) -> list[tuple[str, str]]:
        known = (one for one in page.folder.answers(name).glob("[!.]*") if one.name != LEDGER)
        return [(path.name, page.folder.name(path)) for path in sorted(known) if page.folder.has(path)]

    @router.get("/files/{name:path}")
    def files(name: str) -> Response:
        return page.html("files.html", name=name, files=files_of(name), answers=page.answered(name))

    @router.get("/zip/{name:path}")
    def everything(name: str) -> Response:
        with ZipFile(content := BytesIO(), "w", ZIP_DEFLATED) as into:
            for one in (name, *(path for _, path in files_of(name))):
                into.write(page.folder.inside(one), one)
        return Response(content.getvalue(), media_type="application/zip")

    @router.get("/file/{name:path}")
    def file(name: str) -> Response:
        path = page.folder.inside(name)
        return FileResponse(path, filename=path.name)

    @router.post("/point/{name:path}")
    def point(name: str, sent: Form) -> Response:
        study, found = page.folder.study(name), page.loaded(file_of(page, "map", name))
        try:
            x, y = (float(sent.get(way, "")) for way in "xy")
        except ValueError:
            raise InputError("The point", "must have two numbers", got=shown(sent)) from None
        with refusing_damage(name):
            words, text, question = at_point(found, study.name, x, y)
        path = study.with_name(f"{study.stem[:40]} {words.replace(',', '')}.toml"[:100])
        if not (page.folder.has(path) and path.read_text(encoding="utf-8") == text):
            path = page.folder.new(path.name, page.folder.name(path.parent))
            path.write_text(text, encoding="utf-8", newline="\n")
        page.jobs.ask("simulate", page.folder.name(path), question)
        return page.running()

    return router


def routes_of_logs(page: Page) -> APIRouter:
    """Return the routes of logs: drop them, correct how they are read, move the end of running-in."""
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

    @router.put("/logs/{name}")
    def drop(name: str, content: Body) -> Response:
        """Keep a log that was dropped; one of the same name and content is there already."""
        if name not in page.folder.logs() or page.folder.log(name).read_bytes() != content:
            path = page.folder.new(name, LOGS)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content)
        return page.html("log_list.html", names=page.folder.logs())

    @router.get("/logs")
    def logs() -> Response:
        return page.html("logs.html", names=page.folder.logs())

    @router.get("/log/{name}")
    def log(name: str) -> Response:
        answer = page.folder.answers(name, LOG) / f"{LOG}.json"
        body = body_of(page, LOG, name) if page.folder.has(answer) else EMPTY
        tests = page.loaded(answer).get("tests") or [{}]
        unit = UNITS.get(tests[0].get("run_in_axis"), "s")
        return page.html("log.html", unit=unit, **body, **map_of(name))

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


def file_of(page: Page, verb: str, name: str) -> Path:
    """Return the file of a saved answer; one that is not there is refused."""
    path = page.folder.answers(name, verb) / f"{verb}.json"
    if verb not in (*VERBS, LOG) or not page.folder.has(path):
        raise InputError(f"{name}: {verb}", "has no answer yet", cure="Run the verb.")
    return path


def page_of(page: Page, verb: str, name: str) -> blocks.Page:
    """Return the page of a saved answer, interrupted or not; a damaged one is refused with its file."""
    file = file_of(page, verb, name)
    where, found = page.folder.name(file), page.loaded(file)
    if not found:
        raise InputError(where, "is not a document of an answer", cure=AGAIN)
    asked = tool_named(LOG) if verb == LOG else verb_named(verb)
    return page_of_document(asked, found, where)


def body_of(page: Page, verb: str, name: str) -> dict[str, Any]:
    """Return title and body of an answer's page; of one that cannot be shown a line that names its file."""

    def picture(one: blocks.Picture) -> str:
        place = f"/figure/{verb}/{quote(one.name)}/{quote(name)}"
        caption = f"<figcaption>{html.inline(one.caption)}</figcaption>"
        return f'<figure hx-get="{place}" hx-trigger="load" hx-swap="outerHTML">{caption}</figure>'

    def view(one: blocks.View) -> str:
        place = f"/view/{verb}/{quote(one.name)}/{quote(name)}"
        return f'<p><a class="button" href="{place}">{html.inline(one.caption)}</a></p>'

    try:
        found = page_of(page, verb, name)
        with refusing_damage(page.folder.name(file_of(page, verb, name))):
            body = html.body(found, blocks.Level.REPORT, picture, view)
    except InputError as error:
        return EMPTY | {"refused": str(error)}
    return EMPTY | {"title": found.title, "subtitle": found.subtitle, "body": body}


def changed(page: Page, name: str, found: dict[str, Any]) -> str:
    """Return in a sentence how the study differs from that of an answer; empty if it does not."""
    try:
        with reading_only_in(page.folder.root), refusing_damage(name):
            known = (found["study"]["cage"] or {}).get("model", {})
            model = known["value"] if is_chosen(known) else None
            names = differing(found, asked_by(read_study(page.folder.study(name), model)))
    except InputError as error:
        return f"The study or this answer cannot be read: {(error.problems or (error,))[0]}"
    return f"Changed after this answer: {names}. Run it again." if names else ""
