"""Routes of the studies: the list, the text with the form beside it, and running a verb."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_args, get_origin

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from tomlkit.exceptions import TOMLKitError

from separatrix.front.page import drafts as draft
from separatrix.front.page.folder import Form, Page
from separatrix.front.page.form import as_typed, form
from separatrix.front.page.worker import REPORT
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable
from separatrix.study.study import BallModel, MotionModel, Study, shipped_studies
from separatrix.study.template import template
from separatrix.verbs import VERBS, verb_named

MODELS = {"motion": [one.value for one in MotionModel], "ball": [one.value for one in BallModel]}
"""Of a cage that moves: what may be chosen beside the study."""

CHANGED = "Another tab changed this study; its text is shown now. Make your change again."


def routes(page: Page) -> APIRouter:
    """Return the routes of the studies."""
    router = APIRouter(default_response_class=HTMLResponse)

    def edit_again(name: str, path: Path, problem: str = "") -> Response:
        return page.html("editor.html", **_editor(page, name, path, problem))

    @router.get("/")
    def studies() -> Response:
        rows = [
            {
                "name": name,
                "title": page.title(name),
                "answers": page.answered(name),
                "has_draft": draft.has_draft(page.folder.study(name)),
            }
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
        shown = _editor(page, name, page.folder.study(name))
        found = shown["checked"].study if shown["checked"] else None
        return page.html(
            "study.html",
            title=page.title(name),
            cards=_cards(found),
            tables=page.folder.tables(name),
            answers=page.answered(name),
            **shown,
        )

    @router.post("/edit/{name:path}")
    def edit(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        text, problem = draft.current_text(path), ""
        if sent.get("version") != draft.version_of(text):
            problem = CHANGED
        elif "text" in sent:
            draft.keep(path, sent["text"].replace("\r\n", "\n"))
        else:
            section, _, key = sent.get("field", "").partition(".")
            try:
                draft.keep(path, draft.edited(text, section, key, sent.get("value", "")))
            except InputError as error:
                problem = str(error)
            except TOMLKitError as error:  # TOML in an order that tomlkit does not take
                problem = f"The form cannot change this text: {error} {draft.MEND}"
        return edit_again(name, path, problem)

    @router.post("/save/{name:path}")
    def save(name: str) -> Response:
        path = page.folder.study(name)
        draft.save(path)
        return edit_again(name, path)

    @router.post("/discard/{name:path}")
    def discard(name: str) -> Response:
        path = page.folder.study(name)
        draft.draft_path(path).unlink(missing_ok=True)
        return edit_again(name, path)

    @router.post("/run/{name:path}")
    def run(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        verb = sent.get("verb", "")
        question = {} if verb == REPORT else asked(page, name, verb, sent)
        draft.save_to_run(path, page.folder.root)
        page.jobs.ask(verb, path, page.folder.answers(name), name=name, question=question)
        return page.running()

    router.get("/jobs")(page.running)

    @router.post("/jobs/{number}/cancel")
    def cancel(number: int) -> Response:
        page.jobs.cancel(number)
        return page.running()

    @router.post("/jobs/forget")
    def forget() -> Response:
        page.jobs.forget_ended()
        return page.running()

    @router.post("/jobs/{number}/resume")
    def resume(number: int) -> Response:
        job = page.jobs.job(number)
        if job is None:
            raise InputError("The job", "is no longer listed", cure="Run the verb again: it resumes too.")
        task = job.task
        page.jobs.ask(task.verb, task.study, task.folder, name=job.study, question=task.question)
        return page.running()

    return router


def _editor(page: Page, name: str, path: Path, problem: str = "") -> dict[str, Any]:
    """Return what the text and the form beside it show; nothing of a workbook, which is not `checked`."""
    checked = draft.check(path, page.folder.root) if path.suffix == ".toml" else None
    return {
        "name": name,
        "checked": checked,
        "sections": form(checked) if checked else (),
        "as_typed": as_typed,
        "problem": problem if checked else "",
        "has_draft": checked is not None and draft.has_draft(path),
    }


def _cards(study: Study | None) -> list[dict[str, Any]]:
    """Return each verb with its options, and the sections that it needs and the study lacks."""
    return [
        {
            "verb": verb,
            "help": VERBS[verb.name],
            "lacks": [one for one in verb.needs if study and getattr(study, one) is None],
            "options": {
                name: (_kind(hint), about, default)
                for name, (hint, about, default) in verb.shown_options().items()
            },
            "models": MODELS if verb.moves_a_cage else {},
        }
        for verb in map(verb_named, VERBS)
    ]


def _kind(hint: Any) -> str:
    """Return the kind of field for a type: flag, lines, file, number or text."""
    kinds = {get_origin(hint) or hint, *get_args(hint)}
    known = {bool: "flag", tuple: "lines", Path: "file", int: "number"}
    return next((kind for one, kind in known.items() if one in kinds), "text")


def asked(page: Page, study: str, verb: str, sent: Mapping[str, str]) -> dict[str, object]:
    """Return the options of a verb, and models, as a form gives them; empty ones have their defaults."""
    known = verb_named(verb)
    kinds = {name: _kind(hint) for name, (hint, *_) in known.shown_options().items()}
    kinds |= dict.fromkeys(MODELS, "text") if known.moves_a_cage else {}
    question: dict[str, object] = {}
    for name, kind in kinds.items():
        text = sent.get(name, "").strip()
        if not text:
            continue
        if kind == "number" and not re.fullmatch("-?[0-9]{1,9}", text):
            flag = f"--{name.replace('_', '-')}"
            raise InputError(flag, "must be a whole number", got=f'"{printable(text)}"')
        match kind:
            case "flag":
                question[name] = True
            case "lines":
                question[name] = tuple(line.strip() for line in text.splitlines() if line.strip())
            case "file":
                question[name] = page.folder.table(study, text)
            case "number":
                question[name] = int(text)
            case _:
                question[name] = text
    return question
