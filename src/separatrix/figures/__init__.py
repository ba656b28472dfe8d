"""Figures for journals, drawn from a dataset alone, so that a saved result can be drawn again."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from separatrix.figures import chain, envelope, map, ranking, sensitivity, simulation, stability
from separatrix.figures.style import headed, journal, literal, literal_texts, save, settled
from separatrix.ground.errors import InputError

__all__ = ["draw", "plot", "save", "save_all"]

FIGURES: Mapping[str, Callable[[xr.Dataset], Iterator[tuple[str, Figure]]]] = {
    "bearing": chain.bearing,
    "traction": chain.traction,
    "restitution": chain.restitution,
    "mobility": chain.mobility,
    "stability": lambda data: iter([("stability-curve", stability.stability(data))]),
    "map": lambda data: iter([("stability-map", map.stability_map(data))]),
    "simulate": simulation.figures,
    "rank": ranking.figures,
    "sensitivity": sensitivity.figures,
    "sweep": envelope.figures,
}
"""Verb -> what yields its pictures, each with the name of its file."""


def draw(
    verb: str,
    data: xr.Dataset,
    other: xr.Dataset | None = None,
    *,
    names: tuple[str, str] = ("", ""),
    only: str | None = None,
) -> Iterator[tuple[str, Figure]]:
    """Yield name and figure of every picture of an answer.

    Parameters
    ----------
    verb : str
        The question; `compare` draws two simulations, stability curves or rankings together.
    data, other : Dataset
        From `Answer.to_xarray` or `separatrix.load`; only `compare` takes a second one.
    names : tuple of str
        What `compare` writes above the two columns; by default the titles of the studies.
    only : str, optional
        Only the picture of this name, without title and operating point above it: for a document that has
        them already.
    """
    if (verb == "compare") != (other is not None):
        raise InputError(verb, "needs two datasets" if other is None else "has one dataset, not two")
    with journal():
        if other is not None:
            pair = [(literal_texts(one), name) for one, name in zip((data, other), names, strict=True)]
            titles = [literal(name) or str(one.attrs.get("title", "")) for one, name in pair]
            together = stability.comparison if "restitution_factor" in data.sizes else simulation.comparison
            yield "comparison", settled(together(pair[0][0], pair[1][0], titles))
        elif verb in FIGURES:
            data = literal_texts(data)
            for name, figure in FIGURES[verb](data):
                if only in (None, name):
                    yield name, settled(figure if only else headed(figure, data))


def save_all(pictures: Iterable[tuple[str, Figure]], folder: Path) -> None:
    """Write pictures with their names into a folder, each as PNG and SVG."""
    for name, figure in pictures:
        for suffix in (".png", ".svg"):
            save(figure, folder / f"{name}{suffix}")


def plot(verb: str, data: xr.Dataset, name: str | None = None) -> Figure:
    """Return the first picture of an answer, or the one whose file has this name."""
    for found, figure in draw(verb, data):
        if name is None or found == name:
            return figure
    raise InputError(verb, f"has no picture {name or 'of this answer'}")
