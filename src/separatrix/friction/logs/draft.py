"""A draft of a column map: what a log shows, with a question at all that it does not state for certain."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

from separatrix.friction.logs.column_map import ColumnChoice, ColumnMap, TextFormat
from separatrix.friction.logs.log import metadata_of, two_ways
from separatrix.friction.logs.log_tables import (
    STARTS,
    Block,
    Content,
    Heads,
    Part,
    cells_of,
    fields_of,
    first_table,
    heads_in,
    is_clock,
    is_number,
    is_row,
    matching,
    separator_of,
)
from separatrix.friction.logs.names import (
    ABSCISSAE,
    KEYS,
    MASSES,
    MEANINGS,
    MISSING,
    POSITIONS,
    header_parts,
    looks_extreme,
    looks_like_friction,
    looks_like_torque,
    plain,
    ranks,
    scale_of,
    time_form,
    torque_scale,
)
from separatrix.friction.logs.numbers_and_times import UnfitError, decimal_of
from separatrix.friction.logs.raw import stated_units
from separatrix.ground.errors import InputError
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
"""Units that a draft offers where the file states none, to be checked."""

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
    unit: str  # as the file states it; empty for none
    known: bool
    question: str = ""


@dataclass(slots=True)
class Draft:
    """Lines of a column map, what has to be looked at, and what is not used."""

    given: ColumnMap
    form: list[str] = field(default_factory=list)
    columns: dict[str, str] = field(default_factory=dict)  # by meaning
    test: list[str] = field(default_factory=list)
    seen: list[str] = field(default_factory=list)
    cells: list[list[str]] = field(default_factory=list)  # of each column
    questions: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def ask(self, line: str, question: str) -> str:
        """Return a line with its question, which is noted."""
        self.questions.append(question)
        return f"{line}  {CHECK}: {printable(question, 200)}"

    def text(self, name: str) -> str:
        """The map, ready to be looked at."""
        begin = f'# Draft of a column map for {name}: check each line with "guess, check", then add --map.'
        lines = [
            begin,
            f"name = {_toml(f'map of {name}'[:200])}",
            "",
            "[format]",
            *self.form,
            "",
            "[columns]",
        ]
        lines += self.columns.values()
        stated = self.given.stated
        test = [f"{key} = {_toml(value)}" for key, value in _section(stated.get("test")).items()]
        lines += ["", "[test]", *test, *self.test] if test or self.test else []
        for pattern, section in _section(stated.get("files")).items():
            lines += ["", f"[files.{_toml(pattern)}]"]
            lines += [f"{key} = {_toml(value)}" for key, value in _section(section).items()]
        return "\n".join(
            [*lines, "", "# The columns, with their first, middle and last values:", *self.seen, ""]
        )


def _section(value: object) -> Mapping[str, object]:
    return value if isinstance(value, dict) else {}


def _toml(value: object) -> str:
    """A value in TOML."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_toml(key)} = {_toml(one)}" for key, one in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_toml, value))}]"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def draft_of(content: Content, given: ColumnMap, why: InputError | None) -> Draft:
    """Draft of the map of a file: of its first table without questions, else of its first.

    `given` is what the user and a known layout state; `why` is the reason that they do not suffice, if any.
    """
    drafts: list[tuple[str, Draft]] = []
    drafts += [(group.name, _draft(group, Draft(given))) for group in content.groups]
    for part in content.parts:
        draft = Draft(given)
        if (block := _block(part, draft)) is not None:
            drafts.append((part.sheet, _draft(block, draft)))
    if not drafts:
        raise _no_table(content)
    name, found = next(((one, draft) for one, draft in drafts if not draft.questions), drafts[0])
    if len(drafts) > 1 and found.questions and not given.format.tables:
        listed = ", ".join(_toml(one) for one, _ in drafts)
        found.form.append(found.ask(f"tables = [{_toml(name)}]", f"one of {listed}?"))
    if why is not None:
        found.form.insert(
            0, found.ask(f"# {given.name}", f"the map of this layout does not fit: {why.rule} {why.got}")
        )
    return found


