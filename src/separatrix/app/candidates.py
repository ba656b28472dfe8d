"""Candidates of the user's own in the text of a study: one is added, changed part by part, or removed."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, MutableMapping, MutableSequence
from typing import TypeGuard

import tomlkit
from tomlkit.items import Array, InlineTable

from separatrix.app.draft import MEND, TomlTable, parsed, put, typed
from separatrix.errors import InputError
from separatrix.toml_files import lines_of_keys

SECTION, KEY = "ranking", "candidates"
AT = f"[{SECTION}] {KEY}"
HEADER = f"[[{SECTION}.{KEY}]]"
TEXTS = ("name", "source", "confidence")
"""Parts that are text even if they look like a number or a list."""


def is_measured(friction: object) -> TypeGuard[Mapping[str, object]]:
    """Whether a friction is a table of a mean with its scatter, rather than a number or a distribution."""
    return isinstance(friction, Mapping) and not {"between", "samples"} & set(friction)


def changed(text: str, number: int, path: tuple[str, ...], value: str) -> str:
    """Return the text with one part of a candidate set as a form gives it, comments kept.

    Parameters
    ----------
    text : str
        Of a study file.
    number : int
        Of the candidate, from 0.
    path : tuple of str
        ``("name",)``, ``("material",)``, ``("material", "density")``, ``("friction", environment)`` or
        ``("friction", environment, "count")``.
    value : str
        As typed; an empty one removes the part, and the table that would be empty then.
    """
    document = parsed(text)
    items = _items(document)
    item = items[number] if 0 <= number < len(items) else None
    if not isinstance(item, MutableMapping):
        raise InputError(f"{AT}[{number + 1}]", "is not a table", cure=MEND)
    if path[0] == "friction" and path[-1] == "mean":
        frictions = item.get("friction")
        if not (isinstance(frictions, Mapping) and is_measured(frictions.get(path[1]))):
            path = path[:2]
    if not value.strip():
        _remove(item, path)
    elif path[-1] in TEXTS and path[:-1] != ("friction",):
        _set(item, path, value.strip())
    else:
        _set(item, path, typed(value, is_name=path == ("material",)))
    return tomlkit.dumps(document)


def added(text: str, name: str) -> str:
    """Return the text with one more candidate, behind the others or at the end; it has only a name yet."""
    if not name.strip():
        raise InputError(AT, "needs a name for the new candidate")
    document, data = parsed(text), tomllib.loads(text)
    items, new = _items(document), {"name": name.strip()}
    lines = text.rstrip("\n").split("\n")
    last = _lines_of(text, len(items) - 1) if items else None
    at = len(lines) if last is None else last.stop
    found = "\n".join([*lines[:at], "", HEADER, tomlkit.dumps(new).rstrip(), *lines[at:], ""])
    if _has(found, data, [*data.get(SECTION, {}).get(KEY, ()), new]):
        return found
    if not isinstance(items, Array):
        raise InputError(AT, "is not a list of tables", cure=MEND)
    inline = tomlkit.inline_table()
    inline.update(new)
    items.append(inline)
    return tomlkit.dumps(document)


def removed(text: str, number: int) -> str:
    """Return the text without a candidate; comments below it, which are about what follows, stay."""
    document, data = parsed(text), tomllib.loads(text)
    items = _items(document)
    if not 0 <= number < len(items):
        raise InputError(f"{AT}[{number + 1}]", "is not in the text")
    lines, own = text.split("\n"), _lines_of(text, number)
    if own is not None:
        before, behind = lines[: own.start], lines[own.stop :]
        while behind and not behind[0].strip() and not (before and before[-1].strip()):
            del behind[0]
        found = "\n".join([*before, *behind]).rstrip("\n") + "\n"
        rest = [item for i, item in enumerate(data[SECTION][KEY]) if i != number]
        if _has(found, data, rest):
            return found
    del items[number]
    if not items:
        del document[SECTION][KEY]
    return tomlkit.dumps(document)


def _items(document: TomlTable) -> MutableSequence[object]:
    """Return the candidates of a document; an empty list where it has none."""
    section = document.get(SECTION, {})
    items = section.get(KEY, []) if isinstance(section, Mapping) else None
    if not isinstance(items, list):
        raise InputError(AT, "is not a list of tables", cure=MEND)
    return items


def _lines_of(text: str, number: int) -> range | None:
    """Return the lines of a candidate, from its header, without comments at its end; None if it has none."""
    lines, known = text.split("\n"), lines_of_keys(text)
    path = f"{SECTION}.{KEY}.{number}"
    if path not in known:
        return None
    others = [line for one, line in known.items() if line > known[path] and not _is_inside(one, path)]
    stop = min(others, default=len(lines) + 1) - 1
    while not lines[stop - 1].strip() or lines[stop - 1].lstrip().startswith("#"):
        stop -= 1
    return range(known[path] - 1, stop)


def _is_inside(one: str, path: str) -> bool:
    """Whether a key is of a candidate, be it in a table under a header of its own."""
    above = path.rpartition(".")[0]
    inside = one.removeprefix(f"{above}.").partition(".")[0]
    return one.startswith(f"{path}.") or (one.startswith(f"{above}.") and not inside.isdigit())


def _has(text: str, data: Mapping[str, Mapping[str, object]], items: list[object]) -> bool:
    """Whether a text has these candidates, and the rest as in `data`."""
    try:
        found = tomllib.loads(text)
    except ValueError:
        return False
    rest = {key: value for key, value in data.get(SECTION, {}).items() if key != KEY}
    section = {**rest, **({KEY: items} if items else {})}
    return {SECTION: {}, **found} == {**data, SECTION: section}


def _set(item: TomlTable, path: tuple[str, ...], value: object) -> None:
    """Set a part; a friction that was a number becomes the mean beside its scatter."""
    for depth, key in enumerate(path[:-1]):
        old = item.get(key)
        if depth == 1 and old is not None and not is_measured(old):
            put(item, key, {"mean": old.unwrap()})
        elif not isinstance(old, Mapping):
            put(item, key, {})
        item = item[key]
    put(item, path[-1], value)


def _remove(item: TomlTable, path: tuple[str, ...]) -> None:
    """Remove a part, and the tables that are empty then; a mean that is left alone becomes a number."""
    tables = [item]
    for key in path[:-1]:
        inner = tables[-1].get(key)
        if not isinstance(inner, MutableMapping):
            return
        tables.append(inner)
    tables[-1].pop(path[-1], None)
    for table, key in zip(reversed(tables[:-1]), reversed(path[:-1]), strict=True):
        if not table[key] and "#" not in table[key].as_string():
            del table[key]
        elif set(table[key]) == {"mean"} and isinstance(table[key], InlineTable):
            put(table, key, table[key]["mean"].unwrap())
