"""What several verbs report of a verdict and of a stability curve: words, columns, facts, pictures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from math import hypot, inf, log, pi

from separatrix.ground.plain_data import Part
from separatrix.present import quantity_text as q
from separatrix.present.blocks import Block, Cell, Column, Equation, Level, Note, Table, grouped, text_column
from separatrix.present.figure import BLUE, GREY, Across, Band, Label, Mark, Panel, Trace
from separatrix.present.quantity_text import all_numbers, axis, cell, column, fill, number_of, show

DIRECTIONS = {1: "forward", -1: "backward", 0: ""}
MARK = "*"
"""After a friction that is extrapolated beyond its tests."""


def has_safety(rows: Iterable[Part]) -> bool:
    """Whether some of the rows have a safety factor: not in the paper's model."""
    return any(row.get("own_critical_friction_low") is not None for row in rows)


def verdict(row: Part) -> str:
    """Return the verdict of a row, or why there is none."""
    if judged(row):
        return str(row.verdict)
    return "not measured" if row.get("friction") is None else "not finished"


def by_verdict(pairs: Iterable[tuple[str, str]]) -> str:
    """Return verdicts, each with who has it."""
    return "; ".join(f"{word} {', '.join(who)}" for word, who in grouped(pairs).items())


def footnotes(rows: Sequence[Part], level: Level = Level.ALWAYS) -> list[Note]:
    """Return in what respect frictions are extrapolated; on a screen, the first one."""
    measured = [row for row in rows if "friction" in row]
    who = grouped((sentence, row.name) for row in measured for sentence in row.extrapolation)
    everyone = [one for one, names in who.items() if len(names) == len(measured)]
    rest = [f"{one} ({', '.join(names)})" for one, names in who.items() if one not in everyone]
    each = everyone + rest
    brief = each[0] + "; more: `--full`" * bool(each[1:]) if each else ""
    known = (("; ".join(each), Level.LONG), (brief, Level.BRIEF))
    words = f"{MARK} extrapolated beyond the tests"
    return [Note(f"{words}: {one}.", "legend", at) for one, at in known if each and at & level]


def judged(row: Part) -> Part | None:
    """Return a row that has a verdict; None of another."""
    return None if row.get("verdict") is None else row


def drifting(row: Part) -> Part | None:
    """Return a row that nothing guides and whose runs do not all whirl: only these have a drift rate."""
    if not judged(row) or not row.drift_rate_law:
        return None
    worst = next(one for one in row.by_kick if one.kick == row.worst_kick)
    return None if worst.whirls == row.runs else row


def is_by_land(row: Part) -> bool:
    """Whether friction on the land makes the cage of a row unstable."""
    return bool(row.verdict == "UNSTABLE" and row.driven_by_land)


def is_land_driven(row: Part) -> bool:
    """Whether friction on the land drives the cage of a row that is not stable."""
    return bool(row.verdict != "STABLE" and row.driven_by_land)


def pocket_force(row: Part) -> Cell:
    """Return the largest force in a pocket, or what the races hold, beyond which it means nothing."""
    largest = cell(judged(row), "largest_contact_force")
    if not judged(row) or not row.force_exceeds_races:
        return largest
    return replace(cell(row, "force_limit"), quantity=largest.quantity, before="> ")


def evidence_column(name: str) -> Column:
    """Return a column of evidence; numbers that a row cannot have are absent."""
    if name == "largest_contact_force":
        return replace(column(name), cell=pocket_force)
    return column(name, of=drifting if name == "drift_rate" else judged)


def motion_column() -> Column:
    """Return the motion that most runs from the worst disturbance end in."""
    return text_column("motion", lambda row: (row.cage_motion or "unresolved") if judged(row) else "-")


def power_facts(row: Part) -> list[tuple[str, str]]:
    """Return what friction feeds into the cage or takes from it, and what rubs on the land."""
    powers = (("pocket", "pocket_power"), ("land", "land_power"))
    each = [f"{show(row, name)} by the {where}" for where, name in powers if getattr(row, name)]
    rubbing = fill(row, "{rubbing_force} at {rubbing_speed}, {rubbing_power} of heat")
    return [
        ("Friction power into the cage", ", ".join(each) or "none"),
        ("Rubbing on the land", rubbing if row.rubbing_force > 0.0 else ""),
    ]


