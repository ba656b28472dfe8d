"""Routes of the studies: the list, the text with the form beside it, and running a verb."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args, get_origin

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, RedirectResponse, Response

from separatrix.front.page import drafts as draft
from separatrix.front.page.folder import REPORT, Form, Page
from separatrix.ground.errors import InputError
from separatrix.ground.units import shown
from separatrix.study.study import CageModel, shipped_studies
from separatrix.study.template import template
from separatrix.verbs import VERBS, verb_named

CHANGED = "Another tab changed this study; its text is shown now. Make your change again."


def routes(page: Page) -> APIRouter:
    """Return the routes of the studies."""
    router = APIRouter(default_response_class=HTMLResponse)

    def editor(name: str, problem: str = "", template: str = "editor.html", **more: object) -> Response:
        """Return the text and the form beside it; nothing of a workbook, which is not `checked`."""
        path = page.folder.study(name)
        checked = draft.check(path, page.folder.root) if path.suffix == ".toml" else None
        return page.html(
            template,
            name=name,
            checked=checked,
            version=draft.version_of(checked.text) if checked else "",
            sections=[*draft.form(checked)] if checked else (),
            as_typed=draft.as_typed,
            problem=problem,
            has_draft=draft.has_draft(path),
            **more,
        )

    @router.get("/")
    def studies() -> Response:
        rows = [
            (name, page.title(name), page.answered(name), draft.has_draft(page.folder.study(name)))
            for name in page.folder.studies()
        ]
        return page.html("studies.html", rows=rows, shipped=sorted(shipped_studies()))

    @router.post("/new")
    def new(sent: Form) -> Response:
        name = f"{sent.get('name', '').strip().removesuffix('.toml')}.toml"
        path, base = page.folder.new(name), shipped_studies().get(sent.get("base", ""))
        text = template() if base is None else base.read_text(encoding="utf-8")
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
        return RedirectResponse(f"/study/{page.folder.name(path)}", status_code=303)

    @router.get("/study/{name:path}")
    def study(name: str) -> Response:
        return editor(
            name,
            template="study.html",
            title=page.title(name),
            verbs=[verb_named(verb) for verb in VERBS],
            kind_of=kind_of,
            models=[one.value for one in CageModel],
            tables=page.folder.tables(name),
            answers=page.answered(name),
        )

    @router.post("/edit/{name:path}")
    def edit(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        text = draft.current_text(path)
        if sent.get("version") != draft.version_of(text):
            return editor(name, CHANGED)
        try:
            if "text" in sent:
                text = sent["text"].replace("\r\n", "\n")
            else:
                section, _, key = sent.get("field", "").partition(".")
                text = draft.edited(text, section, key, sent.get("value", ""))
            draft.keep(path, text)
        except InputError as error:
            return editor(name, str(error))
        return editor(name)

    @router.post("/save/{name:path}")
    def save(name: str) -> Response:
        draft.save(page.folder.study(name))
        return editor(name)

    @router.post("/discard/{name:path}")
    def discard(name: str) -> Response:
        draft.draft_path(page.folder.study(name)).unlink(missing_ok=True)
        return editor(name)

    @router.post("/run/{name:path}")
    def run(name: str, sent: Form) -> Response:
        verb = sent.get("verb", "")
        question = {} if verb == REPORT else asked(page, name, verb, sent)
        draft.save_to_run(page.folder.study(name), page.folder.root)
        page.jobs.ask(verb, name, question)
        return page.running()

    router.get("/jobs")(page.running)

    @router.post("/jobs/forget")
    def forget() -> Response:
        page.jobs.forget_ended()
        return page.running()

    @router.post("/jobs/{number:int}/cancel")
    def cancel(number: int) -> Response:
        page.jobs.cancel(number)
        return page.running()

    @router.post("/jobs/{number:int}/resume")
    def resume(number: int) -> Response:
        page.jobs.resume(number)
        return page.running()

    return router


def kind_of(hint: Any) -> str:
    """Return the kind of field for a type: flag, lines, file, number or text."""
    kinds = {get_origin(hint) or hint, *get_args(hint)}
    known = {bool: "flag", tuple: "lines", Path: "file", int: "number"}
    return next((kind for one, kind in known.items() if one in kinds), "text")


def asked(page: Page, study: str, verb: str, sent: Mapping[str, str]) -> dict[str, object]:
    """Return the options of a verb, and the model, as a form gives them; empty ones have their defaults."""
    known = verb_named(verb)
    kinds = {name: kind_of(hint) for name, (hint, *_) in known.shown_options().items()}
    kinds |= {"model": "text"} if known.moves_a_cage else {}
    question: dict[str, object] = {}
    for name, text in ((name, sent.get(name, "").strip()) for name in kinds):
        match text and kinds[name]:
            case "flag":
                question[name] = True
            case "lines":
                question[name] = tuple(line.strip() for line in text.splitlines() if line.strip())
            case "file":
                question[name] = page.folder.table(study, text)
            case "number" if re.fullmatch("-?[0-9]{1,9}", text):
                question[name] = int(text)
            case "number":
                flag = f"--{name.replace('_', '-')}"
                raise InputError(flag, "must be a whole number", got=shown(text))
            case "text":
                question[name] = text
    return question
