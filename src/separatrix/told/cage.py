"""Text for the moving cage: one run, and the evidence of a verdict."""

from __future__ import annotations

import math

from separatrix.cage import History, MovingCage
from separatrix.cage.closed_forms import drift_rate_law
from separatrix.study.candidates import cage_candidate, environment_of
from separatrix.study.study import Guidance, Study
from separatrix.told.chain import basis, running_clearances
from separatrix.told.sentences import pocket_force
from separatrix.told.tables import (
    facts,
    number,
    paragraph,
    quantity,
    rate,
    section,
    significant,
    stated,
)
from separatrix.verbs.answer_records import SimulationAnswer
from separatrix.verdict.critical_friction import own_restitution_factor
from separatrix.verdict.judgement import Judgement
from separatrix.verdict.reasons import CageMotion, ball_words

DIRECTIONS = {1: "forward", -1: "backward", 0: "none"}

MOTIONS = {
    CageMotion.CENTRED: "the cage rests among its balls, clear of its land",
    CageMotion.ON_THE_LAND: (
        "the cage rests on its land, or moves on it as loads and the land's friction make it"
    ),
    CageMotion.ROLLING: "a whirl in the pockets, weaker than what frame and loads can give the cage",
    CageMotion.WHIRLING: "friction in the pockets sustains the motion, or makes it grow",
    CageMotion.DRIFTING: "the cage has no land, and nothing holds its centre",
}


SINGLE = paragraph(
    "A single run is not evidence: another seed may end differently. See stability and rank.", indent=""
)

BASIS = 3
"""Facts of the chain that leave the text of a run on a screen: bearing, operation, film."""

STEADY = 0.5
"""Coherence from which tilt and offset have a phase worth a number."""


def simulate(answer: SimulationAnswer, study: Study) -> list[str]:
    """How one run ended, how its cage moved, its largest forces, and the work that drove it."""
    history, found = answer.history, answer.analysis
    span = f"{stated(history, 'judged_from')} to {stated(history, 'followed')}"
    ended = [
        ("Outcome", f"{history.outcome.name}. {answer.outcome_sentence}"),
        ("Judged", f"from {span}; the run has {stated(found, 'run_length')}"),
        *_start(answer, study),
        ("Drift rate", _drift_text(history.drift_rate, drift_rate_law(answer.cage))),
        ("Energy balance", f"closes to {history.energy_imbalance:.0e} of the work done"),
    ]
    running = running_clearances(answer.solution.clearances)
    return [
        section("The run", facts(ended)),
        section("Motion: means of the judged part", facts([*_motion(answer), clearance_fact(answer.cage)])),
        section("Forces, rubbing and work", facts(_forces(answer))),
        section("Basis of this answer", facts([*basis(study, answer)[:BASIS], *running])),
        SINGLE,
    ]


def friction_text(cage: MovingCage, study: Study) -> str:
    """Return the pocket friction, and where it comes from if not from the study's cage."""
    own = study.cage is not None and study.cage.ball_cage_friction is not None
    candidate = None if own else cage_candidate(study)
    environment = environment_of(study.ranking) if study.ranking and candidate else None
    whose = f", {candidate.name} in {environment}" if candidate else ""
    return number(cage.ball_cage_friction) + whose


def _start(answer: SimulationAnswer, study: Study) -> list[tuple[str, str]]:
    """Return what a run starts from; its race damping only if it is not that of the study."""
    cage = answer.cage
    found = [
        ("Kick, run, seed", f"{answer.kick:g} m/s, {answer.run}, {study.stability.seed}"),
        ("Pocket friction; ball", f"{friction_text(cage, study)}; {ball_words(cage)}"),
    ]
    if cage.race_damping != answer.solution.restitution.race_damping:
        size = quantity(cage.race_damping, "N s/m") if math.isfinite(cage.race_damping) else "infinite"
        eta = own_restitution_factor(cage)
        found.append(
            ("Race damping", f"{size}, for a restitution factor of {eta:.4g} in place of the study's")
        )
    return found


def clearance_fact(cage: MovingCage) -> tuple[str, str]:
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
    forces = f"{pocket_force(found.largest_contact_force, found.force_limit)}, at a pocket"
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
        ("Ball", f"{found.ball}. {found.ball_reason or 'The study asks for it.'}"),
        ("Growth rate", f"{growth}, from {found.worst_kick:g} m/s, the worst kick"),
        ("Offset", f"{stated(found, 'largest_offset')} at most; {mean}"),
        *_space_facts(found),
        ("Drift rate", _drift_text(found.drift_rate, found.drift_rate_law)),
        ("Largest forces", f"{forces}; {stated(found, 'largest_land_force')} at the land"),
        *_left_facts(found),
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


