"""Panels of a run of the cage: its path, its course in time, its whirl."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from separatrix.ground.document import Part
from separatrix.ground.quantity import alone
from separatrix.ground.units import Array
from separatrix.present.figure import (
    BLACK,
    BLUE,
    CYCLE,
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
    axial_play,
    is_in_space,
    judged_samples,
    land_boundary,
    land_heights,
    largest_play,
    last_turns,
    pocket_boundary,
    smooth_path,
    spectrum_reach,
    whirl_spectrum,
)
from separatrix.verbs.parts.telling import axis, quantity, told

SHOWN = 1600
"""Points of a course in time, at most."""

LAND: dict[str, Any] = {"colour": VERMILION, "width": 3.5, "opacity": 0.45}
POCKETS: dict[str, Any] = {"colour": BLACK, "width": 0.8, "line": "--"}
"""Boundaries come before the path, the land wide and light: neither hides the other or a path along it."""

NEAR = 2.5
"""Limits within this multiple of the largest value are drawn."""


class Limit(NamedTuple):
    """A value at which a cage touches, with its name and colour."""

    value: float
    name: str
    colour: str


def orbit(answer: Part, *others: Part, title: str = "a  Cage centre, turning frame") -> Panel:
    """Return the centre's path between its boundaries, on a scale that has room for the other runs."""
    most, lines = max(map(_orbit_reach, (answer, *others))), []
    for radius, look, name in (
        (land_boundary(answer), LAND, "land clearance"),
        (pocket_boundary(answer) if largest_play(answer) else None, POCKETS, "pocket clearance"),
    ):
        if radius is not None and radius.max() > 0.0:
            lines.append(_ring(np.where(np.isfinite(radius), radius, np.nan), look, name))
    path = smooth_path(*(array(answer, name) for name in ("time", "position", "velocity")))
    return _path_panel(answer, "position", title, ("x", "y"), path, most, lines)


def _orbit_reach(answer: Part) -> float:
    """Return the least half width of a picture of the orbit [m]."""
    land, far = land_boundary(answer), float(np.abs(array(answer, "position")).max())
    return 1.12 * max(far, largest_play(answer) or 0.0, 0.0 if land is None else float(land.max()), 1e-9)


def lean(answer: Part, title: str = "Lean of the cage's axis") -> Panel:
    """Return where the axis of the cage leans to, with the tilts at which a centred cage touches."""
    path = smooth_path(*(array(answer, name) for name in ("time", "lean", "lean_rate")))
    far = float(np.abs(path).max(initial=0.0)) or 1e-3
    near = [one for one in tilt_limits(answer) if one.value <= 2.0 * far]
    looks = {"land": LAND, "pockets": POCKETS}
    lines = [_ring(one.value, looks[one.name], f"{one.name}, if centred") for one in near]
    most = 1.12 * max([far, *(one.value for one in near)])
    return _path_panel(answer, "largest_tilt", title, ("lean along x", "lean along y"), path, most, lines)


def _ring(radius: Array | float, look: dict[str, Any], name: str) -> Trace:
    return Trace(
        x=(radius * np.cos(AROUND)).tolist(), y=(radius * np.sin(AROUND)).tolist(), name=name, **look
    )


def _path_panel(
    answer: Part,
    name: str,
    title: str,
    labels: tuple[str, str],
    path: Array,
    most: float,
    boundaries: Sequence[Trace],
) -> Panel:
    """Return a path about the axis, darker in its last turns, within boundaries."""
    marks, first = [*boundaries], last_turns(path)
    if first:
        marks.append(_line(path, colour=SKY, width=0.35, opacity=0.8, name="path"))
    last = path[first:]
    width, words = (0.8, f"last {LAST} turns") if first else (0.6, "path")
    marks.append(_line(last, colour=BLUE, width=width, name=words))
    for place, marker, words in ((path[0], "o", "start"), (path[-1], "s", "end")):
        look: dict[str, Any] = {"line": "", "marker": marker, "size": 3.5, "is_open": marker == "s"}
        marks.append(_line(place[np.newaxis], name=words, **look))
    x, y = (axis(name, answer.unit(name), [most], label=one, low=-most, high=most) for one in labels)
    return Panel(title=title, x=x, y=y, marks=tuple(marks), is_to_scale=True)


def _line(path: Array, **look: Any) -> Trace:
    return Trace(x=path[:, 0].tolist(), y=path[:, 1].tolist(), **look)


def offset(answer: Part, title: str) -> Panel:
    """Return the offset of the centre against time, in space with the axial place of the cage."""
    far = np.hypot(*array(answer, "position").T)
    land, play = land_boundary(answer), largest_play(answer)
    limits = [] if play is None else [Limit(play, "pockets", BLACK)]
    limits += [] if land is None else [Limit(float(land.max()), "land", VERMILION)]
    if not is_in_space(answer):
        return _course(answer, title, [Course("largest_offset", far, "", BLUE)], limits, label="offset")
    courses = [
        Course("largest_offset", far, "offset", BLUE),
        Course("axial_place", array(answer, "axial_place"), "axial place", GREEN),
    ]
    return _course(answer, title, courses, limits, label="offset, axial place")


def tilt(answer: Part, title: str) -> Panel:
    """Return the angle between the axes of cage and bearing against time."""
    found = np.hypot(*array(answer, "lean").T)
    return _course(
        answer, title, [Course("largest_tilt", found, "", BLUE)], tilt_limits(answer), label="tilt"
    )


