"""Panels of a run of the cage: its path, its course in time, its whirl."""

from __future__ import annotations

from collections.abc import Sequence
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
    Words,
)
from separatrix.verbs.parts.cage_scene import (
    AROUND,
    LAST,
    array,
    axial_half_play,
    land_boundary,
    land_heights,
    largest_play,
    last_turns,
    pocket_boundary,
    smooth_path,
    spectrum_reach,
    whirl_spectrum,
)
from separatrix.verbs.parts.quantity_text import axis, show

SHOWN = 1600
"""Points of a course in time, at most."""

LAND: dict[str, Any] = {"colour": VERMILION, "width": 3.5, "opacity": 0.45}
POCKETS: dict[str, Any] = {"colour": BLACK, "width": 0.8, "line": "--"}
"""Boundaries come before the path, the land wide and light: neither hides the other or a path along it."""

NEAR = 2.5
"""Limits within this multiple of the largest value are drawn."""


Limit = tuple[float, str, str]
"""A value at which a cage touches, with its name and colour."""


def orbit(answer: Part) -> Panel:
    """Return the centre's path between its boundaries, darker in its last turns."""
    land, play = land_boundary(answer), largest_play(answer)
    path = smooth_path(*(array(answer, name) for name in ("time", "position", "velocity")))
    reach = (np.abs(path).max(), play or 0.0, 0.0 if land is None else land.max(), 1e-9)
    marks, most, first = [], 1.12 * float(max(reach)), last_turns(path)
    for radius, look, name in (
        (land, LAND, "land clearance"),
        (None if play is None else pocket_boundary(answer), POCKETS, "pocket clearance"),
    ):
        if radius is not None and radius.max() > 0.0:
            around = np.where(np.isfinite(radius), radius, np.nan)
            ring = np.stack([around * np.cos(AROUND), around * np.sin(AROUND)], axis=1)
            marks.append(_line(ring, name=name, **look))
    if first:
        marks.append(_line(path, colour=SKY, width=0.35, opacity=0.8, name="path"))
    marks.append(_line(path[first:], colour=BLUE, width=0.7, name=f"last {LAST} turns" if first else "path"))
    for place, marker, words in ((path[:1], "o", "start"), (path[-1:], "s", "end")):
        marks.append(_line(place, name=words, line="", marker=marker, size=3.5, is_open=marker == "s"))
    unit = answer.unit("position")
    x, y = (axis("position", unit, [most], label=one, low=-most, high=most) for one in "xy")
    return Panel(title="a  Cage centre, turning frame", x=x, y=y, marks=tuple(marks), is_to_scale=True)


def _line(path: Array, **look: Any) -> Trace:
    return Trace(x=path[:, 0].tolist(), y=path[:, 1].tolist(), **look)


def offset(answer: Part) -> Panel:
    """Return the offset of the centre against time, in space with the axial place of the cage."""
    land, play = land_boundary(answer), largest_play(answer)
    limits = [] if play is None else [(play, "pockets", BLACK)]
    limits += [] if land is None else [(float(land.max()), "land", VERMILION)]
    courses = [Course("offset", np.hypot(*array(answer, "position").T), BLUE)]
    courses += [Course("axial place", array(answer, "axial_place"), GREEN)] if "lean" in answer else []
    return _course(answer, "largest_offset", "c  Offset", courses, limits)


def tilt(answer: Part) -> Panel:
    """Return the angle between the axes of cage and bearing; limits are those of a centred cage."""
    play, land = axial_half_play(answer) / answer.cage.pitch_radius, land_boundary(answer)
    reach = float(land_heights(answer).max(initial=0.0)) + 0.5 * answer.cage.land_width
    limits = [(play, "pockets", BLACK)] if play > 0.0 else []
    limits += [(float(land.max()) / reach, "land", VERMILION)] if land is not None and reach else []
    courses = [Course("tilt", np.hypot(*array(answer, "lean").T), BLUE)]
    return _course(answer, "largest_tilt", "e  Tilt", courses, limits)


