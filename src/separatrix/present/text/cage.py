"""Text for the moving cage: runs in the plane and in space, and the evidence of a verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from separatrix.answers import SimulationAnswer, SpaceSimulationAnswer
from separatrix.cage import CageMotion, History, Judgement, PlanarCage, SpaceAnalysis
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.limits.point import own_restitution_factor
from separatrix.present.shapes import outcome_sentence
from separatrix.present.text.chain import basis, running_clearances
from separatrix.present.text.tables import (
    facts,
    interval,
    number,
    paragraph,
    quantity,
    rate,
    section,
    significant,
    stated,
    table,
)
from separatrix.ranking.records import NotMeasured, Ranking, Row
from separatrix.study import BallModel, Guidance, Study

DIRECTIONS = {1: "forward", -1: "backward", 0: "none"}

MOTIONS = {
    CageMotion.CENTRED: "the cage rests among its balls, clear of its land",
    CageMotion.ON_THE_LAND: (
        "the cage rests on its land, or moves on it as loads and the land's friction make it"
    ),
    CageMotion.WHIRLING: "friction in the pockets sustains the motion, or makes it grow",
    CageMotion.DRIFTING: "the cage has no land, and nothing holds its centre",
}


SINGLE = paragraph(
    "A single run is not evidence: another seed may end differently. See stability and rank.", indent=""
)

BASIS = 3
"""Facts of the chain that leave the text of a run in space on a screen: bearing, operation, film."""

STEADY = 0.5
"""Coherence from which tilt and offset have a phase worth a number."""


def simulate(answer: SimulationAnswer | SpaceSimulationAnswer, study: Study) -> list[str]:
    """How one run ended, where its centre went, its largest forces, and the work that drove it."""
    if isinstance(answer, SpaceSimulationAnswer):
        return _simulate_in_space(answer, study)
    history, cage = answer.history, answer.cage
    span = " to ".join(stated(history, f"judged_{at}") for at in ("from", "until"))
    outcome = f"{history.outcome.name}, judged from {span}. {outcome_sentence(history)}"
    rubbing = cage.land_friction * history.rubbing_force * history.rubbing_speed
    ended = [*_start(answer, study), ("Outcome", outcome), *_power_facts(history, rubbing)]
    peaks = np.abs(history.contact_force).max(axis=0)
    forces = [
        ("Pocket", f"{quantity(float(peaks.max()), 'N')}, pocket {peaks.argmax() + 1}"),
        ("Land", quantity(float(history.land_force.max()), "N")),
    ]
    energies = {name: getattr(history, name) for name in ("kinetic_energy", "spring_energy", "land_energy")}
    ledger = [
        (name.replace("_", " "), quantity(float(values[-1]), "J"))
        for name, values in (history.work | energies).items()
        if values.any()
    ]
    return [
        section("The run", facts(ended)),
        section("Centre of the cage", facts([*orbit_facts(history, cage), clearance_fact(cage)])),
        section("Largest forces", facts(forces)),
        section("Work done on the cage; energy at the end", facts(ledger)),
        section("Basis of this answer", facts(basis(study, answer))),
        SINGLE,
    ]


def friction_text(cage: PlanarCage, study: Study) -> str:
    """Return the pocket friction, and where it comes from if not from the study's cage."""
    own = study.cage is not None and study.cage.ball_cage_friction is not None
    candidate = None if own else cage_candidate(study)
    environment = environment_of(study.ranking) if study.ranking and candidate else None
    whose = f", {candidate.name} in {environment}" if candidate else ""
    return number(cage.ball_cage_friction) + whose


def _start(answer: SimulationAnswer | SpaceSimulationAnswer, study: Study) -> list[tuple[str, str]]:
    """Return what a run starts from; its race damping only if it is not that of the study."""
    cage = answer.cage
    found = [
        ("Kick, run, seed", f"{answer.kick:g} m/s, {answer.run}, {study.stability.seed}"),
        ("Pocket friction", friction_text(cage, study)),
    ]
    if cage.race_damping != answer.solution.restitution.race_damping:
        size = quantity(cage.race_damping, "N s/m") if math.isfinite(cage.race_damping) else "infinite"
        eta = own_restitution_factor(cage)
        found.append(
            ("Race damping", f"{size}, for a restitution factor of {eta:.4g} in place of the study's")
        )
    return found


