"""One reader of the files that people write: ``read_text(Schema, text, label) -> Loaded``.

From a TOML file, perhaps over the one that it extends, to the record of its schema: keys to values by their
types, all mistakes at once, each with its line, key, rule, value and cure. The rules themselves are in
`schema`. A mistake carries the path of its key, and `Document` has the place of a path: a line of a file.
Uncertain numbers and names of a library are read by a `Helper`.
"""

from __future__ import annotations

import typing
from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from enum import Enum
from os.path import isfile
from pathlib import Path
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from separatrix.ground import toml
from separatrix.ground.errors import InputError, together
from separatrix.ground.schema import (
    Described,
    Fault,
    OneOf,
    built,
    defaults_of,
    faults_of,
    is_record,
    keys_of,
    silent_keys,
    without_unit,
)
from separatrix.ground.toml import KeyPath
from separatrix.ground.units import format_quantity, printable, shown

Schema = TypeVar("Schema")
Made = TypeVar("Made")
MOST_FAULTS = 100
MOST_BASES = 8


class Elsewhere(InputError):  # noqa: N818 - it never leaves a reading
    """Mistakes in a file that a value names: they have places of their own."""

    def __init__(self, error: InputError) -> None:
        super().__init__(error.path, error.rule, error.got, error.cure)
        self.problems = error.problems or (error,)


