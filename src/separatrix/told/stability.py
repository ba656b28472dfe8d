"""Text of the stability curve, of a stability map and of a sweep."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from separatrix.ground.plain_data import field_units, plain
from separatrix.study.candidates import cage_candidate
from separatrix.study.study import Study
from separatrix.told.cage import friction_text
from separatrix.told.chain import basis
from separatrix.told.sentences import deciding, drift_sentence, time_shares
from separatrix.told.tables import (
    ABSENT,
    facts,
    interval,
    kick_list,
    number,
    paragraph,
    quantity,
    section,
    significant,
    stated,
    table,
)
from separatrix.verbs.answer_records import MapAnswer, StabilityAnswer
from separatrix.verdict.map_records import NOT_RUN, Inference, MapAxis, MapChange, StabilityMap, Stopping
from separatrix.verdict.stability_curve import StabilityCurve
from separatrix.verdict.swept_cases import Sweep, SweptCase

HEADERS = (
    *("restitution\nfactor", "critical friction\n(95 %)", "band\nlow", "band\nhigh"),
    "linear\nlimit",
)
LEGEND = "\n" + paragraph(
    "critical friction: half the runs whirl from the reference kick; fewer below, more above. band: nine in "
    "ten runs settle or roll from every kick below its low end, and whirl from every kick above its high "
    "end. linear limit: no clearance, balls at rest."
)
MAP_LEGEND = paragraph(
    "between the last point of a column at which, beyond the scatter, less than half the runs whirl and the "
    "first at which more than half do; margin: distance of the study's own value to that band, positive "
    "where the cage settles."
)

FRICTION = "ball_cage_friction"
MOST_COLUMNS, SOME_COLUMNS = 20, 9
"""Columns of the map whose bands are all printed, and how many are chosen of more."""

ROUNDING = 1e-9
"""A distance to a band below this share of the value is the rounding of its unit."""

KINDS = ("STABLE", "UNSTABLE", "UNDECIDED", "refused", "inferred", "not_run")


def stability(answer: StabilityAnswer, study: Study) -> list[str]:
    """Critical friction with its band and limits, and the ensemble behind them."""
    found = answer.curve
    reasons = dict.fromkeys(point.reason for point in found.curve if point.reason)
    ensemble = ensemble_facts(found.kicks, found.runs, found.duration, middle=found.middle_kick)
    holds_for = section("Basis of this answer", facts([*basis(study, answer), *ensemble]))
    remarks = [paragraph(reason, first="  - : ", indent="      ") for reason in reasons]
    return [*curve(found), holds_for, *remarks]


def ensemble_facts(
    kicks: Sequence[float], runs: int, duration: float, *, middle: float | None = None
) -> list[tuple[str, str]]:
    """Return the ensemble in a few words."""
    return [
        ("Kicks", kick_list(kicks) + (f"; the curve is that of {middle:g} m/s" if middle else "")),
        ("Runs", f"{runs} at each point, of {quantity(duration, 's')}"),
    ]


def curve(found: StabilityCurve) -> list[str]:
    """Points of the curve with band and limits, and the band at this bearing's own restitution factor."""
    linear = {one.restitution_factor: one.critical_friction for one in found.linear_limit}
    rows = []
    for point in found.curve:
        eta, critical = point.restitution_factor, ABSENT
        if point.critical_friction is not None:
            critical = interval(point.critical_friction, point.scatter_low, point.scatter_high, 3)
        others = (point.critical_friction_low, point.critical_friction_high, linear.get(eta))
        rows.append([number(eta), critical, *map(number, others)])
    drift = drift_sentence(found.drifts, found.drift_rate_law)
    block = section(
        "Stability curve", table(HEADERS, rows), LEGEND, *([f"\n{paragraph(drift)}"] if drift else [])
    )
    here = found.here
    if here is None:
        return [block]
    low, high = here.critical_friction_low, here.critical_friction_high
    kicks = zip(found.kicks, here.kick_critical_friction, strict=True)
    lines = [
        ("Every kick settles or rolls below", "none" if low is None else f"a friction of {number(low)}"),
        ("Every kick whirls above", "none" if high is None else f"a friction of {number(high)}"),
        ("Half the runs whirl at", ", ".join(f"{number(at)} from {kick:g} m/s" for kick, at in kicks)),
        *([("Reason", here.reason)] if here.reason else []),
    ]
    title = f"Sub-critical band of this bearing, restitution factor {number(here.restitution_factor)}"
    return [block, section(title, facts(lines))]


