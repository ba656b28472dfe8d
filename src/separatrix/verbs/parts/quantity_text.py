"""Numbers of an answer as facts, columns, sentences and axes, each as `quantities` describes it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from operator import itemgetter
from typing import Any

from separatrix.ground.document import Part
from separatrix.ground.quantity import Estimate, Number, Quantity, alone, scale
from separatrix.present.blocks import Cell, Column, Level, Table, text_column
from separatrix.present.figure import Axis, Trace
from separatrix.verbs.parts.quantities import QUANTITIES

Of = Callable[[Any], Part | None]
"""From a row to the part that has a number; None where the row has none."""


def itself(row: Any) -> Any:
    """Return a row: most tables have their numbers there."""
    return row


def quantity(name: str) -> Quantity:
    """Return the label and form of a quantity of this name; one that only full tables have, by its name.

    A key of a study, as ``film.thickness``, has its own words, with its section where these need it.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    section, _, key = name.replace("_", " ").rpartition(".")
    is_known = section in ("", "operation", "wear") or section in key or key == "race friction"
    return Quantity(label=key if is_known else f"{section.replace('.', ' ')} {key}", head=key)


def ends_of(name: str) -> tuple[str, str]:
    """Return the names of the ends of the interval of a quantity."""
    return quantity(name).ends or (f"{name}_low", f"{name}_high")


def estimate(part: Part, name: str) -> Number:
    """Return a number of a part, with its interval if it has one."""
    value = getattr(part, name)
    low, high = ends_of(name)
    if part.get(low) is None:
        return value  # type: ignore[no-any-return]
    return Estimate(value, part.get(low), part.get(high))


def cell(part: Part | None, name: str, mark: str = "") -> Cell:
    """Return a number of a part as a cell; an absent one without a part."""
    if part is None:
        return Cell(None, quantity(name))
    value = estimate(part, name)
    return Cell(value, quantity(name), part.unit(name), mark if value is not None else "")


def named(name: str) -> str:
    """Return the label of a quantity with its symbol, as a line begins with it."""
    known = quantity(name)
    return begun(f"{known.label} ${known.symbol}$" if known.symbol else known.label)


def begun(words: str) -> str:
    """Return words as they stand at the beginning of a line."""
    return words[:1].upper() + words[1:]


def fact(part: Part, name: str, label: str = "") -> tuple[str, Cell]:
    """Return label and value of a quantity."""
    return begun(label or quantity(name).label), cell(part, name)


def head_of(name: str) -> str:
    """Return what stands above a column of a quantity."""
    return quantity(name).head or quantity(name).label


def column(
    name: str,
    *,
    of: Of = itself,
    head: str = "",
    mark: Callable[[Any], str] = lambda _: "",
    is_short: bool = False,
) -> Column:
    """Return the column of a quantity; `of` finds in a row the part that has it; short: without intervals."""

    def one(row: Any) -> Cell:
        found = cell(of(row), name, mark(row))
        if is_short and isinstance(found.value, Estimate) and not found.value.is_beyond:
            return replace(found, value=found.value.value)
        return found

    return Column(head or head_of(name), one, meaning=quantity(name).meaning)


def known_columns(columns: Iterable[Column], rows: Sequence[Any]) -> tuple[Column, ...]:
    """Return the columns in which some of the rows have a value."""
    return tuple(one for one in columns if any(one.cell(row).value not in (None, "") for row in rows))


def place_column(part: Part, name: str, *, head: str = "") -> Column:
    """Return the column of a list of a part, for rows that are places in it."""
    known, unit = quantity(name), part.unit(name)
    return Column(head or head_of(name), lambda place: Cell(getattr(part, name)[place], known, unit))


def places_table(
    name: str, part: Part, *columns: str, level: Level = Level.SHEET, caption: str = ""
) -> Table:
    """Return lists of a part as columns, their places as rows, by default for a workbook."""
    shown = tuple(place_column(part, one) for one in columns if one in part)
    return Table(name, shown, tuple(range(len(part.get(columns[0])))), caption, level)


