"""The one renderer of figures on paper: PNG, SVG and PDF by matplotlib, the same bytes for the same spec."""

from __future__ import annotations

import io
import re
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure as Canvas
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import math_to_image
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator, MaxNLocator
from matplotlib.transforms import Bbox, offset_copy

from separatrix.ground.errors import InputError
from separatrix.ground.units import Array
from separatrix.present.blocks import Page, Picture, spans
from separatrix.present.figure import (
    GREY,
    Across,
    Axis,
    Band,
    Cells,
    Figure,
    Hatched,
    Mark,
    Numbers,
    Panel,
    Trace,
    apart,
)

PAGE, LINE = 7.0, 0.135
"""Width of two columns of a journal, and height of a line [inch]."""

STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlelocation": "left",
    "legend.frameon": False,
    "legend.fontsize": 6.5,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "figure.dpi": 200.0,
    "savefig.dpi": 200.0,
    "svg.hashsalt": "separatrix",
    "svg.fonttype": "path",
}
NOTHING: dict[str, dict[str, None]] = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"Creator": None, "Producer": None, "CreationDate": None},
}
"""Endings of pictures, and what is left out of each so that the same data make the same bytes."""

ONE_AT_A_TIME = threading.Lock()
"""Settings of matplotlib and its reader of formulas are those of the whole process."""

DASHES: dict[str, Any] = {"-": "-", "": "", ":": ":", "--": (0, (5, 2)), "-.": (0, (6, 1.5, 1, 1.5))}
SYMBOLS = {name: rf"\{name}" for name in ("eta", "mu", "zeta", "alpha", "xi")} | {"dxi": r"\delta\xi"}
BESIDE: dict[str, Any] = {"xycoords": "axes fraction", "fontsize": 7.0, "annotation_clip": False}
"""How labels stand beside a panel."""

MOST_NAMED = 3000.0
"""Ratio of the ends of a logarithmic axis below which 2 and 5 are named, too."""

LEAST_NAMED = 6.0
"""The same below which 1, 2 and 5 may leave less than three names."""


def save(spec: Figure, *paths: Path) -> Drawing:
    """Write a figure in the formats of the endings, each one of `NOTHING`; return it as SVG, drawn once."""
    for path in paths:
        if path.suffix not in NOTHING:
            raise InputError(str(path), f"must end in {', '.join(NOTHING)}", got=f'"{path.suffix}"')
    with ONE_AT_A_TIME, mpl.rc_context(STYLE):
        figure = _drawn(spec)
        for path in paths:
            figure.savefig(path, metadata=NOTHING[path.suffix])
        return _svg(figure, spec)


def plot(page: Page, name: str | None = None) -> Canvas:
    """Return the first picture of a page, or the one of this name."""
    for one in page.blocks:
        if isinstance(one, Picture) and name in (None, one.name):
            return drawn(one.figure())
    raise InputError(page.title, f"has no picture {name or 'of this answer'}")


class Way(NamedTuple):
    """An axis of a figure: its ends on paper, as shares from left or top, and their values [SI]."""

    start: float
    end: float
    low: float
    high: float
    is_log: bool


class Drawing(NamedTuple):
    """A figure as SVG with its size [points], and the places that a reader can point at: x, y, and a text.

    `ways` are x and y of its first panel: where a click in it is.
    """

    svg: str
    width: float
    height: float
    targets: tuple[tuple[float, float, str], ...] = ()
    ways: tuple[Way, ...] = ()


MOST_TARGETS, MOST_CELLS, MANY = 400, 900, 5000
"""Targets of a trace, and of cells; points of a line from which it is drawn as pixels."""


def _svg(figure: Canvas, spec: Figure) -> Drawing:
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata=NOTHING[".svg"])
    axes = [one for one in figure.axes if one.get_label() != "<colorbar>"]
    places = [at for one, panel in zip(axes, spec.panels, strict=True) for at in _places(one, panel)]
    return _small(buffer.getvalue())._replace(targets=tuple(places), ways=_ways(axes[0], spec.panels[0]))


def _ways(axes: Axes, panel: Panel) -> tuple[Way, Way]:
    canvas: Any = axes.get_figure(root=True)
    box = axes.get_window_extent().transformed(canvas.transFigure.inverted())

    def way(start: float, end: float, limits: tuple[float, float], axis: Axis) -> Way:
        low, high = (float(one) * axis.size for one in limits)
        return Way(float(start), float(end), low, high, axis.is_log)

    across = way(box.x0, box.x1, axes.get_xlim(), panel.x)
    return across, way(1.0 - box.y0, 1.0 - box.y1, axes.get_ylim(), panel.y)


