"""A schema is a frozen record: its types carry the units, its fields bounds, choices and defaults.

The reader of files and the record built in Python take the rules from it; templates and tables of keys can.
What no declaration expresses is a check, a function whose parameters are the keys that it compares:

    @record
    class Film:
        '''A solid film.'''

        race_friction: Ratio = key(between(0.0, 2.0))
        '''Of ball on race.'''
        thickness: Metre | None = key(positive(1e-10, 1e-2), default=None, without="bare races")
        '''Total of ball and race.'''

    @check(Film)
    def film_without_friction(thickness: Metre, race_friction: Ratio) -> Faults:
        if race_friction == 0.0:
            yield Fault("race_friction", "must be > 0 with a film", "Leave the thickness out.")

A field without `key` is not in the file; what follows from the keys is a property.
"""

from __future__ import annotations

import ast
import inspect
import math
import textwrap
import typing
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import MISSING, dataclass, field, fields
from enum import Enum
from functools import cache, partial
from itertools import pairwise
from numbers import Real
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, NamedTuple, TypeGuard, TypeVar, dataclass_transform

from separatrix.ground.errors import InputError, noted, together
from separatrix.ground.toml import KeyPath, text
from separatrix.ground.units import UNITS, format_quantity, parse, shown, unit_of

Made = TypeVar("Made")

OPEN = "?"
"""Unit of a field that has the unit, the bound and the hint of the key above its record."""

Open = Annotated[float, "?"]


class Spelled(Enum):
    """An enumeration whose values are shown; of another the names."""


class Fault(NamedTuple):
    """A mistake of a record: its key, or the path to a value inside; empty for the record as a whole."""

    key: str | KeyPath
    rule: str
    cure: str = ""
    got: str | None = None
    """The value as it is written, if None."""

    @property
    def path(self) -> KeyPath:
        """Path from the record to the wrong value."""
        return self.key if isinstance(self.key, tuple) else (self.key,) if self.key else ()


Faults = Iterator[Fault]
Check = Callable[..., Faults]


class Bound(NamedTuple):
    """Numbers that a quantity takes."""

    low: float
    high: float
    open_low: bool = False
    open_high: bool = False
    sign: str = ""
    """``"> 0"`` or ``">= 0"`` of a one-sided bound: it names only the side that is wrong."""

    def rule(self, value: object, unit: str) -> str:
        """Rule that a value breaks; empty if it breaks none."""
        low, high = self.low, self.high
        if not is_number(value) or not math.isfinite(value):
            return f"must be a finite number{f' {self.sign}' if self.sign else ''}"
        is_end = (self.open_low and value == low) or (self.open_high and value == high)
        if low <= value <= high and not is_end:
            return ""
        bottom, top = ("0" if end == 0.0 else format_quantity(end, unit) for end in (low, high))
        if self.sign and (value < 0.0 or (value == 0.0 and self.sign == "> 0")):
            return f"must be {self.sign}{' K' * (unit == 'K')}"  # what is below 0 degC is above 0 K
        if self.sign:
            return f"must be >= {bottom}" if value < low else f"must be <= {top}"
        if self.open_low or self.open_high:
            below, above = ">" if self.open_low else ">=", "<" if self.open_high else "<="
            return f"must be {below} {bottom} and {above} {top}"
        return f"must lie between {bottom} and {top}"


def is_number(value: object) -> TypeGuard[float]:
    """True for a real number that is not a bool, nor an integer too long for a float."""
    too_long = isinstance(value, int) and abs(value) >= 10**300
    return isinstance(value, Real) and not isinstance(value, bool) and not too_long


def between(low: float, high: float, *, open_low: bool = False, open_high: bool = False) -> Bound:
    """Numbers of an interval."""
    return Bound(low, high, open_low=open_low, open_high=open_high)


def positive(low: float, high: float) -> Bound:
    """Numbers above zero; nothing real is outside [low, high]."""
    return Bound(low, high, sign="> 0")


def not_negative(high: float) -> Bound:
    """Numbers from zero to `high`; nothing real is above."""
    return Bound(0.0, high, sign=">= 0")


class Only(NamedTuple):
    """A key has a meaning only with some values of another key."""

    key: str
    values: tuple[object, ...]
    reason: str
    """Why it has none with another value."""

    cure: str = ""
    ignored: bool = False
    """Whether a written value of the other key turns the fault into a note and the key into its default."""