def _left_facts(found: Judgement) -> list[tuple[str, str]]:
    """Return in how many runs a ball reached the edge of its pocket's wall; empty if in none."""
    every = found.runs * len(found.by_kick)
    where = f"in {found.left_pocket} of {every} runs a ball reached the edge of its pocket's wall"
    return [("Left its pocket", where)] if found.left_pocket else []


def motion_words(motion: CageMotion | None) -> str:
    """Return a class of motion as text."""
    return motion.value if motion else "unresolved"


def _power_facts(found: History | Judgement, rubbing: float) -> list[tuple[str, str]]:
    powers = (("pocket", found.pocket_power), ("land", found.land_power))
    each = [f"{name} {'feeds' if w > 0.0 else 'takes'} {quantity(abs(w), 'W', 3)}" for name, w in powers if w]
    rows = [("Friction power", ", ".join(each) or "none")]
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


def _motion(answer: SimulationAnswer) -> list[tuple[str, str]]:
    history, found, turning = answer.history, answer.analysis, abs(answer.cage.cage_speed)
    spread = number(history.offset_spread / history.mean_offset, 2) if history.mean_offset > 0.0 else "0"
    most = f"{stated(history, 'largest_offset')} at most, mean {stated(history, 'mean_offset')}"
    rows = [("Offset", f"{most}, relative spread {spread} (0: a circle about the axis)")]
    if history.largest_tilt is not None:
        cone = "without a steady phase to the offset"
        if found.tilt_phase is not None and (found.tilt_coherence or 0.0) >= STEADY:
            cone = f"{math.degrees(found.tilt_phase):.0f} deg ahead of the offset (0: a forward cone)"
        axial = " to ".join(stated(history, f"axial_{end}") for end in ("low", "high"))
        tilt = f"{significant(1e3 * history.largest_tilt, 3)} mrad at most; {cone}"
        rows += [("Tilt", tilt), ("Axial place", axial)]
    pace = f"{stated(history, 'whirl_frequency')} {DIRECTIONS[history.whirl_direction]}"
    seen = f"{pace}, seen from the balls; the centre moves at {stated(found, 'whirl_speed')}"
    speeds = (("centre", history.orbit_speed), ("tilt", history.cone_speed))
    ratios = [
        f"{name} {number(speed / turning, 2)}" for name, speed in speeds if speed is not None and turning
    ]
    slip = "the ball set is at rest"
    if found.cage_slip is not None:
        share = round(100.0 * found.cage_slip, 2) + 0.0  # never -0
        slip = f"{abs(share):g} % {'ahead of' if share < 0.0 else 'behind'} the ball set"
    return [
        *rows,
        ("Whirl", seen if answer.whirls else "none: the motion does not last"),
        ("Orbit", f"{', '.join(ratios)} of the ball set's speed (below 0: backward)" if ratios else slip),
        ("Cage slip", slip),
    ]


def _forces(answer: SimulationAnswer) -> list[tuple[str, str]]:
    history, found = answer.history, answer.analysis
    pocket = pocket_force(history.largest_contact_force, answer.force_limit)
    if answer.force_exceeds_races:
        pocket += ": beyond it this model of a ball has no meaning (`--ball free` has)"
    is_landless = answer.cage.guidance is Guidance.BALL
    land = "the cage has no land" if is_landless else stated(history, "largest_land_force")
    count = f"{history.pocket_impacts.sum():.0f} in pockets, {history.land_impacts} at the land"
    if found.impacts_per_turn is not None:
        count += f"; {number(float(found.impacts_per_turn.mean()), 2)} in each pocket per cage turn"
    rows = [("Pocket, largest", pocket), ("Land, largest", land), ("Impacts", count)]
    if found.front_share is not None:
        shares = (
            (found.front_share, "in front of the ball"),
            (found.rear_share, "behind it"),
            (found.axial_share, "at its axial sides"),
        )
        each = (f"{100.0 * share:.0f} % {where}" for share, where in shares if share)
        rows.append(("Impulse", ", ".join(each)))
    heat = f"{quantity(float(found.pocket_rubbing_power.sum()), 'W')} of heat, mean of the run"
    rows += [*_power_facts(history, answer.rubbing_power), ("Rubbing in the pockets", heat)]
    done = {name.replace("_", " "): float(work[-1]) for name, work in history.work.items() if work.any()}
    left = float(history.kinetic_energy[-1] + history.stored_energy[-1])
    works = ", ".join(f"{name} {quantity(work, 'J', 3)}" for name, work in done.items())
    return [*rows, ("Work on the cage", f"{works or 'none'}; energy at the end {quantity(left, 'J', 3)}")]