def _places(axes: Axes, panel: Panel) -> Iterator[tuple[float, float, str]]:
    """Yield where the points with a text of a panel are, thinned evenly where they are many."""
    canvas: Any = axes.get_figure(root=True)
    scale, height = 72.0 / canvas.dpi, canvas.get_size_inches()[1] * 72.0
    for mark in panel.marks:
        if not isinstance(mark, Trace | Cells) or not mark.hover:
            continue
        xs, ys, most, texts = _scaled(mark.x, panel.x), _scaled(mark.y, panel.y), MOST_TARGETS, [*mark.hover]
        if isinstance(mark, Cells):
            xs, ys, most = np.tile(xs, ys.size), np.repeat(ys, xs.size), MOST_CELLS
            texts = [text for row in mark.hover for text in row]
        for x, y, text in [*zip(xs, ys, texts, strict=True)][:: -(-len(texts) // most)]:
            if np.isfinite([x, y]).all() and axes.viewLim.contains(x, y):
                across, up = axes.transData.transform((x, y))
                yield round(across * scale, 2), round(height - up * scale, 2), str(text)


def formula(latex: str) -> Drawing:
    """Return a formula as SVG."""
    buffer = io.BytesIO()
    with ONE_AT_A_TIME, mpl.rc_context({**STYLE, "savefig.transparent": True}):
        math_to_image(f"${latex}$", buffer, prop=FontProperties(size=11), format="svg")
    return _small(buffer.getvalue().decode())


_COMMENT = re.compile(r"<!--.*?-->\s*|<metadata>.*?</metadata>\s*", re.DOTALL)
_LONG = re.compile(r"-?\d+\.\d{3,}(?!\d*e)")
_SIZE = re.compile(r'<svg[^>]*?viewBox="0 0 ([\d.]+) ([\d.]+)"', re.DOTALL)


def _small(text: str) -> Drawing:
    """Return an SVG without comments and header, its paths to a hundredth of a point."""
    text = _COMMENT.sub("", text[text.index("<svg") :])
    text = re.sub(r' d="[^"]*"', lambda path: _LONG.sub(lambda one: f"{float(one[0]):.2f}", path[0]), text)
    size = _SIZE.search(text)
    if size is None:
        raise ValueError("matplotlib's SVG has no viewBox")
    return Drawing(text, float(size[1]), float(size[2]))


def drawn(spec: Figure) -> Canvas:
    """Return the figure, laid out once for all: every format of it is the same."""
    with mpl.rc_context(STYLE):
        return _drawn(spec)


def _drawn(spec: Figure) -> Canvas:
    below = 0.14 * -(-len({one.name for one in spec.named}) // 2)
    height = spec.height * len(spec.rows) + below + LINE * len(spec.heading)
    figure = Canvas(figsize=(PAGE, height), layout="constrained")
    if spec.heading:
        lines = "\n".join(_literal(line) for line in spec.heading)
        figure.suptitle(lines, x=0.008, ha="left", fontsize=7.0, linespacing=1.35)
    parts = figure.subfigures(len(spec.rows), 1, squeeze=False)[:, 0]
    for part, row in zip(parts, spec.rows, strict=True):
        across = part.subplots(1, len(row), squeeze=False)[0]
        for axes, panel in zip(across, row, strict=True):
            draw_panel(axes, panel)
    _legend(figure)
    layout = figure.get_layout_engine()
    for _ in range(2):  # labels beside axes, and axes of equal scales, are known after the first
        if layout is not None:
            layout.execute(figure)
    figure.set_layout_engine(None)
    # the solver's last digits and its sign of 0 differ from call to call, and names hold them
    for subfigure in figure.subfigs:
        subfigure.bbox_relative.set_points(subfigure.bbox_relative.get_points().round(9) + 0.0)
    for axes in figure.axes:
        axes.set_position(Bbox(axes.get_position(original=True).get_points().round(9) + 0.0))
    return figure


def draw_panel(axes: Axes, panel: Panel) -> None:
    """Draw title, marks, axes and labels of a panel."""
    axes.set_title(symbols(panel.title))
    x, y = ("log" if one.is_log else "linear" for one in (panel.x, panel.y))
    axes.set(xscale=x, yscale=y)
    for mark in panel.marks:
        _mark(axes, mark, panel)
    _axis(axes, "x", panel.x)
    _axis(axes, "y", panel.y)
    if panel.is_to_scale:
        is_given = None not in (panel.x.low, panel.y.low)
        axes.set_aspect("equal", adjustable="box" if is_given else "datalim", anchor="N")
    if panel.labels:
        _labels(axes, panel)


def _mark(axes: Axes, mark: Mark, panel: Panel) -> None:
    look: Any
    match mark:
        case Trace():
            _trace(axes, mark, panel)
        case Band():
            low, high = (_scaled(end, panel.y) for end in (mark.low, mark.high))
            look = {"color": mark.colour, "alpha": mark.opacity, "lw": 0, "label": symbols(mark.name) or None}
            axes.fill_between(_scaled(mark.x, panel.x), low, high, **look)
        case Across():
            along = panel.x if mark.axis == "x" else panel.y
            look = {"color": mark.colour, "ls": DASHES[mark.line], "lw": 1.0}
            draw = axes.axvline if mark.axis == "x" else axes.axhline
            draw(mark.at / along.size, **look, label=symbols(mark.name) or None)
        case Cells():
            _cells(axes, mark, panel)
        case Hatched():
            _hatched(axes, mark, panel)


def _axis(axes: Axes, way: Literal["x", "y"], one: Axis) -> None:
    ends = [None if end is None else end / one.size for end in (one.low, one.high)]
    getattr(axes, f"set_{way}label")(symbols(one.label))
    if ends != [None, None]:
        getattr(axes, f"set_{way}lim")(*ends)
    ticks = getattr(axes, f"set_{way}ticks")
    if one.is_log:
        _log_ticks(axes.xaxis if way == "x" else axes.yaxis)
    if one.names:
        axes.tick_params(axis=way, length=0)
        ticks(range(len(one.names)), [_literal(name) for name in one.names])
    if one.ticks:
        ticks([at / one.size for at, _ in one.ticks], [_literal(name) for _, name in one.ticks])
        ticks([], minor=True)


def _log_ticks(axis: Any) -> None:
    """Name 1, 2 and 5 of each decade, without powers, where few decades are shown; of less, even steps."""
    low, high = sorted(axis.get_view_interval())
    if low > 0.0 and high / low < MOST_NAMED:
        few = high / low < LEAST_NAMED
        axis.set_major_locator(
            MaxNLocator(5, steps=[1, 2, 5, 10]) if few else LogLocator(subs=(1.0, 2.0, 5.0))
        )
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("")


def _scaled(values: Numbers, axis: Axis) -> Array:
    absent = [one is None or (axis.is_log and one <= 0.0) for one in values]
    return np.where(absent, np.nan, np.array(values, dtype=float)) / axis.size


def _arrows(axes: Axes, one: Trace, places: Array, starts: Array) -> None:
    """Intervals without an upper end: arrows to the edge of the axis."""
    along_x = one.ends_along == "x"
    edge: Any = axes.get_yaxis_transform() if along_x else axes.get_xaxis_transform()
    look: Any = {"arrowstyle": "->", "color": one.colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
    for place, start in zip(places, starts, strict=True):
        tip, tail = ((1.0, place), (start, place)) if along_x else ((place, 1.0), (place, start))
        axes.annotate("", tip, tail, xycoords=edge, textcoords="data", arrowprops=look, zorder=3)


def _trace(axes: Axes, one: Trace, panel: Panel) -> None:
    x, y = _scaled(one.x, panel.x), _scaled(one.y, panel.y)
    if one.face:
        axes.fill(x, y, facecolor=one.face, lw=0, zorder=2)
    if one.low:
        along = panel.x if one.ends_along == "x" else panel.y
        draw, place = (axes.hlines, y) if one.ends_along == "x" else (axes.vlines, x)
        low, high = _scaled(one.low, along), _scaled(one.high, along)
        endless = np.isfinite(low) & np.isnan(high)
        draw(place, low, np.where(endless, low, high), color=one.colour, lw=1.4, zorder=3)
        _arrows(axes, one, place[endless], low[endless])
    marker = f"${one.marker}$" if one.marker == "*" else one.marker
    look: Any = {"color": one.colour, "ls": DASHES[one.line], "lw": one.width, "marker": marker or None}
    look |= {"alpha": one.opacity, "rasterized": len(x) > MANY, "label": symbols(one.name) or None}
    look |= {"ms": one.size, "mfc": "white" if one.is_open else one.colour}
    if one.has_halo:
        look["path_effects"] = [withStroke(linewidth=one.width + 1.6, foreground="white")]
    axes.plot(x, y, zorder=2 if one.line else 4, clip_on=bool(one.line) or not len(x), **look)


def _cells(axes: Axes, one: Cells, panel: Panel) -> None:
    """Draw a colour for each pair of places, its edges half way to the next place."""
    x, y = (_edges(_scaled(v, a), is_log=a.is_log) for v, a in ((one.x, panel.x), (one.y, panel.y)))
    values = np.array([[np.nan if v is None else v for v in row] for row in one.values], dtype=float)
    mesh = axes.pcolormesh(x, y, values, vmin=one.low, vmax=one.high, cmap=one.colours, rasterized=True)
    bar: Any = axes.figure.colorbar(mesh, ax=axes, label=symbols(one.label))
    bar.outline.set_visible(False)


def _hatched(axes: Axes, one: Hatched, panel: Panel) -> None:
    """Draw a strip for each row of cells side by side, and name them once."""
    x, y = (_edges(_scaled(v, a), is_log=a.is_log) for v, a in ((one.x, panel.x), (one.y, panel.y)))
    corners = []
    for j, row in enumerate(one.where):
        ends = np.flatnonzero(np.diff([0, *map(int, row), 0]))
        for a, b in zip(ends[::2], ends[1::2], strict=True):
            corners.append([(x[a], y[j]), (x[b], y[j]), (x[b], y[j + 1]), (x[a], y[j + 1])])
    if not corners:
        return
    look: Any = {"edgecolor": one.colour, "hatch": one.strokes, "linewidth": 0.0}
    axes.add_collection(PolyCollection(corners, facecolor=one.fill or "none", **look), autolim=False)
    axes.fill_between([], [], facecolor=one.fill or GREY, label=symbols(one.name), **look)


def _edges(places: Array, *, is_log: bool) -> Array:
    at = np.log(places) if is_log else places
    if at.size == 1:
        half = 0.5 * (abs(at[0]) or 1.0)
        edges = np.array([at[0] - half, at[0] + half])
    else:
        inner = 0.5 * (at[1:] + at[:-1])
        edges = np.concatenate([[2 * at[0] - inner[0]], inner, [2 * at[-1] - inner[-1]]])
    return np.exp(edges) if is_log else edges


def _labels(axes: Axes, panel: Panel) -> None:
    """Write labels at the right, apart where they would overlap; one that moved is tied to its place."""
    share = axes.transData - axes.transAxes
    right = axes.get_xlim()[1]
    wanted = [float(share.transform((right, one.y / panel.y.size))[1]) for one in panel.labels]
    places = apart(wanted)
    moved = any(abs(a - b) > 0.0125 for a, b in zip(places, wanted, strict=True))
    gap = 14 if moved or any(one.marker for one in panel.labels) else 5
    aside = offset_copy(axes.transAxes, axes.get_figure(root=True), x=gap, units="points")
    for one, at, place in zip(panel.labels, wanted, places, strict=True):
        if one.marker:
            axes.plot(1.02, at, one.marker, color=one.colour, ms=5, transform=axes.transAxes, clip_on=False)
        look: Any = {"textcoords": aside, "xytext": (1.0, place), "va": "center", "color": one.colour}
        if moved and not one.marker:
            tie = {"arrowstyle": "-", "lw": 0.5, "shrinkA": 1.0, "shrinkB": 0.0, "color": one.colour}
            look["arrowprops"] = {**tie, "relpos": (0.0, 0.5)}
        axes.annotate(symbols(one.text), (1.0, at), **look, **BESIDE)
    if panel.head:
        look = {"textcoords": "offset points", "xytext": (8, 5), "color": GREY}
        axes.annotate(symbols(panel.head), (1, 1), **look, **BESIDE)


def _legend(figure: Canvas) -> None:
    """Name everything in the panels once, below them."""
    handles: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    if handles:
        look: Any = {"loc": "outside lower left", "ncols": 2, "handlelength": 2.4, "columnspacing": 1.5}
        figure.legend(list(handles.values()), list(handles), **look)


def _literal(text: str) -> str:
    """Return a text that is written as it is: matplotlib takes a formula between two dollar signs."""
    return text.replace("$", r"\$")


def symbols(text: str) -> str:
    """Return a text with its symbols as matplotlib's formulas."""
    parts = spans(text)
    return "".join(f"${_formula(part)}$" if kind == "symbol" else _literal(part) for kind, part in parts)


def _formula(symbol: str) -> str:
    stem, _, index = symbol.partition("_")
    inside = SYMBOLS.get(index, rf"\mathrm{{{index}}}" if len(index) > 1 else index)
    return SYMBOLS.get(stem, stem) + (f"_{{{inside}}}" if index else "")
