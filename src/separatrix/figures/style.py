"""How every figure looks: sizes, colours that colour-blind readers tell apart, labels at the lines."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import offset_copy

from separatrix.errors import InputError

COLUMN, PAGE = 3.5, 7.0
"""Widths of one and of two columns of a journal [inch]."""

BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY, YELLOW, BLACK = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#F0E442",
    "#000000",
)
"""Okabe and Ito's palette."""

CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, BLACK)
GREY = "#6b6b6b"
MARK = "*"
"""After a friction that was asked for where nothing was tested."""

MARKERS = ("o", "s", "^", "v", "P", "*", "p")
VERDICT_COLOURS = {"STABLE": BLUE, "UNSTABLE": VERMILION, "UNDECIDED": ORANGE}
VERDICT_MARKERS = {"STABLE": "o", "UNSTABLE": "X", "UNDECIDED": "D"}

LEADER: Any = {"arrowstyle": "-", "lw": 0.5, "shrinkA": 1.0, "shrinkB": 0.0, "relpos": (0.0, 0.5)}
"""From a label to the end of its line."""

STYLE: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=CYCLE),
    "axes.titlelocation": "left",
    "hatch.linewidth": 0.5,
    "lines.linewidth": 1.3,
    "lines.markersize": 4.0,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "figure.dpi": 200.0,
    "savefig.dpi": 200.0,
    "svg.hashsalt": "separatrix",
    "svg.fonttype": "path",
    "path.simplify": True,
}


@contextlib.contextmanager
def journal() -> Iterator[None]:
    """Draw with this style inside the block."""
    with mpl.rc_context(STYLE):
        yield


def canvas(width: float = COLUMN, height: float = 2.6, **grid: Any) -> tuple[Figure, Any]:
    """Return a figure and its axes; no state of matplotlib's is touched."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(**grid)


def settled(figure: Figure) -> Figure:
    """Lay the figure out once for all, so that every format and every drawing of it is the same."""
    layout = figure.get_layout_engine()
    if layout is not None:
        for _ in range(2):  # the labels beside the axes are known after the first
            layout.execute(figure)
    figure.set_layout_engine(None)  # "none" would leave a placeholder, for which savefig draws twice
    return figure


NOTHING: dict[str, dict[str, Any]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"Creator": None, "Producer": None, "CreationDate": None},
}
"""Endings of pictures, and what is left out of each so that the same data give the same bytes."""


def save(figure: Figure, path: Path) -> None:
    """Write the figure in the format of the ending; the same data give the same bytes.

    Raises
    ------
    InputError
        The ending is none of `NOTHING`.
    """
    if path.suffix not in NOTHING:
        raise InputError(str(path), f"must end in {', '.join(NOTHING)}", got=f'"{path.suffix}"')
    with journal():
        figure.savefig(path, metadata=NOTHING[path.suffix])


def legend_below(figure: Figure, panels: Iterable[Axes] | None = None, *, columns: int = 2) -> None:
    """Name everything in these panels (or in all) once, below the picture."""
    handles: dict[str, Any] = {}
    for axes in figure.axes if panels is None else panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    look: Any = {"fontsize": 6.5, "handlelength": 2.4, "columnspacing": 1.5}
    figure.legend(list(handles.values()), list(handles), loc="outside lower left", ncols=columns, **look)


def label_lines(
    axes: Axes,
    labels: Sequence[tuple[float, float, str, str]],
    *,
    gap: float = 0.055,
    colour: str | None = None,
) -> None:
    """Write labels at the right ends of lines, moved apart where they would overlap.

    Parameters
    ----------
    axes : Axes
        Its limits must be final.
    labels : sequence of (x, y, text, colour)
        Ends of the lines, in data.
    gap : float
        Least distance of two labels, as a share of the height.
    colour : str or None
        Of the text; the line's own if None. A label that had to move is tied to its line.
    """
    low, high = axes.get_ylim()
    wanted = [(y - low) / (high - low) for _, y, _, _ in labels]
    places = spread(wanted, gap)
    moved = any(abs(place - want) > gap / 4 for place, want in zip(places, wanted, strict=True) if want < 1)
    beside = offset_copy(axes.transData, axes.get_figure(root=True), x=12 if moved else 4, units="points")
    for place, want, (x, y, text, own) in zip(places, wanted, labels, strict=True):
        axes.annotate(
            text,
            (x, y),
            xytext=(x, low + place * (high - low)),
            textcoords=beside,
            color=colour or own,
            va="center",
            fontsize=7.0,
            annotation_clip=False,
            arrowprops={**LEADER, "color": own} if moved and want < 1 else None,
        )


def spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Return places in 0 to 1, `gap` apart and in the same order, near to the wanted ones."""
    order = np.argsort(wanted, kind="stable")
    places = np.array(wanted, dtype=float)[order]
    for _ in range(200):
        for low, high in zip(range(len(places) - 1), range(1, len(places)), strict=True):
            lack = gap - (places[high] - places[low])
            if lack > 1e-9:
                places[low] -= lack / 2
                places[high] += lack / 2
        np.clip(places, 0.02, 0.98, out=places)
    result = np.empty(len(places))
    result[order] = places
    return [float(value) for value in result]