def stability_map(answer: MapAnswer, study: Study) -> list[str]:
    """Shares of the plane, bands at a few columns, the rule, and the basis."""
    found = answer.map
    candidate = None
    if study.cage is None or study.cage.ball_cage_friction is None:
        candidate = cage_candidate(study)
    axes = [
        (name, _axis(axis, candidate.name if candidate and axis.parameter == FRICTION else "the study"))
        for name, axis in (("x", found.x), ("y", found.y))
    ]
    shares = [
        [
            kind.lower().replace("_", " "),
            str(found.counts[kind]),
            f"{100 * found.counts[kind] / len(found.points):.1f} %",
        ]
        for kind in KINDS
        if found.counts[kind] or kind in ("STABLE", "UNSTABLE")
    ]
    chosen, total = list(found.x.values), len(found.x.values)
    if total > MOST_COLUMNS:
        chosen = [chosen[round(i * (total - 1) / (SOME_COLUMNS - 1))] for i in range(SOME_COLUMNS)]
    shown = len(chosen)
    part = f"{shown} of {total} columns of the map are shown; map.json and map.nc have all of them."
    legend = ["", *([paragraph(part)] if shown < total else []), MAP_LEGEND]
    headers = (found.x.parameter, "from", "to", "whirls", "margin")
    bands = table(headers, [row for x in chosen for row in _bands(found, x)])
    varied = (found.x.parameter, found.y.parameter)
    friction = [] if FRICTION in varied else [("Pocket friction", friction_text(answer.cage, study))]
    ensemble = [
        ("Kick", "each point its own" if "kick" in varied else quantity(found.kick, "m/s")),
        ("Runs", _runs(found.stopping)),
        *_inference(found.inference),
        ("Run", f"{quantity(found.duration, 's')}, ball scatter {found.ball_scatter:g}"),
    ]
    refused = [one for one in found.points if not one.runs and not one.reason.startswith(NOT_RUN)]
    first = f"{len(refused)} points were refused; the first: {refused[0].reason}" if refused else ""
    return [
        section("Stability map", facts(axes), "", table(("", "points", "share"), shares)),
        section("Where the cage begins to whirl", bands, *legend),
        section("Basis of this answer", facts([*basis(study, answer), *friction, *ensemble])),
        *([paragraph(first, first="  - : ", indent="      ")] if first else []),
    ]


def _axis(axis: MapAxis, whose: str) -> str:
    low, high = (quantity(axis.values[i], axis.unit) for i in (0, -1))
    here = "" if axis.here is None else f", {whose} has {quantity(axis.here, axis.unit)}"
    return f"{axis.parameter}, {low} to {high}, {len(axis.values)} values{here}"


def _bands(found: StabilityMap, x: float) -> list[list[str]]:
    """Return the bands of a column; one that does not change has a row with what it is."""
    unit, here, start = found.y.unit, found.y.here, quantity(x, found.x.unit)
    changes = [change for change in found.changes if change.x == x]
    if not changes:
        sides = {point.side for point in found.points if point.x == x and point.runs}
        kind = "no boundary found" if 0 in sides else "everywhere" if sides == {1} else "nowhere"
        return [[start, "-", "-", kind if sides else "not run", "-"]]
    return [
        [
            *(start, quantity(change.y_low, unit), quantity(change.y_high, unit)),
            "above" if change.whirls_above else "below",
            "-" if here is None else quantity(_margin(change, here), unit),
        ]
        for change in changes
    ]


def _margin(change: MapChange, here: float) -> float:
    distance = max(change.y_low - here, here - change.y_high, 0.0)
    distance *= distance > ROUNDING * abs(here)
    whirls = (here > change.y_high) == change.whirls_above and distance > 0.0
    return -distance if whirls else distance


def _runs(rule: Stopping) -> str:
    if rule.agreeing_runs == rule.most_runs:
        return f"{rule.most_runs} at every point"
    wrong, other = 100 * rule.wrong_side_probability, 100 * rule.other_decision_probability
    return (
        f"up to {rule.most_runs}, stopped after {rule.agreeing_runs} that agree (risk of the wrong "
        f"side {wrong:.2g} %, of another decision {other:.2g} %)"
    )


def _inference(found: Inference | None) -> list[tuple[str, str]]:
    """Return how many points were not run, and how often those around them were wrong where they were."""
    if found is None or not found.points + found.checked:
        return []
    inferred = f"{found.points} points were not run, as those around them agree; "
    if found.error_low is None or found.error_high is None:
        return [("Inferred", f"{inferred}none was checked")]
    ends = f"(95 %: {100 * found.error_low:.2g} to {100 * found.error_high:.2g} %)"
    checked = f"{found.checked} more of that kind were run as a check, of which {found.decided_otherwise}"
    return [("Inferred", f"{inferred}{checked} are decided otherwise {ends}")]


