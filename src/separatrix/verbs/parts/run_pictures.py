"""A run of the cage to draw: its path and boundaries, its course in time, and its whirl."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from separatrix.ground.plain_data import Part
from separatrix.ground.units import Array, Metre
from separatrix.present import figure as fig
from separatrix.present.quantity_text import axis, show
from separatrix.present.view import AROUND, array, land_boundary, land_heights, whirl_spectrum

FINE = 6
"""Points drawn for a sample of the path."""

BEYOND, NEVER = 2.0, 1e3
"""Half the play over the land's gap from which the pockets are left out of the picture; over the play, along
the radius of one ball, from which a boundary does not exist."""

PRESENT = 0.05
"""Share of the largest amplitude of a spectrum from which a whirl is shown."""


def pocket_boundary(answer: Part) -> Array:
    """Return how far the centre may go in each direction until a pocket touches its ball [m].

    Without rotation and lead that is where |r . e_t,j| = c_j: the polygon inside 2 Z lines. A single ball
    leaves the way along its own radius free: there it is infinite. Of spheres it is a circle, or the part
    that many have in common where they are off their balls.
    """
    apart, play = AROUND[:, np.newaxis] - array(answer, "pocket_angle"), array(answer, "half_play")
    if answer.cage.pocket_shape == "spherical":
        outward = answer.cage.pocket_radial_offset * np.cos(apart)
        return np.asarray((np.hypot(outward, play) - outward).min(axis=1))
    across = np.abs(np.sin(apart))
    reach = play / np.maximum(across, 1.0 / NEVER)
    return np.where((across < 1.0 / NEVER).all(axis=1), np.inf, reach.min(axis=1))


def largest_play(answer: Part) -> Metre | None:
    """Return half the largest play of the pockets [m]; None if the centre stays far within."""
    play, land = float(array(answer, "half_play").max()), land_boundary(answer)
    far = float(np.hypot(*array(answer, "position").T).max())
    return play if land is None or play <= BEYOND * max(far, float(land.max())) else None


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
    at_land = 0.0 if land is None else float(land.max())
    most = 1.12 * max(float(np.abs(path).max()), play or 0.0, at_land, 1e-9)
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
    frequency, share = whirl_spectrum(answer)
    shown = np.abs(frequency[share > PRESENT])
    most = float(1.3 * shown.max(initial=0.0)) or float(np.abs(frequency).max()) or 1.0
    seen = np.flatnonzero(np.abs(frequency) <= most)
    at = seen[thinned(share[seen])]
    marks: list[fig.Mark] = [fig.Across(at=0.0, colour=fig.GREY)]
    title = "b  Whirl: velocity of the centre"
    if "whirl_frequency" in answer and answer.whirl_direction:
        title += f"; judged part {show(answer, 'whirl_frequency')}"
        whirl = answer.whirl_direction * answer.whirl_frequency
        marks.append(fig.Across(at=whirl, colour=fig.VERMILION, line="--"))
    marks.append(fig.Trace(x=frequency[at].tolist(), y=share[at].tolist(), colour=fig.BLUE, width=0.8))
    label, unit = "frequency; backward < 0 < forward", answer.unit("whirl_frequency")
    x = axis("whirl_frequency", unit, [most], label=label, low=-most, high=most)
    y = fig.Axis(label="relative amplitude [-]", low=0.0, high=1.18)
    return fig.Panel(title=title, x=x, y=y, marks=tuple(marks))