def verdict_sentences(rows: Sequence[Part], place: str) -> str:
    """Return the answer of a ranking: the first, its safety factor or margin, the others."""
    first = [row for row in rows if row.get("rank") == 1]
    if not first:
        return f"No candidate was ranked in {place}."
    each = {verdict(row) for row in first}
    names = ", ".join(row.name for row in first)
    lead = f"{names} ranks first in {place}: {verdict(first[0])}."
    if len(first) > 1:
        words = f" ({names}): {verdict(first[0])}" if len(each) == 1 else f": {each_verdict(first)}"
        lead = f"{len(first)} materials tie for first in {place}{words}."
    margin = _safety(first) if has_safety(first) else _margin(first)
    others = [row for row in rows if row not in first]
    rest = f"The others: {each_verdict(others)}." if others else "There is no other candidate."
    rest = f"All others: {verdict(others[0])}." if len({*map(verdict, others)}) == 1 else rest
    return f"{lead} {margin} {rest}"


def each_verdict(rows: Sequence[Part]) -> str:
    """Return each verdict with who has it."""
    return by_verdict((verdict(row), row.name) for row in rows)


def _margin(first: Sequence[Part]) -> str:
    """Return the restitution thresholds of the candidates that rank first, in the paper's model."""
    name = "restitution_threshold"
    threshold = span(first, name) if len(first) > 1 else show(first[0], name)
    return (
        f"From the reference disturbance the largest stable restitution factor is {threshold}; this bearing "
        f"and film have {span(first, 'restitution_factor')}, a margin of {span(first, 'margin')}."
    )


def without_friction(rows: Sequence[Part]) -> str:
    """Return why critical frictions are 0."""
    edge = " or bring a ball to the edge of its pocket" * any(row.get("left_pocket") for row in rows)
    return f"half the runs whirl{edge} even without friction in the pockets, which do not drive them"


def _safety(first: Sequence[Part]) -> str:
    """Return the safety factors of the candidates that rank first, and what they are made of."""
    criticals, frictions = span(first, "own_critical_friction"), span(first, "friction")
    lowest = min(first, key=lambda row: row.safety_factor_low if "safety_factor_low" in row else inf)
    if all(judged(row) and is_by_land(row) for row in first):
        return "No safety factor: friction in the pockets does not decide."
    if lowest.get("own_critical_friction") == 0.0:
        return f"Safety factor 0: {without_friction(first)}; their friction is {frictions}."
    factor = show(lowest, "safety_factor")
    at = "at least " if len(first) > 1 and not factor.startswith(">") else ""
    half = f"half the runs whirl at a friction of {criticals}"
    if not any("own_critical_friction" in row for row in first):
        searched = number_of(lowest, "own_critical_friction", lowest.own_critical_friction_low)
        half = f"at no friction up to {searched} half the runs whirl"
    return f"Safety factor {at}{factor}: {half}, the pockets have {frictions}."