def _no_table(content: Content) -> InputError:
    cure = "It needs a line of column names above at least two rows; a column map can state where."
    for part in content.parts:
        signs = ((i, line, separator_of([line])[0]) for i, line in enumerate(part.lines[:500]))
        rows = [i for i, line, sign in signs if sign and is_row(fields_of(line, sign))]
        if len(rows) == 1:
            where = f"{content.name}: {part.word} {rows[0] + 1}"
            return InputError(where, "is the only row", cure="A log has at least two.")
    return InputError(content.name, "has no table of numbers with two columns or more", cure=cure)


# --- the table ------------------------------------------------------------------------------------
def _block(part: Part, draft: Draft) -> Block | None:
    """The first table of a text: how it is written goes into the draft; None without one."""
    form = draft.given.format
    missing = MISSING | {one.casefold() for one in form.missing}
    separator, others = (form.separator, []) if form.separator else separator_of(part.lines, missing)
    separator = "\t" if part.sheet else separator
    if not separator:
        return None
    if form.header_line is not None:
        heads: Heads | None = next(heads_in(part, draft.given, separator, missing))
    else:
        heads = first_table(part.lines, separator, missing, _start(part, separator, draft.given))
    if heads is None:
        return None
    own = {f.name: value for f in fields(TextFormat) if (value := getattr(form, f.name))}
    draft.form += [f"{key} = {_toml(value)}" for key, value in own.items()]
    if "separator" not in own and not part.sheet:
        line = f"separator = {_toml(separator)}"
        names = " or ".join(_toml(one) for one in others)
        draft.form.append(draft.ask(line, f"or {names}?") if others else line)
    block = Block(
        part.source,
        part.sheet,
        heads.names,
        heads.below,
        part.lines[: heads.line or 0],
        separator=separator,
        word=part.word,
    )
    known = {part.lines[heads.line] if heads.line is not None else None}
    _rows(block, part.lines, heads.first, known, draft)
    if heads.line is None:
        block.heads = [""] * len(heads.names)
    return block


def _start(part: Part, separator: str, given: ColumnMap) -> int:
    """The first line with the names that are stated; the first of all where there is none."""
    named = [one.names for one in given.columns.values() if one.names and not one.optional]
    lines = ((i, fields_of(line, separator)) for i, line in enumerate(part.lines) if named)
    return next((i for i, heads in lines if all(matching(names, heads) for names in named)), 0)


