"""The bearing and its cage to scale: a section through the axis, the view along it, and one pocket enlarged.

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
from separatrix.present.figure import BLACK, BLUE, GREY, VERMILION, Axis, Figure, Mark, Panel, Trace, Words
from separatrix.verbs.parts.answer_page import figure_heading
from separatrix.verbs.parts.telling import told

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
    """What is drawn [m]; a cage has inner and outer radius and half its width.

    `guessed` names what the study does not state.
    """

    ball: Metre
    pitch: Metre
    count: int
    inner_groove: Metre
    outer_groove: Metre
    bore: Metre
    outside: Metre
    ring_width: Metre
    inner_land: Metre
    outer_land: Metre
    cage: tuple[Metre, Metre, Metre] | None
    pocket_clearance: Metre
    land_clearance: Metre | None
    guidance: str
    pocket_angles: tuple[Radian, ...]
    guessed: frozenset[str]

    def line(self, *parts: str) -> str:
        """Return the line around a part: dashed where it is guessed."""
        return "--" if self.guessed.intersection(parts) else "-"


def bearing_picture(answer: Part, contacts: Part | None) -> Picture:
    """Return the bearing of an answer's study to scale; `contacts` have the angles under load, if known."""
    study = answer.values["study"]
    guessed = "; ".join(words for key, words in GUESSES.items() if key in shape_of(study).guessed)
    note = f" Dashed, at common proportions because the study does not state them: {guessed}."
    caption = "Bearing and cage to scale: a section, the view along the axis, and one pocket." + (
        note if guessed else ""
    )
    return Picture("bearing", lambda: drawing(answer, contacts), caption)


def drawing(answer: Part, contacts: Part | None) -> Figure:
    """Return the three views."""
    of = shape_of(answer.values["study"])
    return Figure(
        rows=((_section(of, answer, contacts), _view(of), _pocket(of)),),
        heading=figure_heading(answer),
        height=3.2,
        widths=(1.0, 1.25, 1.05),
        alt="Three drawings to scale: a section through the axis, the ring of balls, and one pocket.",
    )


def shape_of(study: Mapping[str, Any]) -> Shape:
    """Return the shapes of a resolved study."""

    def known(section: str, key: str) -> Any:
        return ((study.get(section) or {}).get(key) or {}).get("value")

    D, dm = known("bearing", "ball_diameter"), known("bearing", "pitch_diameter")
    lands = {"inner": dm / 2 - D / 2 + SHOULDER * D, "outer": dm / 2 + D / 2 - SHOULDER * D}
    guessed, cage = {"rings"}, None
    guidance, gap = str(known("cage", "guidance") or ""), known("cage", "land_clearance")
    if study.get("cage"):
        sizes = [known("cage", key) for key in ("inner_diameter", "outer_diameter", "width")]
        half = [None if one is None else one / 2 for one in sizes]
        cage = _cage(half, lands, guidance, gap or 0.0, D, dm)
        guessed |= {"cage"} if None in sizes else set()
        if sizes[0] is not None and sizes[1] is not None and gap is not None and guidance in lands:
            lands[guidance] = cage[1] + gap / 2 if guidance == "outer" else cage[0] - gap / 2
    count, bore = int(known("bearing", "ball_count")), known("bearing", "bore")
    if not 1 <= count <= MOST_BALLS:
        raise ValueError(f"{count} balls cannot be drawn")
    guessed |= {"bore"} if bore is None else set()
    inside = bore / 2 if bore else dm / 2 - D
    return Shape(
        ball=D,
        pitch=dm,
        count=count,
        inner_groove=D * known("bearing", "inner_conformity"),
        outer_groove=D * known("bearing", "outer_conformity"),
        bore=inside,
        outside=dm - inside,
        ring_width=max(WIDTH * D, 2.2 * cage[2] if cage else 0.0),
        inner_land=lands["inner"],
        outer_land=lands["outer"],
        cage=cage,
        pocket_clearance=known("cage", "pocket_clearance") or 0.0,
        land_clearance=gap,
        guidance=guidance,
        pocket_angles=tuple(known("cage", "pocket_angles") or ()),
        guessed=frozenset(guessed),
    )