def orbit_facts(history: History, cage: PlanarCage) -> list[tuple[str, str]]:
    """Return how far the centre went, and how it moved in the part of the run by which it is judged."""
    start = min(history.judged_from, float(history.time[-1]))
    offset = np.hypot(*history.position.T)
    at_end = offset[history.time >= start]
    mean, spread = float(at_end.mean()), float(at_end.std())
    evenness = f"{number(spread / mean, 2)} (0: a circle about the axis)" if mean > 0.0 else "none"
    return [
        ("Largest offset", quantity(float(offset.max()), "m")),
        ("Mean offset", f"{quantity(mean, 'm')}, from {quantity(start, 's')} to the end"),
        ("Relative spread", evenness),
        ("Drift rate", _drift_text(history.drift_rate, drift_rate_law(cage))),
    ]


def clearance_fact(cage: PlanarCage) -> tuple[str, str]:
    """Return the clearances that the offset compares with: of the pockets, and of the land."""
    pockets = f"pockets {quantity(cage.half_play, 'm')} each way"
    if cage.guidance is Guidance.BALL or cage.land_clearance is None:
        return "Clearance", f"{pockets}; no land"
    land = f"{cage.guidance.value} land {quantity(cage.land_clearance / 2.0, 'm')} radial"
    return "Clearance", f"{land}, {pockets}"


def judgement_facts(found: Judgement, reason: str) -> list[tuple[str, str]]:
    """Return a verdict with its evidence on a few lines."""
    motion = found.cage_motion
    ends = f"(95 %: {number(found.probability_low, 2)} to {number(found.probability_high, 2)})"
    mean = f"{stated(found, 'mean_offset')} at the end, relative spread {number(found.orbit_evenness, 2)}"
    forces = f"{stated(found, 'largest_contact_force')} at a pocket, {stated(found, 'largest_land_force')}"
    energy = (
        f"{quantity(found.end_energy, 'J', 3)}; frame and loads alone can supply "
        f"{quantity(found.drive_energy, 'J', 3)}"
    )
    growth = f"{significant(found.growth_rate, 3)} 1/s (one run: no interval)"
    if found.growth_rate_low is not None:
        low, high = significant(found.growth_rate_low, 3), significant(found.growth_rate_high, 3)
        growth = f"{significant(found.growth_rate, 3)} 1/s (95 %: {low} to {high})"
    return [
        ("Verdict", f"{found.verdict.name}. {reason}"),
        ("Motion", f"{motion.value}: {MOTIONS[motion]}" if motion else "unresolved in most runs"),
        ("P(stable)", f"{number(found.probability_stable, 2)} {ends}"),
        ("Growth rate", f"{growth}, from {found.worst_kick:g} m/s, the worst kick"),
        ("Offset", f"{stated(found, 'largest_offset')} at most; {mean}"),
        *_space_facts(found),
        ("Drift rate", _drift_text(found.drift_rate, found.drift_rate_law)),
        ("Largest forces", f"{forces} at the land"),
        ("Impacts", _impacts_text(found)),
        ("Whirl", _whirl_text(found)),
        ("Energy at the end", energy),
        *_power_facts(found, found.rubbing_power),
        ("Runs", f"{found.runs} from each kick, of up to {stated(found, 'longest_run')}"),
    ]


def _space_facts(found: Judgement) -> list[tuple[str, str]]:
    if found.largest_tilt is None or found.axial_travel is None:
        return []
    cone = "" if found.cone_ratio is None else f"; its lean goes round at {found.cone_ratio:.2f} of the balls"
    return [
        ("Tilt", f"{1e3 * found.largest_tilt:.3g} mrad at most{cone}"),
        ("Axial motion", f"{stated(found, 'axial_travel')} from end to end"),
        ("Impacts at pockets", f"{number(found.impact_rate or 0.0, 0)} 1/s in the last part"),
    ]


def motion_words(motion: CageMotion | None) -> str:
    """Return a class of motion as text."""
    return motion.value if motion else "unresolved"


