"""Figures for journals, drawn from a dataset alone, so that a saved result can be drawn again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import xarray as xr
from matplotlib.figure import Figure

from separatrix.figures import bearing, ranking, simulation, stability, traction
from separatrix.figures.style import journal, save

__all__ = ["figures", "save"]

Draw = Callable[[xr.Dataset], Figure]

FIGURES: Mapping[str, Mapping[str, Draw]] = {
    "bearing": {"bearing-balls": bearing.balls, "bearing-contacts": bearing.contact},
    "traction": {"traction-curves": traction.curves, "traction-shear": traction.shear},
    "stability": {"stability-curve": stability.stability},
    "simulate": {"simulation": simulation.run},
    "rank": {"rank-overview": ranking.overview, "stability-curve": stability.stability},
}
"""Verb -> name of the file -> what draws it."""


def figures(verb: str, data: xr.Dataset) -> Iterator[tuple[str, Figure]]:
    """Yield the name and the figure of every picture of an answer.

    Parameters
    ----------
    verb : str
        The question.
    data : Dataset
        From `results.dataset` or `results.load`.
    """
    if verb == "rank" and data.sizes.get("restitution_factor", 0) == 0:
        return  # interrupted before the stability curve had a point
    with journal():
        for name, draw in FIGURES.get(verb, {}).items():
            yield name, draw(data)
        if verb == "rank":
            yield from ranking.environments(data)
