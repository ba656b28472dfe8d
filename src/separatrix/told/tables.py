"""Plain-text tables and lists of facts, the same in every terminal: no colour, no width to guess."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from separatrix.ground.plain_data import field_units
from separatrix.ground.units import format_quantity

if TYPE_CHECKING:
    from separatrix.study.study import Friction

WIDTH = 96
ABSENT = "-"


def heading(text: str) -> str:
    """Return a heading, underlined."""
    line = textwrap.shorten(text, WIDTH, placeholder=" ...")
    return f"{line}\n{'=' * len(line)}"


def section(text: str, *blocks: str) -> str:
    """Return a section: its title, underlined, and its blocks."""
    return "\n".join([text, "-" * len(text), *blocks])


def facts(pairs: Sequence[tuple[str, str]]) -> str:
    """Return labels and values in two columns."""
    width = max(len(label) for label, _ in pairs)
    hanging = " " * (width + 4)
    return "\n".join(
        paragraph(value, first=f"  {label:<{width}}  ", indent=hanging) for label, value in pairs
    )


def table(headers: Sequence[str], rows: Sequence[Sequence[str]], *, left: int = 1) -> str:
    """Return a table; the first `left` columns start at the left, numbers end at the right.

    A header may hold a line break: the unit goes under the name.
    """
    tops = [header.partition("\n")[::2] for header in headers]
    lines = [[top for top, _ in tops], [bottom for _, bottom in tops]]
    lines = lines if any(lines[1]) else lines[:1]
    widths = [max(len(line[i]) for line in [*lines, *rows]) for i in range(len(headers))]
    signs = ["<" if i < left else ">" for i in range(len(widths))]
    return "\n".join(
        "  "
        + "  ".join(f"{c:{sign}{width}}" for c, sign, width in zip(row, signs, widths, strict=True)).rstrip()
        for row in [*lines, ["-" * width for width in widths], *rows]
    )


def paragraph(text: str, *, indent: str = "  ", first: str | None = None) -> str:
    """Return text broken into lines."""
    start = indent if first is None else first
    return textwrap.fill(text, WIDTH, initial_indent=start, subsequent_indent=indent, break_on_hyphens=False)


def grouped(pairs: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """Return each first text with all its second texts, both in order."""
    found: dict[str, list[str]] = {}
    for key, one in pairs:
        found.setdefault(key, []).append(one)
    return found


def number(value: float | None, digits: int = 3) -> str:
    """Return a pure number with this number of decimals, or a dash if it is absent."""
    return ABSENT if value is None else f"{round(value, digits) + 0.0:.{digits}f}"


def significant(value: float | None, digits: int = 4) -> str:
    """Return a pure number with this number of significant digits, or a dash if it is absent."""
    return ABSENT if value is None else f"{float(f'{value:.{digits}g}'):g}"


def quantity(value: float | None, unit: str, digits: int | None = None) -> str:
    """Return a value in a unit a reader likes, rounded to significant digits; a dash if it is absent."""
    return ABSENT if value is None else format_quantity(value, unit, digits or 4)


def stated(record: object, name: str) -> str:
    """Return a field of a record in the unit that its type states."""
    return quantity(getattr(record, name), field_units(type(record))[name])


def interval(
    value: float | None, low: float | None, high: float | None, digits: int = 2, to: str = " to "
) -> str:
    """Return a pure number with its interval."""
    return f"{number(value, digits)} ({number(low, digits)}{to}{number(high, digits)})"


def rate(value: float, low: float | None = None, high: float | None = None) -> str:
    """Return a rate of growth to three digits, with its interval if it has one."""
    ends = "" if low is None else f" ({significant(low, 3)} to {significant(high, 3)})"
    return significant(value, 3) + ends


def kick_list(kicks: Iterable[float]) -> str:
    """Return the initial disturbances of an ensemble."""
    return f"{', '.join(f'{kick:g}' for kick in kicks)} m/s"


def friction_table(
    environments: Sequence[str], friction: Mapping[str, Mapping[str, Friction | None]], *more: tuple[str, str]
) -> str:
    """Return the friction of materials in environments, and below it what each column is."""
    letters = [f"{chr(ord('A') + i % 26)}{i // 26 or ''}" for i in range(len(environments))]
    rows = [[name, *(friction_text(row.get(env)) for env in environments)] for name, row in friction.items()]
    return "\n".join([table(("", *letters), rows), facts([*zip(letters, environments, strict=True), *more])])


def friction_text(friction: Friction | None) -> str:
    """Return a mean friction with its standard deviation."""
    if friction is None:
        return "not measured"
    spread = friction.standard_deviation
    return number(friction.mean) + ("" if spread is None else f" +/- {spread:.2g}")
