"""A study while it is edited: its text, one key changed in it, and what is wrong with it, key by key."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit import TOMLDocument
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Array, InlineTable, Item, Table

from separatrix.ground.errors import InputError, grouped
from separatrix.ground.files import is_inside, reading_only_in
from separatrix.ground.reader import document_of
from separatrix.ground.toml import MOST_BYTES, read_text
from separatrix.ground.units import NUMBER, shown
from separatrix.study.reading import read_study
from separatrix.study.study import Study
from separatrix.study.template import study_keys

DRAFT = ".{}.draft"
"""Name of the draft of a study, beside it: a server that is killed loses no edit."""

MEND = "Mend it in the text first."

_KEY = re.compile(r"\[(?P<section>[a-z]+)\](?: (?P<key>[a-z_]+))?")
_LINE = re.compile(r"line (\d+)")
_NUMBER = re.compile(rf"\s*{NUMBER}\s*")


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong: its line (0 if unknown), its key (empty texts for the file as a whole), words.

    `short` leaves out where it is.
    """

    line: int
    section: str
    key: str
    message: str
    short: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Checked:
    """A text, the study that it makes (None if it is refused), its faults, and the notes of a sound one."""

    text: str
    study: Study | None
    faults: tuple[Fault, ...]
    notes: tuple[str, ...] = ()
    inherited: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    """Values by section and key, those of the file that it extends among them."""

    @property
    def version(self) -> str:
        """Which text it is: a tab that has another one edits an older state."""
        return version_of(self.text)

    def faults_of(self, section: str, key: str) -> tuple[str, ...]:
        """Return the messages about one key."""
        return tuple(one.message for one in self.faults if (one.section, one.key) == (section, key))


