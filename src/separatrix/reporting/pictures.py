"""The pictures of a report, drawn from the datasets of its answers, and its formulas."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from separatrix.figures import draw
from separatrix.figures.drawing import bearing_drawing, guesses
from separatrix.figures.envelope import envelope_plots, sweep_plots
from separatrix.figures.hover import Place, candidates_plot, map_plot, places, stability_plot, traction_plot
from separatrix.figures.ranking import file_name, own_environment
from separatrix.figures.style import formula, journal, settled, svg_of
from separatrix.reporting.record import Equation, Kept, Picture, Row, Target

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

REACH, CELL = 5.0, 3.0
"""Radius of a place to point at [points]: of a mark, and of a cell of a map."""

MOST_TARGETS = 60
MOST_CELLS = 900
"""Places to point at in a series, and in a map."""


def picture(kept: Kept, name: str, caption: str, alt: str) -> Iterator[Picture]:
    """Yield the picture of this name of an answer, with its places to point at; nothing without one."""
    if kept.data is None:
        return
    for _, figure in draw(str(kept.document["verb"]), kept.data, only=name):
        yield picture_of(figure, name, caption, alt, tuple(_targets(name, figure, kept.data)))
        return


def picture_of(figure: Figure, name: str, caption: str, alt: str, hover: tuple[Target, ...] = ()) -> Picture:
    """Return a figure as a picture of a report."""
    svg, width, height = svg_of(figure)
    return Picture(name, caption, alt, svg=svg, width=width, height=height, hover=hover)


def _targets(name: str, figure: Figure, data: xr.Dataset) -> Iterator[Target]:
    """Yield the places to point at in a picture; one without series has none."""
    found: list[Place] = []
    radius = REACH
    first = figure.axes[0]
    if name == "rank-overview":
        found += places(first, candidates_plot(data), MOST_TARGETS)
    elif name == "stability-curve" or name.startswith("rank-"):
        found += places(first, stability_plot(data), MOST_TARGETS)
    elif name == "stability-map":
        found, radius = [*places(first, map_plot(data), MOST_CELLS)], CELL
    elif name == "traction-curves":
        for axes, race in zip(figure.axes, ("inner race", "outer race"), strict=False):
            found += places(axes, traction_plot(data), MOST_TARGETS // 2, race)
    elif name in ("envelope", "sweep"):
        plots = envelope_plots(data) if name == "envelope" else sweep_plots(data)
        for axes, plot in zip(figure.axes, plots, strict=False):  # a place without a panel is hidden
            found += places(axes, plot, MOST_TARGETS)
    for x, y, text in found:
        yield Target(round(x, 1), round(y, 1), radius, text)


def own_candidates(data: xr.Dataset | None) -> str:
    """Return the name of the picture of a ranking's candidates in the bearing's own environment."""
    if data is None or "environment" not in data:
        return ""
    place = own_environment(data) or 0
    return f"rank-{place + 1}-{file_name(str(data['environment'].values[place]))}"


def drawing(study: Row, bearing: Row | None) -> Picture:
    """Return the bearing to scale, with the contact angles under load where they are known."""
    angle = None
    if bearing is not None:
        contacts = bearing["contacts"]
        angle = float(contacts["inner"]["contact_angle"]), float(contacts["outer"]["contact_angle"])
    with journal():
        figure = settled(bearing_drawing(study, angle))
    cage = " and its cage" if study.get("cage") else ""
    line = f"line of contact {'under' if angle else 'without'} load"
    return picture_of(
        figure,
        "bearing-drawing",
        f"The bearing{cage} to scale. Red: {line}; blue: clearances. {guesses(study)}",
        f"Drawing to scale: a section through one ball with rings{cage}, all balls along the axis, and one "
        "ball enlarged.",
    )


@cache
def equation(latex: str, words: str) -> Equation:
    """Return a formula, drawn."""
    svg, width, height = formula(latex)
    return Equation(latex, words, svg=svg, width=width, height=height)
