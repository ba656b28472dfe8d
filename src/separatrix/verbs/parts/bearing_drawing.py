"""The bearing and its cage to scale: a section through the axis, and the view along it.

What the study does not state is drawn in dashes, at the proportions of a common bearing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import asin, cos, floor, log10, pi, sin, sqrt
from typing import Any

from separatrix.ground.document import Part
from separatrix.ground.quantity import Quantity, alone
from separatrix.ground.units import Metre, Radian
from separatrix.present.blocks import Picture
from separatrix.present.figure import BLACK, GREY, VERMILION, Axis, Figure, Mark, Panel, Trace, Words
from separatrix.verbs.parts.answer_page import entry_words, figure
from separatrix.verbs.parts.quantity_text import show

Point = tuple[float, float]

STEEL, BALL, CAGE = "#c9ced6", "#eef1f5", "#e8c27a"
SHOULDER, WALL, WIDTH = 0.3, 0.22, 1.5
"""Height of a land above the groove, thickness of a cage and width of a ring over the ball's diameter, where
the study states none."""

MOST_BALLS = 1000
GUESSES = {"rings": "the rings' width, lands and outside", "bore": "the bore", "cage": "the cage's section"}
LENGTH = Quantity(label="length", digits=7)


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """What is drawn [m]; pairs are of the inner and the outer ring; `guessed` is what the study leaves open.

    A cage has an inner and an outer radius, and half a width.
    """

    ball: Metre  # diameter
    pitch: Metre  # diameter
    grooves: tuple[Metre, Metre]
    lands: tuple[Metre, Metre]
    rims: tuple[Metre, Metre]  # radii of bore and outside
    cage: tuple[Metre, Metre, Metre] | None
    pocket_clearance: Metre
    angles: tuple[Radian, ...]  # of the balls
    guessed: frozenset[str]

    def line(self, *parts: str) -> str:
        """Return the line around a part: dashed where it is guessed."""
        return "--" if self.guessed.intersection(parts) else "-"


def bearing_picture(answer: Part, contacts: Part | None) -> Picture:
    """Return the bearing of an answer's study to scale; `contacts` have the angles under load, if known."""
    of = shape_of(answer.values["study"])
    guessed = "; ".join(words for key, words in GUESSES.items() if key in of.guessed)
    note = f" Dashed, at common proportions because the study does not state them: {guessed}."
    caption = "Bearing and cage to scale: a section, and the view along the axis." + (note if guessed else "")
    alt = "Two drawings to scale: a section through the axis, and the ring of balls in its cage."

    def drawing() -> Figure:
        return figure(answer, (_section(of, answer, contacts), _view(of, answer)), alt=alt, height=3.4)

    return Picture("bearing", drawing, caption)


def shape_of(study: Mapping[str, Any]) -> Shape:
    """Return the shapes of a resolved study."""

    def known(section: str, key: str) -> Any:
        return ((study.get(section) or {}).get(key) or {}).get("value")

    D, dm, count = (known("bearing", key) for key in ("ball_diameter", "pitch_diameter", "ball_count"))
    if not 1 <= count <= MOST_BALLS:
        raise ValueError(f"{count} balls cannot be drawn")
    lands = {"inner": dm / 2 - D / 2 + SHOULDER * D, "outer": dm / 2 + D / 2 - SHOULDER * D}
    bore, gap, guidance = known("bearing", "bore"), known("cage", "land_clearance"), known("cage", "guidance")
    cage, guessed = None, {"rings"} | ({"bore"} if bore is None else set())
    if study.get("cage"):
        sizes = [known("cage", key) for key in ("inner_diameter", "outer_diameter", "width")]
        half = [None if one is None else one / 2 for one in sizes]
        cage = _cage(half, lands, guidance, gap or 0.0, D, dm)
        guessed |= {"cage"} if None in sizes else set()
        if None not in (*sizes[:2], gap) and guidance in lands:
            lands[guidance] = cage[1] + gap / 2 if guidance == "outer" else cage[0] - gap / 2
    inside = bore / 2 if bore else dm / 2 - D
    angles = known("cage", "pocket_angles") or ()
    return Shape(
        ball=D,
        pitch=dm,
        grooves=(D * known("bearing", "inner_conformity"), D * known("bearing", "outer_conformity")),
        lands=(lands["inner"], lands["outer"]),
        rims=(inside, dm - inside),
        cage=cage,
        pocket_clearance=known("cage", "pocket_clearance") or 0.0,
        angles=tuple(angles if len(angles) == count else (2 * pi * i / count for i in range(count))),
        guessed=frozenset(guessed),
    )


