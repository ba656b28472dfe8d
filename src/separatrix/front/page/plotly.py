"""Figures to hover over: the series of `figures.hover` as Plotly draws them."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

from separatrix.figures.hover import Plot, Series, plain

Spec = dict[str, Any]
"""Data and layout of a figure of Plotly, as JSON has it."""

GRID = "rgba(128,128,128,0.25)"
COLOURS = [[0.0, "#0072B2"], [0.5, "#f0f0f0"], [1.0, "#D55E00"]]
"""Of the share of runs that whirl: the palette of the printed figures."""

LINE = 80
"""Letters of a line of the words under the pointer."""

GAP, WIDE_GAP = 0.15, 0.35
"""Share of its height that is left free below a panel; with the label of an x axis there."""


def spec(*plots: Plot) -> Spec:
    """Return the figure of a plot, or of several one below the other: over one x axis if they have one label.

    Colours of text and paper are set by the page, light or dark.
    """
    first, count = plots[0], len(plots)
    own_x = len({plot.x_label for plot in plots}) > 1
    layout: Spec = {
        "title": {"text": _plain(first.title), "font": {"size": 15}, "x": 0.01, "xanchor": "left"},
        "xaxis": _axis(first.x_label, is_log=first.x_log) | {"anchor": f"y{count}" if count > 1 else "y"},
        "hovermode": "closest",
        "margin": {"l": 70, "r": 20, "t": 50, "b": 55},
        "legend": {"orientation": "h", "y": -0.22, "font": {"size": 11}},
        "shapes": [],
    }
    data: list[Spec] = []
    for place, plot in enumerate(plots, start=1):
        number = str(place) if place > 1 else ""  # Plotly counts so
        layout[f"yaxis{number}"] = axis = _axis(plot.y_label, is_log=plot.y_log)
        if count > 1:
            top, foot = 1.0 - (place - 1) / count, 1.0 - (place - (WIDE_GAP if own_x else GAP)) / count
            axis["domain"] = [foot if place < count else 0.0, top]
            layout[f"legend{number}"] = {"x": 1.01, "y": top, "yanchor": "top", "font": {"size": 11}}
        if own_x:
            layout[f"xaxis{number}"] = _axis(plot.x_label, is_log=plot.x_log) | {"anchor": f"y{number}"}
            axis["anchor"] = f"x{number}"
        if plot.y_names:
            names = [_plain(name) for name in plot.y_names]
            axis |= {"tickvals": [*range(len(names))], "ticktext": names, "automargin": True}
        for one in plot.series:
            if one.kind == "upright":
                line = {"color": one.colour, "width": 1.5, "dash": "dash"}
                label = {"text": _plain(one.name), "textangle": -90, "font": {"size": 11}}
                label |= {"textposition": "end", "yanchor": "top"}
                layout["shapes"].append({"type": "line", "line": line, "label": label, **upright(one.x[0])})
            own = {"yaxis": f"y{number}", "legend": f"legend{number}"}
            own |= {"xaxis": f"x{number}"} if own_x else {}
            data += [trace | own for trace in _traces(one, across=bool(plot.y_names))]
    return {"data": data, "layout": layout}


def _axis(label: str, *, is_log: bool) -> Spec:
    kind = {"type": "log"} if is_log else {}
    return {"title": {"text": _plain(label)}, "gridcolor": GRID, "zeroline": False, **kind}


def _plain(text: str) -> str:
    """Return a text that Plotly shows as it is: it would take some tags, and has no formulas."""
    return plain(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _traces(one: Series, *, across: bool) -> Iterator[Spec]:
    """Yield the traces of a series; intervals lie along x where places are names."""
    base: Spec = {"name": _plain(one.name), "x": one.x, "y": one.y}
    base |= (
        {"text": ["<br>".join(textwrap.wrap(_plain(text), LINE)) for text in one.text], "hoverinfo": "text"}
        if one.text
        else {"hoverinfo": "name"}
    )
    if one.kind == "cells":
        yield base | {
            "type": "heatmap",
            "z": one.value,
            "colorscale": COLOURS,
            "zmin": 0,
            "zmax": 1,
            "colorbar": {"title": {"text": _plain(one.name), "side": "right"}, "thickness": 12},
        }
    elif one.kind == "band":
        edge = {"mode": "lines", "line": {"width": 0}, "hoverinfo": "skip", "x": one.x}
        red, green, blue = (int(one.colour[i : i + 2], 16) for i in (1, 3, 5))
        faint = f"rgba({red},{green},{blue},0.18)"
        yield edge | {"y": one.low, "showlegend": False}
        yield edge | {"y": one.high, "fill": "tonexty", "name": base["name"], "fillcolor": faint}
    elif one.kind == "line":
        yield base | {"mode": "lines", "line": {"color": one.colour, "width": 2}} | _interval(one, across)
    elif one.kind == "bars":
        yield base | {"type": "bar", "textposition": "none", "marker": {"color": one.colour}}
    elif one.kind == "points":
        look = {"color": one.colour, "size": 10, "line": {"width": 1, "color": "white"}}
        yield base | {"mode": "markers", "marker": look} | _interval(one, across)


def _interval(one: Series, across: bool) -> Spec:
    if not one.low or not one.high:
        return {}
    values = one.x if across else one.y
    bars = {
        "type": "data",
        "symmetric": False,
        "array": [_less(h, v) for h, v in zip(one.high, values, strict=True)],
        "arrayminus": [_less(v, low) for low, v in zip(one.low, values, strict=True)],
        "color": one.colour,
        "thickness": 1,
        "width": 3,
    }
    return {"error_x" if across else "error_y": bars}


def _less(a: float | None, b: float | None) -> float | None:
    return None if a is None or b is None else a - b


def upright(at: object) -> Spec:
    """Return the ends of a line over the whole height of a figure."""
    return {"x0": at, "x1": at, "y0": 0, "y1": 1, "yref": "paper"}