# A sweep.

SHOWN = 15
"""Cases in the printed table."""

RANGES = {
    "restitution_factor": "Restitution factor",
    "race_damping": "Race damping",
    "max_pressure_inner": "Pressure, inner race",
    "max_pressure_outer": "Pressure, outer race",
    "spin_roll_ratio_inner": "Spin/roll ratio, inner",
    "ball_cage_friction": "Pocket friction",
    "pocket_clearance": "Pocket clearance",
    "land_clearance": "Land clearance",
    "linear_whirl_frequency": "Whirl without clearance",
    "orbit_frequency": "Orbit of whirling runs",
    "restitution_threshold": "Threshold",
    "margin": "Margin",
    "probability_stable": "P(stable)",
    "largest_offset": "Largest offset",
    "largest_contact_force": "Force at a pocket",
}


def sweep(found: Sweep, study: Study) -> list[str]:  # noqa: ARG001
    """Counts and ranges, then cases spread evenly over all."""
    cases = found.cases
    refused = [case for case in cases if case.reason and case.verdict is None]
    lines = [
        ("Varied", ", ".join(one.name for one in found.parameters)),
        ("Cases", f"{len(cases)}, of which {len(refused)} refused"),
    ]
    lines += _worst_case(found)
    verdicts = Counter(case.verdict for case in cases if case.verdict)
    if verdicts:
        counted = (f"{count} {verdict}" for verdict, count in sorted(verdicts.items()))
        lines.append(("Verdicts", ", ".join(counted)))
    units = field_units(SweptCase)
    for key, words in RANGES.items():
        values = [value for case in cases if (value := getattr(case, key)) is not None]
        if values:
            ends = (quantity(end, units[key]) for end in (min(values), max(values)))
            lines.append((words, " to ".join(dict.fromkeys(ends))))
    which = []
    if (total := len(cases)) > SHOWN:
        cases = tuple(cases[round(i * (total - 1) / (SHOWN - 1))] for i in range(SHOWN))
        which = ["", paragraph(f"{SHOWN} of {total} cases; sweep.csv, sweep.xlsx and sweep.nc have all.")]
    names = [one.name.rpartition(".")[2] for one in found.parameters]
    headers = ["case", *names, "eta", "C_mu", "pressure"]
    headers += [*["threshold", "margin"] * found.margins, *["P(stable)", "verdict"] * found.verdicts]
    rows = []
    for case in cases:
        given = zip(found.parameters, case.values, strict=True)
        row = [str(case.case), *(quantity(value, one.unit or "-") for one, value in given)]
        row += [significant(case.restitution_factor), stated(case, "race_damping")]
        row += [stated(case, "max_pressure_inner")]
        if found.margins:
            row += [significant(case.restitution_threshold, 3), significant(case.margin, 3)]
        if found.verdicts:
            row += [significant(case.probability_stable, 3), case.verdict or "-"]
        rows.append(row)
    blocks = [section("Sweep", facts(lines)), section("Cases", table(headers, rows), *which)]
    if refused:
        blocks.append(paragraph(f"Case {refused[0].case}: {refused[0].reason}", first="  "))
    return blocks


def _worst_case(found: Sweep) -> list[tuple[str, str]]:
    """Return the worst case with its values, and the time of a duty cycle that is spent where."""
    lines = []
    if (worst := found.worst) is not None:
        values = next(case.values for case in found.cases if case.case == worst.case)
        given = zip(found.parameters, values, strict=True)
        at = ", ".join(f"{one.name} {quantity(value, one.unit or '-')}" for one, value in given)
        of = f" of {worst.compared} case{'s'[: worst.compared != 1]}"
        others = f" (and {worst.alike - 1} more that are alike)" * (worst.alike > 1)
        lines.append(("Worst case", f"{worst.case}: {at}{others}"))
        more = "; --margins or --verdicts compare the stability" * (worst.quantity == "restitution_factor")
        lines.append(("Its evidence", deciding(worst.quantity, worst.value, of) + more))
    if (duty := found.duty) is not None:
        known = (f"{share} {words}" for words, share in time_shares(plain(duty)))
        lines.append(("Time", "; ".join(known) or "--margins or --verdicts show where"))
    return lines