class OneOf(NamedTuple):
    """Groups of keys that exclude each other. In the class variable `RULES` of a record."""

    groups: tuple[tuple[str, ...], ...]
    required: bool


class AllOrNone(NamedTuple):
    """Keys that are given together or not at all. In the class variable `RULES` of a record."""

    names: tuple[str, ...]


def one_of(*groups: str | tuple[str, ...], required: bool = False) -> OneOf:
    """Keys, or groups of keys, of which at most one is given; `required`: exactly one."""
    return OneOf(tuple((group,) if isinstance(group, str) else group for group in groups), required)


def all_or_none(*names: str) -> AllOrNone:
    """Keys that are given together or not at all."""
    return AllOrNone(names)


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """Properties of a key besides its type."""

    bound: Bound | None = None
    """Of a number, or of each number of a list."""

    hint: str = ""
    """Cure of a wrong value, or of a missing one."""

    without: str = ""
    """What its absence means, or the reason of its default."""

    example: str = ""
    """A value as TOML, for the template and for the cure of a wrong one."""

    letters: tuple[int, int] = (1, 200)
    """Fewest and most of a text, or of each text of a list."""

    length: tuple[int, int] = (0, 2000)
    """Fewest and most items of a list, or names of a table."""

    single: bool = False
    """Whether one item may stand without the brackets of its list."""

    distinct: tuple[str, ...] = ()
    """Keys in which the tables of a list must differ."""

    rising: bool = False
    """Whether the numbers of a list must increase."""

    needs: tuple[str, str] | None = None
    """Another key without which it has no effect, and why."""

    only: tuple[Only, ...] = ()
    certain: bool = False
    """Whether it takes no distribution, in a file whose numbers may be uncertain."""

    named: str = ""
    """Kind of the library's records that it may name."""

    read: Callable[[Any, KeyPath, Any], Any] | None = None
    """Reader of a form of its own: from the value, its path and the `reader.Reading` to the field."""

    item: Callable[[Any, KeyPath, Any], Any] | None = None
    """The same of each value of a table of names."""

    form: type | None = None
    """Record of the keys that a file has, where `read` makes another of it."""


def key(
    bound: Bound | None = None, *, default: Any = MISSING, compare: bool = True, **properties: Any
) -> Any:
    """Field of a record that is a key of a file; its keywords are those of `Key`."""
    metadata = {"key": Key(bound=bound, **properties)}
    if default == {}:
        return field(default_factory=dict, metadata=metadata, compare=compare)
    return field(default=default, metadata=metadata, compare=compare)


_CHECKS: dict[type, list[tuple[Check, tuple[Check, ...]]]] = {}
"""Checks of each record, each with those after which it comes."""


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(key,))
def record(cls: type[Made]) -> type[Made]:
    """Frozen record that checks itself when it is built."""
    type.__setattr__(cls, "__post_init__", _check_itself)
    made = dataclass(frozen=True, slots=True, kw_only=True)(cls)
    _CHECKS[made] = []
    return made


def check(*owners: type, after: tuple[Check, ...] = ()) -> Callable[[Check], Check]:
    """Register a check of records. A parameter is a key; any other name is the whole record.

    It does not run where one of its keys was refused, nor where one is None and its type here is not
    optional, nor where a check of `after` found a fault. One of the whole record runs last, if nothing else
    is wrong.
    """

    def registered(function: Check) -> Check:
        for owner in owners:
            _CHECKS[owner].append((function, after))
        return function

    return registered


class Described(NamedTuple):
    """A key of a record with its type taken apart."""

    name: str
    key: Key
    hint: Any
    """Type without None and without a unit."""

    unit: str
    """SI unit; ``-`` of a ratio, empty of what is not a quantity."""

    default: Any

    @property
    def is_required(self) -> bool:
        """Whether it has no default."""
        return self.default is MISSING


@cache
def meanings_of(owner: type) -> Mapping[str, str]:
    """Text below each field of a record, on one line, from its source."""
    (made,) = ast.parse(textwrap.dedent(inspect.getsource(owner))).body
    found: dict[str, str] = {}
    for one, below in pairwise(getattr(made, "body", [])):
        is_field = isinstance(one, ast.AnnAssign) and isinstance(one.target, ast.Name)
        if is_field and isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            found[one.target.id] = " ".join(str(below.value.value).split())
    return found


