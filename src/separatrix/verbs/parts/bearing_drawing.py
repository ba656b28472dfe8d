"""The bearing to scale: a section through its axis, with ball, races, cage, pocket and land.

What the study does not state is drawn in dashes, at the proportions of a common bearing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from separatrix.ground.document import Part
from separatrix.ground.units import Array, Metre, Radian
from separatrix.present.blocks import Picture
from separatrix.present.figure import GREY, VERMILION, Axis, Mark, Panel, Trace
from separatrix.present.quantity_text import show
from separatrix.verbs.parts.answer_page import entry_words, figure, stated

STEEL, BALL, CAGE = "#c9ced6", "#eef1f5", "#e8c27a"
SHOULDER, WALL, WIDTH, CAGE_WIDTH = 0.3, 0.22, 1.5, 1.36
"""Height of a land above the groove, thickness of a cage, width of a ring and of a cage over the ball's
diameter, where the study states none."""

RINGS = "inner", "outer"


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """What is drawn; pairs are of the inner and the outer ring."""

    ball: Metre  # radius
    centre: Metre  # radius of the pitch circle
    grooves: tuple[Metre, Metre]  # radii of curvature
    lands: tuple[Metre, Metre]  # radii
    rims: tuple[Metre, Metre]  # radii of bore and outside
    cage: tuple[Metre, Metre, Metre] | None  # inner and outer radius, half the width
    hole: Metre  # half the size of a pocket along the axis
    is_cage_stated: bool  # whether the study has all sizes of the cage


def section_of(study: Mapping[str, Any]) -> Section:
    """Return the section of a resolved study."""

    def known(section: str, key: str) -> Any:
        return ((study.get(section) or {}).get(key) or {}).get("value")

    def half(section: str, key: str) -> Metre | None:
        size = known(section, key)
        return None if size is None else size / 2

    diameter, gap = known("bearing", "ball_diameter"), half("cage", "land_clearance") or 0.0
    r, centre, guidance = diameter / 2, known("bearing", "pitch_diameter") / 2, known("cage", "guidance")
    inner_land, outer_land = centre - r + SHOULDER * diameter, centre + r - SHOULDER * diameter
    cage, sizes = None, [half("cage", key) for key in ("inner_diameter", "outer_diameter", "width")]
    if study.get("cage"):
        inner, outer, width = sizes
        wall = WALL * diameter
        usual = {"inner": inner_land + gap, "outer": outer_land - gap - wall}
        if inner is None:
            inner = usual.get(guidance, centre - wall / 2) if outer is None else outer - wall
        cage = inner, inner + wall if outer is None else outer, width or CAGE_WIDTH * r
        inner_land = cage[0] - gap if guidance == "inner" else inner_land
        outer_land = cage[1] + gap if guidance == "outer" else outer_land
    bore = half("bearing", "bore") or centre - diameter
    play = known("cage", "pocket_axial_clearance") or known("cage", "pocket_clearance") or 0.0
    inner_groove, outer_groove = (diameter * known("bearing", f"{ring}_conformity") for ring in RINGS)
    return Section(
        ball=r,
        centre=centre,
        grooves=(inner_groove, outer_groove),
        lands=(inner_land, outer_land),
        rims=(bore, 2 * centre - bore),
        cage=cage,
        hole=r + play / 2,
        is_cage_stated=None not in sizes,
    )


def bearing_picture(answer: Part, contacts: Part | None) -> Picture:
    """Return the bearing of an answer's study to scale; `contacts` have the angles under load, if known."""
    study = answer.values["study"]
    of, nominal = section_of(study), study["bearing"]["contact_angle"]
    angles, words = [nominal["value"]] * 2, f"{entry_words(nominal)} without load"
    if contacts is not None:
        both = contacts.inner, contacts.outer
        angles = [one.contact_angle for one in both]
        words = " inner, ".join(show(one, "contact_angle") for one in both) + " outer"
    sizes = [f"contact angle {words}"]
    for name in ("bearing.ball_diameter", "cage.pocket_clearance", "cage.land_clearance"):
        section, _, key = name.partition(".")
        text = stated(study, section, key)
        sizes += [f"{key.replace('_', ' ')} {text}"] if text else []
    dashed = "Dashed: at common proportions, where the study states no size"
    caption = f"Section through the axis, to scale: {', '.join(sizes)}. {dashed}."
    return Picture("bearing", lambda: figure(answer, (section_panel(of, angles),), height=3.4), caption)


def section_panel(of: Section, angles: Sequence[Radian]) -> Panel:
    """Return the section with the lines of contact."""
    r, half = of.ball, max(WIDTH * of.ball, 1.1 * of.cage[2] if of.cage else 0.0)
    marks: list[Mark] = []
    for side, alpha, groove, land, rim in zip((-1, 1), angles, of.grooves, of.lands, of.rims, strict=True):
        away, x = groove - r, np.linspace(-half, half, 401)
        middle = of.centre - side * away * np.cos(alpha)
        depth = np.sqrt(np.maximum(groove**2 - (x + side * away * np.sin(alpha)) ** 2, 0.0))
        surface = side * np.maximum(side * land, side * middle + depth)
        marks.append(_area([-half, *x, half], [rim, *surface, rim], STEEL, "--"))
        in_groove = side * surface > side * land
        marks.append(Trace(x=x[in_groove].tolist(), y=surface[in_groove].tolist(), width=0.8))
    turns = np.linspace(0.0, 2 * np.pi, 121)
    marks.append(_area(r * np.sin(turns), of.centre + r * np.cos(turns), BALL))
    if of.cage is not None:
        low, high, width = of.cage
        rim = max(width, 1.06 * of.hole)
        for side in (-1, 1):
            across = [side * of.hole, side * rim, side * rim, side * of.hole]
            outline = "-" if of.is_cage_stated else "--"
            marks.append(_area(across, [low, low, high, high], CAGE, outline))
    for side, alpha in zip((-1, 1), angles, strict=True):
        ends = [0.0, side * r * np.sin(alpha)], [of.centre, of.centre + side * r * np.cos(alpha)]
        marks.append(Trace(x=ends[0], y=ends[1], colour=VERMILION, marker="o", size=2.5))
    marks.append(Trace(x=[-half, half], y=[of.centre] * 2, colour=GREY, line="-.", width=0.5))
    return Panel(
        title="Section",
        x=Axis(label="along the axis [mm]", size=1e-3, low=-1.1 * half, high=1.1 * half),
        y=Axis(label="radius [mm]", size=1e-3, low=of.rims[0] - 0.4 * r, high=of.rims[1] + 0.4 * r),
        marks=tuple(marks),
        is_to_scale=True,
    )


def _area(x: Array | list[Metre], y: Array | list[Metre], face: str, line: str = "-") -> Trace:
    """Return a closed outline with a colour inside."""
    return Trace(x=[*x, x[0]], y=[*y, y[0]], face=face, line=line, width=0.8)
