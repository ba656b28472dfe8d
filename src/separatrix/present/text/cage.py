"""Text for the moving cage: one run, and the evidence of a verdict."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import CageMotion
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.limits.point import own_restitution_factor
from separatrix.present.shapes import outcome_sentence
from separatrix.present.text.chain import basis
from separatrix.present.text.tables import (
    facts,
    number,
    paragraph,
    quantity,
    rate,
    section,
    significant,
    stated,
)
from separatrix.study import Guidance

if TYPE_CHECKING:
    from separatrix.answers import OfCage, SimulationAnswer
    from separatrix.cage import History, Judgement, PlanarCage
    from separatrix.study import Study

DIRECTIONS = {1: "forward", -1: "backward", 0: "none"}

MOTIONS = {
    CageMotion.CENTRED: "the cage rests among its balls, clear of its land",
    CageMotion.ON_THE_LAND: (
        "the cage rests on its land, or moves on it as loads and the land's friction make it"
    ),
    CageMotion.WHIRLING: "friction in the pockets sustains the motion, or makes it grow",
    CageMotion.DRIFTING: "the cage has no land, and nothing holds its centre",
}


def simulate(answer: SimulationAnswer, study: Study) -> list[str]:
    """How one run ended, where its centre went, its largest forces, and the work that drove it."""
    history, cage = answer.history, answer.cage
    span = " to ".join(stated(history, f"judged_{at}") for at in ("from", "until"))
    outcome = f"{history.outcome.name}, judged from {span}. {outcome_sentence(history)}"
    rubbing = cage.land_friction * history.rubbing_force * history.rubbing_speed
    ended = [
        ("Kick, run, seed", f"{answer.kick:g} m/s, {answer.run}, {study.stability.seed}"),
        ("Pocket friction", friction_text(cage, study)),
        *damping_fact(answer),
        ("Outcome", outcome),
        *_power_facts(history, rubbing),
    ]
    peaks = np.abs(history.contact_force).max(axis=0)
    forces = [
        ("Pocket", f"{quantity(float(peaks.max()), 'N')}, pocket {peaks.argmax() + 1}"),
        ("Land", quantity(float(history.land_force.max()), "N")),
    ]
    energies = {name: getattr(history, name) for name in ("kinetic_energy", "spring_energy", "land_energy")}
    ledger = [
        (name.replace("_", " "), f"{significant(1e3 * values[-1])} mJ")
        for name, values in (history.work | energies).items()
        if values.any()
    ]
    single = "A single run is not evidence: another seed may end differently. See stability and rank."
    return [
        section("The run", facts(ended)),
        section("Centre of the cage", facts([*orbit_facts(history, cage), clearance_fact(cage)])),
        section("Largest forces", facts(forces)),
        section("Work done on the cage; energy at the end", facts(ledger)),
        section("What it holds for", facts(basis(study, answer))),
        paragraph(single, indent=""),
    ]


def friction_text(cage: PlanarCage, study: Study) -> str:
    """Return the pocket friction, and where it comes from if not from the study's cage."""
    own = study.cage is not None and study.cage.ball_cage_friction is not None
    candidate = None if own else cage_candidate(study)
    environment = environment_of(study.ranking) if study.ranking and candidate else None
    whose = f", {candidate.name} in {environment}" if candidate else ""
    return number(cage.ball_cage_friction) + whose


def damping_fact(answer: OfCage) -> list[tuple[str, str]]:
    """Return the race damping and the restitution factor of a run if they are not those of the study."""
    cage = answer.cage
    if cage.race_damping == answer.solution.restitution.race_damping:
        return []
    size = quantity(cage.race_damping, "N s/m") if isfinite(cage.race_damping) else "infinite"
    eta = own_restitution_factor(cage)
    return [("Race damping", f"{size}, for a restitution factor of {eta:.4g} in place of the study's")]


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
        f"{significant(1e3 * found.end_energy, 3)} mJ; frame and loads alone can give "
        f"{significant(1e3 * found.drive_energy, 3)} mJ"
    )
    growth = f"{significant(found.growth_rate, 3)} 1/s "
    if found.growth_rate_low is None:
        growth += "(one run: no interval)"
    else:
        low, high = significant(found.growth_rate_low, 3), significant(found.growth_rate_high, 3)
        growth += f"(95 %: {low} to {high})"
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
    """Return the evidence that only a cage in space has."""
    if found.largest_tilt is None or found.axial_travel is None:
        return []
    cone = "" if found.cone_ratio is None else f"; its lean goes round at {found.cone_ratio:.2f} of the balls"
    return [
        ("Tilt", f"{1e3 * found.largest_tilt:.3g} mrad at most{cone}"),
        ("Axial motion", f"{stated(found, 'axial_travel')} from end to end"),
        ("Impacts at pockets", f"{number(found.impact_rate or 0.0, 0)} 1/s in the last part"),
    ]


def motion_words(motion: CageMotion | None) -> str:
    """Return a class of motion as it is printed."""
    return motion.value if motion else "unresolved"


def _power_facts(found: History | Judgement, rubbing: float) -> list[tuple[str, str]]:
    powers = {"pocket": found.pocket_power, "land": found.land_power}
    each = (
        f"{name} {'feeds' if watt > 0.0 else 'takes'} {quantity(abs(watt), 'W')}"
        for name, watt in powers.items()
    )
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
