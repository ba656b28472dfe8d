"""Routes of the studies: the list, the form with the text beside it, and running a verb."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi import APIRouter
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from tomlkit.exceptions import TOMLKitError

from separatrix.front.page import drafts as draft
from separatrix.front.page.folder import Form, Page
from separatrix.front.page.form import as_typed, form
from separatrix.ground.errors import InputError
from separatrix.ground.units import printable
from separatrix.study.study import BallModel, MotionModel, Study, shipped_studies
from separatrix.study.template import template
from separatrix.verbs import VERBS, Verb, verb_named

TYPED = {"points": int, "runs": int, "run": int, "samples": int}
"""Options that are whole numbers."""

CHANGED = "Another tab changed this study; its text is shown now. Make your change again."


def routes(page: Page) -> APIRouter:
    """Return the routes of the studies."""
    router = APIRouter(default_response_class=HTMLResponse)

    def edit_again(name: str, path: Path, problem: str = "") -> Response:
        checked = draft.check(path, page.folder.root) if path.suffix == ".toml" else None
        return page.html("editor.html", **_editor(name, path, checked, problem))

    def all_jobs() -> Response:
        return page.html("jobs.html", jobs=page.jobs.all())

    @router.get("/")
    def studies() -> Response:
        rows = [_summary(page, name) for name in page.folder.studies()]
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
        path = page.folder.study(name)
        checked = draft.check(path, page.folder.root) if path.suffix == ".toml" else None
        shown = {**_editor(name, path, checked), **_running(page, name, checked.study if checked else None)}
        return page.html("study.html", title=page.title(name), **shown)

    @router.post("/edit/{name:path}")
    def edit(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        text, problem = draft.current_text(path), ""
        if sent.get("version") != draft.version_of(text):
            problem = CHANGED
        elif "text" in sent:
            draft.keep(path, sent["text"].replace("\r\n", "\n"))
        else:
            try:
                draft.keep(path, edited_by(text, sent))
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
        path, verb = page.folder.study(name), verb_named(sent.get("verb", ""))
        draft.save_to_run(path, page.folder.root)
        place = page.folder.answers(name)
        page.jobs.ask(verb.name, path, place, name=name, question=_question(page, name, verb, sent))
        return all_jobs()

    router.get("/jobs")(all_jobs)

    @router.post("/jobs/{number}/cancel")
    def cancel(number: int) -> Response:
        page.jobs.cancel(number)
        return all_jobs()

    @router.post("/jobs/forget")
    def forget() -> Response:
        page.jobs.forget_ended()
        return all_jobs()

    @router.post("/jobs/{number}/resume")
    def resume(number: int) -> Response:
        job = page.jobs.job(number)
        if job is None:
            raise InputError("The job", "is no longer listed", cure="Run the verb again: it resumes too.")
        task = job.task
        page.jobs.ask(task.verb, task.study, task.folder, name=job.study, question=task.question)
        return all_jobs()

    return router


def edited_by(text: str, sent: dict[str, str]) -> str:
    """Return the text of a study with what one part of the form changes in it."""
    value = draft.with_unit(sent.get("value", ""), sent.get("unit", ""))
    section, _, key = sent.get("field", "").rpartition(".")
    if ticked := [value for name, value in sent.items() if name.startswith("box-")]:
        given = draft.parsed(text).unwrap().get(section, {}).get(key, [])  # its order is that of the answer
        kept = [one for one in given if one in ticked]
        value = as_typed([*kept, *(one for one in ticked if one not in kept)])
    return draft.edited(text, section, key, value)


def _summary(page: Page, name: str) -> dict[str, object]:
    place, answers = page.folder.answers(name), page.answered(name)
    ranked = page.document(place, "rank") or {}
    overall = ranked.get("overall") or []
    counts = {
        verdict: sum(row.get("verdict") == verdict for row in overall) for verdict in ("STABLE", "UNSTABLE")
    }
    best = next((row["name"] for row in overall if row.get("rank") == 1), None)
    return {
        "name": name,
        "title": page.title(name) or ranked.get("title", ""),
        "answers": answers,
        "best": best,
        "counts": counts,
        "count": len(overall),
        "has_draft": draft.has_draft(page.folder.study(name)),
    }


def _editor(name: str, path: Path, checked: draft.Checked | None, problem: str = "") -> dict[str, object]:
    """Return what the form and the text beside it show; nothing of a workbook, which is not `checked`."""
    return {
        "name": name,
        "checked": checked,
        "sections": form(checked) if checked else (),
        "problem": problem if checked else "",
        "has_draft": checked is not None and draft.has_draft(path),
    }


def _running(page: Page, name: str, found: Study | None) -> dict[str, object]:
    """Return what the panel of verbs shows; `lacking` are sections that a verb needs and a study lacks."""
    lacking = {
        verb.name: [section for section in verb.needs if found and getattr(found, section) is None]
        for verb in VERBS
    }
    return {
        "verbs": VERBS,
        "lacking": lacking,
        "answers": page.answered(name),
        "jobs": page.jobs.all(),
        "motions": [one.value for one in MotionModel],
        "tables": page.folder.tables(name),
        "balls": [one.value for one in BallModel],
    }


def _question(page: Page, study: str, verb: Verb, sent: dict[str, str]) -> dict[str, object]:
    """Return the options of a verb of a study as a form gives them; empty ones have their defaults."""
    question: dict[str, object] = {}
    for name in (*verb.question, *(("motion", "ball") if verb.moves_a_cage else ())):
        text = sent.get(name, "").strip()
        if not text or name == "animate":
            continue
        if name == "vary":
            question[name] = tuple(line.strip() for line in text.splitlines() if line.strip())
        elif name == "cases":
            question[name] = page.folder.table(study, text)
        elif name in ("adaptive", "verdicts", "margins"):
            question[name] = True
        elif name in TYPED:
            if not re.fullmatch("[0-9]{1,9}", text):
                raise InputError(f"--{name}", "must be a whole number", got=f'"{printable(text)}"')
            question[name] = int(text)
        else:
            question[name] = text
    return question
