"""A study while it is edited: its text and form, what is wrong with it, one key changed, and its routes."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Iterator, Mapping, MutableMapping
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any, Literal, NamedTuple

import tomlkit
from fastapi import APIRouter
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Array, Table

from separatrix.front.cli import asked_of, flag_of, option_value
from separatrix.front.page.folder import REPORT, Form, Page
from separatrix.ground.errors import InputError, grouped
from separatrix.ground.files import is_inside, reading_only_in, staged, write_new
from separatrix.ground.reader import document_of
from separatrix.ground.toml import MOST_BYTES, read_text
from separatrix.ground.units import NUMBER, shown
from separatrix.present import blocks
from separatrix.study.reading import read_study
from separatrix.study.study import ORDER, Study, shipped_studies
from separatrix.study.template import StudyKey, remark_of, study_keys, template
from separatrix.verbs import VERBS, verb_named
from separatrix.verbs.verb import kind_of

CHANGED = "Another tab changed this study; its text is shown now. Make your change again."
MEND = "Mend it in the text first."


class Fault(NamedTuple):
    """One thing that is wrong: its line (0 if unknown), its key (empty texts for the file as a whole), words.

    `short` leaves out where it is.
    """

    line: int
    section: str
    key: str
    message: str
    short: str


class Checked(NamedTuple):
    """A text, the study that it makes (None if it is refused), its faults, and the notes of a sound one."""

    text: str
    study: Study | None = None
    faults: tuple[Fault, ...] = ()
    notes: tuple[str, ...] = ()
    inherited: Mapping[str, Any] = {}
    """Its content over that of the file that it extends."""


# ---- the draft, beside the study: a server that is killed loses no edit


def draft_path(study: Path) -> Path:
    """Return where the draft of a study is kept."""
    return study.with_name(f".{study.name}.draft")


def current(study: Path) -> Path:
    """Return the draft of a study, or the study if it has none; a link out of its folder is none."""
    draft = draft_path(study)
    return draft if draft.is_file() and is_inside(draft, study.parent) else study


def version_of(text: str) -> str:
    """Return a checksum of a text: a tab that has another one edits an older state."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def keep(study: Path, text: str) -> None:
    """Keep a text as the draft of a study; one like the study itself is none."""
    if len(text.encode()) > MOST_BYTES:
        raise InputError(study.name, f"is larger than a study can be, {MOST_BYTES // 1024} kB")
    path = draft_path(study)
    if text == read_text(study):
        path.unlink(missing_ok=True)
        return
    with staged(path.parent) as stage:  # whole or not at all, and in place of a link
        (stage / path.name).write_text(text, encoding="utf-8", newline="\n")


# ---- what is wrong


def check(study: Path, root: Path) -> Checked:
    """Read the draft of a study as every verb would, without files outside `root`."""
    path, text, inherited = current(study), "", dict[str, Any]()
    try:
        text = read_text(path)
        with reading_only_in(root):
            with suppress(InputError):  # which the reading below meets, too
                inherited |= document_of(Study, path).data
            found = read_study(path)
    except InputError as error:
        return Checked(text=text, faults=faults_in(error, study.name, path.name), inherited=inherited)
    return Checked(text=text, study=found, notes=tuple(grouped(found.notes)), inherited=inherited)


def faults_in(error: InputError, name: str, label: str) -> tuple[Fault, ...]:
    """Return the faults of a file, which the messages call by a name in place of its label."""
    faults = []
    for one in error.problems or (error,):
        section, key = (*map(str, one.key[:2]), "", "")[:2]
        section, key = (section, key) if section in ORDER else ("", section)
        message = str(one).removeprefix(f"{label}, line {one.line}: ").replace(label, name)
        faults.append(Fault(one.line, section, key, message, str(one.at("")).strip()))
    return tuple(faults)


# ---- the form


class FormSection(NamedTuple):
    """A section of the form: values by key, those of the file that it extends, and messages by key."""

    name: str
    remark: str
    keys: tuple[StudyKey, ...]
    given: Mapping[str, Any]
    inherited: Mapping[str, Any]
    faults: Mapping[str, list[str]]


def form(checked: Checked) -> Iterator[FormSection]:
    """Yield the sections of the form of a text; without valid TOML its fields are empty."""
    data: dict[str, Any] = {}
    with suppress(ValueError, RecursionError):
        data = tomllib.loads(checked.text)
    for name in ("", *ORDER):
        faults = blocks.grouped((one.key, one.message) for one in checked.faults if one.section == name)
        values = (one.get(name) if name else one for one in (data, checked.inherited))
        given, inherited = (one if isinstance(one, Mapping) else {} for one in values)
        yield FormSection(name, remark_of(name), study_keys(name), given, inherited, faults)


def as_typed(value: object) -> str:
    """Return a value as it is typed into a field: text as it is, lists and tables as TOML has them."""
    if value is None or isinstance(value, str):
        return value or ""
    item: Any = tomlkit.inline_table() if isinstance(value, dict) else tomlkit.item(value)
    if isinstance(value, dict):
        item.update(value)
    return str(item.as_string())


# ---- one key changed


