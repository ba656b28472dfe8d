"""What `stability` and `rank` tell of a stability curve: picture, table, and the bearing's own point."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, log, pi
from typing import Any

from separatrix.ground.document import Part
from separatrix.ground.quantity import alone, middle
from separatrix.present.blocks import Block, Cell, Column, Equation, Heading, Level, Note, Table
from separatrix.present.figure import (
    BLUE,
    GREY,
    SKY,
    Across,
    Band,
    Label,
    Mark,
    Panel,
    Trace,
)
from separatrix.verbs.parts.telling import axis, column, estimate, quantity, said, told

HIGHEST = 0.5
"""Friction at the top of a picture without any curve: above it no cage material is of interest."""

ENDS = ("critical_friction_low", "critical_friction_high")
HEIGHTS = ("critical_friction", "scatter_high", "critical_friction_high")
"""Numbers of a point whose largest is the top of the picture; the limits are drawn as far as they go."""

WIDE = 0.006
"""Half the width of the band that is known at the bearing's own restitution factor alone."""

# The picture.


def highest(curve: Part, more: Iterable[float | None] = ()) -> float:
    """Return the friction at the top of the picture: above every curve and mark in it, and `more`."""
    points = [*(curve.get("curve") or ()), *([curve.here] if "here" in curve else [])]
    found = [one.get(name) for one in points for name in HEIGHTS]
    found += [one for point in points for one in point.get("kick_critical_friction") or ()]
    top = max((one for one in [*found, *more] if one is not None), default=0.0)
    return 1.12 * top if top > 0.0 else HIGHEST


def curve_marks(curve: Part, top: float | None = None) -> list[Mark]:
    """Return the band, the curve with its scatter, the linear limit, and the curve of each disturbance.

    A band without its upper end goes beyond `top`, that of the picture.
    """
    points = curve.get("curve") or []
    eta = [one.restitution_factor for one in points]
    half = [one.critical_friction for one in points]
    scatter: dict[str, Any] = {
        "low": [one.scatter_low for one in points],
        "high": [one.scatter_high for one in points],
    }
    words = f"half of {told(curve, 'runs')} runs whirl, disturbance {told(curve, 'middle_kick')}"
    hover = tuple(map(_hover, points))
    return [
        Trace(x=eta, y=half, name=words, colour=BLUE, marker="o", size=3.0, hover=hover),
        Band(x=eta, **scatter, name="its 95 % interval"),
        *_each_disturbance(curve),
        *_band(curve, top or highest(curve)),
        *linear_limit(curve),
    ]


def _hover(point: Part) -> str:
    at = f"restitution factor {told(point, 'restitution_factor')}"
    if "critical_friction" not in point:
        return f"{at}: {point.reason}"
    band = ""
    if any(name in point for name in ENDS):
        low, high = (_end(point, name) for name in ENDS)
        band = f"; band {low} to {high}"
    return f"{at}: half of the runs whirl at a friction of {told(point, 'critical_friction')}{band}"


def _end(point: Part, name: str) -> str:
    """Return an end of the band without its own interval."""
    return alone(point.get(name), quantity(name), point.unit(name))


def _band(curve: Part, top: float) -> list[Mark]:
    """Return the band over the curve, or where only the bearing's own is known, there."""
    points, x = (curve.get("curve") or [], [])
    if curve.band:
        x = [one.restitution_factor for one in points]
    elif "here" in curve:
        at = curve.here.restitution_factor
        points, x = [curve.here] * 2, [max(at - WIDE, 0.0), at + WIDE]
    if not points:
        return []
    low: list[float | None] = []
    high: list[float | None] = []
    for one in points:
        known = any(name in one for name in ("critical_friction", *ENDS))
        least, most = (one.get(name) for name in ENDS)
        low.append(least if least is not None else 0.0 if known else None)
        high.append(most if most is not None else 2.0 * top if known else None)
    kicks = disturbances(curve)
    where = "" if curve.band else "at the bearing's own $eta$ "
    name = f"band {where}in which the disturbance decides ({kicks[0]} to {kicks[-1]})"
    if len(kicks) == 1:
        name = f"band {where}of the scatter between runs"
    found: list[Mark] = [Band(x=x, low=low, high=high, name=name, opacity=0.15)]
    if curve.band:
        look: dict[str, Any] = {"colour": BLUE, "width": 0.7}
        found.append(Trace(x=x, y=low, line=":", **look))
        found.append(
            Trace(x=x, y=[None if one is None or one > top else one for one in high], line="-.", **look)
        )
    return found


def _each_disturbance(curve: Part) -> list[Mark]:
    """Return the critical friction from the least and from the largest disturbance."""
    points, kicks = curve.get("curve") or [], curve.kicks
    if not curve.band or len(kicks) == 1:
        return []
    found: list[Mark] = []
    for place, marker in ((0, "v"), (len(kicks) - 1, "^")):
        if kicks[place] != curve.middle_kick:
            y = [(one.kick_critical_friction or [None] * len(kicks))[place] for one in points]
            look: dict[str, Any] = {"colour": SKY, "marker": marker, "size": 2.5, "width": 0.7}
            name = f"half of them whirl, disturbance {disturbances(curve)[place]}"
            found.append(Trace(x=[one.restitution_factor for one in points], y=y, name=name, **look))
    return found


