"""What `stability` and `rank` report of a stability curve: picture, table, and the bearing's own point."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, log, pi

from separatrix.ground.document import Part
from separatrix.present.blocks import Block, Cell, Column, Equation, Level, Note, Table
from separatrix.present.figure import BLUE, GREY, Across, Band, Label, Mark, Panel, Trace
from separatrix.verbs.parts.quantity_text import (
    all_numbers,
    axis,
    begun,
    column,
    fill,
    marks,
    number_of,
    quantity,
    show,
)

HIGHEST = 0.5
"""Friction at the top of a picture without any curve: above it no cage material is of interest."""

ENDS = ("critical_friction_low", "critical_friction_high")
HEIGHTS = ("critical_friction", "scatter_high", "critical_friction_high")
"""Numbers of a point whose largest is the top of the picture; the limits are drawn as far as they go."""

# The picture.


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
    heights = [*(one.get(name) for one in points_of(curve) for name in HEIGHTS), *frictions]
    top = 1.12 * max((one for one in heights if one is not None), default=0.0) or HIGHEST
    return Panel(
        title=title,
        x=axis("restitution_factor", "-", [], low=0.0, high=1.0),
        y=axis("ball_cage_friction", "-", [], low=0.0, high=top),
        marks=(*curve_marks(curve, top), *own_marks(answer, curve), *more),
        labels=tuple(labels),
        head=head,
    )


def points_of(curve: Part) -> list[Part]:
    """Return the points of a curve, and the bearing's own at last."""
    return [*(curve.get("curve") or ()), *([curve.here] if "here" in curve else [])]


def curve_marks(curve: Part, top: float) -> list[Mark]:
    """Return the curve with its scatter, the band, and the linear limit.

    A band without its upper end goes beyond `top`, that of the picture.
    """
    points = curve.get("curve") or []
    eta = [one.restitution_factor for one in points]
    words = f"half of {show(curve, 'runs')} runs whirl, disturbance {show(curve, 'middle_kick')}"
    half, least, most = ([one.get(name) for one in points] for name in HALF)
    found: list[Mark] = [
        Trace(x=eta, y=half, name=words, colour=BLUE, marker="o", size=3.0),
        Band(x=eta, low=least, high=most, name="its 95 % interval"),
    ]
    if curve.band:
        low, high = zip(*(_ends(one, top) for one in points), strict=True) if points else ((), ())
        kicks = disturbances(curve)
        name = f"band in which the disturbance decides ({kicks[0]} to {kicks[-1]})"
        name = name if kicks[1:] else "band of the scatter between runs"
        found.append(Band(x=eta, low=low, high=high, name=name, opacity=0.15))
    known = [one for one in curve.get("linear_limit") or () if one.restitution_factor < 1.0]
    if known:
        found.append(linear_law(known[0].critical_friction / _damping(known[0].restitution_factor)))
    return found


HALF = ("critical_friction", "scatter_low", "scatter_high")


def _ends(point: Part, top: float) -> tuple[float | None, float | None]:
    """Return the ends of the band at a point; of one that was not found, that of the picture."""
    if not any(name in point for name in ("critical_friction", *ENDS)):
        return None, None
    low, high = (point.get(name) for name in ENDS)
    return (0.0 if low is None else low), (2.0 * top if high is None else high)


def disturbances(curve: Part) -> list[str]:
    """Return the initial disturbances of the runs as text."""
    return [number_of(curve, "kicks", one) for one in curve.kicks]


def linear_law(scale: float, *, is_upright: bool = False, colour: str = GREY) -> Trace:
    """Return the friction of the linear law, ``scale`` times the damping ratio at a restitution factor."""
    eta = [i / 200.0 for i in range(201)]
    friction = [scale * _damping(one) for one in eta]
    x, y = (friction, eta) if is_upright else (eta, friction)
    name = "linear limit: no clearance, balls at rest"
    return Trace(x=x, y=y, name=name, colour=colour, line="--", width=1.0)


def _damping(eta: float) -> float:
    """Return the damping ratio at a restitution factor."""
    return 1.0 if eta == 0.0 else -log(eta) / hypot(pi, log(eta))


def own_marks(answer: Part, curve: Part) -> list[Mark]:
    """Return the restitution factor of the bearing as an upright line, and its critical friction."""
    text = f"this bearing, $eta$ = {show(answer.chain, 'restitution_factor')}"
    found: list[Mark] = [Across(at=answer.chain.restitution_factor, name=text)]
    here = curve.get("here")
    if here is not None and "critical_friction" in here:
        name = f"its critical friction, {show(here, 'critical_friction')}"
        at = marks([here], "restitution_factor", "critical_friction", marker="D", is_open=True, name=name)
        found.append(at)
    return found


# The text.


def curve_blocks(curve: Part, level: Level = Level.ALWAYS) -> list[Block]:
    """Return the table of the curve, with its ensemble."""
    points = curve.get("curve") or []
    linear = {one.restitution_factor: one for one in curve.get("linear_limit") or ()}
    shares = (Cell(one, quantity("band_few")).text for one in (1.0 - curve.band_few, curve.band_most))
    few, most = shares
    band = (
        f" Band: {few} of the runs settle or roll from every disturbance below its low end, {most} whirl "
        "from every disturbance above its high end."
    )
    caption = (
        f"Critical friction: {fill(curve, 'half of {runs} runs of {duration} whirl from the reference')} "
        f"disturbance, {show(curve, 'middle_kick')}; fewer below, more above.{band if curve.band else ''} "
        f"Disturbances: {', '.join(disturbances(curve))}. Linear limit: no clearance, balls at rest."
    )

    def plain(name: str) -> Column:  # without its interval
        known = quantity(name)
        return Column(known.head, lambda row: Cell(row.get(name), known, row.unit(name)))

    columns = (
        column("restitution_factor"),
        column("critical_friction"),
        *(map(plain, ENDS) if curve.band else ()),
        column("critical_friction", of=lambda row: linear.get(row.restitution_factor), head="linear limit"),
    )
    reasons = dict.fromkeys(one.reason for one in points if "reason" in one)
    return [
        Equation(
            r"f_{lin} = 2\,\zeta\,\sqrt{2/Z}",
            "Linear limit of the friction: $Z$ balls, no clearance, damping ratio $zeta$ of an impact.",
        ),
        Table("stability curve", columns, tuple(points), caption, level),
        *(Note(f"{begun(one)}.", "legend", level) for one in reasons),
        all_numbers("points of the curve", (), ((one,) for one in points_of(curve))),
    ]


# The friction of the cage itself.


def pocket_friction(answer: Part) -> str:
    """Return the pocket friction of a cage, and whose it is if not its own; empty if none is known."""
    stated = (answer.values["study"]["cage"].get("ball_cage_friction") or {}).get("value") is not None
    if not stated and not answer.cage.ball_cage_friction:
        return ""
    return show(answer.cage, "ball_cage_friction") + ("" if stated else f", {_material(answer)}")


def _material(answer: Part) -> str:
    """Return the candidate that the cage has, and its environment."""
    study = answer.values["study"]
    ranking = study["ranking"]
    name = (study["cage"].get("material") or {}).get("name") or ranking["candidates"][0]["name"]
    place = (ranking.get("environment") or {}).get("value") or ranking["environments"][0]
    return f"that of {name} in {place}"
