"""One run of the cage as a page to turn and play: true shapes, small movements enlarged."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from separatrix.figures.motion import (
    axial_play,
    frame_moments,
    is_in_space,
    land_boundary,
    land_heights,
    shown_parts,
)
from separatrix.figures.style import WIDTH, cut, heading, stated, study_of
from separatrix.ground.units import Array, format_number

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames of a page, and most numbers in all: they keep it under 1 MB."""

PARTS = Path(__file__).with_name("cage_view")
"""Folder of style, script and templates of pages that show a run."""

WHERE = ("in the pocket (balls: white to red)", "on the land (grey to red)")

NANO = 1e9
"""Movements are whole nanometres and nanoradians; forces 1/255 of the largest."""

BAR_SHARE, FARTHEST = 0.4, 0.25
"""Least share of the bar in the room between two balls; largest movement drawn over the pitch radius."""

THICK, WIDE, RIM = 0.28, 1.35, 0.88
"""Half the radial thickness of the cage over the ball's diameter; its width over that, if it is not stated;
largest size of a pocket along the axis over the cage's width."""

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


def scene(data: xr.Dataset, moments: Array) -> Scene:
    """Return sizes and movements of a run at some samples.

    Movements are enlarged so that a wall touches its ball when it does so: as much as leaves a bar between
    two pockets, the pockets within the cage, and the cage in the picture.
    """
    peaks = [np.asarray(data[name].values, dtype=float) for name in ("contact_force", "land_force")]
    before = np.concatenate([[moments[0]], moments[:-1] + 1])
    pairs = [(min(a, b), b + 1) for a, b in zip(before, moments, strict=True)]
    force, land_force = (np.array([one[a:b].max(axis=0) for a, b in pairs]) for one in peaks)
    in_space, data = is_in_space(data), data.isel(time=moments)
    count, balls = data.sizes["time"], data.sizes["ball"]
    radius, plays = float(data["cage_pitch_radius"]), data["half_play"].values.astype(float)
    pitch = 2.0 * np.pi * radius / max(3, balls)
    ball = 0.5 * (float(data["cage_ball_diameter"]) or 0.75 * pitch)
    wide = stated(study_of(data), "cage", "width")
    half_width = max(0.5 * float(wide) if wide else 0.0, WIDE * ball)
    centre, lean = data["position"].values, data["lean"].values if in_space else np.zeros((count, 2))
    axial = data["axial_place"].values if in_space else np.zeros(count)
    across, land = axial_play(data) if in_space else 0.0, land_boundary(data)
    side = 0 if land is None else (-1 if str(data["cage_guidance"].values) == "inner" else 1)
    far = max(
        float(np.abs(one).max(initial=0.0))
        for one in (np.hypot(*centre.T), radius * np.hypot(*lean.T), axial)
    )
    limits = [
        (0.5 * (1.0 - BAR_SHARE) * (pitch - 2.0 * ball), float(plays.max())),
        (RIM * half_width - ball, across),
        (FARTHEST * radius, far),
    ]
    most = [largest / size for largest, size in limits if size > 0.0]
    return Scene(
        radius=radius,
        ball=ball,
        half_width=half_width,
        half_thickness=2.0 * THICK * ball,
        angles=data["pocket_angle"].values.astype(float),
        plays=plays,
        axial_play=across,
        is_square=str(data["cage_pocket_shape"].values) == "square",
        land=radius + side * 2.0 * THICK * ball,
        side=side,
        heights=tuple(float(h) for h in land_heights(data)),
        gap=0.0 if land is None else float(land.max()),
        in_space=in_space,
        centre=centre,
        lean=lean,
        axial=axial,
        rotation=data["rotation"].values,
        lead=data["ball_lead"].values,
        ball_axial=data["ball_axial"].values if in_space else np.zeros((count, balls)),
        force=force,
        land_force=land_force,
        largest=(float(peaks[0].max()), float(peaks[1].max())),
        enlarged=float(f"{max(1.0, min(most, default=1.0)):.2g}"),
    )


def turned_by(data: xr.Dataset) -> Array:
    """Return the angle by which the ball set has turned at each sample [rad], with its start-up ramp."""
    time, speed = np.asarray(data["time"].values, dtype=float), float(data["cage_cage_speed"])
    ramp, start = float(data["cage_ramp_time"]), float(data["cage_ramp_start"])
    if not ramp > 0.0:
        return np.asarray(speed * time)
    within = np.minimum(time, ramp)
    return np.asarray(speed * (time - (1 - start) * within + (1 - start) * within**2 / (2 * ramp)))


def force_key(at: Scene) -> str:
    """Return which colours the forces have."""
    forces = [f"0 to {format_number(one, 3)} N {where}" for one, where in zip(at.largest, WHERE, strict=True)]
    shown = ", ".join(forces[: 1 + (at.largest[1] > 0.0)])
    return f"{shown}; root scale, the largest since the frame before"


def span_key(data: xr.Dataset, moments: Array) -> str:
    """Return which times the frames show."""
    spans = " and ".join(f"{first:.4g} to {last:.4g} ms" for first, last in shown_parts(data, moments))
    return f"Frames show {spans}."


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
    title = cut(str(data.attrs.get("title", "")), WIDTH)
    # a text of the study may hold any mark: the JSON is inside a script
    found = json.dumps(run_for_page(data, moments, at), allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    parts = {
        "ABOUT": html.escape("\n".join(heading(data)[len(title) :])),
        "MOST": force_key(at),
        "SHOWN": span_key(data, moments),
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
        "view": list(VIEWS[at.in_space]),
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
