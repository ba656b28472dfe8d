"""Routes of the answers: pages, figures, files, a point of a map, and whether the study has changed."""

from __future__ import annotations

import io
import json
import re
import threading
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar
from urllib.parse import quote

import tomlkit
from fastapi import APIRouter
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, Response
from markupsafe import escape

from separatrix import __version__
from separatrix.front.page.folder import ANSWER_SUFFIXES, OF_LOG, Form, Page
from separatrix.front.page.worker import LOG
from separatrix.ground.document import part_of
from separatrix.ground.errors import InputError
from separatrix.ground.files import is_inside, reading_only_in
from separatrix.ground.plain_data import plain
from separatrix.ground.units import UNITS, format_number, shown
from separatrix.present import blocks, draw, html
from separatrix.present.hover import plotly
from separatrix.study.reading import read_study
from separatrix.study.sources import inputs_of, resolved
from separatrix.verbs import tool_named, verb_named
from separatrix.verbs.saved_answers import AGAIN, refusing_damage

Named = TypeVar("Named", blocks.Picture, blocks.View)

SHOWN_INLINE = {".png": "image/png", ".svg": "image/svg+xml", ".gif": "image/gif", ".txt": "text/plain"}
"""Files that the browser shows; all others it keeps."""

FRESH = {"cache-control": "no-cache"}
ONE_AT_A_TIME = threading.Lock()
"""Drawings: matplotlib's style is one for all threads."""

MOST_NAMED = 4
"""Inputs that a sentence names."""

_SCRIPT = re.compile(r'<script( type="module")?>(.*?)</script>', re.DOTALL)
_POLICY = re.compile(r'<meta http-equiv="Content-Security-Policy".*?>', re.DOTALL)


def routes(page: Page) -> APIRouter:
    """Return the routes of the answers."""
    router = APIRouter()

    def place_of(verb: str, name: str) -> Path:
        if verb == LOG:
            log = page.folder.log(name)
            return log.with_name(log.name + OF_LOG)
        return page.folder.answers(name)

    def file_of(verb: str, name: str) -> Path:
        path = place_of(verb, name) / f"{verb if verb == LOG else verb_named(verb).name}.json"
        if not page.folder.has(path):
            raise InputError(f"{name}: {verb}", "has no answer yet", cure="Run the verb.")
        return path

    def block(verb: str, name: str, of: str, kind: type[Named]) -> Named:
        for one in page_of(page, file_of(verb, name), verb).blocks:
            if isinstance(one, kind) and one.name == of:
                return one
        raise InputError(f"{name}: {verb}", f"has no {shown(of)}")

    @router.get("/answer/{verb}/{name:path}", response_class=HTMLResponse)
    def answer(verb: str, name: str) -> Response:
        file = file_of(verb, name)
        return page.html(
            "answer.html",
            name=name,
            verb=verb,
            point=verb == "map",
            changed=changed(page, name, page.loaded(file)),
            answers=page.answered(name),
            **body_of(page, file, verb, name),
        )

    @router.get("/figure/{verb}/{of}.{kind}/{name:path}")
    def figure(verb: str, of: str, kind: str, name: str) -> Response:
        with ONE_AT_A_TIME, refusing_damage(name):
            spec = block(verb, name, of, blocks.Picture).figure()
            if kind == "png":
                return Response(draw.png(spec), media_type="image/png", headers=FRESH)
            return JSONResponse(plotly(spec), headers=FRESH)

    @router.get("/view/{verb}/{of}/{name:path}", response_class=HTMLResponse)
    def view(verb: str, of: str, name: str, script: int | None = None) -> Response:
        with refusing_damage(name):
            text = block(verb, name, of, blocks.View).html()
        if script is not None:  # a script in the page itself would not run
            found = _SCRIPT.findall(text)[script : script + 1]
            return Response(found[0][1] if found else "", media_type="text/javascript")
        numbers = iter(range(text.count("<script")))
        text = _SCRIPT.sub(
            lambda one: f'<script{one[1] or ""} src="?script={next(numbers)}" defer></script>', text
        )
        head = '<head>\n<link rel="icon" href="/static/icon.svg">'
        return HTMLResponse(_POLICY.sub("", text).replace("<head>", head, 1))

    @router.get("/files/{name:path}", response_class=HTMLResponse)
    def files(name: str) -> Response:
        found = [(path.name, page.folder.name(path)) for path in _files(page, name)]
        return page.html("files.html", name=name, files=found, answers=page.answered(name))

    @router.get("/zip/{name:path}")
    def everything(name: str) -> Response:
        content = io.BytesIO()
        with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as into:
            for path in (page.folder.study(name), *_files(page, name)):
                into.write(path, page.folder.name(path))
        sent = f"attachment; filename*=UTF-8''{quote(Path(name).stem)}.zip"
        return Response(
            content.getvalue(), media_type="application/zip", headers={"content-disposition": sent}
        )

    @router.get("/file/{name:path}")
    def file(name: str) -> Response:
        path = page.folder.inside(name)
        if not path.is_file() or path.suffix not in ANSWER_SUFFIXES:
            raise InputError(shown(name), "is not a file of an answer")
        kind = SHOWN_INLINE.get(path.suffix)
        return FileResponse(path, media_type=kind, filename=None if kind else path.name)

    @router.post("/point/{name:path}", response_class=HTMLResponse)
    def point(name: str, sent: Form) -> Response:
        variant, question = at_point(page, name, page.loaded(file_of("map", name)), sent)
        place = page.folder.answers(variant)
        page.jobs.ask("simulate", page.folder.study(variant), place, name=variant, question=question)
        return page.running()

    return router