def _power_facts(found: History | Judgement, rubbing: float) -> list[tuple[str, str]]:
    powers = (("pocket", found.pocket_power), ("land", found.land_power))
    each = (f"{name} {'feeds' if w > 0.0 else 'takes'} {quantity(abs(w), 'W')}" for name, w in powers)
    rows = [("Friction power", ", ".join(each))]
    if found.rubbing_force > 0.0:
        both = f"{stated(found, 'rubbing_force')} at {stated(found, 'rubbing_speed')}"
        rows.append(("Rubbing on the land", f"{both}, {quantity(rubbing, 'W')} of heat"))
    return rows


def _drift_text(measured: float, law: float) -> str:
    return f"{rate(measured)} 1/s" + (f"; by the linear law {rate(law)} 1/s" if law else "")


def _impacts_text(found: Judgement) -> str:
    """Return which pocket takes most impacts, against an even share, and the share of the land."""
    shares = found.pocket_impact_shares
    if not any(shares):
        return f"none at a pocket, {'all' if found.land_impact_share else 'none'} at the land"
    most = max(range(len(shares)), key=shares.__getitem__)
    land = f"{100.0 * found.land_impact_share:.0f} % of all impacts are at the land"
    even = f"even share {100.0 / len(shares):.0f} %"
    return f"pocket {most + 1} takes {100.0 * shares[most]:.0f} % of the impacts at pockets ({even}); {land}"


def _whirl_text(found: Judgement) -> str:
    """Return frequency and direction in the turning frame, and the whirl ratio in the fixed one."""
    seen = f"{stated(found, 'whirl_frequency')} {DIRECTIONS[found.whirl_direction]}"
    if found.whirl_ratio is None:
        return f"{seen}; the ball set is at rest"
    ratio = number(found.whirl_ratio, 2)
    return f"{seen}, seen from the balls; the centre orbits at {ratio} of the ball set's speed"


def _simulate_in_space(answer: SpaceSimulationAnswer, study: Study) -> list[str]:
    history, found, cage = answer.history, answer.analysis, answer.cage
    span = " to ".join(stated(history, f"judged_{at}") for at in ("from", "until"))
    ended = [
        ("Outcome", f"{history.outcome.name}. {outcome_sentence(history)}"),
        ("Judged", f"from {span}; the run has {quantity(found.run_length, 's')}"),
        *_start(answer, study),
        ("Drift rate", _drift_text(history.drift_rate, drift_rate_law(cage))),
        ("Energy balance", f"closes to {history.energy_imbalance:.0e} of the work done"),
    ]
    if cage.rotation_sense < 0:
        ended.append(("Shown", "as its mirror image, in which the balls go round forward"))
    part = "of the whole run" if found.whole_run else "of the judged part"
    running = running_clearances(answer.solution.clearances)
    return [
        section("The run", facts(ended)),
        section(f"Motion in space: means {part}", facts([*_motion(found), clearance_fact(cage)])),
        section("Forces and rubbing of the whole run", facts(_forces(answer))),
        section("Basis of this answer", facts([*basis(study, answer)[:BASIS], *running])),
        SINGLE,
    ]


def _motion(found: SpaceAnalysis) -> list[tuple[str, str]]:
    whirl = found.whirl
    axial = " to ".join(quantity(end, "m") for end in (found.axial.low, found.axial.high))
    ratios = [
        f"{name} {number(ratio, 2)}"
        for name, ratio in (("offset", whirl.offset_ratio), ("tilt", whirl.tilt_ratio))
        if ratio is not None
    ]
    words = f"{', '.join(ratios)} of the cage's speed (1: turns with it; below 0: backward)"
    slip = "the ball set is at rest"
    if found.cage_slip is not None:
        share = round(100.0 * found.cage_slip, 2) + 0.0  # never -0
        slip = f"{abs(share):g} % {'ahead of' if share < 0.0 else 'behind'} the ball set"
    cone = "without a steady phase to the offset"
    if whirl.tilt_phase is not None and (whirl.tilt_coherence or 0.0) >= STEADY:
        cone = f"{math.degrees(whirl.tilt_phase):.0f} deg ahead of the offset (0: a forward cone)"
    return [
        ("Offset", f"{quantity(found.largest_offset, 'm')} at most, mean {quantity(found.offset.mean, 'm')}"),
        ("Tilt", f"{_mrad(found.largest_tilt)} at most, mean {_mrad(found.tilt.mean)}; {cone}"),
        ("Axial place", f"{quantity(found.largest_axial, 'm')} at most; {axial}"),
        ("Whirl ratio", words if ratios else "none: the cage does not turn, or rests at the centre"),
        ("Cage slip", slip),
    ]