def deciding(answer: Part, rows: Sequence[Part]) -> Iterator[str]:
    """Yield what decides a ranking besides frictions: inputs, the land, a weak whirl, extrapolation."""
    known = [row for row in rows if judged(row)]
    if driven := [row.name for row in known if is_land_driven(row)]:
        friction = f"friction on the land, {answer.cage.land_friction:g}, and not in the pockets"
        yield f"{', '.join(driven)}: {friction}, drives the whirl."
    if not known or not has_safety(known):
        return
    drawn = [(row.get("uncertain_verdict"), row.name, row.verdict) for row in known]
    if others := [(verdict, name) for verdict, name, mean in drawn if verdict not in (None, mean)]:
        yield f"That is at the means of the uncertain inputs; with them drawn: {by_verdict(others)}."
    best = known[0]
    undriven = [row for row in known if row.get("own_critical_friction") == 0.0]
    if undriven and best.get("own_critical_friction") != 0.0:
        yield f"{', '.join(row.name for row in undriven)}: {without_friction(undriven)}."
    both = fill(best, "land clearance {land_clearance}, pocket clearance {pocket_clearance}")
    wide, even = (
        next((one for one in answer.effects or () if one.name == name), None)
        for name in ("wide_land", "even_orbits")
    )
    own = next((row for row in known if row.name == answer.candidate), None)
    if wide is not None and own is not None:
        critical = wide.get("own_critical_friction") or wide.own_critical_friction_low
        words = f"With {wide.change} the critical friction of {answer.candidate} would be "
        words += fill(wide, "{own_critical_friction}")
        whirling = [row.name for row in known if row.verdict != "STABLE" and row.name not in driven]
        above = [row.name for row in known if row.friction > critical and row.verdict == "STABLE"]
        at_most, wide_at_most = (
            inf if (high := one.get("own_critical_friction_high")) is None else high for one in (own, wide)
        )
        if wide.own_critical_friction_low > at_most:
            lowers = "and lowers the critical friction"
            yield f"The land stops the cage before its pockets do ({both}) {lowers}. {words}."
        elif wide_at_most >= own.own_critical_friction_low:
            yield f"The land stops the cage before its pockets do ({both}) but does not decide. {words}."
        else:
            steadies = "keeps it stable" if above else "raises the critical friction"
            steadies = "is not enough for " + ", ".join(whirling) if whirling else steadies
            whose = f", less than the friction of {', '.join(above)}" if above else ""
            yield f"The land stops the cage before its pockets do ({both}), which {steadies}. {words}{whose}."
    elif best.get("land_clearance") is not None and any(
        row.verdict != "STABLE" and row.name not in driven for row in known
    ):
        words = "The pockets decide, not the land (clearances {pocket_clearance}, {land_clearance})."
        yield fill(best, words)
    most = even.get("own_critical_friction_high") if even is not None else None
    kept = [row.name for row in known if row.verdict == "STABLE" and row.friction > (most or inf)]
    if even is not None and kept:
        words = "Balls that lead and lag under radial load or moment keep the cage stable. Without this, the "
        words += f"critical friction of {answer.candidate} would be {show(even, 'own_critical_friction')}"
        yield f"{words}, less than the friction of {', '.join(kept)}."
    weak = [row for row in known if row.cage_motion == "ROLLING" and row.verdict == "STABLE"]
    if weak:
        force = "up to {largest_contact_force}"
        if weak[0].force_exceeds_races:
            force = "above {force_limit}, whose friction is all that the races hold"
        words = "a weak whirl remains, fed {pocket_power}, with pocket forces " + force
        yield f"{weak[0].name} rolls in its pockets: {fill(weak[0], words)}."
    rubs = [row for row in known if row.cage_motion == "ON THE LAND" and row.verdict == "STABLE"]
    if rubs:
        whose = "Every cage" if rubs == known else f"The cage of {', '.join(row.name for row in rubs)}"
        yield f"{whose} stays on its land and rubs it with {span(rubs, 'rubbing_power')} of heat."
    beyond = [bool(row.extrapolation) for row in known]
    if any(beyond):
        yield f"{'All' if all(beyond) else 'Some'} frictions are extrapolated."


def span(rows: Sequence[Part], name: str) -> str:
    """Return the least and the largest value of a quantity among some rows, one where they look alike."""
    known = [getattr(row, name) for row in rows if name in row]
    ends = [number_of(rows[0], name, one) for one in (min(known), max(known))] if known else []
    return " to ".join(dict.fromkeys(ends)) or show(rows[0], name)


# The stability curve.

HIGHEST = 0.5
"""Friction at the top of a picture without any curve: above it no cage material is of interest."""

ENDS = ("critical_friction_low", "critical_friction_high")
HALF = ("critical_friction", "scatter_low", "scatter_high")
HEIGHTS = (*HALF, "critical_friction_high")
"""Numbers of a point whose largest is the top of the picture; the limits are drawn as far as they go."""


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
        found.append(linear_law([(one.restitution_factor, one.critical_friction) for one in known]))
    return found


def _ends(point: Part, top: float) -> tuple[float | None, float | None]:
    """Return the ends of the band at a point; of one that was not found, that of the picture."""
    if not any(name in point for name in ("critical_friction", *ENDS)):
        return None, None
    low, high = (point.get(name) for name in ENDS)
    return (0.0 if low is None else low), (2.0 * top if high is None else high)


