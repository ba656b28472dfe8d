"""A run of the cage to draw: its path and boundaries, its course in time, its whirl, and a moving scene."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from separatrix.ground.document import Part
from separatrix.ground.units import Array, Hertz, Metre
from separatrix.present import figure as fig
from separatrix.present.quantity_text import axis, show

AROUND = np.linspace(0.0, 2 * np.pi, 721)
"""Directions in which boundaries are drawn: half a degree apart."""

FINE = 6
"""Points drawn for a sample of the path."""

BEYOND, NEVER = 2.0, 1e3
"""Half the play over the land's gap from which the pockets are left out of the picture; over the play, along
the radius of one ball, from which a boundary does not exist."""

SHORTEST, STRONG, PRESENT = 8, 0.3, 0.05
"""Least samples of a spectrum; shares of its largest amplitude from which a whirl is strong, and is shown."""

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


def pocket_boundary(answer: Part) -> Array:
    """Return how far the centre may go in each direction until a pocket touches its ball [m].

    Without rotation and lead that is where |r . e_t,j| = c_j: the polygon inside 2 Z lines. A single ball
    leaves the way along its own radius free: there it is infinite.
    """
    across = np.abs(np.sin(AROUND[:, np.newaxis] - array(answer, "pocket_angle")))
    reach = array(answer, "half_play") / np.maximum(across, 1.0 / NEVER)
    return np.where((across < 1.0 / NEVER).all(axis=1), np.inf, reach.min(axis=1))


def land_boundary(answer: Part) -> Array | None:
    """Return how far the centre may go in each direction until the land touches [m]; None without one."""
    cage = answer.cage
    if cage.guidance == "ball" or cage.land_clearance is None:
        return None
    sign = (-1) ** cage.land_lobes if cage.guidance == "inner" else 1
    wave = cage.land_out_of_round * sign * np.cos(cage.land_lobes * AROUND)
    return np.asarray(0.5 * cage.land_clearance - wave)


def largest_play(answer: Part) -> Metre | None:
    """Return half the largest play of the pockets [m]; None if the centre stays far within."""
    play, land = float(array(answer, "half_play").max()), land_boundary(answer)
    far = float(np.hypot(*array(answer, "position").T).max())
    return play if land is None or play <= BEYOND * max(far, float(land.max())) else None


def land_heights(answer: Part) -> Array:
    """Return the height of the middle of each land over the pockets [m]."""
    if land_boundary(answer) is None:
        return np.zeros(0)
    cage = answer.cage
    return np.zeros(1) if cage.land_count == 1 else 0.5 * cage.land_spacing * np.array([-1.0, 1.0])


def smooth_path(answer: Part) -> Array:
    """Return the path through samples as the cubics that have their positions and velocities.

    Straight lines between the samples of a fast whirl would be drawn as a polygon.
    """
    time, position, velocity = (array(answer, name) for name in ("time", "position", "velocity"))
    if time.size < 2:
        return position
    places = np.linspace(0, time.size - 1, FINE * (time.size - 1) + 1)
    found = CubicHermiteSpline(time, position, velocity)(np.interp(places, np.arange(time.size), time))
    return np.asarray(found)


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


def spectrum_reach(answer: Part) -> Hertz:
    """Return the frequency up to which a picture of the spectrum must go [Hz]."""
    frequency, share = whirl_spectrum(answer)
    shown = np.abs(frequency[share > PRESENT])
    return float(1.3 * shown.max(initial=0.0)) or float(np.abs(frequency).max()) or 1.0


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


# The panels.

SHOWN = 1600
"""Points of a course in time, at most."""

NEAR = 2.5
"""Limits within this multiple of the largest value are drawn."""


def orbit(answer: Part) -> fig.Panel:
    """Return the centre's path between its boundaries, darker in the judged part.

    Boundaries come before the path, the land wide and light: neither hides the other or a path along it.
    """
    path, land, play = smooth_path(answer), land_boundary(answer), largest_play(answer)
    most = 1.12 * max(
        float(np.abs(path).max()), play or 0.0, 0.0 if land is None else float(land.max()), 1e-9
    )
    marks: list[fig.Mark] = []
    if land is not None:
        marks.append(_around(land, "land clearance", colour=fig.VERMILION, width=3.5, opacity=0.45))
    if play:
        marks.append(_around(pocket_boundary(answer), "pocket clearance", width=0.8, line="--"))
    first = FINE * int(np.searchsorted(array(answer, "time"), answer.judged_from))
    first = first if answer.followed > answer.judged_from else 0
    if first:
        marks.append(_line(path[: first + 1], "path", colour=fig.SKY, width=0.35, opacity=0.8))
    marks.append(_line(path[first:], "path, judged part" if first else "path", colour=fig.BLUE, width=0.7))
    marks.append(_line(path[:1], "start", line="", marker="o", size=3.5))
    marks.append(_line(path[-1:], "end", line="", marker="s", size=3.5, is_open=True))
    unit = answer.unit("position")
    x, y = (axis("position", unit, [most], label=one, low=-most, high=most) for one in "xy")
    return fig.Panel(title="a  Cage centre, turning frame", x=x, y=y, marks=tuple(marks), is_to_scale=True)


def _around(radius: Array, name: str, **look: Any) -> fig.Trace:
    known = np.where(np.isfinite(radius), radius, np.nan)[:, np.newaxis]
    return _line(known * np.stack([np.cos(AROUND), np.sin(AROUND)], axis=1), name, **look)


def _line(path: Array, name: str, **look: Any) -> fig.Trace:
    return fig.Trace(x=path[:, 0].tolist(), y=path[:, 1].tolist(), name=name, **look)


class Course(NamedTuple):
    """What is shown against time: its label, its values at the samples, and how its line looks."""

    label: str
    values: Array
    colour: str = fig.BLUE
    line: str = "-"


Limits = dict[tuple[str, str], float | None]
"""Name and colour of what a cage touches -> the value at which it does; None if it does so nowhere."""

POCKETS, LAND = ("pockets", fig.BLACK), ("land", fig.VERMILION)


def offset(answer: Part) -> fig.Panel:
    """Return the offset of the centre against time, in space with the axial place of the cage."""
    land = land_boundary(answer)
    limits: Limits = {POCKETS: largest_play(answer), LAND: None if land is None else float(land.max())}
    courses = [Course("offset", np.hypot(*array(answer, "position").T))]
    courses += [Course("axial place", array(answer, "axial_place"), fig.GREEN)] if "lean" in answer else []
    return _course(answer, "largest_offset", "c  Offset", courses, limits)


def tilt(answer: Part) -> fig.Panel:
    """Return the angle between the axes of cage and bearing; limits are those of a centred cage."""
    cage, land = answer.cage, land_boundary(answer)
    reach = float(land_heights(answer).max(initial=0.0)) + 0.5 * cage.land_width
    at_land = None if land is None or not reach else float(land.max()) / reach
    limits: Limits = {POCKETS: (cage.axial_half_play or 0.0) / cage.pitch_radius or None, LAND: at_land}
    courses = [Course("tilt", np.hypot(*array(answer, "lean").T))]
    return _course(answer, "largest_tilt", "e  Tilt", courses, limits)


def forces(answer: Part) -> fig.Panel:
    """Return the largest force of any pocket, and that of the lands, against time."""
    pocket, land = array(answer, "contact_force").max(axis=1), array(answer, "land_force")
    courses = [Course("pocket, largest", pocket)]
    courses += [Course("land", land, fig.VERMILION, "--")] if np.any(land) else []
    limits: Limits = {("races hold", fig.GREY): answer.get("force_limit")}
    return _course(answer, "contact_force", "d  Forces", courses, limits, label="force")


def _course(
    answer: Part, name: str, title: str, courses: list[Course], limits: Limits, label: str = ""
) -> fig.Panel:
    """Return courses of one quantity against time, with the limits near to them and the judged part."""
    time, every = array(answer, "time"), np.concatenate([one.values for one in courses])
    near = NEAR * float(np.abs(every).max())
    known = {one: value for one, value in limits.items() if value is not None and value <= near}
    high = 1.12 * max([0.0, float(every.max()), *known.values()]) or 1e-12
    low, first, until = min(0.0, 1.1 * float(every.min())), answer.judged_from, answer.followed
    marks, labels = list[fig.Mark](), list[fig.Label]()
    if until > first:
        look: dict[str, Any] = {"colour": fig.GREY, "opacity": 0.2, "name": "judged part"}
        marks.append(fig.Band(x=[first, until], low=[low, low], high=[high, high], **look))
    for (touched, colour), value in known.items():
        marks.append(fig.Across(at=value, axis="y", colour=colour, line="--"))
        labels.append(fig.Label(y=value, text=touched, colour=colour))
    for course in courses:
        at = thinned(course.values)
        x, y = time[at].tolist(), course.values[at].tolist()
        marks.append(fig.Trace(x=x, y=y, colour=course.colour, line=course.line, width=0.8))
        if len(courses) > 1:
            labels.append(fig.Label(y=float(course.values[-1]), text=course.label, colour=course.colour))
    label = label or ", ".join(course.label for course in courses)
    return fig.Panel(
        title=title,
        x=axis("time", answer.unit("time"), [time[-1]], low=0.0, high=float(time[-1]) or 1e-3),
        y=axis(name, answer.unit(name), [high], label=label, low=low, high=high),
        marks=tuple(marks),
        labels=tuple(labels),
    )


def thinned(values: Array, most: int = SHOWN) -> NDArray[np.intp]:
    """Return the places of the least and the largest value of each part of a course, rising."""
    if values.size <= most:
        return np.arange(values.size)
    edges = np.linspace(0, values.size, most // 2 + 1).astype(int)
    ends = [a + end for a, b in pairwise(edges) for end in (values[a:b].argmin(), values[a:b].argmax())]
    return np.unique([0, *ends, values.size - 1])


def spectrum(answer: Part) -> fig.Panel:
    """Return the two-sided spectrum of the centre's velocity; forward whirl turns as the balls do."""
    most, (frequency, share) = spectrum_reach(answer), whirl_spectrum(answer)
    seen = np.flatnonzero(np.abs(frequency) <= most)
    at = seen[thinned(share[seen])]
    marks: list[fig.Mark] = [fig.Across(at=0.0, colour=fig.GREY)]
    title = "b  Whirl: velocity of the centre"
    if "whirl_frequency" in answer and answer.whirl_direction:
        title += f"; judged part {show(answer, 'whirl_frequency')}"
        marks.append(
            fig.Across(at=answer.whirl_direction * answer.whirl_frequency, colour=fig.VERMILION, line="--")
        )
    marks.append(fig.Trace(x=frequency[at].tolist(), y=share[at].tolist(), colour=fig.BLUE, width=0.8))
    label, unit = "frequency; backward < 0 < forward", answer.unit("whirl_frequency")
    x = axis("whirl_frequency", unit, [most], label=label, low=-most, high=most)
    y = fig.Axis(label="relative amplitude [-]", low=0.0, high=1.18)
    return fig.Panel(title=title, x=x, y=y, marks=tuple(marks))
