"""One reader of the files that people write: ``read(Schema, path) -> Loaded(value, sources, notes)``.

From a TOML file to the record of its schema: keys to values by their types, all mistakes at once, each with
its line, key, rule, value and cure. The rules themselves are in `schema`. A mistake carries the path of its
key, and `Document` has the place of a path: a line of a file, or a cell of a sheet.
"""

from __future__ import annotations

import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

from separatrix.ground import toml
from separatrix.ground.errors import InputError, together
from separatrix.ground.schema import (
    Described,
    Fault,
    built,
    defaults_of,
    faults_of,
    is_record,
    keys_of,
    silent_keys,
    without_unit,
)
from separatrix.ground.toml import KeyPath
from separatrix.ground.units import printable, shown

Schema = TypeVar("Schema")
MOST_FAULTS = 100


class Origin(Enum):
    """Who gave a value."""

    GIVEN = "given"
    DEFAULT = "default"


class Source(NamedTuple):
    """Where a value comes from: its place and its text in a file, or the reason of a default."""

    origin: Origin
    place: str = ""
    text: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Loaded(Generic[Schema]):
    """A record, the source of each of its values, and notes on what is right but has no effect."""

    value: Schema
    sources: Mapping[KeyPath, Source]
    notes: tuple[str, ...] = ()


class Document(NamedTuple):
    """Content of a file before any value is converted, and the place of each key."""

    label: str
    data: Mapping[str, Any]
    places: Mapping[KeyPath, str]

    def place(self, path: KeyPath) -> str:
        """Place of the longest part of a path that has one."""
        parts = (path[:length] for length in range(len(path), 0, -1))
        return next((self.places[part] for part in parts if part in self.places), self.label)

    def written(self, path: KeyPath) -> Any:
        """Value of a path as it is written; that of a part of it where it ends there."""
        value: Any = self.data
        for part in path:
            if isinstance(value, Mapping):
                value = value.get(str(part))
            elif isinstance(value, list) and isinstance(part, int):
                value = value[part]
        return value

    def name(self, path: KeyPath) -> str:
        """A path as a person writes it: ``[ranking] candidates[2].friction."air, 440C"``."""
        if not path:
            return ""
        value, text, rest = self.data.get(str(path[0])), printable(str(path[0])), path[1:]
        if isinstance(value, Mapping):
            text = f"[{text}]"
        elif isinstance(value, list) and value and isinstance(value[int(rest[0]) if rest else 0], Mapping):
            text, rest = f"[[{text}]]", rest[1:]  # which of them, the line has
        for i, part in enumerate(rest):
            is_plain = i == 0 or str(part).replace("_", "").isalnum()
            quoted = printable(str(part)) if is_plain and part != "" else f'"{printable(str(part))}"'
            text += (
                f"[{part + 1}]"
                if isinstance(part, int)
                else f"{' ' if text.endswith(']') and not i else '.'}{quoted}"
            )
        return text


def read(schema: type[Schema], path: Path) -> Loaded[Schema]:
    """Record of a file by its schema, whose class variable ``FILE`` has the kind of the file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: place, key, rule, value, cure.
    """
    return read_text(schema, toml.read_text(path, _kind(schema)), toml.label_of(path))


def read_text(schema: type[Schema], text: str, label: str) -> Loaded[Schema]:
    """Record of the text of a file."""
    data, lines = toml.parsed(text, label, _kind(schema))
    places = {path: f"{label}, line {line}" for path, line in lines.items()}
    return read_document(schema, Document(label, data, places))


def read_document(schema: type[Schema], document: Document) -> Loaded[Schema]:
    """Record of a document."""
    reading = Reading(schema, document)
    try:
        value = reading.record(schema, document.data, ())
    except Refused:
        raise together(reading.faults) from None
    return Loaded(value=value, sources=reading.sources, notes=tuple(reading.notes))


def _kind(schema: Any) -> toml.Kind:
    kind: toml.Kind = schema.FILE
    return kind


class Refused(Exception):  # noqa: N818 - it never leaves a reading
    """The mistakes of a value are noted already."""