def is_record(hint: object) -> bool:
    """Whether a type is a schema."""
    return isinstance(hint, type) and hint in _CHECKS


def keys_of(owner: Any, above: Described | None = None) -> Mapping[str, Described]:
    """Keys of a record by name; those of an open unit take unit, bound and hint of the key above."""
    if above is None:
        return _keys_of(owner, OPEN, None, "")
    return _keys_of(owner, above.unit, above.key.bound, above.key.hint)


@cache
def _keys_of(owner: Any, unit: str, bound: Bound | None, hint: str) -> Mapping[str, Described]:
    types, found = typing.get_type_hints(owner, include_extras=True), {}
    for one in fields(owner):
        if "key" not in one.metadata:
            continue
        plain, own = without_unit(without_none(types[one.name])[0])
        known: Key = one.metadata["key"]
        if own == OPEN:
            own = unit
            known = Key(bound=bound, hint=hint, without=known.without, length=known.length)
        default = one.default if one.default_factory is MISSING else one.default_factory()
        found[one.name] = Described(one.name, known, plain, own, default)
    return found


def without_none(hint: Any) -> tuple[Any, bool]:
    """A type without None, and whether it had it."""
    if typing.get_origin(hint) not in (typing.Union, UnionType):
        return hint, False
    left = [one for one in typing.get_args(hint) if one is not NoneType]
    return (left[0] if len(left) == 1 else hint), len(left) < len(typing.get_args(hint))


def without_unit(hint: Any) -> tuple[Any, str]:
    """A type without its unit, and the unit; of a list the unit of its items."""
    if typing.get_origin(hint) is Annotated:
        plain, unit, *_ = typing.get_args(hint)
        return plain, unit
    if typing.get_origin(hint) is tuple:
        return hint, without_unit(typing.get_args(hint)[0])[1]
    return hint, ""


# ---- the rules of a record, for the reader and for a record built in Python alike


def faults_of(
    owner: type,
    keys: Mapping[str, Described],
    values: Mapping[str, Any],
    written: Set[str],
    refused: Set[str],
) -> Faults:
    """Mistakes of the values of a record, of each key the first; `refused` keys have theirs already.

    `values` has the defaults too, and MISSING where there is none.
    """
    bad: set[str | int] = set(refused)
    for stage in (partial(_structure, owner, keys, values, written), partial(_rules, keys, values, written)):
        for fault in tuple(stage(bad)):
            bad.update(fault.path[:1] or ("",))
            yield fault
    seen: set[KeyPath] = set()
    failed: set[Check] = set()
    for function, after, is_whole in _ordered(owner):
        spared = not failed.isdisjoint(after) or (is_whole and (bad or seen))
        arguments = None if spared else _arguments(function, owner, values, bad)
        if arguments is None:
            failed.add(function)
            continue
        for fault in function(**arguments):
            failed.add(function)
            if fault.path not in seen:
                yield fault
            seen.add(fault.path)
            if len(arguments) == 1:
                bad.update(fault.path[:1])


@cache
def _ordered(owner: Any) -> tuple[tuple[Check, tuple[Check, ...], bool], ...]:
    """Checks of one key, whose refusal spares it the others; of several; of the whole record, marked."""
    names = {one.name for one in fields(owner)}
    found = [(one, after, not _parameters(one).keys() <= names) for one, after in _CHECKS[owner]]
    return tuple(sorted(found, key=lambda one: (one[2], len(_parameters(one[0])) > 1)))


def silent_keys(
    keys: Mapping[str, Described], values: Mapping[str, Any], written: Set[str], bad: Set[str]
) -> Mapping[str, Only]:
    """Written keys that have no meaning beside the value of another key, and the rule that they break."""
    return {
        name: only
        for name, one in keys.items()
        if name in written and name not in bad
        for only in reversed(one.key.only)  # the first rule that is broken comes last, and stays
        if only.key not in bad and values[only.key] not in only.values
        if only.ignored or values[name] != one.default
    }


