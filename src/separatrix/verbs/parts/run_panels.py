"""Panels of a run of the cage: its path, its course in time, its whirl."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.ground.document import Part
from separatrix.ground.units import Array
from separatrix.present.figure import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    SKY,
    VERMILION,
    Across,
    Axis,
    Band,
    Label,
    Mark,
    Panel,
    Trace,
)
from separatrix.verbs.parts import cage_scene
from separatrix.verbs.parts.cage_scene import AROUND, array, land_boundary, largest_play
from separatrix.verbs.parts.quantity_text import axis, show

SHOWN = 1600
"""Points of a course in time, at most."""

NEAR = 2.5
"""Limits within this multiple of the largest value are drawn."""


def orbit(answer: Part) -> Panel:
    """Return the centre's path between its boundaries, darker in the judged part.

    Boundaries come before the path, the land wide and light: neither hides the other or a path along it.
    """
    path, land, play = cage_scene.smooth_path(answer), land_boundary(answer), largest_play(answer)
    most = 1.12 * max(
        float(np.abs(path).max()), play or 0.0, 0.0 if land is None else float(land.max()), 1e-9
    )
    marks: list[Mark] = []
    if land is not None:
        marks.append(_around(land, "land clearance", colour=VERMILION, width=3.5, opacity=0.45))
    if play:
        marks.append(_around(cage_scene.pocket_boundary(answer), "pocket clearance", width=0.8, line="--"))
    first = cage_scene.FINE * int(np.searchsorted(array(answer, "time"), answer.judged_from))
    first = first if answer.followed > answer.judged_from else 0
    if first:
        marks.append(_line(path[: first + 1], "path", colour=SKY, width=0.35, opacity=0.8))
    marks.append(_line(path[first:], "path, judged part" if first else "path", colour=BLUE, width=0.7))
    marks.append(_line(path[:1], "start", line="", marker="o", size=3.5))
    marks.append(_line(path[-1:], "end", line="", marker="s", size=3.5, is_open=True))
    unit = answer.unit("position")
    x, y = (axis("position", unit, [most], label=one, low=-most, high=most) for one in "xy")
    return Panel(title="a  Cage centre, turning frame", x=x, y=y, marks=tuple(marks), is_to_scale=True)


def _around(radius: Array, name: str, **look: Any) -> Trace:
    known = np.where(np.isfinite(radius), radius, np.nan)[:, np.newaxis]
    return _line(known * np.stack([np.cos(AROUND), np.sin(AROUND)], axis=1), name, **look)


def _line(path: Array, name: str, **look: Any) -> Trace:
    return Trace(x=path[:, 0].tolist(), y=path[:, 1].tolist(), name=name, **look)


class Course(NamedTuple):
    """What is shown against time: its label, its values at the samples, and how its line looks."""

    label: str
    values: Array
    colour: str = BLUE
    line: str = "-"


Limits = dict[tuple[str, str], float | None]
"""Name and colour of what a cage touches -> the value at which it does; None if it does so nowhere."""

POCKETS, LAND = ("pockets", BLACK), ("land", VERMILION)


def offset(answer: Part) -> Panel:
    """Return the offset of the centre against time, in space with the axial place of the cage."""
    land = land_boundary(answer)
    limits: Limits = {POCKETS: largest_play(answer), LAND: None if land is None else float(land.max())}
    courses = [Course("offset", np.hypot(*array(answer, "position").T))]
    courses += [Course("axial place", array(answer, "axial_place"), GREEN)] if "lean" in answer else []
    return _course(answer, "largest_offset", "c  Offset", courses, limits)


def tilt(answer: Part) -> Panel:
    """Return the angle between the axes of cage and bearing; limits are those of a centred cage."""
    play, land = cage_scene.axial_half_play(answer) / answer.cage.pitch_radius, land_boundary(answer)
    reach = float(cage_scene.land_heights(answer).max(initial=0.0)) + 0.5 * answer.cage.land_width
    at_land = None if land is None or not reach else float(land.max()) / reach
    limits: Limits = {POCKETS: play or None, LAND: at_land}
    courses = [Course("tilt", np.hypot(*array(answer, "lean").T))]
    return _course(answer, "largest_tilt", "e  Tilt", courses, limits)


def forces(answer: Part) -> Panel:
    """Return the largest force of any pocket, and that of the lands, against time."""
    pocket, land = array(answer, "contact_force").max(axis=1), array(answer, "land_force")
    courses = [Course("pocket, largest", pocket)]
    courses += [Course("land", land, VERMILION, "--")] if np.any(land) else []
    limits: Limits = {("races hold", GREY): answer.get("force_limit")}
    return _course(answer, "contact_force", "d  Forces", courses, limits, label="force")


def _course(
    answer: Part, name: str, title: str, courses: list[Course], limits: Limits, label: str = ""
) -> Panel:
    """Return courses of one quantity against time, with the limits near to them and the judged part."""
    time, every = array(answer, "time"), np.concatenate([one.values for one in courses])
    near = NEAR * float(np.abs(every).max())
    known = {one: value for one, value in limits.items() if value is not None and value <= near}
    high = 1.12 * max([0.0, float(every.max()), *known.values()]) or 1e-12
    low, first, until = min(0.0, 1.1 * float(every.min())), answer.judged_from, answer.followed
    marks, labels = list[Mark](), list[Label]()
    if until > first:
        look: dict[str, Any] = {"colour": GREY, "opacity": 0.2, "name": "judged part"}
        marks.append(Band(x=[first, until], low=[low, low], high=[high, high], **look))
    for (touched, colour), value in known.items():
        marks.append(Across(at=value, axis="y", colour=colour, line="--"))
        labels.append(Label(y=value, text=touched, colour=colour))
    for course in courses:
        at = thinned(course.values)
        x, y = time[at].tolist(), course.values[at].tolist()
        marks.append(Trace(x=x, y=y, colour=course.colour, line=course.line, width=0.8))
        if len(courses) > 1:
            labels.append(Label(y=float(course.values[-1]), text=course.label, colour=course.colour))
    label = label or ", ".join(course.label for course in courses)
    return Panel(
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


def spectrum(answer: Part) -> Panel:
    """Return the two-sided spectrum of the centre's velocity; forward whirl turns as the balls do."""
    most, (frequency, share) = cage_scene.spectrum_reach(answer), cage_scene.whirl_spectrum(answer)
    seen = np.flatnonzero(np.abs(frequency) <= most)
    at = seen[thinned(share[seen])]
    marks: list[Mark] = [Across(at=0.0, colour=GREY)]
    title = "b  Whirl: velocity of the centre"
    if "whirl_frequency" in answer and answer.whirl_direction:
        title += f"; judged part {show(answer, 'whirl_frequency')}"
        marks.append(Across(at=answer.whirl_direction * answer.whirl_frequency, colour=VERMILION, line="--"))
    marks.append(Trace(x=frequency[at].tolist(), y=share[at].tolist(), colour=BLUE, width=0.8))
    label, unit = "frequency; backward < 0 < forward", answer.unit("whirl_frequency")
    x = axis("whirl_frequency", unit, [most], label=label, low=-most, high=most)
    y = Axis(label="relative amplitude [-]", low=0.0, high=1.18)
    return Panel(title=title, x=x, y=y, marks=tuple(marks))