def tilt_limits(answer: Part) -> list[Limit]:
    """Return the tilts at which a centred cage touches balls and lands [rad]."""
    play, land = axial_play(answer) / answer.cage.pitch_radius, land_boundary(answer)
    found = [Limit(play, "pockets", BLACK)] if play > 0.0 else []
    reach = float(land_heights(answer).max(initial=0.0)) + 0.5 * answer.cage.land_width
    return found + (
        [Limit(float(land.max()) / reach, "land", VERMILION)] if land is not None and reach else []
    )


def forces(answer: Part, title: str) -> Panel:
    """Return the largest force of any pocket, and that of the lands, against time."""
    pocket, land = array(answer, "contact_force").max(axis=1), array(answer, "land_force")
    courses = [Course("contact_force", pocket, "pocket, largest", BLUE)]
    if np.any(land):
        courses.append(Course("land_force", land, "land", VERMILION, "--"))
    limit = answer.get("force_limit")
    limits = [] if limit is None else [Limit(limit, "races hold", GREY)]
    return _course(answer, title, courses, limits, label="force")


def energy(answer: Part, title: str) -> Panel:
    """Return the kinetic energy of the cage, and the work of each source since the start.

    Up to the end of the judged part: the engine adds up no work beyond it.
    """
    end = judged_samples(answer)
    courses = [Course("kinetic_energy", array(answer, "kinetic_energy")[:end], "kinetic energy", BLACK)]
    done = {name: array(answer.work, name)[:end] for name in answer.work.values}
    for (name, values), colour in zip(done.items(), CYCLE, strict=False):
        if np.any(values):
            courses.append(Course("work", values, name.replace("_", " "), colour))
    return _course(answer, title, courses, [], label="energy, work")


class Course(NamedTuple):
    """A quantity against time: its name, its values at the samples, its label, and how its line looks."""

    quantity: str
    values: Array
    label: str
    colour: str
    line: str = "-"


def _course(
    answer: Part, title: str, courses: Sequence[Course], limits: Sequence[Limit], *, label: str
) -> Panel:
    """Return quantities of one unit against time, with the limits near to them and the judged part."""
    time, unit = array(answer, "time")[: courses[0].values.size], answer.unit(courses[0].quantity)
    every = np.concatenate([one.values for one in courses])
    near = [one for one in limits if one.value <= NEAR * float(np.abs(every).max())]
    high = 1.12 * max([0.0, float(every.max()), *(one.value for one in near)]) or 1e-12
    low, first, until = min(0.0, 1.1 * float(every.min())), answer.judged_from, answer.followed
    marks: list[Mark] = []
    if until > first:
        look: dict[str, Any] = {"colour": GREY, "opacity": 0.2, "name": "judged part"}
        marks.append(Band(x=[first, until], low=[low, low], high=[high, high], **look))
    marks += [Across(at=one.value, axis="y", colour=one.colour, line="--") for one in near]
    labels = [Label(y=one.value, text=one.name, colour=one.colour) for one in near]
    for one in courses:
        at = thinned(one.values)
        hover = tuple(
            f"{alone(t, quantity('time'), answer.unit('time'))}: "
            f"{one.label or label} {alone(v, quantity(one.quantity), unit)}"
            for t, v in zip(time[at].tolist(), one.values[at].tolist(), strict=True)
        )
        shape: dict[str, Any] = {"colour": one.colour, "line": one.line, "width": 0.8, "hover": hover}
        marks.append(Trace(x=time[at].tolist(), y=one.values[at].tolist(), **shape))
        labels += [Label(y=float(one.values[-1]), text=one.label, colour=one.colour)] if one.label else []
    x = axis("time", answer.unit("time"), [time[-1]], low=0.0, high=float(time[-1]) or 1e-3)
    y = axis(courses[0].quantity, unit, [high], label=label, low=low, high=high)
    return Panel(title=title, x=x, y=y, marks=tuple(marks), labels=tuple(labels))


def thinned(values: Array, most: int = SHOWN) -> NDArray[np.intp]:
    """Return the places of the least and the largest value of each part of a course, rising."""
    if values.size <= most:
        return np.arange(values.size)
    edges = np.linspace(0, values.size, most // 2 + 1).astype(int)
    ends = [a + end for a, b in pairwise(edges) for end in (values[a:b].argmin(), values[a:b].argmax())]
    return np.unique([0, *ends, values.size - 1])


def spectrum(answer: Part, *others: Part, title: str) -> Panel:
    """Return the two-sided spectrum of the centre's velocity; forward whirl turns as the balls do."""
    most = max(map(spectrum_reach, (answer, *others)))
    frequency, share = whirl_spectrum(answer)
    seen = np.flatnonzero(np.abs(frequency) <= most)
    at = seen[thinned(share[seen])]
    unit = answer.unit("whirl_frequency")
    label = "frequency; backward < 0 < forward"
    whirl: list[Mark] = []
    if "whirl_frequency" in answer and answer.whirl_direction:
        place = answer.whirl_direction * answer.whirl_frequency
        text, is_outward = told(answer, "whirl_frequency"), abs(place) < 0.4 * most
        side = "right" if (place > 0.0) == is_outward else "left"  # across neither zero nor the panel's end
        whirl = [
            Across(at=place, colour=VERMILION, line="--"),
            Words(x=place, y=1.1, text=f"judged part: {text}", colour=VERMILION, side=side),
        ]
    return Panel(
        title=title,
        x=axis("whirl_frequency", unit, [most], label=label, low=-most, high=most),
        y=Axis(label="relative amplitude [-]", low=0.0, high=1.18),
        marks=(
            Across(at=0.0, colour=GREY),
            *whirl,
            Trace(x=frequency[at].tolist(), y=share[at].tolist(), colour=BLUE, width=0.8),
        ),
    )
