"""From a table of a file to a log in SI units: complete rows of steady sliding, friction as magnitude."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from separatrix.friction.logs.column_map import ColumnMap
from separatrix.friction.logs.columns import Meant, Understood, understand
from separatrix.friction.logs.dialect import is_number
from separatrix.friction.logs.log import KEYS, RawLog, RawTable, conditions_of
from separatrix.friction.logs.names import ABSCISSAE, MEANINGS, header_parts, looks_extreme, plain
from separatrix.friction.logs.sliding import Rows, sliding_rows
from separatrix.ground.errors import InputError
from separatrix.ground.units import Array, format_quantity, printable, shown

HIGHEST = 5.0
"""Friction above which a value is not a ratio of forces in sliding: a code for a missing value, no load."""

FEW = 0.1  # share of the rows up to which such values are left out; with more the column is refused
ONE_SIGN = 0.9  # share of the rows in which the normal force must have one sign to be that of compression
Arrays = dict[str, Array]  # columns by their meaning, shape (row,) each, in SI units


def raw_log(
    table: RawTable,
    source: str,
    checksum: str,
    format_name: str,
    columns: ColumnMap,
    given: Mapping[str, str | float],
) -> RawLog:
    """Log of one table, with the conditions that the column map states for its file."""
    constant = given.get("normal_force")
    force = constant if isinstance(constant, float) else None
    of_track = given.get("track_radius")
    radius = of_track if isinstance(of_track, float) else None
    understood = understand(
        *(table.headers, table.units, source, columns, table.layout),
        constant_force=force is not None,
        track_radius=radius,
    )
    _check_twins(table, understood, source)
    notes: list[str] = []
    mean = understood.used.get("friction")
    if mean is not None and looks_extreme(header := table.headers[mean.index].strip()):
        notes.append(f'the column of friction, "{printable(header)}", is not a mean friction by its name')
    arrays = _in_si(table, understood, columns, source, notes)
    _mend_sign(arrays, understood, source, notes, is_given=force is not None)
    signed = _friction(arrays, force, notes)
    arrays["friction"] = _magnitude(signed, source, notes)
    kept = _complete(arrays, table, source)
    missing = int(len(kept) - kept.sum())
    if missing:
        notes.append(f"{missing} of {len(kept)} rows are left out: friction or its abscissa is missing")
    kept, left_out = sliding_rows(table, signed, arrays.get("time"), kept)
    notes += [left_out] if left_out else []
    if not kept.all():
        arrays = {meaning: column[kept] for meaning, column in arrays.items()}
    rotation = arrays.pop("rotational_speed", None)
    turns = {} if rotation is None else {"rotational_speed": np.abs(rotation)}
    if turns and radius is not None and "slip_speed" not in arrays:
        arrays["slip_speed"] = turns["rotational_speed"] * radius
        notes.append(f"slip speed is rotational speed times {format_quantity(radius, 'm')}")
    metadata = _without_stroke_speed(table, arrays, notes)
    conditions, measured, sentences = conditions_of(given, metadata, arrays | turns, source)
    if turns and "slip_speed" in measured and conditions.slip_speed and "slip_speed" not in arrays:
        turning = turns["rotational_speed"]  # the radius of the track is in the head of the file
        arrays["slip_speed"] = turning * (conditions.slip_speed / float(np.nanmedian(turning)))
    return RawLog(
        source=source,
        checksum=checksum,
        format=format_name,
        missing=missing,
        columns=understood.columns,
        metadata=dict(table.metadata),
        conditions=conditions,
        measured=measured,
        notes=(*notes, *sentences),
        friction=arrays["friction"],
        time=arrays.get("time"),
        distance=arrays.get("distance"),
        cycles=arrays.get("cycles"),
        normal_force=arrays.get("normal_force"),
        tangential_force=arrays.get("tangential_force"),
        temperature=arrays.get("temperature"),
        wear_depth=arrays.get("wear_depth"),
        slip_speed=arrays.get("slip_speed"),
    )


def _check_twins(table: RawTable, understood: Understood, source: str) -> None:
    """Refuse columns of one name with different numbers, where one of them is needed."""
    for meaning, others in understood.twins.items():
        if meaning not in understood.used:
            continue
        places = [understood.used[meaning].index, *others]
        columns = [table.columns[i] for i in places]
        both = np.isfinite(columns).all(axis=0)
        if any(not np.array_equal(columns[0][both], one[both]) for one in columns[1:]):
            header = table.headers[places[0]].strip()
            rule = f"has {len(places)} columns that could be the {meaning.replace('_', ' ')}"
            listed = ", ".join(f'"{printable(header)}"' for _ in places)
            numbers = " or ".join(str(i + 1) for i in places)
            cure = f"State which below [columns] in a column map: {meaning} = {numbers}."
            raise InputError(source, rule, f"columns {listed}", cure)


def _in_si(
    table: RawTable, understood: Understood, columns: ColumnMap, source: str, notes: list[str]
) -> Arrays:
    """Columns in SI units; NaN for what is not finite or a number that means a missing value."""
    absent = [float(word) for word in columns.format.missing if is_number(word) and "," not in word]
    arrays = {}
    for meaning, one in understood.used.items():
        column = table.columns[one.index]
        if absent:
            column = np.where(np.isin(column, absent), np.nan, column)
        if one.scale is not None:
            column = one.scale.of(column)
        if one.sign < 0:
            column = -column
        if meaning == "temperature":
            _check_absolute_zero(column, table, one, source)
        arrays[meaning] = (
            column if np.isfinite(column).all() else np.where(np.isfinite(column), column, np.nan)
        )
    there = [meaning for meaning in ABSCISSAE if meaning in arrays]
    empty = [meaning for meaning in there if np.isnan(arrays[meaning]).all()]
    if empty == there:
        raise InputError(source, f"has no value of {' or '.join(empty)} in any row")
    for meaning in empty:
        del arrays[meaning]
        notes.append(f"the column of {meaning} is empty and not used")
    return arrays


def _check_absolute_zero(column: Array, table: RawTable, one: Meant, source: str) -> None:
    """Refuse temperatures below absolute zero: the unit is another, or they mean a missing value."""
    below = np.flatnonzero(column < -1e-9)
    if below.size:
        name = shown(table.headers[one.index].strip())
        line = f'temperature = {{ name = {name}, unit = "..." }}'
        got = f"{float(table.columns[one.index][below[0]]):g} {one.unit}"
        cure = (
            f"State its true unit below [columns] in a column map: {line}; if this is a code for a missing "
            f'value, write missing = ["{got.split()[0]}"] below [format].'
        )
        raise InputError(f"{source}: column {name}", "has temperatures below absolute zero", got, cure)


def _mend_sign(
    arrays: Arrays, understood: Understood, source: str, notes: list[str], *, is_given: bool
) -> None:
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
    if column is None or understood.used["normal_force"].sign < 0:
        return
    negative, positive = int((column < 0.0).sum()), int((column > 0.0).sum())
    if negative > ONE_SIGN * (negative + positive):
        arrays["normal_force"] = -column
        notes.append("the normal force is negative in the file: compression counts negative there")
    elif "friction" not in arrays and positive <= ONE_SIGN * (negative + positive):
        rule = "has a normal force of both signs, so that the sign of compression is not certain"
        got = f"{positive} rows above zero, {negative} below"
        cure = "Below [columns] in a column map, add to normal_force: sign = 1 (or -1)."
        if understood.used["normal_force"].why != "column map":
            raise InputError(source, rule, got, cure)


def _friction(arrays: Arrays, force: float | None, notes: list[str]) -> Array:
    """Friction with its sign as logged, or tangential over normal force."""
    if "friction" in arrays:
        return arrays["friction"]
    tangential = np.abs(arrays["tangential_force"])
    if "normal_force" not in arrays:
        normal = np.nan if force is None else force
        notes.append(f"friction is |tangential force| / {format_quantity(normal, 'N')}, the constant given")
        return np.asarray(tangential / normal)
    notes.append("friction is |tangential force| / normal force, row by row")
    normal_force = arrays["normal_force"]
    released = int((normal_force <= 0.0).sum())
    if released:
        notes.append(f"{released} rows without compression (normal force zero or pulling) are left out")
    friction = np.full(len(tangential), np.nan)
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
        notes.append(
            f"friction is negative in {negative} of {len(size)} rows (strokes there and back, or an "
            "offset of zero): its magnitude is used"
        )
    return size


def _complete(arrays: Arrays, table: RawTable, source: str) -> Rows:
    """Rows that have friction and every abscissa, none of which may run backwards."""
    abscissae = [meaning for meaning in ABSCISSAE if meaning in arrays]
    kept: Rows = np.all([np.isfinite(arrays[name]) for name in ("friction", *abscissae)], axis=0)
    if kept.sum() < 2:
        got = f"{int(kept.sum())} of {len(kept)} rows"
        raise InputError(source, "needs at least two rows with a friction and its abscissa", got)
    rows = np.flatnonzero(kept)
    for meaning in abscissae:
        column = arrays[meaning][kept]
        back = np.flatnonzero(np.diff(column) < 0.0)
        if len(back):
            i = int(back[0]) + 1
            row = f"table row {rows[i] + 1}" if table.lines is None else f"line {table.lines[rows[i]]}"
            here, before = (format_quantity(float(column[j]), MEANINGS[meaning], 8) for j in (i, i - 1))
            cure = "Split the file there; or, if this column has another meaning, state it in a column map."
            rule = f"{meaning} must not run backwards"
            raise InputError(f"{source}: {row}", rule, f"{here} after {before}", cure)
    return kept


def _without_stroke_speed(table: RawTable, arrays: Arrays, notes: list[str]) -> dict[str, str]:
    """Metadata, and columns, without the greatest speed of a stroke: it is not the speed of sliding."""
    strokes = any(plain(header).startswith(("linear position", "lin position")) for header in table.headers)
    names = KEYS["slip_speed"].split("; ")
    speeds = [key for key in table.metadata if plain(header_parts(key)[0][0]) in names]
    if not strokes or not (speeds or "slip_speed" in arrays):
        return dict(table.metadata)
    arrays.pop("slip_speed", None)
    notes.append(
        "these are strokes there and back: the file has their greatest speed, which is not used; write "
        "the mean as slip_speed below [test] (2/pi of the greatest, if the motion is sinusoidal)"
    )
    return {key: value for key, value in table.metadata.items() if key not in speeds}