def forces(answer: Part) -> Panel:
    """Return the largest force of any pocket, and that of the lands, against time."""
    pocket, land = array(answer, "contact_force").max(axis=1), array(answer, "land_force")
    courses = [Course("pocket, largest", pocket, BLUE)]
    courses += [Course("land", land, VERMILION, "--")] if np.any(land) else []
    limits = [(float(answer.force_limit), "races hold", GREY)] if "force_limit" in answer else []
    return _course(answer, "contact_force", "d  Forces", courses, limits, label="force")


class Course(NamedTuple):
    """What is shown against time: its label, its values at the samples, and how its line looks."""

    label: str
    values: Array
    colour: str
    line: str = "-"


def _course(
    answer: Part, name: str, title: str, courses: Sequence[Course], limits: Sequence[Limit], label: str = ""
) -> Panel:
    """Return courses of one quantity against time, with the limits near to them and the judged part."""
    time, unit, label = array(answer, "time"), answer.unit(name), label or ", ".join(c.label for c in courses)
    every = np.concatenate([one.values for one in courses])
    near = [one for one in limits if one[0] <= NEAR * float(np.abs(every).max())]
    high = 1.12 * max([0.0, float(every.max()), *(value for value, _, _ in near)]) or 1e-12
    low, first, until = min(0.0, 1.1 * float(every.min())), answer.judged_from, answer.followed
    marks: list[Mark] = []
    if until > first:
        look: dict[str, Any] = {"colour": GREY, "opacity": 0.2, "name": "judged part"}
        marks.append(Band(x=[first, until], low=[low, low], high=[high, high], **look))
    marks += [Across(at=value, axis="y", colour=colour, line="--") for value, _, colour in near]
    labels = [Label(y=value, text=text, colour=colour) for value, text, colour in near]
    for one in courses:
        at = thinned(one.values)
        look = {"colour": one.colour, "line": one.line, "width": 0.8}
        marks.append(Trace(x=time[at].tolist(), y=one.values[at].tolist(), **look))
        if len(courses) > 1:
            labels.append(Label(y=float(one.values[-1]), text=one.label, colour=one.colour))
    x = axis("time", answer.unit("time"), [time[-1]], low=0.0, high=float(time[-1]) or 1e-3)
    y = axis(name, unit, [high], label=label, low=low, high=high)
    return Panel(title=title, x=x, y=y, marks=tuple(marks), labels=tuple(labels))


def thinned(values: Array, most: int = SHOWN) -> NDArray[np.intp]:
    """Return the places of the least and the largest value of each part of a course, rising."""
    if values.size <= most:
        return np.arange(values.size)
    edges = np.linspace(0, values.size, most // 2 + 1).astype(int)
    ends = [a + end for a, b in pairwise(edges) for end in (values[a:b].argmin(), values[a:b].argmax())]
    return np.unique([0, *ends, values.size - 1])


def spectrum(answer: Part) -> Panel:
    """Return the two-sided spectrum of the centre's velocity; forward whirl turns as the balls do."""
    most, (frequency, share) = spectrum_reach(answer), whirl_spectrum(answer)
    seen = np.flatnonzero(np.abs(frequency) <= most)
    at = seen[thinned(share[seen])]
    marks: list[Mark] = [Across(at=0.0, colour=GREY)]
    if "whirl_frequency" in answer and answer.whirl_direction:
        place = answer.whirl_direction * answer.whirl_frequency
        text, is_outward = show(answer, "whirl_frequency"), abs(place) < 0.4 * most
        side = "right" if (place > 0.0) == is_outward else "left"  # across neither zero nor the panel's end
        marks.append(Across(at=place, colour=VERMILION, line="--"))
        marks.append(Words(x=place, y=1.1, text=f"judged part: {text}", colour=VERMILION, side=side))
    marks.append(Trace(x=frequency[at].tolist(), y=share[at].tolist(), colour=BLUE, width=0.8))
    label, unit = "frequency; backward < 0 < forward", answer.unit("whirl_frequency")
    x = axis("whirl_frequency", unit, [most], label=label, low=-most, high=most)
    y = Axis(label="relative amplitude [-]", low=0.0, high=1.18)
    return Panel(title="b  Whirl: velocity of the centre", x=x, y=y, marks=tuple(marks))