def disturbances(curve: Part) -> list[str]:
    """Return the initial disturbances of the runs as text."""
    return [alone(one, quantity("kicks"), curve.unit("kicks")) for one in curve.kicks]


def linear_limit(curve: Part) -> list[Mark]:
    """Return the linear law as smooth as it is, through the points of the document."""
    known = [one for one in curve.get("linear_limit") or () if one.restitution_factor < 1.0]
    if not known:
        return []
    return [linear_law(known[0].critical_friction / _damping(known[0].restitution_factor))]


def linear_law(scale: float, *, is_upright: bool = False, colour: str = GREY) -> Trace:
    """Return the friction of the linear law, ``scale`` times the damping ratio at a restitution factor."""
    eta = [i / 200.0 for i in range(201)]
    friction = [scale * _damping(one) for one in eta]
    x, y = (friction, eta) if is_upright else (eta, friction)
    return Trace(
        x=x, y=y, name="linear limit: no clearance, balls at rest", colour=colour, line="--", width=1.0
    )


def _damping(eta: float) -> float:
    """Return the damping ratio at a restitution factor."""
    return 1.0 if eta == 0.0 else -log(eta) / hypot(pi, log(eta))


def own_marks(answer: Part, curve: Part) -> list[Mark]:
    """Return the restitution factors of the bearing as upright lines, and its critical friction."""
    chain, found = answer.chain, list[Mark]()
    for name, words, line in (
        ("restitution_factor", "this bearing", "-"),
        ("restitution_factor_free_spin", "the same, balls free to spin", ":"),
    ):
        text = f"{words}, $eta$ = {told(chain, name)}"
        found.append(Across(at=getattr(chain, name), name=text, line=line, hover=text))
    here = curve.get("here")
    if here is not None and "critical_friction" in here:
        words = f"its critical friction, {told(here, 'critical_friction')}"
        value = estimate(here, "critical_friction")
        found.append(
            Trace(
                x=[here.restitution_factor],
                y=[middle(value)],
                low=[here.scatter_low],
                high=[here.scatter_high],
                name=words,
                line="",
                marker="D",
                size=4.5,
                is_open=True,
                hover=(_hover(here),),
            )
        )
    return found


def curve_panel(
    answer: Part,
    curve: Part,
    *,
    title: str = "Critical friction and its band",
    more: Sequence[Mark] = (),
    frictions: Iterable[float | None] = (),
    labels: Sequence[Label] = (),
    head: str = "",
) -> Panel:
    """Return the curve over the restitution factor with the bearing's own point.

    `more` are marks above them, `frictions` their heights, `labels` texts at the right under `head`.
    """
    top = highest(curve, frictions)
    return Panel(
        title=title,
        x=axis("restitution_factor", "-", [], low=0.0, high=1.0),
        y=axis("ball_cage_friction", "-", [], low=0.0, high=top),
        marks=(*curve_marks(curve, top), *own_marks(answer, curve), *more),
        labels=tuple(labels),
        head=head,
    )


# The text.


def own_lead(curve: Part) -> str:
    """Return the sentence on the bearing's own critical friction, and that of a cage without a land."""
    here = curve.get("here")
    if here is None:
        return "The critical friction at the bearing's own restitution factor was not finished."
    at = said(here, "At this bearing's restitution factor of {restitution_factor} ")
    if "critical_friction" not in here:
        return f"{at}no critical friction was found: {here.reason}."
    return f"{at}half of the runs whirl at a pocket friction of {told(here, 'critical_friction')}."


def drift_words(curve: Part) -> str:
    """Return that a cage without a land is stable nowhere, and how fast it drifts; empty if it has one."""
    if not curve.drifts:
        return ""
    pace = said(curve, ", by the linear law at {drift_rate_law}") if curve.get("drift_rate_law") else ""
    return (
        f"The cage has no land and drifts at any friction{pace}. Below the curve disturbances decay, but no "
        "verdict there is STABLE."
    )


def own_point(curve: Part) -> list[Block]:
    """Return the band at the bearing's own restitution factor, disturbance by disturbance."""
    here = curve.get("here")
    if here is None:
        return []
    each = tuple(range(len(curve.kicks)))

    def of(part: Part, name: str, head: str) -> Column:
        values = part.get(name) or [None] * len(each)
        return Column(head, lambda row: Cell(values[row], quantity(name), part.unit(name)))

    table = Table(
        "own point",
        (
            of(curve, "kicks", "initial disturbance"),
            of(here, "kick_low", f"{_share(curve.band_few)} whirl at"),
            of(here, "kick_critical_friction", "half whirl at"),
            of(here, "kick_high", f"{_share(curve.band_most)} whirl at"),
        ),
        each,
        f"Pocket frictions at this bearing's restitution factor, {told(here, 'restitution_factor')}. "
        + band_words(curve, here),
    )
    notes = [_sentence(here.reason)] if "reason" in here else []
    if here.restitution_factor == 0.0:
        notes.append(
            "Impacts of this bearing are overdamped: its critical friction is found with its own race "
            "damping, the curve's point at 0 with the largest damping that leaves no rebound."
        )
    return [
        Heading("Critical friction of this bearing", depth=3),
        table,
        *(Note(one, "legend") for one in notes),
    ]


