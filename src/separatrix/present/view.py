"""One run of a cage as a page to turn and play: true shapes, small movements enlarged."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

from separatrix.ground.units import Array, format_number, format_quantity

WHERE = ("in the pocket (balls: white to red)", "on the land (grey to red)")

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""

RIM = 0.88
"""Largest size of a pocket along the axis over the cage's width."""

POCKET_POINTS, BAR_POINTS = 24, 6
"""Points around a pocket; pieces of a bar between two pockets, in the plane of the balls."""

VIEWS = ((0.5 * np.pi, 0.0), tuple(np.deg2rad([28.0, -62.0])))
"""Height of the eye over the plane of the bearing, and angle around it [rad]: in the plane, in space."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """Sizes [m], and movements at each moment, true, in the frame of the ball set."""

    radius: float  # of the pitch circle
    ball: float  # radius
    half_width: float  # of the cage
    half_thickness: float  # of the cage
    angles: Array  # of each pocket [rad]
    plays: Array  # half the clearance of each pocket along the orbit
    axial_play: float  # half the clearance of a pocket along the axis
    is_square: bool  # whether pockets have corners
    land: float  # radius of the surface of the cage at the land
    side: int  # 1 for a land outside the cage, -1 inside, 0 without one
    heights: tuple[float, ...]  # of the lands over the pockets
    gap: float  # radial clearance of the lands
    in_space: bool  # whether the cage tilts and moves along the axis
    time: Array  # of each moment [s]
    parts: tuple[tuple[float, float], ...]  # beginning and end of each part of the run that is shown [s]
    turned: Array  # angle by which the ball set has turned, shape (time,) [rad]
    centre: Array  # shape (time, 2)
    lean: Array  # shape (time, 2) [rad]
    axial: Array  # shape (time,)
    rotation: Array  # shape (time,) [rad]
    lead: Array  # of each ball, shape (time, ball)
    ball_axial: Array  # shape (time, ball)
    force: Array  # largest of each ball since the moment before, shape (time, ball) [N]
    land_force: Array  # the same of the lands, shape (time,) [N]
    largest: tuple[float, float]  # forces of a pocket and of the lands, of all samples of the run [N]
    enlarged: float  # factor by which movements and clearances are drawn too large at first


def page(heading: Sequence[str], at: Scene) -> str:
    """Return a page that needs no other file; its heading is a title and lines below it, all escaped."""
    title, *about = heading
    # a text of the study may hold any mark: the JSON is inside a script
    found = json.dumps(_plain(at), allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    forces = [f"0 to {format_number(one, 3)} N {where}" for one, where in zip(at.largest, WHERE, strict=True)]
    shown = ", ".join(forces[: 1 + (at.largest[1] > 0.0)])
    spans = " and ".join(" to ".join(format_quantity(end, "s") for end in part) for part in at.parts)
    parts = {
        "TITLE": html.escape(title),
        "ABOUT": html.escape("\n".join(about)),
        "MOST": f"{shown}; root scale, the largest since the frame before",
        "SHOWN": f"Frames show {spans}.",
        "DATA": found,
        "STYLE": _static("cage.css"),
        "SCRIPT": _static("cage.js"),
    }
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], _static("cage.html"))  # no mark inside a part


def _static(name: str) -> str:
    return files("separatrix.present").joinpath("static", name).read_text(encoding="utf-8")


def _plain(at: Scene) -> dict[str, object]:
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
        "view": list(VIEWS[at.in_space]),
        "enlarged": at.enlarged,
        "around": POCKET_POINTS,
        "barPoints": BAR_POINTS,
        "rim": RIM,
        "most": most,
        "time": [float(f"{one:.7g}") for one in at.time],
        "turned": [round(float(one), 4) for one in np.mod(at.turned, 2.0 * np.pi)],
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
