"""TOML files that people write: checked before they are parsed, every key with its line, values by readers.

A `Reader` takes a value and the name of its place, and returns what a record has, or raises InputError.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from enum import Enum
from pathlib import Path
from typing import TypeVar

from separatrix.ground.errors import InputError
from separatrix.ground.files import size_of, unreadable
from separatrix.ground.units import NUMBER, missing_unit, parse, printable, shown

Made = TypeVar("Made")
Choice = TypeVar("Choice", bound=Enum)
Reader = Callable[[object, str], Made]
KeyPath = tuple[str | int, ...]
"""Keys from the top of a file to a value; a number is the place in a list, from 0."""

MOST_BYTES = 256 * 1024
LONGEST_LINE = 4000
DEEPEST = 16
"""How deep brackets may nest; a study needs 3."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """Kind of a file: its name in refusals, and its largest size."""

    noun: str = "a study"
    most_bytes: int = MOST_BYTES
    empty: str = "`separatrix new PATH` writes a study to fill in."
    """The cure of an empty one."""

    shipped: Callable[[], Mapping[str, Path]] = dict
    """Files that `extends` may name without a path."""


STUDY = Kind()

_BESIDE = ("ring", "race", "land", "guided")
"""Words that may follow a choice."""

_KEY = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
DOTTED = rf"{_KEY}(?:[ \t]*\.[ \t]*{_KEY})*"
_KEY_LINE = re.compile(rf"\s*({DOTTED})[ \t]*=")
_HEADER = re.compile(rf"\s*(\[\[?)[ \t]*({DOTTED})[ \t]*\]")
_STRING_OR_COMMENT = re.compile(
    r'"""(?:\\.|[^\\])*?(?:"""|\Z)'
    r"|'''.*?(?:'''|\Z)"
    r'|"(?:\\.|[^"\\\n])*(?:"|$)'
    r"|'[^'\n]*(?:'|$)"
    r"|#[^\n]*",
    re.DOTALL | re.MULTILINE,
)


def label_of(path: Path) -> str:
    """Name of a file in messages and results: without its folder, on one line."""
    return printable(path.name or str(path))


def path_text(path: Path) -> str:
    """A path as the user wrote it, on one line; only its name if it is long."""
    text = printable(str(path), 200)
    return text if len(text) <= 80 else label_of(path)


def parsed(text: str, label: str, kind: Kind = STUDY) -> tuple[dict[str, object], dict[KeyPath, int]]:
    """Content of TOML text, and the line of each key."""
    begins, too_deep = _statements(text)
    if too_deep:
        raise _in_line(label, too_deep, f"nests brackets more than {DEEPEST} deep")
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _invalid_toml(error, text, label) from None
    if not data:
        raise InputError(label, "is empty", cure=kind.empty)
    return data, lines_of_keys(text, begins)


def lines_of_keys(text: str, begins: Iterable[int]) -> dict[KeyPath, int]:
    """Line of each key of valid TOML; what is inside a value has the line of the value."""
    found: dict[KeyPath, int] = {}
    items: dict[KeyPath, int] = {}
    prefix: KeyPath = ()
    lines = text.split("\n")
    for number in begins:
        line, path = lines[number - 1], prefix
        if header := _HEADER.match(line):
            path, parts = (), _plain(header[2])
            for depth, part in enumerate(parts, 1):
                path = (*path, part)
                if header[1] == "[[" and depth == len(parts):
                    items[path] = items.get(path, -1) + 1
                if path in items:  # below a list of tables: in the last of them
                    path = (*path, items[path])
                for length in range(len(prefix := path)):
                    found.setdefault(path[: length + 1], number)
        elif key := _KEY_LINE.match(line):
            for part in _plain(key[1])[:4]:
                path = (*path, part)
                found.setdefault(path, number)
    return found


def _statements(text: str) -> tuple[list[int], int]:
    """Numbers of the lines that begin a statement; and of the line that nests too deep, 0 if none does."""
    begins, number, depth = [1], 1, 0
    # a text or a comment without its content, its ends of lines marked as inside
    bare = _STRING_OR_COMMENT.sub(lambda match: "\0" * match[0].count("\n"), text)
    for mark in re.findall(r"[\[{\]}\n\0]", bare):
        depth = max(0, depth + (mark in "[{") - (mark in "]}"))
        if depth > DEEPEST:
            return begins, number
        number += mark in "\n\0"
        if mark == "\n" and depth == 0:
            begins.append(number)
    return begins, 0


def _plain(dotted: str) -> list[str]:
    return [part.strip("\"'") for part in re.findall(_KEY, dotted)]


def read_text(path: Path, kind: Kind = STUDY) -> str:
    """Text of a regular file, small enough for its kind, in UTF-8, without NUL or endless lines."""
    label = label_of(path)
    size_of(path, path_text(path))
    try:
        with path.open("rb") as file:
            raw = file.read(kind.most_bytes + 1)
    except OSError as error:
        raise unreadable(path_text(path), error) from None
    if len(raw) > kind.most_bytes:
        raise InputError(label, f"is larger than {kind.noun} can be, {kind.most_bytes // 1024} kB")
    if raw.startswith(b"PK"):
        raise InputError(label, f"is a workbook or another zip file: {kind.noun} is text", cure=kind.empty)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise _in_line(label, line, "is not UTF-8 text", cure="Save the file as UTF-8.") from None
    for number, content in enumerate(text.split("\n"), 1):
        if "\0" in content:
            raise _in_line(label, number, "contains a NUL character: this is not a text file")
        if len(content) > LONGEST_LINE:
            raise _in_line(label, number, f"is longer than {LONGEST_LINE} characters")
    return text


def _invalid_toml(error: Exception, text: str, label: str) -> InputError:
    message = printable(str(error), 300)
    found = re.search(r" \(at line (\d+), column \d+\)", message)
    if not found:
        rule = "is not valid TOML: it ends inside a quotation or a bracket"
        return InputError(label, rule if "end of document" in message else "is not valid TOML")
    number = int(found[1])
    line = text.split("\n")[number - 1].strip()
    if "overwrite" in message or "twice" in message:
        key = _KEY_LINE.match(line)
        name = printable(".".join(_plain(key[1]))) if key else shown(line)
        return _in_line(label, number, f"has {name} a second time")
    reason = message[: found.start()]
    rule = f"is not valid TOML: {reason[:1].lower()}{reason[1:]}"[:120]
    return _in_line(label, number, rule, printable(line), _cure(line))


def _in_line(label: str, line: int, rule: str, got: str = "", cure: str = "") -> InputError:
    """Return what is wrong in a line of a file."""
    error = InputError(f"{label}, line {line}", rule, got, cure)
    error.line = line
    return error


def _cure(line: str) -> str:
    """Likely correction of an invalid line."""
    if comma := re.search(r"=\s*([+-]?[0-9]+),([0-9]+)", line):
        return f"Write a decimal point: {comma[1]}.{comma[2]}."
    if bare := re.search(r"=\s*([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?\s*[A-Za-z][^#\"]{0,20})", line):
        return f'Put quantities in quotes: "{printable(bare[1].strip())}".'
    return "Put text in quotes." if re.search(r"=\s*[A-Za-z]", line) else ""


def as_toml(value: object) -> str:
    """A value in TOML: JSON's escapes are among its own. Invisible characters are spelled out."""
    if isinstance(value, Mapping):
        keys = {key: key if re.fullmatch("[A-Za-z0-9_-]+", key) else as_toml(key) for key in value}
        return "{ " + ", ".join(f"{keys[key]} = {as_toml(one)}" for key, one in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(as_toml, value))}]"
    text = json.dumps(value, ensure_ascii=False)
    return "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in text)