def disturbances(curve: Part) -> list[str]:
    """Return the initial disturbances of the runs as text."""
    return [number_of(curve, "kicks", one) for one in curve.kicks]


def linear_law(known: Sequence[tuple[float, float]], *, is_upright: bool = False) -> Trace:
    """Return the linear law through restitution factors, below 1, and their frictions.

    Of dampers friction is in proportion to the damping ratio; of balls of inertia what is between follows.
    """
    from numpy import interp

    at, ratios = zip(
        *sorted((_damping(one), friction / _damping(one)) for one, friction in known), strict=True
    )
    eta = [i / 200.0 for i in range(201)]
    friction = [float(interp(_damping(one), at, ratios)) * _damping(one) for one in eta]
    x, y = (friction, eta) if is_upright else (eta, friction)
    name = "linear limit: no clearance, balls at rest"
    return Trace(x=x, y=y, name=name, colour=GREY, line="--", width=1.0)


def _damping(eta: float) -> float:
    """Return the damping ratio at a restitution factor."""
    return 1.0 if eta == 0.0 else -log(eta) / hypot(pi, log(eta))


def own_marks(answer: Part, curve: Part) -> list[Mark]:
    """Return the restitution factor of the bearing as an upright line, and its critical friction."""
    text = "this bearing, $eta$ = {restitution_factor}"
    if answer.chain.damping_ratio > 1.0:
        text += " (damping ratio {damping_ratio}; of the curve up to 1)"
    text = fill(answer.chain, text)
    found: list[Mark] = [Across(at=answer.chain.restitution_factor, name=text)]
    here = curve.get("here")
    if here is not None and "critical_friction" in here:
        name = fill(here, "its critical friction, {critical_friction}")
        at = q.marks([here], "restitution_factor", "critical_friction", marker="D", is_open=True, name=name)
        found.append(at)
    return found


def curve_blocks(curve: Part, level: Level = Level.ALWAYS) -> list[Block]:
    """Return the table of the curve, with its ensemble."""
    points = curve.get("curve") or []
    linear = {one.restitution_factor: one for one in curve.get("linear_limit") or ()}
    few, most = (number_of(curve, "band_few", one) for one in (1.0 - curve.band_few, curve.band_most))
    band = f" Band: {few} of the runs settle or roll from every disturbance below its low end, {most} whirl "
    band += "from every disturbance above its high end."
    caption = (
        f"Critical friction: {fill(curve, 'half of {runs} runs of {duration} whirl from the reference')} "
        f"disturbance, {show(curve, 'middle_kick')}; fewer below, more above.{band if curve.band else ''} "
        f"Disturbances: {', '.join(disturbances(curve))}. Linear limit: no clearance, balls at rest."
    )
    columns = (
        column("restitution_factor"),
        column("critical_friction"),
        *(column(name, is_short=True) for name in ENDS if curve.band),
        column("critical_friction", of=lambda row: linear.get(row.restitution_factor), head="linear limit"),
    )
    reasons = grouped((one.reason, show(one, "restitution_factor")) for one in points if "reason" in one)
    return [
        Equation(
            r"f_{lin} = 2\,\zeta\,\sqrt{2/Z}",
            "Linear limit of the friction: $Z$ balls as dampers, no clearance, damping ratio $zeta$ of an "
            "impact; of balls of inertia it is that of their small motions.",
        ),
        Table("stability curve", columns, tuple(points), caption, level),
        *(Note(f"At {', '.join(at)}: {one}.", "legend", level) for one, at in reasons.items()),
        all_numbers("points of the curve", (), ((one,) for one in points_of(curve))),
    ]


def pocket_friction(answer: Part) -> str:
    """Return the pocket friction of a cage, and whose it is if not its own; empty if none is known."""
    study, friction = answer.values["study"], show(answer.cage, "ball_cage_friction")
    if (study["cage"].get("ball_cage_friction") or {}).get("value") is not None:
        return friction
    if not answer.cage.ball_cage_friction:
        return ""
    ranking = study["ranking"]
    name = (study["cage"].get("material") or {}).get("name") or ranking["candidates"][0]["name"]
    place = (ranking.get("environment") or {}).get("value") or ranking["environments"][0]
    return f"{friction}, that of {name} in {place}"
