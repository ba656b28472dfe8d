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
LINES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
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
    names = [one.name for one in _named(spec)]
    keys = KEY * ceil(sum(len(one) + 9 for one in dict.fromkeys(names)) / LINE) + 14 if names else 6
    slot = HEAD + FOOT + INCH * spec.height
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
    for row, panels in enumerate(spec.rows):
        top = 1 - (row + HEAD / slot) / len(spec.rows)
        across = _shares(panels, spec.widths)
        for panel, ends in zip(panels, across, strict=True):
            end = str(n) if (n := len([one for one in layout if one.startswith("xaxis")]) + 1) > 1 else ""
            height = [top - INCH * spec.height / slot / len(spec.rows), top]
            _panel(layout, data, panel, end, known, {"x": ends, "y": height})
    data += [_once(_trace(one, spec.panels[0], ""), one.name, known) for one in spec.legend]
    return {"data": data, "layout": layout}


def _named(spec: Figure) -> list[Any]:
    marks = [one for panel in spec.panels for one in panel.marks]
    return [one for one in (*marks, *spec.legend) if getattr(one, "name", "")]


def _shares(panels: tuple[Panel, ...], widths: tuple[float, ...]) -> Iterator[list[float]]:
    """Yield the ends of each panel of a row, with room for what stands beside it."""
    given = widths if len(widths) == len(panels) else (1.0,) * len(panels)
    at = 0.0
    for place, (panel, width) in enumerate(zip(panels, given, strict=True)):
        share = width / sum(given)
        letters = [len(one.text) + 3 * bool(one.marker) for one in panel.labels]
        beside = 0.01 + LETTER * max(letters, default=0)
        beside += BAR if any(isinstance(one, Cells) for one in panel.marks) else 0.0
        yield [
            at + (ASIDE * share * len(panels) / 2 if place else 0.0),
            at + share - min(beside, 0.6 * share),
        ]
        at += share


def _panel(layout: Json, data: list[Json], panel: Panel, end: str, known: set[str], place: Json) -> None:
    x, y, axes = f"x{end}", f"y{end}", {"xaxis": f"x{end}", "yaxis": f"y{end}"}
    bare = {} if panel.has_frame else {"showgrid": False, "showticklabels": False, "ticks": ""}
    layout[f"xaxis{end}"] = _axis(panel.x, _values(panel, "x")) | {"domain": place["x"], "anchor": y} | bare
    layout[f"yaxis{end}"] = _axis(panel.y, _values(panel, "y")) | {"domain": place["y"], "anchor": x} | bare
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
                layout["annotations"].append(_words(mark.text, mark.colour) | at | SIDES[mark.side])
    layout["annotations"] += _beside(panel, layout[f"yaxis{end}"], place, y)


def _once(found: Json, name: str, known: set[str]) -> Json:
    """Return a trace or a shape that stands in the legend if no other of its name does."""
    is_new = bool(name) and name not in known
    known.add(name)
    return found | {"name": _text(name), "legendgroup": name, "showlegend": is_new}


def _axis(one: Axis, values: list[float]) -> Json:
    grid = {"zeroline": False, "gridcolor": "rgba(128,128,128,0.22)", "linecolor": GREY, "ticks": "outside"}
    found: Json = {"title": {"text": _text(one.label), "standoff": 8}, "type": "linear", **grid}
    if one.is_log:
        found |= {"type": "log", "dtick": "D1" if len({*map(round, map(log10, values))}) < 2 else 1}
    if one.low is not None or one.high is not None:
        ends = [min(values, default=0.0), max(values, default=1.0)]
        given = [own if own is not None else end for own, end in zip((one.low, one.high), ends, strict=True)]
        found["range"] = [_placed(value, one) for value in given]
    if one.ticks:
        found["tickvals"] = [at / one.size for at, _ in one.ticks]
        found["ticktext"] = [_text(name) for _, name in one.ticks]
    if one.most_ticks:
        found["nticks"] = one.most_ticks
    if one.names:
        found |= {"tickvals": [*range(len(one.names))], "ticktext": [*map(_text, one.names)]}
        found |= {"automargin": True, "showgrid": False}
    return found | ({} if one.has_ticks else {"showticklabels": False, "ticks": ""})


def _values(panel: Panel, way: str) -> list[float]:
    """Return every number that a panel shows along an axis [SI]."""
    axis: Axis = getattr(panel, way)
    found: list[float | None] = []
    for mark in panel.marks:
        match mark:
            case Trace() | Cells() | Hatched():
                found += getattr(mark, way)
                found += [*mark.low, *mark.high] if isinstance(mark, Trace) and mark.ends_along == way else []
            case Band():
                found += mark.x if way == "x" else [*mark.low, *mark.high]
            case Across() if mark.axis == way:
                found.append(mark.at)
    return [one for one in found if one is not None and (one > 0.0 or not axis.is_log)]