def version_of(text: str) -> str:
    """Return a checksum of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def draft_path(study: Path) -> Path:
    """Return where the draft of a study is kept."""
    return study.with_name(DRAFT.format(study.name))


def has_draft(study: Path) -> bool:
    """Whether a study has a draft; a link that leads out of its folder is none."""
    draft = draft_path(study)
    return draft.is_file() and is_inside(draft, study.parent)


def current_text(study: Path) -> str:
    """Return the draft of a study, or the study if it has none."""
    return read_text(draft_path(study) if has_draft(study) else study)


def keep(study: Path, text: str) -> None:
    """Keep a text as the draft of a study; one like the study itself is none."""
    if len(text.encode()) > MOST_BYTES:
        raise InputError(study.name, f"is larger than a study can be, {MOST_BYTES // 1024} kB")
    if not has_draft(study):
        draft_path(study).unlink(missing_ok=True)  # a link in its place
    if study.is_file() and text == read_text(study):
        draft_path(study).unlink(missing_ok=True)
    else:
        draft_path(study).write_text(text, encoding="utf-8", newline="\n")


def save(study: Path) -> None:
    """Put the draft in the place of the study."""
    if has_draft(study):
        draft_path(study).replace(study)


def save_to_run(study: Path, root: Path) -> None:
    """Put the draft in the place of a study that is to be computed; one with faults is refused."""
    if study.suffix == ".toml" and (faults := check(study, root).faults):
        raise InputError(study.name, f"is not run: {faults[0].message}")
    save(study)


def check(study: Path, root: Path) -> Checked:
    """Read the draft of a study as every verb would, without files outside `root`."""
    path = draft_path(study) if has_draft(study) else study
    text, inherited = "", dict[str, dict[str, object]]()
    try:
        text = read_text(path)
        inherited = _inherited(path, root)
        with reading_only_in(root):
            found = read_study(path)
    except InputError as error:
        faults = faults_in(error, study.name, path.name)
        return Checked(text=text, study=None, faults=faults, inherited=inherited)
    return Checked(text=text, study=found, faults=(), notes=tuple(grouped(found.notes)), inherited=inherited)


def _inherited(path: Path, root: Path) -> dict[str, dict[str, object]]:
    """Return what a study that extends another has, by section and key; nothing of another study."""
    try:
        with reading_only_in(root):
            data = document_of(Study, path).data
    except InputError:  # shown among the faults
        return {}
    top = {key: value for key, value in data.items() if not isinstance(value, dict)}
    sections = {key: value for key, value in data.items() if isinstance(value, dict)}
    return {"": top} | sections if "extends" in data else {}


def faults_in(error: InputError, name: str, label: str) -> tuple[Fault, ...]:
    """Return the faults of a file, which the messages call by a name in place of its label."""
    faults = []
    for one in error.problems or (error,):
        at, line = _KEY.search(one.path), _LINE.search(one.path)
        section, key = (at["section"], at["key"] or "") if at else ("", "")
        message, short = str(one).replace(label, name), str(one.at("")).strip()
        message = message.removeprefix(f"{name}, line {line[1]}: ") if line else message
        faults.append(Fault(int(line[1]) if line else 0, section, key, message, short))
    return tuple(faults)


def edited(text: str, section: str, key: str, value: str) -> str:
    """Return the text with one key set as a form gives it, comments kept; an empty value removes the key.

    Parameters
    ----------
    text : str
        Of a study file.
    section, key : str
        Of the study; an empty section is above the first one.
    value : str
        As typed: a number, a quantity, a word, or a list or table as TOML writes it.
    """
    document = parsed(text)
    if section and section not in document:
        document.add(section, tomlkit.table())
    table = document[section] if section else document
    if not isinstance(table, MutableMapping):
        raise InputError(f"[{section}]", "is not a section", cure=MEND)
    if not value.strip():
        if key in table:
            del table[key]
    else:
        is_name = any(one.is_name for one in study_keys(section) if one.name == key)
        _put(table, key, _typed(value, is_name=is_name))
    return tomlkit.dumps(document)


def parsed(text: str) -> TOMLDocument:
    """Return the document of a text, with its comments; what is not TOML is refused."""
    try:
        return tomlkit.parse(text)
    except (TOMLKitError, RecursionError) as error:
        raise InputError("The text", f"is not valid TOML: {error}", cure=MEND) from None


def _put(table: MutableMapping[str, Any], key: str, value: object) -> None:
    """Set a key; comments behind its old value and in its old list stay."""
    old = table.get(key)
    if isinstance(old, Array) and isinstance(value, list) and _same_list(old, value):
        return
    new = tomlkit.item(value)
    if isinstance(value, dict) and not isinstance(old, Table):
        new = tomlkit.inline_table()
        new.update(value)
    if isinstance(old, Item) and old.trivia.comment and not isinstance(new, Table):
        new.trivia.comment_ws, new.trivia.comment = old.trivia.comment_ws, old.trivia.comment
    if key in table or not isinstance(table, Table | InlineTable):
        table[key] = new
        return
    body, behind = table.value.body, []
    while body and body[-1][0] is None:  # comments at the end are about what follows
        behind.append(body.pop())
    table.append(key, new)
    body.extend(reversed(behind))


def _same_list(old: Array, value: list[object]) -> bool:
    """Make a list another one by removing and adding items; return whether that was enough."""
    for item in [item for item in old.unwrap() if item not in value]:
        old.remove(item)
    for item in value[len(old) :]:
        old.append(item)
    return bool(old.unwrap() == value)


def _typed(value: str, *, is_name: bool = False) -> object:
    """Return a value of a form as TOML has it: a number unless it is a name, a list or table, else text."""
    value = value.strip()
    if not is_name and _NUMBER.fullmatch(value):
        return float(value) if re.search(r"[.eE]", value) else int(value)
    if value[0] in "[{":
        try:
            found: object = tomllib.loads(f"value = {value}")["value"]
            return found
        except (ValueError, RecursionError):
            raise InputError(shown(value), "is not a list or table of TOML") from None
    return value