def edited(text: str, section: str, key: str, value: str) -> str:
    """Return the text with one key set as a form gives it, comments kept; an empty value removes the key.

    An empty section is above the first one. `InputError`: the text is not TOML, or comments would be lost.
    """
    try:
        document = tomlkit.parse(text)
        table = document.setdefault(section, tomlkit.table()) if section else document
        if not isinstance(table, MutableMapping):
            raise InputError(f"[{section}]", "is not a section", cure=MEND)
        is_name = any(one.is_name for one in study_keys(section) if one.name == key)
        _put(table, key, _typed(value.strip(), is_name=is_name))
        return tomlkit.dumps(document)
    except (TOMLKitError, RecursionError) as error:  # not TOML, or in an order that tomlkit does not take
        raise InputError("The form", f"cannot change this text: {error}", cure=MEND) from None


def _put(table: MutableMapping[str, Any], key: str, value: object) -> None:
    """Set a key, or remove it; a new one stands above comments at the end, which are about what follows."""
    old, behind = table.get(key), []
    if value is None:
        table.pop(key, None)
    if value in (None, old):
        return
    if isinstance(old, Array) and "#" in old.as_string():
        raise InputError(key, "has comments in its list", cure="Change it in the text.")
    body = table.value.body if isinstance(table, Table) and key not in table else []
    while body and body[-1][0] is None:
        behind.append(body.pop())
    table[key] = value
    body.extend(reversed(behind))


def _typed(value: str, *, is_name: bool) -> object:
    """Return a value of a form as TOML has it: a number unless it is a name, a list or table, else text."""
    if not is_name and re.fullmatch(NUMBER, value):
        return float(value) if re.search(r"[.eE]", value) else int(value)
    if value[:1] not in ("[", "{"):
        return value or None
    try:
        return tomlkit.value(value)
    except (TOMLKitError, RecursionError):
        raise InputError(shown(value), "is not a list or table of TOML") from None


# ---- the routes: the list of studies, the text with the form beside it, and running a verb


def routes(page: Page) -> APIRouter:
    """Return the routes of the studies."""
    router = APIRouter(default_response_class=HTMLResponse)

    def editor(name: str, problem: str = "", page_of: str = "editor.html", **more: Any) -> Response:
        """Return the text and the form beside it."""
        path = page.folder.study(name)
        checked = check(path, page.folder.root)
        more |= {"checked": checked, "version": version_of(checked.text), "sections": [*form(checked)]}
        more |= {"title": checked.inherited.get("title", "")}
        more |= {"as_typed": as_typed, "problem": problem, "has_draft": current(path) != path}
        return page.html(page_of, name=name, **more)

    @router.get("/")
    def studies() -> Response:
        paths = {name: page.folder.study(name) for name in page.folder.studies()}
        rows = [(one, page.title(one), page.answered(one), current(at) != at) for one, at in paths.items()]
        return page.html("studies.html", rows=rows, shipped=sorted(shipped_studies()))

    @router.post("/new")
    def new(sent: Form) -> Response:
        name = f"{sent.get('name', '').strip().removesuffix('.toml')}.toml"
        path, base = page.folder.new(name), shipped_studies().get(sent.get("base", ""))
        text = template() if base is None else base.read_text(encoding="utf-8")
        write_new(path, text.encode())
        return RedirectResponse(f"/study/{page.folder.name(path)}", status_code=303)

    @router.get("/study/{name:path}")
    def study(name: str) -> Response:
        verbs = [(verb := verb_named(one), asked_of(verb)) for one in VERBS]
        return editor(name, page_of="study.html", verbs=verbs, answers=page.answered(name))

    @router.post("/edit/{name:path}")
    def edit(name: str, sent: Form) -> Response:
        path = page.folder.study(name)
        text = read_text(current(path))
        if sent.get("version") != version_of(text):
            return editor(name, CHANGED)
        try:
            section, _, key = sent.get("field", "").partition(".")
            text = sent["text"] if "text" in sent else edited(text, section, key, sent.get("value", ""))
            keep(path, text.replace("\r\n", "\n"))
        except InputError as error:
            return editor(name, str(error))
        return editor(name)

    @router.post("/save/{name:path}")
    def save(name: str) -> Response:
        path = page.folder.study(name)
        current(path).replace(path)
        return editor(name)

    @router.post("/discard/{name:path}")
    def discard(name: str) -> Response:
        draft_path(page.folder.study(name)).unlink(missing_ok=True)
        return editor(name)

    @router.post("/run/{name:path}")
    def run(name: str, sent: Form) -> Response:
        verb = sent.get("verb", "")
        question = {} if verb == REPORT else asked(page, name, verb, sent)
        path = page.folder.study(name)
        if faults := check(path, page.folder.root).faults:
            raise InputError(path.name, f"is not run: {faults[0].message}")
        current(path).replace(path)
        page.jobs.ask(verb, name, question)
        return page.running()

    router.get("/jobs")(page.running)

    @router.post("/jobs/{number:int}/{change}")
    def change(number: int, change: Literal["cancel", "resume"]) -> Response:
        getattr(page.jobs, change)(number)
        return page.running()

    return router


def asked(page: Page, study: str, verb: str, sent: Mapping[str, str]) -> dict[str, object]:
    """Return the options of a verb, and the model, as a form gives them; empty ones have their defaults."""
    question: dict[str, object] = {}
    for name, (hint, note, _) in asked_of(verb_named(verb)).items():
        kind, text = kind_of(hint), sent.get(name, "").strip()
        found: Any = option_value(kind, text or None, flag_of(name, note), note)
        if kind == "texts":
            found = tuple(line.strip() for line in text.splitlines() if line.strip())
        elif kind == "file" and text:
            found = page.folder.inside(str(PurePosixPath(study).parent / text))
        if text:
            question[name] = True if kind == "flag" else found
    return question
