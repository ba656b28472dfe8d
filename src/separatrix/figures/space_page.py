"""One run of a cage in space to turn and play: as one file that needs no network, and in the local page."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from separatrix.figures.animation import frame_moments, shown_parts
from separatrix.figures.scene import turned_by
from separatrix.figures.simulation import is_logarithmic
from separatrix.figures.space_scene import AROUND, RIM, space_scene
from separatrix.figures.style import WIDTH, cut, heading
from separatrix.units import Array

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames of a page, and most numbers in all: they keep it under 1 MB."""

VIEW = Path(__file__).with_name("space_view")
"""Folder of what every page that shows a run has, and of the page that has nothing else."""

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""


def write_page(data: xr.Dataset, path: Path) -> None:
    """Write a saved run of a cage in space as an HTML page that plays it."""
    path.write_text(page(data), encoding="utf-8")


def page(data: xr.Dataset) -> str:
    """Return the page as text; words of the study are escaped."""
    parts = {
        "TITLE": html.escape(str(data.attrs.get("title", "")) or "A cage in space"),
        "STYLE": _text(VIEW / "view.css"),
        "VIEW": view(data),
        "SCRIPT": _text(VIEW / "view.js"),
    }
    return _filled(_text(VIEW / "page.html"), parts)


def view(data: xr.Dataset) -> str:
    """Return the part of a page that shows the run, with its data; it needs style and script of `VIEW`."""
    most = int(min(MOST_FRAMES, MOST_NUMBERS // (8 + 3 * data.sizes["ball"])))
    moments = frame_moments(data, max(2, most))
    run = run_for_page(data, moments)
    spans = " and ".join(f"{first:.4g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    title = cut(str(data.attrs.get("title", "")), WIDTH)
    # a text of the study may hold any mark: the JSON stands in a script
    found = json.dumps(run, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    parts = {
        "ABOUT": html.escape("\n".join(heading(data)[len(title) :])),
        "MOST": f"{run['most']:.3g}",
        "SHOWN": f"Frames show {spans}{', on logarithmic time' if is_logarithmic(data) else ''}.",
        "DATA": found,
    }
    return _filled(_text(VIEW / "view.html"), parts)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def _filled(template: str, parts: Mapping[str, str]) -> str:
    """Return a template with its marks replaced; what stands in their place is not searched again."""
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], template)


def run_for_page(data: xr.Dataset, moments: Array) -> dict[str, Any]:
    """Return what the page draws as plain data."""
    at = space_scene(data, moments)
    largest = at.largest_force or 1.0
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
        "enlarged": at.enlarged,
        "around": AROUND,
        "rim": RIM,
        "most": largest,
        "time": [float(f"{one:.7g}") for one in data["time"].values[moments]],
        "turned": [round(float(one), 4) for one in np.mod(turned_by(data)[moments], 2.0 * np.pi)],
        "centre": _whole(NANO * at.centre),
        "lean": _whole(NANO * at.lean),
        "axial": _whole(NANO * at.axial),
        "rotation": _whole(NANO * at.rotation),
        "lead": _whole(NANO * at.lead),
        "ballAxial": _whole(NANO * at.ball_axial),
        "force": _whole(255.0 * at.force / largest),
    }


def _whole(values: Array) -> Any:
    return np.rint(values).astype(int).ravel().tolist()