def _cage(
    half: Sequence[Metre | None], lands: Mapping[str, Metre], guidance: str, gap: Metre, D: Metre, dm: Metre
) -> tuple[Metre, Metre, Metre]:
    """Return inner and outer radius and half the width of a cage; what is not stated is common."""
    wall, (inner, outer, width) = WALL * D, half
    usual = {"outer": lands["outer"] - gap / 2 - wall, "inner": lands["inner"] + gap / 2}
    if inner is None:
        inner = usual.get(guidance, dm / 2 - wall / 2) if outer is None else outer - wall
    return inner, inner + wall if outer is None else outer, 0.68 * D if width is None else width


def _section(of: Shape, answer: Part, contacts: Part | None) -> Panel:
    """Return a section through the axis, with the lines of contact."""
    centre, r, bearing = of.pitch / 2, of.ball / 2, answer.values["study"]["bearing"]
    half = max(WIDTH * r, 1.1 * of.cage[2] if of.cage else 0.0)
    found = [bearing[f"{race}_conformity"]["value"] for race in ("inner", "outer")]
    grooves = " inner, ".join(f"{one:.3g} D" for one in dict.fromkeys(found))
    nominal = bearing["contact_angle"]
    angles = [nominal["value"]] * 2
    words = f"{alone(nominal['value'], LENGTH, nominal['unit'])}, without load"
    if contacts is not None:
        both = contacts.inner, contacts.outer
        angles = [one.contact_angle for one in both]
        words = " inner, ".join(show(one, "contact_angle") for one in both) + " outer"
    marks: list[Mark] = []
    for sign, alpha, groove, land, rim in zip((-1, 1), angles, of.grooves, of.lands, of.rims, strict=True):
        middle = -sign * (groove - r) * sin(alpha), centre - sign * (groove - r) * cos(alpha)
        profile = _groove(half, groove, middle, sign, land)
        marks.append(_area([(-half, rim), *profile, (half, rim)], STEEL, of.line("rings")))
    marks.append(_area(_circle((0.0, centre), r), BALL))
    if of.cage is not None:
        low, high, end = of.cage
        hole = r + of.pocket_clearance / 2
        for a, b in ((hole, max(end, hole + 0.12 * r)), (-max(end, hole + 0.12 * r), -hole)):
            marks.append(_area([(a, low), (b, low), (b, high), (a, high)], CAGE, of.line("cage")))
    marks.append(_line([(0.0, centre - 1.3 * r), (0.0, centre + 1.3 * r)], GREY, "-.", 0.5))
    for sign, alpha in zip((-1, 1), angles, strict=True):
        along, up = r * sin(alpha) * sign, r * cos(alpha) * sign
        marks.append(_line([(0.0, centre), (1.25 * along, centre + 1.25 * up)], VERMILION, "-", 1.0))
        marks.append(Trace(x=[along], y=[centre + up], colour=VERMILION, line="", marker="o", size=2.5))
    marks += _scale(of.ball, -half, of.rims[0] - 0.5 * r)
    label = f"contact angle {words}\nD = {_length(of.ball)}, groove radius {grooves}"
    ends = (-half - 0.3 * r, half + 0.3 * r), (of.rims[0] - 1.1 * r, of.rims[1] + 0.4 * r)
    return _drawn("a  Section", label, marks, *ends)


def _groove(half: Metre, groove: Metre, middle: Point, sign: int, land: Metre) -> Iterator[Point]:
    """Yield the surface of a ring from one side to the other: its land, and the groove in it."""
    for i in range(401):
        x = half * (i / 200.0 - 1.0)
        inside = groove**2 - (x - middle[0]) ** 2
        bottom = middle[1] + sign * sqrt(max(inside, 0.0))
        yield x, land if inside <= 0.0 else min(land, bottom) if sign < 0 else max(land, bottom)