def _cage(
    half: Sequence[Metre | None], lands: Mapping[str, Metre], guidance: str, gap: Metre, D: Metre, dm: Metre
) -> tuple[Metre, Metre, Metre]:
    """Return inner and outer radius and half the width of a cage; what is not stated is common."""
    wall = WALL * D
    usual = {
        "outer": (lands["outer"] - gap / 2 - wall, lands["outer"] - gap / 2),
        "inner": (lands["inner"] + gap / 2, lands["inner"] + gap / 2 + wall),
    }.get(guidance, (dm / 2 - wall / 2, dm / 2 + wall / 2))
    if half[0] is not None and half[1] is None:
        usual = half[0], half[0] + wall
    if half[1] is not None and half[0] is None:
        usual = half[1] - wall, half[1]
    inner, outer = (usual[i] if half[i] is None else half[i] or 0.0 for i in (0, 1))
    return inner, outer, half[2] if half[2] is not None else 0.68 * D


def _section(of: Shape, answer: Part, contacts: Part | None) -> Panel:
    """Return a section through the axis, with the lines of contact."""
    centre, r, half = of.pitch / 2, of.ball / 2, of.ring_width / 2
    bearing = answer.values["study"]["bearing"]
    nominal = bearing["contact_angle"]["value"]
    inner, outer = (
        (nominal, nominal)
        if contacts is None
        else (contacts.inner.contact_angle, contacts.outer.contact_angle)
    )
    marks: list[Mark] = []
    for groove, sign, land, rim, alpha in (
        (of.inner_groove, -1, of.inner_land, of.bore, inner),
        (of.outer_groove, 1, of.outer_land, of.outside, outer),
    ):
        profile = _groove(
            half,
            groove,
            (-sign * (groove - r) * sin(alpha), centre - sign * (groove - r) * cos(alpha)),
            sign,
            land,
        )
        marks.append(_area([(-half, rim), *profile, (half, rim)], STEEL, of.line("rings")))
    marks.append(_area(_circle((0.0, centre), r), BALL))
    if of.cage is not None:
        low, high, end = of.cage
        hole = r + of.pocket_clearance / 2
        width = max(end - hole, 0.12 * r)
        for start in (hole, -hole - width):
            corners = [(start, low), (start + width, low), (start + width, high), (start, high)]
            marks.append(_area(corners, CAGE, of.line("cage")))
    marks.append(_line([(0.0, centre - 1.3 * r), (0.0, centre + 1.3 * r)], GREY, "-.", 0.5))
    for sign, alpha in ((-1, inner), (1, outer)):
        along, up = r * sin(alpha) * sign, r * cos(alpha) * sign
        marks.append(_line([(0.0, centre), (1.25 * along, centre + 1.25 * up)], VERMILION, "-", 1.0))
        marks.append(Trace(x=[along], y=[centre + up], colour=VERMILION, line="", marker="o", size=2.5))
    turned = (
        [0.65 * r * sin(outer * i / 20) for i in range(21)],
        [0.65 * r * cos(outer * i / 20) for i in range(21)],
    )
    marks.append(_line([(x, centre + y) for x, y in zip(*turned, strict=True)], VERMILION, "-", 0.8))
    marks += _scale(of.ball, -half, of.bore - 0.5 * r)
    angle = f"contact angle {_of_study(bearing['contact_angle'])}, without load"
    if contacts is not None:
        angles = (told(one, "contact_angle") for one in (contacts.inner, contacts.outer))
        angle = f"contact angle {' inner, '.join(angles)} outer"
    found = [f"{bearing[f'{race}_conformity']['value']:.3g} D" for race in ("inner", "outer")]
    grooves = found[0] if found[0] == found[1] else f"{found[0]} inner, {found[1]} outer"
    words = [angle, f"D = {_length(of.ball)}, groove radius {grooves}"]
    ends = (-half - 0.3 * r, half + 0.3 * r), (of.bore - 1.1 * r, of.outside + 0.4 * r)
    return _drawn("a  Section", words, marks, *ends)


def _groove(half: Metre, groove: Metre, middle: Point, sign: int, land: Metre) -> Iterator[Point]:
    """Yield the surface of a ring from one side to the other: its land, and the groove in it."""
    for i in range(401):
        x = half * (i / 200.0 - 1.0)
        inside = groove**2 - (x - middle[0]) ** 2
        bottom = middle[1] + sign * sqrt(max(inside, 0.0))
        yield x, land if inside <= 0.0 else min(land, bottom) if sign < 0 else max(land, bottom)