class Helper(Protocol):
    """What reads the values of a file that have a form of their own in it."""

    def number(self, raw: object, unit: str, one: Described) -> tuple[float, object]:
        """Number of a quantity or, with an empty unit, whole one; and its distribution, None if certain."""

    def named(self, raw: object, one: Described, reading: Reading) -> Any:
        """Record of a library that a text names, or None if the value is not a name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Loaded(Generic[Schema]):
    """A record, the place of each value that is given, and notes on what is right but has no effect."""

    value: Schema
    places: Mapping[KeyPath, str]
    notes: tuple[str, ...] = ()
    distributions: Mapping[KeyPath, Any] = field(default_factory=dict)
    """Of the uncertain numbers, which have their means in the record."""


class Document(NamedTuple):
    """Content of a file before any value is converted, and the place of each key."""

    label: str
    data: Mapping[str, Any]
    places: Mapping[KeyPath, str]
    lines: Mapping[KeyPath, int] = {}
    """Line of each key in the file itself, not of those that it extends."""

    folders: Mapping[KeyPath, Path] = {}
    """Where the files are that a value names, by the top of its path."""

    chain: tuple[tuple[Path, Mapping[str, Any]], ...] = ()
    """The file and those that it extends, each with its own content."""

    files: dict[str, str] = {}  # noqa: RUF012 - of a named tuple; `document_of` gives each its own
    """Texts of the files that values name, by these names: as they are read, or as an answer kept them."""

    is_kept: bool = False

    def file(self, path: KeyPath, name: str, kind: toml.Kind) -> str | None:
        """Text of the file that a key names; None if there is no such file."""
        if not self.is_kept:
            found = self.folder(path) / name
            if not isfile(found):
                return None
            self.files[name] = toml.read_text(found, kind)
        return self.files.get(name)

    def folder(self, path: KeyPath) -> Path:
        """Folder of the file that gives a key."""
        return _longest(self.folders, path, Path())

    def place(self, path: KeyPath) -> str:
        """Place of the longest part of a path that has one."""
        return _longest(self.places, path, self.label)

    def line(self, path: KeyPath) -> int:
        """Line of the longest part of a path that has a place; 0 where that is in another file."""
        parts = (path[:length] for length in range(len(path), 0, -1))
        return self.lines.get(next((one for one in parts if one in self.places), ()), 0)

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
            before = " " if text.endswith("]") and i == 0 else "."
            text += f"[{part + 1}]" if isinstance(part, int) else f"{before}{quoted}"
        return text


def _longest(known: Mapping[KeyPath, Made], path: KeyPath, default: Made) -> Made:
    """What is known of the longest part of a path, from its beginning."""
    parts = (path[:length] for length in range(len(path), -1, -1))
    return next((known[part] for part in parts if part in known), default)


def read_text(schema: type[Schema], text: str, label: str) -> Loaded[Schema]:
    """Record of the text of a file by its schema, whose class variable ``FILE`` has the kind of the file.

    Raises
    ------
    InputError
        Everything that is wrong, a line each: place, key, rule, value, cure.
    """
    return read_document(schema, _document_of_text(schema, text, label))


def _document_of_text(schema: type, text: str, label: str) -> Document:
    data, lines = toml.parsed(text, label, _kind(schema))
    return Document(label, data, {path: f"{label}, line {line}" for path, line in lines.items()}, lines)


def read_document(schema: type[Schema], document: Document, helper: Helper | None = None) -> Loaded[Schema]:
    """Record of a document."""
    reading = Reading(schema, document, helper)
    try:
        value = reading.record(schema, document.data, ())
    except Refused:
        raise together(reading.in_order()) from None
    notes = tuple(reading.notes)
    return Loaded(value=value, places=reading.places, notes=notes, distributions=reading.distributions)


# ---- a file over the file that it extends


def document_of(schema: type, path: Path, above: tuple[Path, ...] = ()) -> Document:
    """Document of a file, over that of the file that it extends."""
    kind = _kind(schema)
    document = _document_of_text(schema, toml.read_text(path, kind), toml.label_of(path))
    folders: dict[KeyPath, Path] = {(): path.parent}
    for name, one in document.data.items():
        folders |= {(name, key): path.parent for key in one} if isinstance(one, dict) else {}
    document = document._replace(folders=folders, chain=((path, document.data),), files={})
    if "extends" not in document.data or "extends" not in keys_of(schema):
        return document
    where, base = f"{document.place(('extends',))}: extends", document.data["extends"]
    shipped: Mapping[str, Path] = kind.shipped()
    if not isinstance(base, str):
        raise InputError(where, "must be a path or the name of a shipped example", shown(base))
    beside_it = path.parent / base
    target = beside_it if base and isfile(beside_it) else shipped.get(base)
    if target is None:
        cure = toml.nearest(base, shipped).replace("Known:", "Shipped examples:")
        raise InputError(where, "does not name a file beside this one", shown(base), cure)
    chain = (*above, path.resolve())
    if target.resolve() in chain:
        raise InputError(where, "leads back to a file that extends this one", shown(base))
    if len(chain) > MOST_BASES:
        raise InputError(where, f"makes a chain of more than {MOST_BASES} files", shown(base))
    return _over(schema, document_of(schema, target, chain), document)


def _over(schema: type, base: Document, variant: Document) -> Document:
    """A document over its base: a section key by key, all else as a whole."""
    data = {name: value for name, value in base.data.items() if name not in ("extends", "library")}
    own: set[KeyPath] = set()
    for name, value in variant.data.items():
        one, below = keys_of(schema).get(name), data.get(name)
        is_section = one is not None and is_record(one.key.form or one.hint)
        if one is not None and is_section and isinstance(value, dict) and isinstance(below, dict):
            dropped = set(_dropped(one.key.form or one.hint, value))
            data[name] = {key: item for key, item in below.items() if key not in dropped} | value
            own |= {(name, key) for key in (*value, *dropped)}
        else:
            data[name] = value
            own.add((name,))
    hidden = {path for path in base.places if path[:1] in own or path[:2] in own}
    places = {path: where for path, where in base.places.items() if path not in hidden}
    return variant._replace(
        data=data,
        places={**places, **variant.places},
        folders={**base.folders, **variant.folders},
        chain=variant.chain + base.chain,
    )


def _dropped(section: Any, variant: Mapping[str, Any]) -> Iterator[str]:
    """Keys of the base that the variant replaces by an alternative, or makes meaningless."""
    for rule in getattr(section, "RULES", ()):
        if isinstance(rule, OneOf) and any(key in variant for group in rule.groups for key in group):
            others = (group for group in rule.groups if not any(one in variant for one in group))
            yield from (key for group in others for key in group)
    for name, keys in getattr(section, "REPLACED", {}).items():
        yield from keys if name in variant else ()
    for name, one in keys_of(section).items():
        for only in one.key.only:
            try:
                chosen = toml.choice(keys_of(section)[only.key].hint)(variant.get(only.key), "")
            except InputError:  # it is not given, or refused where the section is read
                continue
            if chosen not in only.values:
                yield name


def _kind(schema: Any) -> toml.Kind:
    kind: toml.Kind = schema.FILE
    return kind


class Refused(Exception):  # noqa: N818 - it never leaves a reading
    """The mistakes of a value are noted already."""


@dataclass(slots=True)
class Reading:
    """A reading so far: mistakes, notes, places."""

    schema: type
    document: Document
    helper: Helper | None = None
    faults: list[tuple[KeyPath, InputError]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    places: dict[KeyPath, str] = field(default_factory=dict)
    distributions: dict[KeyPath, Any] = field(default_factory=dict)
    done: dict[str, Any] = field(default_factory=dict)
    """Values of the keys at the top that were read before."""

    def refuse(self, path: KeyPath, error: InputError) -> None:
        """Note a mistake in the value of a path."""
        for one in error.problems or (error,):
            if isinstance(error, Elsewhere):
                one.line, one.key = self.document.line(path), path
                self.faults.append((path, one))
            elif len(self.faults) < MOST_FAULTS:
                place, name = self.document.place(path), self.document.name(path)
                found = one.at(f"{place}: {name}{one.path}" if path else place)
                found.line, found.key = self.document.line(path), path
                self.faults.append((path, found))
            elif len(self.faults) == MOST_FAULTS:
                rule = f"was not read to its end: it has more than {MOST_FAULTS} mistakes"
                self.faults.append(((), InputError(self.document.label, rule)))

    def in_order(self) -> list[InputError]:
        """Mistakes in the order of the file; what concerns the file as a whole comes last."""
        known = {path: place for place, path in enumerate(self.document.places)}
        ordered = sorted(self.faults, key=lambda fault: _longest(known, fault[0], len(known)))
        return [error for _, error in ordered]

    def record(self, owner: type[Schema], raw: Any, path: KeyPath, above: Described | None = None) -> Schema:
        """Record of a table; fields of an open unit have that of the key above."""
        keys, before = keys_of(owner, above), len(self.faults)
        if not isinstance(raw, Mapping):
            short = getattr(owner, "SHORT", "")
            if not short or isinstance(raw, list):
                required = ", ".join(name for name, one in keys.items() if one.is_required)
                example = above.key.example if above else ""
                cure = f"Write it like {example}." if example else ""
                rule = f"must be a table{f' with {required}' if required else ''}"
                rule = f"must be one section, headed [{path[0]}]" if len(path) == 1 else rule
                raise InputError("", rule, shown(raw), cure)
            raw = {short: raw}
        values, refused, written = defaults_of(owner), set(), {name for name in raw if name in keys}
        for name, one in keys.items():  # in the order of the schema: a later key may need an earlier one
            at = (*path, name)
            if name not in raw:
                continue
            found = self._noted(one.hint, one, raw[name], at)
            values[name] = found
            if found is _NOTHING:
                refused.add(name)
            elif not path:
                self.done[name] = found
        for name in raw:
            if name not in keys and len(self.faults) <= MOST_FAULTS:
                refused.add(name)
                self._unknown(name, raw[name], path, keys)
                if (meant := toml.near(name, keys)) and meant not in raw:  # which is not missing as well
                    written.add(meant)
                    refused.add(meant)
        for fault in faults_of(owner, keys, values, written, refused):
            self._refuse_fault(fault, path, keys)
        self._ignore_silent_keys(keys, values, written, refused, raw, path)
        if len(self.faults) > before:
            raise Refused
        return built(owner, values)

    def checked(self, owner: type[Schema], values: Mapping[str, Any], path: KeyPath) -> Schema:
        """Record of values that follow from those of a table."""
        faults = tuple(faults_of(owner, keys_of(owner), values, set(values), set()))
        for fault in faults:
            self._refuse_fault(fault, path, keys_of(owner))
        if faults:
            raise Refused
        return built(owner, values)

    def _ignore_silent_keys(
        self,
        keys: Mapping[str, Described],
        values: dict[str, Any],
        written: Set[str],
        refused: Set[str],
        raw: Mapping[str, Any],
        path: KeyPath,
    ) -> None:
        """Note written keys that have no effect beside the value of another, and take their defaults."""
        unused: dict[str, list[str]] = {}
        for name, only in silent_keys(keys, values, written, refused).items():
            if only.ignored and only.key in written:
                unused.setdefault(only.key, []).append(name)
                values[name] = keys[name].default
        for other, names in unused.items():
            at = (*path, names[0])
            where = ", ".join([f"{self.document.place(at)}: {self.document.name(at)}", *names[1:]])
            self.notes.append(f"{where}: not used, because {other} is {shown(raw[other])}.")

    def _noted(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> Any:
        """Value of a path; `_NOTHING` where it was refused."""
        if len(self.faults) > MOST_FAULTS:
            return _NOTHING
        self.places[path] = self.document.place(path)
        try:
            return self.convert(hint, one, raw, path)
        except InputError as error:
            self.refuse(path, error)
        except Refused:
            pass
        return _NOTHING

    def _refuse_fault(self, fault: Fault, path: KeyPath, keys: Mapping[str, Described]) -> None:
        at, got = (*path, *fault.path), fault.got
        if got is None and at in self.distributions:
            one, unit = self.distributions[at], keys[str(fault.path[0])].unit
            got = f"{one.text}, whose mean is {format_quantity(one.mean, unit or '-', 8)}"
        elif got is None:
            raw = self.document.written(at)
            got = "" if raw is None else shown(raw)
        self.refuse(at, InputError("", fault.rule, got, fault.cure))

    def _unknown(self, name: str, raw: Any, path: KeyPath, keys: Mapping[str, Described]) -> None:
        top, cure, rule = keys_of(self.schema), toml.nearest(name, keys), "is not a valid key"
        forms = {home: one.key.form or one.hint for home, one in top.items()}
        homes = [f"[{home}]" for home, form in forms.items() if is_record(form) and name in keys_of(form)]
        is_section = not path and isinstance(raw, dict | list)
        if not path:
            rule = f"is not a {'section' if is_section else 'key'} of {_kind(self.schema).noun}"
        if homes and not is_section:
            cure = f"It belongs in {' or '.join(homes)}."
        self.refuse((*path, name), InputError("", rule, cure=cure))

    def convert(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> Any:
        """Value of a type: numbers in SI, texts as they are, lists as tuples, tables as records."""
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if one.key.read is not None:
            return one.key.read(raw, path, self)
        if hint in (float, int):
            return self.number(one, raw, path, hint)
        if hint is bool:
            return toml.truth(raw, "")
        if one.key.named and self.helper is not None:
            found = self.helper.named(raw, one, self)
            if found is not None:
                return found
        if is_record(hint):
            return self.record(hint, raw, path, one)
        if isinstance(hint, type) and issubclass(hint, Enum):
            return toml.choice(hint)(raw, "")
        if origin is tuple and arguments[-1] is not Ellipsis:
            return self._pair(one, raw)
        if origin is tuple:
            return self.list_of(arguments[0], one, raw, path)
        if isinstance(origin, type) and issubclass(origin, Mapping):
            return self._names(arguments[1], one, raw, path)
        return raw  # a text, or a choice that is the text itself: `faults_of` has its rules

    def list_of(self, hint: Any, one: Described, raw: Any, path: KeyPath) -> tuple[Any, ...]:
        """Values of a list, or of one that may stand without its brackets."""
        if not isinstance(raw, list) and not one.key.single:
            raise InputError("", "must be a list in [brackets]", shown(raw), one.key.hint)
        if not isinstance(raw, list):
            return (self.convert(without_unit(hint)[0], one, raw, path),)
        if not raw and one.unit and without_unit(hint)[0] is float:
            raise InputError("", "must not be empty", cure="Leave it out, or give its values.")
        one = one._replace(key=replace(one.key, read=None))
        return tuple(self._each(hint, one, (((*path, i), item) for i, item in enumerate(raw))))

    def number(self, one: Described, raw: Any, path: KeyPath, hint: type = float) -> float:
        """Number of a key: of an uncertain one the mean."""
        if self.helper is None:
            return toml.quantity(one.unit)(raw, "") if hint is float else toml.whole(raw, "")
        value, distribution = self.helper.number(raw, one.unit if hint is float else "", one)
        if distribution is not None:
            self.distributions[path] = distribution
        return value

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
        if one.key.item is not None:
            one = one._replace(key=replace(one.key, read=one.key.item))
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
