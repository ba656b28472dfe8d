"""One run of a cage in space as a page to turn and play: one file, that needs no network."""

from __future__ import annotations

import html
import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from separatrix.figures.animation import frame_moments, shown_parts
from separatrix.figures.scene import turned_by
from separatrix.figures.simulation import is_logarithmic
from separatrix.figures.space_scene import AROUND, RIM, space_scene
from separatrix.figures.style import heading
from separatrix.units import Array

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames of a page, and most numbers in all: they keep it under 1 MB."""

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""


def write_page(data: xr.Dataset, path: Path) -> None:
    """Write a saved run of a cage in space as an HTML page that plays it."""
    path.write_text(page(data), encoding="utf-8")


def page(data: xr.Dataset) -> str:
    """Return the page as text; words of the study are escaped."""
    template = files("separatrix.figures").joinpath("space_page.html").read_text(encoding="utf-8")
    title = str(data.attrs.get("title", "")) or "A cage in space"
    # a text of the study may hold any mark: the JSON stands in a script, the title in the head
    found = json.dumps(run_for_page(data), allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    before, after = template.split("@DATA@")
    return before.replace("@TITLE@", html.escape(title)) + found + after


def run_for_page(data: xr.Dataset) -> dict[str, Any]:
    """Return what the page draws as plain data."""
    most = int(min(MOST_FRAMES, MOST_NUMBERS // (8 + 3 * data.sizes["ball"])))
    moments = frame_moments(data, max(2, most))
    at, lines = space_scene(data, moments), heading(data)
    spans = " and ".join(f"{first:.4g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    largest = at.largest_force or 1.0
    return {
        "title": str(data.attrs.get("title", "")),
        "about": "\n".join(lines[1:]),
        "shown": f"Frames show {spans}{', on logarithmic time' if is_logarithmic(data) else ''}.",
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


def _whole(values: Array) -> list[int]:
    return [int(one) for one in np.rint(values).ravel()]
