"""Figures for journals, drawn from a dataset alone, so that a saved result can be drawn again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import xarray as xr
from matplotlib.figure import Figure

from separatrix.figures import (
    bearing,
    forces,
    ranking,
    restitution,
    sensitivity,
    simulation,
    stability,
    sweep,
    traction,
)
from separatrix.figures import map as maps
from separatrix.figures.heading import headed
from separatrix.figures.literal import literal, literal_texts
from separatrix.figures.style import journal, save, settled

__all__ = ["compared", "figures", "save"]

Draw = Callable[[xr.Dataset], Figure]

FIGURES: Mapping[str, Mapping[str, Draw]] = {
    "bearing": {"bearing-balls": bearing.balls, "bearing-contacts": bearing.contact},
    "traction": {"traction-curves": traction.curves, "traction-shear": traction.shear},
    "restitution": {"restitution-film": restitution.lubrication},
    "stability": {"stability-curve": stability.stability},
    "map": {"stability-map": maps.map},
    "simulate": {"simulation": simulation.run, "simulation-forces": forces.forces},
    "rank": {"rank-overview": ranking.overview, "stability-curve": stability.stability},
    "sensitivity": {
        "sensitivity-probabilities": sensitivity.probabilities,
        "sensitivity-convergence": sensitivity.convergence,
    },
    "sweep": {"sweep": sweep.sweep},
}
"""Verb -> name of the file -> what draws it."""


EACH = {"rank": ranking.environments, "sensitivity": sensitivity.each}
"""Verb -> what yields its further pictures: one for each environment."""

NEEDED = {"rank": "restitution_factor", "restitution": "film_thickness", "sweep": "case"}
"""Verb -> dimension without which nothing is drawn: an interrupted ranking or sweep, bare races."""


def compared(first: xr.Dataset, second: xr.Dataset, names: tuple[str, str]) -> Figure:
    """Return the figure of two simulations together.

    Parameters
    ----------
    first, second : Dataset
        From two answers of `simulate`.
    names : tuple of str
        What the legend calls them.
    """
    from separatrix.figures.comparison import comparison

    shown = literal(names[0]), literal(names[1])
    with journal():
        return settled(comparison(literal_texts(first), literal_texts(second), shown))


def figures(verb: str, data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the name and the figure of every picture of an answer.

    Parameters
    ----------
    verb : str
        The question.
    data : Dataset
        From `present.dataset` or `present.load`.
    """
    if verb in NEEDED and NEEDED[verb] not in data.sizes:
        return
    data = literal_texts(data)
    with journal():
        for name, draw in FIGURES.get(verb, {}).items():
            yield name, settled(headed(draw(data), data))
        for name, figure in EACH[verb](data) if verb in EACH else ():
            yield name, settled(headed(figure, data))
