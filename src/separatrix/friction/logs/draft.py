"""A draft of a column map: what a log shows, with a question at all that it does not state for certain."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from separatrix.friction.logs import names as naming
from separatrix.friction.logs import tables
from separatrix.friction.logs.column_map import Column, ColumnMap, TextFormat, given_in
from separatrix.friction.logs.conditions import metadata_of
from separatrix.friction.logs.log import UnfitError, decimal_of, stated_units
from separatrix.ground.errors import InputError
from separatrix.ground.toml import as_toml
from separatrix.ground.units import printable

CHECK = "# guess, check"
UNKNOWN = "..."  # is refused until it is edited
USUAL = {
    "time": "s",
    "distance": "m",
    "temperature": "degC",
    "wear_depth": "um",
    "friction": "-",
    "cycles": "-",
}
"""Units that a draft offers where the file states none, to be checked; of others N."""

MOST_ROWS = 20_000  # of which a column is looked at in all
SAMPLE = 50  # rows of a column that are looked at
_CLOCK = re.compile(r"\d{1,4}:\d{1,2}:\d{1,2}(?:[.,:]\d+)?\s*(?:[AaPp]\.?[Mm]\.?)?")
_ISO = re.compile(r"\d{4}-\d{2}-\d{2}[T ]\d{2}:\d{2}(?::\d{2}(?:[.,]\d+)?)?(Z|[+-]\d{2}:?\d{2})?")
_DATE = re.compile(
    r"(\d{1,2})([./-])(\d{1,2}|[A-Za-z]{3})\2(\d{4}|\d{2})(\D{1,2})(\d{1,2}):\d{2}(:\d{2})?([.,]\d+)?"
    r"( ?[AaPp][Mm])?"
)


@dataclass(frozen=True, slots=True)
class Option:
    """A column that may have a meaning: how usual its name is, its unit, and whether that is certain."""

    rank: int
    index: int
    unit: str = ""  # as the file states it; empty for none
    known: bool = False
    question: str = ""


Options = dict[str, list[Option]]  # by meaning


@dataclass(slots=True)
class Draft:
    """Lines of the column map of a table, what has to be looked at, and what is not used."""

    given: ColumnMap
    stated: Mapping[str, Any]  # conditions of the file
    block: tables.Block
    cells: list[list[str]]  # of each column
    form: list[str] = field(default_factory=list)
    columns: dict[str, str] = field(default_factory=dict)  # by meaning
    used: set[int] = field(default_factory=set)  # columns that have such a line
    test: list[str] = field(default_factory=list)
    seen: list[str] = field(default_factory=list)
    questions: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def head(self, i: int) -> str:
        """The head of a column, in quotes."""
        return as_toml(self.block.heads[i].strip())

    def ask(self, line: str, question: str) -> str:
        """Return a line with its question, which is noted."""
        self.questions.append(question)
        return f"{line}  {CHECK}: {printable(question, 200)}"

    def text(self, name: str) -> str:
        """The map, ready to be looked at."""
        lines = [
            f'# Draft of a column map for {name}: check each line with "guess, check", then add --map.',
            f"name = {as_toml(f'map of {name}'[:200])}",
            *("", "[format]", *self.form, "", "[columns]", *self.columns.values(), "", "[test]"),
        ]
        written = self.given.as_written
        lines += [f"{key} = {as_toml(value)}" for key, value in written.get("test", {}).items()] + self.test
        for pattern, section in written.get("files", {}).items():
            lines += ["", f"[files.{as_toml(pattern)}]"]
            lines += [f"{key} = {as_toml(value)}" for key, value in section.items()]
        about = "# The columns, with their first, middle and last values:"
        return "\n".join([*lines, "", about, *self.seen, ""])


def draft_of(content: tables.Content, given: ColumnMap, why: InputError | None) -> Draft:
    """Draft of the map of a file: of its first table without questions, else of its first.

    `given` is what the user and a known layout state; `why` is the reason that they do not suffice, if any.
    """
    stated = given.conditions(content.path)
    firsts = ((part.sheet, _first_block(part, given)) for part in content.parts)
    drafts = [(sheet, _draft(one[0], given, stated, *one[1:])) for sheet, one in firsts if one is not None]
    if not drafts:
        raise _no_table(content)
    name, chosen = next(((one, draft) for one, draft in drafts if not draft.questions), drafts[0])
    if len(drafts) > 1 and chosen.questions and not given.format.tables:
        listed = ", ".join(as_toml(one) for one, _ in drafts)
        chosen.form.append(chosen.ask(f"tables = [{as_toml(name)}]", f"one of {listed}?"))
    if why is not None:
        question = f"the map of this layout does not fit: {why.rule} {why.got}"
        chosen.form.insert(0, chosen.ask(f"# {given.name}", question))
    return chosen


def _no_table(content: tables.Content) -> InputError:
    cure = "It needs a line of column names above at least two rows; a column map can state where."
    for part in content.parts:
        signs = ((i, line, tables.separator_of([line])[0]) for i, line in enumerate(part.lines[:500]))
        rows = [i for i, line, sign in signs if sign and tables.is_row(tables.fields_of(line, sign))]
        if len(rows) == 1:
            where = f"{content.name}: {part.word} {rows[0] + 1}"
            return InputError(where, "is the only row", cure="A log has at least two.")
    return InputError(content.name, "has no table of numbers with two columns or more", cure=cure)


# --- the table ------------------------------------------------------------------------------------
def _first_block(
    part: tables.Part, given: ColumnMap
) -> tuple[tables.Block, TextFormat, dict[str, str]] | None:
    """The first table of a text, how it is written, and questions on that by the key of the format."""
    form = given.format
    separator, others = tables.separator_in(part, form)
    heads = _heads(part, separator, given) if separator else None
    if heads is None:
        return None
    asked = {"separator": f"or {' or '.join(map(as_toml, others))}?"} if others else {}
    form = form if part.sheet else TextFormat(**given_in(form) | {"separator": separator})
    names = heads.names if heads.line is not None and form.header_line is None else []
    block = next(tables.blocks_of_part(part, form, [(name,) for name in names if name.strip()]), None)
    if block is None and names and heads.line is not None:
        form = replace(form, header_line=heads.line + 1)
        asked["header_line"] = "its line of names?"
        block = next(tables.blocks_of_part(part, form, []), None)
    if block is None:
        return None
    if heads.line is None:
        block.heads = [""] * len(block.heads)
    if len(block.rows) > MOST_ROWS:  # the reader looks at all of them
        middle = block.rows[1000 : -1000 : len(block.rows) // 10_000]
        block.rows = [*block.rows[:1000], *middle, *block.rows[-1000:]]
    return block, form, asked


def _heads(part: tables.Part, separator: str, given: ColumnMap) -> tables.Heads | None:
    """Names of the first table: at the line that is stated, or below the first with the names stated."""
    if given.format.header_line is not None:
        return next(tables.heads_in(part, given.format, (), separator))
    named = [one.names for one in given.columns.values() if one.names and not one.optional]
    lines = ((i, tables.fields_of(line, separator)) for i, line in enumerate(part.lines) if named)
    start = next((i for i, heads in lines if all(tables.matching(names, heads) for names in named)), 0)
    missing = naming.MISSING | {one.casefold() for one in given.format.missing}
    return tables.first_table(part.lines, separator, missing, start)


# --- its columns ----------------------------------------------------------------------------------
def _draft(
    block: tables.Block,
    given: ColumnMap,
    stated: Mapping[str, Any],
    form: TextFormat,
    asked: Mapping[str, str],
) -> Draft:
    """What each column of a table means: certain by name and unit, or asked."""
    cells = tables.cells_of(block, range(len(block.heads)))
    draft, options = Draft(given, stated, block, cells), Options()
    for key, value in given_in(form).items():
        line = f"{key} = {as_toml(value)}"
        draft.form.append(draft.ask(line, asked[key]) if key in asked else line)
    for i, column in enumerate(cells):
        for meaning, option in _options(block, i, column).items():
            options.setdefault(meaning, []).append(option)
        values = ", ".join(column[k] for k in (0, len(column) // 2, -1)) if column else ""
        beside = f" {block.below[i]}" if block.below[i] else ""
        draft.seen.append(printable(f"# {i + 1:3d} {as_toml(block.heads[i])}{beside}: {values}", 150))
    _given(draft)
    _decide(draft, options)
    _decimal(draft)
    _conditions(draft)
    return draft


def _options(block: tables.Block, i: int, cells: Sequence[str]) -> dict[str, Option]:
    """Meanings that a column may have."""
    ways = naming.header_parts(block.heads[i])
    sample = [cell for cell in cells[:SAMPLE] if cell.casefold() not in naming.MISSING]
    clocks = [cell for cell in sample if tables.is_clock(cell)]
    if 2 * len(clocks) > len(sample):
        stated = stated_units(block.heads[i], block.below[i], "time", {})
        return {"time": _clock(8 if "time" in naming.ranks(ways[0][0]) else 9, i, stated, cells, clocks)}
    if 2 * sum(not tables.is_number(cell) for cell in sample) > len(sample):
        return {}
    for name, unit in ways:
        if unit.isdigit():  # COF_2: a station
            continue
        meanings = naming.ranks(name.rpartition(".")[2]) | naming.ranks(name)
        if naming.looks_extreme(ways[0][0]):
            meanings = {key: rank for key, rank in meanings.items() if not re.search("friction|force", key)}
        if meanings:
            only = len(meanings) == 1
            return {one: _option(block, i, one, rank, is_only=only) for one, rank in meanings.items()}
    return {}


def _option(block: tables.Block, i: int, meaning: str, rank: int, *, is_only: bool) -> Option:
    """A column of numbers with a usual name: certain where its unit is."""
    stated = stated_units(block.heads[i], block.below[i], meaning, {})
    scales = {naming.scale_of(one, meaning) for one in stated}
    known = (None not in scales and len(scales) == 1) or meaning == "position"
    known = known or (not stated and meaning in ("friction", "cycles") and is_only)
    unit = (stated[0] if known else ", ".join(stated)) if stated else ""
    if meaning in ("friction", "tangential_force"):
        known = known and not naming.looks_like_torque(block.heads[i], block.below[i])
    return Option(rank, i, unit, known)


def _clock(rank: int, i: int, stated: Sequence[str], cells: Sequence[str], clocks: Sequence[str]) -> Option:
    """A column of times as text, with how they are written."""
    form = next((form for one in stated if (form := naming.time_form(one))), "")
    if form in ("hh:mm", "mm:ss") or all(_CLOCK.fullmatch(one) for one in clocks):
        return Option(rank, i, form if form in ("hh:mm", "mm:ss") else "clock", known=True)
    if iso := [match for one in cells if (match := _ISO.fullmatch(one))]:
        zones = list(dict.fromkeys(match[1] or "no zone" for match in iso))
        question = f"its time zone changes: {', '.join(zones[:3])}" if len(zones) > 1 else ""
        return Option(rank, i, "iso", known=True, question=question)
    if dates := [match for one in cells if (match := _DATE.fullmatch(one))]:
        form, is_certain = _date_format(dates)
        return Option(rank, i, form, True, "" if is_certain else "is the day before the month?")
    if all(re.fullmatch(r"\d{1,4}:\d{1,2}(?:[.,]\d+)?", one) for one in clocks):
        return Option(rank, i, question="minutes and seconds, or hours and minutes (hh:mm)?")
    return Option(rank, i, UNKNOWN)


def _date_format(dates: Sequence[re.Match[str]]) -> tuple[str, bool]:
    """Format of dates, and whether their numbers show which of them is the day."""
    one = dates[0]
    order, is_certain = ("%d", "%b"), True
    if not one[3].isalpha():
        first, second = (max(int(match[k]) for match in dates) for k in (1, 3))
        order, is_certain = (("%m", "%d") if second > 12 else ("%d", "%m")), max(first, second) > 12
    date = one[2].join((*order, "%Y" if len(one[4]) == 4 else "%y"))
    time = ("%I" if one[9] else "%H") + ":%M" + (":%S" if one[7] else "") + (".%f" if one[8] else "")
    half = "" if not one[9] else " %p" if one[9][0] == " " else "%p"
    return f"{date}{one[5]}{time}{half}", is_certain


# --- the lines of the map -------------------------------------------------------------------------
def _given(draft: Draft) -> None:
    """Columns that are stated already, with their lines; what the table does not have is asked."""
    heads = draft.block.heads
    for meaning, one in draft.given.columns.items():
        places = tables.matching(one.names, heads) if one.number is None else [one.number - 1]
        if places and max(places) < len(heads):
            draft.columns[meaning] = _of_twins(draft, meaning, one, places)
            draft.used |= set(places)
        elif not one.optional:
            name = one.names[0] if one.names else f"number {one.number}"
            draft.questions.append(f"no column {as_toml(name)}, which the column map names as {meaning}")


def _of_twins(draft: Draft, meaning: str, one: Column, places: Sequence[int]) -> str:
    """The line of columns of one name; asked by number where their numbers differ."""
    if all(draft.cells[i] == draft.cells[places[0]] for i in places[1:]):
        return _stated(meaning, one)
    numbers = f"{places[0] + 1} or {' or '.join(str(i + 1) for i in places[1:])}"
    question = f"{len(places)} columns that could be the {meaning.replace('_', ' ')}: {numbers}?"
    return draft.ask(_stated(meaning, replace(one, name=places[0] + 1)), question)


def _stated(meaning: str, one: Column) -> str:
    name = one.names[0] if len(one.names) == 1 else one.name
    more = ({"unit": one.unit} if one.unit else {}) | ({"sign": -1} if one.sign < 0 else {})
    more |= {"optional": True} if one.optional else {}
    return f"{meaning} = {as_toml({'name': name} | more if more or isinstance(name, tuple) else name)}"


def _line(draft: Draft, meaning: str, option: Option, unit: str = "") -> str:
    """One line of [columns]: the name without its unit where that is unique, else the whole or the number."""
    heads, i = draft.block.heads, option.index
    head = " ".join(heads[i].split())
    bare = naming.header_parts(head)[0][0]
    named = bare if bare and tables.matching([bare], heads) == [i] else head
    unit = unit or (option.unit if meaning == "time" and naming.time_form(option.unit) else "")
    optional = meaning in ("temperature", "wear_depth")
    choice = Column(name=(named,) if named else i + 1, unit=unit or None, optional=optional)
    return _of_twins(draft, meaning, choice, tables.matching([named], heads) if named else [i])


def _decide(draft: Draft, options: Options) -> None:
    """One line of the map for each meaning that is there: certain, asked, or noted as not used."""
    meanings = (*naming.MEANINGS, "position")
    free = {key: [one for one in some if one.index not in draft.used] for key, some in options.items()}
    sure = {key: _best([one for one in free.get(key, ()) if one.known]) for key in meanings}
    needed = _needed(draft, free, sure)
    for meaning in meanings:
        if meaning in draft.columns:
            continue
        chosen = [one for one in sure[meaning] if one.index not in draft.used]
        rest = [one for one in free.get(meaning, ()) if one.index not in draft.used]
        if chosen:
            _choose(draft, meaning, chosen, is_needed=meaning in needed or meaning == "time")
            draft.used |= {one.index for one in chosen}
        elif rest and meaning in needed:
            _ask(draft, meaning, _best(rest))
        elif rest and meaning in ("temperature", "wear_depth", "normal_force", "distance"):
            head, words = printable(draft.block.heads[rest[0].index].strip()), meaning.replace("_", " ")
            draft.notes.append(f'column "{head}" has no known unit and is not used as {words}')
    for meaning in sorted(needed - draft.columns.keys()):
        _ask(draft, meaning, [])
    _shapes(draft, options)


def _needed(draft: Draft, free: Options, sure: Options) -> set[str]:
    """Meanings that the map must have: friction, or the forces instead; and an abscissa."""
    has_load = "normal_force" in draft.columns or sure["normal_force"] or "normal_force" in draft.stated
    by_name = any(map(naming.looks_like_friction, draft.block.heads))
    has_friction = sure["friction"] or free.get("friction") or by_name
    forces = sure["tangential_force"] if has_load else []
    forces = forces or ([] if has_friction else free.get("tangential_force", []))
    by_forces = "tangential_force" in draft.columns or (forces and not sure["friction"])
    needed = {"friction"}
    if by_forces and "friction" not in draft.columns:
        needed = {"tangential_force", "normal_force"}
        sure["friction"], free["friction"] = [], []
    if not any(name in draft.columns or sure[name] for name in naming.ABSCISSAE):
        needed.add(next((name for name in naming.ABSCISSAE if free.get(name)), "time"))
    return needed


def _best(options: Sequence[Option]) -> list[Option]:
    lowest = min((one.rank for one in options), default=0)
    return [one for one in options if one.rank == lowest]


def _choose(draft: Draft, meaning: str, chosen: Sequence[Option], *, is_needed: bool) -> None:
    """The line of columns that are certain; asked where several of other names are."""
    count, words = len(draft.questions), meaning.replace("_", " ")
    line = _line(draft, meaning, chosen[0])
    names = list(dict.fromkeys(draft.head(one.index) for one in chosen))
    units = {naming.scale_of(one.unit, meaning) if one.unit else None for one in chosen}
    if len(draft.questions) > count and not is_needed:
        del draft.questions[count:]
        draft.notes.append(f"columns {names[0]} differ, and none is used as {words}")
        return
    if len(names) > 1 or len(units) > 1:
        if not is_needed:
            draft.notes.append(f"columns {', '.join(names)} could all be the {meaning}, and none is used")
            return
        others = [f"{draft.head(one.index)} (column {one.index + 1})" for one in chosen[1:]]
        line = draft.ask(line, f"{names[0]}, or {' or '.join(others)}?")
    elif chosen[0].question:
        line = draft.ask(line, f"column {names[0]}: {chosen[0].question}")
    draft.columns[meaning] = line


def _ask(draft: Draft, meaning: str, options: Sequence[Option]) -> None:
    """The line of a column that is needed: of the first option, whose unit is not certain, or of none."""
    heads, below = draft.block.heads, draft.block.below
    torques = [i for i, head in enumerate(heads) if naming.looks_like_torque(head, below[i])]
    near = [i for i, head in enumerate(heads) if naming.looks_like_friction(head)]
    i = options[0].index if options else torques[0] if torques else 0
    if i in torques and (meaning == "tangential_force" if options else meaning == "friction" and not near):
        units = (below[i], naming.header_parts(heads[i])[0][1])
        unit = next((one for one in units if naming.torque_scale(one)), UNKNOWN)
        line = _line(draft, "tangential_force", Option(0, i), unit)
        question = "a torque: write the radius of its track below [test]"
        draft.columns["tangential_force"] = draft.ask(line, question)
        if "track_radius" not in draft.stated:
            draft.test.append('track_radius = "... mm"')
        if meaning == "friction" and "normal_force" not in draft.columns:
            _ask(draft, "normal_force", [])
    elif options:  # an unknown unit is left open, a usual one is offered
        one = options[0]
        unit = UNKNOWN if one.unit else "mm:ss" if one.question else USUAL.get(meaning, "N")
        said = f'the file writes "{one.unit}"' if one.unit else one.question or "the file states no unit"
        line = _line(draft, meaning, one, unit)
        draft.columns[meaning] = draft.ask(line, f"column {draft.head(i)}: {said}")
    elif meaning == "normal_force":
        if "normal_force" not in draft.stated:
            draft.test.append(draft.ask('normal_force = "... N"', "the log has no normal force"))
    elif meaning == "friction" and near:
        question = f"the friction by its name? There are {', '.join(map(draft.head, near[:4]))}"
        draft.columns[meaning] = draft.ask(_line(draft, meaning, Option(0, near[0]), "-"), question)
    else:
        line = f"{meaning} = {as_toml({'name': UNKNOWN if any(heads) else 1, 'unit': UNKNOWN})}"
        draft.columns[meaning] = draft.ask(line, f"which column is the {meaning.replace('_', ' ')}?")


def _shapes(draft: Draft, options: Options) -> None:
    """Columns in any unit that show standstill and reversals."""
    free = {key: [one for one in some if one.index not in draft.used] for key, some in options.items()}
    speeds = [one for key in ("slip_speed", "rotational_speed") for one in free.get(key, ())]
    speeds = [one for one in speeds if one.unit.casefold() not in ("v", "a")]
    if speeds and not {"slip_speed", "rotational_speed", "motion"} & draft.columns.keys():
        draft.columns["motion"] = _line(draft, "motion", min(speeds, key=lambda one: one.index))
    forces = free.get("tangential_force", ())
    forces = [one for one in forces if not naming.looks_like_torque(draft.block.heads[one.index])]
    if forces and "stroke" not in draft.columns and "friction" in draft.columns:
        draft.columns["stroke"] = _line(draft, "stroke", forces[0])


def _decimal(draft: Draft) -> None:
    """A question where marks may be decimal signs or between thousands."""
    block = draft.block
    if block.word == "row" or draft.given.format.decimal:
        return
    try:
        decimal_of([draft.cells[i] for i in sorted(draft.used)], block.separator, block.source)
    except UnfitError as error:
        draft.form.append(draft.ask(f'decimal = "{UNKNOWN}"', f"{error.rule}: {error.got}"))


def _conditions(draft: Draft) -> None:
    """Names that a friction file needs and the log does not state, to fill in."""
    metadata = metadata_of(draft.block.above)
    known = {*draft.stated, *(meant for key in metadata for meant in naming.conditions_named(key)[:1])}
    for name, what in NAMED.items():
        if name not in known:
            draft.test.append(f'# {name} = "{UNKNOWN}"  # {what}; the log does not state it')


NAMED = {"material": "of the cage", "counterface": "of ball or race", "medium": "the gas or liquid around"}
"""What a friction file needs beside the friction."""