def _files(page: Page, name: str) -> list[Path]:
    place = page.folder.answers(name)
    found = sorted(place.iterdir()) if place.is_dir() and is_inside(place, page.folder.root) else ()
    return [path for path in found if path.suffix in ANSWER_SUFFIXES and page.folder.has(path)]


def page_of(page: Page, file: Path, verb: str) -> blocks.Page:
    """Return the page of a saved answer, interrupted or not."""
    name, found = page.folder.name(file), page.loaded(file)
    if not found:
        raise InputError(name, "is not a document of an answer", cure=AGAIN)
    with refusing_damage(name):
        return (tool_named(verb) if verb == LOG else verb_named(verb)).page(part_of(found, name))


def body_of(page: Page, file: Path, verb: str, name: str) -> dict[str, Any]:
    """Return title and body of an answer's page; of one that cannot be shown a line that names its file."""

    def picture(one: blocks.Picture) -> str:
        place = f"/figure/{verb}/{quote(one.name)}"
        return (
            f'<figure class="plot" data-source="{place}.json/{quote(name)}"><div class="canvas" role="group" '
            f'aria-label="{escape(one.caption)}"></div><figcaption>{html.inline(one.caption)} '
            f'<a href="{place}.png/{quote(name)}" download="{one.name}.png">PNG</a></figcaption></figure>'
        )

    def view(one: blocks.View) -> str:
        place = f"/view/{verb}/{quote(one.name)}/{quote(name)}"
        return f'<p><a class="button" href="{place}">{html.inline(one.caption)}</a></p>'

    try:
        with ONE_AT_A_TIME:
            found = page_of(page, file, verb)
            with refusing_damage(page.folder.name(file)):
                body = html.body(found, blocks.Level.REPORT, picture, view)
    except InputError as error:
        return {"title": "", "subtitle": "", "body": "", "refused": str(error)}
    return {"title": found.title, "subtitle": found.subtitle, "body": body, "refused": ""}


def changed(page: Page, name: str, document: Mapping[str, Any]) -> str:
    """Return in a sentence how the study differs from that of an answer; empty if it does not."""
    models = ((document.get("provenance") or {}).get("command") or {}).get("models") or {}
    try:
        with reading_only_in(page.folder.root):
            study = plain(resolved(read_study(page.folder.study(name), models)), "study")
        with refusing_damage(name):
            then, now = (inputs(one) for one in (document["study"], json.loads(json.dumps(study))))
    except InputError as error:
        return f"The study or this answer cannot be read: {(error.problems or (error,))[0]}"
    names = [key for key in {**then, **now} if then.get(key) != now.get(key)]
    if names:
        more = f" and {len(names) - MOST_NAMED} more" if names[MOST_NAMED:] else ""
        return (
            f"The study has changed after this answer: {', '.join(names[:MOST_NAMED])}{more}. Run it again."
        )
    version = document.get("separatrix_version")
    return "" if version == __version__ else f"This answer is of separatrix {version}, not {__version__}."


def inputs(study: Any) -> dict[str, object]:
    """Return what a resolved study states, by section and key, without the lines where it stands."""
    known: dict[str, object] = {
        f"[{section}] {key}": {part: one for part, one in entry.items() if part != "origin"}
        for section, key, entry in inputs_of(study)
    }
    ranking = study["ranking"] or {"candidates": ()}
    return known | {f"[ranking] {one['name']}": one for one in ranking["candidates"]}


def at_point(
    page: Page, name: str, found: Mapping[str, Any], sent: Mapping[str, str]
) -> tuple[str, dict[str, object]]:
    """Return the variant of a study at the point of its map that was clicked, and what is asked of it.

    The variant is a study of its own that extends the first; restitution factor and disturbance are options.
    """
    from separatrix.verdict.map_records import KICK, LONG, RESTITUTION

    axes = {
        found[way]["parameter"]: (_nearest(found[way]["values"], sent.get(way, "")), found[way]["unit"])
        for way in "xy"
    }
    cage = found["study"]["cage"]
    question: dict[str, object] = {one: str(cage[one]["value"]) for one in ("motion", "ball") if one in cage}
    words = [
        f"{key.rpartition('.')[2].replace('_', ' ')} {format_number(value, 4)}"
        for key, (value, _) in axes.items()
    ]
    question["kick"] = f"{axes.pop(KICK, (found['kick'], ''))[0]:.7g} m/s"
    if RESTITUTION in axes:
        question["restitution_factor"] = f"{axes.pop(RESTITUTION)[0]:.7g}"
    text = tomlkit.document()
    text["extends"], text["title"] = Path(name).name, f"{found['title']}: {', '.join(words)}"
    for key, (value, unit) in axes.items():
        *sections, last = LONG.get(key, key).split(".")
        table: Any = text
        for section in sections:
            table = table.setdefault(section, tomlkit.table())
        is_whole = value == round(value) and unit not in UNITS
        table[last] = (
            f"{value:.9g} {unit}" if unit in UNITS and unit != "-" else int(value) if is_whole else value
        )
    study = page.folder.study(name)
    file = f"{study.stem[:40]} {' '.join(words)}.toml"[:100]
    path = study.with_name(file)
    if not (page.folder.has(path) and path.read_text(encoding="utf-8") == tomlkit.dumps(text)):
        path = page.folder.new(
            file, page.folder.name(study.parent) if study.parent != page.folder.root else ""
        )
        path.write_text(tomlkit.dumps(text), encoding="utf-8", newline="\n")
    return page.folder.name(path), question


def _nearest(values: list[float], text: str) -> float:
    try:
        return min(values, key=lambda one: abs(one - float(text)))
    except ValueError:
        raise InputError("The point", "must have two numbers", got=shown(text)) from None
