"""A TOML file as text: read with care, checked before it is parsed, and every key traced to its line.

Shared by the files that people write: studies, materials, friction.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from separatrix.errors import InputError
from separatrix.kept_files import note
from separatrix.regular_file import size_of, unreadable
from separatrix.units import printable, shown

MOST_BYTES = 256 * 1024
LONGEST_LINE = 4000
DEEPEST = 16
"""How deep brackets may nest; a study needs 3."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What a file is, for its refusals, and how large it may be."""

    noun: str = "a study"
    most_bytes: int = MOST_BYTES
    empty: str = "`separatrix new PATH` writes a study to fill in."
    """The cure of an empty one."""


STUDY = Kind()

_KEY = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
_DOTTED = rf"{_KEY}(?:[ \t]*\.[ \t]*{_KEY})*"
_KEY_LINE = re.compile(rf"\s*({_DOTTED})[ \t]*=")
_HEADER = re.compile(rf"\s*(\[\[?)[ \t]*({_DOTTED})[ \t]*\]")
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


def read_toml(path: Path, kind: Kind = STUDY) -> tuple[dict[str, Any], dict[str, int]]:
    """Content of a TOML file, and the line of each key as a dotted path.

    Raises
    ------
    InputError
        Not a regular file, small enough for its kind, of UTF-8 with valid TOML in it.
    """
    return parsed(read_text(path, kind), label_of(path), kind)


def parsed(text: str, label: str, kind: Kind = STUDY) -> tuple[dict[str, Any], dict[str, int]]:
    """Content of TOML text, and the line of each key as a dotted path."""
    _, too_deep = _statements(text)
    if too_deep:
        raise InputError(f"{label}, line {too_deep}", f"nests brackets more than {DEEPEST} deep")
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _invalid_toml(error, text, label) from None
    if not data:
        raise InputError(label, "is empty", cure=kind.empty)
    return data, lines_of_keys(text)


def lines_of_keys(text: str) -> dict[str, int]:
    """Line number of each key by its dotted path: ``bearing.bore``, ``ranking.candidates.0.name``."""
    found: dict[str, int] = {}
    seen: dict[str, int] = {}
    prefix, lines = "", text.split("\n")
    for number in _statements(text)[0]:
        line = lines[number - 1]
        if header := _HEADER.match(line):
            name = _plain(header[2])
            if header[1] == "[[":
                seen[name] = seen.get(name, -1) + 1
                name = f"{name}.{seen[name]}"
            prefix = name + "."
            found.setdefault(name, number)
        elif key := _KEY_LINE.match(line):
            parts = _plain(key[1]).split(".")
            for depth in range(1, min(len(parts), 4) + 1):
                found.setdefault(prefix + ".".join(parts[:depth]), number)
    return found


@dataclass(slots=True)
class Places:
    """File and line, or sheet and cell, of the paths of faults, as ``[ranking] candidates[2].name``."""

    label: str
    """Of the file, the place of what has none of its own."""

    known: dict[str, str] = field(default_factory=dict)

    def of(self, path: str) -> str:
        """Return the place of the longest part of a path that has one."""
        found = [p for p in self.known if path.startswith(p) and path[len(p) : len(p) + 1] in (*".,[ ", "")]
        return self.known[max(found, key=len)] if found else self.label

    def locate(self, path: str) -> str:
        """Return a path with its place: ``case.toml, line 7: [cage] mass``."""
        return f"{self.of(path)}: {path}" if path else self.label


def places_of(label: str, data: dict[str, Any], lines: Mapping[str, int]) -> Places:
    """Return the places of the keys of a TOML file, from the lines of its dotted keys."""
    places = Places(label)
    for dotted, line in lines.items():
        for path in _paths(dotted, data):
            places.known.setdefault(path, f"{label}, line {line}")
    return places


def _paths(dotted: str, data: dict[str, Any]) -> Iterator[str]:
    """Yield a dotted key as the paths of faults, and those of what it is in."""
    name, *keys = dotted.split(".")
    inside: Any = data.get(name)
    if not keys and not isinstance(inside, dict | list):
        yield name
        return
    path = f"[{printable(name)}]"
    yield path
    for i, key in enumerate(keys):
        if isinstance(inside, list) and key.isdigit():
            path += f"[{int(key) + 1}]" if i > 0 else ""
            inside = inside[int(key)] if int(key) < len(inside) else None
        else:
            path += f"{' ' if i == 0 else '.'}{printable(key)}"
            inside = inside.get(key) if isinstance(inside, dict) else None
        yield path


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


def _plain(key: str) -> str:
    return ".".join(part.strip("\"'") for part in re.findall(_KEY, key))


def read_text(path: Path, kind: Kind = STUDY) -> str:
    """Text of a file: a regular one, small enough for its kind, UTF-8, without NUL or endless lines."""
    label = label_of(path)
    size_of(path, path_text(path))
    try:
        with path.open("rb") as file:
            raw = file.read(kind.most_bytes + 1)
    except OSError as error:
        raise unreadable(path_text(path), error) from None
    if len(raw) > kind.most_bytes:
        raise InputError(label, f"is larger than {kind.noun} can be, {kind.most_bytes // 1024} kB")
    note(path, raw)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        where, cure = f"{label}, line {line}", "Save the file as UTF-8."
        raise InputError(where, "is not UTF-8 text", cure=cure) from None
    for number, content in enumerate(text.split("\n"), 1):
        if "\0" in content:
            raise InputError(f"{label}, line {number}", "holds a NUL character: this is not a text file")
        if len(content) > LONGEST_LINE:
            raise InputError(f"{label}, line {number}", f"is longer than {LONGEST_LINE} characters")
    return text


def _invalid_toml(error: Exception, text: str, label: str) -> InputError:
    message = printable(str(error), 300)
    found = re.search(r" \(at line (\d+), column \d+\)", message)
    if not found:
        rule = "is not valid TOML: it ends inside a quotation or a bracket"
        return InputError(label, rule if "end of document" in message else "is not valid TOML")
    number = int(found[1])
    line, where = text.split("\n")[number - 1].strip(), f"{label}, line {number}"
    if "overwrite" in message or "twice" in message:
        key = _KEY_LINE.match(line)
        return InputError(where, f"gives {printable(_plain(key[1])) if key else shown(line)} a second time")
    reason = message[: found.start()]
    rule = f"is not valid TOML: {reason[:1].lower()}{reason[1:]}"[:120]
    return InputError(where, rule, printable(line), _cure(line))


def _cure(line: str) -> str:
    """What the writer of an invalid line most likely meant."""
    if comma := re.search(r"=\s*([+-]?[0-9]+),([0-9]+)", line):
        return f"Write a decimal point: {comma[1]}.{comma[2]}."
    if bare := re.search(r"=\s*([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?\s*[A-Za-z][^#\"]{0,20})", line):
        return f'Put quantities in quotes: "{printable(bare[1].strip())}".'
    return "Put text in quotes." if re.search(r"=\s*[A-Za-z]", line) else ""
