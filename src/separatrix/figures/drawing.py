"""The bearing and its cage to scale: a section through the axis, the view along it, and one pocket enlarged.

What the study does not state is drawn in dashes, at the proportions of a common bearing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, degrees, sin, sqrt

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon, Rectangle, Wedge

from separatrix.figures.style import BLACK, BLUE, GREY, PAGE, VERMILION, Json, Look, canvas, stated
from separatrix.ground.units import Array, Metre, Radian, format_quantity

STEEL, BALL, CAGE = "#c9ced6", "#eef1f5", "#e8c27a"
DASHED: Look = {"ls": (0, (3, 2)), "lw": 0.8}
DOT_DASHED = (0, (6, 2, 1, 2))
SOLID: Look = {"ls": "-", "lw": 0.8}
SHOULDER, WALL, WIDTH = 0.3, 0.22, 1.5
"""Height of a land above the groove, thickness of a cage and width of a ring over the ball's diameter, where
the study states none."""

MOST_BALLS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """What is drawn, all in millimetres; `guessed` names what the study does not state."""

    ball: float
    pitch: float
    count: int
    inner_groove: float
    outer_groove: float
    bore: float
    outside: float
    ring_width: float
    inner_land: float
    outer_land: float
    cage: tuple[float, float, float] | None = None
    pocket_clearance: float = 0.0
    land_clearance: float | None = None
    guidance: str = ""
    pocket_angles: tuple[Radian, ...] = ()
    guessed: frozenset[str] = frozenset()


def shape_of(study: Json) -> Shape:
    """Return the shapes of a resolved study, as documents and datasets have it."""

    def known(section: str, key: str) -> float | None:
        value = stated(study, section, key)
        return None if value is None else 1e3 * float(value)

    D, dm = known("bearing", "ball_diameter") or 0.0, known("bearing", "pitch_diameter") or 0.0
    grooves = [D * (known("bearing", f"{race}_conformity") or 520.0) / 1e3 for race in ("inner", "outer")]
    lands = {"inner": dm / 2 - D / 2 + SHOULDER * D, "outer": dm / 2 + D / 2 - SHOULDER * D}
    guessed, cage = {"rings"}, None
    guidance = str(stated(study, "cage", "guidance") or "")
    gap = known("cage", "land_clearance")
    if study.get("cage"):
        sizes = [known("cage", key) for key in ("inner_diameter", "outer_diameter", "width")]
        cage = _cage([None if one is None else one / 2 for one in sizes], lands, guidance, gap or 0.0, D, dm)
        guessed |= {"cage"} if None in sizes else set()
        if sizes[0] is not None and sizes[1] is not None and gap is not None and guidance in lands:
            lands[guidance] = cage[1] + gap / 2 if guidance == "outer" else cage[0] - gap / 2
    count = int(study["bearing"]["ball_count"]["value"])
    if not 1 <= count <= MOST_BALLS:
        raise ValueError(f"{count} balls cannot be drawn")
    bore = known("bearing", "bore")
    guessed |= {"bore"} if bore is None else set()
    inside = bore / 2 if bore else dm / 2 - D
    angles = stated(study, "cage", "pocket_angles") or ()
    return Shape(
        ball=D,
        pitch=dm,
        count=count,
        inner_groove=grooves[0],
        outer_groove=grooves[1],
        bore=inside,
        outside=dm - inside,
        ring_width=max(WIDTH * D, 2.2 * cage[2] if cage else 0.0),
        inner_land=lands["inner"],
        outer_land=lands["outer"],
        cage=cage,
        pocket_clearance=known("cage", "pocket_clearance") or 0.0,
        land_clearance=gap,
        guidance=guidance,
        pocket_angles=tuple(float(one) for one in angles),
        guessed=frozenset(guessed),
    )


def _cage(
    half: list[float | None], lands: Mapping[str, float], guidance: str, gap: float, D: float, dm: float
) -> tuple[float, float, float]:
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


def bearing_drawing(study: Json, angle: tuple[Radian, Radian] | None = None) -> Figure:
    """Draw a bearing and its cage to scale, from the resolved study of a document.

    `angle` has the contact angles at the inner and the outer race under load; by default that of the study.
    """
    of, nominal = shape_of(study), float(study["bearing"]["contact_angle"]["value"])
    inner, outer = angle or (nominal, nominal)
    figure, (section, view, pocket) = canvas(PAGE, 3.2, ncols=3, width_ratios=(1.0, 1.25, 1.05))
    _section(section, of, inner, outer, nominal)
    _view(view, of)
    _pocket(pocket, of)
    for axes in (section, view, pocket):
        axes.set_aspect("equal", anchor="N")
        axes.axis("off")
    return figure


def _line(of: Shape, *parts: str) -> Look:
    return DASHED if of.guessed.intersection(parts) else SOLID


def _section(axes: Axes, of: Shape, inner: Radian, outer: Radian, nominal: Radian) -> None:
    centre, r, half = of.pitch / 2, of.ball / 2, of.ring_width / 2
    x = np.linspace(-half, half, 401)
    for groove, sign, land, rim, alpha in (
        (of.inner_groove, -1, of.inner_land, of.bore, inner),
        (of.outer_groove, 1, of.outer_land, of.outside, outer),
    ):
        off = groove - r
        cx, cy = -sign * off * sin(alpha), centre - sign * off * cos(alpha)
        inside = np.sqrt(np.maximum(groove**2 - (x - cx) ** 2, 0.0))
        bottom = cy + sign * inside
        profile = np.minimum(land, bottom) if sign < 0 else np.maximum(land, bottom)
        profile = np.where(np.abs(x - cx) < groove, profile, land)
        outline = [(-half, rim), *zip(x, profile, strict=True), (half, rim)]
        axes.add_patch(Polygon(outline, fc=STEEL, ec=BLACK, **_line(of, "rings")))
    axes.add_patch(Circle((0, centre), r, fc=BALL, ec=BLACK, lw=0.9))
    if of.cage is not None:
        low, high, end = of.cage
        hole = r + of.pocket_clearance / 2
        for side in (-1, 1):
            width = max(end - hole, 0.12 * r)
            start = hole if side > 0 else -hole - width
            look = _line(of, "cage")
            axes.add_patch(Rectangle((start, low), width, high - low, fc=CAGE, ec=BLACK, zorder=3, **look))
    for sign, alpha in ((-1, inner), (1, outer)):
        along, up = r * sin(alpha) * sign, r * cos(alpha) * sign
        axes.plot([0, 1.25 * along], [centre, centre + 1.25 * up], color=VERMILION, lw=1.0, zorder=5)
        axes.plot(along, centre + up, "o", color=VERMILION, ms=2.5, zorder=6)
    ends = [centre - 1.3 * r, centre + 1.3 * r]
    axes.plot([0, 0], ends, color=GREY, lw=0.5, ls=DOT_DASHED, zorder=4)
    arc = Arc((0, centre), 1.3 * r, 1.3 * r, theta1=90 - degrees(outer), theta2=90, color=VERMILION, lw=0.8)
    axes.add_patch(arc)
    arc.set_zorder(6)
    words = rf"$\alpha$ = {degrees(inner):.1f}$\degree$ inner, {degrees(outer):.1f}$\degree$ outer"
    if (inner, outer) == (nominal, nominal):
        words = rf"$\alpha$ = {degrees(nominal):.1f}$\degree$, without load"
    grooves = dict.fromkeys(f"{groove / of.ball:.3g} D" for groove in (of.inner_groove, of.outer_groove))
    _caption(axes, "a  Section", [words, f"D = {_mm(of.ball)}, grooves {', '.join(grooves)}"])
    axes.set(xlim=(-half - 0.3 * r, half + 0.3 * r), ylim=(of.bore - 1.1 * r, of.outside + 0.4 * r))
    _scale(axes, of.ball, -half, of.bore - 0.5 * r)


def _view(axes: Axes, of: Shape) -> None:
    middle, r = of.pitch / 2, of.ball / 2
    rings = ((of.bore, middle - r, "bore"), (middle + r, of.outside, "rings"))
    for low, high, part in rings:
        axes.add_patch(Wedge((0, 0), high, 0, 360, width=high - low, fc=STEEL, ec="none"))
        for radius, guess in ((low, part == "bore"), (high, part == "rings")):
            look = _line(of, part) if guess else SOLID
            axes.add_patch(Circle((0, 0), radius, fc="none", ec=BLACK, **look))
    angles = np.linspace(0.0, 2 * np.pi, of.count, endpoint=False).tolist()
    if len(of.pocket_angles) == of.count:
        angles = list(of.pocket_angles)
    if of.cage is not None:
        low, high, _ = of.cage
        cage_look = {"fc": CAGE, "zorder": 3, **_line(of, "cage")}
        half = np.arcsin(min(1.0, (of.ball + of.pocket_clearance) / of.pitch))
        for one, following in zip(angles, [*angles[1:], angles[0] + 2 * np.pi], strict=True):
            if following - one > 2 * half:
                turn = np.linspace(one + half, following - half, 24)
                _sector(axes, low, high, turn, cage_look)
    for at in angles:
        axes.add_patch(Circle((middle * sin(at), middle * cos(at)), r, fc=BALL, ec=BLACK, lw=0.7, zorder=4))
    axes.add_patch(Circle((0, 0), middle, fc="none", ec=GREY, lw=0.5, ls=DOT_DASHED, zorder=5))
    facts = [f"{of.count} balls, pitch diameter {_mm(of.pitch)}"]
    facts += [] if "bore" in of.guessed else [f"bore {_mm(2 * of.bore)}"]
    _caption(axes, "b  Along the axis", [", ".join(facts)])
    reach = 1.04 * of.outside
    axes.set(xlim=(-reach, reach), ylim=(-reach - 1.2 * r, reach))
    _scale(axes, _round(of.pitch / 3), -reach, -reach - 0.4 * r)


def _sector(axes: Axes, low: float, high: float, turn: Array, look: Look) -> None:
    """Draw the area between two circles at these angles from the vertical."""
    around = np.stack([np.sin(turn), np.cos(turn)], axis=1)
    axes.add_patch(Polygon(np.concatenate([high * around, low * around[::-1]]), ec=BLACK, **look))


def _pocket(axes: Axes, of: Shape) -> None:
    """Draw one ball in its pocket and the land beside it, with their clearances."""
    middle, r = of.pitch / 2, of.ball / 2
    span = 1.75 * r
    turn = np.linspace(-span / middle, span / middle, 200)
    _sector(axes, of.outer_land, middle + 1.5 * r, turn, {"fc": STEEL, **_line(of, "rings")})
    _sector(axes, middle - 1.5 * r, of.inner_land, turn, {"fc": STEEL, **_line(of, "rings")})
    words = []
    if of.cage is not None:
        low, high, _ = of.cage
        hole = r + of.pocket_clearance / 2
        edge = hole / middle
        cage_look = {"fc": CAGE, "zorder": 3, **_line(of, "cage")}
        for start, end in ((turn[0], -edge), (edge, turn[-1])):
            part = np.linspace(start, end, 60)
            _sector(axes, low, high, part, cage_look)
        words.append(f"pocket clearance {_mm(of.pocket_clearance)}: {_mm(of.pocket_clearance / 2)} each way")
        _gap(axes, (r, middle), (hole, middle))
        if of.land_clearance is not None and of.guidance in ("inner", "outer"):
            place = -1.25 * r
            ends = (high, of.outer_land) if of.guidance == "outer" else (of.inner_land, low)
            _gap(axes, *((place, sqrt(max(one**2 - place**2, 0.0))) for one in ends))
            radial = f"{_mm(of.land_clearance)}: {_mm(of.land_clearance / 2)} radial"
            words.append(f"{of.guidance} land clearance {radial}")
        else:
            words.append("guided by the balls: no land")
    axes.add_patch(Circle((0, middle), r, fc=BALL, ec=BLACK, lw=0.9, zorder=4))
    title = "c  One pocket" if of.cage is not None else "c  One ball"
    _caption(axes, title, words)
    axes.set(xlim=(-span, span), ylim=(middle - 2.15 * r, middle + 1.75 * r))
    _scale(axes, _round(of.ball / 3), -span, middle - 1.95 * r)


def _gap(axes: Axes, first: tuple[float, float], second: tuple[float, float]) -> None:
    axes.plot(*zip(first, second, strict=True), color=BLUE, lw=2.2, zorder=6, solid_capstyle="butt")


def _scale(axes: Axes, length: float, x: float, y: float) -> None:
    """Draw a bar of a length, with its ends and the length written above it."""
    axes.plot([x, x + length], [y, y], color=BLACK, lw=1.6, solid_capstyle="butt")
    look: Look = {"textcoords": "offset points", "fontsize": 6.5, "va": "center"}
    axes.annotate(_mm(length), (x + length, y), xytext=(4, 0), **look)


def _caption(axes: Axes, title: str, lines: list[str]) -> None:
    axes.set_title(title)
    if lines:
        axes.text(0.0, -0.02, "\n".join(lines), transform=axes.transAxes, fontsize=6.3, va="top")


def _round(length: float) -> float:
    """Return the largest of 1, 2, 5, 10, ... not above a length."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length))


def _mm(length: Metre) -> str:
    return format_quantity(float(f"{1e-3 * length:.5g}"), "m").replace(" um", " \N{MICRO SIGN}m")


def guesses(study: Json) -> str:
    """Return which parts of the drawing the study does not state, as a sentence; empty if it states all."""
    words = {"rings": "the rings' width, lands and outside", "bore": "the bore", "cage": "the cage's section"}
    found = "; ".join(words[key] for key in words if key in shape_of(study).guessed)
    return found and f"Dashed, at common proportions because the study does not state them: {found}."