def _structure(
    owner: type, keys: Mapping[str, Described], values: Mapping[str, Any], written: Set[str], bad: Set[str]
) -> Faults:
    """Keys that are missing, exclude each other, need another, or have no meaning beside another's value."""
    is_file = hasattr(owner, "FILE")
    lacking = {
        name: f"[{name}]" if is_record(one.hint) and is_file else name
        for name, one in keys.items()
        if one.is_required and name not in written
    }
    for rule in getattr(owner, "RULES", ()):
        if isinstance(rule, AllOrNone):
            absent = [name for name in rule.names if name not in written]
            if 0 < len(absent) < len(rule.names):
                yield Fault(absent[0], "is missing", f"Give all of {', '.join(rule.names)}, or none.", "")
            continue
        given = [one for group in rule.groups if (one := [name for name in group if name in written])]
        for first, second in pairwise(given):
            yield Fault(second[0], f"and {first[0]} exclude each other", "Give one of the two.", "")
        if rule.required and not given:
            first, *others = (group[0] for group in rule.groups)
            lacking[first] = f"{first} (or {', '.join(others)})"
    if lacking:
        listed = ", ".join(lacking[name] for name in keys if name in lacking)
        first_key = keys[next(iter(lacking))].key
        is_hint = len(lacking) == 1 and first_key.bound is None  # that of a bound is about a number
        yield Fault("", f"lacks: {listed}", first_key.hint if is_hint else "", "")
    for name in keys:
        needs = keys[name].key.needs if name in written else None
        if needs and needs[0] not in written:
            yield Fault(name, f"needs {needs[0]}: without it {needs[1]}", "Give it, or leave both out.", "")
    for name, only in silent_keys(keys, values, written, bad).items():
        if not only.ignored:
            yield Fault(name, only.reason, only.cure)
        elif only.key not in written:
            yield Fault(name, f"needs {only.key}: {only.reason}", only.cure, "")


def _rules(
    keys: Mapping[str, Described], values: Mapping[str, Any], written: Set[str], bad: Set[str | int]
) -> Faults:
    """What type, bound and length of each key refuse; a default is right."""
    for name in (name for name in keys if name in written and name not in bad):
        if values[name] is None and keys[name].key.read is None:  # from Python
            yield Fault(name, "is missing", keys[name].key.hint, "")
        elif values[name] is not MISSING:
            yield from _of_type(keys[name].hint, keys[name], values[name], (name,))


def _of_type(hint: Any, one: Described, value: Any, path: KeyPath) -> Faults:
    """What the rules of a key refuse in a value of a type; in a list, of each item."""
    known, origin, arguments = one.key, typing.get_origin(hint), typing.get_args(hint)
    if hint is float:
        rule = (known.bound or Bound(-math.inf, math.inf)).rule(value, one.unit)
        if rule:
            yield Fault(path, rule, known.hint)
    elif hint is int:
        low, high = (int(end) for end in (known.bound or Bound(-1e15, 1e15))[:2])
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            yield Fault(path, f"must be a whole number from {low} to {high}", known.hint)
    elif hint is str:
        least, most = known.letters
        try:
            text(value, "", most, least=least)
        except InputError as error:
            yield Fault(path, error.rule, known.hint)
    elif origin is Literal:
        if value not in arguments:
            yield Fault(path, f"must be {' or '.join(map(shown, arguments))}", known.hint)
    elif origin is tuple:
        yield from _of_list(arguments, one, value, path)
    elif isinstance(hint, type) and known.read is None and not isinstance(value, hint):
        rule = f"must be of {hint.__name__}"
        if issubclass(hint, Enum):
            rule = f"must be one of {', '.join(f'{hint.__name__}.{option.name}' for option in hint)}"
        yield Fault(path, rule, known.hint)


