"""A draft of a column map: what a log shows, with a question at all that it does not state for certain."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from separatrix.friction.logs import names as naming
from separatrix.friction.logs import tables
from separatrix.friction.logs.column_map import SEPARATORS, Column, ColumnMap, TextFormat, given_in
from separatrix.friction.logs.log import TIMES, UnfitError, seconds, stated_units
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

WORDS = {sign: word for word, sign in SEPARATORS.items()}
MOST_ROWS = 20_000  # of which a column is looked at in all
SAMPLE = 50  # rows of a column that are looked at


class Option(NamedTuple):
    """A column that may have a meaning: how usual its name is, the unit stated, whether that is certain."""

    rank: int
    place: int  # of the column
    unit: str = ""
    is_known: bool = False


Options = dict[str, list[Option]]  # by meaning


@dataclass(slots=True)
class Draft:
    """Lines of the column map of a table, what has to be looked at, and what is not used."""

    given: ColumnMap
    block: tables.Block
    has_load: bool  # whether the user states the normal force
    form: list[str] = field(default_factory=list)
    columns: dict[str, str] = field(default_factory=dict)  # by meaning
    used: set[int] = field(default_factory=set)  # columns that have such a line
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
        written = self.given.as_written
        test = {**written.get("test", {})}
        if "normal_force" in self.columns and not self.columns["normal_force"]:
            test["normal_force"] = f"{UNKNOWN} N"
        lines = [
            f'# Draft of a column map for {name}: check each line with "guess, check", then add --map.',
            f"name = {as_toml(f'map of {name}'[:200])}",
            *(
                "",
                "[format]",
                *self.form,
                "",
                "[columns]",
                *filter(None, self.columns.values()),
                "",
                "[test]",
            ),
            *(f"{key} = {as_toml(value)}" for key, value in test.items()),
            *(f'# {key} = "{UNKNOWN}"  # {what}' for key, what in NAMED.items() if key not in test),
        ]
        for pattern, section in written.get("files", {}).items():
            lines += ["", f"[files.{as_toml(pattern)}]"]
            lines += [f"{key} = {as_toml(value)}" for key, value in section.items()]
        about = "# The columns, with their first, middle and last values:"
        return "\n".join([*lines, "", about, *self.seen, ""])


NAMED = {"material": "of the cage", "counterface": "of ball or race", "medium": "the gas or liquid around"}
"""What a friction file needs beside the friction."""


def draft_of(content: tables.Content, given: ColumnMap, why: UnfitError | None) -> Draft:
    """Draft of the map of a file: of its first table without questions, else of its first.

    `given` is what the user and a known layout state; `why` is the reason that they do not suffice, if any.
    """
    has_load = "normal_force" in given.conditions(content.path)
    firsts = ((part.sheet, _first_block(part, given)) for part in content.parts)
    drafts = [(sheet, _draft(given, has_load, *one)) for sheet, one in firsts if one is not None]
    if not drafts:
        cure = "It needs a line of column names above at least two rows; a column map can state where."
        raise InputError(content.name, "has no table of numbers with two columns or more", cure=cure)
    name, chosen = next(((one, draft) for one, draft in drafts if not draft.questions), drafts[0])
    if len(drafts) > 1 and chosen.questions and not given.format.tables:
        listed = ", ".join(as_toml(one) for one, _ in drafts)
        chosen.form.append(chosen.ask(f"tables = [{as_toml(name)}]", f"one of {listed}?"))
    if why is not None:
        question = f"the map of this layout does not fit: {why.question}"
        chosen.form.insert(0, chosen.ask(f"# {given.name}", question))
    return chosen


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
    others = [WORDS[one] for one in others]
    asked = {"separator": f"or {' or '.join(map(as_toml, others))}?"} if others else {}
    form = form if part.sheet else TextFormat(**given_in(form) | {"separator": WORDS[separator]})
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
    given: ColumnMap, has_load: bool, block: tables.Block, form: TextFormat, asked: Mapping[str, str]
) -> Draft:
    """What each column of a table means: certain by name and unit, or asked."""
    draft, cells = Draft(given, block, has_load), tables.cells_of(block, range(len(block.heads)))
    for key, value in given_in(form).items():
        line = f"{key} = {as_toml(value)}"
        draft.form.append(draft.ask(line, asked[key]) if key in asked else line)
    for meaning, one in given.columns.items():
        places = tables.matching(one.names, block.heads) if one.number is None else [one.number - 1]
        if places and max(places) < len(block.heads):
            draft.columns[meaning] = _line(meaning, one)
            draft.used |= set(places)
        elif not one.optional:
            name = one.names[0] if one.names else f"number {one.number}"
            draft.questions.append(f"no column {as_toml(name)}, which the column map names as {meaning}")
    options = Options()
    for i, column in enumerate(cells):
        values = ", ".join(column[k] for k in (0, len(column) // 2, -1)) if column else ""
        beside = f" {block.below[i]}" if block.below[i] else ""
        draft.seen.append(printable(f"# {i + 1:3d} {as_toml(block.heads[i])}{beside}: {values}", 150))
        for meaning, option in _options(block, i, column).items() if i not in draft.used else ():
            options.setdefault(meaning, []).append(option)
    _decide(draft, options)
    return draft


def _options(block: tables.Block, i: int, cells: Sequence[str]) -> dict[str, Option]:
    """Meanings that a column may have."""
    ways = naming.header_parts(block.heads[i])
    sample = [cell for cell in cells[:SAMPLE] if cell.casefold() not in naming.MISSING]
    clocks = [cell for cell in sample if tables.is_clock(cell)]
    if 2 * len(clocks) > len(sample):
        form = _time_form(stated_units(block.heads[i], block.below[i], "time", {}), clocks)
        return {"time": Option(8 if "time" in naming.ranks(ways[0][0]) else 9, i, form, form != UNKNOWN)}
    if 2 * sum(not tables.is_number(cell) for cell in sample) > len(sample):
        return {}
    for name, unit in ways:
        if unit.isdigit():  # COF_2: a station
            continue
        meanings = naming.ranks(name.rpartition(".")[2]) | naming.ranks(name)
        if naming.looks_extreme(ways[0][0]):
            meanings = {key: rank for key, rank in meanings.items() if not re.search("friction|force", key)}
        if meanings:
            is_only = len(meanings) == 1
            return {one: _option(block, i, one, rank, is_only=is_only) for one, rank in meanings.items()}
    return {}


def _option(block: tables.Block, i: int, meaning: str, rank: int, *, is_only: bool) -> Option:
    """A column of numbers with a usual name: certain where its unit is."""
    stated = stated_units(block.heads[i], block.below[i], meaning, {})
    scales = {naming.scale_of(one, meaning) for one in stated}
    known = (None not in scales and len(scales) == 1) or meaning == "position"
    known = known or (not stated and meaning in ("friction", "cycles") and is_only)
    return Option(rank, i, (stated[0] if known else ", ".join(stated)) if stated else "", known)


def _time_form(stated: Sequence[str], clocks: Sequence[str]) -> str:
    """How times are written as text."""
    named = [form for one in stated if (form := naming.time_form(one))]
    fitting = (form for form in ("clock", "iso") if not seconds(clocks, form)[1])
    return named[0] if named else next(fitting, UNKNOWN)


# --- the lines of the map -------------------------------------------------------------------------
def _line(meaning: str, one: Column) -> str:
    """One line of [columns]."""
    name = one.names[0] if len(one.names) == 1 else one.name
    more = ({"unit": one.unit} if one.unit else {}) | ({"sign": -1} if one.sign < 0 else {})
    more |= {"optional": True} if one.optional else {}
    return f"{meaning} = {as_toml({'name': name} | more if more or isinstance(name, tuple) else name)}"


def _line_of(draft: Draft, meaning: str, option: Option, unit: str = "") -> str:
    """One line: the name without its unit where that is unique, else the whole or the number."""
    heads, i = draft.block.heads, option.place
    head = " ".join(heads[i].split())
    bare = naming.header_parts(head)[0][0]
    named = bare if bare and tables.matching([bare], heads) == [i] else head
    unit = unit or (option.unit if meaning == "time" and naming.time_form(option.unit) else "")
    name = (named,) if named else i + 1
    optional = meaning in ("temperature", "wear_depth")
    return _line(meaning, Column(name=name, unit=unit or None, optional=optional))


def _decide(draft: Draft, options: Options) -> None:
    """One line of the map for each meaning that is there: certain, asked, or noted as not used."""
    meanings = (*naming.MEANINGS, "position")
    sure = {key: _best([one for one in options.get(key, ()) if one.is_known]) for key in meanings}
    needed = _needed(draft, options, sure)
    for meaning in meanings:
        rest = [one for one in options.get(meaning, ()) if one.place not in draft.used]
        chosen = [one for one in sure[meaning] if one in rest]
        if meaning in draft.columns:
            continue
        if chosen:
            _choose(draft, meaning, chosen, is_needed=meaning in needed or meaning == "time")
            draft.used |= {one.place for one in chosen}
        elif meaning in needed:
            _ask(draft, meaning, _best(rest))
        elif rest and meaning in ("temperature", "wear_depth", "normal_force", "distance"):
            head, words = printable(draft.block.heads[rest[0].place].strip()), meaning.replace("_", " ")
            draft.notes.append(f'column "{head}" has no known unit and is not used as {words}')
    free = {key: [one for one in some if one.place not in draft.used] for key, some in options.items()}
    speeds = [*free.get("slip_speed", ()), *free.get("rotational_speed", ())]
    speeds = [one for one in speeds if one.unit.casefold() not in ("v", "a")]
    if speeds and not {"slip_speed", "rotational_speed", "motion"} & draft.columns.keys():
        draft.columns["motion"] = _line_of(draft, "motion", min(speeds, key=lambda one: one.place))
    if (forces := free.get("tangential_force")) and "stroke" not in draft.columns:
        draft.columns |= (
            {"stroke": _line_of(draft, "stroke", forces[0])} if "friction" in draft.columns else {}
        )


def _needed(draft: Draft, options: Options, sure: Options) -> set[str]:
    """Meanings that the map must have: friction, or the forces instead; and an abscissa."""
    known = {*draft.columns, *(key for key, some in sure.items() if some)}
    has_load = draft.has_load or "normal_force" in known
    forces = sure["tangential_force"] if has_load else []
    forces = forces or ([] if options.get("friction") else options.get("tangential_force", []))
    by_forces = "tangential_force" in draft.columns or (forces and not sure["friction"])
    needed = {"friction"}
    if by_forces and "friction" not in draft.columns:
        needed = {"tangential_force", *([] if draft.has_load else ["normal_force"])}
        sure["friction"], options["friction"] = [], []
    if not any(name in known for name in naming.ABSCISSAE):
        needed.add(next((name for name in naming.ABSCISSAE if options.get(name)), "time"))
    return needed


def _best(options: Sequence[Option]) -> list[Option]:
    lowest = min((one.rank for one in options), default=0)
    return [one for one in options if one.rank == lowest]


def _choose(draft: Draft, meaning: str, chosen: Sequence[Option], *, is_needed: bool) -> None:
    """The line of columns that are certain; asked where several of other names are."""
    names = list(dict.fromkeys(draft.head(one.place) for one in chosen))
    units = {naming.scale_of(one.unit, meaning) if one.unit else None for one in chosen}
    line = _line_of(draft, meaning, chosen[0])
    if len(names) > 1 or len(units) > 1:
        if not is_needed:
            draft.notes.append(f"columns {', '.join(names)} could all be the {meaning}, and none is used")
            return
        others = [f"{draft.head(one.place)} (column {one.place + 1})" for one in chosen[1:]]
        line = draft.ask(line, f"{names[0]}, or {' or '.join(others)}?")
    draft.columns[meaning] = line


def _ask(draft: Draft, meaning: str, options: Sequence[Option]) -> None:
    """The line of a column that is needed: of the first option, whose unit is not certain, or of none."""
    if options:  # an unknown unit is left open, a usual one is offered
        one = options[0]
        unit = UNKNOWN if one.unit else USUAL.get(meaning, "N")
        said = f'the file writes "{one.unit}"' if one.unit else "the file states no unit"
        said = f"how are its times written? {TIMES}" if one.unit == UNKNOWN else said
        line = _line_of(draft, meaning, one, unit)
        draft.columns[meaning] = draft.ask(line, f"column {draft.head(one.place)}: {said}")
        draft.used.add(one.place)
    elif meaning == "normal_force":
        draft.columns[meaning] = ""
        draft.questions.append("the log has no normal force: write it below [test]")
    else:
        name = UNKNOWN if any(draft.block.heads) else 1
        line = f"{meaning} = {as_toml({'name': name, 'unit': UNKNOWN})}"
        draft.columns[meaning] = draft.ask(line, f"which column is the {meaning.replace('_', ' ')}?")