def all_numbers(name: str, heads: Sequence[str], rows: Iterable[tuple[Any, ...]]) -> Table:
    """Return what some parts have for a workbook; a row is a value for each of `heads`, and then its part."""
    known = tuple(rows)
    kinds: dict[str, bool] = {}
    for key, value in (pair for *_, part in known for pair in part.values.items()):
        is_words = isinstance(value, str | bool)
        if is_words or isinstance(value, int | float):
            kinds[key] = is_words
    ends = {end for key in kinds for end in ends_of(key)}

    def held(key: str) -> Column:
        if kinds[key]:
            return text_column(key.replace("_", " "), lambda row: row[-1].get(key))
        return Column(key.replace("_", " "), lambda row: cell(row[-1] if key in row[-1] else None, key))

    labels = (text_column(head, itemgetter(place)) for place, head in enumerate(heads))
    columns = (*labels, *(held(key) for key in kinds if key not in ends))
    return Table(name, columns, known, level=Level.SHEET)


def by_race(name: str, inner: Part, outer: Part, *names: str) -> Table:
    """Return a table with quantities as rows, for the inner and the outer race."""
    columns = (
        text_column("", lambda row: begun(quantity(row).label)),
        Column("inner race", partial(cell, inner)),
        Column("outer race", partial(cell, outer)),
    )
    return Table(name, columns, names)


def show(part: Part, name: str) -> str:
    """Return a number of a part as it stands in a sentence."""
    return alone(estimate(part, name), quantity(name), part.unit(name))


def number_of(part: Part, name: str, value: float | None) -> str:
    """Return one number of a list of a part, as it stands in a sentence."""
    return alone(value, quantity(name), part.unit(name))


def fill(part: Part, template: str) -> str:
    """Return a sentence in which ``{name}`` stands for a number of a part."""
    return re.sub(r"\{(\w+)\}", lambda name: show(part, name[1]), template)


def axis(
    name: str,
    unit: str,
    values: Iterable[float | None],
    *,
    label: str = "",
    low: float | None = None,
    high: float | None = None,
    is_log: bool = False,
) -> Axis:
    """Return the axis of a quantity in the unit that suits some values: its label, symbol and unit."""
    known = quantity(name)
    size, symbol = scale([one for one in values if one is not None], unit, known.unit)
    sign = f" ${known.symbol}$" if known.symbol else ""
    words = f"{label or known.label}{sign} [{symbol or '-'}]"
    return Axis(label=words, size=size, low=low, high=high, is_log=is_log)


def marks(
    rows: Sequence[Part], x: str, y: str, *, hover: Callable[[Part], str] | None = None, **look: Any
) -> Trace:
    """Return a mark for each row; an estimate brings its interval along, that of y where both have one."""
    found: dict[str, Any] = {"line": ""} | look
    for way, name in (("x", x), ("y", y)):
        values = [estimate(row, name) for row in rows]
        if any(isinstance(one, Estimate) for one in values):
            known = [one if isinstance(one, Estimate) else Estimate(one) for one in values]
            found |= {"ends_along": way, "low": [one.low for one in known]}
            found |= {"high": [one.high for one in known]}
            values = [one.value for one in known]
        found[way] = values
    return Trace(hover=tuple(hover(row) for row in rows) if hover else (), **found)


# Parameters of a study that are varied.


SPACE = 1.5
"""Ratio of the last step of an axis to its first beyond which values in proportion are logarithmic."""


def parameter_axis(name: str, unit: str, values: Sequence[float], *, is_tight: bool = False) -> Axis:
    """Return the axis of a parameter; a tight one ends at its first and last value."""
    low, high = min(values), max(values)
    ends = (low, high) if is_tight and low < high else (None, None)
    return axis(name, unit, values, is_log=is_proportional(values), low=ends[0], high=ends[1])


def is_proportional(values: Sequence[float]) -> bool:
    """Whether values rise by a factor rather than by a step: their axis is logarithmic."""
    if len(values) < 3 or not values[0] > 0.0:
        return False
    factors = [b / a for a, b in pairwise(values)]
    is_spread = values[-1] - values[-2] > SPACE * (values[1] - values[0])
    return is_spread and max(factors) < 1.05 * min(factors)


def value_of(parameter: Part, name: str, value: float | None) -> Cell:
    """Return a value of a parameter of this name, in its unit."""
    return Cell(value, quantity(name), parameter.get("unit") or "-")


def at(parameter: Part, name: str, value: float | None) -> str:
    """Return a parameter and its value in words."""
    return f"{quantity(name).label} {value_of(parameter, name, value).text}"