def _of_list(arguments: tuple[Any, ...], one: Described, value: Any, path: KeyPath) -> Faults:
    """What the rules refuse in a list, or in a pair of the lowest and the highest value."""
    is_pair, inner = arguments[-1] is not Ellipsis, without_unit(arguments[0])[0]
    least, most = (2, 2) if is_pair else one.key.length
    if not isinstance(value, tuple) or not least <= len(value) <= most:
        got = f"{len(value)} of them" if isinstance(value, tuple) else None
        count = f"{least} to {most}" if least < most else f"{most}"
        cure = "" if one.key.bound else one.key.hint  # that of a bound is about a number
        yield Fault(path, f"must have {count} items", cure, got)
        return
    of_items = [tuple(_of_type(inner, one, item, (*path, i))) for i, item in enumerate(value)]
    if wrong := [fault for faults in of_items for fault in faults]:
        end = value[int(wrong[0].path[-1])] if is_pair else None
        got = format_quantity(end, one.unit) if is_number(end) and math.isfinite(end) else shown(end)
        yield from (wrong[0]._replace(key=path, got=got),) if is_pair else wrong
        return
    names = one.key.distinct
    if names and len({tuple(getattr(v, name) for name in names) for v in value}) < len(value):
        rule = f"has two with the same {', '.join(names[:-1])} and {names[-1]}"
        yield Fault(path, rule, "Keep one, or give the key in which they differ.", "")
    if inner is not float:
        return
    for first, second in pairwise(value):
        if first > second if is_pair else one.key.rising and first >= second:
            got = f"{format_quantity(second, one.unit)} after {format_quantity(first, one.unit)}"
            rule = "must have the lowest value first" if is_pair else "must be strictly increasing"
            yield Fault(path, rule, got=got)
            return


@cache
def _parameters(function: Check) -> Mapping[str, bool]:
    """Names of the parameters of a check, and whether each takes None."""
    hints = typing.get_type_hints(function, include_extras=True)
    return {name: without_none(hints.get(name, Any))[1] for name in inspect.signature(function).parameters}


def _arguments(
    function: Check, owner: type, values: Mapping[str, Any], bad: Set[str | int]
) -> dict[str, Any] | None:
    found: dict[str, Any] = {}
    for name, takes_none in _parameters(function).items():
        if name not in values:
            found[name] = built(owner, values)
        elif name in bad or values[name] is MISSING or (values[name] is None and not takes_none):
            return None
        else:
            found[name] = values[name]
    return found


def defaults_of(owner: Any) -> dict[str, Any]:
    """Value of each field that is not given; MISSING if there is none."""
    made = ((one.name, one.default, one.default_factory) for one in fields(owner))
    return {name: default if factory is MISSING else factory() for name, default, factory in made}


def built(owner: type[Made], values: Mapping[str, Any]) -> Made:
    """Record of values that were checked."""
    made = object.__new__(owner)
    for name, value in values.items():
        object.__setattr__(made, name, value)
    return made


def _check_itself(self: Any) -> None:
    """Check a record that is built in Python; a text such as ``"25 g"`` becomes the number in SI first."""
    owner, keys = type(self), keys_of(type(self))
    values = {one.name: getattr(self, one.name) for one in fields(owner)}
    wrong: list[InputError] = []
    for name, one in keys.items():
        value = values[name]
        has_text = isinstance(value, str) or (type(value) is tuple and str in map(type, value))
        if has_text and one.unit in UNITS:
            with noted(wrong):
                values[name] = _parsed(value, one.unit, f"{owner.__name__}.{name}")
                object.__setattr__(self, name, values[name])
    written = {name for name, one in keys.items() if one.is_required or values[name] != one.default}
    refused = {error.path.partition(".")[2] for error in wrong}
    for fault in faults_of(owner, keys, values, written, refused):
        where = owner.__name__ + "".join(f"[{x + 1}]" if isinstance(x, int) else f".{x}" for x in fault.path)
        wrong.append(InputError(where, fault.rule, _got(fault, owner, values), fault.cure))
    if wrong:
        raise together(wrong)


def _parsed(value: Any, unit: str, where: str) -> Any:
    """A text as a number in SI, or each text of a tuple."""
    if isinstance(value, str):
        return parse(value, unit, where)
    return tuple(parse(one, unit, where) if isinstance(one, str) else one for one in value)


def _got(fault: Fault, owner: type, values: Mapping[str, Any]) -> str:
    """Value of a fault for a message, where no file has its text."""
    if fault.got is not None or not fault.path:
        return fault.got or ""
    name, *rest = fault.path
    value, unit = values[str(name)], unit_of(owner, str(name))
    for part in rest:
        if is_record(type(value)):
            value, unit = getattr(value, str(part)), unit_of(type(value), str(part))
        else:
            value = value[part]
    if value is None:
        return ""
    if unit and is_number(value) and math.isfinite(value):
        return format_quantity(value, unit, 8) + (f" ({value:.5g} rad)" if unit == "rad" else "")
    return shown(value)
