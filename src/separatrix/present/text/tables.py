"""Plain-text tables and lists of facts, the same in every terminal: no colour, no width to guess."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from separatrix.units import format_quantity

WIDTH = 96
ABSENT = "-"


def heading(text: str) -> str:
    """Return a heading, underlined."""
    line = shorten(text)
    return f"{line}\n{'=' * len(line)}"


def section(text: str, *blocks: str) -> str:
    """Return a section: its title, underlined, and what stands in it."""
    return "\n".join([text, "-" * len(text), *blocks])


def facts(pairs: Sequence[tuple[str, str]]) -> str:
    """Return labels and values in two columns."""
    width = max(len(label) for label, _ in pairs)
    return "\n".join(_fact(label, value, width) for label, value in pairs)


def _fact(label: str, value: str, width: int) -> str:
    hanging = " " * (width + 4)
    return textwrap.fill(
        value,
        WIDTH,
        initial_indent=f"  {label:<{width}}  ",
        subsequent_indent=hanging,
        break_on_hyphens=False,
    )


def table(headers: Sequence[str], rows: Sequence[Sequence[str]], *, left: int = 1) -> str:
    """Return a table; the first `left` columns start at the left, numbers end at the right.

    Parameters
    ----------
    headers : sequence of str
        A header may hold a line break: the unit goes under the name.
    rows : sequence of sequences of str
        One text for each header.
    left : int
        Columns of text.
    """
    tops = [header.partition("\n")[::2] for header in headers]
    lines = [[top for top, _ in tops], [bottom for _, bottom in tops]]
    lines = lines if any(lines[1]) else lines[:1]
    widths = [max(len(line[i]) for line in [*lines, *rows]) for i in range(len(headers))]
    rule = ["-" * width for width in widths]
    return "\n".join(_row(line, widths, left) for line in [*lines, rule, *rows])


def _row(cells: Sequence[str], widths: Sequence[int], left: int) -> str:
    padded = [
        f"{cell:<{width}}" if i < left else f"{cell:>{width}}"
        for i, (cell, width) in enumerate(zip(cells, widths, strict=True))
    ]
    return "  " + "  ".join(padded).rstrip()


def paragraph(text: str, *, indent: str = "  ", first: str | None = None) -> str:
    """Return text broken into lines."""
    start = indent if first is None else first
    return textwrap.fill(text, WIDTH, initial_indent=start, subsequent_indent=indent, break_on_hyphens=False)


def number(value: float | None, digits: int = 3) -> str:
    """Return a pure number with so many decimals, or a dash if it is absent."""
    return ABSENT if value is None else f"{round(value, digits) + 0.0:.{digits}f}"


def significant(value: float | None, digits: int = 4) -> str:
    """Return a pure number with so many significant digits, or a dash if it is absent."""
    return ABSENT if value is None else f"{float(f'{value:.{digits}g}'):g}"


def quantity(value: float | None, unit: str) -> str:
    """Return a value in a unit a reader likes, or a dash if it is absent."""
    return ABSENT if value is None else format_quantity(value, unit)


def shorten(text: str, width: int = WIDTH) -> str:
    """Return the text on one line, cut if it is too long."""
    return textwrap.shorten(text, width, placeholder=" ...")
