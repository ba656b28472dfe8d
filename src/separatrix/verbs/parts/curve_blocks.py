"""What `stability` and `rank` tell of a stability curve: picture, table, and the bearing's own point."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot, log, pi
from typing import Any

from separatrix.ground.document import Part
from separatrix.present.blocks import Block, Cell, Column, Equation, Level, Note, Table
from separatrix.present.figure import BLUE, GREY, Across, Band, Label, Mark, Panel, Trace
from separatrix.verbs.parts.quantity_text import (
    all_numbers,
    axis,
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

WIDE = 0.006
"""Half the width of a band that is known at the bearing's own restitution factor alone."""

# The picture.


def highest(points: Sequence[Part], more: Iterable[float | None] = ()) -> float:
    """Return the friction at the top of the picture: above every point of the curve, and `more`."""
    found = [one.get(name) for one in points for name in HEIGHTS]
    top = max((one for one in [*found, *more] if one is not None), default=0.0)
    return 1.12 * top if top > 0.0 else HIGHEST


def curve_marks(curve: Part, top: float) -> list[Mark]:
    """Return the curve with its scatter, the band, and the linear limit.

    A band without its upper end goes beyond `top`, that of the picture.
    """
    points = curve.get("curve") or []
    eta = [one.restitution_factor for one in points]
    half = [one.critical_friction for one in points]
    scatter: dict[str, Any] = {end: [one.get(f"scatter_{end}") for one in points] for end in ("low", "high")}
    words = f"half of {show(curve, 'runs')} runs whirl, disturbance {show(curve, 'middle_kick')}"
    found: list[Mark] = [
        Trace(x=eta, y=half, name=words, colour=BLUE, marker="o", size=3.0),
        Band(x=eta, **scatter, name="its 95 % interval"),
    ]
    if curve.band:
        low, high = zip(*(_ends(one, top) for one in points), strict=True) if points else ((), ())
        found.append(Band(x=eta, low=low, high=high, name=_band_name(curve), opacity=0.15))
    return [*found, *linear_limit(curve)]


def _ends(point: Part, top: float) -> tuple[float | None, float | None]:
    """Return the ends of the band at a point; of one that was not found, that of the picture."""
    if not any(name in point for name in ("critical_friction", *ENDS)):
        return None, None
    low, high = (point.get(name) for name in ENDS)
    return (0.0 if low is None else low), (2.0 * top if high is None else high)


def _band_name(curve: Part) -> str:
    kicks = disturbances(curve)
    if len(kicks) == 1:
        return "band of the scatter between runs"
    return f"band in which the disturbance decides ({kicks[0]} to {kicks[-1]})"


def disturbances(curve: Part) -> list[str]:
    """Return the initial disturbances of the runs as text."""
    return [number_of(curve, "kicks", one) for one in curve.kicks]


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


def own_marks(answer: Part, curve: Part, top: float) -> list[Mark]:
    """Return the restitution factors of the bearing as upright lines, its critical friction and its band."""
    found: list[Mark] = []
    for name, words, line in (("", "this bearing", "-"), ("_free_spin", "the same, balls free to spin", ":")):
        key = f"restitution_factor{name}"
        text = f"{words}, $eta$ = {show(answer.chain, key)}"
        found.append(Across(at=answer.chain.get(key), name=text, line=line, hover=text))
    here = curve.get("here")
    if here is None:
        return found
    if not curve.band:
        at, (low, high) = here.restitution_factor, _ends(here, top)
        look: dict[str, Any] = {"name": _band_name(curve), "opacity": 0.25}
        found.append(Band(x=(at - WIDE, at + WIDE), low=[low] * 2, high=[high] * 2, **look))
    if "critical_friction" in here:
        look = {"marker": "D", "size": 4.5, "is_open": True}
        look["name"] = f"its critical friction, {show(here, 'critical_friction')}"
        found.append(marks([here], "restitution_factor", "critical_friction", **look))
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
    top = highest(points_of(curve), frictions)
    return Panel(
        title=title,
        x=axis("restitution_factor", "-", [], low=0.0, high=1.0),
        y=axis("ball_cage_friction", "-", [], low=0.0, high=top),
        marks=(*curve_marks(curve, top), *own_marks(answer, curve, top), *more),
        labels=tuple(labels),
        head=head,
    )