def _view(of: Shape) -> Panel:
    """Return the rings, the cage and the balls along the axis."""
    middle, r = of.pitch / 2, of.ball / 2
    marks: list[Mark] = []
    for low, high, part in ((of.bore, middle - r, "bore"), (middle + r, of.outside, "rings")):
        marks.append(_face([*_circle((0.0, 0.0), high), *reversed(_circle((0.0, 0.0), low))], STEEL))
        for radius, is_guess in ((low, part == "bore"), (high, part == "rings")):
            marks.append(_line(_circle((0.0, 0.0), radius), BLACK, of.line(part) if is_guess else "-", 0.8))
    angles = list(of.pocket_angles)
    if len(angles) != of.count:
        angles = [2 * pi * i / of.count for i in range(of.count)]
    if of.cage is not None:
        half = asin(min(1.0, (of.ball + of.pocket_clearance) / of.pitch))
        for one, following in zip(angles, [*angles[1:], angles[0] + 2 * pi], strict=True):
            if following - one > 2 * half:
                sector = _sector(*of.cage[:2], one + half, following - half)
                marks.append(_area(sector, CAGE, of.line("cage")))
    marks += [_area(_circle((middle * sin(at), middle * cos(at)), r), BALL) for at in angles]
    marks.append(_line(_circle((0.0, 0.0), middle), GREY, "-.", 0.5))
    words = f"{of.count} balls, pitch diameter {_length(of.pitch)}"
    words += "" if "bore" in of.guessed else f", bore {_length(2 * of.bore)}"
    reach = 1.04 * of.outside
    marks += _scale(_round(of.pitch / 3), -reach, -reach - 0.4 * r)
    return _drawn("b  Along the axis", [words], marks, (-reach, reach), (-reach - 1.2 * r, reach))


def _pocket(of: Shape) -> Panel:
    """Return one ball in its pocket and the land beside it, with their clearances."""
    middle, r = of.pitch / 2, of.ball / 2
    span = 1.75 * r
    turn = span / middle
    rings = (of.outer_land, middle + 1.5 * r), (middle - 1.5 * r, of.inner_land)
    marks: list[Mark] = [_area(_sector(*ends, -turn, turn), STEEL, of.line("rings")) for ends in rings]
    words = []
    if of.cage is not None:
        low, high, _ = of.cage
        hole = r + of.pocket_clearance / 2
        edge = hole / middle
        parts = ((-turn, -edge), (edge, turn))
        marks += [_area(_sector(low, high, *ends), CAGE, of.line("cage")) for ends in parts]
        each = f"{_length(of.pocket_clearance)}: {_length(of.pocket_clearance / 2)} each way"
        words.append(f"pocket clearance {each}")
        marks.append(_line([(r, middle), (hole, middle)], BLUE, "-", 2.2))
        if of.land_clearance is not None and of.guidance in ("inner", "outer"):
            place = -1.25 * r
            ends = (high, of.outer_land) if of.guidance == "outer" else (of.inner_land, low)
            heights = [sqrt(max(one**2 - place**2, 0.0)) for one in ends]
            marks.append(_line([(place, one) for one in heights], BLUE, "-", 2.2))
            radial = f"{_length(of.land_clearance)}: {_length(of.land_clearance / 2)} radial"
            words.append(f"{of.guidance} land clearance {radial}")
        else:
            words.append("guided by the balls: no land")
    marks.append(_area(_circle((0.0, middle), r), BALL))
    marks += _scale(_round(of.ball / 3), -span, middle - 1.95 * r)
    title = "c  One pocket" if of.cage is not None else "c  One ball"
    return _drawn(title, words, marks, (-span, span), (middle - 2.15 * r, middle + 1.75 * r))


def _drawn(title: str, words: Sequence[str], marks: Sequence[Mark], across: Point, up: Point) -> Panel:
    """Return a panel to scale without a frame, with lines below it."""
    x = Axis(label="\n".join(words), low=across[0], high=across[1], has_ticks=False)
    y = Axis(label="", low=up[0], high=up[1], has_ticks=False)
    return Panel(title=title, x=x, y=y, marks=tuple(marks), is_to_scale=True, has_frame=False)


def _area(points: Sequence[Point], face: str, line: str = "-") -> Trace:
    """Return a closed outline with a colour inside."""
    x, y = zip(*points, points[0], strict=True)
    return Trace(x=x, y=y, face=face, line=line, width=0.8)


def _face(points: Sequence[Point], face: str) -> Trace:
    """Return a colour without an outline."""
    x, y = zip(*points, strict=True)
    return Trace(x=x, y=y, face=face, line="", width=0.0)


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


def _round(length: Metre) -> Metre:
    """Return the largest of 1, 2, 5, 10, ... not above a length."""
    power = 10.0 ** floor(log10(length))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length)


def _length(length: Metre) -> str:
    return alone(length, LENGTH, "m")


def _of_study(entry: Mapping[str, Any]) -> str:
    return alone(entry["value"], LENGTH, entry["unit"])
