"""What a figure shows, without how it is drawn: rows of panels, each of marks over two axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#000000", "#6b6b6b"
"""Okabe and Ito's palette, and a grey."""

CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
MARKERS = ("o", "s", "^", "v", "P", "*", "p")
SEQUENCE = ("#440154", "#3F4788", "#277E8E", "#2CB17E", "#9BD93C")
"""Five colours from dark to light, for curves in an order."""
VERDICT_COLOURS = {"STABLE": BLUE, "UNSTABLE": VERMILION, "UNDECIDED": ORANGE}
VERDICT_MARKERS = {"STABLE": "o", "UNSTABLE": "X", "UNDECIDED": "D"}

Numbers = Sequence[float | None]
"""In SI: an axis knows the unit that it shows. None is a gap."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """An axis: its label with symbol and unit, the size of that unit, its ends [SI].

    `names` are those of the places 0, 1, ...; `ticks` are places with a name each, in the place of others.
    """

    label: str
    size: float = 1.0
    low: float | None = None
    high: float | None = None
    is_log: bool = False
    names: tuple[str, ...] = ()
    ticks: tuple[tuple[float, str], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Trace:
    """A line, marks, or both, with the interval of each point along x or y; `hover` is a text for each point.

    An interval that has `low` and not `high` has no upper end.

    `face` is a colour inside a closed line that hides what was drawn before, `has_halo` a white edge above
    colours.
    """

    x: Numbers
    y: Numbers
    name: str = ""
    colour: str = BLACK
    line: str = "-"
    width: float = 1.3
    marker: str = ""
    size: float = 4.0
    is_open: bool = False
    low: Numbers = ()
    high: Numbers = ()
    ends_along: str = "y"
    opacity: float = 1.0
    has_halo: bool = False
    face: str = ""
    hover: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Band:
    """What is between two curves."""

    x: Numbers
    low: Numbers
    high: Numbers
    name: str = ""
    colour: str = BLUE
    opacity: float = 0.35


@dataclass(frozen=True, slots=True, kw_only=True)
class Across:
    """A line over the whole panel at one place of an axis, "x" or "y"."""

    at: float
    axis: str = "x"
    name: str = ""
    colour: str = BLACK
    line: str = "-"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cells:
    """A value for each pair of places, as colours: `values` are rows, one for each y."""

    x: Numbers
    y: Numbers
    values: Sequence[Numbers]
    label: str
    low: float | None = None
    high: float | None = None
    colours: str = "viridis"
    hover: Sequence[Sequence[str]] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Hatched:
    """Strokes over some of the cells of these places, above a `fill` if it is stated."""

    x: Numbers
    y: Numbers
    where: Sequence[Sequence[bool]]
    name: str
    colour: str = "#ffffff"
    strokes: str = "////"
    fill: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Label:
    """A text at the right of a panel, at a height, with a mark before it or a line to its place."""

    y: float
    text: str
    colour: str = BLACK
    marker: str = ""


Mark = Trace | Band | Across | Cells | Hatched


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """Marks over two axes, that of y with both ends where there are `labels`; `head` is above these."""

    title: str
    x: Axis
    y: Axis
    marks: tuple[Mark, ...]
    labels: tuple[Label, ...] = ()
    head: str = ""
    is_to_scale: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure:
    """Rows of panels; what is named in them stands below, once; `heading` says of what it is.

    `height` is that of a row [inch], and the width that of a page.
    """

    rows: tuple[tuple[Panel, ...], ...]
    heading: tuple[str, ...] = ()
    height: float = 2.5

    @property
    def panels(self) -> list[Panel]:
        """All of them, row by row."""
        return [panel for row in self.rows for panel in row]

    @property
    def named(self) -> list[Any]:
        """What has a name in the legend."""
        return [one for panel in self.panels for one in panel.marks if getattr(one, "name", "")]


def apart(wanted: Sequence[float], gap: float = 0.055) -> list[float]:
    """Return places in 0 to 1, `gap` apart and in the same order, near to the wanted ones."""
    order = sorted(range(len(wanted)), key=wanted.__getitem__)
    places = [wanted[i] for i in order]
    for _ in range(200):
        for i in range(len(places) - 1):
            lack = gap - (places[i + 1] - places[i])
            if lack > 1e-9:
                places[i], places[i + 1] = places[i] - lack / 2, places[i + 1] + lack / 2
        places = [min(max(place, 0.02), 0.98) for place in places]
    return [places[order.index(i)] for i in range(len(wanted))]