def band_words(curve: Part, at: Part) -> str:
    """Return between which frictions the disturbance decides at a point."""
    low = "There is no friction at which runs settle or roll from every disturbance"
    if "critical_friction_low" in at:
        low = f"From every disturbance runs settle or roll below {told(at, 'critical_friction_low')}"
    high = f"up to {told(curve, 'searched_friction')} there is none above which they whirl from every one"
    if "critical_friction_high" in at:
        high = f"they whirl from every one above {told(at, 'critical_friction_high')}"
    return f"{low}; {high}."


def _sentence(reason: str) -> str:
    return f"{reason[:1].upper()}{reason[1:]}."


def _share(value: float) -> str:
    return Cell(value, quantity("band_few")).text


def curve_blocks(curve: Part, level: Level = Level.ALWAYS) -> list[Block]:
    """Return the table of the curve, with its ensemble; a workbook has that of each disturbance, too."""
    points = curve.get("curve") or []
    linear = {one.restitution_factor: one for one in curve.get("linear_limit") or ()}
    band = [_plain(name) for name in ENDS] if curve.band else []
    caption = (
        f"Critical friction: {said(curve, 'half of {runs} runs of {duration} whirl from the reference')} "
        f"disturbance, {told(curve, 'middle_kick')}; fewer below, more above."
    )
    if band:
        few, most = _share(1.0 - curve.band_few), _share(curve.band_most)
        caption += (
            f" Band: {few} of the runs settle or roll from every disturbance below its low end, {most} whirl "
            "from every disturbance above its high end."
        )
    caption += f" Disturbances: {', '.join(disturbances(curve))}. Linear limit: no clearance, balls at rest."
    columns = (
        column("restitution_factor"),
        column("critical_friction"),
        *band,
        column("critical_friction", of=lambda row: linear.get(row.restitution_factor), head="linear limit"),
    )
    reasons = dict.fromkeys(one.reason for one in points if "reason" in one)
    return [
        Equation(
            r"f_{lin} = 2\,\zeta\,\sqrt{2/Z}",
            "Linear limit of the friction: $Z$ balls, no clearance, damping ratio $zeta$ of an impact.",
        ),
        Table("stability curve", columns, tuple(points), caption, level),
        *(Note(_sentence(one), "legend", level) for one in reasons),
        *_sheets(curve),
    ]


def _plain(name: str) -> Column:
    """Return the column of a number without its interval."""
    known = quantity(name)
    return Column(known.head, lambda row: Cell(row.get(name), known, row.unit(name)))


def _sheets(curve: Part) -> list[Block]:
    """Return every number of the curve and of the bearing's own point: ends with intervals, disturbances."""
    points = [*(curve.get("curve") or ()), *([curve.here] if "here" in curve else [])]
    if not any(name in one for one in points for name in ENDS):
        return []
    columns = (column(name) for name in ("restitution_factor", "critical_friction", *ENDS))
    rows = tuple((one, place) for one in points if one.kick_low for place in range(len(curve.kicks)))

    def of(name: str) -> Column:
        return Column(
            quantity(name).head, lambda row: Cell(row[0].get(name)[row[1]], quantity(name), row[0].unit(name))
        )

    kick = Column(
        "disturbance", lambda row: Cell(curve.kicks[row[1]], quantity("kicks"), curve.unit("kicks"))
    )
    eta = column("restitution_factor", of=lambda row: row[0])
    each = (eta, kick, *map(of, ("kick_low", "kick_critical_friction", "kick_high")))
    own = "The last is the bearing's own." if "here" in curve else ""
    return [
        Table("band of the curve", tuple(columns), tuple(points), own, Level.SHEET),
        Table("curve by disturbance", each, rows, own, Level.SHEET),
    ]


# The friction of the cage itself.


def pocket_friction(answer: Part) -> str:
    """Return the pocket friction of a cage, and whose it is if not its own; empty if none is known."""
    stated = (answer.values["study"]["cage"].get("ball_cage_friction") or {}).get("value") is not None
    if not stated and not answer.cage.ball_cage_friction:
        return ""
    return told(answer.cage, "ball_cage_friction") + ("" if stated else f", {_material(answer)}")


def _material(answer: Part) -> str:
    """Return the candidate that the cage has, and its environment."""
    study = answer.values["study"]
    ranking = study["ranking"]
    name = (study["cage"].get("material") or {}).get("name") or ranking["candidates"][0]["name"]
    place = (ranking.get("environment") or {}).get("value") or ranking["environments"][0]
    return f"that of {name} in {place}"
