"""From a table of a file to a log in SI units: complete rows of steady sliding, friction as magnitude."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from separatrix.friction.logs import names as naming
from separatrix.friction.logs import tables
from separatrix.friction.logs.column_map import ColumnMap, Conditions, conditions_of
from separatrix.friction.logs.sliding import Rows, Signal, sliding_rows
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, format_quantity, printable, shown

HIGHEST = 5.0
"""Friction above which a value is not a ratio of forces in sliding: a code for a missing value, no load."""

FEW = 0.1  # share of the rows up to which such values are left out; with more the column is refused
ONE_SIGN = 0.9  # share of the rows in which the normal force must have one sign to be that of compression
Arrays = dict[str, Array]  # columns by their meaning, shape (row,) each, in SI units
_SIGNALS = {
    **dict.fromkeys(("slip_speed", "rotational_speed", "motion"), "speed"),
    **dict.fromkeys(("tangential_force", "stroke"), "force"),
    "position": "position",
}
TIMES = 'unit = "clock" for 10:00:01.5, "iso" for 2026-02-01 10:00:01, "mm:ss", "hh:mm", "%d.%m.%Y %H:%M:%S"'


class UnfitError(InputError):
    """A table that its map does not fit: it lacks a column, or states another unit."""

    @property
    def question(self) -> str:
        """What a draft asks about it."""
        return f"{self.rule}: {self.got}. {self.cure}" if self.got else f"{self.rule}. {self.cure}"


# --- a log ----------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnRead:
    """How one column of a file was understood."""

    header: str  # as in the file
    meaning: str | None  # A key of `MEANINGS`; None where the column is not used
    unit: str  # as the file or the column map writes it; empty where there is none
    why: str  # for instance ``"its name"`` or ``"column map"``


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RawLog:
    """Friction of one test as it was logged, in SI units, with where it comes from."""

    source: str  # name of the file, and of the sheet or section in it
    checksum: str  # SHA-256 of the file
    format: str  # of the file, in words
    friction: Array  # Magnitude, shape (row,) [-]
    time: Array | None = None  # since the start, shape (row,) [s]
    distance: Array | None = None  # slid, shape (row,) [m]
    cycles: Array | None = None  # turns or strokes, shape (row,)
    normal_force: Array | None = None  # shape (row,) [N]
    tangential_force: Array | None = None  # with the sign that was logged, shape (row,) [N]
    temperature: Array | None = None  # shape (row,) [K]
    wear_depth: Array | None = None  # shape (row,) [m]
    slip_speed: Array | None = None  # shape (row,) [m/s]
    missing: int = 0  # rows left out because friction or its abscissa was not there
    columns: tuple[ColumnRead, ...] = ()  # how each was understood
    conditions: Conditions = field(default_factory=Conditions)  # from column map and columns
    measured: frozenset[str] = frozenset()
    """Conditions that are the median of a column, or follow from one; the others are stated."""
    series: str = ""  # what the header states about the test that this is a part of; empty if nothing
    notes: tuple[str, ...] = ()  # what the reading did that a user should know, a sentence each

    @property
    def rows(self) -> int:
        """Rows that are kept."""
        return len(self.friction)

    @property
    def abscissae(self) -> tuple[str, ...]:
        """Which of time, distance and cycles the log has."""
        return tuple(name for name in naming.ABSCISSAE if getattr(self, name) is not None)


# --- numbers and times: nothing is repaired --------------------------------------------------------
FLOAT = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][+-]?[0-9]{1,3})?")
_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:[.,][0-9]{3})+")
_PLAIN = frozenset("0123456789+-.eE\n")
_ZONE = re.compile(r"[T ]\d{1,2}:.*(?:Z|[+-]\d{2}:?\d{2})$")
_TIME = re.compile(r"(\d{1,4}):(\d{1,2})(?::(\d{1,2}(?:[.,:]\d+)?))?\s*([AaPp])?\.?[Mm]?\.?")
DAY = 86_400.0


def decimal_of(cells: Sequence[Sequence[str]], separator: str, source: str) -> str:
    """The decimal sign of the numbers; empty where none has one. Marks between thousands are refused."""
    if separator == "," and not any("," in cell for column in cells for cell in column):
        return "."
    marked = [one for column in cells for one in column if ("," in one or "." in one) and ":" not in one]
    marked = [one for one in marked if one[-1:].isdigit()]
    examples = [next(one for one in marked if mark in one) for mark in ".," if any(mark in m for m in marked)]
    if len(examples) > 1 or any(one.count(",") + one.count(".") > 1 for one in marked):
        cure = "Export it without marks between thousands, or write below [format]: decimal = ..."
        got = " and ".join(f'"{printable(one)}"' for one in dict.fromkeys(examples))
        raise UnfitError(source, "has points and commas in its numbers", got, cure)
    mark = next((mark for mark in ".," if any(mark in one for one in marked)), "")
    if marked and all(_GROUPED.fullmatch(one) for one in marked):
        rule = "does not show whether its marks are decimal signs or between thousands"
        cure = f'Add to the column map, below [format]: decimal = "{mark}".'
        raise UnfitError(source, rule, f'"{printable(marked[-1])}"', cure)
    return mark


def numbers(cells: Sequence[str], decimal: str, missing: frozenset[str]) -> tuple[Array, list[int]]:
    """Numbers of a column, NaN for what is missing, and the rows of what is neither."""
    text = "\n".join(cells)
    if decimal == "," and "." not in text:
        text = text.replace(",", ".")
    if text and set(text) <= _PLAIN:
        try:
            return np.array(text.split("\n"), dtype=float), []
        except ValueError:  # an empty cell, or `1-2`
            pass
    found, wrong = np.full(len(cells), np.nan), []
    for i, cell in enumerate(cells):
        one = cell.rstrip(tables.PERCENT)
        plain_number = one.replace(",", ".") if decimal == "," and "." not in one else one
        if FLOAT.fullmatch(plain_number):
            found[i] = float(plain_number.replace("d", "e").replace("D", "e"))
        elif one.casefold() not in missing:
            wrong.append(i)
    return np.where(np.isfinite(found), found, np.nan), wrong


def seconds(
    cells: Sequence[str], form: str, missing: frozenset[str] = naming.MISSING
) -> tuple[Array, list[int]]:
    """Seconds since the first time, NaN for what is missing, and the rows of what is not a time.

    A clock that falls back by more than half a day has passed midnight. Zones of dates count; where
    only some dates have one, the others are wrong.
    """
    texts = ["" if cell.casefold() in missing else cell for cell in cells]
    there = np.array([bool(text) for text in texts])
    found = np.full(len(texts), np.nan)
    if form == "iso" or "%" in form:
        import pandas as pd

        zones = np.array([bool(_ZONE.search(text)) for text in texts])
        if zones.any() and not zones[there].all():
            return found, np.flatnonzero(there & ~zones).tolist()
        dates = pd.Series([text.replace(",", ".") for text in texts], dtype="str")
        form = "ISO8601" if form == "iso" else form
        moments = pd.to_datetime(dates, format=form, errors="coerce", utc=True)
        fits = moments.notna().to_numpy()
        if fits.any():
            found[fits] = (moments[fits] - moments[fits].iloc[0]).dt.total_seconds()
    else:
        for i in np.flatnonzero(there):
            found[i] = _time(texts[i], form)
        fit = np.flatnonzero(np.isfinite(found))
        found[fit[1:]] += DAY * np.cumsum(np.diff(found[fit]) < -DAY / 2.0)
        found -= found[fit[0]] if fit.size else 0.0
    return np.round(found, 9), np.flatnonzero(there & ~np.isfinite(found)).tolist()


def _time(text: str, form: str) -> float:
    """Seconds of a time of day; NaN where it is not one of that form."""
    match = _TIME.fullmatch(text)
    if match is None or (match[3] is None and form == "clock"):
        return float("nan")
    first, second = float(match[1]), float(match[2])
    if match[3] is None and form == "mm:ss":
        return 60.0 * first + second
    if match[4]:
        first = first % 12.0 + (12.0 if match[4] in "pP" else 0.0)
    return 3600.0 * first + 60.0 * second + float(re.sub("[,:]", ".", match[3] or "0"))


# --- columns --------------------------------------------------------------------------------------
@dataclass(frozen=True, slots=True)
class Read:
    """Columns of a table in SI units, where they are, their units, the decimal sign, notes on all that."""

    block: tables.Block
    arrays: Arrays
    places: Mapping[str, int]
    units: Mapping[str, str]
    decimal: str
    notes: list[str]

    def head(self, meaning: str) -> str:
        """Name of the column of a meaning; empty where there is none."""
        return self.block.heads[self.places[meaning]].strip() if meaning in self.places else ""


def places_of(block: tables.Block, columns: ColumnMap, notes: list[str]) -> dict[str, list[int]]:
    """Columns of each meaning; several where a name stands twice."""
    found: dict[str, list[int]] = {}
    used: dict[int, str] = {}
    for meaning, one in columns.columns.items():
        words = meaning.replace("_", " ")
        if one.number is not None and one.number > len(block.heads):
            raise UnfitError(block.source, f"has {len(block.heads)} columns, not {one.number}, for {words}")
        places = tables.matching(one.names, block.heads) if one.number is None else [one.number - 1]
        if places:
            found[meaning] = places
        elif one.optional:
            notes.append(f'no column "{printable(one.names[0])}": without it the {words} is not known')
        else:
            listed = ", ".join(f'"{printable(head)}"' for head in block.heads[:12] if head)
            rule = f'has no column "{printable(one.names[0])}", which the column map names as {meaning}'
            raise UnfitError(block.source, rule, cure=f"It has {listed}.")
        for i in places:
            if used.setdefault(i, meaning) != meaning:
                rule = f'column "{printable(block.heads[i].strip())}" is both {used[i]} and {meaning}'
                raise InputError(block.source, f"{rule} in the column map")
    return found


def stated_units(head: str, below: str, meaning: str, spellings: Mapping[str, str]) -> list[str]:
    """Units that the file writes for a column, in its head and in the line below; also unknown ones.

    Words after a name without brackets that are not a unit of the meaning are a part of the name.
    """
    ways = naming.header_parts(head)
    beside = [spellings.get(unit, unit) for _, unit in ways if unit]
    if len(ways) > 1 or not re.search(r"[\[(<{]", head):
        beside = [unit for unit in beside if naming.scale_of(unit, meaning) is not None][:1]
    under = tables.bare_unit(below)
    return [unit for unit in (spellings.get(under, under), *beside) if unit]


def scale_for(block: tables.Block, i: int, meaning: str, columns: ColumnMap) -> tuple[naming.Scale, str]:
    """Scale and unit of a column; refused where the file states none, an unknown or another one."""
    column, head = columns.columns[meaning], block.heads[i].strip()
    stated = stated_units(head, block.below[i], meaning, columns.format.spellings)
    if meaning in naming.SHAPES:
        return naming.Scale(), (stated or [""])[0]
    where = f'{block.source}: column "{printable(head)}"'
    if any(map(naming.is_torque, stated)):
        cure_torque = "Divide it by the radius of the track in the file, and name that column."
        raise InputError(where, "is a torque, not a force", cure=cure_torque)

    def cure(unit: str) -> str:
        line = f"{meaning} = {{ name = {shown(head)}, unit = {shown(unit)} }}"
        return f"Below [columns] of a column map: {line}."

    def alike(scale: naming.Scale) -> bool:
        """Whether a unit is of the size that the map states; for times as text the map decides."""
        mapped = column.unit or ""
        is_text = meaning == "time" and bool(naming.time_form(mapped))
        return is_text or scale == naming.scale_of(mapped, meaning)

    known = {unit: naming.scale_of(unit, meaning) for unit in stated}
    if column.unit is not None:
        for unit, scale in known.items():
            if columns.is_shipped if scale is None else not alike(scale):
                rule, got = f'is in "{column.unit}" by its map', f'"{printable(unit)}" in the file'
                raise UnfitError(where, rule, got, cure(unit))
        return naming.scale_of(column.unit, meaning) or naming.Scale(), column.unit
    if meaning == "friction" and naming.looks_like_force(head):
        rule = "is a force by its name, not a friction"
        raise InputError(where, rule, cure="Name it as tangential_force, with its unit.")
    if None in known.values() or len({*known.values()}) > 1:
        quantity = f"{meaning.replace('_', ' ')} ({naming.known_units(meaning)})"
        rule = f"has a unit that is not one of the {quantity}"
        raise UnfitError(where, rule, f'"{printable(", ".join(stated))}"', cure("..."))
    if not stated and meaning not in ("friction", "cycles"):
        raise UnfitError(where, "has no unit, so that its meaning is not certain", cure=cure("..."))
    unit = stated[0] if stated else ""
    return known.get(unit) or naming.Scale(), "" if naming.plain(unit) in naming.SYMBOLS["friction"] else unit


def in_si(block: tables.Block, columns: ColumnMap) -> Read:
    """Columns of the map in SI units; of columns of one name, the first, if all have its numbers."""
    notes = list(block.notes)
    places = places_of(block, columns, notes)
    scales = {i: scale_for(block, i, meaning, columns) for meaning, some in places.items() for i in some}
    cells = dict(zip(scales, tables.cells_of(block, list(scales)), strict=True))
    timed = {i: form for i in places.get("time", ()) if (form := naming.time_form(scales[i][1]))}
    numeric = [cells[i] for i in sorted(scales) if i not in timed]
    stated = columns.format.decimal if block.word == "line" else "."
    decimal = stated or decimal_of(numeric, block.separator, block.source)
    absent = [float(one) for one in columns.format.missing if FLOAT.fullmatch(one)]
    arrays: Arrays = {}
    for meaning, some in places.items():
        made = []
        for i in some:
            values = _values(block, cells[i], i, columns.format.missing, decimal, timed.get(i, ""))
            if scales[i][1] == "%":  # a cell shown as a percentage is saved as a fraction
                values = values * np.where([tables.PERCENT in cell for cell in cells[i]], 100.0, 1.0)
            values = np.where(np.isin(values, absent), np.nan, values) if absent else values
            made.append(_scaled(block, values, i, meaning, *scales[i], columns.columns[meaning].sign))
        both = np.isfinite(made).all(axis=0)
        if any(not np.array_equal(made[0][both], other[both]) for other in made[1:]):
            listed = ", ".join(f'"{printable(block.heads[i].strip())}"' for i in some)
            which = " or ".join(str(i + 1) for i in some)
            cure = f"State which below [columns] in a column map: {meaning} = {which}."
            rule = f"has {len(some)} columns that could be the {meaning.replace('_', ' ')}"
            raise UnfitError(block.source, rule, f"columns {listed}", cure)
        arrays[meaning] = made[0]
    first = {meaning: some[0] for meaning, some in places.items()}
    units = {meaning: scales[i][1] for meaning, i in first.items()}
    return Read(block, arrays, first, units, decimal, notes)


def _values(
    block: tables.Block, cells: Sequence[str], i: int, marks: Sequence[str], decimal: str, form: str
) -> Array:
    """Numbers or seconds of a column; refused with the row of what is neither."""
    own = {one.casefold() for one in marks}
    missing = naming.MISSING | own
    values, wrong = seconds(cells, form, missing) if form else numbers(cells, decimal, missing)
    if not wrong:
        return values
    cell, where = cells[wrong[0]], block.at(wrong[0], i)
    bare = cell.rstrip(tables.PERCENT)
    cure = f"If that means a missing value, add below [format] in the column map: missing = [{shown(bare)}]"
    cure += f"; if the table ends there, ends = [{shown(bare)}]." if i == 0 else "."
    got = f'"{printable(bare)}"'
    if form:
        raise InputError(where, f'must be a time ("{form}")', got, f"Forms of times: {TIMES}.")
    if tables.is_clock(bare) or re.match(r"\d{1,4}([-/.])\d{1,2}\1\d", bare):
        cure = f"For a column of times, add to the column map: {TIMES}."
    elif _GROUPED.match(bare):
        cure = "If its mark is between thousands, export the log without such marks."
    raise InputError(where, "must be a number", got, cure)


def _scaled(
    block: tables.Block, values: Array, i: int, meaning: str, size: naming.Scale, unit: str, sign: float
) -> Array:
    """A column in SI units."""
    head = block.heads[i].strip()
    where = f'{block.source}: column "{printable(head)}"'
    found = (values * size.factor + size.offset) * (sign if meaning != "time" else 1.0)
    if meaning == "temperature" and (below := np.flatnonzero(found < -1e-9)).size:
        got = f"{float(values[below[0]]):g}"
        line = f'temperature = {{ name = {shown(head)}, unit = "..." }}'
        cure = f"State its true unit below [columns] in a column map: {line}"
        cure += f'; if this is a code for a missing value, write missing = ["{got}"] below [format].'
        raise InputError(where, "has temperatures below absolute zero", f"{got} {unit}", cure)
    return found if np.isfinite(found).all() else np.where(np.isfinite(found), found, np.nan)


# --- the log --------------------------------------------------------------------------------------
def raw_log(
    block: tables.Block, content: tables.Content, columns: ColumnMap, given: Mapping[str, Any]
) -> RawLog:
    """Log of one table, with the conditions that the column map states for its file."""
    source = f"{content.name}, {printable(block.name)}" if block.name else content.name
    radius = given.get("track_radius")
    read = in_si(block, columns)
    notes = read.notes
    if naming.looks_extreme(head := read.head("friction")):
        notes.append(f'the column of friction, "{printable(head)}", is not a mean friction by its name')
    arrays, missing = _steady(read, columns, given.get("normal_force"), source)
    turning = arrays.pop("rotational_speed", None)
    turns = {} if turning is None else {"rotational_speed": np.abs(turning)}
    if turns and radius is not None and "slip_speed" not in arrays:
        arrays["slip_speed"] = turns["rotational_speed"] * radius
        notes.append(f"slip speed is rotational speed times {format_quantity(radius, 'm')}")
    _drop_stroke_speed(read, arrays)
    is_text = block.word == "line"
    conditions, measured, sentences = conditions_of(given, arrays | turns, source)
    sign = "comma" if read.decimal == "," else "point"
    form = f", {tables.SEPARATED[block.separator]}, decimal {sign}" if is_text else ""
    return RawLog(
        source=source,
        checksum=content.checksum,
        format=f"{columns.name} ({content.words}{form})",
        missing=missing,
        columns=_columns_read(columns, read),
        conditions=conditions,
        measured=measured,
        notes=(*notes, *sentences),
        **arrays,  # type: ignore[arg-type]
    )


def _steady(read: Read, columns: ColumnMap, force: float | None, source: str) -> tuple[Arrays, int]:
    """Columns in the complete rows of steady sliding, friction as magnitude; and how many are incomplete."""
    arrays, notes = dict(read.arrays), read.notes
    _drop_empty(arrays, source, notes)
    _mend_sign(arrays, columns, source, notes, is_given=force is not None)
    signed = _friction(arrays, force, source, notes)
    arrays["friction"] = _magnitude(signed, source, notes)
    complete = _complete(arrays, read.block, source)
    missing = int((~complete).sum())
    if missing:
        notes.append(f"{missing} of {complete.size} rows are left out: friction or its abscissa is missing")
    there = sorted((i, meaning) for meaning, i in read.places.items() if meaning in _SIGNALS)
    signals = [Signal(_SIGNALS[m], printable(read.head(m)), read.arrays[m]) for _, m in there]
    kept, left_out = sliding_rows(signals, signed, arrays.get("time"), complete)
    notes += [left_out] if left_out else []
    return {name: column[kept] for name, column in arrays.items() if name not in naming.SHAPES}, missing


def _columns_read(columns: ColumnMap, read: Read) -> tuple[ColumnRead, ...]:
    """How each column of the file was understood."""
    meanings = {i: meaning for meaning, i in read.places.items()}
    found = []
    for i, head in enumerate(read.block.heads):
        meaning = meanings.get(i)
        why = columns.columns[meaning].origin if meaning else "not needed"
        unit = read.units[meaning] if meaning else read.block.below[i]
        if meaning in naming.SHAPES:
            meaning, why = None, f"{meaning}, {why}"
        found.append(ColumnRead(header=head.strip(), meaning=meaning, unit=unit, why=why))
    return tuple(found)


def _drop_empty(arrays: Arrays, source: str, notes: list[str]) -> None:
    """Leave out abscissae without any value; one must be left."""
    there = [meaning for meaning in naming.ABSCISSAE if meaning in arrays]
    empty = [meaning for meaning in there if np.isnan(arrays[meaning]).all()]
    if empty == there:
        raise InputError(source, f"has no value of {' or '.join(empty)} in any row")
    for meaning in empty:
        del arrays[meaning]
        notes.append(f"the column of {meaning} is empty and not used")


def _mend_sign(arrays: Arrays, columns: ColumnMap, source: str, notes: list[str], *, is_given: bool) -> None:
    """Make compression positive: the sign of nearly all rows, or that of the column map.

    A column without any force gives way to the constant force of the column map, if there is one.
    """
    column = arrays.get("normal_force")
    if column is not None and not (np.abs(column) > 0.0).any() and "friction" not in arrays:
        if not is_given:
            rule = f"has a normal force that is {'zero' if (column == 0.0).any() else 'missing'} in every row"
            cure = 'If the load is a dead weight, write normal_force = "... N" below [test] of a column map.'
            raise InputError(source, rule, cure=cure)
        del arrays["normal_force"]
        notes.append("the column of normal force has no load in any row and is not used")
        return
    if column is None or columns.columns["normal_force"].sign < 0:
        return
    negative, positive = int((column < 0.0).sum()), int((column > 0.0).sum())
    if negative > ONE_SIGN * (negative + positive):
        arrays["normal_force"] = -column
        notes.append("the normal force is negative in the file: compression counts negative there")
    elif "friction" not in arrays and positive <= ONE_SIGN * (negative + positive):
        rule = "has a normal force of both signs, so that the sign of compression is not certain"
        got = f"{positive} rows above zero, {negative} below"
        cure = "Below [columns] in a column map, add to normal_force: sign = -1 if compression is negative."
        raise InputError(source, rule, got, cure)


def _friction(arrays: Arrays, force: float | None, source: str, notes: list[str]) -> Array:
    """Friction with its sign as logged, or tangential over normal force."""
    if "friction" in arrays:
        return arrays["friction"]
    tangential = np.abs(arrays["tangential_force"])
    if "normal_force" not in arrays:
        if force is None:
            cure = 'In a map, below [columns]: normal_force = "..."; below [test]: normal_force = "... N".'
            raise UnfitError(source, "has a tangential force but no normal force", cure=cure)
        notes.append(f"friction is |tangential force| / {format_quantity(force, 'N')}, the constant given")
        return np.asarray(tangential / force)
    notes.append("friction is |tangential force| / normal force, row by row")
    normal_force = arrays["normal_force"]
    released = int((normal_force <= 0.0).sum())
    if released:
        notes.append(f"{released} rows without compression (normal force zero or pulling) are left out")
    friction = np.full(len(tangential), np.nan)
    with np.errstate(over="ignore"):  # such a ratio is not a friction, and left out
        np.divide(tangential, normal_force, out=friction, where=normal_force > 0.0)
    return np.where(np.isfinite(friction), friction, np.nan)


def _magnitude(friction: Array, source: str, notes: list[str]) -> Array:
    """Magnitude of the friction, without values that cannot be a ratio of forces in sliding."""
    size = np.abs(friction)
    beyond = size > HIGHEST
    if beyond.sum() > FEW * np.isfinite(size).sum():
        cure = 'If it is in percent: friction = { name = "...", unit = "%" } below [columns] in a column map.'
        rule = f"has a friction above {HIGHEST:g} in more than a tenth of its rows: not a ratio of forces"
        raise InputError(source, rule, f"a median of {float(np.nanmedian(size)):.4g}", cure)
    if beyond.any():
        notes.append(
            f"friction is above {HIGHEST:g} in {int(beyond.sum())} of {len(size)} rows (up to "
            f"{np.max(size[beyond]):.4g}), which is not a ratio of forces in sliding: these rows are left out"
        )
        size[beyond] = np.nan
    negative = int(((friction < 0.0) & ~beyond).sum())
    if negative:
        why = "(strokes there and back, or an offset of zero): its magnitude is used"
        notes.append(f"friction is negative in {negative} of {len(size)} rows {why}")
    return size


def _complete(arrays: Arrays, block: tables.Block, source: str) -> Rows:
    """Rows that have friction and every abscissa, none of which may run backwards."""
    abscissae = [meaning for meaning in naming.ABSCISSAE if meaning in arrays]
    kept: Rows = np.all([np.isfinite(arrays[name]) for name in ("friction", *abscissae)], axis=0)
    if kept.sum() < 2:
        got = f"{int(kept.sum())} of {len(kept)} rows"
        raise InputError(source, "needs at least two rows with a friction and its abscissa", got)
    rows = np.flatnonzero(kept)
    for meaning in abscissae:
        column = arrays[meaning][kept]
        back = np.flatnonzero(np.diff(column) < 0.0)
        if back.size:
            i = int(back[0]) + 1
            unit, where = naming.MEANINGS[meaning], block.at(int(rows[i]))
            got = " after ".join(format_quantity(float(column[j]), unit, 8) for j in (i, i - 1))
            cure = "Split the file there; if a column numbers its tests, write below [format] of a column map"
            cure += ': tests = ["..."]; if this column has another meaning, state it there.'
            raise InputError(where, f"{meaning} must not run backwards", got, cure)
    return kept


def _drop_stroke_speed(read: Read, arrays: Arrays) -> None:
    """Leave out the greatest speed of a stroke: it is not the speed of sliding."""
    is_stroke = naming.plain(read.head("position")).startswith(("linear position", "lin position"))
    if is_stroke and arrays.pop("slip_speed", None) is not None:
        read.notes.append(
            "these are strokes there and back: the file has their greatest speed, which is not used; write "
            "the mean as slip_speed below [test] (2/pi of the greatest, if the motion is sinusoidal)"
        )
