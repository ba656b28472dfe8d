"""Text for one run of a cage in space: where it ends first, then motion, forces and rubbing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from separatrix.cage.closed_forms import drift_rate_law
from separatrix.present.shapes import outcome_sentence
from separatrix.present.text.cage import clearance_fact, damping_fact, friction_text
from separatrix.present.text.chain import basis
from separatrix.present.text.clearances import running_clearances
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

if TYPE_CHECKING:
    from separatrix.answers import SpaceSimulationAnswer
    from separatrix.cage import SpaceAnalysis
    from separatrix.study import Study

BASIS = 3
"""Facts of the chain that leave the text on a screen: bearing, operation, film."""

STEADY = 0.5
"""Coherence from which tilt and offset have a phase worth a number."""


def simulate_in_space(answer: SpaceSimulationAnswer, study: Study) -> list[str]:
    """How one run in space ended, how the cage moved, its forces and its rubbing."""
    history, found, cage = answer.history, answer.analysis, answer.cage
    span = " to ".join(stated(history, f"judged_{at}") for at in ("from", "until"))
    law = drift_rate_law(cage)
    drift = f"{rate(history.drift_rate)} 1/s" + (f"; by the linear law {rate(law)} 1/s" if law else "")
    ended = [
        ("Outcome", f"{history.outcome.name}. {outcome_sentence(history)}"),
        ("Judged", f"from {span}; the run has {quantity(found.run_length, 's')}"),
        ("Kick, run, seed", f"{answer.kick:g} m/s, {answer.run}, {study.stability.seed}"),
        ("Pocket friction", friction_text(cage, study)),
        *damping_fact(answer),
        ("Drift rate", drift),
        ("Energy balance", f"closes to {history.energy_imbalance:.0e} of the work done"),
    ]
    if cage.rotation_sense < 0:
        ended.append(("Shown", "as its mirror image, in which the balls go round forward"))
    single = "A single run is not evidence: another seed may end differently. See stability and rank."
    part = "of the whole run" if found.whole_run else "of the judged part"
    running = running_clearances(answer.solution.clearances)
    return [
        section("The run", facts(ended)),
        section(f"Motion in space: means {part}", facts([*_motion(found), clearance_fact(cage)])),
        section("Forces and rubbing of the whole run", facts(_forces(answer))),
        section("What it holds for", facts([*basis(study, answer)[:BASIS], *running])),
        paragraph(single, indent=""),
    ]


def _motion(found: SpaceAnalysis) -> list[tuple[str, str]]:
    """Offset, axial place, tilt, whirl and slip."""
    whirl, axial = found.whirl, found.axial
    ratios = [
        f"{name} {number(ratio, 2)}"
        for name, ratio in (("offset", whirl.offset_ratio), ("tilt", whirl.tilt_ratio))
        if ratio is not None
    ]
    words = f"{', '.join(ratios)} of the cage's speed (1: turns with it; below 0: backward)"
    slip = "the ball set is at rest" if found.cage_slip is None else f"{100.0 * found.cage_slip:.2g} %"
    return [
        ("Offset", f"{quantity(found.largest_offset, 'm')} at most, mean {quantity(found.offset.mean, 'm')}"),
        ("Tilt", f"{_mrad(found.largest_tilt)} at most, mean {_mrad(found.tilt.mean)}; {_cone(found)}"),
        (
            "Axial place",
            f"{quantity(found.largest_axial, 'm')} at most; {quantity(axial.low, 'm')} to "
            f"{quantity(axial.high, 'm')}",
        ),
        ("Whirl ratio", words if ratios else "none: the cage does not turn, or rests at the centre"),
        ("Cage slip", f"{slip} behind the ball set" if found.cage_slip is not None else slip),
    ]


def _mrad(angle: float) -> str:
    return f"{significant(1e3 * angle, 3)} mrad"


def _cone(found: SpaceAnalysis) -> str:
    """Return how the tilt follows the offset."""
    whirl = found.whirl
    if whirl.tilt_phase is None or whirl.tilt_coherence is None or whirl.tilt_coherence < STEADY:
        return "without a steady phase to the offset"
    degrees = math.degrees(whirl.tilt_phase)
    return f"{degrees:.0f} deg ahead of the offset (0: a forward cone)"


def _forces(answer: SpaceSimulationAnswer) -> list[tuple[str, str]]:
    """Largest forces, where on the pockets they fall, impacts, and rubbing."""
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