def _placed(value: float, axis: Axis) -> float:
    """Return a value as ranges and texts have it: its logarithm on an axis of logarithms."""
    return log10(value / axis.size) if axis.is_log else value / axis.size


def _scaled(values: Numbers, axis: Axis) -> list[float | None]:
    return [None if one is None else one / axis.size for one in values]


def _words(text: str, colour: str) -> Json:
    return {"text": _text(text), "showarrow": False, "font": {"size": 12, "color": colour}, "align": "left"}


def _beside(panel: Panel, axis: Json, place: Json, y: str) -> Iterator[Json]:
    """Yield the title above a panel and the labels at its right, apart where they would overlap."""
    fixed: Json = {"showarrow": False, "xref": "paper", "xanchor": "left"}
    above = fixed | {"yref": f"{y} domain", "y": 1.0, "yanchor": "bottom"}
    yield above | {"x": place["x"][0], "text": f"<b>{_text(panel.title)}</b>", "font": {"size": 13}}
    right = fixed | {"x": place["x"][1] + 0.008, "yref": f"{y} domain", "yanchor": "middle"}
    if panel.head:
        yield (
            right | above | {"x": right["x"], "text": _text(panel.head), "font": {"size": 11, "color": GREY}}
        )
    if not panel.labels:
        return
    values = [_placed(one, panel.y) for one in _values(panel, "y")]
    room = 0.06 * (max(values) - min(values) or 1.0)
    low, high = axis.setdefault("range", [min(values) - room, max(values) + room])
    wanted = [(_placed(one.y, panel.y) - low) / (high - low or 1.0) for one in panel.labels]
    for one, at in zip(panel.labels, apart(wanted, 0.075), strict=True):
        sign = "\N{BLACK CIRCLE} " if one.marker else ""
        yield right | {"y": at, "text": sign + _text(one.text), "font": {"size": 12, "color": one.colour}}


def _trace(one: Trace, panel: Panel, end: str) -> Json:
    x, y = _scaled(one.x, panel.x) or [None], _scaled(one.y, panel.y) or [None]
    mode = "+".join(["lines"] * bool(one.line) + ["markers"] * bool(one.marker)) or "none"
    found: Json = {"x": x, "y": y, "mode": mode, "xaxis": f"x{end}", "yaxis": f"y{end}"}
    found["line"] = {"color": one.colour, "width": 1.4 * one.width, "dash": LINES.get(one.line, "solid")}
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
        ends = _scaled(one.low, axis), _scaled(one.high, axis)
        look = {"type": "data", "symmetric": False, "color": one.colour, "thickness": 1.6, "width": 0}
        found[f"error_{way}"] = look | {
            "array": [*map(_less, ends[1], found[way])],
            "arrayminus": [*map(_less, found[way], ends[0])],
        }
    return found


def _template(panel: Panel) -> str:
    """Return what the pointer shows of a point without a text of its own: both values with their labels."""
    labels = (_text(one.label).replace("{", "(").replace("}", ")") for one in (panel.x, panel.y))
    return "<br>".join(f"{label}: %{{{way}:.4~g}}" for way, label in zip("xy", labels, strict=True))


def _less(a: float | None, b: float | None) -> float | None:
    return None if a is None or b is None else a - b


def _band(one: Band, panel: Panel) -> Iterator[Json]:
    edge: Json = {"x": _scaled(one.x, panel.x), "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip"}
    yield edge | {"y": _scaled(one.low, panel.y)}
    inside = {"fill": "tonexty", "fillcolor": _faint(one.colour, one.opacity)}
    yield edge | {"y": _scaled(one.high, panel.y), "of": one.name} | inside


def _across(one: Across, panel: Panel, x: str, y: str) -> Json:
    """Return a line over a whole panel, with its name in the legend."""
    way, other = ("x", "y") if one.axis == "x" else ("y", "x")
    at = one.at / getattr(panel, way).size
    refs = {"xref": x, "yref": y} | {f"{other}ref": f"{y if way == 'x' else x} domain"}
    line = {"color": one.colour, "width": 1.6, "dash": LINES.get(one.line, "solid")}
    return {
        "type": "line",
        **refs,
        f"{way}0": at,
        f"{way}1": at,
        f"{other}0": 0,
        f"{other}1": 1,
        "line": line,
    }


def _hatched(one: Hatched, panel: Panel) -> Json:
    """Return cells with a thin veil: Plotly has no strokes there."""
    veil = one.fill or one.colour
    found: Json = {"type": "heatmap", "x": _scaled(one.x, panel.x), "y": _scaled(one.y, panel.y)}
    found["z"] = [[1 if is_one else None for is_one in row] for row in one.where]
    return found | {
        "colorscale": [[0, veil], [1, veil]],
        "showscale": False,
        "opacity": 0.4,
        "hoverinfo": "skip",
    }


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
