"""One run of the cage as a page to turn and play."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from separatrix.figures.motion import frame_moments, shown_parts
from separatrix.figures.scene import BAR_POINTS, POCKET_POINTS, RIM, Scene, scene, turned_by
from separatrix.figures.style import WIDTH, cut, heading
from separatrix.units import Array, format_number

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames of a page, and most numbers in all: they keep it under 1 MB."""

PARTS = Path(__file__).with_name("cage_view")
"""Folder of style, script and templates of pages that show a run."""

WHERE = ("in the pocket (balls: white to red)", "on the land (grey to red)")

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""


def write_page(data: xr.Dataset, path: Path) -> None:
    """Write a saved run as an HTML page that plays it."""
    path.write_text(page(data), encoding="utf-8")


def page(data: xr.Dataset) -> str:
    """Return the page as text; words of the study are escaped."""
    parts = {
        "TITLE": html.escape(str(data.attrs.get("title", "")) or "The moving cage"),
        "STYLE": _text(PARTS / "view.css"),
        "VIEW": view(data),
        "SCRIPT": _text(PARTS / "view.js"),
    }
    return _filled(_text(PARTS / "page.html"), parts)


def view(data: xr.Dataset) -> str:
    """Return the part of a page that shows the run, with its data; it needs style and script of the page."""
    most = int(min(MOST_FRAMES, MOST_NUMBERS // (9 + 3 * data.sizes["ball"])))
    moments = frame_moments(data, max(2, most))
    at = scene(data, moments)
    forces = [f"0 to {format_number(one, 3)} N {where}" for one, where in zip(at.largest, WHERE, strict=True)]
    spans = " and ".join(f"{first:.4g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    title = cut(str(data.attrs.get("title", "")), WIDTH)
    # a text of the study may hold any mark: the JSON is inside a script
    found = json.dumps(run_for_page(data, moments, at), allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    parts = {
        "ABOUT": html.escape("\n".join(heading(data)[len(title) :])),
        "MOST": ", ".join(forces[: 1 + (at.largest[1] > 0.0)]),
        "SHOWN": f"Frames show {spans}.",
        "DATA": found,
    }
    return _filled(_text(PARTS / "view.html"), parts)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _filled(template: str, parts: Mapping[str, str]) -> str:
    """Return a template with its marks replaced; the replacements are not searched again."""
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], template)


def run_for_page(data: xr.Dataset, moments: Array, at: Scene) -> dict[str, object]:
    """Return what the page draws as plain data; what only a cage in space has is null in the plane."""
    most = [one or 1.0 for one in at.largest]
    return {
        "radius": at.radius,
        "ball": at.ball,
        "halfWidth": at.half_width,
        "halfThickness": at.half_thickness,
        "angles": at.angles.tolist(),
        "plays": at.plays.tolist(),
        "axialPlay": at.axial_play,
        "square": at.is_square,
        "land": at.land,
        "side": at.side,
        "heights": list(at.heights),
        "gap": at.gap,
        "view": list(at.view),
        "enlarged": at.enlarged,
        "around": POCKET_POINTS,
        "barPoints": BAR_POINTS,
        "rim": RIM,
        "most": most,
        "time": [float(f"{one:.7g}") for one in data["time"].values[moments]],
        "turned": [round(float(one), 4) for one in np.mod(turned_by(data)[moments], 2.0 * np.pi)],
        "centre": _whole(NANO * at.centre),
        "lean": _whole(NANO * at.lean) if at.in_space else None,
        "axial": _whole(NANO * at.axial) if at.in_space else None,
        "rotation": _whole(NANO * at.rotation),
        "lead": _whole(NANO * at.lead),
        "ballAxial": _whole(NANO * at.ball_axial) if at.in_space else None,
        "force": _whole(255.0 * at.force / most[0]),
        "landForce": _whole(255.0 * at.land_force / most[1]),
    }


def _whole(values: Array) -> list[int]:
    return [int(one) for one in np.rint(values).ravel()]
