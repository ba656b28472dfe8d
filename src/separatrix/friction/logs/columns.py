"""What the columns of a table mean: from the column map, else from the published names and units."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from separatrix.friction.logs.column_map import ColumnChoice, ColumnMap
from separatrix.friction.logs.dialect import CLOCK
from separatrix.friction.logs.header import PLAIN, Layout
from separatrix.friction.logs.log import ColumnRead
from separatrix.friction.logs.names import (
    ABSCISSAE,
    CLOCKS,
    MASSES,
    MEANINGS,
    Scale,
    header_parts,
    known_units,
    looks_extreme,
    looks_like_force,
    looks_like_friction,
    looks_like_torque,
    plain,
    ranks,
    scale_of,
    torque_scale,
)
from separatrix.ground.errors import InputError
from separatrix.ground.units import Metre, printable, shown

LAST = 9  # rank of times as text: a column of seconds is finer
NO_UNIT = "has no unit, so that its meaning is not certain"
DIVIDED = "divided by the radius of the track"
IN_MAP = "Below [columns] in a column map"


@dataclass(frozen=True, slots=True)
class Meant:
    """What one column means, or may mean by its name; without a scale its unit is missing or does not fit."""

    index: int
    meaning: str
    unit: str
    scale: Scale | None
    rank: int = 0
    sign: int = 1
    why: str = "its name"


@dataclass(slots=True)
class Understood:
    """The columns that are used by meaning, and what was read of every column."""

    used: dict[str, Meant] = field(default_factory=dict)
    columns: tuple[ColumnRead, ...] = ()
    unsettled: dict[str, list[int]] = field(default_factory=dict)
    """Columns that could have each meaning, had they a unit or were they the only one."""
    twins: dict[str, list[int]] = field(default_factory=dict)
    """Other columns of the same name and unit as the one used; they must have the same numbers."""


def understand(
    headers: Sequence[str],
    units: Sequence[str],
    source: str,
    columns: ColumnMap,
    layout: Layout = PLAIN,
    *,
    constant_force: bool = False,
    track_radius: Metre | None = None,
) -> Understood:
    """Meaning of each column; `[columns]` of the column map goes first.

    With a constant normal force the tangential force alone determines the friction. A torque that the map
    names is divided by the radius of the track.
    """
    table = _Table(headers, units, source, layout, track_radius)
    given: dict[str, Meant] = {}
    for meaning, choice in columns.columns.items():
        chosen = table.given(meaning, choice)
        other = next((name for name, one in given.items() if one.index == chosen.index), None)
        if other is not None:
            rule = f"is both {_words(other)} and {_words(meaning)} in the column map"
            raise InputError(table.column(chosen.index), rule)
        given[meaning] = chosen
    taken = {chosen.index for chosen in given.values()}
    options = {i: table.options(i) for i in range(len(headers)) if i not in taken}
    result = _decided(options, given, headers)
    if "tangential_force" in given and "friction" not in given:
        result.used.pop("friction", None)
    _require_friction(result, table, options, "tangential_force" in given, constant_force)
    if not any(meaning in result.used for meaning in ABSCISSAE):
        for meaning in ABSCISSAE:
            _refuse_unsettled(meaning, result, table, options)
        rule = "has no column that is known to be time, distance or cycles"
        cure = 'State which below [columns] in a column map: time = { name = "...", unit = "s" }.'
        raise InputError(source, rule, table.listed(range(len(headers))), cure)
    by_index = {one.index: one for one in result.used.values()}
    result.columns = tuple(
        ColumnRead(header=header.strip(), meaning=one.meaning, unit=one.unit, why=one.why)
        if (one := by_index.get(i)) is not None
        else ColumnRead(header=header.strip(), meaning=None, unit=units[i], why=_why_not(options[i], result))
        for i, header in enumerate(headers)
    )
    return result


@dataclass(frozen=True, slots=True)
class _Table:
    """Headers and units of one table."""

    headers: Sequence[str]
    units: Sequence[str]
    source: str
    layout: Layout
    track_radius: Metre | None

    def column(self, i: int) -> str:
        """Place of a column for a refusal."""
        return f"{self.source}: column {self.name(i)}"

    def name(self, i: int) -> str:
        """Header in quotes."""
        return shown(self.headers[i].strip())

    def listed(self, places: Iterable[int]) -> str:
        """Headers of the first of these columns, and how many more there are."""
        names = [self.name(i) for i in places if self.headers[i].strip()]
        more = f" and {len(names) - 8} more" if len(names) > 8 else ""
        return "columns " + ", ".join(names[:8]) + more

    def scale(self, meaning: str, unit: str) -> Scale | None:
        """Scale of a unit as this format spells it."""
        return scale_of(self.layout.spellings.get((meaning, unit), unit), meaning)

    def agreed(self, unit: str, beside: str, meaning: str) -> str:
        """The unit of the line of units, else that beside the name; both, where they are not the same."""
        if not unit or not beside:
            return unit or beside
        first, second = self.scale(meaning, unit), self.scale(meaning, beside)
        return f"{beside}, {unit}" if first and second and first != second else unit

    def given(self, meaning: str, choice: ColumnChoice) -> Meant:
        """Column that the map names."""
        i = self._place(meaning, choice)
        header, unit = self.headers[i], self.units[i]
        if meaning == "friction" and not choice.unit and looks_like_force(header):
            rule = "is a force by its name, not a coefficient of friction"
            cure = f'{_forces_line(self, i)} If it is a coefficient all the same, add unit = "-" here.'
            raise InputError(self.column(i), rule, cure=cure)
        if meaning == "tangential_force" and looks_like_torque(header, unit):
            return self._torque(i, choice)
        ways = header_parts(self.layout.rename(header))
        beside = [part for _, part in ways if part and self.scale(meaning, part)]
        written = [choice.unit or unit, ways[0][1], self.layout.units.get(ways[0][0], "")]
        if not choice.unit and beside:
            written = [self.agreed(unit, beside[0], meaning)]
        written = [one for one in written if one] + [""]
        for one in written:
            scale = self.scale(meaning, one)
            if scale is not None:
                return Meant(i, meaning, one, scale, sign=choice.sign, why="column map")
        raise _unit_wanted(self, i, meaning, written[0])

    def _torque(self, i: int, choice: ColumnChoice) -> Meant:
        """Column of torque that the map names as the tangential force."""
        if self.track_radius is None:
            raise _torque_refused(self, i)
        written = [choice.unit or "", self.units[i], *(part for _, part in header_parts(self.headers[i]))]
        unit = next((one for one in written if one), "")
        scale = torque_scale(unit)
        if scale is None:
            raise _torque_refused(self, i)
        force = Scale(factor=scale.factor / self.track_radius)
        return Meant(i, "tangential_force", unit, force, sign=choice.sign, why=f"column map, {DIVIDED}")

    def _place(self, meaning: str, choice: ColumnChoice) -> int:
        if choice.number is not None:
            if choice.number > len(self.headers):
                rule = f"has {len(self.headers)} columns, not {choice.number}"
                raise InputError(self.source, f"{rule}, as the column map states for {meaning}")
            return choice.number - 1
        name = choice.name or ""
        found = [i for i, header in enumerate(self.headers) if header.strip() == name.strip()]
        if not found:
            parts = [{header, *(part for part, _ in header_parts(header))} for header in self.headers]
            found = [i for i, names in enumerate(parts) if plain(name) in {plain(n) for n in names} - {""}]
        if len(found) == 1:
            return found[0]
        if not found:
            rule = f"has no column {shown(name)}, which the column map names as {meaning}"
            raise InputError(self.source, rule, cure=f"It has {self.listed(range(len(self.headers)))}.")
        numbers = " or ".join(str(i + 1) for i in found)
        cure = f"Below [columns], write its number instead: {meaning} = {numbers}."
        raise InputError(self.source, f"has {len(found)} columns {shown(name)}", cure=cure)

    def options(self, i: int) -> list[Meant]:
        """What a column may mean: those meanings of its name whose unit fits, or all where it has no unit."""
        unit = self.units[i]
        for way, (name, part) in enumerate(header_parts(self.layout.rename(self.headers[i]))):
            found = []
            for meaning, rank in ranks(name).items():
                beside = part or self.layout.units.get(name, "")
                written = self.agreed(unit, "" if unit == CLOCK and beside in CLOCKS else beside, meaning)
                rank = LAST - 1 if unit == CLOCK else rank
                found.append(Meant(i, meaning, written, self.scale(meaning, written), rank))
            found = [one for one in found if one.unit and one.scale] or found
            if found and (way == 0 or any(one.scale for one in found)):
                return found
        return [Meant(i, "time", CLOCK, Scale(), LAST)] if unit == CLOCK else []


Options = dict[int, list[Meant]]  # what each column that the map does not name may mean


def _decided(options: Options, given: dict[str, Meant], headers: Sequence[str]) -> Understood:
    """One column for each meaning where one is best; the others as columns that could have it; its twins."""
    result = Understood(used=dict(given))
    for meaning in MEANINGS:
        if meaning in given:
            continue
        sure = [o[0] for o in options.values() if len(o) == 1 and o[0].meaning == meaning and o[0].scale]
        best = min((one.rank for one in sure), default=0)
        sure = [one for one in sure if one.rank == best]
        twins: list[int] = []
        if len({(headers[one.index].strip(), one.unit) for one in sure}) == 1:
            result.used[meaning], *others = sure
            twins = result.twins[meaning] = [one.index for one in others]
            sure = sure[:1]
        places = [one.index for one in sure]
        if len(sure) < 2:
            unsure = [i for i, o in options.items() if any(one.meaning == meaning for one in o)]
            places = [] if sure else [i for i in unsure if i not in twins]
        result.unsettled[meaning] = places
    return result


def _require_friction(
    result: Understood, table: _Table, options: Options, chosen_forces: bool, constant_force: bool
) -> None:
    """Refuse a table without friction: offer what may be a coefficient, else the two forces."""
    forces = "tangential_force" in result.used and ("normal_force" in result.used or constant_force)
    if "friction" in result.used or (forces and (chosen_forces or not result.unsettled["friction"])):
        return
    every = range(len(table.headers))
    torques = [i for i in every if looks_like_torque(table.headers[i], table.units[i])]
    if torques and "tangential_force" not in result.used and not result.unsettled["tangential_force"]:
        raise _torque_refused(table, torques[0])
    near = [i for i in every if looks_like_friction(table.headers[i])]
    for meaning in ("tangential_force", "normal_force") if chosen_forces else ("friction",):
        _refuse_unsettled(meaning, result, table, options)
    if chosen_forces or not near:
        for meaning, other in (("tangential_force", "normal_force"), ("normal_force", "tangential_force")):
            if other in result.used or result.unsettled[other]:
                _refuse_unsettled(meaning, result, table, options)
    if "tangential_force" in result.used:
        cure = f'{IN_MAP}: normal_force = "...", or below [test]: normal_force = "... N".'
        raise InputError(table.source, "has a tangential force but no normal force", cure=cure)
    rule = "has no column that is known to be the friction, nor two forces from which it follows"
    near.sort(key=lambda i: looks_extreme(table.headers[i]))
    parts = ("fric", "reib", "frott", "tang", "lateral")
    tangential = [i for i in every if any(part in plain(table.headers[i]) for part in parts)]
    tangential = [i for i in tangential if i not in near and looks_like_force(table.headers[i])]
    if tangential and not near:
        line = _forces_line(table, tangential[0], with_load="normal_force" not in result.used)
        raise InputError(table.source, rule, table.listed(tangential), line)
    name = table.name(near[0]) if near else '"..."'
    cure = f"State which below [columns] in a column map: friction = {name}."
    raise InputError(table.source, rule, table.listed(near or every), cure)


def _forces_line(table: _Table, i: int, *, with_load: bool = True) -> str:
    """The lines of a column map that make friction from a force whose unit is not known."""
    line = f'tangential_force = {{ name = {table.name(i)}, unit = "{_advised(table, i)}" }}'
    if not with_load:
        return f"{IN_MAP}, with the true unit: {line}."
    normal = [k for k, header in enumerate(table.headers) if k != i and "normal_force" in ranks(header)]
    if normal:
        unit = _advised(table, normal[0])
        line += f' and normal_force = {{ name = {table.name(normal[0])}, unit = "{unit}" }}'
        return f"{IN_MAP}, with the true units: {line}."
    load = 'below [test] normal_force = "... N"'
    return f"In a column map, with the true unit and load: below [columns] {line}, {load}."


def _advised(table: _Table, i: int, meaning: str = "normal_force") -> str:
    """The unit to write for a column: its own if it fits, the force that a mass means, or that of SI."""
    written = [one for one in (table.units[i], *(part for _, part in header_parts(table.headers[i]))) if one]
    for unit in written:
        if scale_of(unit, meaning):
            return unit
        if MEANINGS[meaning] == "N" and unit in MASSES:
            return MASSES[unit]
    stated = table.units[i] or header_parts(table.headers[i])[0][1]
    return "..." if stated else MEANINGS[meaning]


def _torque_refused(table: _Table, i: int) -> InputError:
    unit = table.units[i] or header_parts(table.headers[i])[0][1]
    unit = unit if torque_scale(unit) else "N m"
    line = f'tangential_force = {{ name = {table.name(i)}, unit = "{unit}" }}'
    cure = (
        f"Divide it by the radius of the track, or in a column map: below [columns] {line}, "
        'below [test] track_radius = "... mm".'
    )
    return InputError(table.column(i), "is a torque, not a force", cure=cure)


def _refuse_unsettled(meaning: str, result: Understood, table: _Table, options: Options) -> None:
    """Refuse if there are columns that could have the meaning, with the line that settles it."""
    places = result.unsettled[meaning]
    if meaning in result.used or not places:
        return
    first = places[0]
    if len(places) == 1:
        option = next(one for one in options[first] if one.meaning == meaning)
        if meaning == "tangential_force" and not option.unit and "normal_force" not in result.used:
            raise InputError(table.column(first), NO_UNIT, cure=_forces_line(table, first))
        others = [one.meaning for one in options[first] if one.meaning != meaning]
        raise _unit_wanted(table, first, meaning, option.unit, others)
    twice = len({table.headers[i].strip() for i in places}) < len(places)
    choice = str(first + 1) if twice else table.name(first)
    rule = f"has {len(places)} columns that could be the {_words(meaning)}"
    cure = f"State which below [columns] in a column map: {meaning} = {choice}."
    raise InputError(table.source, rule, table.listed(places), cure)


def _unit_wanted(table: _Table, i: int, meaning: str, unit: str, others: Sequence[str] = ()) -> InputError:
    advised = _advised(table, i, meaning) if unit else MEANINGS[meaning]
    line = f'{meaning} = {{ name = {table.name(i)}, unit = "{advised}" }}'
    cure = f"{IN_MAP}, with the true unit: {line}"
    if unit:
        rule = f"has a unit that is not one of the {_words(meaning)} ({known_units(meaning)})"
        return InputError(table.column(i), rule, shown(unit), f"{cure}.")
    return InputError(table.column(i), NO_UNIT, cure=f"{cure} (or {others[0]})." if others else f"{cure}.")


def _why_not(options: Sequence[Meant], result: Understood) -> str:
    if not options:
        return "not needed"
    one, words = options[0], _words(options[0].meaning)
    if one.scale is None:
        fault = f'the unit "{printable(one.unit)}" does not fit' if one.unit else "it has no unit"
        return f"could be {words}, but {fault}"
    if one.index in result.twins.get(one.meaning, []):
        return f"the same as the column of {words}"
    used = one.meaning in result.used
    return f"another column is the {words}" if used else f"one of several that could be {words}"


def _words(meaning: str) -> str:
    return meaning.replace("_", " ")