def _rows(block: Block, lines: Sequence[str], first: int, heads: set[str | None], draft: Draft) -> None:
    """Add the rows to the block, and a question on each kind of line among them that is not one."""
    width = len(fields_of(lines[first], block.separator))
    form, odd = draft.given.format, dict[str, int]()
    between: list[int] = []
    is_first = True  # the first of the tables with these names
    for i in range(first, len(lines)):
        line = lines[i]
        if (
            not between
            and line[:1] in STARTS
            and '"' not in line
            and line.count(block.separator) == width - 1
        ):
            if is_first:
                block.rows.append(line)
            continue
        begin = line.strip()
        if form.ends and begin.startswith(form.ends):
            break
        if not line.strip(f"{block.separator} \t") or begin.startswith(
            (*(one for one in form.skip if not one[0].isdigit()), "\0")
        ):
            continue
        if line in heads:
            between, is_first, heads = [], False, heads | {block.separator.join(block.below)}
            continue
        parts = fields_of(line, block.separator)
        has_number = any(is_number(one) or is_clock(one) or one.casefold() in MISSING for one in parts)
        if len(parts) != width or not has_number or (between and not is_row(parts)):
            between.append(i)
            continue
        names = [k for k in between[-2:] if len(fields_of(lines[k], block.separator)) == width and block.rows]
        if names and width > 1:
            name = fields_of(lines[names[0]], block.separator)[0]
            got = lines[names[0]].strip()[:60]
            question = f"{block.word} {names[0] + 1} begins another table, which is not read: {got!r}"
            draft.form.append(
                draft.ask(f"ends = {_toml([*form.ends, name or lines[names[0]].strip()])}", question)
            )
            break
        for k in between[:20] if block.rows else ():
            word = re.match(r"\D{0,30}", lines[k].strip())
            odd.setdefault((word[0].strip() if word else "") or lines[k].strip()[:20], k)
        between = []
        if is_first:
            block.rows.append(line)
    if len(block.rows) > MOST_ROWS:  # the reader looks at all of them
        ends = block.rows[:1000], block.rows[1000 : -1000 : len(block.rows) // 10_000], block.rows[-1000:]
        block.rows = [row for some in ends for row in some]
    if odd:
        skip = [*form.skip, *list(odd)[:20]]
        number = next(iter(odd.values()))
        draft.form = [line for line in draft.form if not line.startswith("skip =")]
        question = (
            f"{block.word} {number + 1} is among the rows and is left out: {lines[number].strip()[:60]!r}"
        )
        draft.form.append(draft.ask(f"skip = {_toml(skip)}", question))


# --- its columns ----------------------------------------------------------------------------------
def _draft(block: Block, draft: Draft) -> Draft:
    """What each column means: certain by name and unit, or asked."""
    places = list(range(len(block.heads)))
    if block.columns is not None:
        cells = [[f"{value:.9g}" for value in column[:SAMPLE].tolist()] for column in block.columns]
    else:
        cells = cells_of(block, places)
    draft.cells = cells
    options: dict[str, list[Option]] = {}
    for i in places:
        for meaning, option in _options(block, i, cells[i]):
            options.setdefault(meaning, []).append(option)
        values = ", ".join(cells[i][k] for k in (0, len(cells[i]) // 2, -1)) if cells[i] else ""
        beside = f" {block.below[i]}" if block.below[i] else ""
        draft.seen.append(printable(f"# {i + 1:3d} {_toml(block.heads[i])}{beside}: {values}", 150))
    used = _given(block, draft)
    _decide(block, draft, options, used)
    _decimal(block, draft, [cells[i] for i in sorted(used)])
    _conditions(block, draft, cells)
    if not draft.given.format.tests:
        _steps(block, draft, cells, used)
    return draft


def _options(block: Block, i: int, cells: Sequence[str]) -> list[tuple[str, Option]]:
    """Meanings that a column may have."""
    head, below = block.heads[i], block.below[i]
    sample = [cell for cell in cells[:SAMPLE] if cell.casefold() not in MISSING]
    clocks = [cell for cell in sample if is_clock(cell)]
    if 2 * len(clocks) > len(sample):
        named = "time" in ranks(header_parts(head)[0][0])
        return [("time", _clock(8 if named else 9, i, stated_units(head, below, "time", {}), cells, clocks))]
    if sum(not is_number(cell) for cell in sample) > len(sample) / 2:
        return []
    found = []
    is_extreme = looks_extreme(header_parts(head)[0][0])
    for name, unit in header_parts(head):
        names = {name, name.rpartition(".")[2]}
        meanings = {meaning: rank for one in names for meaning, rank in ranks(one).items()}
        if unit.isdigit():
            meanings = {}  # a second station, COF_2
        if is_extreme:
            meanings = {
                key: rank for key, rank in meanings.items() if "friction" not in key and "force" not in key
            }
        for meaning, rank in meanings.items():
            stated = stated_units(head, below, meaning, {})
            scales = {scale_of(one, meaning) for one in stated}
            known = None not in scales and len(scales) == 1
            known = known or (not stated and meaning in ("friction", "cycles") and len(meanings) == 1)
            if meaning in ("friction", "tangential_force") and looks_like_torque(head, below):
                known = False
            found.append(
                (
                    meaning,
                    Option(rank, i, (stated[0] if known else ", ".join(stated)) if stated else "", known),
                )
            )
        if any(plain(one) in POSITIONS for one in names):
            found.append(("position", Option(0, i, "", known=True)))
        if found:
            break
    return found


def _clock(rank: int, i: int, stated: Sequence[str], cells: Sequence[str], clocks: Sequence[str]) -> Option:
    """A column of times as text, with how they are written."""
    form = next((form for one in stated if (form := time_form(one))), "")
    if form in ("hh:mm", "mm:ss") or all(_CLOCK.fullmatch(one) for one in clocks):
        return Option(rank, i, form if form in ("hh:mm", "mm:ss") else "clock", known=True)
    if iso := [match for one in cells if (match := _ISO.fullmatch(one))]:
        zones = list(dict.fromkeys(match[1] or "no zone" for match in iso))
        question = f"its time zone changes: {', '.join(zones[:3])}" if len(zones) > 1 else ""
        return Option(rank, i, "iso", known=True, question=question)
    if dates := [match for one in cells if (match := _DATE.fullmatch(one))]:
        form, is_certain = _date_format(dates)
        return Option(
            rank, i, form, known=True, question="" if is_certain else "is the day before the month?"
        )
    if all(re.fullmatch(r"\d{1,4}:\d{1,2}(?:[.,]\d+)?", one) for one in clocks):
        return Option(rank, i, "", known=False, question="minutes and seconds, or hours and minutes (hh:mm)?")
    return Option(rank, i, UNKNOWN, known=False)


def _date_format(dates: Sequence[re.Match[str]]) -> tuple[str, bool]:
    """Format of dates, and whether their numbers show which of them is the day."""
    one = dates[0]
    if one[3].isalpha():
        order, is_certain = ("%d", "%b"), True
    else:
        first, second = (max(int(match[k]) for match in dates) for k in (1, 3))
        order, is_certain = (("%m", "%d") if second > 12 else ("%d", "%m")), max(first, second) > 12
    date = one[2].join((*order, "%Y" if len(one[4]) == 4 else "%y"))
    time = ("%I" if one[9] else "%H") + ":%M" + (":%S" if one[7] else "") + (".%f" if one[8] else "")
    half = "" if not one[9] else " %p" if one[9][0] == " " else "%p"
    return f"{date}{one[5]}{time}{half}", is_certain


def _given(block: Block, draft: Draft) -> set[int]:
    """Columns that are stated already, with their lines; what the table does not have is asked."""
    used = set()
    for meaning, one in draft.given.columns.items():
        places = matching(one.names, block.heads) if one.number is None else [one.number - 1]
        if places and max(places) < len(block.heads):
            draft.columns[meaning] = _of_twins(draft, meaning, one, places)
            used |= set(places)
        elif not one.optional:
            name = one.names[0] if one.names else f"number {one.number}"
            draft.questions.append(f"no column {_toml(name)}, which the column map names as {meaning}")
    return used


def _of_twins(draft: Draft, meaning: str, one: ColumnChoice, places: Sequence[int]) -> str:
    """The line of columns of one name; asked by number where their numbers differ."""
    if all(draft.cells[i] == draft.cells[places[0]] for i in places[1:]):
        return _stated(meaning, one)
    line = _stated(meaning, replace(one, names=(), number=places[0] + 1))
    others = " or ".join(str(i + 1) for i in places[1:])
    return draft.ask(
        line,
        f"{len(places)} columns that could be the {meaning.replace('_', ' ')}: {places[0] + 1} or {others}?",
    )


def _stated(meaning: str, one: ColumnChoice) -> str:
    name = list(one.names) if len(one.names) > 1 else one.names[0] if one.names else one.number
    more: dict[str, object] = {"unit": one.unit} if one.unit else {}
    more |= ({"sign": -1} if one.sign < 0 else {}) | ({"optional": True} if one.optional else {})
    inside = ", ".join(f"{key} = {_toml(value)}" for key, value in ({"name": name} | more).items())
    return f"{meaning} = {{ {inside} }}" if more else f"{meaning} = {_toml(name)}"


def _line(draft: Draft, block: Block, meaning: str, option: Option, unit: str = "") -> str:
    """One line of [columns]: the name without its unit where that is unique, else the whole or the number."""
    head = " ".join(block.heads[option.index].split())
    bare = header_parts(head)[0][0]
    named = bare if bare and matching([bare], block.heads) == [option.index] else head
    choice = ColumnChoice(names=(named,) if named else (), number=None if named else option.index + 1)
    unit = unit or (option.unit if meaning == "time" and time_form(option.unit) else "")
    choice = replace(choice, optional=meaning in ("temperature", "wear_depth"))
    places = matching([named], block.heads) if named else [option.index]
    return _of_twins(draft, meaning, replace(choice, unit=unit or None), places)


def _decide(block: Block, draft: Draft, options: dict[str, list[Option]], used: set[int]) -> None:
    """One line of the map for each meaning that is there: certain, asked, or noted as not used."""
    free = {key: [one for one in some if one.index not in used] for key, some in options.items()}
    sure = {key: _best([one for one in free.get(key, ()) if one.known]) for key in (*MEANINGS, "position")}
    has_load = (
        "normal_force" in draft.columns or bool(sure["normal_force"]) or "normal_force" in draft.given.test
    )
    near = sure["friction"] or free.get("friction") or any(map(looks_like_friction, block.heads))
    by_forces = "tangential_force" in draft.columns or (bool(sure["tangential_force"]) and has_load)
    by_forces = by_forces or (bool(free.get("tangential_force")) and not near)
    needed = set()
    if "friction" not in draft.columns and (
        "tangential_force" in draft.columns or (by_forces and not sure["friction"])
    ):
        needed |= {"tangential_force", "normal_force"}
        sure["friction"] = []
        free["friction"] = []
    else:
        needed.add("friction")
    if not any(name in draft.columns or sure[name] for name in ABSCISSAE):
        needed.add(next((name for name in ABSCISSAE if free.get(name)), "time"))
    taken = set(used)
    for meaning in (*MEANINGS, "position"):
        chosen = [one for one in sure[meaning] if one.index not in taken]
        if meaning in draft.columns:
            continue
        if chosen:
            _choose(block, draft, meaning, chosen, is_needed=meaning in needed or meaning == "time")
            taken |= {one.index for one in chosen}
        elif rest := [one for one in free.get(meaning, ()) if one.index not in taken]:
            if meaning in needed:
                _ask_unit(block, draft, meaning, _best(rest)[0])
            elif meaning in ("temperature", "wear_depth", "normal_force", "distance"):
                head = printable(block.heads[rest[0].index].strip())
                draft.notes.append(
                    f'column "{head}" has no known unit and is not used as {meaning.replace("_", " ")}'
                )
    for meaning in sorted(needed - draft.columns.keys()):
        _ask_column(block, draft, meaning)
    _shapes(block, draft, options, taken)
    used |= taken


def _best(options: Sequence[Option]) -> list[Option]:
    lowest = min((one.rank for one in options), default=0)
    return [one for one in options if one.rank == lowest]


def _choose(block: Block, draft: Draft, meaning: str, chosen: Sequence[Option], *, is_needed: bool) -> None:
    """The line of columns that are certain; asked where several of other names are."""
    count = len(draft.questions)
    line = _line(draft, block, meaning, chosen[0])
    names = list(dict.fromkeys(_toml(block.heads[one.index].strip()) for one in chosen))
    units = {scale_of(one.unit, meaning) if one.unit else None for one in chosen}
    if len(draft.questions) > count and not is_needed:
        del draft.questions[count:]
        draft.notes.append(f"columns {names[0]} differ, and none is used as {meaning.replace('_', ' ')}")
        return
    if len(names) > 1 or len(units) > 1:
        if not is_needed:
            draft.notes.append(f"columns {', '.join(names)} could all be the {meaning}, and none is used")
            return
        others = " or ".join(
            f"{name} (column {one.index + 1})" for name, one in zip(names[1:], chosen[1:], strict=False)
        )
        line = draft.ask(line, f"{names[0]}, or {others or 'its namesake'}?")
    elif chosen[0].question:
        line = draft.ask(line, f"column {names[0]}: {chosen[0].question}")
    draft.columns[meaning] = line


def _ask_unit(block: Block, draft: Draft, meaning: str, option: Option) -> None:
    """The line of a column whose unit is not certain: an unknown one is left open, a usual one is offered."""
    head = _toml(block.heads[option.index].strip())
    if meaning == "tangential_force" and looks_like_torque(
        block.heads[option.index], block.below[option.index]
    ):
        _ask_torque(block, draft, option)
        return
    usual = USUAL.get(meaning, "N")
    unit = MASSES.get(option.unit, UNKNOWN) if option.unit else ("mm:ss" if option.question else usual)
    said = f'the file writes "{option.unit}"' if option.unit else option.question or "the file states no unit"
    draft.columns[meaning] = draft.ask(_line(draft, block, meaning, option, unit), f"column {head}: {said}")


def _ask_torque(block: Block, draft: Draft, option: Option) -> None:
    unit = next(
        (
            one
            for one in (block.below[option.index], header_parts(block.heads[option.index])[0][1])
            if torque_scale(one)
        ),
        UNKNOWN,
    )
    line = _line(draft, block, "tangential_force", option, unit)
    draft.columns["tangential_force"] = draft.ask(
        line, "a torque: write the radius of its track below [test]"
    )
    if "track_radius" not in draft.given.test:
        draft.test.append('track_radius = "... mm"')


def _ask_column(block: Block, draft: Draft, meaning: str) -> None:
    """The line of a column that is needed and that no name shows."""
    torque = [i for i, head in enumerate(block.heads) if looks_like_torque(head, block.below[i])]
    near = [i for i, head in enumerate(block.heads) if looks_like_friction(head)]
    if meaning == "normal_force":
        if "normal_force" not in draft.given.test:
            draft.test.append(draft.ask('normal_force = "... N"', "the log has no normal force"))
    elif meaning == "friction" and torque and not near:
        _ask_torque(block, draft, Option(0, torque[0], "", known=False))
        if "normal_force" not in draft.columns:
            _ask_column(block, draft, "normal_force")
    elif meaning == "friction" and near:
        names = ", ".join(_toml(block.heads[i].strip()) for i in near[:4])
        option = Option(0, near[0], "", known=False)
        draft.columns[meaning] = draft.ask(
            _line(draft, block, meaning, option, "-"), f"the friction by its name? There are {names}"
        )
    else:
        name = (
            f'{{ name = 1, unit = "{UNKNOWN}" }}'
            if not any(block.heads)
            else f'{{ name = "{UNKNOWN}", unit = "{UNKNOWN}" }}'
        )
        draft.columns[meaning] = draft.ask(
            f"{meaning} = {name}", f"which column is the {meaning.replace('_', ' ')}?"
        )


def _shapes(block: Block, draft: Draft, options: dict[str, list[Option]], taken: set[int]) -> None:
    """Columns in any unit that show standstill and reversals."""
    speeds = [one for key in ("slip_speed", "rotational_speed") for one in options.get(key, ())]
    speeds = [one for one in speeds if one.index not in taken and one.unit.casefold() not in ("v", "a")]
    has_speed = {"slip_speed", "rotational_speed", "motion"} & draft.columns.keys()
    if speeds and not has_speed:
        draft.columns["motion"] = _line(draft, block, "motion", min(speeds, key=lambda one: one.index))
    forces = [one for one in options.get("tangential_force", ()) if one.index not in taken]
    forces = [one for one in forces if not looks_like_torque(block.heads[one.index])]
    if forces and "stroke" not in draft.columns and "friction" in draft.columns:
        draft.columns["stroke"] = _line(draft, block, "stroke", forces[0])


def _decimal(block: Block, draft: Draft, cells: Sequence[Sequence[str]]) -> None:
    """A question where marks may be decimal signs or between thousands."""
    if block.columns is not None or block.word == "row" or draft.given.format.decimal:
        return
    try:
        decimal_of(cells, block.separator, block.source)
    except UnfitError as error:
        draft.form.append(draft.ask(f'decimal = "{UNKNOWN}"', f"{error.rule}: {error.got}"))


def _conditions(block: Block, draft: Draft, cells: Sequence[Sequence[str]]) -> None:
    """A question on each condition above the table whose number can be read in two ways."""
    text = "".join("".join(column[:SAMPLE]) for column in cells)
    decimal = "," if "," in text else "." if "." in text or block.separator == "," else ""
    for key, value in metadata_of(block.above).items():
        meant = [one for one, names in KEYS.items() if plain(header_parts(key)[0][0]) in names]
        if meant and meant[0] not in draft.given.test and (ways := two_ways(value, decimal)):
            question = f"{_toml(key)} is {_toml(value)}: {' or '.join(ways)}? It is not used as it is"
            draft.test.append(draft.ask(f'# {meant[0]} = "{UNKNOWN}"', question))


def _steps(block: Block, draft: Draft, cells: Sequence[Sequence[str]], used: set[int]) -> None:
    """Ask for the column that tells tests apart, where time falls back when it changes."""
    for i in [i for i in used if "time" in ranks(header_parts(block.heads[i])[0][0])][:1]:
        texts = [cell.replace(",", ".") for cell in cells[i]]
        values = [
            float(text) if re.fullmatch(r"[+-]?[0-9]+\.?[0-9]*", text) else float("nan") for text in texts
        ]
        falls = [k for k in range(1, len(values)) if values[k] < values[k - 1]]
        for j, head in enumerate(block.heads if falls else ()):
            few = j not in used and head.strip() and len(set(cells[j])) <= SAMPLE
            if few and all(cells[j][k] != cells[j][k - 1] for k in falls):
                question = f"{block.heads[i].strip()} begins anew where this changes: tests of their own?"
                draft.form.append(draft.ask(f"tests = [{_toml(head.strip())}]", question))
                return
