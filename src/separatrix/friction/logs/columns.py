"""What the columns of a table mean: from the column map, else from the published names and units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from separatrix.errors import InputError
from separatrix.friction.logs.clock import CLOCK
from separatrix.friction.logs.column_map import ColumnChoice, ColumnMap
from separatrix.friction.logs.formats import PLAIN, Layout
from separatrix.friction.logs.log import ABSCISSAE, MEANINGS, ColumnRead
from separatrix.friction.logs.names import (
    CLOCKS,
    Scale,
    header_parts,
    known_units,
    looks_extreme,
    looks_like_force,
    looks_like_friction,
    plain,
    ranks,
    scale_of,
)
from separatrix.units import printable, shown

LAST = 9
"""Rank of times as text: a column of seconds is finer."""


NO_UNIT = "has no unit, so that its meaning is not sure"


@dataclass(frozen=True, slots=True)
class Chosen:
    """One column that is used: where it stands, how it comes to SI, and its sign."""

    index: int
    scale: Scale
    unit: str
    why: str
    sign: int = 1


@dataclass(frozen=True, slots=True)
class _Option:
    """What one column may mean, by its name; no scale where its unit does not fit or is not there."""

    meaning: str
    rank: int
    unit: str
    scale: Scale | None


@dataclass(slots=True)
class Understood:
    """The columns that are used by meaning, and what was said about every column."""

    used: dict[str, Chosen]
    columns: tuple[ColumnRead, ...]
    unsettled: dict[str, list[int]] = field(default_factory=dict)
    twins: dict[str, list[int]] = field(default_factory=dict)
    """Other columns of the same name and unit as the one used; they must hold the same numbers."""
    """Columns that could have each meaning, had they a unit or were they alone."""


def understand(
    headers: Sequence[str],
    units: Sequence[str],
    source: str,
    columns: ColumnMap,
    layout: Layout = PLAIN,
    *,
    constant_force: bool = False,
) -> Understood:
    """Meaning of each column.

    Parameters
    ----------
    headers, units : sequence of str
        As the file writes them; a unit may be empty and stand in the header instead.
    source : str
        Names the file in a refusal.
    columns : ColumnMap
        Its `[columns]` go first.
    layout : Layout
        What the instrument's format says.
    constant_force : bool
        The normal force is known, so that the tangential force alone gives the friction.

    Raises
    ------
    InputError
        Friction or its abscissa cannot be told; which columns could be it, and the line that settles it.
    """
    given = {
        meaning: _given(meaning, choice, headers, units, source, layout)
        for meaning, choice in columns.columns.items()
    }
    _refuse_same(given, headers, source)
    options = {
        i: _options(headers[i], units[i], layout)
        for i in range(len(headers))
        if i not in {chosen.index for chosen in given.values()}
    }
    used, unsettled, twins = _decided(options, given, headers)
    if "tangential_force" in given and "friction" not in given:
        used.pop("friction", None)
    result = Understood(used, (), unsettled, twins)
    _require_friction(result, headers, source, options, columns, constant_force)
    _require_abscissa(result, headers, source, options)
    result.columns = _read(headers, units, options, result)
    return result


def _refuse_same(given: dict[str, Chosen], headers: Sequence[str], source: str) -> None:
    taken: dict[int, str] = {}
    for meaning, chosen in given.items():
        other = taken.setdefault(chosen.index, meaning)
        if other != meaning:
            rule = f"is both {_words(other)} and {_words(meaning)} in the column map"
            raise InputError(f"{source}: column {shown(headers[chosen.index].strip())}", rule)


def _given(
    meaning: str,
    choice: ColumnChoice,
    headers: Sequence[str],
    units: Sequence[str],
    source: str,
    layout: Layout,
) -> Chosen:
    index = _place(meaning, choice, headers, source)
    if meaning == "friction" and not choice.unit and looks_like_force(headers[index]):
        rule = "is a force by its name, not a coefficient of friction"
        cure = f'{_forces_line(headers, index)} If it is a coefficient all the same, add unit = "-" here.'
        raise InputError(_column(source, headers[index]), rule, cure=cure)
    ways = header_parts(layout.rename(headers[index]))
    beside = [unit for _, unit in ways if unit and _scale(meaning, unit, layout)]
    if not choice.unit and beside:
        written = [_agreed(units[index], beside[0], meaning, layout)]
    else:
        written = [choice.unit or units[index], ways[0][1], layout.units.get(ways[0][0], "")]
    for unit in [unit for unit in written if unit] + [""]:
        scale = _scale(meaning, unit, layout)
        if scale is not None:
            return Chosen(index, scale, unit, "column map", choice.sign)
    raise _unit_wanted(meaning, headers[index], next((unit for unit in written if unit), ""), source)


def _scale(meaning: str, unit: str, layout: Layout) -> Scale | None:
    return scale_of(layout.spellings.get((meaning, unit), unit), meaning)


def _agreed(unit: str, beside: str, meaning: str, layout: Layout) -> str:
    """The unit of the line of units, else that beside the name; both, where they are not the same."""
    if not unit or not beside:
        return unit or beside
    first, second = _scale(meaning, unit, layout), _scale(meaning, beside, layout)
    return f"{beside}, {unit}" if first and second and first != second else unit


def _place(meaning: str, choice: ColumnChoice, headers: Sequence[str], source: str) -> int:
    if choice.number is not None:
        if choice.number > len(headers):
            rule = f"has {len(headers)} columns, not {choice.number}, as the column map says for {meaning}"
            raise InputError(source, rule)
        return choice.number - 1
    name = choice.name or ""
    exact = [i for i, header in enumerate(headers) if header.strip() == name.strip()]
    near = [
        i
        for i, header in enumerate(headers)
        if plain(name) in {plain(header), *(plain(part) for part, _ in header_parts(header))} - {""}
    ]
    found = exact or near
    if len(found) == 1:
        return found[0]
    if not found:
        rule = f"has no column {shown(name)}, which the column map says is {meaning}"
        raise InputError(source, rule, cure=f"It has {_listed(headers, range(len(headers)))}.")
    numbers = " or ".join(str(i + 1) for i in found)
    cure = f"Below [columns], give its number instead: {meaning} = {numbers}."
    raise InputError(source, f"has {len(found)} columns {shown(name)}", cure=cure)


def _options(header: str, unit: str, layout: Layout) -> list[_Option]:
    """What a column may mean: those meanings of its name whose unit fits, or all where it has no unit."""
    for way, (name, beside) in enumerate(header_parts(layout.rename(header))):
        options = [
            _option(meaning, rank, unit, beside or layout.units.get(name, ""), layout)
            for meaning, rank in ranks(name).items()
        ]
        options = [option for option in options if option.unit and option.scale] or options
        if options and (way == 0 or any(option.scale for option in options)):
            return options
    return [_Option("time", LAST, CLOCK, Scale())] if unit == CLOCK else []


def _option(meaning: str, rank: int, unit: str, beside: str, layout: Layout) -> _Option:
    if unit == CLOCK and beside in CLOCKS:
        beside = ""
    written = _agreed(unit, beside, meaning, layout)
    rank = LAST - 1 if unit == CLOCK else rank
    return _Option(meaning, rank, written, _scale(meaning, written, layout))


def _decided(
    options: dict[int, list[_Option]], given: dict[str, Chosen], headers: Sequence[str]
) -> tuple[dict[str, Chosen], dict[str, list[int]], dict[str, list[int]]]:
    """One column for each meaning where one is best; the others as columns that could have it; its twins."""
    used, unsettled = dict(given), {}
    twins: dict[str, list[int]] = {}
    for meaning in MEANINGS:
        if meaning in given:
            continue
        sure = {i: o[0] for i, o in options.items() if len(o) == 1 and o[0].meaning == meaning and o[0].scale}
        if sure:
            best = min(option.rank for option in sure.values())
            sure = {i: option for i, option in sure.items() if option.rank == best}
        if len({(headers[i].strip(), option.unit) for i, option in sure.items()}) == 1:
            (index, option), *others = sure.items()
            twins[meaning] = [i for i, _ in others]
            sure = {index: option}
            used[meaning] = Chosen(index, option.scale or Scale(), option.unit, "its name")
        unsure = [i for i, o in options.items() if i not in sure and any(x.meaning == meaning for x in o)]
        unsure = [i for i in unsure if i not in twins.get(meaning, [])]
        unsettled[meaning] = list(sure) if len(sure) > 1 else ([] if sure else unsure)
    return used, unsettled, twins


def _require_friction(
    result: Understood,
    headers: Sequence[str],
    source: str,
    options: dict[int, list[_Option]],
    columns: ColumnMap,
    constant_force: bool,
) -> None:
    forces = "tangential_force" in result.used and ("normal_force" in result.used or constant_force)
    chosen_forces = "tangential_force" in columns.columns
    if "friction" in result.used or (forces and (chosen_forces or len(result.unsettled["friction"]) < 1)):
        return
    for meaning in ("tangential_force", "normal_force") if chosen_forces else ("friction",):
        _refuse_unsettled(meaning, result, headers, source, options)
    if not chosen_forces and any(looks_like_friction(header) for header in headers):
        raise _no_friction(headers, source, result)
    for meaning, other in (("tangential_force", "normal_force"), ("normal_force", "tangential_force")):
        if other in result.used or result.unsettled[other]:
            _refuse_unsettled(meaning, result, headers, source, options)
    raise _no_friction(headers, source, result)


def _no_friction(headers: Sequence[str], source: str, result: Understood) -> InputError:
    """Refuse a table without friction: offer what may be a coefficient, else the forces that give one."""
    if "tangential_force" in result.used:
        rule = "has a tangential force but no normal force"
        cure = (
            'Below [columns] in a column map: normal_force = "...", or below [test]: normal_force = "... N".'
        )
        return InputError(source, rule, cure=cure)
    rule = "has no column that is known to be the friction, nor two forces that give it"
    near = sorted(
        (i for i, header in enumerate(headers) if looks_like_friction(header)),
        key=lambda i: looks_extreme(headers[i]),
    )
    forces = [i for i in range(len(headers)) if i not in near and _is_tangential(headers[i])]
    if near or not forces:
        name = headers[near[0]].strip() if near else "..."
        cure = f"Say which below [columns] in a column map: friction = {shown(name)}."
        if not near:
            cure += " A log without friction is of no use here: leave it out."
        return InputError(source, rule, _listed(headers, near or range(len(headers))), cure)
    return InputError(source, rule, _listed(headers, forces), _forces_line(headers, forces[0], result))


def _is_tangential(header: str) -> bool:
    words = plain(header)
    parts = ("fric", "reib", "frott", "tang", "lateral")
    return looks_like_force(header) and any(part in words for part in parts)


def _forces_line(headers: Sequence[str], index: int, result: Understood | None = None) -> str:
    """The lines of a column map that make friction from a force whose unit is not known."""
    if result is not None and "normal_force" in result.used:
        line = f'tangential_force = {{ name = {shown(headers[index].strip())}, unit = "N" }}'
        return f"Below [columns] in a column map, with the true unit: {line}."
    normal = [i for i in range(len(headers)) if i != index and "normal_force" in ranks(headers[i])]
    name = shown(headers[index].strip())
    lines = f'tangential_force = {{ name = {name}, unit = "N" }}'
    if normal:
        lines += f' and normal_force = {{ name = {shown(headers[normal[0]].strip())}, unit = "N" }}'
        return f"Below [columns] in a column map, with the true units: {lines}."
    load = 'below [test] normal_force = "... N"'
    return f"In a column map, with the true unit and load: below [columns] {lines}, {load}."


def _require_abscissa(
    result: Understood, headers: Sequence[str], source: str, options: dict[int, list[_Option]]
) -> None:
    if any(meaning in result.used for meaning in ABSCISSAE):
        return
    for meaning in ABSCISSAE:
        _refuse_unsettled(meaning, result, headers, source, options)
    rule = "has no column that is known to be time, distance or cycles"
    cure = 'Say which below [columns] in a column map: time = { name = "...", unit = "s" }.'
    raise InputError(source, rule, _listed(headers, range(len(headers))), cure)


def _refuse_unsettled(
    meaning: str, result: Understood, headers: Sequence[str], source: str, options: dict[int, list[_Option]]
) -> None:
    """Refuse if there are columns that could have the meaning, with the line that settles it."""
    places = result.unsettled[meaning]
    if meaning in result.used or not places:
        return
    if len(places) == 1:
        option = next(o for o in options[places[0]] if o.meaning == meaning)
        if meaning == "tangential_force" and not option.unit and "normal_force" not in result.used:
            cure = _forces_line(headers, places[0])
            raise InputError(_column(source, headers[places[0]]), NO_UNIT, cure=cure)
        raise _unit_wanted(meaning, headers[places[0]], option.unit, source, options[places[0]])
    twice = len({headers[i].strip() for i in places}) < len(places)
    choice = str(places[0] + 1) if twice else shown(headers[places[0]].strip())
    rule = f"has {len(places)} columns that could be the {_words(meaning)}"
    cure = f"Say which below [columns] in a column map: {meaning} = {choice}."
    raise InputError(source, rule, _listed(headers, places), cure)


def _column(source: str, header: str) -> str:
    return f"{source}: column {shown(header.strip())}"


def _unit_wanted(
    meaning: str, header: str, unit: str, source: str, options: Sequence[_Option] = ()
) -> InputError:
    name = shown(header.strip())
    others = [option.meaning for option in options if option.meaning != meaning]
    line = f'{meaning} = {{ name = {name}, unit = "{MEANINGS[meaning]}" }}'
    cure = f"Below [columns] in a column map, with the true unit: {line}."
    if others and not unit:
        cure = cure[:-1] + f" (or {others[0]})."
    if unit:
        rule = f"has a unit that is not one of the {_words(meaning)} ({known_units(meaning)})"
        return InputError(f"{source}: column {name}", rule, shown(unit), cure)
    return InputError(f"{source}: column {name}", NO_UNIT, cure=cure)


def _read(
    headers: Sequence[str],
    units: Sequence[str],
    options: dict[int, list[_Option]],
    result: Understood,
) -> tuple[ColumnRead, ...]:
    by_index = {chosen.index: (meaning, chosen) for meaning, chosen in result.used.items()}
    reads = []
    for i, header in enumerate(headers):
        if i in by_index:
            meaning, chosen = by_index[i]
            read = ColumnRead(header=header.strip(), meaning=meaning, unit=chosen.unit, why=chosen.why)
        else:
            why = _why_not(i, options.get(i, []), result)
            read = ColumnRead(header=header.strip(), meaning=None, unit=units[i], why=why)
        reads.append(read)
    return tuple(reads)


def _why_not(index: int, options: list[_Option], result: Understood) -> str:
    if not options:
        return "not needed"
    option = options[0]
    if option.scale is None:
        said = f'the unit "{printable(option.unit)}" does not fit' if option.unit else "it has no unit"
        return f"could be {_words(option.meaning)}, but {said}"
    if index in result.twins.get(option.meaning, []):
        return f"the same as the column of {_words(option.meaning)}"
    if option.meaning in result.used:
        return f"another column is the {_words(option.meaning)}"
    return f"one of several that could be {_words(option.meaning)}"


def _words(meaning: str) -> str:
    return meaning.replace("_", " ")


def _listed(headers: Sequence[str], places: Sequence[int] | range) -> str:
    names = [shown(headers[i].strip()) for i in places if headers[i].strip()]
    more = f" and {len(names) - 8} more" if len(names) > 8 else ""
    return "columns " + ", ".join(names[:8]) + more
