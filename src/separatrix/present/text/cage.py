"""Text for the moving cage: one run, and the evidence of a verdict."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from separatrix.cage import CageMotion
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.cage_choice import cage_candidate, environment_of
from separatrix.present.shapes import outcome_sentence
from separatrix.present.text.chain import basis
from separatrix.present.text.tables import facts, number, paragraph, quantity, section, significant
from separatrix.study import Guidance

if TYPE_CHECKING:
    from separatrix.answers import SimulationAnswer
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
    span = " to ".join(quantity(at, "s") for at in (history.judged_from, history.judged_until))
    outcome = f"{history.outcome.name}, judged from {span}. {outcome_sentence(history)}"
    rubbing = cage.land_friction * history.rubbing_force * history.rubbing_speed
    ended = [
        ("Kick, run, seed", f"{answer.kick:g} m/s, {answer.run}, {study.stability.seed}"),
        ("Pocket friction", friction_text(cage, study)),
        ("Outcome", outcome),
        ("Friction power", _power_text(history)),
        *_rubbing_facts(history, rubbing),
    ]
    single = "A single run is not evidence: another seed may end differently. See stability and rank."
    return [
        section("The run", facts(ended)),
        section("Centre of the cage", facts([*orbit_facts(history, cage), clearance_fact(cage)])),
        section("Largest forces", facts(_forces(history))),
        section("Work done on the cage; energy at the end", facts(_energies(history))),
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


def orbit_facts(history: History, cage: PlanarCage) -> list[tuple[str, str]]:
    """Return how far the centre went, and how it moved in the part of the run by which it is judged."""
    start = min(history.judged_from, float(history.time[-1]))
    offset = np.hypot(*history.position.T)
    at_end = offset[history.time >= start]
    mean, spread = float(at_end.mean()), float(at_end.std())
    evenness = f"{number(spread / mean, 2)} (0: a circle about the axis)" if mean > 0.0 else "none"
    return [
        ("Largest offset", quantity(float(offset.max()), "m")),
        ("Mean offset at the end", f"{quantity(mean, 'm')}, since {quantity(start, 's')}"),
        ("Relative spread", evenness),
        ("Drift rate", _drift_text(history.drift_rate, drift_rate_law(cage))),
    ]


def clearance_fact(cage: PlanarCage) -> tuple[str, str]:
    """Return the clearances that the offset compares with: of the pockets, and of the land."""
    pockets = f"pockets {quantity(cage.half_play, 'm')} each way"
    if cage.guidance is Guidance.BALL or cage.land_clearance is None:
        return "Clearance", f"{pockets}; no land"
    return (
        "Clearance",
        f"{cage.guidance.value} land {quantity(cage.land_clearance / 2.0, 'm')} radial, {pockets}",
    )


def _forces(history: History) -> list[tuple[str, str]]:
    """Return the largest force of a pocket, which one, and of the land."""
    peaks = np.abs(history.contact_force).max(axis=0)
    return [
        ("Pocket", f"{quantity(float(peaks.max()), 'N')}, pocket {peaks.argmax() + 1}"),
        ("Land", quantity(float(history.land_force.max()), "N")),
    ]


def _energies(history: History) -> list[tuple[str, str]]:
    """Return the work of every source that did any, and the energies at the end."""
    energies = {name: getattr(history, name) for name in ("kinetic_energy", "spring_energy", "land_energy")}
    return [
        (name.replace("_", " "), f"{1e3 * values[-1]:.4g} mJ")
        for name, values in (history.work | energies).items()
        if values.any()
    ]


def judgement_facts(found: Judgement, reason: str) -> list[tuple[str, str]]:
    """Return a verdict with its evidence on a few lines."""
    motion = found.cage_motion
    low, high = number(found.probability_low, 2), number(found.probability_high, 2)
    largest, mean = quantity(found.largest_offset, "m"), quantity(found.mean_offset, "m")
    forces = (quantity(force, "N") for force in (found.largest_contact_force, found.largest_land_force))
    energy = (
        f"{1e3 * found.end_energy:.3g} mJ; frame and loads alone can give {1e3 * found.drive_energy:.3g} mJ"
    )
    growth = f"{growth_text(found, ' 1/s', '95 %: ')}, from {found.worst_kick:g} m/s, the worst kick"
    spread = f"relative spread {number(found.orbit_evenness, 2)}"
    return [
        ("Verdict", f"{found.verdict.name}. {reason}"),
        ("Motion", f"{motion.value}: {MOTIONS[motion]}" if motion else "unresolved in most runs"),
        ("P(stable)", f"{number(found.probability_stable, 2)} (95 %: {low} to {high})"),
        ("Growth rate", growth),
        ("Offset", f"{largest} at most; {mean} at the end, {spread}"),
        ("Drift rate", _drift_text(found.drift_rate, found.drift_rate_law)),
        ("Largest forces", "{} at a pocket, {} at the land".format(*forces)),
        ("Impacts", _impacts_text(found)),
        ("Whirl", _whirl_text(found)),
        ("Energy at the end", energy),
        ("Friction power", _power_text(found)),
        *_rubbing_facts(found, found.rubbing_power),
        ("Runs", f"{found.runs} from each kick, of up to {quantity(found.longest_run, 's')}"),
    ]


def motion_words(motion: CageMotion | None) -> str:
    """Return a class of motion as it is printed."""
    return motion.value if motion else "unresolved"


def growth_text(found: Judgement, unit: str = "", share: str = "") -> str:
    """Return the growth rate with its interval."""
    rate = f"{significant(found.growth_rate, 3)}{unit}"
    if found.growth_rate_low is None:
        return f"{rate} (one run: no interval)" if unit else rate
    return (
        f"{rate} ({share}{significant(found.growth_rate_low, 3)} to {significant(found.growth_rate_high, 3)})"
    )


def _power_text(found: History | Judgement) -> str:
    """Return the power that friction feeds into the cage at the end, or takes from it."""
    powers = {"pocket": found.pocket_power, "land": found.land_power}
    verbs = {name: "feeds" if watt > 0.0 else "takes" for name, watt in powers.items()}
    return ", ".join(f"{name} {verbs[name]} {quantity(abs(watt), 'W')}" for name, watt in powers.items())


def _rubbing_facts(found: History | Judgement, power: float) -> list[tuple[str, str]]:
    """Return force, speed and power of the rubbing on the land, if the cage rubs there at the end."""
    if found.rubbing_force <= 0.0:
        return []
    both = f"{quantity(found.rubbing_force, 'N')} at {quantity(found.rubbing_speed, 'm/s')}"
    return [("Rubbing on the land", f"{both}, {quantity(power, 'W')} of heat")]


def _drift_text(rate: float, law: float) -> str:
    """Return the drift rate as measured, and by the linear law for a cage without a land."""
    measured = f"{significant(rate, 3)} 1/s"
    return f"{measured}; by the linear law {significant(law, 3)} 1/s" if law else measured


def _impacts_text(found: Judgement) -> str:
    """Return which pocket takes most impacts, against an even share, and the share of the land."""
    shares = found.pocket_impact_shares
    if not any(shares):
        at_land = ", all at the land" if found.land_impact_share else ", none at the land"
        return f"none at a pocket{at_land}"
    most = max(range(len(shares)), key=shares.__getitem__)
    land = f"{100.0 * found.land_impact_share:.0f} % of all impacts are at the land"
    even = f"even share {100.0 / len(shares):.0f} %"
    return f"pocket {most + 1} takes {100.0 * shares[most]:.0f} % of the impacts at pockets ({even}); {land}"


def _whirl_text(found: Judgement) -> str:
    """Return frequency and direction in the turning frame, and the whirl ratio in the fixed one."""
    seen = f"{quantity(found.whirl_frequency, 'Hz')} {DIRECTIONS[found.whirl_direction]}"
    if found.whirl_ratio is None:
        return f"{seen}; the ball set is at rest"
    ratio = number(found.whirl_ratio, 2)
    return f"{seen}, seen from the balls; the centre orbits at {ratio} of the ball set's speed"
