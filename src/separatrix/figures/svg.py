"""Figures and formulas as SVG that a page can hold: small, without comments, with where its data are."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import math_to_image

from separatrix.figures.hover import Plot
from separatrix.figures.style import NOTHING, journal

POINTS = 72.0
"""Points of an inch: the unit of matplotlib's SVG."""

_COMMENT = re.compile(r"<!--.*?-->\s*|<metadata>.*?</metadata>\s*", re.DOTALL)
_PATH = re.compile(r' d="[^"]*"')
_LONG = re.compile(r"-?\d+\.\d{3,}(?!\d*e)")
_SIZE = re.compile(r'<svg[^>]*?viewBox="0 0 ([\d.]+) ([\d.]+)"', re.DOTALL)

Place = tuple[float, float, str]
"""Centre in points of the SVG, from its upper left corner, and text."""


def svg_of(figure: Figure) -> tuple[str, float, float]:
    """Return a figure as SVG with its width and height [points]; texts are drawn, none is left as text."""
    buffer = io.StringIO()
    with journal():
        figure.savefig(buffer, format="svg", metadata=NOTHING[".svg"])
    return _small(buffer.getvalue())


def formula(latex: str) -> tuple[str, float, float]:
    """Return a formula as SVG with its width and height [points]."""
    buffer = io.BytesIO()
    with journal(), rc_context({"savefig.transparent": True}):
        math_to_image(f"${latex}$", buffer, prop=FontProperties(size=11), format="svg")
    return _small(buffer.getvalue().decode())


def _small(text: str) -> tuple[str, float, float]:
    """Return an SVG without comments and to a hundredth of a point, and its size."""
    text = _COMMENT.sub("", text[text.index("<svg") :])
    text = _PATH.sub(lambda path: _LONG.sub(lambda one: f"{float(one[0]):.2f}", path[0]), text)
    size = _SIZE.search(text)
    if size is None:
        raise ValueError("matplotlib's SVG has no viewBox")
    return text, float(size[1]), float(size[2])


def places(axes: Axes, plot: Plot, most: int, *names: str) -> Iterator[Place]:
    """Yield where the points of a plot are in the SVG of the figure that has them in these axes.

    Parameters
    ----------
    axes : Axes
        Of a finished figure: nothing moves afterwards.
    plot : Plot
        Its series with text; all of them, or those of these names.
    most : int
        Points of a series that has more than this are thinned evenly to at most this number.
    """
    figure = axes.figure.get_figure(root=True)
    if figure is None:
        return
    scale, height = POINTS / figure.dpi, figure.get_size_inches()[1] * POINTS
    left, right = sorted(axes.get_xlim())
    low, high = sorted(axes.get_ylim())
    for series in plot.series:
        if names and series.name not in names:
            continue
        step = -(-len(series.text) // most) if series.text else 1
        for x, y, text in [*zip(series.x, series.y, series.text, strict=False)][::step]:
            if x is None or y is None or not (left <= x <= right and low <= y <= high):
                continue
            across, up = axes.transData.transform((x, y))
            yield float(across * scale), float(height - up * scale), text