def _mrad(angle: float) -> str:
    return f"{significant(1e3 * angle, 3)} mrad"


def _forces(answer: SpaceSimulationAnswer) -> list[tuple[str, str]]:
    history, found = answer.history, answer.analysis
    impacts, rubbing = found.impacts, found.rubbing
    pocket = quantity(history.largest_contact_force, "N")
    if found.force_share is not None:
        pocket += f", {number(found.force_share, 2)} of what the races can transmit to a ball"
    land = quantity(history.largest_land_force, "N") if rubbing.land_power.size else "the cage has no land"
    rows = [("Pocket, largest", pocket), ("Land, largest", land)]
    turns = impacts.rate_per_turn
    count = f"{impacts.count} in pockets, {impacts.land_count} at lands"
    if turns is not None and turns.size:
        count += f"; {number(float(turns.mean()), 2)} in each pocket per cage turn"
    rows.append(("Impacts", count))
    if impacts.front_share is not None:
        shares = (
            (impacts.front_share, "in front of the ball"),
            (impacts.rear_share, "behind it"),
            (impacts.axial_share, "at its axial sides"),
        )
        each = ", ".join(f"{100.0 * (share or 0.0):.0f} % {where}" for share, where in shares)
        rows.append(("Impulse", each))
    pockets, lands = float(rubbing.pocket_power.sum()), float(rubbing.land_power.sum())
    heat = f"pockets {quantity(pockets, 'W')}, lands {quantity(lands, 'W')} of friction heat, mean"
    return [*rows, ("Rubbing", heat)]


SECOND_HEADERS = ("material", "damper:\nverdict", "force over\ncapacity")
TRACTION_HEADERS = ("traction:\nverdict", "P(stable)\n(95 %)", "force over\ncapacity")
WHY = {
    True: "beyond its traction a ball slides along with the cage and takes the energy of the impact, where "
    "the damper returns it",
    False: "a ball with traction yields less to weak impacts than the damper, and goes on moving after them",
}
"""Why the model with traction may find more runs stable, or fewer."""


def by_the_other_ball(found: Ranking, rows: Sequence[Row]) -> list[str]:
    """Return verdicts by both models of a ball, and where they differ; nothing without a second verdict."""
    runs = 0
    both: list[tuple[str, Judgement, Judgement]] = []
    for row in rows:
        if isinstance(row, NotMeasured) or row.judgement is None or row.other_ball is None:
            continue
        first, second = row.judgement, row.other_ball
        runs = second.runs
        is_damper = found.ball_model is BallModel.DAMPER
        both.append((row.name, first, second) if is_damper else (row.name, second, first))
    if not both:
        return []
    cells = [[name, *_cells(found, damper), *_cells(found, traction)] for name, damper, traction in both]
    for cell, (_, _, traction) in zip(cells, both, strict=True):
        ends = traction.probability_low, traction.probability_high
        cell.insert(-1, interval(traction.probability_stable, *ends))
    largest = max(damper.largest_contact_force for _, damper, _ in both)
    text = (
        f"The races transmit at most {quantity(found.capacity, 'N', 3)} to a ball before it slides; the "
        f"damper presses pockets with up to {quantity(largest, 'N', 3)}. The other model has {runs} runs "
        f"from each kick. {_differences(both)}"
    )
    title = "Balls as dampers (the paper), and with their inertia and the traction of their races"
    return [section(title, table((*SECOND_HEADERS, *TRACTION_HEADERS), cells, left=1), "", paragraph(text))]


def _cells(found: Ranking, one: Judgement) -> list[str]:
    return [one.verdict.name, f"{one.largest_contact_force / found.capacity:.2g}"]


def _differences(both: Sequence[tuple[str, Judgement, Judgement]]) -> str:
    said = []
    for more in (True, False):
        names = [
            name
            for name, damper, traction in both
            if damper.verdict is not traction.verdict
            and (traction.probability_stable >= damper.probability_stable) is more
        ]
        if names:
            than = "more" if more else "less"
            come = "comes" if len(names) == 1 else "come"
            said.append(f"With traction {', '.join(names)} {come} out {than} stable: {WHY[more]}.")
    return " ".join(said) or "Both models reach the same verdicts."