def _view(of: Shape, answer: Part) -> Panel:
    """Return the rings, the cage and the balls along the axis, and what the study states of their sizes."""
    middle, r, (bore, outside) = of.pitch / 2, of.ball / 2, of.rims
    marks: list[Mark] = [
        _area(_circle((0.0, 0.0), outside), STEEL, of.line("rings")),
        _area(_circle((0.0, 0.0), middle + r), "#ffffff"),
        _area(_circle((0.0, 0.0), middle - r), STEEL),
        _area(_circle((0.0, 0.0), bore), "#ffffff", of.line("bore")),
    ]
    if of.cage is not None:
        half = asin(min(1.0, (of.ball + of.pocket_clearance) / of.pitch))
        for one, following in zip(of.angles, [*of.angles[1:], of.angles[0] + 2 * pi], strict=True):
            if following - one > 2 * half:
                sector = _sector(*of.cage[:2], one + half, following - half)
                marks.append(_area(sector, CAGE, of.line("cage")))
    marks += [_area(_circle((middle * sin(at), middle * cos(at)), r), BALL) for at in of.angles]
    marks.append(_line(_circle((0.0, 0.0), middle), GREY, "-.", 0.5))
    words = f"{len(of.angles)} balls, pitch diameter {_length(of.pitch)}"
    words += "" if "bore" in of.guessed else f", bore {_length(2 * bore)}"
    stated, reach = answer.values["study"].get("cage"), 1.04 * outside
    if stated:
        guidance, gap = stated["guidance"]["value"], "no land"
        if stated["land_clearance"]["value"] is not None and guidance != "ball":
            gap = f"{guidance} land {entry_words(stated['land_clearance'])}"
        words += f"\nclearances: pocket {entry_words(stated['pocket_clearance'])}, {gap}"
    power = 10.0 ** floor(log10(of.pitch / 3))
    bar = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= of.pitch / 3)
    marks += _scale(bar, -reach, -reach - 0.4 * r)
    return _drawn("b  Along the axis", words, marks, (-reach, reach), (-reach - 1.2 * r, reach))


def _drawn(title: str, words: str, marks: Sequence[Mark], across: Point, up: Point) -> Panel:
    """Return a panel to scale without a frame, with words below it."""
    x = Axis(label=words, low=across[0], high=across[1], has_ticks=False)
    y = Axis(label="", low=up[0], high=up[1], has_ticks=False)
    return Panel(title=title, x=x, y=y, marks=tuple(marks), is_to_scale=True, has_frame=False)


def _area(points: Sequence[Point], face: str, line: str = "-") -> Trace:
    """Return a closed outline with a colour inside."""
    x, y = zip(*points, points[0], strict=True)
    return Trace(x=x, y=y, face=face, line=line, width=0.8)


def _line(points: Sequence[Point], colour: str, line: str, width: float) -> Trace:
    x, y = zip(*points, strict=True)
    return Trace(x=x, y=y, colour=colour, line=line, width=width)


def _circle(middle: Point, radius: Metre) -> list[Point]:
    turns = [2 * pi * i / 120 for i in range(121)]
    return [(middle[0] + radius * sin(one), middle[1] + radius * cos(one)) for one in turns]


def _sector(low: Metre, high: Metre, start: Radian, end: Radian) -> list[Point]:
    """Return the area between two circles at these angles from the vertical."""
    turns = [start + (end - start) * i / 40 for i in range(41)]
    outside = [(high * sin(one), high * cos(one)) for one in turns]
    return outside + [(low * sin(one), low * cos(one)) for one in reversed(turns)]


def _scale(length: Metre, x: Metre, y: Metre) -> list[Mark]:
    """Return a bar of a length, with the length written beside it."""
    bar = _line([(x, y), (x + length, y)], BLACK, "-", 1.6)
    return [bar, Words(x=x + length, y=y, text=_length(length))]


def _length(length: Metre) -> str:
    return alone(length, LENGTH, "m")