@dataclass(slots=True)
class Reading:
    """A reading so far: mistakes, notes, sources."""

    schema: type
    document: Document
    faults: list[InputError] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    sources: dict[KeyPath, Source] = field(default_factory=dict)

    def refuse(self, path: KeyPath, error: InputError) -> None:
        """Note a mistake in the value of a path."""
        for one in error.problems or (error,):
            if len(self.faults) < MOST_FAULTS:
                place, name = self.document.place(path), self.document.name(path)
                self.faults.append(one.at(f"{place}: {name}{one.path}" if path else place))
            elif len(self.faults) == MOST_FAULTS:
                rule = f"was not read to its end: it has more than {MOST_FAULTS} mistakes"
                self.faults.append(InputError(self.document.label, rule))

    def record(self, owner: type[Schema], raw: Any, path: KeyPath, above: Described | None = None) -> Schema:
        """Record of a table; fields of an open unit have that of the key above."""
        keys, before = keys_of(owner, above), len(self.faults)
        if not isinstance(raw, Mapping):
            short = getattr(owner, "SHORT", "")
            if not short or isinstance(raw, list):
                required = ", ".join(name for name, one in keys.items() if one.is_required)
                example = above.key.example if above else ""
                cure = f"Write it like {example}." if example else ""
                raise InputError(
                    "", f"must be a table{f' with {required}' if required else ''}", shown(raw), cure
                )
            raw = {short: raw}
        values, refused, written = defaults_of(owner), set(), {name for name in raw if name in keys}
        for name, one in keys.items():  # in the order of the schema: a later key may need an earlier one
            at = (*path, name)
            if name not in raw:
                text = one.key.without or ("not given" if one.default is None else "")
                self.sources[at] = Source(Origin.DEFAULT, text=text)
                continue
            found = self._noted(one.hint, one, raw[name], at)
            values[name] = found
            if found is _NOTHING:
                refused.add(name)
        for name in raw:
            if name not in keys and len(self.faults) <= MOST_FAULTS:
                refused.add(name)
                self._unknown(name, raw[name], path, keys)
        for fault in faults_of(owner, keys, values, written, refused):
            self._refuse_fault(fault, path)
        for name, only in silent_keys(keys, values, written, refused).items():
            if only.ignored and only.key in written:
                at = (*path, name)
                because = f"not used, because {only.key} is {shown(raw[only.key])}."
                self.notes.append(f"{self.document.place(at)}: {self.document.name(at)}: {because}")
                values[name] = keys[name].default
        if len(self.faults) > before:
            raise Refused
        return built(owner, values)

    def _noted(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> Any:
        """Value of a path and its source; `_NOTHING` where it was refused."""
        if len(self.faults) > MOST_FAULTS:
            return _NOTHING
        text = raw if isinstance(raw, str) else "" if isinstance(raw, dict | list) else shown(raw)
        self.sources[path] = Source(Origin.GIVEN, self.document.place(path), text)
        try:
            return self.convert(hint, one, raw, path)
        except InputError as error:
            self.refuse(path, error)
        except Refused:
            pass
        return _NOTHING

    def _refuse_fault(self, fault: Fault, path: KeyPath) -> None:
        at = (*path, *fault.path)
        got = fault.got
        if got is None:
            raw = self.document.written(at)
            got = "" if raw is None else shown(raw)
        self.refuse(at, InputError("", fault.rule, got, fault.cure))

    def _unknown(self, name: str, raw: Any, path: KeyPath, keys: Mapping[str, Described]) -> None:
        top, cure = keys_of(self.schema), toml.nearest(name, keys)
        rule = "is not a valid key"
        if not path:
            is_section = isinstance(raw, dict | list)
            rule = f"is not a {'section' if is_section else 'key'} of {_kind(self.schema).noun}"
        elif homes := [
            home for home, one in top.items() if is_record(one.hint) and name in keys_of(one.hint)
        ]:
            cure = f"It belongs in {' or '.join(f'[{home}]' for home in homes)}."
        self.refuse((*path, name), InputError("", rule, cure=cure))

    def convert(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> Any:
        """Value of a type: numbers in SI, texts as they are, lists as tuples, tables as records."""
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if one.key.read is not None:
            return one.key.read(raw, path, self)
        if hint is float:
            return toml.quantity(one.unit)(raw, "")
        if hint is int:
            return toml.whole(raw, "")
        if hint is bool:
            return toml.truth(raw, "")
        if is_record(hint):
            return self.record(hint, raw, path, one)
        if isinstance(hint, type) and issubclass(hint, Enum):
            return toml.choice(hint)(raw, "")
        if origin is tuple and arguments[-1] is not Ellipsis:
            return self._pair(one, raw)
        if origin is tuple:
            if not isinstance(raw, list) and not one.key.single:
                raise InputError("", "must be a list in [brackets]", shown(raw), one.key.hint)
            if not isinstance(raw, list):
                return (self.convert(without_unit(arguments[0])[0], one, raw, path),)
            items = (((*path, i), item) for i, item in enumerate(raw))
            return tuple(self._each(arguments[0], one, items))
        if isinstance(origin, type) and issubclass(origin, Mapping):
            return self._names(arguments[1], one, raw, path)
        return raw  # a text, or a choice that is the text itself: `faults_of` has its rules

    def _pair(self, one: Described, raw: Any) -> tuple[float, ...]:
        """One quantity, or a list of the lowest and the highest."""
        ends = raw if isinstance(raw, list) else [raw, raw]
        if len(ends) != 2:
            raise InputError("", "must be one quantity, or [lowest, highest]", f"{len(ends)} of them")
        return tuple(toml.quantity(one.unit)(end, "") for end in ends)

    def _names(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> dict[str, Any]:
        """Values by their names."""
        least, most = one.key.length or (0, 2000)
        if not isinstance(raw, dict):
            raise InputError("", "must be a table of names with their values", shown(raw), one.key.hint)
        if not least <= len(raw) <= most:
            raise InputError("", f"must have {least} to {most} names", f"{len(raw)} of them", one.key.hint)
        before = len(self.faults)
        for name in raw:
            try:
                if toml.text(name, ", its name,") != name.strip():
                    raise InputError(", its name,", "must not begin or end with a space", shown(name))
            except InputError as error:
                self.refuse((*path, name), error)
        items = (((*path, name), item) for name, item in raw.items())
        made = self._each(hint, one, items)
        if len(self.faults) > before:
            raise Refused
        return dict(zip(raw, made, strict=True))

    def _each(self, hint: Any, one: Described, items: Iterable[tuple[KeyPath, Any]]) -> list[Any]:
        plain, before = without_unit(hint)[0], len(self.faults)
        found = [self._noted(plain, one, item, at) for at, item in items]
        if len(self.faults) > before:
            raise Refused
        return found


_NOTHING: Any = object()