def folded(name: str) -> str:
    """Letters and digits of a name in lower case, which its spellings have in common."""
    return "".join(c for c in name.casefold() if c.isalnum())


def near(name: str, known: Iterable[str]) -> str | None:
    """The known name that one resembles most, if any."""
    by_case = {c.casefold(): c for c in known}
    found = get_close_matches(name[:80].casefold(), by_case, 1, 0.6)
    return by_case[found[0]] if found else None


def nearest(name: str, known: Iterable[str]) -> str:
    """Sentence for a name that is not known: the nearest one that is, and as many as fit in a line."""
    choices = list(known)
    if found := near(name, choices):
        return f"Did you mean {found}?"
    return cut_list(f"Known: {', '.join(choices)}.")


def cut_list(listed: str) -> str:
    """A sentence with a list, cut after a comma where it is long."""
    return listed if len(listed) <= 200 else listed[: listed.rindex(",", 0, 200)] + ", ..."


def quantity(unit: str) -> Reader[float]:
    """Read a number with a unit, as text; of a ratio, without a unit, a plain number."""

    def read(value: object, where: str) -> float:
        if not isinstance(value, str):
            raise missing_unit(value, unit, where)
        return parse(value, unit, where)

    return ratio if unit == "-" else read


def ratio(value: object, where: str) -> float:
    """Read a plain number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        cure = _as_number(value)
        raise InputError(where, "must be a plain number, without a unit", shown(value), cure)
    if not -1e300 < value < 1e300:  # an integer may be too long for a float
        raise InputError(where, "must be a finite number", shown(value))
    return float(value)


def whole(value: object, where: str) -> int:
    """Read an integer."""
    if isinstance(value, bool) or not isinstance(value, int):
        near = isinstance(value, float) and abs(value) < 1e15 and value.is_integer()
        cure = f"Write {value:.0f}." if near else _as_number(value)
        raise InputError(where, "must be a whole number", shown(value), cure)
    return value


def truth(value: object, where: str) -> bool:
    """Read true or false."""
    if not isinstance(value, bool):
        raise InputError(where, "must be true or false, without quotes", shown(value))
    return value


def text(value: object, where: str, longest: int = 200, *, least: int = 1) -> str:
    """Read a line of printable text."""
    if not isinstance(value, str):
        raise InputError(where, "must be text", shown(value))
    if not least <= len(value.strip()) <= longest or not value.isprintable():
        rule = f"must be one line of {least} to {longest} printable characters"
        raise InputError(where, rule, shown(value))
    return value


def choice(options: type[Choice]) -> Reader[Choice]:
    """Read one of the values of an Enum, in any spelling: "Inner ring" is "inner"."""
    names = [option.value for option in options]
    known = {folded(f"{name} {word}"): name for name in names for word in ("", *_BESIDE)}

    def read(value: object, where: str) -> Choice:
        found = known.get(folded(value)) if isinstance(value, str) else None
        if found is None:
            rule = "must be " + " or ".join([", ".join(f'"{name}"' for name in names[:-1]), f'"{names[-1]}"'])
            raise InputError(where, rule, shown(value))
        return options(found)

    return read


def _as_number(value: object) -> str:
    """Cure for a number that is written as text."""
    if not isinstance(value, str):
        return ""
    number = value.replace(",", ".")
    if number.endswith("%") and re.fullmatch(NUMBER, share := number.removesuffix("%").strip()):
        return f"Write {float(share) / 100.0:.12g}."
    if re.fullmatch(NUMBER, number.strip()) is None:
        return ""
    point = " with a decimal point" if "," in value else ""
    return f"Write {number.strip()} as a number{point}, not as text."