def points_of(curve: Part) -> list[Part]:
    """Return the points of a curve, and the bearing's own at last."""
    return [*(curve.get("curve") or ()), *([curve.here] if "here" in curve else [])]


# The text.


def own_lead(curve: Part) -> str:
    """Return the sentence on the bearing's own critical friction, and that of a cage without a land."""
    here = curve.get("here")
    if here is None:
        return "The critical friction at the bearing's own restitution factor was not finished."
    at = fill(here, "At this bearing's restitution factor of {restitution_factor} ")
    if "critical_friction" not in here:
        return f"{at}no critical friction was found: {here.reason}."
    return f"{at}half of the runs whirl at a pocket friction of {show(here, 'critical_friction')}."


def drift_words(curve: Part) -> str:
    """Return that a cage without a land is stable nowhere, and how fast it drifts; empty if it has one."""
    if not curve.drifts:
        return ""
    pace = fill(curve, ", by the linear law at {drift_rate_law}") if curve.get("drift_rate_law") else ""
    return (
        f"The cage has no land and drifts at any friction{pace}. Below the curve disturbances decay, but no "
        "verdict there is STABLE."
    )


def own_point(curve: Part) -> list[Block]:
    """Return the band at the bearing's own restitution factor."""
    here = curve.get("here")
    if here is None:
        return []
    notes = [_sentence(here.reason)] if "reason" in here else []
    if here.restitution_factor == 0.0:
        notes.append(
            "Impacts of this bearing are overdamped: its critical friction is found with its own race "
            "damping, the curve's point at 0 with the largest damping that leaves no rebound."
        )
    return [Note(band_words(curve, here)), *(Note(one, "legend") for one in notes)]


def band_words(curve: Part, at: Part) -> str:
    """Return between which frictions the disturbance decides at a point."""
    low = "There is no friction at which runs settle or roll from every disturbance"
    if "critical_friction_low" in at:
        low = f"From every disturbance runs settle or roll below {show(at, 'critical_friction_low')}"
    high = f"up to {show(curve, 'searched_friction')} there is none above which they whirl from every one"
    if "critical_friction_high" in at:
        high = f"they whirl from every one above {show(at, 'critical_friction_high')}"
    return f"{low}; {high}."


def _sentence(reason: str) -> str:
    return f"{reason[:1].upper()}{reason[1:]}."


def _share(value: float) -> str:
    return Cell(value, quantity("band_few")).text


def curve_blocks(curve: Part, level: Level = Level.ALWAYS) -> list[Block]:
    """Return the table of the curve, with its ensemble."""
    points = curve.get("curve") or []
    linear = {one.restitution_factor: one for one in curve.get("linear_limit") or ()}
    few, most = _share(1.0 - curve.band_few), _share(curve.band_most)
    band = (
        f" Band: {few} of the runs settle or roll from every disturbance below its low end, {most} whirl "
        "from every disturbance above its high end."
    )
    caption = (
        f"Critical friction: {fill(curve, 'half of {runs} runs of {duration} whirl from the reference')} "
        f"disturbance, {show(curve, 'middle_kick')}; fewer below, more above.{band if curve.band else ''} "
        f"Disturbances: {', '.join(disturbances(curve))}. Linear limit: no clearance, balls at rest."
    )
    columns = (
        column("restitution_factor"),
        column("critical_friction"),
        *(map(_plain, ENDS) if curve.band else ()),
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
        all_numbers("points of the curve", (), ((one,) for one in points_of(curve))),
    ]


def _plain(name: str) -> Column:
    """Return the column of a number without its interval."""
    known = quantity(name)
    return Column(known.head, lambda row: Cell(row.get(name), known, row.unit(name)))


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
