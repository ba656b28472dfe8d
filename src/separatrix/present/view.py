"""One run of a cage as a page to turn and play: true shapes, small movements enlarged."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import Any

import numpy as np

from separatrix.ground.plain_data import Part
from separatrix.ground.units import Array, format_number, format_quantity

AROUND = np.linspace(0.0, 2 * np.pi, 721)
"""Directions in which boundaries are drawn: half a degree apart."""

SHORTEST, STRONG = 8, 0.3
"""Least samples of a spectrum; share of its largest amplitude from which a whirl is strong."""

A_TURN = 6
"""Least frames in a turn of the fastest strong whirl: fewer may reverse its sense."""

MOST_FRAMES, MOST_NUMBERS = 1200, 75_000
"""Most frames, and most numbers in all: they keep a page under 1 MB."""

BAR_SHARE, FARTHEST = 0.4, 0.25
"""Least share of the bar in the room between two balls; largest movement drawn over the pitch radius."""

THICK, WIDE, RIM = 0.28, 1.35, 0.88
"""Half the radial thickness of the cage over the ball's diameter; its width over that, if not stated; largest
size of a pocket along the axis over that width."""

NANO = 1e9
POCKET_POINTS, BAR_POINTS = 24, 6
"""Points around a pocket; pieces of a bar between two pockets, in the plane of the balls."""

VIEWS = ((0.5 * np.pi, 0.0), tuple(np.deg2rad([28.0, -62.0])))
"""Height of the eye over the plane of the bearing, and angle around it [rad]: in the plane, in space."""


def array(part: Part, name: str) -> Array:
    """Return numbers of a document as an array."""
    return np.asarray(part.get(name), dtype=float)


def land_boundary(answer: Part) -> Array | None:
    """Return how far the centre may go in each direction until the land touches [m]; None without one."""
    cage = answer.cage
    if cage.guidance == "ball" or cage.land_clearance is None:
        return None
    sign = (-1) ** cage.land_lobes if cage.guidance == "inner" else 1
    wave = cage.land_out_of_round * sign * np.cos(cage.land_lobes * AROUND)
    return np.asarray(0.5 * cage.land_clearance - wave)


def land_heights(answer: Part) -> Array:
    """Return the height of the middle of each land over the pockets [m]."""
    if land_boundary(answer) is None:
        return np.zeros(0)
    cage = answer.cage
    return np.zeros(1) if cage.land_count == 1 else 0.5 * cage.land_spacing * np.array([-1.0, 1.0])


def whirl_spectrum(answer: Part) -> tuple[Array, Array]:
    """Return frequency [Hz] and amplitude of the velocity of a run, the largest being 1.

    Seen so that the ball set turns anticlockwise, frequency rises from negative (backward) to positive
    (forward). A run of few samples goes on at rest up to `SHORTEST` of them.
    """
    time, sense = array(answer, "time"), -1.0 if answer.cage.cage_speed < 0.0 else 1.0
    v = array(answer, "velocity") @ np.array([1.0, 1j * sense])
    v = np.pad(v, (0, max(0, SHORTEST - v.size)))
    amplitude = np.abs(np.fft.fftshift(np.fft.fft(v)))
    step = float(time[1] - time[0] if time.size > 1 else 1.0)
    return np.fft.fftshift(np.fft.fftfreq(v.size, step)), amplitude / (amplitude.max() or 1.0)


def frame_moments(answer: Part, most: int) -> list[Array]:
    """Return the samples that become frames, rising, with the first and the last.

    They are close enough to show each turn of the whirl; if the whole run would take too many, two parts, its
    beginning and its end, are shown.
    """
    time, (frequency, share) = array(answer, "time"), whirl_spectrum(answer)
    even: Any = np.unique(np.linspace(0, time.size - 1, min(most, time.size)).astype(int))
    turns = float(np.abs(frequency[share > STRONG]).max(initial=0.0) * time[-1])  # none of a cage at rest
    step = max(1, int(time.size / (A_TURN * turns))) if turns > 0.0 else time.size
    if int(np.diff(even).max(initial=1)) <= step:
        return [even]
    half: Any = np.arange(most // 2) * step
    return [half, time.size - 1 - half[::-1]]


def turned_by(cage: Part, time: Array) -> Array:
    """Return the angle by which the ball set has turned [rad], with its start-up ramp."""
    speed, ramp, start = cage.cage_speed, cage.ramp_time, cage.ramp_start
    if not ramp > 0.0:
        return np.asarray(speed * time)
    within = np.minimum(time, ramp)
    return np.asarray(speed * (time - (1 - start) * within + (1 - start) * within**2 / (2 * ramp)))


def scene(answer: Part) -> dict[str, Any]:
    """Return what cage.js draws, by its names: sizes [m], and movements at some moments of a run.

    Movements are true, in the frame of the ball set, in whole nanometres and nanoradians; what only a cage in
    space has is null in the plane. Forces are the largest since the moment before, in 1/255 of the largest.
    `enlarged` is the factor by which movements and clearances are drawn too large at first, so that a wall
    touches its ball when it does so: as much as leaves a bar between two pockets, the pockets within the
    cage, and the cage in the picture.
    """
    most = max(2, min(MOST_FRAMES, MOST_NUMBERS // (9 + 3 * len(answer.pocket_angle))))
    parts, time, cage = frame_moments(answer, most), array(answer, "time"), answer.cage
    moments: Any = np.concatenate(parts)
    plays, land, in_space = array(answer, "half_play"), land_boundary(answer), "lean" in answer
    radius, pitch = float(cage.pitch_radius), 2.0 * np.pi * cage.pitch_radius / max(3, plays.size)
    ball = 0.5 * (float(cage.ball_diameter) or 0.75 * pitch)
    stated = answer.values["study"]["cage"]["width"]["value"]
    half_width, axial_play = (
        max(0.5 * float(stated or 0.0), WIDE * ball),
        float(answer.cage.axial_half_play or 0.0),
    )

    def moved(name: str) -> list[int] | None:
        return whole(NANO * array(answer, name)[moments]) if name in answer else None

    peaks = [array(answer, name) for name in ("contact_force", "land_force")]
    largest = [float(one.max()) for one in peaks]
    scales = [one or 1.0 for one in largest]
    force, land_force = (
        whole(255.0 * _largest_since(one, moments) / scale) for one, scale in zip(peaks, scales, strict=True)
    )
    ways = [np.hypot(*array(answer, "position")[moments].T)]
    if in_space:
        lean, axial = (array(answer, name)[moments] for name in ("lean", "axial_place"))
        ways += [radius * np.hypot(*lean.T), axial]
    limits = [
        (0.5 * (1.0 - BAR_SHARE) * (pitch - 2.0 * ball), float(plays.max())),
        (RIM * half_width - ball, axial_play),
        (FARTHEST * radius, max(float(np.abs(one).max(initial=0.0)) for one in ways)),
    ]
    enlarged = min((size / movement for size, movement in limits if movement > 0.0), default=1.0)
    side = 0 if land is None else (-1 if cage.guidance == "inner" else 1)
    return {
        "radius": radius,
        "ball": ball,
        "halfWidth": half_width,
        "halfThickness": 2.0 * THICK * ball,
        "angles": answer.pocket_angle,
        "plays": plays.tolist(),
        "axialPlay": axial_play,
        "square": cage.pocket_shape == "square",
        "land": radius + side * 2.0 * THICK * ball,
        "side": side,  # 1 for a land outside the cage, -1 inside, 0 without one
        "heights": land_heights(answer).tolist(),
        "gap": 0.0 if land is None else float(land.max()),
        "view": VIEWS[in_space],
        "enlarged": float(f"{max(1.0, enlarged):.2g}"),
        "around": POCKET_POINTS,
        "barPoints": BAR_POINTS,
        "rim": RIM,
        "most": scales,
        "largest": largest,
        "parts": [(float(time[one[0]]), float(time[one[-1]])) for one in parts],
        "time": [float(f"{one:.7g}") for one in time[moments]],
        "turned": np.mod(turned_by(cage, time[moments]), 2.0 * np.pi).round(4).tolist(),
        **{key: moved(name) for key, name in MOVED.items()},
        "force": force,
        "landForce": land_force,
    }


MOVED = {
    "centre": "position",
    "lean": "lean",
    "axial": "axial_place",
    "rotation": "rotation",
    "lead": "ball_lead",
    "ballAxial": "ball_axial",
}
"""Movements of a scene."""


def whole(values: Array) -> list[int]:
    """Return rounded values in one list."""
    return np.rint(values).astype(int).ravel().tolist()


def _largest_since(values: Array, moments: Array) -> Array:
    """Return the largest of some values between each moment and the one before it, from the first sample."""
    starts = np.concatenate([[0], moments[:-1] + 1])
    return np.asarray(np.maximum.reduceat(values[: moments[-1] + 1], starts))


# The page.

WHERE = ("in the pocket (balls: white to red)", "on the land (grey to red)")


def page(heading: Sequence[str], scene: Mapping[str, Any]) -> str:
    """Return a page that needs no other file; its heading is a title and lines below it, all escaped.

    `scene` is what cage.js draws: its `largest` are the forces of a pocket and of the lands [N], its `parts`
    beginning and end of each part of the run that is shown [s].
    """
    title, *about = heading
    largest = scene["largest"]
    forces = [f"0 to {format_number(one, 3)} N {where}" for one, where in zip(largest, WHERE, strict=True)]
    shown = ", ".join(forces[: 1 + (largest[1] > 0.0)])
    spans = " and ".join(" to ".join(format_quantity(end, "s") for end in part) for part in scene["parts"])
    parts = {
        "TITLE": html.escape(title),
        "ABOUT": html.escape("\n".join(about)),
        "MOST": f"{shown}; root scale, the largest since the frame before",
        "SHOWN": f"Frames show {spans}.",
        "DATA": script_json(scene),
        "STYLE": static("cage.css"),
        "SCRIPT": static("cage.js"),
    }
    return re.sub("@([A-Z]+)@", lambda mark: parts[mark[1]], static("cage.html"))  # no mark inside a part


def script_json(value: object) -> str:
    """Return JSON to stand inside a script element, which no text in it may end."""
    found = json.dumps(value, allow_nan=False, separators=(",", ":"))
    for sign in "<>&\u2028\u2029":
        found = found.replace(sign, f"\\u{ord(sign):04x}")
    return found


def static(name: str) -> str:
    """Return a file of style, script or markup that is shipped with the program."""
    return files("separatrix.present").joinpath("static", name).read_text(encoding="utf-8")
