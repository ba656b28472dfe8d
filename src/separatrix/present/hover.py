"""The same figure to point at: its spec as Plotly's data and layout, for pages that a server sends."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, log10
from typing import Any

import matplotlib as mpl
from matplotlib.colors import to_hex

from separatrix.present.figure import (
    GREY,
    Across,
    Axis,
    Band,
    Cells,
    Figure,
    Hatched,
    Numbers,
    Panel,
    Trace,
    Words,
    apart,
)
from separatrix.present.html import inline

Json = dict[str, Any]

SIGNS = {"o": "circle", "s": "square", "^": "triangle-up", "v": "triangle-down", "X": "x", "D": "diamond"}
SIGNS |= {"x": "x-thin-open", "P": "cross", "*": "star", "p": "pentagon", "+": "cross-thin-open"}
SIGNS |= {"|": "line-ns-open", "_": "line-ew-open", ".": "circle"}
LINES = {"": "solid", "-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
SIDES: dict[str, Json] = {
    "right": {"xanchor": "left", "xshift": 5, "yanchor": "middle"},
    "left": {"xanchor": "right", "xshift": -5, "yanchor": "middle"},
    "above": {"xanchor": "center", "yanchor": "bottom", "yshift": 5},
    "below": {"xanchor": "center", "yanchor": "top", "yshift": -5},
    "on": {"xanchor": "center", "yanchor": "middle"},
}
INCH, HEAD, FOOT, KEY, LINE = 100, 26, 56, 21, 120
"""Pixels of an inch of the spec, above a panel, below it, of a line of the legend; and its letters."""

LETTER, BAR, ASIDE = 0.0085, 0.09, 0.13
"""Shares of the width: a letter beside a panel, a bar of colours, before a panel that has a neighbour."""


def plotly(spec: Figure) -> Json:
    """Return data and layout of a figure; colours of text and paper are the page's.

    `meta` has, for each panel, the sizes of the units of its axes: what a reader points at times these is
    in SI.
    """
    names = dict.fromkeys(one.name for one in spec.named)
    keys = KEY * ceil(sum(len(one) + 9 for one in names) / LINE) + 14 if names else 6
    inside, slot = INCH * spec.height, HEAD + FOOT + INCH * spec.height
    layout: Json = {
        "hovermode": "closest",
        "height": slot * len(spec.rows) + keys,
        "margin": {"l": 76, "r": 8, "t": 4, "b": keys},
        "legend": {"orientation": "h", "x": 0, "y": 0, "yanchor": "top", "font": {"size": 12}},
        "annotations": [],
        "shapes": [],
        "meta": [[panel.x.size, panel.y.size] for panel in spec.panels],
    }
    data: list[Json] = []
    known: set[str] = set()
    ends = iter(["", *map(str, range(2, len(spec.panels) + 1))])
    for row, panels in enumerate(spec.rows):
        top = 1 - (row + HEAD / slot) / len(spec.rows)
        height = [top - inside / slot / len(spec.rows), top]
        for panel, across in zip(panels, _shares(panels, spec.widths), strict=True):
            _panel(layout, data, panel, next(ends), known, {"x": across, "y": height})
    data += [_once(_trace(one, spec.panels[0], ""), one.name, known) for one in spec.legend]
    return {"data": data, "layout": layout}


def _shares(panels: tuple[Panel, ...], widths: tuple[float, ...]) -> Iterator[list[float]]:
    """Yield the ends of each panel of a row, with room for what stands beside it."""
    given, at = widths if len(widths) == len(panels) else (1.0,) * len(panels), 0.0
    for panel, width in zip(panels, given, strict=True):
        share = width / sum(given)
        beside = 0.01 + LETTER * max(
            (len(one.text) + 3 * bool(one.marker) for one in panel.labels), default=0
        )
        beside += BAR if any(isinstance(one, Cells) for one in panel.marks) else 0.0
        before = ASIDE * share * len(panels) / 2 if at else 0.0
        yield [at + before, at + share - min(beside, 0.6 * share)]
        at += share


def _panel(layout: Json, data: list[Json], panel: Panel, end: str, known: set[str], place: Json) -> None:
    x, y, axes = f"x{end}", f"y{end}", {"xaxis": f"x{end}", "yaxis": f"y{end}"}
    bare = {} if panel.has_frame else {"showgrid": False, "showticklabels": False, "ticks": ""}
    layout[f"xaxis{end}"] = _axis(panel.x) | {"domain": place["x"], "anchor": y} | bare
    layout[f"yaxis{end}"] = _axis(panel.y) | {"domain": place["y"], "anchor": x} | bare
    if panel.is_to_scale:
        layout[f"yaxis{end}"] |= {"scaleanchor": x}
        layout[f"xaxis{end}"].pop("range", None)
    for mark in panel.marks:
        match mark:
            case Trace():
                data.append(_once(_trace(mark, panel, end), mark.name, known))
            case Band():
                data += [_once(one | axes, one.pop("of", ""), known) for one in _band(mark, panel)]
            case Cells():
                data.append(_cells(mark, panel, place) | axes)
            case Hatched():
                data.append(_once(_hatched(mark, panel) | axes, mark.name, known))
            case Across():
                layout["shapes"].append(_once(_across(mark, panel, x, y), mark.name, known))
            case Words():
                at = {"x": _placed(mark.x, panel.x), "y": _placed(mark.y, panel.y), "xref": x, "yref": y}
                font = {"size": 12, "color": mark.colour}
                words = {"text": _text(mark.text), "showarrow": False, "font": font, "align": "left"}
                layout["annotations"].append(words | at | SIDES[mark.side])
    layout["annotations"] += _beside(panel, layout[f"yaxis{end}"], place, y)


def _once(found: Json, name: str, known: set[str]) -> Json:
    """Return a trace or a shape that stands in the legend if no other of its name does."""
    is_new = bool(name) and name not in known
    known.add(name)
    return found | {"name": _text(name), "legendgroup": name, "showlegend": is_new}


def _axis(one: Axis) -> Json:
    grid = {"zeroline": False, "gridcolor": "rgba(128,128,128,0.22)", "linecolor": GREY, "ticks": "outside"}
    found: Json = {"title": {"text": _text(one.label), "standoff": 8}, **grid}
    found["type"] = "log" if one.is_log else "linear"
    if one.low is not None or one.high is not None:
        found["range"] = [None if end is None else _placed(end, one) for end in (one.low, one.high)]
    ticks = [(at / one.size, name) for at, name in one.ticks] or [*enumerate(one.names)]
    if ticks:
        found |= {"tickvals": [at for at, _ in ticks], "ticktext": [_text(name) for _, name in ticks]}
    if one.names:
        found |= {"automargin": True, "showgrid": False}
    if one.most_ticks:
        found["nticks"] = one.most_ticks
    return found | ({} if one.has_ticks else {"showticklabels": False, "ticks": ""})


def _placed(value: float, axis: Axis) -> float:
    """Return a value as ranges and texts have it: its logarithm on an axis of logarithms."""
    return log10(value / axis.size) if axis.is_log else value / axis.size


def _scaled(values: Numbers, axis: Axis) -> list[float | None]:
    return [None if one is None else one / axis.size for one in values]


def _beside(panel: Panel, axis: Json, place: Json, y: str) -> Iterator[Json]:
    """Yield the title above a panel and the labels at its right, apart where they would overlap."""
    fixed: Json = {"showarrow": False, "xref": "paper", "xanchor": "left", "yref": f"{y} domain"}
    above, right = fixed | {"y": 1.0, "yanchor": "bottom"}, place["x"][1] + 0.008
    yield above | {"x": place["x"][0], "text": f"<b>{_text(panel.title)}</b>", "font": {"size": 13}}
    if panel.head:
        yield above | {"x": right, "text": _text(panel.head), "font": {"size": 11, "color": GREY}}
    if not panel.labels:
        return
    low, high = axis["range"]
    wanted = [(_placed(one.y, panel.y) - low) / (high - low or 1.0) for one in panel.labels]
    for one, at in zip(panel.labels, apart(wanted, 0.075), strict=True):
        look: Json = {"yanchor": "middle", "font": {"size": 12, "color": one.colour}}
        sign = "\N{BLACK CIRCLE} " if one.marker else ""
        yield fixed | look | {"x": right, "y": at, "text": sign + _text(one.text)}


def _trace(one: Trace, panel: Panel, end: str) -> Json:
    x, y = _scaled(one.x, panel.x) or [None], _scaled(one.y, panel.y) or [None]
    mode = "+".join(["lines"] * bool(one.line) + ["markers"] * bool(one.marker)) or "none"
    found: Json = {"x": x, "y": y, "mode": mode, "xaxis": f"x{end}", "yaxis": f"y{end}"}
    found["line"] = {"color": one.colour, "width": 1.4 * one.width, "dash": LINES[one.line]}
    if one.marker:
        sign, inside, edge = SIGNS.get(one.marker, "circle"), one.colour, one.colour
        if one.has_halo:  # above colours
            inside, edge = ("#ffffff", one.colour) if one.is_open else (one.colour, "#ffffff")
        elif one.is_open and not sign.endswith("-open"):
            sign += "-open"
        width = 1.6 if one.has_halo or sign.endswith("-open") else 0
        found["marker"] = {"color": inside, "size": 2.0 * one.size, "symbol": sign, "opacity": 1}
        found["marker"]["line"] = {"color": edge, "width": width}
    if one.fill or one.face:
        found |= {"fill": "toself", "fillcolor": one.face or _faint(one.colour, one.fill)}
    if one.hover:
        found |= {"text": [_text(text).replace("; ", "<br>") for text in one.hover], "hoverinfo": "text"}
    else:
        found["hovertemplate"] = _template(panel)
    if one.low:
        way, axis = one.ends_along, panel.x if one.ends_along == "x" else panel.y
        look = {"type": "data", "symmetric": False, "color": one.colour, "thickness": 1.6, "width": 0}
        for key, ends, sense in (("array", one.high, 1), ("arrayminus", one.low, -1)):
            pairs = zip(_scaled(ends, axis), found[way], strict=True)
            look[key] = [None if a is None or b is None else sense * (a - b) for a, b in pairs]
        found[f"error_{way}"] = look
    return found


def _template(panel: Panel) -> str:
    """Return what the pointer shows of a point without a text of its own: both values with their labels."""
    labels = (_text(one.label).replace("{", "(").replace("}", ")") for one in (panel.x, panel.y))
    return "<br>".join(f"{label}: %{{{way}:.4~g}}" for way, label in zip("xy", labels, strict=True))


def _band(one: Band, panel: Panel) -> Iterator[Json]:
    edge: Json = {"x": _scaled(one.x, panel.x), "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip"}
    yield edge | {"y": _scaled(one.low, panel.y)}
    inside = {"fill": "tonexty", "fillcolor": _faint(one.colour, one.opacity)}
    yield edge | {"y": _scaled(one.high, panel.y), "of": one.name} | inside


def _across(one: Across, panel: Panel, x: str, y: str) -> Json:
    """Return a line over a whole panel, with its name in the legend."""
    at = one.at / getattr(panel, one.axis).size
    ends = {"x0": at, "x1": at, "y0": 0, "y1": 1, "xref": x, "yref": f"{y} domain"}
    if one.axis == "y":
        ends = {"y0": at, "y1": at, "x0": 0, "x1": 1, "yref": y, "xref": f"{x} domain"}
    return {"type": "line", "line": {"color": one.colour, "width": 1.6, "dash": LINES[one.line]}, **ends}


def _hatched(one: Hatched, panel: Panel) -> Json:
    """Return cells with a thin veil: Plotly has no strokes there."""
    found: Json = {"type": "heatmap", "x": _scaled(one.x, panel.x), "y": _scaled(one.y, panel.y)}
    found |= {"z": [[1 if is_one else None for is_one in row] for row in one.where], "showscale": False}
    shades = [[end, one.fill or one.colour] for end in (0, 1)]
    return found | {"colorscale": shades, "opacity": 0.4, "hoverinfo": "skip"}


def _cells(one: Cells, panel: Panel, place: Json) -> Json:
    shades = [[i / 10, to_hex(mpl.colormaps[one.colours](i / 10))] for i in range(11)]
    bar = {"x": place["x"][1] + 0.01, "y": place["y"][0], "yanchor": "bottom", "thickness": 12}
    bar |= {"len": place["y"][1] - place["y"][0], "title": {"text": _text(one.label), "side": "right"}}
    found: Json = {"type": "heatmap", "x": _scaled(one.x, panel.x), "y": _scaled(one.y, panel.y)}
    found |= {"z": [[*row] for row in one.values], "colorscale": shades, "colorbar": bar}
    found |= {"zmin": one.low, "zmax": one.high} if one.low is not None and one.high is not None else {}
    if one.hover:
        texts = [[_text(text).replace("; ", "<br>") for text in row] for row in one.hover]
        return found | {"text": texts, "hoverinfo": "text"}
    return found | {"hovertemplate": f"{_template(panel)}<br>{_text(one.label)}: %{{z:.4~g}}<extra></extra>"}


def _faint(colour: str, opacity: float) -> str:
    return "rgba({},{},{},{})".format(*(int(colour[i : i + 2], 16) for i in (1, 3, 5)), opacity)


def _text(text: str) -> str:
    """Return a text that Plotly shows as it is, its symbols as letters with an index."""
    return inline(text, has_code=False).replace("&quot;", '"').replace("&#x27;", "'")
